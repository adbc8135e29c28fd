//! Pictures of all shapes, as goals may have them.

use prf_core::Frame;
use proptest::prelude::*;

/// A picture with sides of 1 to `most`: a pixel, a row, a column, or any size; noise, many equal neighbours, one grey
/// all over, or black.
pub(crate) fn any_shape(most: usize) -> impl Strategy<Value = Frame> {
    let sides = prop_oneof![
        1 => Just((1, 1)),
        1 => (1..=most).prop_map(|width| (width, 1)),
        1 => (1..=most).prop_map(|height| (1, height)),
        4 => (1..=most, 1..=most),
    ];
    sides.prop_flat_map(|(width, height)| {
        let many = width * height;
        let drawn = prop_oneof![3 => Just(0u8), 1 => Just(200), 1 => Just(255), 2 => any::<u8>()];
        let pixels = prop_oneof![
            2 => prop::collection::vec(any::<u8>(), many),
            3 => prop::collection::vec(drawn, many),
            1 => any::<u8>().prop_map(move |grey| vec![grey; many]),
            1 => Just(vec![0; many]),
        ];
        pixels.prop_map(move |pixels| Frame::from_vec(width, height, pixels).unwrap())
    })
}
