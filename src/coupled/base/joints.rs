//! Joints of a base: their rows of B, and the ground's part of contact vectors.

use super::joint_line::{JointLine, PlacedJoint};
use super::line::NodesOnElement;
use super::transformation::{Rows, SparseVector};
use super::{PlacedBase, element_components};
use std::borrow::Cow;

use crate::error::Result;
use crate::geometry::{ContactElement, ContactLayout, check_count};

impl PlacedBase {
    /// Adds joints, with their nodes and contact elements.
    ///
    /// The elements of joints follow those of the ground.
    pub(crate) fn with_joints(mut self, lines: &[JointLine]) -> Result<Self> {
        if lines.is_empty() {
            return Ok(self);
        }
        let ground_layout = self.elements.layout();
        let mut element_count = ground_layout.elements();
        for line in lines {
            let elements = element_count..element_count + line.elements().len();
            element_count = elements.end;
            self.joints.push(PlacedJoint { line: line.clone(), elements });
        }
        check_count(element_count, ground_layout.components())?;
        self.layout = ContactLayout::new(ground_layout.components(), element_count);
        let mut rows = vec![SparseVector::new(); self.layout.len()];
        if let Rows::Sparse(ground_rows) = &self.rows {
            for (i, row) in ground_rows.iter().enumerate() {
                rows[self.contact_index(i)].clone_from(row);
            }
        }
        for joint in &self.joints {
            for (e, components) in joint.elements.clone().zip(element_rows(&joint.line)) {
                for (component, row) in components.into_iter().enumerate() {
                    rows[self.layout.index_of(component, e)] = row;
                }
            }
            self.areas.extend(joint.line.elements().iter().map(ContactElement::area));
            self.nodes.extend(joint.line.sides().iter().flatten().cloned());
        }
        self.rows = Rows::Sparse(rows);
        Ok(self)
    }

    /// The joints.
    pub(crate) fn joints(&self) -> &[PlacedJoint] {
        &self.joints
    }

    /// Index of the joint of an element; 0 for an element of the ground.
    pub(crate) fn joint_of(&self, e: usize) -> usize {
        self.joints.iter().position(|joint| joint.elements.contains(&e)).unwrap_or(0)
    }

    /// A contact element of the ground or of a joint.
    pub(crate) fn element(&self, e: usize) -> &ContactElement {
        if let Some(element) = self.elements.get(e) {
            return element;
        }
        let joint = self.joints.iter().find(|joint| joint.elements.contains(&e));
        joint.map_or(&self.elements[0], |joint| &joint.line.elements()[e - joint.elements.start])
    }

    /// Initial gap of an element, m; zero on the ground.
    pub(crate) fn initial_gap(&self, e: usize) -> f64 {
        let joint = self.joints.iter().find(|joint| joint.elements.contains(&e));
        joint.map_or(0.0, |joint| joint.line.gap)
    }

    /// Initial gaps as jumps of a contact vector, m; empty if there are none.
    pub(crate) fn initial_gaps(&self) -> Vec<f64> {
        if self.joints.iter().all(|joint| joint.line.gap == 0.0) {
            return Vec::new();
        }
        let mut gaps = vec![0.0; self.layout.len()];
        for joint in &self.joints {
            gaps[joint.elements.clone()].fill(joint.line.gap);
        }
        gaps
    }

    /// Index in a contact vector of an entry of the ground's elements.
    fn contact_index(&self, ground_index: usize) -> usize {
        let [component, element] = self.elements.layout().component_and_element(ground_index);
        self.layout.index_of(component, element)
    }

    /// Copies the entries of the ground's elements out of a contact vector.
    pub(crate) fn copy_ground_part(&self, contact: &[f64], ground: &mut [f64]) {
        if self.joints.is_empty() {
            return ground.copy_from_slice(contact);
        }
        let count = self.elements.len();
        for (whole, part) in
            contact.chunks_exact(self.layout.elements()).zip(ground.chunks_exact_mut(count))
        {
            part.copy_from_slice(&whole[..count]);
        }
    }

    /// Overwrites the entries of the ground's elements in a contact vector.
    pub(crate) fn set_ground_part(&self, ground: &[f64], contact: &mut [f64]) {
        if self.joints.is_empty() {
            return contact.copy_from_slice(ground);
        }
        let count = self.elements.len();
        for (whole, part) in
            contact.chunks_exact_mut(self.layout.elements()).zip(ground.chunks_exact(count))
        {
            whole[..count].copy_from_slice(part);
        }
    }

    /// A contact vector with these entries of the ground's elements, and zeros at joints.
    pub(crate) fn with_zero_joints(&self, ground: &[f64]) -> Vec<f64> {
        let mut contact = vec![0.0; self.layout.len()];
        self.set_ground_part(ground, &mut contact);
        contact
    }

    /// Entries of the ground's elements in a matrix of all contact components, row by row.
    pub(crate) fn ground_matrix<'a>(&self, matrix: &'a [f64]) -> Cow<'a, [f64]> {
        if self.joints.is_empty() {
            return Cow::Borrowed(matrix);
        }
        let ground_layout = self.elements.layout();
        let mut ground = vec![0.0; ground_layout.matrix_len()];
        for (i, row) in ground.chunks_exact_mut(ground_layout.len()).enumerate() {
            let row_start = self.contact_index(i) * self.layout.len();
            self.copy_ground_part(&matrix[row_start..row_start + self.layout.len()], row);
        }
        Cow::Owned(ground)
    }

    /// Ground matrix (row by row) as a matrix of all contact components, zero at joints.
    pub(crate) fn spread_ground_matrix(&self, ground: Vec<f64>) -> Vec<f64> {
        if self.joints.is_empty() {
            return ground;
        }
        let mut matrix = vec![0.0; self.layout.matrix_len()];
        let ground_layout = self.elements.layout();
        for (i, row) in ground.chunks_exact(ground_layout.len()).enumerate() {
            let row_start = self.contact_index(i) * self.layout.len();
            self.set_ground_part(row, &mut matrix[row_start..row_start + self.layout.len()]);
        }
        matrix
    }
}

/// Rows of B of a joint's elements, by elements and components.
///
/// A row is the mean displacement of the upper side minus that of the lower side.
fn element_rows(line: &JointLine) -> Vec<Vec<SparseVector>> {
    let sides = line.sides();
    let nodes = sides.concat();
    let mut rows = Vec::with_capacity(line.elements().len());
    for element in line.elements() {
        let mut weights = NodesOnElement::along(&sides[0], element).mean_weights();
        let lower_weights = NodesOnElement::along(&sides[1], element).mean_weights();
        weights.extend(
            lower_weights.into_iter().map(|(node, weight)| (sides[0].len() + node, -weight)),
        );
        rows.push(element_components(&nodes, &weights, element));
    }
    rows
}
