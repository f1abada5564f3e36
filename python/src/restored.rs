//! Results as bytes, for pickles and files.

use pyo3::PyClass;
use pyo3::prelude::*;
use pyo3::pyclass::boolean_struct::True;
use pyo3::types::PyBytes;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::refuse;
use crate::ground::PyImpedances;
use crate::motion::PySpectrum;
use crate::refine::PyRefinement;
use crate::results::{PyEnergyBalance, PyExtremes, PyPeak, PyRun, PyServiceCheck, PySummary};
use crate::simulation::PyFoundation;

/// The function that makes a result again, the name of its class, and its bytes.
type Reduced<'py> = (Bound<'py, PyAny>, (&'static str, Bound<'py, PyBytes>));

fn reduced<'py, T>(own: &Bound<'py, T>) -> PyResult<Reduced<'py>>
where
    T: PyClass<Frozen = True> + Serialize + Sync,
{
    let py = own.py();
    let written = postcard::to_allocvec(own.get());
    let written = written.map_err(|error| refuse(format!("{}: {error}", T::NAME)))?;
    let restored = py.import("basemat._core")?.getattr("_restored")?;
    Ok((restored, (T::NAME, PyBytes::new(py, &written))))
}

fn read<T: PyClass + DeserializeOwned>(data: &[u8]) -> PyResult<T> {
    let read = postcard::from_bytes(data);
    read.map_err(|error| refuse(format!("these bytes are no {}: {error}", T::NAME)))
}

/// What pickles: classes, each with what makes its object of Python from `$own`.
macro_rules! results {
    ($($class:ident: |$py:ident, $own:ident| $made:expr;)+) => {
        $(#[pymethods]
        impl $class {
            fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
                reduced(slf)
            }
        })+

        /// The result of the class ``kind`` from the bytes ``data`` that its pickle holds.
        #[pyfunction(name = "_restored")]
        pub(crate) fn restored(py: Python<'_>, kind: &str, data: &[u8]) -> PyResult<Py<PyAny>> {
            match kind {
                $(<$class as PyClass>::NAME => {
                    let ($py, $own) = (py, read::<$class>(data)?);
                    Ok($made?.into_any())
                })+
                _ => Err(refuse(format!("kind is '{kind}', which is no result"))),
            }
        }
    };
}

results! {
    PyRun: |py, own| own.create(py);
    PyPeak: |py, own| Py::new(py, own);
    PyExtremes: |py, own| Py::new(py, own);
    PyEnergyBalance: |py, own| Py::new(py, own);
    PySummary: |py, own| Py::new(py, own);
    PyServiceCheck: |py, own| Py::new(py, own);
    PyFoundation: |py, own| Py::new(py, own);
    PySpectrum: |py, own| Py::new(py, own);
    PyImpedances: |py, own| Py::new(py, own);
    PyRefinement: |py, own| Py::new(py, own);
}
