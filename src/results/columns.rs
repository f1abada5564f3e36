//! Columns of time series, in CSV and in archives of arrays.

use super::{Quantity, TimeSeries};
use crate::coupled::{EnergyTerm, Probe};
use crate::geometry::{ContactElement, ContactLayout};
use crate::interface::ContactState;
use crate::text::column::{column, distinct};

/// Columns of contact frames for times, modes and the words of modes.
pub(super) const CONTACT: [&str; 3] = ["contact_time_s", "contact_mode", "contact_mode_words"];

/// A number of an element's contact state.
type Number = fn(&ContactState) -> f64;

/// Columns of motion frames.
pub(super) const MOTION: [&str; 5] = [
    "motion_time_s",
    "motion_displacement",
    "motion_velocity",
    "motion_free_field_m",
    "motion_free_field_across_m",
];

impl TimeSeries {
    /// Ends of the elements, with their heights if there are walls.
    pub(super) fn element_ends(&self) -> Vec<(&'static str, Vec<f64>)> {
        const HEIGHT: usize = 2;
        let ends = |axis: usize, end: usize| {
            let name =
                [["left_m", "right_m"], ["front_m", "back_m"], ["bottom_m", "top_m"]][axis][end];
            let of = |own: &ContactElement| {
                if axis == HEIGHT { own.heights()[end] } else { own.ends()[axis][end] }
            };
            (name, self.elements().iter().map(of).collect())
        };
        let axes = ContactLayout::for_elements(self.elements()).axes();
        let heights = ContactElement::any_wall(self.elements()).then_some(HEIGHT);
        axes.chain(heights).flat_map(|axis| [ends(axis, 0), ends(axis, 1)]).collect()
    }

    /// Columns of contact frames with a number per element, and their values.
    pub(super) fn contact_numbers(&self) -> Vec<(String, Number)> {
        let numbers = ContactState::NUMBERS.into_iter().filter(|own| self.in_plan() || !own.2);
        numbers.map(|(word, unit, _, value)| (column(word, unit), value)).collect()
    }

    /// Names of time, scalars and probes; a probe's name differs from all other names in any file.
    pub(super) fn columns(&self) -> Vec<String> {
        let in_plan = self.in_plan();
        let mut columns = vec![column("time", "s")];
        columns.extend(Quantity::recorded(in_plan).map(|quantity| quantity.column(in_plan)));
        let others = CONTACT.iter().chain(&MOTION).map(|&name| name.to_owned());
        let ends = self.element_ends().into_iter().map(|(name, _)| format!("element_{name}"));
        let numbers = self.contact_numbers().into_iter().map(|(name, _)| format!("contact_{name}"));
        let energies = EnergyTerm::ALL.into_iter().map(|term| term.column(in_plan));
        let others = energies.chain(others).chain(ends).chain(numbers);
        let taken: Vec<String> = columns.iter().cloned().chain(others).collect();
        columns.extend(distinct(&taken, self.probes.iter().map(Probe::column)));
        columns
    }

    /// Values of the columns.
    pub(super) fn column_values(&self) -> impl Iterator<Item = &[f64]> {
        let scalars = Quantity::recorded(self.in_plan()).map(|quantity| self.series(quantity));
        let probes = self.probe_values.iter().map(Vec::as_slice);
        std::iter::once(self.times()).chain(scalars).chain(probes)
    }
}
