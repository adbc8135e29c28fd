//! Matching allocates nothing after the first frame of a size. Alone in its program, as it counts all allocations.
#![expect(unsafe_code, reason = "an allocator that counts is one that allocates")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use prf_core::{Frame, MatchMethod, Plane, TemplateMatcher};

thread_local! {
    /// Of this thread alone: the test harness has others.
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

struct Counting;

// SAFETY: the system's allocator does all the work.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.with(|count| count.set(count.get() + 1));
        // SAFETY: the caller keeps the promises that this needs.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn noise(width: usize, height: usize, seed: usize) -> Frame {
    let pixel = |i: usize| (((i + seed) * 2_654_435_761) >> 11) as u8;
    Frame::from_vec(width, height, (0..width * height).map(pixel).collect()).expect("sides above 0")
}

#[test]
fn frames_after_the_first_allocate_nothing() {
    let frames: Vec<Frame> = (0..4).map(|seed| noise(84, 70, seed)).collect();
    let mask = noise(28, 20, 3);
    for (template, mask) in [(noise(3, 5, 9), None), (noise(28, 20, 9), None), (noise(28, 20, 9), Some(&mask))] {
        for method in [MatchMethod::CcorrNormed, MatchMethod::CcoeffNormed] {
            let mut matcher = TemplateMatcher::new(&template, mask, method).expect("a mask that fits");
            let mut map = Plane::from_vec(1, 1, vec![0.0]).expect("one pixel");
            matcher.scores_into(frames[0].view(), &mut map).expect("it fits");
            let before = ALLOCATIONS.get();
            assert!(before > 0, "nothing is counted");
            for frame in &frames {
                matcher.scores_into(frame.view(), &mut map).expect("it fits");
                matcher.best(frame.view()).expect("it fits");
            }
            assert_eq!(ALLOCATIONS.get(), before);
        }
    }
}
