//! The template, with all that doesn't depend on the frame.

use super::MatchMethod;
use super::rectangles::{self, Patch};
use crate::{Error, Frame, FrameView};

/// Pixels `T` of which `n` count (all, or those under the mask). Sums go over these alone.
#[derive(Clone, Debug)]
pub(super) struct Template {
    shape: [usize; 2],
    method: MatchMethod,
    /// Row by row; 0 where a pixel doesn't count.
    pixels: Vec<u8>,
    /// `T − t₀` row by row; 0 where a pixel doesn't count.
    kernel: Vec<f32>,
    /// Cover the pixels that count.
    patches: Vec<Patch>,
    /// `n`
    count: u64,
    /// `Σ T`
    sum: u64,
    /// `Σ T²`, zero-mean `n Σ T² − (Σ T)²`
    energy: u128,
    /// `t₀`: the mean, rounded, so that the kernel holds whole numbers.
    offset: f64,
}

/// How a correlation of centred pixels, `R = Σ (I − c)(T − t₀)`, becomes a score, with `S = Σ I` and `Q = Σ I²` over
/// the window: `(R + by_sum · S + constant) · scale / √energy` with `energy = by_square · Q − by_sum_squared · S²`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Terms {
    by_sum: f64,
    constant: f64,
    pub(super) scale: f64,
    by_square: f64,
    by_sum_squared: f64,
    /// The least score of the method.
    pub(super) least: f32,
}

impl Terms {
    #[inline(always)]
    pub(super) fn numerator(&self, correlation: f32, sum: f64) -> f64 {
        f64::from(correlation) + self.by_sum * sum + self.constant
    }

    /// Exact for up to 370,000 pixels, and 0 for every window that is flat.
    #[inline(always)]
    pub(super) fn energy(&self, sum: f64, square: f64) -> f64 {
        self.by_square * square - self.by_sum_squared * (sum * sum)
    }
}

impl Template {
    pub(super) fn new(template: &Frame, mask: Option<&Frame>, method: MatchMethod) -> Result<Template, Error> {
        let shape = [template.height(), template.width()];
        let patches = match mask {
            Some(mask) => masked_patches(mask, shape)?,
            None => rectangles::whole(shape),
        };
        let counts = |i: usize| mask.is_none_or(|mask| mask.as_slice()[i] != 0);
        let all = || template.as_slice().iter().enumerate().map(|(i, &v)| (v, counts(i)));
        let counted = || all().filter(|pixel| pixel.1).map(|pixel| u64::from(pixel.0));
        let (count, sum) = (counted().count() as u64, counted().sum::<u64>());
        let offset = (sum as f64 / count as f64).round();
        Ok(Template {
            shape,
            method,
            pixels: all().map(|(v, counts)| if counts { v } else { 0 }).collect(),
            kernel: all().map(|(v, counts)| if counts { f32::from(v) - offset as f32 } else { 0.0 }).collect(),
            patches,
            count,
            sum,
            energy: method.energy(count, sum, counted().map(|v| v * v).sum()),
            offset,
        })
    }

    /// `[height, width]`
    pub(super) fn shape(&self) -> [usize; 2] {
        self.shape
    }

    pub(super) fn kernel(&self) -> &[f32] {
        &self.kernel
    }

    pub(super) fn patches(&self) -> &[Patch] {
        &self.patches
    }

    /// The terms for pixels centred by `c`.
    pub(super) fn terms(&self, centre: f64) -> Terms {
        let (count, sum) = (self.count as f64, self.sum as f64);
        let beside = sum - count * self.offset;
        let unit = if self.energy == 0 { 0.0 } else { 1.0 / (self.energy as f64).sqrt() };
        match self.method {
            MatchMethod::CcorrNormed => Terms {
                by_sum: self.offset,
                constant: centre * beside,
                scale: unit,
                by_square: 1.0,
                by_sum_squared: 0.0,
                least: 0.0,
            },
            MatchMethod::CcoeffNormed => Terms {
                by_sum: -beside / count,
                constant: centre * beside,
                scale: count * unit,
                by_square: count,
                by_sum_squared: 1.0,
                least: -1.0,
            },
        }
    }

    /// The score of the window at (`x`, `y`), whose pixels have this sum and sum of squares, from whole numbers.
    #[inline(always)]
    pub(super) fn score(&self, frame: FrameView<'_>, x: usize, y: usize, [sum, square]: [u64; 2]) -> f64 {
        let energy = self.method.energy(self.count, sum, square);
        if energy == 0 || self.energy == 0 {
            return 0.0;
        }
        let product = i128::from(self.product(frame, x, y));
        let numerator = match self.method {
            MatchMethod::CcorrNormed => product,
            MatchMethod::CcoeffNormed => i128::from(self.count) * product - i128::from(sum) * i128::from(self.sum),
        };
        (numerator as f64 / (energy as f64 * self.energy as f64).sqrt()).clamp(-1.0, 1.0)
    }

    /// `Σ I T` over the window at (`x`, `y`).
    #[inline(always)]
    fn product(&self, frame: FrameView<'_>, x: usize, y: usize) -> u64 {
        let mut sum = 0;
        for (row, pixels) in self.pixels.chunks_exact(self.shape[1]).enumerate() {
            sum += dot(pixels, &frame.row(y + row)[x..]);
        }
        sum
    }
}

impl MatchMethod {
    /// What a score divides by, squared, from the number of pixels, their sum and that of their squares.
    fn energy(self, count: u64, sum: u64, square: u64) -> u128 {
        match self {
            MatchMethod::CcorrNormed => u128::from(square),
            MatchMethod::CcoeffNormed => u128::from(count) * u128::from(square) - u128::from(sum) * u128::from(sum),
        }
    }
}

fn masked_patches(mask: &Frame, [height, width]: [usize; 2]) -> Result<Vec<Patch>, Error> {
    if (mask.width(), mask.height()) != (width, height) {
        let got = format!("{}x{} px", mask.width(), mask.height());
        return Err(Error::invalid("mask", &got, format!("{width}x{height} px, the size of the template")));
    }
    let patches = rectangles::of_mask(mask);
    if patches.is_empty() {
        return Err(Error::invalid("mask", &"only zeros", "a pixel that counts; leave the mask out to count all"));
    }
    Ok(patches)
}

/// `Σ a b`, as far as `a` goes.
#[inline(always)]
fn dot(a: &[u8], b: &[u8]) -> u64 {
    // As many products as surely fit 32 bits, which run on more lanes than 64 do.
    const PIECE: usize = 1 << 16;
    let mut total = 0;
    for (a, b) in a.chunks(PIECE).zip(b.chunks(PIECE)) {
        let mut sum = 0u32;
        for (&a, &b) in a.iter().zip(b) {
            sum += u32::from(a) * u32::from(b);
        }
        total += u64::from(sum);
    }
    total
}
