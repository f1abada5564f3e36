//! The energy balance.

use basemat::coupled::{EnergyBalance, EnergyTerm};
use pyo3::prelude::*;

use crate::array::OrderedDict;

/// Energies since the start, J, in the plane J per metre of thickness:
/// ``kinetic + strain + hysteresis + damping + algorithmic + midstep_remainder + soil + contact + interface
/// + static_contact = input``.
#[pyclass(name = "EnergyBalance", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyEnergyBalance(pub(crate) EnergyBalance);

#[pymethods]
impl PyEnergyBalance {
    /// Kinetic energy ½ v·M v, J.
    #[getter]
    fn kinetic(&self) -> f64 {
        self.0.kinetic
    }

    /// Elastic energy of the structure, J.
    #[getter]
    fn strain(&self) -> f64 {
        self.0.strain
    }

    /// Energy dissipated in hysteretic parts of the structure, J.
    #[getter]
    fn hysteresis(&self) -> f64 {
        self.0.hysteresis
    }

    /// Work of the dashpots, J.
    #[getter]
    fn damping(&self) -> f64 {
        self.0.damping
    }

    /// Energy that the time scheme removes, J; negative if it adds energy.
    #[getter]
    fn algorithmic(&self) -> f64 {
        self.0.algorithmic
    }

    /// Work of yielding parts inside the steps that is neither stored nor dissipated, J.
    #[getter]
    fn midstep_remainder(&self) -> f64 {
        self.0.midstep_remainder
    }

    /// Work done on the soil, J; the soil radiates part of it and stores the rest.
    #[getter]
    fn soil(&self) -> f64 {
        self.0.soil
    }

    /// Energy lost by friction and impact, J.
    #[getter]
    fn contact(&self) -> f64 {
        self.0.contact
    }

    /// Elastic energy of compliant interfaces, J.
    #[getter]
    fn interface(&self) -> f64 {
        self.0.interface
    }

    /// Potential of the static tractions against gaps and slips, J.
    #[getter]
    fn static_contact(&self) -> f64 {
        self.0.static_contact
    }

    /// Work of loads and free field, and the energy of an initial motion, J.
    #[getter]
    fn input(&self) -> f64 {
        self.0.input
    }

    /// Relative input energy (Uang and Bertero 1990), J.
    #[getter]
    fn relative_input(&self) -> f64 {
        self.0.relative_input
    }

    /// Bound of the error of `soil` that the approximation of the history causes, J.
    #[getter]
    fn soil_error_bound(&self) -> f64 {
        self.0.soil_error_bound
    }

    /// Largest energy so far, to which `residual` is relative, J.
    #[getter]
    fn largest(&self) -> f64 {
        self.0.largest
    }

    /// Difference between the two sides of the balance, relative to the largest energy so far.
    #[getter]
    fn residual(&self) -> f64 {
        self.0.residual()
    }

    /// All terms by their names: dict of numbers, J, in the plane J/m.
    fn to_dict(&self) -> OrderedDict<String, f64> {
        EnergyTerm::ALL_TERMS
            .into_iter()
            .map(|term| (term.to_string(), self.0.term(term)))
            .collect()
    }

    fn _repr_html_(&self) -> String {
        let rows = EnergyTerm::ALL_TERMS
            .map(|term| format!("<tr><td>{term}</td><td>{:.4e}</td></tr>", self.0.term(term)))
            .concat();
        format!(
            "<table><tr><th>energy</th><th>J (in the plane J/m)</th></tr>{rows}<tr><td>residual, relative</td>\
             <td>{:.1e}</td></tr></table>",
            self.0.residual()
        )
    }

    fn __repr__(&self) -> String {
        let input = self.0.input;
        let residual = self.0.residual();
        format!("EnergyBalance(input {input:.6e} J, in the plane J/m, residual {residual:.1e})")
    }
}
