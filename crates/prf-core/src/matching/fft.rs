//! Fourier transforms of sixteen columns at a time.
//!
//! The columns lie side by side, so that every step is the same arithmetic on sixteen neighbours and needs no
//! shuffling. The forward transform takes natural order to a scattered one (decimation in frequency), the inverse
//! takes it back (decimation in time): a product of two spectra doesn't care, so nothing is ever sorted.

use std::f64::consts::TAU;

use super::dft::{Complex, dft2, dft3, dft4, dft5, times};

/// Columns that are transformed together.
pub(super) const LANES: usize = 16;

/// The same row of sixteen columns.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Lanes(pub(super) [f32; LANES]);

impl Lanes {
    pub(super) const ZERO: Lanes = Lanes([0.0; LANES]);
}

/// A transform of one length, a product of 2, 3 and 5.
#[derive(Clone, Debug)]
pub(super) struct Fft {
    passes: Vec<Pass>,
}

/// One pass over all rows: for each of the neighbours that are `span` apart (as many as the radix), a small transform
/// and `radix` factors `exp(-2πi jk / (radix · span))`. There are `span` sets of factors.
#[derive(Clone, Debug)]
enum Pass {
    Two(Vec<[Complex; 2]>),
    Three(Vec<[Complex; 3]>),
    Four(Vec<[Complex; 4]>),
    Five(Vec<[Complex; 5]>),
}

impl Fft {
    /// `len` as [`radices`] can factor it.
    pub(super) fn new(len: usize) -> Fft {
        let mut block = len;
        let passes = radices(len).into_iter().flatten().map(|radix| {
            let pass = Pass::new(radix, block);
            block /= radix;
            pass
        });
        Fft { passes: passes.collect() }
    }

    /// Sixteen columns of complex numbers to their spectra, in scattered order.
    #[inline(always)]
    pub(super) fn forward(&self, re: &mut [Lanes], im: &mut [Lanes]) {
        for pass in &self.passes {
            pass.split(re, im);
        }
    }

    /// Spectra in scattered order to their columns, times the length.
    #[inline(always)]
    pub(super) fn inverse(&self, re: &mut [Lanes], im: &mut [Lanes]) {
        for pass in self.passes.iter().rev() {
            pass.join(re, im);
        }
    }

    /// Forward, times a spectrum in scattered order, and back, times the length.
    #[inline(always)]
    pub(super) fn filter(&self, re: &mut [Lanes], im: &mut [Lanes], by_re: &[Lanes], by_im: &[Lanes]) {
        let Some((last, passes)) = self.passes.split_last() else { return };
        for pass in passes {
            pass.split(re, im);
        }
        last.filter(re, im, by_re, by_im);
        for pass in passes.iter().rev() {
            pass.join(re, im);
        }
    }
}

impl Pass {
    fn new(radix: usize, block: usize) -> Pass {
        match radix {
            2 => Pass::Two(factors(block)),
            3 => Pass::Three(factors(block)),
            4 => Pass::Four(factors(block)),
            _ => Pass::Five(factors(block)),
        }
    }

    #[inline(always)]
    fn split(&self, re: &mut [Lanes], im: &mut [Lanes]) {
        match self {
            Pass::Two(factors) => split(re, im, factors, dft2),
            Pass::Three(factors) => split(re, im, factors, dft3),
            Pass::Four(factors) => split(re, im, factors, dft4),
            Pass::Five(factors) => split(re, im, factors, dft5),
        }
    }

    #[inline(always)]
    fn join(&self, re: &mut [Lanes], im: &mut [Lanes]) {
        // Swapping the parts before and after turns a forward transform into an inverse one.
        match self {
            Pass::Two(factors) => join(im, re, factors, dft2),
            Pass::Three(factors) => join(im, re, factors, dft3),
            Pass::Four(factors) => join(im, re, factors, dft4),
            Pass::Five(factors) => join(im, re, factors, dft5),
        }
    }

