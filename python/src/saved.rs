//! Results as bytes, for pickles and files.

use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::pyclass::boolean_struct::True;
use pyo3::types::PyBytes;
use serde::Serialize;

use crate::error::refuse;

/// The function that makes a result again, the name of its class, and its bytes.
pub(crate) type Reduced<'py> = (Bound<'py, PyAny>, (&'static str, Bound<'py, PyBytes>));

/// What `__reduce__` of a result returns.
pub(crate) fn reduced<'py, T>(own: &Bound<'py, T>) -> PyResult<Reduced<'py>>
where
    T: PyClass<Frozen = True> + Serialize + Sync,
{
    let py = own.py();
    let written = postcard::to_allocvec(own.get());
    let written = written.map_err(|error| refuse(format!("{}: {error}", T::NAME)))?;
    let restored = py.import("basemat._core")?.getattr("_restored")?;
    Ok((restored, (T::NAME, PyBytes::new(py, &written))))
}
