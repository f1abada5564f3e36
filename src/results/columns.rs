//! The columns of histories, in CSV and in archives of arrays.

use super::{Histories, Quantity};
use crate::column::{column, distinct};
#[cfg(feature = "npz")]
use crate::coupled::Ledger;
use crate::coupled::Probe;

/// Terms of the ledger, in the order of [`ledger_terms`].
pub(super) const LEDGER: [&str; 12] = [
    "kinetic_energy_j_per_m",
    "strain_energy_j_per_m",
    "hysteresis_energy_j_per_m",
    "damping_energy_j_per_m",
    "numerical_energy_j_per_m",
    "soil_energy_j_per_m",
    "contact_energy_j_per_m",
    "layer_energy_j_per_m",
    "preload_energy_j_per_m",
    INPUT,
    "relative_input_energy_j_per_m",
    "soil_error_bound_j_per_m",
];

/// The ledger's input.
pub(super) const INPUT: &str = "input_energy_j_per_m";

/// Elements and contact frames.
pub(super) const CONTACT: [&str; 9] = [
    "element_left_m",
    "element_right_m",
    "contact_time_s",
    "contact_gap_m",
    "contact_slip_m",
    "contact_pressure_pa",
    "contact_shear_pa",
    "contact_mode",
    "contact_mode_words",
];

/// Motion frames.
pub(super) const MOTION: [&str; 4] =
    ["motion_time_s", "motion_displacement", "motion_velocity", "motion_free_field_m"];

/// Terms in the order of [`LEDGER`].
#[cfg(feature = "npz")]
pub(super) fn ledger_terms(ledger: &Ledger) -> [f64; 12] {
    [
        ledger.kinetic,
        ledger.strain,
        ledger.hysteresis,
        ledger.damping,
        ledger.numerical,
        ledger.soil,
        ledger.contact,
        ledger.layer,
        ledger.preload,
        ledger.input,
        ledger.relative_input,
        ledger.soil_error_bound,
    ]
}

impl Histories {
    /// Names of time, scalars and probes; those of probes differ from all others in any file.
    pub(super) fn columns(&self) -> Vec<String> {
        let mut columns = vec![column("time", "s")];
        columns.extend(Quantity::ALL.map(Quantity::column));
        let others = LEDGER.iter().chain(&CONTACT).chain(&MOTION).map(|&name| name.to_owned());
        let taken: Vec<String> = columns.iter().cloned().chain(others).collect();
        columns.extend(distinct(&taken, self.probes.iter().map(Probe::column)));
        columns
    }

    /// Their values.
    pub(super) fn column_values(&self) -> impl Iterator<Item = &[f64]> {
        let scalars = Quantity::ALL.iter().map(|&quantity| self.series(quantity));
        let probes = self.probe_values.iter().map(Vec::as_slice);
        std::iter::once(self.times()).chain(scalars).chain(probes)
    }
}
