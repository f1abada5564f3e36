//! State of a hinge between two nodes.

/// Deformation and forces of a hinge, for results.
///
/// All vectors have components along `axes`. A deformation is the motion of the second node relative to the first, and
/// forces and moments are those of the hinge on the first node: a positive deformation causes a positive force. In the
/// plane rotation and moment are about the third axis, and components that do not exist are zero.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct HingeState {
    /// Position [x, y, z] of the undeformed hinge, m.
    pub position: [f64; 3],
    /// Unit vectors along the member and at right angles to it, right-handed.
    pub axes: [[f64; 3]; 3],
    /// Elongation and displacements at right angles to the member, m.
    pub displacement: [f64; 3],
    /// Axial force (tension is positive) and shear forces, N (in the plane per metre).
    pub force: [f64; 3],
    /// Rotation vector, rad: twist, then bending.
    pub rotation: [f64; 3],
    /// Torque and bending moments, N m (in the plane per metre).
    pub moment: [f64; 3],
    /// Displacement that remains if the force is unloaded elastically, m.
    pub plastic_displacement: [f64; 3],
    /// Rotation that remains if the moment is unloaded elastically, rad.
    pub plastic_rotation: [f64; 3],
}
