//! Who looks at frames, whichever thread they come from.

use std::slice;
use std::sync::Mutex;

use prf_core::{DescriptorParams, TaskDescriptor};
use pyo3::prelude::*;

use super::parts::GoalParts;
use crate::exclusive::{Exclusive, try_lock};

type Descriptor = Box<dyn TaskDescriptor>;

pub(crate) enum Watcher {
    /// Frames are scored one by one, so each call has a descriptor of its own. Here lie those that no call needs now:
    /// they keep the goal's features.
    Frames(Mutex<Vec<Descriptor>>),
    /// Frames are an episode, in their order.
    Episode(Exclusive<Descriptor>),
}

/// How many descriptors are kept: as many as threads commonly look at once.
const KEPT: usize = 64;

impl Watcher {
    pub(crate) fn new(parts: &GoalParts) -> PyResult<Watcher> {
        let descriptor = parts.describe()?;
        Ok(match parts.descriptor {
            DescriptorParams::Motion(_) => Watcher::Episode(Exclusive::new(descriptor)),
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
            Watcher::Frames(idle) => py.detach(|| {
                let mut descriptor = take(idle, parts)?;
                let result = work(&mut *descriptor);
                give_back(idle, descriptor);
                Ok(result)
            }),
            Watcher::Episode(descriptor) => descriptor.with(py, |descriptor| work(&mut **descriptor)),
        }
    }

    /// Calls `work` without the GIL and with descriptors for `count` threads, or with the one of the episode.
    pub(crate) fn with_many<R: Send>(
        &self,
        py: Python<'_>,
        parts: &GoalParts,
        count: usize,
        work: impl FnOnce(&mut [Descriptor]) -> R + Send,
    ) -> PyResult<R> {
        match self {
            Watcher::Frames(idle) => py.detach(|| {
                let mut descriptors = (0..count).map(|_| take(idle, parts)).collect::<PyResult<Vec<_>>>()?;
                let result = work(&mut descriptors);
                descriptors.into_iter().for_each(|descriptor| give_back(idle, descriptor));
                Ok(result)
            }),
            Watcher::Episode(descriptor) => descriptor.with(py, |descriptor| work(slice::from_mut(descriptor))),
        }
    }

    /// What is remembered of the episode; nothing where frames are scored one by one.
    pub(crate) fn save_state(&self) -> PyResult<Option<Vec<u8>>> {
        match self {
            Watcher::Frames(_) => Ok(None),
            Watcher::Episode(descriptor) => Ok(Some(descriptor.lock()?.save_state())),
        }
    }
}

fn take(idle: &Mutex<Vec<Descriptor>>, parts: &GoalParts) -> PyResult<Descriptor> {
    let kept = try_lock(idle).and_then(|mut idle| idle.pop());
    kept.map_or_else(|| parts.describe(), Ok)
}

fn give_back(idle: &Mutex<Vec<Descriptor>>, descriptor: Descriptor) {
    if let Some(mut idle) = try_lock(idle)
        && idle.len() < KEPT
    {
        idle.push(descriptor);
    }
}
