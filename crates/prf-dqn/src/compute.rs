//! Where a network computes, in what numbers, and by how many threads.

use std::fmt;
use std::sync::Arc;

use rayon::{Scope, ThreadPool, ThreadPoolBuilder};
use serde::{Deserialize, Serialize};
use tch::{Device, Kind};

use crate::error::{Error, Result};

/// Where a network computes, in what numbers, and by how many threads.
#[derive(Debug, Clone)]
pub struct Compute {
    device: Device,
    precision: Precision,
    pair: Arc<Pair>,
}

/// The numbers of forward and backward passes. Parameters, Adam's moments and losses are f32 with each.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Precision {
    /// Bf16 where the processor multiplies it natively, f32 elsewhere.
    #[default]
    Auto,
    /// 32 bits.
    F32,
    /// Bfloat16: the range of f32 with 8 significant bits.
    Bf16,
}

impl Compute {
    /// Computing with `threads` threads of the processor; 0 takes all that it has.
    ///
    /// # Errors
    /// [`Error::Threads`] when the system gives no more threads.
    pub fn new(device: Device, precision: Precision, threads: usize) -> Result<Self> {
        let threads = if threads > 0 { threads } else { std::thread::available_parallelism().map_or(1, usize::from) };
        // A GPU is kept busy by one.
        let threads = if device == Device::Cpu { threads } else { 1 };
        Ok(Self { device, precision, pair: Arc::new(Pair::new(threads)?) })
    }

    /// Where its tensors lie.
    pub fn device(&self) -> Device {
        self.device
    }

    /// The workers.
    pub(crate) fn pair(&self) -> &Arc<Pair> {
        &self.pair
    }

    /// The threads that compute.
    pub fn threads(&self) -> usize {
        self.pair.threads
    }

    /// In f32 on the processor.
    #[cfg(test)]
    pub(crate) fn plain() -> Self {
        Self::on_cpu(Precision::F32, 0)
    }

    #[cfg(test)]
    pub(crate) fn on_cpu(precision: Precision, threads: usize) -> Self {
        Self::new(Device::Cpu, precision, threads).expect("threads")
    }

    /// The type of the tensors that are computed with.
    pub(crate) fn kind(&self) -> Kind {
        if self.precision.resolved(self.device) == Precision::Bf16 { Kind::BFloat16 } else { Kind::Float }
    }
}

/// Two workers that share the work of a network.
///
/// libtorch's own way, to split each of its operations among the threads, makes them wait for each other some twenty times in
/// an update, and some operations can hardly be split. A forward and a backward pass have enough that does not depend on
/// each other to keep two workers busy with whole operations. More threads than two are split among the workers.
pub(crate) struct Pair {
    pool: ThreadPool,
    threads: usize,
}

impl Pair {
    fn new(threads: usize) -> Result<Self> {
        let workers = threads.min(2);
        // The same for both, so that it doesn't matter which of them does what.
        let each = (threads / workers) as i32;
        let pool = ThreadPoolBuilder::new()
            .num_threads(workers)
            .thread_name(|index| format!("network-{index}"))
            .start_handler(move |_| {
                // libtorch counts threads for each thread that asks it to work, and gives a new one the number that was set
                // last, wherever that was; once it has been asked, it does so no more.
                let _ = tch::get_num_threads();
                tch::set_num_threads(each);
            })
            .build()
            .map_err(|error| Error::Threads { threads: workers, reason: error.to_string() })?;
        Ok(Self { pool, threads })
    }

    /// Does `work` on one of the workers, from where [`join`](Pair::join) is quicker.
    pub(crate) fn work<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        self.pool.install(work)
    }

    /// Does `work` and what it spawns.
    pub(crate) fn scope<'scope, R: Send>(&self, work: impl FnOnce(&Scope<'scope>) -> R + Send) -> R {
        self.pool.scope(work)
    }

    /// Does both at the same time or, by a single worker, `first` and then `second`.
    pub(crate) fn join<A: Send, B: Send>(
        &self,
        first: impl FnOnce() -> A + Send,
        second: impl FnOnce() -> B + Send,
    ) -> (A, B) {
        self.pool.join(first, second)
    }
}

impl fmt::Debug for Pair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Pair").field("threads", &self.threads).finish_non_exhaustive()
    }
}

impl Precision {
    /// What `Auto` stands for on this machine; anything else is itself.
    #[must_use]
    pub fn resolved(self, device: Device) -> Self {
        match self {
            Self::Auto if device == Device::Cpu && multiplies_bf16() => Self::Bf16,
            Self::Auto => Self::F32,
            given => given,
        }
    }
}

/// Whether the processor has instructions for products of bf16.
fn multiplies_bf16() -> bool {
    #[cfg(target_arch = "x86_64")]
    return std::arch::is_x86_feature_detected!("avx512bf16");
    #[cfg(target_arch = "aarch64")]
    return std::arch::is_aarch64_feature_detected!("bf16");
    #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
    return false;
}
