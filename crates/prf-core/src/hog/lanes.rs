//! Values that lie side by side, to be worked on together.

/// As many as fill four of the widest SIMD registers, which then work without waiting for each other's results.
pub(super) const WIDTH: usize = 64;

/// Lies so that no register's worth of it crosses a border of two cache lines.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Lanes<T>(pub(super) [T; WIDTH]);

impl<T: Copy + Default> Lanes<T> {
    #[inline(always)]
    pub(super) fn zero() -> Lanes<T> {
        Lanes([T::default(); WIDTH])
    }
}
