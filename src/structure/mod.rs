//! Structures: the trait that users implement, implementations of it, and hysteretic springs.

/// Forwards the methods of [`Structure`] that a wrapper leaves unchanged.
macro_rules! forward_structure {
    ($own:ident.$inner:ident) => {
        forward! {
            $own.$inner;
            fn dofs(&$own) -> usize;
            fn contact_nodes(&$own) -> Vec<$crate::structure::BaseNode>;
            fn foundation_ends(&$own) -> Vec<usize>;
            fn contact_faces(&$own) -> Vec<Vec<$crate::structure::BaseNode>>;
            fn mass(&$own, matrix: &mut $crate::structure::Triplets) -> $crate::error::Result<()>;
            fn has_active_damping(&$own) -> bool;
            fn has_active_stiffness(&$own) -> bool;
            fn tallest_storey(&$own) -> Option<f64>;
            fn describe(&$own, dofs: &[usize]) -> Option<String>;
            fn load(&$own, time: f64, load: &mut [f64]) -> $crate::error::Result<()>;
        }
    };
}
pub(crate) use forward_structure;

mod base_motion;
mod base_node;
mod detached;
mod dof_combination;
mod held_base;
mod hysteresis;
mod matrix_checks;
mod modal_damping;
mod models;
mod nonlinear;
pub(crate) mod probe;
mod rayleigh_damping;
mod reduction;
mod rigid_motions;
mod section_rows;

pub use crate::error::StructureError;
pub use crate::linalg::Triplets;
pub use base_node::BaseNode;
pub(crate) use base_node::{base_nodes, check_base_nodes, foundation_nodes, from_the_left};
pub(crate) use detached::{check_attached, numbers as unknown_numbers};
pub use dof_combination::DofCombination;
pub(crate) use held_base::{HeldBase, stiffest};
pub use hysteresis::{
    Bilinear, BoucWen, FrictionPendulum, Hysteresis, LeadRubber, SpringResponse, WithSprings,
};
pub(crate) use matrix_checks::{UNNOTICED, check_damping, check_mass, check_stiffness, massless};
pub use modal_damping::{ModalDamping, WithModalDamping};
pub use models::{
    FemModel, IsolationLevel, MatrixModel, PlanStorey, RigidBlock, RigidBody, Section,
    ShearBuilding, Storey, StoreyBuilding, StructureGroup,
};
pub use nonlinear::{InternalEnergy, NonlinearForce};
pub(crate) use nonlinear::{
    Tangent, is_nonlinear, nonlinear_state, restore_variables, save_variables,
};
pub use rayleigh_damping::RayleighDamping;
pub use reduction::{CraigBampton, Recovery, ReducedModel};
pub use section_rows::SectionRows;

use std::any::Any;

use crate::error::Result;

/// A structure for the integrator: implement this for your own model.
///
/// A structure has `n` degrees of freedom, displacements and rotations (m, rad; x to the right, y up,
/// rotations counter-clockwise), measured from the unloaded state. Its matrices refer to **absolute**
/// displacements. A translation strains nothing. The force f is therefore evaluated, and a step committed, at
/// displacements from which the mean translation of the base (of each connected part) is subtracted; static
/// displacements are included. The structure obeys
///
/// ```text
/// M a + C v_rel + K u + f(u) = p(t) + weight + contact forces
/// ```
///
/// where `v_rel` is the velocity relative to the free field (so that mass-proportional damping does not act
/// on the translation with the ground) and f the optional [`NonlinearForce`]. Four methods are needed:
/// [`dofs`](Structure::dofs), [`contact_nodes`](Structure::contact_nodes), [`mass`](Structure::mass) and
/// [`stiffness`](Structure::stiffness).
///
/// No support is fixed; the ground holds the structure up. Neither K nor the tangent of f at rest may resist
/// a rigid translation to the right or upwards. Building a simulation returns
/// [`StructureError::Restrained`] for stiffness to a fixed point. It returns
/// [`StructureError::Detached`] for a part that has mass or stiffness but is not connected by
/// stiffness to the degrees of freedom of a contact node. Modal and other base-relative coordinates are
/// allowed: their own stiffness holds them, and mass couples them to the base.
///
/// All forces are per metre of thickness, except for a structure in plan
/// ([`contact_faces`](Structure::contact_faces)), which moves in three directions: x to the right, y away
/// from the reader, z up. Matrices and loads may return an error, for a reason of your own by
/// [`Error::part`](crate::Error::part). The error ends the build, or the step with nothing of it committed.
///
/// Every structure is [`Any`], so that [`Simulation::structure`](crate::Simulation::structure) leads back to
/// your own type and its current internal variables.
#[auto_impl::auto_impl(Box)]
pub trait Structure: Any + Send {
    /// Number of degrees of freedom n.
    fn dofs(&self) -> usize;

    /// Points of the base that touch the ground, from left to right.
    ///
    /// Between neighbours the base is straight. A rigid base needs two.
    fn contact_nodes(&self) -> Vec<BaseNode>;

