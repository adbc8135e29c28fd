//! What must hold for any picture and any parameters.
#![expect(clippy::unwrap_used, reason = "a test may stop at the first surprise")]

use prf_core::{
    CellSize, DirectDescriptor, DistanceScale, Frame, Hog, HogLayout, HogParams, Norm, Plane, RewardParams, Score,
    TaskDescriptor, crop_box,
};
use proptest::prelude::*;

/// Bytes with enough black and enough equal neighbours for every special case to turn up.
fn pixel() -> impl Strategy<Value = u8> {
    prop_oneof![3 => Just(0u8), 1 => Just(200), 1 => Just(255), 3 => any::<u8>()]
}

fn frame(sides: std::ops::Range<usize>) -> impl Strategy<Value = Frame> {
    (sides.clone(), sides).prop_flat_map(|(width, height)| {
        prop::collection::vec(pixel(), width * height)
            .prop_map(move |pixels| Frame::from_vec(width, height, pixels).unwrap())
    })
}

fn norm() -> impl Strategy<Value = Norm> {
    prop::sample::select(vec![Norm::None, Norm::L1, Norm::L1Sqrt, Norm::L2, Norm::L2Hys])
}

fn scale() -> impl Strategy<Value = DistanceScale> {
    use DistanceScale::{None, SqrtBlocks, SqrtFeatures};
    prop::sample::select(vec![None, SqrtBlocks, SqrtFeatures])
}

fn cell() -> impl Strategy<Value = CellSize> {
    prop_oneof![(1usize..5).prop_map(CellSize::Px), (0.01f32..=1.0).prop_map(CellSize::Fraction)]
}

prop_compose! {
    fn hog_params()(
        orientations in 1usize..=20,
        signed: bool,
        cell in cell(),
        block_cells in 1usize..4,
        norm in norm(),
    ) -> HogParams {
        HogParams { orientations, signed, cell, block_cells, norm }
    }
}

/// Parameters under which any goal is large enough: blocks of one cell of 1 px.
fn reward_params() -> impl Strategy<Value = RewardParams> {
    let small = |hog| HogParams { cell: CellSize::Fraction(0.03), block_cells: 1, ..hog };
    (hog_params(), scale()).prop_map(move |(hog, scale)| RewardParams { hog: small(hog), scale })
}

fn score(goal: &Frame, frame: &Frame, params: RewardParams) -> Score {
    DirectDescriptor::new(goal, params).unwrap().observe(frame.view()).unwrap()
}

fn hog(image: &Frame, params: HogParams) -> Option<(HogLayout, Vec<f32>)> {
    let mut features = Vec::new();
    let layout = Hog::new(params).unwrap().compute_bytes_into(image.view(), &mut features).ok()?;
    Some((layout, features))
}

/// The frame inside a larger black one, its top left corner at (`x`, `y`).
fn placed(frame: &Frame, x: usize, y: usize, width: usize, height: usize) -> Frame {
    let mut large = Frame::new(width, height);
    for row in 0..frame.height() {
        large.row_mut(y + row)[x..x + frame.width()].copy_from_slice(frame.row(row));
    }
    large
}

/// Histograms of cells by the book: arc tangent, degrees, floor, all in 64 bits.
fn plain_histograms(image: &Frame, params: HogParams, layout: &HogLayout) -> Vec<f64> {
    let at = |x: usize, y: usize| f64::from(image.row(y)[x]);
    let span = if params.signed { 360.0 } else { 180.0 };
    let ([rows, columns], cell) = (layout.cells(), layout.cell_px());
    let mut histograms = vec![0.0; rows * columns * params.orientations];
    for (y, x) in (0..rows * cell).flat_map(|y| (0..columns * cell).map(move |x| (y, x))) {
        let inside = |i: usize, len: usize| 0 < i && i + 1 < len;
        let dx = if inside(x, image.width()) { at(x + 1, y) - at(x - 1, y) } else { 0.0 };
        let dy = if inside(y, image.height()) { at(x, y + 1) - at(x, y - 1) } else { 0.0 };
        let degrees = (dy.atan2(dx) * (180.0 / std::f64::consts::PI)).rem_euclid(span);
        let reached = |&k: &usize| degrees >= span * k as f64 / params.orientations as f64;
        let bin = (1..params.orientations).filter(reached).count();
        let histogram = (y / cell * columns + x / cell) * params.orientations;
        histograms[histogram + bin] += dx.hypot(dy) / 255.0 / (cell * cell) as f64;
    }
    histograms
}

