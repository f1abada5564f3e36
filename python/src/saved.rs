//! Results as bytes, for pickles and files.

use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::pyclass::boolean_struct::True;
use pyo3::types::PyBytes;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::refuse;
use crate::{ground, motion, refine, results, simulation};

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

fn made<T>(py: Python<'_>, data: &[u8]) -> PyResult<Py<PyAny>>
where
    T: PyClass + DeserializeOwned + Into<PyClassInitializer<T>>,
{
    let own: T = postcard::from_bytes(data)
        .map_err(|error| refuse(format!("these bytes are no {}: {error}", T::NAME)))?;
    Ok(Py::new(py, own)?.into_any())
}

/// The result of the class ``kind`` from the bytes ``data`` that its pickle holds.
#[pyfunction(name = "_restored")]
pub(crate) fn restored(py: Python<'_>, kind: &str, data: &[u8]) -> PyResult<Py<PyAny>> {
    macro_rules! by_name {
        ($($class:ty),+ $(,)?) => {
            match kind {
                $(<$class as PyClass>::NAME => made::<$class>(py, data),)+
                _ => Err(refuse(format!("kind is '{kind}', which is no result"))),
            }
        };
    }
    by_name!(
        results::PyRun,
        results::PyPeak,
        results::PyExtremes,
        results::PyEnergyBalance,
        results::PyFoundationSummary,
        results::PyServiceCheck,
        simulation::PyFoundation,
        motion::PySpectrum,
        ground::PyImpedances,
        refine::PyRefinement,
    )
}