    /// The last contact node of each foundation, except of the last foundation.
    ///
    /// Between such a node and the next there is no base. Default: none, one foundation. In plan the faces
    /// decide.
    fn foundation_ends(&self) -> Vec<usize> {
        Vec::new()
    }

    /// Faces of a base in plan, for a ground of three directions.
    ///
    /// Faces are triangles or other convex polygons, each given by its corners in either order, flat and at
    /// one height, not overlapping. The base is flat over a triangle and bilinear over a quadrilateral; a
    /// polygon of more corners is divided into triangles from its first corner. A rigid base needs one face,
    /// its outline. Faces that share a corner, or have a corner on the other's edge, belong to one
    /// foundation; other faces are foundations of their own. Default: none, a line of
    /// [`contact_nodes`](Structure::contact_nodes) in the plane. A structure with faces has no contact nodes.
    fn contact_faces(&self) -> Vec<Vec<BaseNode>> {
        Vec::new()
    }

    /// Adds the mass matrix (n × n, kg/m) to `matrix`.
    ///
    /// It is symmetric and positive semi-definite.
    ///
    /// Degrees of freedom without mass are allowed. Rounding is accepted: entries on the diagonal down to
    /// −10⁻¹² of the largest entry of the matrix, and eigenvalues down to −10⁻⁶ of the matrix scaled to a
    /// diagonal of one. Beyond that `build` returns [`Error::Indefinite`](crate::Error::Indefinite).
    ///
    /// # Errors
    /// Any: `build` returns it.
    fn mass(&self, matrix: &mut Triplets) -> Result<()>;

    /// Adds the stiffness matrix (n × n, N/m per metre) to `matrix`.
    ///
    /// Symmetric, unless [`has_active_stiffness`](Structure::has_active_stiffness) returns `true`; otherwise
    /// `build` returns [`Error::Unsymmetric`](crate::Error::Unsymmetric). The stiffness of a linear structure
    /// must be positive semi-definite with the base held, up to rounding (10⁻¹² of its largest entry on the
    /// diagonal); otherwise `build` returns [`Error::Indefinite`](crate::Error::Indefinite). Lagrange
    /// multipliers are excepted: a degree of freedom with exactly zero on the diagonal, no mass and no
    /// damping, but coefficients cⱼ in its row and column, is the force that keeps Σ cⱼ uⱼ = 0. The rest must
    /// be positive semi-definite for the displacements that this constraint leaves.
    ///
    /// # Errors
    /// Any: `build` returns it.
    fn stiffness(&self, matrix: &mut Triplets) -> Result<()>;

    /// Adds the viscous damping matrix (n × n) to `matrix`. Default: none.
    ///
    /// Symmetric and positive semi-definite, up to rounding as for the mass; otherwise `build` returns
    /// [`Error::Unsymmetric`](crate::Error::Unsymmetric) or [`Error::Indefinite`](crate::Error::Indefinite).
    /// A structure whose [`has_active_damping`](Structure::has_active_damping) returns `true` is not checked.
    ///
    /// # Errors
    /// Any: `build` returns it.
    fn damping(&self, _matrix: &mut Triplets) -> Result<()> {
        Ok(())
    }

    /// Whether the damping matrix may be unsymmetric or feed energy in. Default: no.
    ///
    /// Gyroscopes and active dampers have such a matrix. It is then not checked.
    fn has_active_damping(&self) -> bool {
        false
    }

    /// Whether the stiffness matrix may be unsymmetric. Default: no.
    ///
    /// Follower forces have such a stiffness. It is then not checked. Its work is not in the energy balance,
    /// which stays open by that amount.
    fn has_active_stiffness(&self) -> bool {
        false
    }

    /// Largest height of a storey, m. Default: `None`.
    ///
    /// A run warns of a height above 100 m, which is probably in another unit.
    fn tallest_storey(&self) -> Option<f64> {
        None
    }

    /// Name of these degrees of freedom for errors, by nodes or storeys.
    ///
    /// Default: `None`; errors then give their numbers.
    fn describe(&self, _dofs: &[usize]) -> Option<String> {
        None
    }

    /// Adds the external load at `time` (n, N/m), without the weight, to `load`. Default: none.
    ///
    /// # Errors
    /// Any: at t = 0 `build` returns it; later it is the source of
    /// [`StepError::Part`](crate::coupled::StepError::Part).
    fn load(&self, _time: f64, _load: &mut [f64]) -> Result<()> {
        Ok(())
    }

    /// The nonlinear force f(u). Default: `None`, for a linear structure.
    ///
    /// A structure that implements [`NonlinearForce`] itself returns `Some(self)`, here and in
    /// [`nonlinear_mut`](Structure::nonlinear_mut).
    fn nonlinear(&self) -> Option<&dyn NonlinearForce> {
        None
    }

    /// Nonlinear force of the structure, to commit a step or restore a state.
    ///
    /// If only one of this method and [`nonlinear`](Structure::nonlinear) returns a force, `build` returns
    /// [`Error::Scene`](crate::Error::Scene).
    fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce> {
        None
    }
}
