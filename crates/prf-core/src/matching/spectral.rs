//! Correlation by Fourier transforms, for all but small templates.
//!
//! A tile is transformed column by column, sixteen columns at a time; then, written down transposed, row by row,
//! sixteen rows at a time. Each such strip stays in the fastest cache through all passes of its transform. Two tiles
//! travel as the real and the imaginary part of one: the template is real, so correlation keeps them apart.

use super::fft::{Fft, LANES, Lanes};
use super::plan::Tiling;
use super::template::Template;
use super::tiles::{FrameTiles, Map, Source, TemplateTile, transpose};
use crate::FrameView;
use crate::simd::{Kernel, Simd};

/// How far a correlation may be from the exact one, in units of `‖I − c‖ ‖T − t₀‖` with the norms of a pair of tiles
/// and of the template. Ten times what was ever seen, see the test.
const ERROR: f64 = 4e-7;

/// Complex numbers, in groups of sixteen.
#[derive(Clone, Debug)]
struct Complexes {
    re: Vec<Lanes>,
    im: Vec<Lanes>,
}

impl Complexes {
    fn new(groups: usize) -> Complexes {
        Complexes { re: vec![Lanes::ZERO; groups], im: vec![Lanes::ZERO; groups] }
    }
}

/// The template's spectrum for one size of tiles, and working memory.
#[derive(Clone, Debug)]
pub(super) struct Spectral {
    tiling: Tiling,
    down: Fft,
    across: Fft,
    /// Sixteen columns of a tile.
    strip: Complexes,
    /// A tile transformed along its columns; `[row / 16, column]`, each a group of sixteen rows.
    tile: Complexes,
    /// Complex conjugate of the template's spectrum, divided by the size of a tile, in the order of `tile`.
    spectrum: Complexes,
    /// `‖T − t₀‖`
    norm: f64,
}

impl Spectral {
    pub(super) fn new(tiling: Tiling, template: &Template, simd: Simd) -> Spectral {
        let [height, width] = tiling.shape;
        let groups = height / LANES * width;
        let mut spectral = Spectral {
            tiling,
            down: Fft::new(height),
            across: Fft::new(width),
            strip: Complexes::new(height),
            tile: Complexes::new(groups),
            spectrum: Complexes::new(groups),
            norm: template.kernel().iter().map(|&v| f64::from(v).powi(2)).sum::<f64>().sqrt(),
        };
        simd.run(Prepare { spectral: &mut spectral, template });
        spectral
    }

    /// Transforms a tile along its columns.
    #[inline(always)]
    fn transform_columns(&mut self, source: &mut impl Source) {
        let [height, width] = self.tiling.shape;
        for x in (0..width).step_by(LANES) {
            for y in 0..height {
                [self.strip.re[y], self.strip.im[y]] = source.lanes(y, x);
            }
            self.down.forward(&mut self.strip.re, &mut self.strip.im);
            for (from, to) in [(&self.strip.re, &mut self.tile.re), (&self.strip.im, &mut self.tile.im)] {
                for (rows, group) in from.as_chunks().0.iter().zip(to.chunks_exact_mut(width)) {
                    if let Some(columns) = group[x..].first_chunk_mut() {
                        transpose(rows, columns);
                    }
                }
            }
        }
    }

    /// Multiplies the tile's spectrum with the template's; before and after it is transformed along its columns alone.
    #[inline(always)]
    fn multiply(&mut self) {
        let width = self.tiling.shape[1];
        let tile = self.tile.re.chunks_exact_mut(width).zip(self.tile.im.chunks_exact_mut(width));
        let spectrum = self.spectrum.re.chunks_exact(width).zip(self.spectrum.im.chunks_exact(width));
        for ((re, im), (by_re, by_im)) in tile.zip(spectrum) {
            self.across.filter(re, im, by_re, by_im);
        }
    }

    /// Transforms the columns back and writes the windows of both tiles to the map.
    #[inline(always)]
    fn store(&mut self, origins: [Option<[usize; 2]>; 2], map: &mut Map<'_>) {
        let width = self.tiling.shape[1];
        for x in (0..self.tiling.step[1]).step_by(LANES) {
            for (from, to) in [(&self.tile.re, &mut self.strip.re), (&self.tile.im, &mut self.strip.im)] {
                for (group, rows) in from.chunks_exact(width).zip(to.as_chunks_mut().0) {
                    if let Some(columns) = group[x..].first_chunk() {
                        transpose(columns, rows);
                    }
                }
            }
            self.down.inverse(&mut self.strip.re, &mut self.strip.im);
            for (origin, rows) in origins.into_iter().zip([&self.strip.re, &self.strip.im]) {
                if let Some([top, left]) = origin {
                    let columns = (self.tiling.step[1] - x).min(LANES);
                    map.write([top, left + x], columns, &rows[..self.tiling.step[0]]);
                }
            }
        }
    }
}

/// Fills in the template's spectrum.
struct Prepare<'a> {
    spectral: &'a mut Spectral,
    template: &'a Template,
}

impl Kernel for Prepare<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Prepare { spectral, template } = self;
        let [height, width] = spectral.tiling.shape;
        spectral.transform_columns(&mut TemplateTile { template });
        let (tile, spectrum) = (&mut spectral.tile, &mut spectral.spectrum);
        for (re, im) in tile.re.chunks_exact_mut(width).zip(tile.im.chunks_exact_mut(width)) {
            spectral.across.forward(re, im);
        }
        let unit = 1.0 / (height * width) as f32;
        for (to, from, unit) in [(&mut spectrum.re, &tile.re, unit), (&mut spectrum.im, &tile.im, -unit)] {
            to.iter_mut().zip(from).for_each(|(to, from)| *to = Lanes(from.0.map(|v| v * unit)));
        }
    }
}

/// Writes `Σ (I − centre)(T − t₀)` of every window to `map` and returns how far each may be off.
pub(super) struct Correlate<'a> {
    pub(super) spectral: &'a mut Spectral,
    pub(super) frame: FrameView<'a>,
    pub(super) centre: f32,
    /// Windows in a row of the map.
    pub(super) windows: usize,
    pub(super) map: &'a mut [f32],
}

impl Kernel for Correlate<'_> {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        let Correlate { spectral, frame, centre, windows, map } = self;
        let mut map = Map { windows, scores: map };
        let mut largest = 0.0f64;
        for pair in 0..spectral.tiling.pairs() {
            let origins = [2 * pair, 2 * pair + 1].map(|index| spectral.tiling.origin(index));
            let mut tiles = FrameTiles { frame, centre, origins, squares: Lanes::ZERO };
            spectral.transform_columns(&mut tiles);
            spectral.multiply();
            spectral.store(origins, &mut map);
            largest = largest.max(tiles.squares.0.iter().map(|&v| f64::from(v)).sum());
        }
        ERROR * largest.sqrt() * spectral.norm
    }
}
