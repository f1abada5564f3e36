//! Structures: the trait that users implement, implementations of it, and hysteretic springs.

/// Implements the methods of [`Structure`] that no structure around another one replaces.
macro_rules! forward_structure {
    ($own:ident.$inner:ident) => {
        forward! {
            $own.$inner;
            fn dofs(&$own) -> usize;
            fn contact_nodes(&$own) -> Vec<$crate::structure::ContactNode>;
            fn foundation_ends(&$own) -> Vec<usize>;
            fn contact_faces(&$own) -> Vec<Vec<$crate::structure::FaceNode>>;
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
mod contact_node;
mod damping;
mod detached;
mod dof_combination;
mod hysteresis;
mod models;
mod nonlinear;
pub(crate) mod probe;
mod reduction;
mod section_rows;

pub use crate::linalg::Triplets;
pub use contact_node::{ContactNode, FaceNode};
pub(crate) use contact_node::{base_nodes, check_base_nodes, foundation_nodes, from_the_left};
pub use damping::{ModalDamping, RayleighDamping, WithModalDamping};
pub(crate) use detached::{
    HeldBase, UNNOTICED, check_attached, check_damping, check_mass, check_stiffness, massless,
    numbers as unknown_numbers, stiffest,
};
pub use dof_combination::DofCombination;
pub use hysteresis::{
    Bilinear, BoucWen, FrictionPendulum, Hysteresis, LeadRubber, SpringResponse, WithSprings,
};
pub use models::{
    FemModel, IsolationLevel, MatrixModel, PlanStorey, RigidBlock, RigidBody, Section,
    ShearBuilding, Storey, StoreyBuilding, StructureGroup,
};
pub use nonlinear::{InternalEnergy, NonlinearForce};
pub(crate) use nonlinear::{
    Tangent, is_nonlinear, nonlinear_state, restore_variables, sample_forces, save_variables,
};
pub use reduction::{CraigBampton, Recovery, ReducedModel};
pub use section_rows::SectionRows;

use std::any::Any;

use crate::error::Result;

/// A structure as the integrator sees it: implement this for your own model.
///
/// A structure has `n` degrees of freedom, displacements and rotations (m, rad; x to the right, y up, rotations
/// counter-clockwise), measured from the unloaded state. Its matrices are written for **absolute**
/// ones. Since no translation strains it, f is evaluated, and a step committed, at displacements less
/// the mean translation of the base (of each connected part), with the static ones added. It obeys
///
/// ```text
/// M a + C v_rel + K u + f(u) = p(t) + weight + contact forces
/// ```
///
/// where `v_rel` is the velocity relative to the free field (so that mass-proportional damping
/// does not act on the translation with the ground) and f the optional [`NonlinearForce`]. Four methods
/// are needed: [`dofs`](Structure::dofs), [`contact_nodes`](Structure::contact_nodes),
/// [`mass`](Structure::mass) and [`stiffness`](Structure::stiffness).
///
/// No support is fixed, the ground holds the structure up: neither K nor the tangent of f at rest
/// may resist a rigid translation to the right or upwards. Structures with stiffness to a fixed point are
/// an error when a simulation is built ([`Error::Restrained`](crate::Error::Restrained)), and so are
/// those with a part that has mass or stiffness, but is not connected by stiffness to the degrees of freedom of a
/// contact node ([`Error::Detached`](crate::Error::Detached)). Coordinates of modes and others relative to the base,
/// which a stiffness of their own holds and the mass couples with the rest, are no such part.
///
/// All forces are per metre of thickness, but for a structure in plan ([`contact_faces`](Structure::contact_faces)),
/// which moves in three directions: x to the right, y away from the reader, z up. Matrices and loads may fail, with
/// [`Error::part`](crate::Error::part) for a reason of your own: it ends the build, or the step with
/// nothing of it committed.
///
/// Every structure is [`Any`], so that [`Simulation::structure`](crate::Simulation::structure) leads
/// back to your own type, and what its internal variables have become.
#[auto_impl::auto_impl(Box)]
pub trait Structure: Any + Send {
    /// Number of degrees of freedom n.
    fn dofs(&self) -> usize;

    /// Points of the base that touch the ground, from left to right; between neighbours the base
    /// is straight. A rigid base needs two.
    fn contact_nodes(&self) -> Vec<ContactNode>;

    /// Contact nodes that are the last of a foundation, the structure's last one excepted: between
    /// such a node and the next there is no base. Default: none, one foundation. In plan the faces decide.
    fn foundation_ends(&self) -> Vec<usize> {
        Vec::new()
    }

    /// Faces of a base in plan, for a ground of three directions: triangles or other convex polygons, each by its
    /// corners in either order, flat and at one height, not overlapping. Over a triangle the base is flat, over a
    /// quadrilateral bilinear; one of more corners is made of triangles from its first one. A rigid base needs one
    /// face, its outline. Faces that share a corner, or have one on the other's edge, are of one foundation, others of
    /// foundations of their own. Default: none, a line of [`contact_nodes`](Structure::contact_nodes) in the plane; a
    /// structure with faces has none of those.
    fn contact_faces(&self) -> Vec<Vec<FaceNode>> {
        Vec::new()
    }

    /// Adds the mass matrix (n × n, kg/m) to `matrix`. Symmetric, positive semi-definite.
    ///
    /// Degrees of freedom without mass are allowed. Rounding passes: entries on the diagonal down to −10⁻¹² of
    /// the largest entry of the matrix, and eigenvalues down to −10⁻⁶ of the matrix scaled to a
    /// diagonal of one. With more than that no simulation is built
    /// ([`Error::Indefinite`](crate::Error::Indefinite)).
    ///
    /// # Errors
    /// Any: it is what `build` returns.
    fn mass(&self, matrix: &mut Triplets) -> Result<()>;

    /// Adds the stiffness matrix (n × n, N/m per metre) to `matrix`.
    ///
    /// Symmetric, or no simulation is built ([`Error::Unsymmetric`](crate::Error::Unsymmetric));
    /// [`has_active_stiffness`](Structure::has_active_stiffness) lifts that.
    /// Of a linear structure it must be positive semi-definite with the base held, up to rounding (10⁻¹² of its largest entry on the diagonal), or no simulation is
    /// built ([`Error::Indefinite`](crate::Error::Indefinite)). Lagrange multipliers are excepted:
    /// a degree of freedom with exactly zero on the diagonal, no mass and no damping, but coefficients cⱼ in
    /// its row and column, is the force that keeps Σ cⱼ uⱼ = 0, and the rest must be positive
    /// semi-definite for the displacements that this leaves.
    ///
    /// # Errors
    /// Any: it is what `build` returns.
    fn stiffness(&self, matrix: &mut Triplets) -> Result<()>;

    /// Adds the viscous damping matrix (n × n) to `matrix`. Default: none.
    ///
    /// Symmetric and positive semi-definite, up to rounding as for the mass, or no simulation is
    /// built ([`Error::Unsymmetric`](crate::Error::Unsymmetric), [`Error::Indefinite`](crate::Error::Indefinite));
    /// [`has_active_damping`](Structure::has_active_damping) lifts that.
    ///
    /// # Errors
    /// Any: it is what `build` returns.
    fn damping(&self, _matrix: &mut Triplets) -> Result<()> {
        Ok(())
    }

    /// Whether the damping matrix is meant to be unsymmetric or to feed energy in, as gyroscopes and
    /// active dampers do: then it is taken as it is. Default: no.
    fn has_active_damping(&self) -> bool {
        false
    }

    /// Whether the stiffness matrix is meant to be unsymmetric, as the stiffness of follower forces is: then it is taken
    /// as it is. Its work is not in the energy balance, which stays open by it. Default: no.
    fn has_active_stiffness(&self) -> bool {
        false
    }

    /// Largest height of a storey (m): a run warns of one above 100 m, which is one in another unit. Default: `None`.
    fn tallest_storey(&self) -> Option<f64> {
        None
    }

    /// Name of these degrees of freedom in errors, for a person who knows the structure by its nodes or storeys.
    /// Default: `None`, and errors give their numbers.
    fn describe(&self, _dofs: &[usize]) -> Option<String> {
        None
    }

    /// Adds the external load at `time` (n, N/m), weight excepted, to `load`. Default: none.
    ///
    /// # Errors
    /// Any: at t = 0 it is what `build` returns, later the source of
    /// [`StepError::Structure`](crate::StepError::Structure).
    fn load(&self, _time: f64, _load: &mut [f64]) -> Result<()> {
        Ok(())
    }

    /// The nonlinear force f(u); `None`, the default, for a linear structure. A structure that
    /// implements [`NonlinearForce`] itself says `Some(self)`, here and in
    /// [`nonlinear_mut`](Structure::nonlinear_mut).
    fn nonlinear(&self) -> Option<&dyn NonlinearForce> {
        None
    }

    /// Nonlinear force of the structure, to commit a step or restore a state. No simulation takes a structure that
    /// gives it here and not in [`nonlinear`](Structure::nonlinear), or the other way round
    /// ([`Error::Scene`](crate::Error::Scene)).
    fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce> {
        None
    }
}
