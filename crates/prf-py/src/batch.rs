//! Many pictures at once, on several threads.
//!
//! Threads live no longer than the call: those of a pool would be missing in a forked process, which
//! would then wait for them forever.

use std::sync::{Mutex, PoisonError};
use std::thread::{self, Builder, available_parallelism};

use numpy::ndarray::{Dimension, Ix3};
use numpy::{Element, PyArray, PyArrayMethods};
use prf_core::Error;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::error::value_error;
use crate::image::Array;
use crate::options::Options;

/// More threads than any machine has cores for.
const MAX_THREADS: usize = 1024;

/// A thread that has less to do than this many pixels costs more than it saves.
const PIXELS_A_THREAD: usize = 1 << 15;

/// Each thread takes about this many parts, so that none has to wait long for the last one.
const PARTS_A_THREAD: usize = 4;

/// How many threads may work; nothing where it is as many as the process may use at once.
#[derive(Clone, Copy)]
pub(crate) struct Threads(Option<usize>);

impl Threads {
    /// Takes the argument `threads`.
    pub(crate) fn read(options: &Options<'_>) -> PyResult<Threads> {
        match options.get_optional("threads")? {
            Some(threads) if !(1..=MAX_THREADS).contains(&threads) => {
                Err(PyValueError::new_err(format!("threads: got {threads}, expected 1 to {MAX_THREADS}")))
            }
            threads => Ok(Threads(threads)),
        }
    }

    /// The most threads, if that was said.
    pub(crate) fn most(self) -> Option<usize> {
        self.0
    }

    /// How many threads to take for `count` pictures of this shape; at least 1.
    pub(crate) fn count(self, count: usize, [height, width]: [usize; 2]) -> usize {
        let useful = (count * height * width / PIXELS_A_THREAD).clamp(1, count.max(1));
        match self.0 {
            Some(threads) => threads.min(count.max(1)),
            None if useful == 1 => 1,
            None => available_parallelism().map_or(1, Into::into).min(useful),
        }
    }
}

/// Writes what `work` makes of each of the pictures `name` to an array of `(count, *shape)`. `state` is what every thread
/// begins with.
pub(crate) fn each<'py, P: Element, T: Element, D: Dimension, S: Clone + Send>(
    name: &str,
    pictures: &Array<'py, P, Ix3>,
    threads: Threads,
    state: S,
    shape: &[usize],
    work: impl Fn(&mut S, &[P], &mut [T]) -> Result<(), Error> + Send + Sync,
) -> PyResult<Bound<'py, PyArray<T, D>>> {
    let (py, count, pixels) = (pictures.py(), pictures.count(), pictures.pixels()?);
    let results = empty::<T, D>(py, &[&[count], shape].concat())?;
    let mut writing = results.try_readwrite()?;
    let values = writing.as_slice_mut()?;
    let mut states = vec![state; threads.count(count, pictures.shape())];
    py.detach(|| run(&mut states, count, pixels, values, work))
        .map_err(|(at, error)| value_error(&format!("{name}[{at}]"), &error))?;
    drop(writing);
    Ok(results)
}

/// An array that is still to be filled: NumPy's own, as it raises a MemoryError where there is no room.
pub(crate) fn empty<'py, T: Element, D: Dimension>(
    py: Python<'py>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyArray<T, D>>> {
    let array = py.import("numpy")?.call_method1("empty", (PyTuple::new(py, shape)?, T::get_dtype(py)))?;
    Ok(array.cast_into()?)
}

/// Calls `work` for each of `count` inputs, which lie one after the other in `inputs` as their results do in `outputs`.
/// There is one thread for each of `states`, at least one, and it hands its own to all its calls.
///
/// # Errors
///
/// That of the first input, in their order, that `work` refuses, and which input it is.
pub(crate) fn run<S: Send, I: Sync, O: Send, E: Send>(
    states: &mut [S],
    count: usize,
    inputs: &[I],
    outputs: &mut [O],
    work: impl Fn(&mut S, &[I], &mut [O]) -> Result<(), E> + Sync,
) -> Result<(), (usize, E)> {
    if count == 0 {
        return Ok(());
    }
    let (input_len, output_len) = (inputs.len() / count, outputs.len() / count);
    let part = count.div_ceil(states.len() * PARTS_A_THREAD);
    let parts = inputs.chunks(part * input_len).zip(outputs.chunks_mut(part * output_len));
    let parts = Mutex::new((0..).step_by(part).zip(parts));
    let refused = Mutex::new(None);
    let run_parts = |state: &mut S| {
        while let Some((start, (inputs, outputs))) = lock(&parts, Iterator::next) {
            let pairs = inputs.chunks_exact(input_len).zip(outputs.chunks_exact_mut(output_len));
            // Later parts go on, so that the first error is the same however many threads there are.
            let error = (start..).zip(pairs).find_map(|(at, (i, o))| work(state, i, o).err().map(|error| (at, error)));
            if let Some((at, error)) = error {
                lock(&refused, |refused| match refused {
                    Some((first, _)) if *first < at => {}
                    _ => *refused = Some((at, error)),
                });
            }
        }
    };
    thread::scope(|scope| {
        let Some((own, others)) = states.split_first_mut() else { return };
        for state in others {
            // Where the system gives no more threads, those that are there do all the work.
            if Builder::new().spawn_scoped(scope, || run_parts(state)).is_err() {
                break;
            }
        }
        run_parts(own);
    });
    refused.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(()), Err)
}

fn lock<T, R>(mutex: &Mutex<T>, with: impl FnOnce(&mut T) -> R) -> R {
    with(&mut mutex.lock().unwrap_or_else(PoisonError::into_inner))
}
