//! Forces and moments of a shell per unit of width.

use crate::error::{Result, require};
use crate::fem::vector::{add, cross, dot, length, unit};

/// Smallest sine of the angle between two directions that do not count as parallel.
const MIN_SINE_TO_AXIS: f64 = 1e-6;

/// Forces and moments of a shell at a point, per metre of width.
///
/// They belong to the axes e1, e2, n. [`in_axes`](Self::in_axes) gives them in axes that neighbouring elements
/// have in common: do so before averaging them at a node.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ShellResultants {
    /// Unit vectors e1, e2, n as rows, right-handed; n is the normal of the element.
    pub axes: [[f64; 3]; 3],
    /// Membrane forces n_11, n_22, n_12, N/m; tension is positive.
    pub membrane: [f64; 3],
    /// Moments m_11, m_22, m_12, Nm/m; positive with tension on the lower face, on the side of −n.
    ///
    /// m_11 bends the strip along e1: its stress is σ_11 = 6 m_11/t² on the lower face.
    pub moments: [f64; 3],
    /// Shear forces q_1, q_2, N/m: on a section whose outward normal is e1 or e2, along n.
    pub shears: [f64; 2],
}

impl ShellResultants {
    /// Larger and smaller principal moment, Nm/m.
    pub fn principal_moments(&self) -> [f64; 2] {
        let mean = 0.5 * (self.moments[0] + self.moments[1]);
        let radius = (0.5 * (self.moments[0] - self.moments[1])).hypot(self.moments[2]);
        [mean + radius, mean - radius]
    }

    /// Membrane forces, moments and shear forces in a row.
    pub(crate) fn values(&self) -> [f64; 8] {
        let mut values = [0.0; 8];
        values[..3].copy_from_slice(&self.membrane);
        values[3..6].copy_from_slice(&self.moments);
        values[6..].copy_from_slice(&self.shears);
        values
    }

    /// Mean axes of elements that meet, from the sums of their unit vectors.
    pub(crate) fn mean_axes([first, _, normal]: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
        let normal = unit(normal);
        let first = unit(add(first, -dot(first, normal), normal));
        [first, cross(normal, first), normal]
    }

    /// The same forces and moments in other axes.
    ///
    /// The new e1 is the part of `along` in the plane of the element. The new n is the normal on the side of
    /// `outward`, so that the signs of moments and shear forces do not depend on the order in which the nodes of
    /// an element are listed. Neither vector needs unit length.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) if `along` is normal to the element or `outward` lies in its plane.
    pub fn in_axes(&self, along: [f64; 3], outward: [f64; 3]) -> Result<Self> {
        let [first, second, normal] = self.axes;
        let height = dot(normal, unit(outward));
        let quantity = "part of the outward direction along a shell's normal, of a unit vector";
        let needed = "at least 1e-6 in size: not in the plane of the shell";
        require(quantity, height, height.abs() >= MIN_SINE_TO_AXIS, needed)?;
        let side = height.signum();
        let along = unit(along);
        let in_plane = add(along, -dot(along, normal), normal);
        let part = length(in_plane);
        let quantity = "part of the direction of a shell's axis in its plane, of a unit vector";
        require(quantity, part, part >= MIN_SINE_TO_AXIS, "at least 1e-6: not along the normal")?;
        let new_first = unit(in_plane);
        let new_normal = normal.map(|value| side * value);
        let new_second = cross(new_normal, new_first);
        let rotation = [new_first, new_second].map(|axis| [dot(axis, first), dot(axis, second)]);
        Ok(Self {
            axes: [new_first, new_second, new_normal],
            membrane: rotated(self.membrane, &rotation),
            moments: rotated(self.moments, &rotation).map(|moment| side * moment),
            shears: rotation.map(|[a, b]| side * (a * self.shears[0] + b * self.shears[1])),
        })
    }
}

/// Symmetric tensor [11, 22, 12] in new axes.
///
/// The rows of `rotation` are the new axes in the old ones.
fn rotated([xx, yy, xy]: [f64; 3], rotation: &[[f64; 2]; 2]) -> [f64; 3] {
    [[0, 0], [1, 1], [0, 1]].map(|[i, j]| {
        let a = rotation[i];
        let b = rotation[j];
        a[0] * b[0] * xx + a[1] * b[1] * yy + (a[0] * b[1] + a[1] * b[0]) * xy
    })
}
