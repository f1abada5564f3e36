//! Hinge in the plane whose moment yields.

use std::sync::Arc;

use super::hinge_force::{HingeDeformation, HingeForce, unit_axis};
use super::moment_law::MomentLaw;
use crate::error::{Result, positive};
use crate::fem::element::{Element, MassKind};
use crate::fem::fiber::UniaxialMaterial;
use crate::fem::inelastic_force::InelasticForce;
use crate::geometry::{Direction, PLANE_DIRECTIONS};

/// Hinge in the plane between two nodes at one place, whose moment yields.
///
/// The moment follows the rotation of the second node relative to the first, both counter-clockwise, by any
/// [`UniaxialMaterial`]: a [`BilinearMoment`](super::BilinearMoment), or a
/// [`MenegottoPinto`](crate::fem::MenegottoPinto) with the plastic moment in place of the yield stress and the rotational
/// stiffness in place of the modulus. Stiff springs of one stiffness connect the displacements of both nodes, whatever
/// the direction. [`FemModel::with_tied_nodes`](crate::structure::FemModel::with_tied_nodes) may tie them exactly; the springs then carry nothing.
///
/// The stiffness of the hinge does not count in stiffness-proportional damping: else a hinge that rotates plastically
/// would have a viscous moment far above its plastic moment (Charney 2008, J. Struct. Eng. 134, 581).
/// [`FemModel::hinge_state`](crate::structure::FemModel::hinge_state) returns rotation and moment.
///
/// ```
/// use basemat::fem::{Beam, BilinearMoment, Direction, Hinge, LumpedMass, Mesh};
/// use basemat::structure::{FemModel, NonlinearForce, Structure};
///
/// // A column 3 m high on a hinge at its foot: 400 kN m at 0.01 rad.
/// let mut mesh = Mesh::new();
/// let [left, foot, right] =
///     [mesh.add_node(-2.0, 0.0)?, mesh.add_node(0.0, 0.0)?, mesh.add_node(2.0, 0.0)?];
/// let column_foot = mesh.add_node(0.0, 0.0)?;
/// let top = mesh.add_node(0.0, 3.0)?;
/// for ends in [[left, foot], [foot, right], [column_foot, top]] {
///     mesh.add(Beam::new(ends, 30.0e9, 0.1, 1.0e-3, 2400.0)?)?;
/// }
/// let law = BilinearMoment::new(400.0e3, 40.0e6, 0.01)?;
/// let hinge = mesh.add(Hinge::new([foot, column_foot], 1.0e11, law)?)?;
/// // The contact nodes do not contain the foot of the column.
/// let mut model = FemModel::new(mesh, &[left, foot, right])?;
/// // The column turns by 0.03 rad clockwise, as a rigid body.
/// let mut displacement = vec![0.0; model.dofs()];
/// displacement[model.dof(column_foot, Direction::Rotation).unwrap()] = -0.03;
/// displacement[model.dof(top, Direction::Rotation).unwrap()] = -0.03;
/// displacement[model.dof(top, Direction::X).unwrap()] = 0.09;
/// model.nonlinear_mut().unwrap().commit(&displacement);
/// let state = model.hinge_state(hinge)?;
/// assert!((state.moment[2] + 408.0e3).abs() < 1e-6);
/// assert!((state.plastic_rotation[2] + 0.0198).abs() < 1e-12);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Hinge {
    nodes: [usize; 2],
    force: HingeForce<MomentLaw, 3>,
}

/// Axes of the plane: to the right, up, towards the reader.
const PLANE_AXES: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Deformations of a hinge in the plane: along both axes, and the rotation.
pub(super) const PLANE_DEFORMATIONS: [HingeDeformation; 3] = [
    HingeDeformation::Displacement(0),
    HingeDeformation::Displacement(1),
    HingeDeformation::Rotation(2),
];

impl Hinge {
    /// Hinge between two nodes at one place, with a moment–rotation law.
    ///
    /// `displacement_stiffness`: stiffness of the springs between the displacements of the nodes, N/m (per metre of
    /// thickness); 10² to 10⁴ times that of the members is stiff without loss of digits.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the stiffness and the modulus of the law are positive.
    /// [`Mesh::add`](crate::fem::Mesh::add) returns an error for nodes at a distance.
    pub fn new(
        nodes: [usize; 2],
        displacement_stiffness: f64,
        moment_law: impl UniaxialMaterial,
    ) -> Result<Self> {
        positive("displacement stiffness of the hinge", displacement_stiffness)?;
        positive("rotational stiffness of the hinge", moment_law.modulus())?;
        let law = MomentLaw { displacement_stiffness, moment_law: Arc::new(moment_law) };
        let force = HingeForce {
            law,
            axes: PLANE_AXES,
            deformations: PLANE_DEFORMATIONS,
            directions: PLANE_DIRECTIONS,
            has_rigid_arm: false,
        };
        Ok(Self { nodes, force })
    }

    /// Sets the direction [x, y] of the member, along which [`HingeState`](crate::fem::HingeState) has its first axis.
    ///
    /// Forces do not depend on it. Default: to the right.
    ///
    /// # Errors
    /// [`Error::NotFinite`](crate::Error::NotFinite) and [`Error::Input`](crate::Error::Input) for a vector that is not
    /// finite, or zero.
    pub fn with_axis(mut self, axis: [f64; 2]) -> Result<Self> {
        self.force.axes = plane_axes(axis)?;
        Ok(self)
    }

    /// Allows nodes at a distance: a rigid arm leads from the first node to the hinge at the second.
    #[must_use]
    pub fn with_rigid_arm(mut self) -> Self {
        self.force.has_rigid_arm = true;
        self
    }
}

/// Axes of a hinge in the plane along a direction [x, y], and to its left.
pub(super) fn plane_axes([x, y]: [f64; 2]) -> Result<[[f64; 3]; 3]> {
    let along = unit_axis([x, y, 0.0])?;
    Ok([along, [-along[1], along[0], 0.0], [0.0, 0.0, 1.0]])
}

/// Implements [`Element`] for a hinge with the fields `nodes` and `force`.
macro_rules! hinge_element {
    ($hinge:ident) => {
        fn nodes(&self) -> &[usize] {
            &self.nodes
        }

        fn with_nodes(&self, nodes: &[usize]) -> Option<Box<dyn Element>> {
            Some(Box::new($hinge { nodes: nodes.try_into().ok()?, ..self.clone() }))
        }

        fn directions(&self) -> &[Direction] {
            self.force.directions
        }

        fn stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
            self.force.add_stiffness(coordinates, matrix);
        }

        fn inelastic(&self) -> Option<&dyn InelasticForce> {
            Some(&self.force)
        }

        /// `false`: a hinge that rotates plastically would have a viscous moment far above its plastic moment.
        fn has_stiffness_damping(&self) -> bool {
            false
        }

        /// Adds nothing.
        fn mass(&self, _coordinates: &[[f64; 3]], _kind: MassKind, _matrix: &mut [f64]) {}

        /// [`Error::Input`](crate::Error::Input) for nodes at a distance without a rigid arm.
        fn check(&self, coordinates: &[[f64; 3]]) -> Result<()> {
            self.force.check(coordinates)
        }
    };
}
pub(super) use hinge_element;

impl Element for Hinge {
    hinge_element!(Hinge);
}
