//! Elongation, end rotations and twist of a beam in space.

use super::axes::BeamAxes;
use crate::fem::element_matrix::add_matrix;
use crate::fem::small_matrix::{add_congruent, add_outer};

/// Number of degrees of freedom.
pub(super) const DOF_COUNT: usize = 12;
/// Number of basic deformations of stretching and bending.
pub(super) const BASIC_COUNT: usize = 5;

/// Elastic torsion of a beam.
pub(super) struct Torsion {
    /// G J/L, N m.
    pub(super) stiffness: f64,
    /// Rotation of the second end about the beam relative to the first, rad.
    pub(super) twist: f64,
}

impl Torsion {
    /// Torque, N m.
    pub(super) fn torque(&self) -> f64 {
        self.stiffness * self.twist
    }

    /// Stored energy, J.
    pub(super) fn energy(&self) -> f64 {
        0.5 * self.stiffness * self.twist * self.twist
    }
}

/// Basic deformations due to a unit displacement of each degree of freedom.
pub(super) struct BasicRows {
    /// Elongation, then the rotations of both ends relative to the chord about z, and about y.
    pub(super) bending: [[f64; DOF_COUNT]; BASIC_COUNT],
    /// Rotation of the second end about x less that of the first.
    pub(super) twist: [f64; DOF_COUNT],
}

impl BasicRows {
    /// Rows of a beam with these axes, whose ends are at its nodes.
    pub(super) fn new(axes: &BeamAxes) -> Self {
        let [x, y, z] = axes.axes;
        let mut bending = [[0.0; DOF_COUNT]; BASIC_COUNT];
        let mut twist = [0.0; DOF_COUNT];
        for k in 0..3 {
            bending[0][k] = -x[k];
            bending[0][6 + k] = x[k];
            // The chord turns about z by displacements along y, and about y by those against z.
            let about_z = y[k] / axes.length;
            let about_y = -z[k] / axes.length;
            for (first_row, chord_rotation, axis) in [(1, about_z, z), (3, about_y, y)] {
                for row in first_row..first_row + 2 {
                    bending[row][k] = chord_rotation;
                    bending[row][6 + k] = -chord_rotation;
                }
                bending[first_row][3 + k] = axis[k];
                bending[first_row + 1][9 + k] = axis[k];
            }
            twist[3 + k] = -x[k];
            twist[9 + k] = x[k];
        }
        Self { bending, twist }
    }

    /// Adds Rᵀ k R of bending and torsion to a row-major `matrix`.
    pub(super) fn add_stiffness(
        &self,
        stiffness: &[[f64; BASIC_COUNT]; BASIC_COUNT],
        torsional_stiffness: f64,
        matrix: &mut [f64],
    ) {
        let mut sum = [[0.0; DOF_COUNT]; DOF_COUNT];
        add_congruent(1.0, &self.bending, stiffness, &mut sum);
        add_outer(torsional_stiffness, &self.twist, &mut sum);
        add_matrix(matrix, &sum);
    }
}
