//! Hinge in the plane whose axial force and moment yield together.

use super::axial_moment_surface::AxialMomentSurface;
use super::bilinear_moment::check_hardening_ratio;
use super::hinge_force::HingeForce;
use super::moment_hinge::{PLANE_DEFORMATIONS, hinge_element, plane_axes};
use super::plastic_law::PlasticLaw;
use crate::error::{Result, positive};
use crate::fem::element::{Element, MassKind};
use crate::fem::inelastic_force::InelasticForce;
use crate::geometry::{Direction, PLANE_DIRECTIONS};

/// Indices of elongation and rotation among the deformations.
const YIELDING_DEFORMATIONS: [usize; 2] = [0, 2];

/// Hinge in the plane between two nodes at one place, whose axial force and moment yield together.
///
/// Axial force N and moment M lie within an [`AxialMomentSurface`]. Flow is associated: a hinge that rotates under
/// compression shortens or, where the surface widens with compression, lengthens. The shear force is elastic. Do not tie
/// the displacements of the nodes: the model then returns an error, for the axial force would be lost.
///
/// Deformations are those of the second node relative to the first; elongation and tension are positive, rotation and
/// moment counter-clockwise. The stiffness of the hinge does not count in stiffness-proportional damping, as for a
/// [`Hinge`](super::Hinge).
///
/// ```
/// use basemat::fem::{AxialMomentSurface, Element, InteractionHinge};
///
/// // A column of steel, 2 MN and 300 kN m, at the foot of a vertical member.
/// let surface = AxialMomentSurface::rectangle(2.0e6, 300.0e3)?;
/// let hinge = InteractionHinge::new([0, 1], [0.0, 1.0], [1.0e10, 1.0e10], 1.0e8, surface)?;
/// let force = hinge.inelastic().unwrap();
/// let points = [[0.0; 3]; 2];
/// let mut variables = vec![0.0; force.variable_count()];
/// // 1 MN of compression leaves 225 kN m.
/// let mut displacement = [0.0, 0.0, 0.0, 0.0, -1.0e-4, 0.0];
/// force.commit(&points, &displacement, &mut variables);
/// // The rotation grows in small steps, and the column shortens so that the axial force stays.
/// for _ in 0..200 {
///     displacement[5] += 1.0e-4;
///     for _ in 0..60 {
///         let mut nodal = [0.0; 6];
///         force.force(&points, &displacement, &variables, &mut nodal)?;
///         displacement[4] -= (nodal[4] + 1.0e6) / 1.0e10;
///     }
///     force.commit(&points, &displacement, &mut variables);
/// }
/// let state = force.hinge(&points, &displacement, &variables)?.unwrap();
/// assert!((state.force[0] + 1.0e6).abs() < 1.0 && (state.moment[2] - 225.0e3).abs() < 1.0);
/// // The normal of the surface has ε : θ = 2 N M_p/N_p² : 1.
/// let ratio = state.plastic_displacement[0] / state.plastic_rotation[2];
/// assert!((ratio / (-2.0 * 1.0e6 * 300.0e3 / 4.0e12) - 1.0).abs() < 1e-3);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct InteractionHinge {
    nodes: [usize; 2],
    surface: AxialMomentSurface,
    force: HingeForce<PlasticLaw<AxialMomentSurface, 3, 2>, 3>,
}

/// Law of a hinge with this hardening ratio.
fn law(
    stiffness: [f64; 3],
    hardening_ratio: f64,
    surface: &AxialMomentSurface,
) -> PlasticLaw<AxialMomentSurface, 3, 2> {
    PlasticLaw::new(stiffness, hardening_ratio, YIELDING_DEFORMATIONS, |factors| {
        surface.scaled(factors)
    })
}

impl InteractionHinge {
    /// Hinge between two nodes at one place, perfectly plastic on a yield surface.
    ///
    /// `axis`: direction [x, y] of the member from the first to the second node. `displacement_stiffness`: stiffness
    /// along and across the axis, N/m; `rotational_stiffness`: N m/rad. In the plane all are per metre of thickness.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless all stiffnesses are positive, and for an axis of no length;
    /// [`Error::NotFinite`](crate::Error::NotFinite) for an axis that is not finite. [`Mesh::add`](crate::fem::Mesh::add)
    /// returns an error for nodes at a distance.
    pub fn new(
        nodes: [usize; 2],
        axis: [f64; 2],
        displacement_stiffness: [f64; 2],
        rotational_stiffness: f64,
        surface: AxialMomentSurface,
    ) -> Result<Self> {
        let stiffness = [
            positive("axial stiffness of the hinge", displacement_stiffness[0])?,
            positive("shear stiffness of the hinge", displacement_stiffness[1])?,
            positive("rotational stiffness of the hinge", rotational_stiffness)?,
        ];
        let force = HingeForce {
            law: law(stiffness, 0.0, &surface),
            axes: plane_axes(axis)?,
            deformations: PLANE_DEFORMATIONS,
            directions: PLANE_DIRECTIONS,
            has_rigid_arm: false,
        };
        Ok(Self { nodes, surface, force })
    }

    /// Sets kinematic hardening: the ratio b of the stiffness beyond the yield surface to that within.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless 0 ≤ b < 1.
    pub fn with_hardening(mut self, hardening_ratio: f64) -> Result<Self> {
        check_hardening_ratio(hardening_ratio)?;
        self.force.law = law(self.force.law.stiffness, hardening_ratio, &self.surface);
        Ok(self)
    }

    /// Allows nodes at a distance: a rigid arm leads from the first node to the hinge at the second.
    #[must_use]
    pub fn with_rigid_arm(mut self) -> Self {
        self.force.has_rigid_arm = true;
        self
    }
}

impl Element for InteractionHinge {
    hinge_element!(InteractionHinge);
}
