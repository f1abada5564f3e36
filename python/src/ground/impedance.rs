//! Impedances of a rigid strip.

use basemat::bem::layered::{StripContact, StripImpedance};
use numpy::Complex64;
use pyo3::prelude::*;

use crate::array::{Array, complex};
use crate::names::choice;

/// Dynamic stiffness of a rigid, massless base for motions e^(iωt), per metre of thickness: complex
/// arrays of shape (m,), one value per frequency; the imaginary part is that of radiation and damping.
#[pyclass(name = "Impedances", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyImpedances(pub(super) Vec<StripImpedance>);

pub(super) fn contact(name: &str) -> PyResult<StripContact> {
    choice("contact", name, &[("bonded", StripContact::Bonded), ("relaxed", StripContact::Relaxed)])
}

getters! {
    PyImpedances, own;
    /// Frequencies: array of shape (m,), Hz.
    frequency: Array = own.0.iter().map(|at| at.frequency).collect();
    /// Horizontal force by horizontal translation: complex array of shape (m,), N/m².
    horizontal: Array<Complex64> = own.0.iter().map(|at| complex(at.horizontal)).collect();
    /// Vertical force by vertical translation: complex array of shape (m,), N/m².
    vertical: Array<Complex64> = own.0.iter().map(|at| complex(at.vertical)).collect();
    /// Moment by rotation: complex array of shape (m,), N.
    rocking: Array<Complex64> = own.0.iter().map(|at| complex(at.rocking)).collect();
    /// Horizontal force by rotation: complex array of shape (m,), N/m.
    coupling: Array<Complex64> = own.0.iter().map(|at| complex(at.coupling)).collect();
}
