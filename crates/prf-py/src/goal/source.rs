//! What a goal is given as: an array, or the path of a file.

use std::ffi::CString;
use std::path::PathBuf;

use numpy::{PyUntypedArray, PyUntypedArrayMethods};
use prf_core::io::{self, FrameSource, MotionSequence};
use prf_core::{Error, Frame, MotionParams};
use pyo3::exceptions::{PyTypeError, PyUserWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyString;

use crate::error::{file_error, in_python};
use crate::image::{self, Picture, Pictures};

const PICTURE: &str = "(height, width)";

/// The picture that the argument `name` is or that lies at its path.
pub(crate) fn picture(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Frame> {
    match path(name, value, PICTURE)? {
        Some(path) => value.py().detach(|| io::read_frame(path)).map_err(|error| file_error(&error)),
        None => Ok(Picture::read(name, value)?.view()?.to_frame()),
    }
}

/// The mask that the argument `mask` is or that lies at its path.
pub(crate) fn mask(value: &Bound<'_, PyAny>) -> PyResult<Frame> {
    if value.is_instance_of::<PyUntypedArray>() { image::mask(value) } else { picture("mask", value) }
}

/// The motion template that the argument `goal` is or shows, or what lies at its path.
pub(crate) fn motion(value: &Bound<'_, PyAny>, params: MotionParams) -> PyResult<Frame> {
    let py = value.py();
    let sequence = match path("goal", value, "(height, width) or (count, height, width)")? {
        Some(path) => match py.detach(|| read(path, params)).map_err(|error| file_error(&error))? {
            Read::Template(template) => return Ok(template),
            Read::Sequence(sequence) => sequence,
        },
        None if value.cast::<PyUntypedArray>().is_ok_and(|array| array.ndim() == 3) => {
            let frames = Pictures::read("goal", value)?;
            let frames = frames.views()?;
            py.detach(|| MotionSequence::of_frames("goal", frames, params)).map_err(|error| file_error(&error))?
        }
        None => return picture("goal", value),
    };
    if let Some(warning) = sequence.warning {
        let message = format!("goal: {}", in_python(&format!("{warning}; {}", warning.hint())));
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &CString::new(message)?, 1)?;
    }
    Ok(sequence.template)
}

enum Read {
    Template(Frame),
    Sequence(MotionSequence),
}

/// A file with one picture is a template; a folder with one is a sequence that is too short.
fn read(path: PathBuf, params: MotionParams) -> Result<Read, Error> {
    let source = FrameSource::open(&path)?;
    if source.len_hint() == Some(1) && !path.is_dir() {
        return io::read_frame(path).map(Read::Template);
    }
    MotionSequence::of(source, params, false).map(Read::Sequence)
}

/// The argument `name` as a path; nothing where it is an array.
fn path(name: &str, value: &Bound<'_, PyAny>, shape: &str) -> PyResult<Option<PathBuf>> {
    if value.is_instance_of::<PyUntypedArray>() {
        return Ok(None);
    }
    if value.is_instance_of::<PyString>() || value.hasattr("__fspath__")? {
        let path: PathBuf = value.extract()?;
        if path.as_os_str().as_encoded_bytes().contains(&0) {
            let message = format!("{name}: got {}, expected a path without null characters", value.repr()?);
            return Err(PyValueError::new_err(message));
        }
        return Ok(Some(path));
    }
    let got = value.get_type().name()?;
    let expected = format!("a NumPy array of shape {shape} or the path of a file as str or os.PathLike");
    Err(PyTypeError::new_err(format!("{name}: got {got}, expected {expected}")))
}
