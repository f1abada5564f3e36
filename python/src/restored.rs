//! Results and small values as bytes, for pickles and files.

use pyo3::prelude::*;
use pyo3::pyclass::boolean_struct::True;
use pyo3::types::PyBytes;
use pyo3::{IntoPyObjectExt, PyClass};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::base_node::{PyBaseFaces, PyBaseNode};
use crate::error::input_error;
use crate::ground::{PyImpedances, PyKinematicMotions};
use crate::motion::PySpectrum;
use crate::refine::{PyPeakTwins, PyRefinement, PyRefinements, PySensitivity};
use crate::results::{
    PyEnergyBalance, PyExtremes, PyInteraction, PyPeak, PyRun, PyServiceCheck, PySummary,
    PySystemMode,
};
use crate::row::PyDofCombination;
use crate::simulation::{PyFaceForces, PyFoundation};
use crate::soil::PySoil;
use crate::user::{PyCondition, PyLimits, PyTolerance};

/// The function that makes a result again, the name of its class, and its bytes.
type Reduced<'py> = (Bound<'py, PyAny>, (&'static str, Bound<'py, PyBytes>));

fn reduced<'py, T>(object: &Bound<'py, T>) -> PyResult<Reduced<'py>>
where
    T: PyClass<Frozen = True> + Serialize + Sync,
{
    let py = object.py();
    let written = postcard::to_allocvec(object.get());
    let written = written.map_err(|error| input_error(format!("{}: {error}", T::NAME)))?;
    let restored = py.import("basemat._core")?.getattr("_restored")?;
    Ok((restored, (T::NAME, PyBytes::new(py, &written))))
}

fn read<T: PyClass + DeserializeOwned>(data: &[u8]) -> PyResult<T> {
    let read = postcard::from_bytes(data);
    read.map_err(|error| input_error(format!("these bytes are no {}: {error}", T::NAME)))
}

/// Classes that pickle.
macro_rules! results {
    ($($class:ident)+) => {
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
                $(<$class as PyClass>::NAME => read::<$class>(data)?.into_py_any(py),)+
                _ => Err(input_error(format!("kind is '{kind}', which is not kept as bytes"))),
            }
        }
    };
}

results! {
    PyRun PyPeak PyExtremes PyEnergyBalance PySummary PyServiceCheck PyFoundation PySpectrum PyImpedances PyRefinement
    PyRefinements PySensitivity PyPeakTwins PyInteraction PySystemMode PyFaceForces PyKinematicMotions
    PySoil PyBaseNode PyBaseFaces PyDofCombination PyCondition PyLimits PyTolerance
}
