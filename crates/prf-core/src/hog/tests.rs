//! Bins by hand, and every instruction set of this machine.

use super::*;
use crate::region::Region;

/// A 3×3 picture, as one cell, whose centre has this gradient and no other pixel a slanted one.
fn bin_of(dx: i16, dy: i16, orientations: usize, signed: bool) -> usize {
    let towards = |d: i16| (d.max(0) as u8, (-d).max(0) as u8);
    let ((right, left), (below, above)) = (towards(dx), towards(dy));
    let mut pixels = [0; 9];
    (pixels[1], pixels[3], pixels[5], pixels[7]) = (above, left, right, below);
    let image = FrameView::new(3, 3, &pixels).expect("3 x 3 pixels");
    let params = HogParams { orientations, signed, cell: CellSize::Px(1), norm: Norm::None, ..HogParams::default() };
    let mut features = Vec::new();
    Hog::new(params).expect("valid").compute_bytes_into(image, &mut features).expect("a cell fits");
    let centre = &features[4 * orientations..5 * orientations];
    centre.iter().position(|&v| v > 0.0).expect("a gradient")
}

#[test]
fn a_direction_on_a_border_belongs_to_the_bin_that_begins_there() {
    let eighths = [(9, 0), (9, 9), (0, 9), (-9, 9), (-9, 0), (-9, -9), (0, -9), (9, -9)];
    for length in [1, 7, 28] {
        for (eighth, (dx, dy)) in eighths.into_iter().enumerate() {
            let (dx, dy) = (dx * length, dy * length);
            assert_eq!(bin_of(dx, dy, 8, true), eighth, "{dx}, {dy}");
            assert_eq!(bin_of(dx, dy, 4, false), eighth % 4, "{dx}, {dy}");
        }
    }
}

#[test]
fn a_negative_zero_is_a_zero() {
    let params = HogParams { orientations: 4, cell: CellSize::Px(1), norm: Norm::None, ..HogParams::default() };
    let hog = |above: f32| {
        let pixels = [0.0, above, 0.0, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0];
        let mut features = Vec::new();
        let image = PlaneView::new(3, 3, &pixels).expect("finite");
        Hog::new(params).expect("valid").compute_into(image, &mut features).expect("a cell fits");
        features
    };
    assert_eq!(hog(0.0)[4 * 4..5 * 4], [1.0, 0.0, 0.0, 0.0]);
    assert_eq!(hog(-0.0), hog(0.0));
}

/// Every instruction set of this machine gives the same bits.
#[test]
fn all_instruction_sets_give_the_same_bits() {
    let noise = |i: usize| ((i + 1) * 2_654_435_761) >> 11;
    let shapes = [[1, 1], [3, 2], [17, 66], [64, 64], [40, 131], [151, 90]];
    let norms = [Norm::None, Norm::L1, Norm::L1Sqrt, Norm::L2, Norm::L2Hys];
    for (i, [height, width]) in shapes.into_iter().cycle().take(300).enumerate() {
        let pixels: Vec<u8> = (0..width * height).map(|i| noise(i) as u8 & [255, 3][i % 2]).collect();
        let plane: Vec<f32> = pixels.iter().map(|&v| f32::from(v) / 255.0).collect();
        let params = HogParams {
            orientations: [9, 9, 1, 4, 16][noise(i) % 5],
            signed: i % 3 == 0,
            cell: CellSize::Px([1, 2, 3, 4, 5, 7, 8, 12, 15, 33, 70, 90][noise(i) / 7 % 12].min(height.min(width))),
            block_cells: 1,
            norm: norms[i % 5],
        };
        let larger = HogParams { block_cells: 1 + noise(i) / 3 % 3, ..params };
        let params = if HogLayout::new(&larger, width, height).is_ok() { larger } else { params };
        let layout = HogLayout::new(&params, width, height).expect("a block fits");
        let (mut expected, mut features) = ([Vec::new(), Vec::new()], Vec::new());
        for simd in Simd::available() {
            let mut hog = Hog { simd, ..Hog::new(params).expect("valid") };
            for (kind, expected) in expected.iter_mut().enumerate() {
                match kind {
                    0 => hog.compute(&layout, Region::whole(width, height, &pixels), &mut features),
                    _ => hog.compute(&layout, Region::whole(width, height, &plane), &mut features),
                }
                let bits: Vec<u32> = features.iter().map(|v| v.to_bits()).collect();
                if expected.is_empty() {
                    expected.clone_from(&bits);
                }
                assert!(bits == *expected, "{simd:?}, {width}x{height}, {params:?}");
            }
        }
    }
}

#[test]
fn signs_count_only_where_asked() {
    // 30°, 150°, 210° and 330°, in 3 bins of the full turn and of half of it.
    let directions = [(173, 100), (-173, 100), (-173, -100), (173, -100)];
    let bins = |signed| directions.map(|(dx, dy)| bin_of(dx, dy, 3, signed));
    assert_eq!(bins(true), [0, 1, 1, 2]);
    assert_eq!(bins(false), [0, 2, 0, 2]);
}

#[test]
fn pixels_beyond_the_last_whole_cell_have_no_vote() {
    let params = HogParams { cell: CellSize::Px(4), norm: Norm::None, ..HogParams::default() };
    let mut hog = Hog::new(params).expect("valid parameters");
    let mut features = Vec::new();
    let mut pixels = [0; 49];
    pixels[5 * 7 + 6] = 255; // seen by the gradients of its neighbours alone, all beyond column 4
    let image = FrameView::new(7, 7, &pixels).expect("7 x 7 pixels");
    let layout = hog.compute_bytes_into(image, &mut features).expect("a cell fits");
    assert_eq!(layout.cells(), [1, 1]);
    assert_eq!(features, [0.0; 9]);
}