proptest! {
    #[test]
    fn histograms_are_those_of_the_arc_tangent(image in frame(1..20), params in hog_params()) {
        let params = HogParams { norm: Norm::None, block_cells: 1, ..params };
        if let Some((layout, features)) = hog(&image, params) {
            let expected = plain_histograms(&image, params, &layout);
            prop_assert_eq!(features.len(), expected.len());
            for (got, expected) in features.iter().zip(expected) {
                prop_assert!((f64::from(*got) - expected).abs() < 1e-5, "{got} for {expected}");
            }
        }
    }

    #[test]
    fn features_are_finite_and_within_the_norms_bounds(image in frame(1..20), params in hog_params()) {
        if let Some((layout, features)) = hog(&image, params) {
            prop_assert_eq!(features.len(), layout.len());
            let most = if params.norm == Norm::None { f32::sqrt(2.0) } else { 1.0 } + 1e-5;
            prop_assert!(features.iter().all(|v| (0.0..=most).contains(v)));
            for block in features.chunks_exact(layout.block_len()) {
                let l1: f32 = block.iter().sum();
                let l2: f32 = block.iter().map(|v| v * v).sum();
                prop_assert!(params.norm != Norm::L1 || l1 <= 1.0 + 1e-5);
                prop_assert!(params.norm == Norm::None || l2 <= 1.0 + 1e-5);
            }
        }
    }

    #[test]
    fn bytes_and_floats_agree(image in frame(2..20), params in hog_params()) {
        // With borders at 45° a float that is off by a bit falls into the next bin; bytes don't.
        prop_assume!(params.orientations % 4 != 0);
        if let Some((_, bytes)) = hog(&image, params) {
            let mut floats = Vec::new();
            let plane = Plane::from_frame(image.view());
            Hog::new(params).unwrap().compute_into(plane.view(), &mut floats).unwrap();
            // L1-sqrt has no finite slope at 0, so its square is compared.
            let power = if params.norm == Norm::L1Sqrt { 2 } else { 1 };
            for (a, b) in bytes.iter().zip(&floats) {
                prop_assert!((a.powi(power) - b.powi(power)).abs() < 5e-5, "{a} and {b}");
            }
        }
    }

    #[test]
    fn a_mirrored_picture_gives_mirrored_cell_energies(
        rows in 1usize..5, columns in 1usize..5, cell in 1usize..6, seed in any::<u64>(),
    ) {
        let (width, height) = (columns * cell, rows * cell);
        let noise = |i: usize| (seed.wrapping_mul(2 * i as u64 + 1) >> 56) as u8;
        let image = Frame::from_vec(width, height, (0..width * height).map(noise).collect()).unwrap();
        let mut mirrored = image.clone();
        (0..height).for_each(|y| mirrored.row_mut(y).reverse());
        let params = HogParams { cell: CellSize::Px(cell), norm: Norm::None, ..HogParams::default() };
        let energies = |image: &Frame| -> Vec<f32> {
            let (_, features) = hog(image, params).unwrap();
            features.chunks_exact(9).map(|histogram| histogram.iter().sum()).collect()
        };
        let (plain, mirrored) = (energies(&image), energies(&mirrored));
        for (a, b) in plain.chunks_exact(columns).zip(mirrored.chunks_exact(columns)) {
            for (a, b) in a.iter().zip(b.iter().rev()) {
                prop_assert!((a - b).abs() < 1e-5, "{a} and {b}");
            }
        }
    }

    #[test]
    fn a_reward_lies_above_0_and_is_1_for_the_goal(goal in frame(1..24), params in reward_params()) {
        let same = score(&goal, &goal, params);
        prop_assert_eq!(same, Score { reward: 1.0, distance: 0.0 });
    }

    #[test]
    fn a_distance_is_symmetric(a in frame(1..24), b in frame(1..24), params in reward_params()) {
        let (ab, ba) = (score(&a, &b, params), score(&b, &a, params));
        prop_assert_eq!(ab, ba);
        prop_assert!(ab.distance >= 0.0 && ab.distance.is_finite());
        prop_assert!(ab.reward > 0.0 && ab.reward <= 1.0);
    }

    #[test]
    fn no_frame_is_refused(goal in frame(8..16), other in frame(1..40), hog in hog_params(), scale in scale()) {
        if let Ok(mut descriptor) = DirectDescriptor::new(&goal, RewardParams { hog, scale }) {
            let score = descriptor.observe(other.view()).unwrap();
            prop_assert!(score.reward > 0.0 && score.reward <= 1.0, "{score:?}");
        }
    }

    #[test]
    fn a_score_does_not_depend_on_what_was_scored_before(
        goal in frame(4..12), frames in prop::collection::vec(frame(1..30), 1..25), params in reward_params(),
    ) {
        let mut kept = DirectDescriptor::new(&goal, params).unwrap();
        for frame in frames.iter().chain(&frames) {
            prop_assert_eq!(kept.observe(frame.view()).unwrap(), score(&goal, frame, params));
        }
    }

    #[test]
    fn a_crop_cannot_be_cropped_further(image in frame(1..24)) {
        let crop = crop_box(image.view());
        let mut inner = Frame::new(crop.width, crop.height);
        for y in 0..crop.height {
            inner.row_mut(y).copy_from_slice(&image.row(crop.y + y)[crop.x..crop.x + crop.width]);
        }
        let again = crop_box(inner.view());
        prop_assert_eq!((again.x, again.y), (0, 0));
        prop_assert_eq!((again.width, again.height), (crop.width, crop.height));
        // Nothing but black was cut away.
        let light = |frame: &Frame| frame.as_slice().iter().filter(|&&v| v != 0).count();
        prop_assert_eq!(light(&inner), light(&image));
    }

    #[test]
    fn where_the_picture_stands_does_not_matter(
        goal in frame(2..12), image in frame(2..12), x in 0usize..9, y in 0usize..9, params in reward_params(),
    ) {
        prop_assume!(image.as_slice().iter().any(|&v| v != 0));
        let here = placed(&image, 0, 0, 24, 24);
        let there = placed(&image, x, y, 24, 24);
        prop_assert_eq!(score(&goal, &here, params), score(&goal, &there, params));
    }
}