    /// For the last pass, whose factors are all 1.
    #[inline(always)]
    fn filter(&self, re: &mut [Lanes], im: &mut [Lanes], by_re: &[Lanes], by_im: &[Lanes]) {
        match self {
            Pass::Two(_) => filter(re, im, by_re, by_im, dft2),
            Pass::Three(_) => filter(re, im, by_re, by_im, dft3),
            Pass::Four(_) => filter(re, im, by_re, by_im, dft4),
            Pass::Five(_) => filter(re, im, by_re, by_im, dft5),
        }
    }
}

/// The radices of the passes for a length, `None` when it has other prime factors than 2, 3 and 5.
pub(super) fn radices(mut len: usize) -> Option<Vec<usize>> {
    let mut found = Vec::new();
    for radix in [4, 2, 3, 5] {
        while len > 1 && len.is_multiple_of(radix) {
            found.push(radix);
            len /= radix;
        }
    }
    (len == 1).then_some(found)
}

fn factors<const R: usize>(block: usize) -> Vec<[Complex; R]> {
    let factor = |turns: usize| {
        let (sin, cos) = (-TAU * turns as f64 / block as f64).sin_cos();
        [cos as f32, sin as f32]
    };
    (0..block / R).map(|j| std::array::from_fn(|k| factor(j * k))).collect()
}

/// A pass of the forward transform: small transforms, then factors.
#[inline(always)]
fn split<const R: usize>(
    re: &mut [Lanes],
    im: &mut [Lanes],
    factors: &[[Complex; R]],
    dft: impl Fn([Complex; R]) -> [Complex; R],
) {
    each(re, im, factors, |x, factors| {
        let mut y = dft(x);
        for k in 0..R {
            y[k] = times(y[k], factors[k]);
        }
        y
    });
}

/// A pass of the inverse transform: factors, then small transforms.
#[inline(always)]
fn join<const R: usize>(
    re: &mut [Lanes],
    im: &mut [Lanes],
    factors: &[[Complex; R]],
    dft: impl Fn([Complex; R]) -> [Complex; R],
) {
    each(re, im, factors, |mut x, factors| {
        for k in 0..R {
            x[k] = times(x[k], factors[k]);
        }
        dft(x)
    });
}

#[inline(always)]
fn each<const R: usize>(
    re: &mut [Lanes],
    im: &mut [Lanes],
    factors: &[[Complex; R]],
    step: impl Fn([Complex; R], &[Complex; R]) -> [Complex; R],
) {
    let span = factors.len();
    for (re, im) in re.chunks_exact_mut(R * span).zip(im.chunks_exact_mut(R * span)) {
        for (j, factors) in factors.iter().enumerate() {
            // Copied, so that the compiler sees that nothing read here is written before all lanes are done.
            let from_re: [Lanes; R] = std::array::from_fn(|k| re[j + k * span]);
            let from_im: [Lanes; R] = std::array::from_fn(|k| im[j + k * span]);
            let (mut to_re, mut to_im) = ([Lanes::ZERO; R], [Lanes::ZERO; R]);
            for lane in 0..LANES {
                let y = step(std::array::from_fn(|k| [from_re[k].0[lane], from_im[k].0[lane]]), factors);
                for k in 0..R {
                    (to_re[k].0[lane], to_im[k].0[lane]) = (y[k][0], y[k][1]);
                }
            }
            for k in 0..R {
                (re[j + k * span], im[j + k * span]) = (to_re[k], to_im[k]);
            }
        }
    }
}

