//! Results from the bytes that their pickles and files hold.

use pyo3::PyClass;
use pyo3::prelude::*;
use serde::de::DeserializeOwned;

use crate::error::refuse;
use crate::{ground, motion, refine, results, simulation};

fn read<T: PyClass + DeserializeOwned>(data: &[u8]) -> PyResult<T> {
    let read = postcard::from_bytes(data);
    read.map_err(|error| refuse(format!("these bytes are no {}: {error}", T::NAME)))
}

fn made<T>(py: Python<'_>, data: &[u8]) -> PyResult<Py<PyAny>>
where
    T: PyClass + DeserializeOwned + Into<PyClassInitializer<T>>,
{
    Ok(Py::new(py, read::<T>(data)?)?.into_any())
}

/// The result of the class ``kind`` from the bytes ``data`` that its pickle holds.
#[pyfunction(name = "_restored")]
pub(crate) fn restored(py: Python<'_>, kind: &str, data: &[u8]) -> PyResult<Py<PyAny>> {
    macro_rules! by_name {
        ($($class:ty),+ $(,)?) => {
            match kind {
                $(<$class as PyClass>::NAME => made::<$class>(py, data),)+
                <results::PyRun as PyClass>::NAME => {
                    Ok(read::<results::PyRun>(data)?.create(py)?.into_any())
                }
                _ => Err(refuse(format!("kind is '{kind}', which is no result"))),
            }
        };
    }
    by_name!(
        results::PyPeak,
        results::PyExtremes,
        results::PyEnergyBalance,
        results::PySummary,
        results::PyServiceCheck,
        simulation::PyFoundation,
        motion::PySpectrum,
        ground::PyImpedances,
        refine::PyRefinement,
    )
}
