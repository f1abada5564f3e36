//! The energy balance.

use basemat::coupled::{EnergyBalance, EnergyTerm};
use pyo3::prelude::*;

use crate::array::Named;

/// Energies since the start, J, in the plane J per metre of thickness:
/// ``kinetic + strain + hysteresis + damping + algorithmic + soil + contact + interface + static_contact = input``.
#[pyclass(name = "EnergyBalance", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyEnergyBalance(pub(crate) EnergyBalance);

members! {
    PyEnergyBalance, own;
    /// Kinetic energy ½ v·M v, J.
    kinetic: f64 = own.0.kinetic;
    /// Elastic energy of the structure, J.
    strain: f64 = own.0.strain;
    /// Heat of hysteretic parts of the structure, J.
    hysteresis: f64 = own.0.hysteresis;
    /// Work of the dashpots, J.
    damping: f64 = own.0.damping;
    /// Energy that the time scheme removes, J; negative if it makes any.
    algorithmic: f64 = own.0.algorithmic;
    /// Work done on the soil, radiated and stored, J.
    soil: f64 = own.0.soil;
    /// Loss by friction and impact, J.
    contact: f64 = own.0.contact;
    /// Elastic energy of compliant interfaces, J.
    interface: f64 = own.0.interface;
    /// Potential of the static tractions against gaps and slips, J.
    static_contact: f64 = own.0.static_contact;
    /// Work of loads and free field, and the energy of an initial motion, J.
    input: f64 = own.0.input;
    /// Relative input energy (Uang and Bertero 1990), J.
    relative_input: f64 = own.0.relative_input;
    /// Error bound of :attr:`soil` by an approximate history, J.
    soil_error_bound: f64 = own.0.soil_error_bound;
    /// Largest energy so far, to which :attr:`residual` is relative, J.
    largest: f64 = own.0.largest;
    /// Difference between the two sides of the balance, relative to the largest energy so far.
    residual: f64 = own.0.residual();
}

#[pymethods]
impl PyEnergyBalance {
    /// All terms by their names: dict of numbers, J, in the plane J/m.
    fn to_dict(&self) -> Named<String, f64> {
        EnergyTerm::ALL.into_iter().map(|term| (term.to_string(), self.0.term(term))).collect()
    }

    fn _repr_html_(&self) -> String {
        let row = |term: EnergyTerm| {
            format!("<tr><td>{term}</td><td>{:.4e}</td></tr>", self.0.term(term))
        };
        let rows: String = EnergyTerm::ALL.into_iter().map(row).collect();
        format!(
            "<table><tr><th>energy</th><th>J (in the plane J/m)</th></tr>{rows}<tr><td>residual, relative</td>\
             <td>{:.1e}</td></tr></table>",
            self.0.residual()
        )
    }

    fn __repr__(&self) -> String {
        let (input, residual) = (self.0.input, self.0.residual());
        format!("EnergyBalance(input {input:.6e} J, in the plane J/m, residual {residual:.1e})")
    }
}
