//! Motion of a rigid, massless body in a trench.

use crate::linalg::Complex;

/// Motion of a rigid body without mass in a trench, e^(iωt), per unit motion of the surface of the free field.
///
/// It is the input motion of the structure: kinematic interaction. Waves travel vertically. x to the right, y down; a
/// positive rotation lowers the right end. Translations are of the middle of the base.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct KinematicMotion {
    /// Frequency, Hz.
    pub frequency: f64,
    /// Horizontal translation per unit horizontal motion of the surface by shear waves.
    pub horizontal: Complex,
    /// Rotation per unit horizontal motion of the surface by shear waves, 1/m.
    pub rotation: Complex,
    /// Vertical translation per unit vertical motion of the surface by pressure waves.
    pub vertical: Complex,
}
