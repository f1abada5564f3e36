//! Forces and moments of a shell per metre of width.

use crate::error::{Result, require};
use crate::fem::vector::{add_scaled, cross, dot, norm, unit_vector};

/// Smallest sine of the angle between two directions; below it they count as parallel.
///
/// For a smaller angle, rounding would determine the axes.
const MIN_SINE_TO_AXIS: f64 = 1e-6;

/// Forces and moments of a shell at a point, per metre of width.
///
/// Their components refer to the axes e1, e2, n. Before averaging at a node, transform them to axes that neighbouring
/// elements have in common, by [`in_axes`](Self::in_axes).
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ShellResultants {
    /// Unit vectors e1, e2, n as rows, right-handed; n is the normal of the element.
    pub axes: [[f64; 3]; 3],
    /// Membrane forces n_11, n_22, n_12, N/m; tension is positive.
    pub membrane: [f64; 3],
    /// Moments m_11, m_22, m_12, N m/m.
    ///
    /// They are positive with tension on the lower face, on the side of −n.
    ///
    /// m_11 bends the strip along e1: its stress is σ_11 = 6 m_11/t² on the lower face.
    pub moments: [f64; 3],
    /// Shear forces q_1, q_2, N/m: on a section whose outward normal is e1 or e2, along n.
    pub shears: [f64; 2],
}

impl ShellResultants {
    /// Larger and smaller principal moment, N m/m.
    pub fn principal_moments(&self) -> [f64; 2] {
        let mean = 0.5 * (self.moments[0] + self.moments[1]);
        let mohr_radius = (0.5 * (self.moments[0] - self.moments[1])).hypot(self.moments[2]);
        [mean + mohr_radius, mean - mohr_radius]
    }

    /// Membrane forces, moments and shear forces in one list.
    pub(crate) fn values(&self) -> [f64; 8] {
        let mut values = [0.0; 8];
        values[..3].copy_from_slice(&self.membrane);
        values[3..6].copy_from_slice(&self.moments);
        values[6..].copy_from_slice(&self.shears);
        values
    }

    /// Mean axes of several elements, from the sums of their unit vectors e1, e2, n.
    pub(crate) fn mean_axes([e1_sum, _, normal_sum]: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
        let normal = unit_vector(normal_sum);
        let e1 = unit_vector(add_scaled(e1_sum, -dot(e1_sum, normal), normal));
        [e1, cross(normal, e1), normal]
    }

    /// The same forces and moments in other axes.
    ///
    /// The new e1 is the part of `tangent` in the plane of the element. The new n is the normal on the side of
    /// `outward_direction`, so that the signs of moments and shear forces do not depend on the order of an element's
    /// nodes. Both vectors may have any length.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) if `tangent` is normal to the element, or if `outward_direction` lies in
    /// its plane.
    pub fn in_axes(&self, tangent: [f64; 3], outward_direction: [f64; 3]) -> Result<Self> {
        let [e1, e2, normal] = self.axes;
        let outward_cosine = dot(normal, unit_vector(outward_direction));
        let quantity = "part of the outward direction along a shell's normal, of a unit vector";
        let needed = "at least 1e-6 in size: not in the plane of the shell";
        let is_outward = outward_cosine.abs() >= MIN_SINE_TO_AXIS;
        require(quantity, outward_cosine, is_outward, needed)?;
        let normal_sign = outward_cosine.signum();
        let unit_tangent = unit_vector(tangent);
        let projection = add_scaled(unit_tangent, -dot(unit_tangent, normal), normal);
        let in_plane_length = norm(projection);
        let quantity = "part of the direction of a shell's axis in its plane, of a unit vector";
        let needed = "at least 1e-6: not along the normal";
        require(quantity, in_plane_length, in_plane_length >= MIN_SINE_TO_AXIS, needed)?;
        let new_e1 = unit_vector(projection);
        let new_normal = normal.map(|component| normal_sign * component);
        let new_e2 = cross(new_normal, new_e1);
        let rotation = [new_e1, new_e2].map(|axis| [dot(axis, e1), dot(axis, e2)]);
        Ok(Self {
            axes: [new_e1, new_e2, new_normal],
            membrane: rotated_tensor(self.membrane, &rotation),
            moments: rotated_tensor(self.moments, &rotation).map(|moment| normal_sign * moment),
            shears: rotation.map(|[a, b]| normal_sign * (a * self.shears[0] + b * self.shears[1])),
        })
    }
}

/// Components [11, 22, 12] of a symmetric tensor in new axes.
///
/// The rows of `rotation` are the new axes in the old ones.
fn rotated_tensor([xx, yy, xy]: [f64; 3], rotation: &[[f64; 2]; 2]) -> [f64; 3] {
    [[0, 0], [1, 1], [0, 1]].map(|[i, j]| {
        let a = rotation[i];
        let b = rotation[j];
        a[0] * b[0] * xx + a[1] * b[1] * yy + (a[0] * b[1] + a[1] * b[0]) * xy
    })
}
