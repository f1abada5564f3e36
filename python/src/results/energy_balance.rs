//! The energy balance.

use basemat::coupled::{EnergyBalance, EnergyTerm};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Energies since the start, J per metre of thickness:
/// ``kinetic + strain + hysteresis + damping + algorithmic + soil + contact + interface + static_contact = input``.
#[pyclass(name = "EnergyBalance", module = "basemat", frozen)]
pub(crate) struct PyEnergyBalance(pub(crate) EnergyBalance);

#[pymethods]
impl PyEnergyBalance {
    /// ½ v·M v.
    #[getter]
    fn kinetic(&self) -> f64 {
        self.0.kinetic
    }

    /// Elastic energy of the structure.
    #[getter]
    fn strain(&self) -> f64 {
        self.0.strain
    }

    /// Heat of hysteretic parts of the structure.
    #[getter]
    fn hysteresis(&self) -> f64 {
        self.0.hysteresis
    }

    /// Work of the dashpots.
    #[getter]
    fn damping(&self) -> f64 {
        self.0.damping
    }

    /// Loss by the time scheme.
    #[getter]
    fn algorithmic(&self) -> f64 {
        self.0.algorithmic
    }

    /// Work done on the soil: radiated and stored.
    #[getter]
    fn soil(&self) -> f64 {
        self.0.soil
    }

    /// Loss by friction and impact.
    #[getter]
    fn contact(&self) -> f64 {
        self.0.contact
    }

    /// Elastic energy of compliant interfaces.
    #[getter]
    fn interface(&self) -> f64 {
        self.0.interface
    }

    /// Potential of the static tractions against the change of the jump.
    #[getter]
    fn static_contact(&self) -> f64 {
        self.0.static_contact
    }

    /// Work of loads and free field, and the energy of an initial motion.
    #[getter]
    fn input(&self) -> f64 {
        self.0.input
    }

    /// Relative input energy (Uang & Bertero 1990).
    #[getter]
    fn relative_input(&self) -> f64 {
        self.0.relative_input
    }

    /// Error bound of ``soil`` by an approximate history.
    #[getter]
    fn soil_error_bound(&self) -> f64 {
        self.0.soil_error_bound
    }

    /// Largest energy so far, to which ``residual`` is relative.
    #[getter]
    fn largest(&self) -> f64 {
        self.0.largest
    }

    /// Difference between the two sides of the balance, relative to the largest energy so far.
    #[getter]
    fn residual(&self) -> f64 {
        self.0.residual()
    }

    /// All terms by their names.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let terms = PyDict::new(py);
        for term in EnergyTerm::ALL {
            terms.set_item(term.to_string(), self.0.term(term))?;
        }
        Ok(terms)
    }

    fn __repr__(&self) -> String {
        format!("EnergyBalance(input {:.6e} J/m, residual {:.1e})", self.0.input, self.0.residual())
    }
}
