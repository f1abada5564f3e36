//! Forces and moments of a shell per unit of width.

use crate::error::{Result, require};
use crate::fem::vector::{add, cross, direction, dot};

/// Sine of an angle below which a direction counts as parallel to another.
const PARALLEL: f64 = 1e-6;

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
        let [first, second, twist] = self.moments;
        let (mean, radius) = (0.5 * (first + second), (0.5 * (first - second)).hypot(twist));
        [mean + radius, mean - radius]
    }

    /// Membrane forces, moments and shear forces in a row.
    pub(crate) fn values(&self) -> [f64; 8] {
        let [first, second, shear] = self.membrane;
        let [about, across, twist] = self.moments;
        let [along, aside] = self.shears;
        [first, second, shear, about, across, twist, along, aside]
    }

    /// Axes in the middle between axes of elements that meet, from the sums of their unit vectors.
    pub(crate) fn mean_axes([first, _, normal]: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
        let (_, normal) = direction(normal);
        let (_, first) = direction(add(first, -dot(first, normal), normal));
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
        let height = dot(normal, direction(outward).1);
        let quantity = "part of the outward direction along a shell's normal, of a unit vector";
        let needed = "at least 1e-6 in size: not in the plane of the shell";
        require(quantity, height, height.abs() >= PARALLEL, needed)?;
        let side = height.signum();
        let (_, along) = direction(along);
        let (part, new_first) = direction(add(along, -dot(along, normal), normal));
        let quantity = "part of the direction of a shell's axis in its plane, of a unit vector";
        require(quantity, part, part >= PARALLEL, "at least 1e-6: not along the normal")?;
        let new_normal = normal.map(|value| side * value);
        let new_second = cross(new_normal, new_first);
        let turn = [new_first, new_second].map(|axis| [dot(axis, first), dot(axis, second)]);
        Ok(Self {
            axes: [new_first, new_second, new_normal],
            membrane: turned(self.membrane, &turn),
            moments: turned(self.moments, &turn).map(|moment| side * moment),
            shears: turn.map(|[a, b]| side * (a * self.shears[0] + b * self.shears[1])),
        })
    }
}

/// Symmetric tensor [11, 22, 12] in new axes, whose components in the old ones are the rows of `turn`.
fn turned([xx, yy, xy]: [f64; 3], turn: &[[f64; 2]; 2]) -> [f64; 3] {
    let value = |a: [f64; 2], b: [f64; 2]| {
        a[0] * b[0] * xx + a[1] * b[1] * yy + (a[0] * b[1] + a[1] * b[0]) * xy
    };
    [value(turn[0], turn[0]), value(turn[1], turn[1]), value(turn[0], turn[1])]
}
