//! Points of a structure's base.

/// A point of the base: where it is, and how the unknowns move it.
///
/// Each displacement of the point is a weighted sum of unknowns: `(index, weight)` pairs.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactNode {
    /// Coordinate along the surface, m.
    pub x: f64,
    /// Horizontal displacement (to the right) as a weighted sum of unknowns.
    pub horizontal: Vec<(usize, f64)>,
    /// Vertical displacement (up) as a weighted sum of unknowns.
    pub vertical: Vec<(usize, f64)>,
}

impl ContactNode {
    /// A node with a horizontal and a vertical unknown of its own.
    pub fn free(x: f64, horizontal: usize, vertical: usize) -> Self {
        Self { x, horizontal: vec![(horizontal, 1.0)], vertical: vec![(vertical, 1.0)] }
    }

    /// A point of a rigid flat base with unknowns `[horizontal, vertical, rotation]` at `center`.
    pub fn rigid(x: f64, center: f64, unknowns: [usize; 3]) -> Self {
        let [horizontal, vertical, rotation] = unknowns;
        Self {
            x,
            horizontal: vec![(horizontal, 1.0)],
            vertical: vec![(vertical, 1.0), (rotation, x - center)],
        }
    }

    /// The two ends of a rigid flat base from `left` to `right`, unknowns at its middle.
    pub fn rigid_base(left: f64, right: f64, unknowns: [usize; 3]) -> Vec<Self> {
        let center = 0.5 * (left + right);
        vec![Self::rigid(left, center, unknowns), Self::rigid(right, center, unknowns)]
    }
}
