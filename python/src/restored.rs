//! Results and small values as bytes, for pickles and files.

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
use crate::row::PyDofCombination;
use crate::simulation::PyFoundation;
use crate::soil::PySoil;
use crate::structure::{PyContactNode, PyFaceNode};

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

/// Classes that pickle.
macro_rules! reduces {
    ($($class:ident)+) => {
        $(#[pymethods]
        impl $class {
            fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
                reduced(slf)
            }
        })+
    };
}

/// The results beside a run.
macro_rules! results {
    ($($class:ident)+) => {
        reduces! { PyRun $($class)+ }

        /// The result of the class ``kind`` from the bytes ``data`` that its pickle holds.
        #[pyfunction(name = "_restored")]
        pub(crate) fn restored(py: Python<'_>, kind: &str, data: &[u8]) -> PyResult<Py<PyAny>> {
            match kind {
                <PyRun as PyClass>::NAME => Ok(read::<PyRun>(data)?.create(py)?.into_any()),
                $(<$class as PyClass>::NAME => Ok(Py::new(py, read::<$class>(data)?)?.into_any()),)+
                _ => Err(refuse(format!("kind is '{kind}', which is not kept as bytes"))),
            }
        }
    };
}

results! {
    PyPeak PyExtremes PyEnergyBalance PySummary PyServiceCheck PyFoundation PySpectrum PyImpedances PyRefinement
    PySoil PyContactNode PyFaceNode PyDofCombination
}
