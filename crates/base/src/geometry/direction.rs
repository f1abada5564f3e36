//! Directions of degrees of freedom.

/// Direction of a degree of freedom at a node.
///
/// A mesh in the plane has the directions `X`, `Y` and `Rotation`: to the right, up and counter-clockwise. A mesh
/// in space has `X`, `Y` and `Z`, to the right, away and up, and the rotations about these axes by the right-hand
/// rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Direction {
    /// Displacement to the right, m.
    X,
    /// Displacement upwards in the plane, away from the reader in space, m.
    Y,
    /// Rotation in the plane, counter-clockwise, rad.
    Rotation,
    /// Displacement upwards in space, m.
    Z,
    /// Rotation in space about the axis to the right, rad.
    RotationX,
    /// Rotation in space about the axis away from the reader, rad.
    RotationY,
    /// Rotation in space about the vertical axis, counter-clockwise seen from above, rad.
    RotationZ,
}

words! { #[doc(hidden)] pub Direction, "direction", {
    X = "x",
    Y = "y",
    Rotation = "rotation",
    Z = "z",
    RotationX = "rotation_x",
    RotationY = "rotation_y",
    RotationZ = "rotation_z",
} }

impl Direction {
    /// Component in this direction of a rigid `motion` by one unit.
    ///
    /// `[x, y, z]`: position relative to the centre of rotation, m. The right-hand rule holds in the plane too.
    #[doc(hidden)]
    pub fn in_rigid_motion(self, motion: Self, [x, y, z]: [f64; 3]) -> f64 {
        match (self, motion) {
            // 0 − y is +0 for y = 0, but −y would be −0.
            (Self::X, Self::Rotation | Self::RotationZ) => 0.0 - y,
            (Self::Y, Self::Rotation | Self::RotationZ) => x,
            (Self::Z, Self::RotationX) => y,
            (Self::Y, Self::RotationX) => 0.0 - z,
            (Self::X, Self::RotationY) => z,
            (Self::Z, Self::RotationY) => 0.0 - x,
            _ => f64::from(u8::from(self == motion)),
        }
    }

    /// Whether the direction is a rotation.
    #[doc(hidden)]
    pub fn is_rotation(self) -> bool {
        !matches!(self, Self::X | Self::Y | Self::Z)
    }
}

/// Directions of elements in the plane without rotations.
pub const PLANE_TRANSLATIONS: &[Direction] = &[Direction::X, Direction::Y];

/// All directions in the plane: for beams, and for masses with rotary inertia.
pub const PLANE_DIRECTIONS: &[Direction] = &[Direction::X, Direction::Y, Direction::Rotation];

/// All directions in space.
pub const SPACE_DIRECTIONS: &[Direction] = &[
    Direction::X,
    Direction::Y,
    Direction::Z,
    Direction::RotationX,
    Direction::RotationY,
    Direction::RotationZ,
];
