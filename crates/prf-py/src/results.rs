//! Results with names: the named tuples of `python/prf/_results.py`.

use prf_core::{Match, Rect, Score};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyType;

const MODULE: &str = "prf._results";

pub(crate) fn rect(py: Python<'_>, Rect { x, y, width, height }: Rect) -> PyResult<Bound<'_, PyAny>> {
    static CLASS: PyOnceLock<Py<PyType>> = PyOnceLock::new();
    CLASS.import(py, MODULE, "Rect")?.call1((x, y, width, height))
}

pub(crate) fn score(py: Python<'_>, score: Score, matched: Option<Match>) -> PyResult<Bound<'_, PyAny>> {
    static CLASS: PyOnceLock<Py<PyType>> = PyOnceLock::new();
    let matched = matched.map(|matched| window(py, matched)).transpose()?;
    CLASS.import(py, MODULE, "Score")?.call1((score.reward, score.distance, matched))
}

fn window(py: Python<'_>, Match { rect, score }: Match) -> PyResult<Bound<'_, PyAny>> {
    static CLASS: PyOnceLock<Py<PyType>> = PyOnceLock::new();
    CLASS.import(py, MODULE, "Match")?.call1((rect.x, rect.y, rect.width, rect.height, score))
}
