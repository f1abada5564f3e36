//! Rows of the reduced system of contact in the plane.

use super::delassus::Delassus;
use crate::geometry::COMPONENTS_IN_PLANE;
use crate::interface::Condition;
use crate::linalg::largest;

/// Row of the reduced system.
pub(super) struct ReducedRow {
    pub(super) element: usize,
    /// Index of the condition within the element, 0 or 1.
    pub(super) condition: usize,
    /// Indices of the element's gap and slip in contact vectors.
    places: [usize; COMPONENTS_IN_PLANE],
    /// Columns of the element's tractions in the matrix, normal and tangential, if they are unknown.
    pub(super) columns: [Option<usize>; COMPONENTS_IN_PLANE],
    /// Factor that makes the largest entry of the row 1.
    pub(super) scale: f64,
    /// The same for the row of the factored matrix.
    pub(super) factored_scale: f64,
}

impl ReducedRow {
    /// Row of a condition of an element, with its element's unknown columns.
    pub(super) fn new(
        element: usize,
        condition: usize,
        places: [usize; COMPONENTS_IN_PLANE],
        columns: [Option<usize>; COMPONENTS_IN_PLANE],
    ) -> Self {
        Self { element, condition, places, columns, scale: 1.0, factored_scale: 1.0 }
    }

    /// Appends the scaled row of `condition` to `matrix`; returns its scale.
    ///
    /// `size`: order of W. `dofs`: unknown contact components.
    ///
    /// `None` if the row is zero or not finite.
    pub(super) fn append(
        &self,
        condition: &Condition,
        delassus: &Delassus,
        size: usize,
        dofs: &[usize],
        matrix: &mut Vec<f64>,
    ) -> Option<f64> {
        let gaps = &delassus[self.places[0] * size..][..size];
        let slips = &delassus[self.places[1] * size..][..size];
        let row_start = matrix.len();
        // Most conditions contain a gap or a slip alone.
        let gap = condition.gap;
        let slip = condition.slip;
        if slip == 0.0 {
            matrix.extend(dofs.iter().map(|&j| gap * gaps[j]));
        } else if gap == 0.0 {
            matrix.extend(dofs.iter().map(|&j| -(slip * slips[j])));
        } else {
            matrix.extend(dofs.iter().map(|&j| gap * gaps[j] - slip * slips[j]));
        }
        let values = &mut matrix[row_start..];
        for (column, coefficient) in
            self.columns.into_iter().zip([condition.pressure, condition.shear])
        {
            if let Some(column) = column {
                values[column] += coefficient;
            }
        }
        let max_entry = largest(values);
        if !(max_entry > 0.0 && max_entry.is_finite()) {
            return None;
        }
        let scale = 1.0 / max_entry;
        for value in values {
            *value *= scale;
        }
        Some(scale)
    }
}
