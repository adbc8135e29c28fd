//! One binary for every machine: hot loops are compiled several times, and the best version is chosen while running.
//!
//! The loops themselves are plain Rust, which the compiler turns into the vector instructions that each version may use.
//! They give the same bits in every version, as none of them fuses a product with a sum. On AArch64 the baseline has
//! NEON already.
#![cfg_attr(
    target_arch = "x86_64",
    expect(unsafe_code, reason = "only the caller knows that the machine has a function's instructions")
)]

/// Work that is compiled once for every instruction set. `run`, and all that it calls in its hot loops, must be
/// `#[inline(always)]`: only what is inlined gets the instructions. A closure handed to an iterator often isn't, so
/// such loops are `for` loops.
pub(crate) trait Kernel {
    type Output;

    fn run(self) -> Self::Output;
}

/// Instructions that this machine has; there is no other way to get one than to ask the machine.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Simd(Level);

#[derive(Clone, Copy, Debug)]
enum Level {
    #[cfg(target_arch = "x86_64")]
    Avx512,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    Baseline,
}

/// The fastest first.
const LEVELS: &[Level] = &[
    #[cfg(target_arch = "x86_64")]
    Level::Avx512,
    #[cfg(target_arch = "x86_64")]
    Level::Avx2,
    Level::Baseline,
];

impl Level {
    fn is_available(self) -> bool {
        match self {
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => {
                is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512bw")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("avx512vl")
            }
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => is_x86_feature_detected!("avx2"),
            Level::Baseline => true,
        }
    }
}

impl Default for Simd {
    fn default() -> Simd {
        Simd::detect()
    }
}

impl Simd {
    /// All that this machine has, the fastest first.
    pub(crate) fn available() -> impl Iterator<Item = Simd> {
        LEVELS.iter().copied().filter(|level| level.is_available()).map(Simd)
    }

    /// The fastest.
    pub(crate) fn detect() -> Simd {
        Simd::available().next().unwrap_or(Simd(Level::Baseline))
    }

    pub(crate) fn run<K: Kernel>(self, kernel: K) -> K::Output {
        match self.0 {
            Level::Baseline => kernel.run(),
            // SAFETY: a level is made only after the machine was asked for its instructions.
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => unsafe { run_avx2(kernel) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => unsafe { run_avx512(kernel) },
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn run_avx2<K: Kernel>(kernel: K) -> K::Output {
    kernel.run()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
fn run_avx512<K: Kernel>(kernel: K) -> K::Output {
    kernel.run()
}
