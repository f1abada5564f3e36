//! Forces that pass through a horizontal cut.

/// Linear function of displacement, velocity and acceleration, as sparse rows.
///
/// Each row is a list of `(index of the unknown, weight)`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SectionRows {
    /// Weights of the displacements, N/m.
    pub displacement: Vec<(usize, f64)>,
    /// Weights of the velocities: dashpots and stiffness-proportional damping.
    pub velocity: Vec<(usize, f64)>,
    /// Weights of the accelerations: the share of the mass above that sits on the cut's nodes.
    pub acceleration: Vec<(usize, f64)>,
}

impl SectionRows {
    /// The resultant's value; slices of all unknowns, indices beyond their ends count as zero.
    pub fn value(&self, displacement: &[f64], velocity: &[f64], acceleration: &[f64]) -> f64 {
        let pairs = [
            (&self.displacement, displacement),
            (&self.velocity, velocity),
            (&self.acceleration, acceleration),
        ];
        let row_value = |(row, values): (&Vec<(usize, f64)>, &[f64])| -> f64 {
            row.iter().map(|&(index, weight)| weight * values.get(index).unwrap_or(&0.0)).sum()
        };
        pairs.into_iter().map(row_value).sum()
    }
}

/// Resultant of what the part above a horizontal cut exerts on the part below, per metre.
///
/// It holds the elastic forces, the damping forces except mass-proportional ones, and the inertia
/// of the elements above as far as it sits on the nodes of the cut. To count the weight of the
/// elements above too, add the acceleration of gravity to the vertical accelerations.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Height of the cut, m.
    pub height: f64,
    /// Horizontal force on the part below, N, positive to the right: the base shear when the cut
    /// is the base.
    pub shear: SectionRows,
    /// Vertical force on the part below, N, positive downwards (compression).
    pub compression: SectionRows,
    /// Moment on the part below about the reference point, N m, counter-clockwise.
    pub moment: SectionRows,
}
