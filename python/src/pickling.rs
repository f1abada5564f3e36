//! Pickling of results and small values as bytes.

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
    PyEnergyBalance, PyExtremes, PyInteraction, PyPeak, PyPushOver, PyRun, PyServiceCheck,
    PySummary, PySystemMode,
};
use crate::row::PyDofCombination;
use crate::simulation::{PyFaceForces, PyFoundation};
use crate::soil::PySoil;
use crate::structure::{PyBeamSections, PyHingeState, PySolidPoints};
use crate::user::{PyCondition, PyLimits, PyTolerance};

/// The function that restores an object, the name of its class, and its bytes.
type ReducedObject<'py> = (Bound<'py, PyAny>, (&'static str, Bound<'py, PyBytes>));

/// The data of an object that a pickle stores.
fn reduced_object<'py, T>(object: &Bound<'py, T>) -> PyResult<ReducedObject<'py>>
where
    T: PyClass<Frozen = True> + Serialize + Sync,
{
    let py = object.py();
    let encoded = postcard::to_allocvec(object.get());
    let bytes = encoded.map_err(|error| input_error(format!("{}: {error}", T::NAME)))?;
    let restore = py.import("basemat._core")?.getattr("_restored")?;
    Ok((restore, (T::NAME, PyBytes::new(py, &bytes))))
}

/// The object of a class from its bytes.
fn decode<T: PyClass + DeserializeOwned>(data: &[u8]) -> PyResult<T> {
    let decoded = postcard::from_bytes(data);
    decoded.map_err(|error| input_error(format!("these bytes are not a {}: {error}", T::NAME)))
}

/// Implements pickling for these classes.
macro_rules! pickled_classes {
    ($($class:ident)+) => {
        $(#[pymethods]
        impl $class {
            fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<ReducedObject<'py>> {
                reduced_object(slf)
            }
        })+

        /// The object of the class ``kind`` from the bytes ``data`` of its pickle.
        #[pyfunction(name = "_restored")]
        pub(crate) fn restored(py: Python<'_>, kind: &str, data: &[u8]) -> PyResult<Py<PyAny>> {
            match kind {
                $(<$class as PyClass>::NAME => decode::<$class>(data)?.into_py_any(py),)+
                _ => Err(input_error(format!("kind is '{kind}', but must be a class that pickles"))),
            }
        }
    };
}

pickled_classes! {
    PyRun PyPeak PyExtremes PyEnergyBalance PySummary PyServiceCheck PyFoundation PySpectrum PyImpedances PyRefinement
    PyRefinements PySensitivity PyPeakTwins PyInteraction PySystemMode PyFaceForces PyKinematicMotions
    PySoil PyBaseNode PyBaseFaces PyDofCombination PyCondition PyLimits PyTolerance PySolidPoints PyBeamSections
    PyHingeState PyPushOver
}
