use super::face::{Face, MOVEMENTS};
use super::*;
use prf_core::Frame;

#[test]
fn vertices_by_hand() {
    let face = Face::new([1, 0, 0, 3, 2, 1]).expect("within its levels");
    let vertices = face.vertices();
    // The brows' outer ends: 15.5, 27.5 and the mirror image, one level of 2.5 up.
    assert_eq!((vertices[0], vertices[4]), ([15.5, 25.0], [68.5, 25.0]));
    // The corner of the lips: 3 × 2.6 out, back by 0.4 as the mouth opens; 2 × 2.2 up, and down by 0.6.
    let near = |a: Point, b: Point| (a[0] - b[0]).abs() < 1e-4 && (a[1] - b[1]).abs() < 1e-4;
    assert!(near(vertices[8], [30.0 - 7.8 + 0.4, 60.5 - 4.4 + 0.6]), "{:?}", vertices[8]);
    assert!(near(vertices[12], [84.0 - vertices[8][0], vertices[8][1]]));
    assert_eq!(Face::new([4, 0, 0, 0, 0, 0]), None);
    assert_eq!(Face::new([0, 0, 0, 0, 0, -1]), None);
}

#[test]
fn every_face_has_a_position_of_its_own() {
    assert_eq!(Face::all(0..MOVEMENTS).count(), 6 * 5 * 5 * 6 * 6 * 6);
    for (position, face) in Face::all(0..MOVEMENTS).enumerate() {
        assert_eq!(Face::new(face.levels()), Some(face));
        assert_eq!(face.position(0..MOVEMENTS), position);
    }
}

#[test]
fn the_album_holds_what_would_be_drawn() {
    let (mut kept, mut drawn) = (Frame::new(84, 84), Frame::new(84, 84));
    for face in Face::all(0..MOVEMENTS).step_by(61) {
        assert!(Album::get().draw(face, &mut kept.view_mut()));
        draw::draw(face, &mut drawn.view_mut());
        assert_eq!(kept, drawn, "{face:?}");
    }
}

#[test]
fn the_mouth_never_crosses_itself() {
    for wide in -2..=3 {
        for up in -2..=3 {
            for open in 0..=5 {
                let vertices = Face::new([0, 0, 0, wide, up, open]).expect("within its levels").vertices();
                for lips in vertices[8..].chunks_exact(8) {
                    assert!(lips[0][0] < lips[1][0] && lips[0][0] < lips[7][0] && lips[1][0] < lips[2][0], "{lips:?}");
                    assert!((1..4).all(|above| lips[above][1] < lips[8 - above][1]), "{lips:?}");
                }
            }
        }
    }
}

#[test]
fn the_oracle_takes_the_farthest_movement_first() {
    let target = Face::new([1, 0, 0, 3, -2, 0]).expect("within its levels");
    let mut face = Face::default();
    let mut order = Vec::new();
    while let Some((movement, up)) = oracle::next(face, target) {
        face.shift(movement, up);
        order.push((movement, up));
    }
    assert_eq!(order, [(3, true), (3, true), (4, false), (0, true), (3, true), (4, false)]);
    assert_eq!(face, target);
}

#[test]
fn impossible_states_are_refused() {
    let state = |steps: u32, levels: [i8; MOVEMENTS], status| {
        let face = Face::new(levels).expect("within its levels");
        state::save(Expression::Happy, Some(&Episode { face, steps, status }))
    };
    let world = Kobian::new(Expression::Happy, 10).expect("above 0");
    let load = |bytes: &[u8]| state::load(&world, bytes);
    assert!(load(&state(3, [1, 1, -1, 0, 0, 0], Status::Running)).is_ok());
    for (steps, levels, status) in [
        (2, [1, 1, -1, 0, 0, 0], Status::Running),
        (10, [0; 6], Status::Running),
        (9, [0; 6], Status::Truncated),
        (3, [0; 6], Status::Terminated),
    ] {
        assert!(matches!(load(&state(steps, levels, status)), Err(Error::BadState { .. })), "{steps} {status:?}");
    }
    let mut beyond = state(9, [3, 0, 0, 0, 0, 0], Status::Running);
    let at = beyond.len() - 1 - MOVEMENTS;
    beyond[at] = 4;
    assert!(matches!(load(&beyond), Err(Error::BadState { .. })));
}
