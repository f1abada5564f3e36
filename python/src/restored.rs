//! Results from the bytes that their pickles and files hold.

use pyo3::PyClass;
use pyo3::prelude::*;
use serde::de::DeserializeOwned;

use crate::error::refuse;
use crate::{ground, motion, refine, results, simulation};

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
