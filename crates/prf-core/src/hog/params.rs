//! What a HOG can be told, as it stands in a configuration file.

use serde::{Deserialize, Serialize};

use crate::Error;

const MAX_ORIENTATIONS: usize = 64;

/// Parameters of a HOG (paper, section "HOG features"). In a file, every key may be left out.
///
/// ```
/// use prf_core::{CellSize, HogParams, Norm};
/// let params: HogParams = serde_json::from_str(r#"{ "cell": { "px": 8 }, "norm": "l2-hys" }"#)?;
/// assert_eq!((params.cell, params.norm), (CellSize::Px(8), Norm::L2Hys));
/// assert_eq!(params.orientations, 9);
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct HogParams {
    /// Bins of a histogram, 1 to 64.
    pub orientations: usize,
    /// Whether bins cover the full turn (dark to light is told from light to dark) or, as usual,
    /// half of it.
    pub signed: bool,
    /// Side of a cell.
    pub cell: CellSize,
    /// Cells on the side of a block, over which histograms are normalised; at least 1.
    pub block_cells: usize,
    /// How a block is normalised.
    pub norm: Norm,
}

impl Default for HogParams {
    /// 9 unsigned orientations, cells of 0.03 of the height, blocks of one cell, L2.
    fn default() -> HogParams {
        HogParams { orientations: 9, signed: false, cell: CellSize::Fraction(0.03), block_cells: 1, norm: Norm::L2 }
    }
}

impl HogParams {
    /// Checks every parameter's range.
    ///
    /// # Errors
    ///
    /// [`Error::InvalidParam`] with the key of the first parameter that is out of range.
    pub fn validate(&self) -> Result<(), Error> {
        if !(1..=MAX_ORIENTATIONS).contains(&self.orientations) {
            let expected = format!("1 to {MAX_ORIENTATIONS}");
            return Err(Error::invalid("orientations", &self.orientations, expected));
        }
        if self.block_cells == 0 {
            return Err(Error::invalid("block_cells", &0, "at least 1"));
        }
        self.cell.validate()
    }
}

/// Side of a cell: fixed, or following the height of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CellSize {
    /// This many pixels, at least 1.
    Px(usize),
    /// This part of the picture's height, above 0 and at most 1.
    Fraction(f32),
}

impl CellSize {
    /// Side in pixels for a picture of this height: a fraction gives `max(1, ⌊fraction · height⌋)`.
    ///
    /// ```
    /// use prf_core::CellSize;
    /// assert_eq!(CellSize::Fraction(0.03).cell_px(84), 2);
    /// assert_eq!(CellSize::Fraction(0.03).cell_px(100), 3);
    /// assert_eq!(CellSize::Fraction(0.03).cell_px(10), 1);
    /// ```
    #[must_use]
    pub fn cell_px(self, height: usize) -> usize {
        match self {
            CellSize::Px(px) => px,
            CellSize::Fraction(fraction) => {
                // 0.03 as f32 lies just under 0.03, yet 0.03 of 100 shall be 3.
                let nudge = 1.0 + 1e-6;
                let px = f64::from(fraction) * height as f64 * nudge;
                (px.floor() as usize).max(1)
            }
        }
    }

    fn validate(self) -> Result<(), Error> {
        match self {
            CellSize::Px(0) => Err(Error::invalid("cell.px", &0, "at least 1")),
            // Written so that NaN is refused too.
            CellSize::Fraction(f) if !(f > 0.0 && f <= 1.0) => {
                Err(Error::invalid("cell.fraction", &f, "above 0 and at most 1"))
            }
            _ => Ok(()),
        }
    }
}

/// How the histograms `v` of a block are normalised, with `ε = 1e-5`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Norm {
    /// Not at all: `v`.
    None,
    /// `v / (‖v‖₁ + ε)`
    L1,
    /// `√(v / (‖v‖₁ + ε))`
    L1Sqrt,
    /// `v / √(‖v‖₂² + ε²)`
    L2,
    /// L2, cut off at 0.2, and L2 again.
    L2Hys,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(params: HogParams) -> String {
        params.validate().expect_err("out of range").to_string()
    }

    #[test]
    fn parameters_out_of_range_are_named() {
        let default = HogParams::default();
        default.validate().expect("the default is valid");
        for orientations in [0, 65] {
            assert!(refused(HogParams { orientations, ..default }).starts_with("orientations: got "));
        }
        assert!(refused(HogParams { block_cells: 0, ..default }).starts_with("block_cells: got 0"));
        assert!(refused(HogParams { cell: CellSize::Px(0), ..default }).starts_with("cell.px: got 0"));
        for fraction in [0.0, -0.1, 1.01, f32::NAN, f32::INFINITY] {
            let cell = CellSize::Fraction(fraction);
            assert!(refused(HogParams { cell, ..default }).starts_with("cell.fraction: got "));
        }
    }

    #[test]
    fn an_unknown_key_is_refused() {
        let read = |json| serde_json::from_str::<HogParams>(json);
        let error = read(r#"{ "orientation": 9 }"#).expect_err("a misspelt key").to_string();
        assert!(error.contains("unknown field `orientation`, expected one of `orientations`"), "{error}");
        assert!(read(r#"{ "cell": { "px": 8, "fraction": 0.1 } }"#).is_err());
        assert!(read(r#"{ "cell": { "pixels": 8 } }"#).is_err());
        assert!(read(r#"{ "norm": "L2" }"#).is_err());
    }

    #[test]
    fn every_value_survives_a_file() {
        for norm in [Norm::None, Norm::L1, Norm::L1Sqrt, Norm::L2, Norm::L2Hys] {
            for cell in [CellSize::Px(3), CellSize::Fraction(0.25)] {
                let params = HogParams { norm, cell, ..HogParams::default() };
                let json = serde_json::to_string(&params).expect("plain values");
                assert_eq!(serde_json::from_str::<HogParams>(&json).expect("what was written"), params);
            }
        }
        assert_eq!(serde_json::to_string(&Norm::L1Sqrt).expect("a plain value"), r#""l1-sqrt""#);
    }

    #[test]
    fn a_fraction_that_should_give_a_whole_number_does() {
        for (fraction, height, px) in [(0.03, 100, 3), (0.1, 70, 7), (0.07, 100, 7), (0.29, 100, 29), (0.3, 10, 3)] {
            assert_eq!(CellSize::Fraction(fraction).cell_px(height), px, "{fraction} of {height}");
        }
        assert_eq!(CellSize::Fraction(1.0).cell_px(9), 9);
    }
}
