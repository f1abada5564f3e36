//! Columns of time series, in CSV and in archives of arrays.

use super::{Quantity, TimeSeries};
use crate::coupled::{EnergyTerm, Probe};
use crate::geometry::{ContactElement, ContactLayout};
use crate::interface::ContactState;
use crate::text::column::{column, distinct};

/// Columns of contact frames for times, modes and the words of modes.
pub(super) const CONTACT_COLUMNS: [&str; 3] =
    ["contact_time_s", "contact_mode", "contact_mode_words"];

/// Function that returns a number of an element's contact state.
pub(super) type ContactNumber = fn(&ContactState) -> f64;

/// Columns of motion frames.
pub(super) const MOTION_COLUMNS: [&str; 5] = [
    "motion_time_s",
    "motion_displacement",
    "motion_velocity",
    "motion_free_field_m",
    "motion_free_field_across_m",
];

/// Ends of elements, with their heights if `with_heights`: names and values of columns.
pub(super) fn element_ends(
    elements: &[ContactElement],
    with_heights: bool,
) -> Vec<(&'static str, Vec<f64>)> {
    let end_names = [["left_m", "right_m"], ["front_m", "back_m"]];
    let mut columns = Vec::new();
    for axis in ContactLayout::for_elements(elements).axes() {
        for end in [0, 1] {
            let values = elements.iter().map(|element| element.ends()[axis][end]);
            columns.push((end_names[axis][end], values.collect()));
        }
    }
    if with_heights {
        for (end, name) in ["bottom_m", "top_m"].into_iter().enumerate() {
            let values = elements.iter().map(|element| element.heights()[end]);
            columns.push((name, values.collect()));
        }
    }
    columns
}

/// Columns of contact frames with a number per element, and their values.
pub(super) fn contact_numbers(in_plan: bool) -> Vec<(String, ContactNumber)> {
    let mut columns = Vec::new();
    for (word, unit, is_in_plan_only, value) in ContactState::NUMBER_COLUMNS {
        if in_plan || !is_in_plan_only {
            columns.push((column(word, unit), value));
        }
    }
    columns
}

impl TimeSeries {
    /// Ends of the elements of the base, with their heights if there are walls: names and values of columns.
    pub(super) fn base_ends(&self) -> Vec<(&'static str, Vec<f64>)> {
        element_ends(self.elements(), ContactElement::any_wall(self.elements()))
    }

    /// Names of the arrays of contact with a number per element, of a base or joint with these ends.
    fn contact_arrays(&self, ends: Vec<(&'static str, Vec<f64>)>) -> Vec<String> {
        let ends = ends.into_iter().map(|(name, _)| format!("element_{name}"));
        let numbers = contact_numbers(self.in_plan()).into_iter();
        ends.chain(numbers.map(|(name, _)| format!("contact_{name}"))).collect()
    }

    /// Names of time, scalars and probes; a probe's name differs from all other names in any file.
    pub(super) fn columns(&self) -> Vec<String> {
        let in_plan = self.in_plan();
        let mut columns = vec![column("time", "s")];
        columns.extend(Quantity::recorded(in_plan).map(|quantity| quantity.column(in_plan)));
        for foundation in 0..self.foundations.kept_count() {
            columns.extend(
                Quantity::recorded(in_plan).map(|quantity| {
                    format!("foundation_{foundation}_{}", quantity.column(in_plan))
                }),
            );
        }
        columns.extend(self.joints.columns());
        let mut used_names = columns.clone();
        used_names.extend(EnergyTerm::ALL_TERMS.into_iter().map(|term| term.column(in_plan)));
        used_names
            .extend(CONTACT_COLUMNS.iter().chain(&MOTION_COLUMNS).map(|&name| name.to_owned()));
        used_names.extend(self.contact_arrays(self.base_ends()));
        for (joint, elements) in self.joint_elements().iter().enumerate() {
            let mut arrays = self.contact_arrays(element_ends(elements, true));
            arrays.push("contact_mode".to_owned());
            used_names.extend(arrays.into_iter().map(|name| format!("joint_{joint}_{name}")));
        }
        columns.extend(distinct(&used_names, self.probes.iter().map(Probe::column)));
        columns
    }

    /// Values of the columns.
    pub(super) fn column_values(&self) -> impl Iterator<Item = &[f64]> {
        let scalars = Quantity::recorded(self.in_plan()).map(|quantity| self.series(quantity));
        let foundations = self.foundations.lists.all_lists().iter().map(Vec::as_slice);
        let joints = self.joints.lists.all_lists().iter().map(Vec::as_slice);
        let probes = self.probe_values.iter().map(Vec::as_slice);
        std::iter::once(self.times())
            .chain(scalars)
            .chain(foundations)
            .chain(joints)
            .chain(probes)
    }
}
