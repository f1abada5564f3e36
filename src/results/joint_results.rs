//! Series, snapshots and envelopes of joints.

use super::columns::{contact_numbers, element_ends};
use super::csv::{contact_csv, csv_lines};
use super::{ContactFrame, JointQuantity, Run, TimeSeries};
use crate::bem::ContactElement;
use crate::error::{Result, in_bounds};
use crate::text::column::column;
use crate::text::csv::Csv;

/// Columns of envelopes that only a base with walls has, and every joint.
const HEIGHT_COLUMNS: [&str; 2] = ["bottom", "top"];

impl TimeSeries {
    /// Time series of a quantity of a joint at [`TimeSeries::times`]; joints count from 0, the builder's first.
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) for a joint that does not exist.
    pub fn joint_series(&self, joint: usize, quantity: JointQuantity) -> Result<&[f64]> {
        self.joints.find(joint, quantity)
    }

    /// Contact elements of each joint, in the order of the builder and of the joint's nodes.
    ///
    /// Positions are those of the upper side at rest, m.
    pub fn joint_elements(&self) -> &[Vec<ContactElement>] {
        &self.joints.elements
    }

    /// Snapshots of a joint, in the order of its elements; none unless
    /// [`Recorder::contact`](super::Recorder::contact) was set.
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) for a joint that does not exist.
    pub fn joint_frames(&self, joint: usize) -> Result<impl Iterator<Item = ContactFrame<'_>>> {
        let range = self.joints.element_range(joint)?;
        let first_element = self.elements().len();
        Ok(self.frames_of(first_element + range.start..first_element + range.end))
    }

    /// [Snapshots of a joint](TimeSeries::joint_frames) as CSV, with the columns of [`TimeSeries::contact_csv`].
    ///
    /// Elements count from 0 in the joint; each line has the heights of its element, `bottom_m` and `top_m`.
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) for a joint that does not exist.
    pub fn joint_csv(&self, joint: usize) -> Result<Csv> {
        let frames = self.joint_frames(joint)?;
        let elements = &self.joint_elements()[joint];
        Ok(contact_csv(&element_ends(elements, true), &contact_numbers(false), frames))
    }
}

impl Run {
    /// Columns of the [envelope](Run::joint_envelopes) of a joint: word, SI unit, value.
    pub fn joint_envelope_columns(
        &self,
    ) -> impl Iterator<Item = (&'static str, &'static str, fn(&super::ElementEnvelope) -> f64)>
    {
        let columns = Self::ENVELOPE_COLUMNS.into_iter();
        columns.filter_map(|(word, unit, is_in_run, value)| {
            let has_column = HEIGHT_COLUMNS.contains(&word) || is_in_run(self);
            has_column.then_some((word, unit, value))
        })
    }

    /// [Envelopes of a joint](Run::joint_envelopes) as CSV, with the columns of [`Run::envelope_csv`].
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) for a joint that does not exist.
    pub fn joint_envelope_csv(&self, joint: usize) -> Result<Csv> {
        let index = in_bounds("joint", joint, self.joint_envelopes.len())?;
        let mut heading = vec!["element".to_owned()];
        heading.extend(self.joint_envelope_columns().map(|(word, unit, _)| column(word, unit)));
        let rows = self.joint_envelopes[index].iter().enumerate().map(|(element, envelope)| {
            let values = self.joint_envelope_columns().map(move |(.., value)| value(envelope));
            (format!("{element},"), values)
        });
        Ok(csv_lines(&heading.join(","), rows))
    }
}
