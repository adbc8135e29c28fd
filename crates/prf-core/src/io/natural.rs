//! Names in the order in which people count: `frame2` before `frame10`.

use std::cmp::Ordering;

/// Compares names by their bytes, but numbers in them by their value. Names that differ only in zeros
/// before a number are compared by bytes alone, so that only equal names are equal.
pub(super) fn compare(a: &[u8], b: &[u8]) -> Ordering {
    let (mut left, mut right) = (a, b);
    while let (Some(x), Some(y)) = (left.first(), right.first()) {
        let order = if x.is_ascii_digit() && y.is_ascii_digit() {
            compare_numbers(take_number(&mut left), take_number(&mut right))
        } else {
            (left, right) = (&left[1..], &right[1..]);
            x.cmp(y)
        };
        if order.is_ne() {
            return order;
        }
    }
    left.len().cmp(&right.len()).then_with(|| a.cmp(b))
}

/// The digits that `bytes` begins with, without zeros before them; `bytes` goes on behind.
fn take_number<'a>(bytes: &mut &'a [u8]) -> &'a [u8] {
    let len = bytes.iter().take_while(|byte| byte.is_ascii_digit()).count();
    let (digits, rest) = bytes.split_at(len);
    *bytes = rest;
    let zeros = digits.iter().take_while(|&&digit| digit == b'0').count();
    &digits[zeros..]
}

/// Of any length, so that no number is too large.
fn compare_numbers(a: &[u8], b: &[u8]) -> Ordering {
    a.len().cmp(&b.len()).then_with(|| a.cmp(b))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn numbers_are_compared_by_their_value() {
        let ordered = [
            "S005_001_00000001.png",
            "S005_001_00000011.png",
            "S005_002_00000001.png",
            "S010_001_00000001.png",
            "frame.png",
            "frame002.png",
            "frame2.png",
            "frame2b.png",
            "frame10.png",
            "frame99999999999999999999999.png",
            "frame100000000000000000000000.png",
            "frames.png",
        ];
        for (i, a) in ordered.iter().enumerate() {
            for (j, b) in ordered.iter().enumerate() {
                assert_eq!(compare(a.as_bytes(), b.as_bytes()), i.cmp(&j), "{a} and {b}");
            }
        }
    }

    proptest! {
        #[test]
        fn it_is_an_order(names in prop::collection::vec("[0-2a./é]{0,5}", 3)) {
            let compare = |i: usize, j: usize| compare(names[i].as_bytes(), names[j].as_bytes());
            prop_assert_eq!(compare(0, 1), compare(1, 0).reverse());
            prop_assert_eq!(compare(0, 1).is_eq(), names[0] == names[1]);
            if compare(0, 1).is_le() && compare(1, 2).is_le() {
                prop_assert!(compare(0, 2).is_le());
            }
        }

        #[test]
        fn counted_names_are_in_the_order_of_counting(a: u32, b: u32, width in 0usize..12) {
            let name = |i: u32| format!("S1_{i:0width$}.png").into_bytes();
            prop_assert_eq!(compare(&name(a), &name(b)), a.cmp(&b));
        }
    }
}
