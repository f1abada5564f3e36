//! The columns of histories, in CSV and in archives of arrays.

use super::{Quantity, TimeSeries};
use crate::coupled::{EnergyTerm, Probe};
use crate::text::column::{column, distinct};

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

impl TimeSeries {
    /// Names of time, scalars and probes; those of probes differ from all others in any file.
    pub(super) fn columns(&self) -> Vec<String> {
        let mut columns = vec![column("time", "s")];
        columns.extend(Quantity::ALL.map(Quantity::column));
        let others = CONTACT.iter().chain(&MOTION).map(|&name| name.to_owned());
        let others = EnergyTerm::ALL.map(EnergyTerm::column).into_iter().chain(others);
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