/// Small transforms, products, and small transforms back.
#[inline(always)]
fn filter<const R: usize>(
    re: &mut [Lanes],
    im: &mut [Lanes],
    by_re: &[Lanes],
    by_im: &[Lanes],
    dft: impl Fn([Complex; R]) -> [Complex; R],
) {
    let (re, im) = (re.as_chunks_mut::<R>().0, im.as_chunks_mut::<R>().0);
    let by = by_re.as_chunks::<R>().0.iter().zip(by_im.as_chunks::<R>().0);
    for ((re, im), (by_re, by_im)) in re.iter_mut().zip(im).zip(by) {
        let (from_re, from_im) = (*re, *im);
        for lane in 0..LANES {
            let y = dft(std::array::from_fn(|k| [from_re[k].0[lane], from_im[k].0[lane]]));
            let z = dft(std::array::from_fn(|k| {
                let [re, im] = times(y[k], [by_re[k].0[lane], by_im[k].0[lane]]);
                [im, re]
            }));
            for k in 0..R {
                (re[k].0[lane], im[k].0[lane]) = (z[k][1], z[k][0]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(len: usize, seed: usize) -> Vec<Lanes> {
        let value = |i: usize| ((i * 2_654_435_761 + seed) >> 7 & 255) as f32 / 128.0 - 1.0;
        (0..len).map(|row| Lanes(std::array::from_fn(|lane| value(row * LANES + lane)))).collect()
    }

    /// `Σ a_{j+k} conj(b_k)`, around the end, in 64 bits.
    fn correlation(a: [&[Lanes]; 2], b: [&[Lanes]; 2], j: usize, lane: usize) -> [f64; 2] {
        let len = a[0].len();
        let at = |z: [&[Lanes]; 2], i: usize| z.map(|part| f64::from(part[i % len].0[lane]));
        (0..len).fold([0.0; 2], |sum, k| {
            let ([ar, ai], [br, bi]) = (at(a, j + k), at(b, k));
            [sum[0] + ar * br + ai * bi, sum[1] + ai * br - ar * bi]
        })
    }

    #[test]
    fn products_of_spectra_are_correlations() {
        for len in [2, 3, 4, 5, 16, 30, 48, 80, 144, 150] {
            let fft = Fft::new(len);
            let ([re, im], by) = ([noise(len, 1), noise(len, 77)], [noise(len, 5), noise(len, 9)]);
            let ([mut by_re, mut by_im], [mut got_re, mut got_im]) = (by.clone(), [re.clone(), im.clone()]);
            fft.forward(&mut by_re, &mut by_im);
            by_im.iter_mut().for_each(|row| row.0.iter_mut().for_each(|v| *v = -*v));
            fft.filter(&mut got_re, &mut got_im, &by_re, &by_im);
            for (j, lane) in [(0, 0), (1, 3), (len / 2, 15), (len - 1, 8)] {
                let expected = correlation([&re, &im], [&by[0], &by[1]], j, lane);
                for (got, expected) in [(got_re[j].0[lane], expected[0]), (got_im[j].0[lane], expected[1])] {
                    let got = f64::from(got) / len as f64;
                    assert!((got - expected).abs() < 1e-4, "{got} for {expected}, length {len}, row {j}");
                }
            }
        }
    }

    #[test]
    fn the_inverse_takes_back() {
        for len in [2, 3, 4, 5, 48, 150] {
            let (re, im) = (noise(len, 1), noise(len, 77));
            let (mut got_re, mut got_im) = (re.clone(), im.clone());
            Fft::new(len).forward(&mut got_re, &mut got_im);
            Fft::new(len).inverse(&mut got_re, &mut got_im);
            for (got, expected) in got_re.iter().chain(&got_im).zip(re.iter().chain(&im)) {
                assert!((got.0[6] / len as f32 - expected.0[6]).abs() < 1e-5, "length {len}");
            }
        }
    }

    #[test]
    fn the_sum_comes_first() {
        let mut re = noise(60, 4);
        let sum: f32 = re.iter().map(|row| row.0[7]).sum();
        Fft::new(60).forward(&mut re, &mut noise(60, 8));
        assert!((re[0].0[7] - sum).abs() < 1e-4);
    }

    #[test]
    fn lengths_have_small_factors_only() {
        assert_eq!(radices(240), Some(vec![4, 4, 3, 5]));
        assert_eq!(radices(1), Some(vec![]));
        assert_eq!(radices(112), None);
    }
}
