//! The meaning of a seed must never change.

use std::collections::HashSet;

use prf_envs::Error;
use prf_envs::rng::{below, restore, save, stream, unit_f32};
use rand_core::Rng;

/// The numbers come from an implementation of ChaCha8 that shares no code with the crate's.
#[test]
fn streams_keep_their_numbers() {
    let first = |seed, purpose, index| stream(seed, purpose, index).next_u64();
    assert_eq!(
        [first(0, "a", 0), first(1, "a", 0), first(0, "b", 0), first(0, "a", 1), first(u64::MAX, "breakout-launch", 9)],
        [
            6_361_988_922_492_210_370,
            16_548_846_477_325_878_073,
            4_808_082_005_549_982_583,
            17_047_913_048_690_009_640,
            4_786_377_655_549_930_007
        ]
    );
    let mut rng = stream(42, "golden", 0);
    let mut drawn = Vec::new();
    drawn.resize_with(8, || below(&mut rng, 1000));
    assert_eq!(drawn, [242, 660, 958, 49, 819, 541, 991, 273]);
    assert_eq!(unit_f32(&mut rng), 0.827_580_63);
}

#[test]
fn streams_differ_by_every_part_of_their_key() {
    let mut seen = HashSet::new();
    for seed in [0, 1, u64::MAX] {
        for purpose in ["a", "b", "aa", "sixteen letters!"] {
            for index in [0, 1, u64::MAX] {
                assert!(seen.insert(stream(seed, purpose, index).next_u64()), "{seed} {purpose} {index}");
            }
        }
    }
}

#[test]
fn below_is_even_and_in_range() {
    let mut rng = stream(0, "even", 0);
    for n in [1, 2, 3, 7, 10] {
        let mut counts = vec![0u32; n];
        for _ in 0..10_000 {
            counts[below(&mut rng, n)] += 1;
        }
        let mean = 10_000.0 / n as f64;
        assert!(counts.iter().all(|&count| (f64::from(count) - mean).abs() < 5.0 * mean.sqrt()), "{n}: {counts:?}");
    }
    // So large that nearly half of all draws have to be rejected.
    let large = usize::MAX / 2 + 2;
    assert!((0..100).all(|_| below(&mut rng, large) < large));
}

#[test]
fn unit_stays_below_one() {
    let mut rng = stream(0, "unit", 0);
    let values: Vec<_> = (0..100_000).map(|_| unit_f32(&mut rng)).collect();
    assert!(values.iter().all(|value| (0.0..1.0).contains(value)));
    let mean = values.iter().sum::<f32>() / values.len() as f32;
    assert!((mean - 0.5).abs() < 0.01, "{mean}");
}

#[test]
fn a_restored_stream_goes_on() -> Result<(), Error> {
    let mut rng = stream(3, "restore", 1);
    for draws in 0..70 {
        let mut restored = restore(&save(&rng))?;
        let (here, there): (Vec<_>, Vec<_>) = (0..40).map(|_| (restored.next_u32(), restored.next_u64())).unzip();
        let mut again = restore(&save(&rng))?;
        let same: (Vec<_>, Vec<_>) = (0..40).map(|_| (again.next_u32(), again.next_u64())).unzip();
        assert_eq!((here, there), same);
        let mut one = restore(&save(&rng))?;
        assert_eq!(one.next_u32(), rng.next_u32(), "after {draws} draws");
    }
    Ok(())
}

#[test]
fn damaged_streams_are_refused() {
    let saved = save(&stream(3, "restore", 1));
    for bytes in [&saved[..47], &[], &[saved.as_slice(), &[0]].concat()] {
        assert!(matches!(restore(bytes), Err(Error::BadState { .. })), "{} bytes", bytes.len());
    }
    let mut beyond = saved;
    beyond[47] = 255;
    assert!(matches!(restore(&beyond), Err(Error::BadState { .. })));
}

#[test]
#[should_panic(expected = "1 to 16 ASCII bytes")]
fn a_purpose_that_is_too_long_is_a_mistake_in_the_program() {
    stream(0, "seventeen letters", 0);
}
