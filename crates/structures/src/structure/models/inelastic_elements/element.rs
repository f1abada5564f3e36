//! An element with internal variables, and its degrees of freedom in the model.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use crate::error::{Error, Result};
use crate::fem::{Element, InelasticForce};
use crate::structure::Triplets;

/// Weight of a deformation that links prevent, relative to its largest term.
///
/// Rounding of rigid arms leaves far less.
const LINK_ROUNDING: f64 = 1e-9;

/// An element with internal variables, and its degrees of freedom in the model.
#[derive(Clone)]
pub(super) struct InelasticElement {
    /// Index in the mesh.
    pub(super) index: usize,
    pub(super) element: Arc<dyn Element>,
    pub(super) coordinates: Vec<[f64; 3]>,
    /// Terms (degree of freedom, weight) of the element's degrees of freedom, one after the other.
    pub(super) terms: Vec<(usize, f64)>,
    /// Range of the terms of each of the element's degrees of freedom.
    pub(super) rows: Vec<Range<usize>>,
    /// Degrees of freedom of the model that equal those of the element; `None` if one is a sum.
    pub(super) dofs: Option<Vec<usize>>,
    /// Range of the element's internal variables.
    pub(super) variables: Range<usize>,
}

impl InelasticElement {
    /// Overwrites `element_displacement` by the displacements of the element's degrees of freedom.
    pub(super) fn gather(&self, displacement: &[f64], element_displacement: &mut [f64]) {
        if let Some(dofs) = &self.dofs {
            let values = element_displacement.iter_mut().zip(dofs);
            return values.for_each(|(value, dof)| *value = displacement[*dof]);
        }
        for (value, row) in element_displacement.iter_mut().zip(&self.rows) {
            let terms = self.terms[row.clone()].iter();
            *value = terms.map(|&(dof, weight)| weight * displacement[dof]).sum();
        }
    }

    /// Degrees of freedom of the model that equal those of the element; `None` if one is a sum.
    pub(super) fn single_dofs(&self) -> Option<Vec<usize>> {
        let single_dof = |row: &Range<usize>| match self.terms[row.clone()] {
            [(dof, 1.0)] => Some(dof),
            _ => None,
        };
        self.rows.iter().map(single_dof).collect()
    }

    /// Adds forces on the element's degrees of freedom to those on the model's.
    pub(super) fn scatter(&self, element_force: &[f64], force: &mut [f64]) {
        for (element_value, row) in element_force.iter().zip(&self.rows) {
            for &(dof, weight) in &self.terms[row.clone()] {
                force[dof] += weight * element_value;
            }
        }
    }

    /// Adds a matrix of the element, with all its zeros, to that of the model.
    pub(super) fn scatter_matrix(&self, element_matrix: &[f64], matrix: &mut Triplets) {
        if let Some(dofs) = &self.dofs {
            return matrix.add_block(dofs, element_matrix);
        }
        for (values, row) in element_matrix.chunks_exact(self.rows.len()).zip(&self.rows) {
            for (value, column) in values.iter().zip(&self.rows) {
                for &(i, row_weight) in &self.terms[row.clone()] {
                    for &(j, column_weight) in &self.terms[column.clone()] {
                        matrix.add(i, j, row_weight * column_weight * value);
                    }
                }
            }
        }
    }

    /// Whether the element computes its tangent with its force.
    pub(super) fn has_shared_evaluation(&self) -> bool {
        self.element.inelastic().is_some_and(InelasticForce::has_shared_evaluation)
    }

    /// Number of stresses that the model stores for the element.
    pub(super) fn stress_count(&self) -> usize {
        self.element.inelastic().map_or(0, InelasticForce::stress_count)
    }

    /// Returns an error if links and ties prevent a deformation that can yield.
    pub(super) fn check_links(&self, force: &dyn InelasticForce) -> Result<()> {
        for deformation in force.yielding_deformations(&self.coordinates) {
            let mut sums: HashMap<usize, f64> = HashMap::new();
            let mut largest_term = 0.0_f64;
            for (weight, row) in deformation.iter().zip(&self.rows) {
                for &(dof, factor) in &self.terms[row.clone()] {
                    *sums.entry(dof).or_default() += weight * factor;
                    largest_term = largest_term.max((weight * factor).abs());
                }
            }
            let largest_sum = sums.values().fold(0.0_f64, |max, sum| max.max(sum.abs()));
            if largest_sum <= LINK_ROUNDING * largest_term {
                let reason = "rigid links or ties between its nodes prevent a deformation that can yield: remove \
                              them, or the element";
                return Err(Error::part(self.name(), reason));
            }
        }
        Ok(())
    }

    /// Text that names the element in errors.
    pub(super) fn name(&self) -> String {
        format!("element {} on nodes {:?}", self.index, self.element.nodes())
    }
}
