//! Hinge in space whose two bending moments yield together.

use super::bilinear_moment::check_hardening_ratio;
use super::ellipse::Ellipse;
use super::hinge_force::{HingeDeformation, HingeForce, unit_axis};
use super::moment_hinge::hinge_element;
use super::plastic_law::PlasticLaw;
use crate::error::{Result, positive, require};
use crate::fem::element::{Element, MassKind};
use crate::fem::inelastic_force::InelasticForce;
use crate::fem::vector::{add_scaled, cross, dot, norm};
use crate::geometry::{Direction, SPACE_DIRECTIONS};

/// Smallest sine of the angle between the axis and the orientation of a hinge.
const MIN_ORIENTATION_SINE: f64 = 1e-6;
/// Indices of both bending rotations among the deformations.
const YIELDING_DEFORMATIONS: [usize; 2] = [4, 5];

/// Hinge in space between two nodes at one place, whose bending moments yield on a circle or an ellipse.
///
/// (M_y/M_py)² + (M_z/M_pz)² ≤ 1 with associated flow and kinematic hardening; with equal plastic moments and
/// stiffnesses it is a circle with radial return, and the same in all directions. Displacements and torsion are elastic.
///
/// Axis x leads along the member from the first to the second node, and y lies in the plane of x and the orientation, as
/// for a [`SpaceBeam`](crate::fem::SpaceBeam). Deformations are those of the second node relative to the first, by the
/// right-hand rule. The stiffness of the hinge does not count in stiffness-proportional damping, as for a
/// [`Hinge`](super::Hinge).
///
/// ```
/// use basemat::fem::{Element, SpaceHinge};
///
/// // 300 kN m about any horizontal axis, at the foot of a vertical member.
/// let axes = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]];
/// let hinge = SpaceHinge::new([0, 1], axes, 1.0e10, [1.0e8, 5.0e7, 5.0e7], [300.0e3, 300.0e3])?;
/// let force = hinge.inelastic().unwrap();
/// let mut variables = vec![0.0; force.variable_count()];
/// // A rotation by 0.05 rad about the horizontal axis [0.6, 0.8].
/// let mut displacement = [0.0; 12];
/// (displacement[9], displacement[10]) = (0.03, 0.04);
/// let mut nodal = [0.0; 12];
/// force.force(&[[0.0; 3]; 2], &displacement, &variables, &mut nodal)?;
/// assert!((nodal[9] - 180.0e3).abs() < 1e-6 && (nodal[10] - 240.0e3).abs() < 1e-6);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct SpaceHinge {
    nodes: [usize; 2],
    /// About y and z, N m.
    plastic_moments: [f64; 2],
    force: HingeForce<PlasticLaw<Ellipse<2>, 6, 2>, 6>,
}

/// Law of a hinge with this hardening ratio.
fn law(
    stiffness: [f64; 6],
    hardening_ratio: f64,
    plastic_moments: [f64; 2],
) -> PlasticLaw<Ellipse<2>, 6, 2> {
    PlasticLaw::new(stiffness, hardening_ratio, YIELDING_DEFORMATIONS, |factors| Ellipse {
        semi_axes: [0, 1].map(|k| factors[k] * plastic_moments[k]),
    })
}

/// Right-handed axes: along `axis`, then in the plane of `axis` and `orientation`.
fn space_axes([axis, orientation]: [[f64; 3]; 2]) -> Result<[[f64; 3]; 3]> {
    let x = unit_axis(axis)?;
    let orientation = unit_axis(orientation)?;
    let normal_part = add_scaled(orientation, -dot(orientation, x), x);
    let sine = norm(normal_part);
    let quantity = "sine of the angle between the axis of the hinge and its orientation";
    let needed = "above 1e-6: an orientation that is not along the axis";
    require(quantity, sine, sine > MIN_ORIENTATION_SINE, needed)?;
    let y = unit_axis(normal_part)?;
    Ok([x, y, cross(x, y)])
}

impl SpaceHinge {
    /// Hinge between two nodes at one place, perfectly plastic in bending.
    ///
    /// `axes`: direction [x, y, z] of the member, and its orientation. `displacement_stiffness`: stiffness of the springs
    /// between the displacements of the nodes, N/m. `rotational_stiffness`: in torsion, and in bending about y and z,
    /// N m/rad. `plastic_moments`: M_py and M_pz, N m.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless stiffnesses and plastic moments are positive, and for axes of no
    /// length or along one line; [`Error::NotFinite`](crate::Error::NotFinite) for axes that are not finite.
    /// [`Mesh::add`](crate::fem::Mesh::add) returns an error for nodes at a distance.
    pub fn new(
        nodes: [usize; 2],
        axes: [[f64; 3]; 2],
        displacement_stiffness: f64,
        rotational_stiffness: [f64; 3],
        plastic_moments: [f64; 2],
    ) -> Result<Self> {
        positive("displacement stiffness of the hinge", displacement_stiffness)?;
        for stiffness in rotational_stiffness {
            positive("rotational stiffness of the hinge", stiffness)?;
        }
        for plastic_moment in plastic_moments {
            positive("plastic moment of the hinge", plastic_moment)?;
        }
        let mut stiffness = [displacement_stiffness; 6];
        stiffness[3..].copy_from_slice(&rotational_stiffness);
        let force = HingeForce {
            law: law(stiffness, 0.0, plastic_moments),
            axes: space_axes(axes)?,
            deformations: [
                HingeDeformation::Displacement(0),
                HingeDeformation::Displacement(1),
                HingeDeformation::Displacement(2),
                HingeDeformation::Rotation(0),
                HingeDeformation::Rotation(1),
                HingeDeformation::Rotation(2),
            ],
            directions: SPACE_DIRECTIONS,
            has_rigid_arm: false,
        };
        Ok(Self { nodes, plastic_moments, force })
    }

    /// Sets kinematic hardening: the ratio b of the bending stiffness beyond the yield surface to that within.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless 0 ≤ b < 1.
    pub fn with_hardening(mut self, hardening_ratio: f64) -> Result<Self> {
        check_hardening_ratio(hardening_ratio)?;
        self.force.law = law(self.force.law.stiffness, hardening_ratio, self.plastic_moments);
        Ok(self)
    }

    /// Allows nodes at a distance: a rigid arm leads from the first node to the hinge at the second.
    #[must_use]
    pub fn with_rigid_arm(mut self) -> Self {
        self.force.has_rigid_arm = true;
        self
    }
}

impl Element for SpaceHinge {
    hinge_element!(SpaceHinge);
}
