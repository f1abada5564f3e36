//! Local axes and ends of beams.

use crate::error::{Result, positive, require};
use crate::fem::vector::{add_scaled, cross, dot, norm, unit_vector};

/// Smallest sine of the angle between a beam and its orientation.
///
/// For a smaller angle, rounding errors of the coordinates would rotate the axes of the section noticeably.
const MIN_ORIENTATION_SINE: f64 = 1e-6;

/// Matrix of the twelve degrees of freedom at the ends of a beam.
///
/// Local, at each end: displacements along the axes x (along the beam), y and z, then the rotations about these axes.
/// Global: displacements of the node along x, y and z, then its rotations about these axes.
pub(super) type EndsMatrix = [[f64; 12]; 12];

/// Axes and end offsets of a beam, for the forces at its ends.
pub(crate) struct EndFrame {
    /// Unit vectors along the beam and along y and z of its section, right-handed.
    pub(crate) axes: [[f64; 3]; 3],
    /// Vectors from the nodes to the ends, m.
    pub(crate) offsets: [[f64; 3]; 2],
}

/// Length and local axes of a beam in space.
pub(super) struct BeamAxes {
    /// Distance of the ends, m.
    pub(super) length: f64,
    /// Unit vectors along the beam and along y and z of its section.
    pub(super) axes: [[f64; 3]; 3],
}

impl BeamAxes {
    /// Axes of a beam between two `ends` (coordinates in m).
    ///
    /// The y axis lies in the plane of the beam and the vector `orientation`.
    pub(super) fn new(ends: [[f64; 3]; 2], orientation: [f64; 3]) -> Result<Self> {
        let chord = add_scaled(ends[1], -1.0, ends[0]);
        let length = positive("length of the beam", norm(chord))?;
        let tangent = unit_vector(chord);
        let unit_orientation = unit_vector(orientation);
        let normal_part = add_scaled(unit_orientation, -dot(unit_orientation, tangent), tangent);
        let sine = norm(normal_part);
        let quantity = "sine of the angle between the beam and its orientation";
        let needed = "above 1e-6: an orientation that is not along the beam";
        require(quantity, sine, sine > MIN_ORIENTATION_SINE, needed)?;
        let y = unit_vector(normal_part);
        Ok(Self { length, axes: [tangent, y, cross(tangent, y)] })
    }

    /// Transformation of displacements of the nodes to local displacements of the ends.
    ///
    /// `offsets`: vectors from the nodes to the ends, m.
    pub(super) fn to_local(&self, offsets: &[[f64; 3]; 2]) -> EndsMatrix {
        let mut matrix = [[0.0; 12]; 12];
        for (end, &offset) in offsets.iter().enumerate() {
            for (k, &axis) in self.axes.iter().enumerate() {
                let row = 6 * end + k;
                let first_displacement = 6 * end;
                let first_rotation = 6 * end + 3;
                matrix[row][first_displacement..first_displacement + 3].copy_from_slice(&axis);
                // A rigid arm displaces the end by axis · (θ × offset).
                matrix[row][first_rotation..first_rotation + 3]
                    .copy_from_slice(&cross(offset, axis));
                matrix[row + 3][first_rotation..first_rotation + 3].copy_from_slice(&axis);
            }
        }
        matrix
    }
}
