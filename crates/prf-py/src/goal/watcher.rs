//! Who looks at frames, whichever thread they come from.

use std::sync::{Mutex, MutexGuard, TryLockError};

use prf_core::{DescriptorParams, TaskDescriptor};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use super::parts::GoalParts;

type Descriptor = Box<dyn TaskDescriptor>;

/// No lock is waited for: a thread that was not taken along when a process forked never gives its back.
pub(crate) enum Watcher {
    /// Frames are scored one by one, so each call has a descriptor of its own. Here lie those that no call needs now:
    /// they keep the goal's features.
    Frames(Mutex<Vec<Descriptor>>),
    /// Frames are an episode, in their order.
    Episode(Mutex<Descriptor>),
}

/// How many descriptors are kept: as many as threads commonly look at once.
const KEPT: usize = 64;

impl Watcher {
    pub(crate) fn new(parts: &GoalParts) -> PyResult<Watcher> {
        let descriptor = parts.describe()?;
        Ok(match parts.descriptor {
            DescriptorParams::Motion(_) => Watcher::Episode(Mutex::new(descriptor)),
            DescriptorParams::Direct | DescriptorParams::Window(_) => Watcher::Frames(Mutex::new(vec![descriptor])),
        })
    }

    /// Calls `work` without the GIL.
    pub(crate) fn with<R: Send>(
        &self,
        py: Python<'_>,
        parts: &GoalParts,
        work: impl FnOnce(&mut dyn TaskDescriptor) -> R + Send,
    ) -> PyResult<R> {
        match self {
            Watcher::Frames(idle) => {
                let mut descriptor = match pop(idle) {
                    Some(descriptor) => descriptor,
                    None => parts.describe()?,
                };
                let result = py.detach(|| work(&mut *descriptor));
                push(idle, descriptor);
                Ok(result)
            }
            Watcher::Episode(descriptor) => {
                let mut descriptor = episode(descriptor)?;
                let descriptor = &mut **descriptor;
                Ok(py.detach(|| work(descriptor)))
            }
        }
    }

    /// Calls `work` without the GIL and with descriptors for `count` threads, or one for an episode.
    pub(crate) fn with_many<R: Send>(
        &self,
        py: Python<'_>,
        parts: &GoalParts,
        count: usize,
        work: impl FnOnce(&mut [Descriptor]) -> R + Send,
    ) -> PyResult<R> {
        match self {
            Watcher::Frames(idle) => {
                let taken = (0..count).map(|_| pop(idle).map_or_else(|| parts.describe(), Ok));
                let mut descriptors = taken.collect::<PyResult<Vec<_>>>()?;
                let result = py.detach(|| work(&mut descriptors));
                descriptors.into_iter().for_each(|descriptor| push(idle, descriptor));
                Ok(result)
            }
            Watcher::Episode(descriptor) => {
                let mut descriptor = episode(descriptor)?;
                let descriptors = std::slice::from_mut(&mut *descriptor);
                Ok(py.detach(|| work(descriptors)))
            }
        }
    }

    /// What is remembered of the episode; nothing where frames are scored one by one.
    pub(crate) fn save_state(&self) -> PyResult<Option<Vec<u8>>> {
        match self {
            Watcher::Frames(_) => Ok(None),
            Watcher::Episode(descriptor) => Ok(Some(episode(descriptor)?.save_state())),
        }
    }
}

fn pop(idle: &Mutex<Vec<Descriptor>>) -> Option<Descriptor> {
    try_lock(idle).and_then(|mut idle| idle.pop())
}

fn push(idle: &Mutex<Vec<Descriptor>>, descriptor: Descriptor) {
    if let Some(mut idle) = try_lock(idle)
        && idle.len() < KEPT
    {
        idle.push(descriptor);
    }
}

fn episode(descriptor: &Mutex<Descriptor>) -> PyResult<MutexGuard<'_, Descriptor>> {
    try_lock(descriptor).ok_or_else(|| {
        PyRuntimeError::new_err("this goal's episode is in use by another thread; give each thread a copy() of its own")
    })
}

fn try_lock<T>(mutex: &Mutex<T>) -> Option<MutexGuard<'_, T>> {
    match mutex.try_lock() {
        Ok(guard) => Some(guard),
        Err(TryLockError::Poisoned(poisoned)) => Some(poisoned.into_inner()),
        Err(TryLockError::WouldBlock) => None,
    }
}
