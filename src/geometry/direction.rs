//! Directions of degrees of freedom.

/// Direction of a degree of freedom at a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Direction {
    /// Displacement to the right, m.
    X,
    /// Displacement upwards, m.
    Y,
    /// Rotation, counter-clockwise, rad.
    Rotation,
}

words! { Direction, "direction", {
    X = "x",
    Y = "y",
    Rotation = "rotation",
} }

/// Directions of elements without rotations.
pub(crate) const TRANSLATIONS: &[Direction] = &[Direction::X, Direction::Y];

/// Directions of beams and of masses with rotary inertia.
pub(crate) const FRAME: &[Direction] = &Direction::ALL;
