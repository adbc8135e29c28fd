//! After the first frames nothing is allocated. Alone in its program, as it counts all allocations.
#![expect(unsafe_code, reason = "an allocator that counts is one that allocates")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use prf_core::{
    CellSize, DescriptorParams, EmaState, Frame, HogParams, MatchMethod, MotionParams, Norm, Plane, RewardParams,
    TemplateMatcher, WindowParams,
};

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
fn matching_allocates_nothing_after_the_first_frame() {
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

#[test]
fn rewards_and_states_allocate_nothing_once_all_sizes_were_seen() {
    // Crops of different sizes, below and above the goal's.
    let frames: Vec<Frame> = [4, 20, 9, 30].map(|border| framed(noise(84, 70, border), border)).into();
    let goal = framed(noise(60, 48, 5), 12);
    let window = WindowParams { method: MatchMethod::CcoeffNormed };
    let hog = |px, block_cells, norm| HogParams { cell: CellSize::Px(px), block_cells, norm, ..HogParams::default() };
    let hogs = [hog(1, 1, Norm::L2), hog(2, 1, Norm::L2), hog(5, 2, Norm::L2Hys)];
    let descriptors =
        [DescriptorParams::Direct, DescriptorParams::Window(window), DescriptorParams::Motion(MotionParams::default())];
    for (params, hog) in descriptors.into_iter().flat_map(|params| hogs.map(|hog| (params, hog))) {
        let reward = RewardParams { hog, ..RewardParams::default() };
        let mut descriptor = params.describe(&goal.clone().into(), reward).expect("a goal of many cells");
        let mut state = EmaState::new(84, 70, 0.7).expect("valid");
        let mut before = 0;
        for pass in 0..2 {
            before = ALLOCATIONS.get();
            descriptor.reset();
            state.reset();
            for frame in &frames {
                descriptor.observe(frame.view()).expect("one size");
                state.update(frame.view());
            }
            assert!(pass > 0 || ALLOCATIONS.get() > before, "nothing is counted");
        }
        assert_eq!(ALLOCATIONS.get(), before, "{params:?}, {hog:?}");
    }
}

/// The picture with a black border.
fn framed(mut picture: Frame, border: usize) -> Frame {
    let (width, height) = (picture.width(), picture.height());
    for y in 0..height {
        let row = picture.row_mut(y);
        if y < border || y >= height - border {
            row.fill(0);
        } else {
            row[..border].fill(0);
            row[width - border..].fill(0);
        }
    }
    picture
}
