//! What one thread at a time may use.

use std::sync::{Mutex, MutexGuard, TryLockError};

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// Something that changes with each call. A thread that comes while another one is at it is refused: to wait
/// could last forever in a process that was forked from one whose threads it has not.
pub(crate) struct Exclusive<T>(Mutex<T>);

impl<T> Exclusive<T> {
    pub(crate) fn new(value: T) -> Exclusive<T> {
        Exclusive(Mutex::new(value))
    }

    /// # Errors
    ///
    /// RuntimeError where another thread is using it.
    pub(crate) fn lock(&self) -> PyResult<MutexGuard<'_, T>> {
        try_lock(&self.0).ok_or_else(|| {
            PyRuntimeError::new_err(
                "got a call while another thread is using this object, expected one at a time: \
                                     give each thread a copy() of its own",
            )
        })
    }

    /// Calls `work` without the GIL.
    ///
    /// # Errors
    ///
    /// As [`Exclusive::lock`].
    pub(crate) fn with<R: Send>(&self, py: Python<'_>, work: impl FnOnce(&mut T) -> R + Send) -> PyResult<R>
    where
        T: Send,
    {
        let mut guard = self.lock()?;
        let value = &mut *guard;
        Ok(py.detach(|| work(value)))
    }
}

/// Nothing where another thread has locked it.
pub(crate) fn try_lock<T>(mutex: &Mutex<T>) -> Option<MutexGuard<'_, T>> {
    match mutex.try_lock() {
        Ok(guard) => Some(guard),
        Err(TryLockError::Poisoned(poisoned)) => Some(poisoned.into_inner()),
        Err(TryLockError::WouldBlock) => None,
    }
}
