//! Points of a structure's base.

use super::Row;

/// A point of the base: where it is, and how the unknowns move it.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactNode {
    /// Coordinate along the surface, m.
    pub x: f64,
    /// Horizontal displacement (to the right) as a weighted sum of unknowns.
    pub horizontal: Row,
    /// Vertical displacement (up) as a weighted sum of unknowns.
    pub vertical: Row,
}

impl ContactNode {
    /// A node with a horizontal and a vertical unknown of its own.
    pub fn free(x: f64, horizontal: usize, vertical: usize) -> Self {
        Self { x, horizontal: horizontal.into(), vertical: vertical.into() }
    }

    /// A point of a rigid flat base with unknowns `[horizontal, vertical, rotation]` at `center`.
    pub fn rigid(x: f64, center: f64, unknowns: [usize; 3]) -> Self {
        let [horizontal, vertical, rotation] = unknowns;
        Self {
            x,
            horizontal: horizontal.into(),
            vertical: [(vertical, 1.0), (rotation, x - center)].into(),
        }
    }

    /// The two ends of a rigid flat base from `left` to `right`, unknowns at its middle.
    pub fn rigid_base(left: f64, right: f64, unknowns: [usize; 3]) -> Vec<Self> {
        let center = 0.5 * (left + right);
        vec![Self::rigid(left, center, unknowns), Self::rigid(right, center, unknowns)]
    }
}
