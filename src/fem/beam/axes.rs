//! Local axes of a beam in space.

use crate::error::{Result, positive, require};
use crate::fem::vector::{add, cross, direction, dot};

/// Smallest sine of the angle between a beam and its orientation.
///
/// Below it rounding errors of the coordinates turn the axes of the section.
const LEAST_SINE: f64 = 1e-6;

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
    /// Axes of a beam between two `ends`; its y axis lies in the plane of the beam and the `orientation`.
    pub(super) fn new(ends: [[f64; 3]; 2], orientation: [f64; 3]) -> Result<Self> {
        let (length, along) = direction(add(ends[1], -1.0, ends[0]));
        positive("length of the beam", length)?;
        let (_, orientation) = direction(orientation);
        let (sine, y) = direction(add(orientation, -dot(orientation, along), along));
        let quantity = "sine of the angle between the beam and its orientation";
        require(quantity, sine, sine > LEAST_SINE, "above 1e-6: an orientation across the beam")?;
        Ok(Self { length, axes: [along, y, cross(along, y)] })
    }

    /// Local displacements of the ends due to displacements of the nodes, `offsets` away.
    pub(super) fn to_local(&self, offsets: &[[f64; 3]; 2]) -> EndsMatrix {
        let mut matrix = [[0.0; 12]; 12];
        for (end, &offset) in offsets.iter().enumerate() {
            for (k, &axis) in self.axes.iter().enumerate() {
                let row = 6 * end + k;
                let [displacement, rotation] = [6 * end, 6 * end + 3];
                matrix[row][displacement..displacement + 3].copy_from_slice(&axis);
                // Rigid arm: axis · (θ × offset).
                matrix[row][rotation..rotation + 3].copy_from_slice(&cross(offset, axis));
                matrix[row + 3][rotation..rotation + 3].copy_from_slice(&axis);
            }
        }
        matrix
    }
}
