//! Local axes of a beam in space.

use crate::error::{Result, positive, require};
use crate::fem::vector::{add, cross, dot, length, unit};

/// Smallest sine of the angle between a beam and its orientation.
///
/// For smaller angles rounding errors of the coordinates rotate the axes of the section.
const MIN_ORIENTATION_SINE: f64 = 1e-6;

/// Matrix of the twelve degrees of freedom at the ends of a beam.
///
/// Local, at each end: displacements along the beam, along y and along z, then the rotations about these axes.
/// Global: displacements of the node along x, y and z, then its rotations about them.
pub(super) type EndsMatrix = [[f64; 12]; 12];

/// Length of a beam and its axes: along the beam, then y and z of its section.
pub(super) struct Axes {
    pub(super) length: f64,
    pub(super) axes: [[f64; 3]; 3],
}

impl Axes {
    /// Axes of a beam between two `ends`.
    ///
    /// The y axis lies in the plane of the beam and the `orientation`.
    pub(super) fn new(ends: [[f64; 3]; 2], orientation: [f64; 3]) -> Result<Self> {
        let axis = add(ends[1], -1.0, ends[0]);
        let beam_length = positive("length of the beam", length(axis))?;
        let along = unit(axis);
        let orientation = unit(orientation);
        let across = add(orientation, -dot(orientation, along), along);
        let sine = length(across);
        let quantity = "sine of the angle between the beam and its orientation";
        let needed = "above 1e-6: an orientation across the beam";
        require(quantity, sine, sine > MIN_ORIENTATION_SINE, needed)?;
        let y = unit(across);
        Ok(Self { length: beam_length, axes: [along, y, cross(along, y)] })
    }

    /// Local displacements of the ends due to displacements of the nodes, `offsets` away.
    pub(super) fn to_local(&self, offsets: &[[f64; 3]; 2]) -> EndsMatrix {
        let mut matrix = [[0.0; 12]; 12];
        for (end, &offset) in offsets.iter().enumerate() {
            for (k, &axis) in self.axes.iter().enumerate() {
                let row = 6 * end + k;
                let displacement = 6 * end;
                let rotation = 6 * end + 3;
                matrix[row][displacement..displacement + 3].copy_from_slice(&axis);
                // Rigid arm: axis · (θ × offset).
                matrix[row][rotation..rotation + 3].copy_from_slice(&cross(offset, axis));
                matrix[row + 3][rotation..rotation + 3].copy_from_slice(&axis);
            }
        }
        matrix
    }
}
