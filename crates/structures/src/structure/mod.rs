//! Structures: the trait that users implement, implementations of it, and hysteretic springs.

/// Forwards the methods of [`Structure`] that a wrapper does not change.
#[doc(hidden)]
#[macro_export]
macro_rules! forward_structure {
    ($wrapper:ident.$inner:ident) => {
        forward! {
            $wrapper.$inner;
            fn dofs(&$wrapper) -> usize;
            fn base(&$wrapper) -> $crate::structure::Base;
            fn mass(&$wrapper, matrix: &mut $crate::structure::Triplets) -> $crate::Result<()>;
            fn mass_at_rest(&$wrapper) -> $crate::Result<Option<Vec<f64>>>;
            fn geometric_stiffness(&$wrapper, matrix: &mut $crate::structure::Triplets) -> $crate::Result<()>;
            fn has_active_damping(&$wrapper) -> bool;
            fn has_active_stiffness(&$wrapper) -> bool;
            fn description(&$wrapper) -> $crate::structure::StructureDescription;
            fn describe(&$wrapper, dofs: &[usize]) -> Option<String>;
            fn load(&$wrapper, time: f64, load: &mut [f64]) -> $crate::Result<()>;
        }
    };
}

mod base;
mod base_motion;
pub(crate) mod base_node;
mod description;
pub(crate) mod detached;
mod dof_combination;
mod hysteresis;
pub(crate) mod matrix_checks;
mod modal_damping;
mod models;
pub(crate) mod nonlinear;
pub(crate) mod probe;
mod rayleigh_damping;
mod reduction;
mod rigid_motions;
pub(crate) mod spring_supported_base;

#[doc(inline)]
pub use crate::error::StructureError;
pub use crate::fem::internal_energy::InternalEnergy;
#[doc(inline)]
pub use crate::linalg::Triplets;
pub use base::Base;
pub use base_node::BaseNode;
pub use description::StructureDescription;
pub use dof_combination::{DofCombination, SectionRows};
pub use hysteresis::{
    BiaxialResponse, BiaxialSpring, Bilinear, BoucWen, FrictionPendulum, Hysteresis, LeadRubber,
    PendulumBearing, SpringResponse, WithSprings,
};
pub use modal_damping::{ModalDamping, WithModalDamping};
#[cfg(feature = "embedded")]
pub use models::WithWalls;
pub use models::{
    BeamEndRows, BeamRows, FemModel, IsolationLevel, MatrixModel, PlanStorey, RigidBlock,
    RigidBody, Section, ShearBuilding, ShellRows, SpaceSection, Storey, StoreyBuilding,
    StructureGroup, WithElements,
};
pub use nonlinear::NonlinearForce;
pub(crate) use nonlinear::{MassAndStiffness, mass_and_stiffness};
pub use rayleigh_damping::RayleighDamping;
pub use reduction::{CraigBampton, Recovery, ReducedModel};
pub(crate) use spring_supported_base::{SpringSupportedBase, max_diagonal_stiffness};

use std::any::Any;

use crate::error::Result;

/// A structure for the integrator: implement this for your own model.
///
/// Four methods are required: [`dofs`](Structure::dofs), [`base`](Structure::base), [`mass`](Structure::mass) and
/// [`stiffness`](Structure::stiffness). The example is a rigid base with a mass on a column 6 m high:
/// ```
/// use basemat::prelude::*;
///
/// /// Degrees of freedom: base to the right, base up, rotation of the base, mass to the right.
/// struct Tower;
///
/// impl Structure for Tower {
///     fn dofs(&self) -> usize {
///         4
///     }
///     fn base(&self) -> Base {
///         BaseNode::rigid_base(-2.0, 2.0, [0, 1, 2]).into()
///     }
///     fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
///         for (dof, mass) in [10.0e3, 30.0e3, 40.0e3, 20.0e3].into_iter().enumerate() {
///             matrix.add(dof, dof, mass);
///         }
///         Ok(())
///     }
///     // The column's deformation is u₃ − u₀ + 6 u₂.
///     fn stiffness(&self, matrix: &mut Triplets) -> basemat::Result<()> {
///         matrix.add_outer([(3, 1.0), (0, -1.0), (2, 6.0)], 4.0e6);
///         Ok(())
///     }
/// }
///
/// let simulation = Simulation::builder(0.005)
///     .ground(ElasticGround::under(Soil::new(120.0e6, 0.33, 1900.0)?, &Tower, 8)?)
///     .structure(Tower)
///     .interface(Coulomb::new(0.4)?)
///     .motion(el_centro_1940())
///     .build()?;
/// // The normal force of the ground is the weight of the vertical mass.
/// assert!((simulation.state().normal_force - 30.0e3 * STANDARD_GRAVITY).abs() < 1.0);
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// A structure has `n` degrees of freedom: displacements and rotations (m, rad; x to the right, y up, rotations
/// counter-clockwise), measured from the unloaded state. Its matrices refer to **absolute** displacements. A
/// translation causes no strain. The force f is therefore evaluated, and a step committed, at displacements from which
/// the mean translation of the base (of each connected part) is subtracted; static displacements are included. The
/// equation of motion is
///
/// ```text
/// M a + C v_rel + K u + f(u) = p(t) + weight + contact forces
/// ```
///
/// where `v_rel` is the velocity relative to the free field (so that mass-proportional damping does not act on the
/// translation with the ground) and f the optional [`NonlinearForce`].
///
/// The structure has no fixed support; the ground supports it. Neither K nor the tangent of f at rest may resist a
/// rigid translation to the right or upwards. Building a simulation returns [`StructureError::Restrained`] for
/// stiffness to a fixed point. It returns [`StructureError::Detached`] for a part that has mass or stiffness but is not
/// connected by stiffness to the degrees of freedom of a contact node. Modal and other coordinates relative to the base
/// are allowed: they have their own stiffness, and mass couples them to the base.
///
/// All forces are per metre of thickness, except for a structure in space ([`Base::Faces`]), which has displacements in
/// three directions: x to the right, y away from the reader, z up. Matrices and loads may return an error;
/// [`Error::part`](crate::Error::part) makes one with your reason. The error ends the build, or a step of which nothing
/// is committed.
///
/// Every structure is [`Any`], so that `Simulation::structure` can be downcast to your type with its current internal
/// variables.
#[auto_impl::auto_impl(Box)]
pub trait Structure: Any + Send {
    /// Number of degrees of freedom n.
    fn dofs(&self) -> usize;

    /// Base of the structure: the nodes that touch the ground.
    ///
    /// In the plane it lists nodes from left to right, `nodes.into()`, and is straight between neighbours. A rigid base
    /// needs its two ends ([`BaseNode::rigid_base`]). [`Base::Lines`] are several foundations; [`Base::Faces`] belong
    /// to a structure in space. Every call returns the same base.
    fn base(&self) -> Base;

    /// Adds the mass matrix (n × n, kg/m) to `matrix`.
    ///
    /// It is symmetric and positive semi-definite.
    ///
    /// Degrees of freedom without mass are allowed. Rounding is accepted: entries on the diagonal down to −10⁻¹² of the
    /// largest entry of the matrix, and eigenvalues down to −10⁻⁶ of the matrix scaled to a diagonal of one. For lower
    /// values `build` returns [`Error::Indefinite`](crate::Error::Indefinite).
    ///
    /// # Errors
    /// Any: `build` returns it.
    fn mass(&self, matrix: &mut Triplets) -> Result<()>;

    /// Mass of soil at rest on each of the n degrees of freedom, kg. Default: `None`.
    ///
    /// This soil has inertia, but no weight. The mass is the product of the soil's part of the
    /// [`mass`](Structure::mass) and an upward translation by 1 m. The weight of this soil is in equilibrium with its
    /// stresses and pressures at rest ([`Mesh::with_stress_at_rest`]), and does not act in a run. With `Some`, the
    /// structure is bonded to a trench from the start, and the ground's pressures at rest do not act on it.
    ///
    /// [`Mesh::with_stress_at_rest`]: crate::fem::Mesh::with_stress_at_rest
    ///
    /// # Errors
    /// Any: `build` returns it.
    fn mass_at_rest(&self) -> Result<Option<Vec<f64>>> {
        Ok(None)
    }

    /// Adds the stiffness matrix (n × n, N/m per metre) to `matrix`.
    ///
    /// It is symmetric, unless [`has_active_stiffness`](Structure::has_active_stiffness) returns `true`; otherwise
    /// `build` returns [`Error::Unsymmetric`](crate::Error::Unsymmetric). The stiffness of a linear structure
    /// must be positive semi-definite with a fixed base, up to rounding (10⁻¹² of its largest entry on the
    /// diagonal); otherwise `build` returns [`Error::Indefinite`](crate::Error::Indefinite). Lagrange
    /// multipliers are excepted: a degree of freedom with exactly zero on the diagonal, no mass and no
    /// damping, but coefficients cⱼ in its row and column, is the force that keeps Σ cⱼ uⱼ = 0. The other degrees
    /// of freedom must have a positive semi-definite stiffness for all displacements that satisfy this constraint.
    ///
    /// # Errors
    /// Any: `build` returns it.
    fn stiffness(&self, matrix: &mut Triplets) -> Result<()>;

    /// Adds the viscous damping matrix (n × n) to `matrix`. Default: none.
    ///
    /// It is symmetric and positive semi-definite, up to rounding as for the mass; otherwise `build` returns
    /// [`Error::Unsymmetric`](crate::Error::Unsymmetric) or [`Error::Indefinite`](crate::Error::Indefinite).
    /// A structure whose [`has_active_damping`](Structure::has_active_damping) returns `true` is not checked.
    ///
    /// # Errors
    /// Any: `build` returns it.
    fn damping(&self, _matrix: &mut Triplets) -> Result<()> {
        Ok(())
    }

    /// Adds the geometric stiffness of the static forces (P–Δ), n × n, to `matrix`. Default: none.
    ///
    /// [`stiffness`](Structure::stiffness) contains this part. The load factor at which the structure buckles, which
    /// errors state, is computed from it. `build` returns an error for a structure that buckles on its ground
    /// (`StabilityError::Buckling`).
    ///
    /// # Errors
    /// Any; `build` returns it.
    fn geometric_stiffness(&self, _matrix: &mut Triplets) -> Result<()> {
        Ok(())
    }

    /// Whether the damping matrix may be unsymmetric or feed energy in. Default: no.
    ///
    /// Gyroscopes and active dampers have such a matrix. The matrix is then not checked.
    fn has_active_damping(&self) -> bool {
        false
    }

    /// Whether the stiffness matrix may be unsymmetric. Default: no.
    ///
    /// Follower forces have such a stiffness. The matrix is then not checked. The energy balance does not contain the
    /// work of such a stiffness; the work becomes part of the energy error.
    fn has_active_stiffness(&self) -> bool {
        false
    }

    /// Properties by which a run warns of probable mistakes. Default: none.
    ///
    /// An example of such a mistake is a number in another unit.
    fn description(&self) -> StructureDescription {
        StructureDescription::default()
    }

    /// Text that names degrees of freedom in errors, by nodes or storeys.
    ///
    /// Default: `None`; errors then list their indices.
    fn describe(&self, _dofs: &[usize]) -> Option<String> {
        None
    }

    /// Adds the external load at `time` (n, N/m), without the weight, to `load`. Default: none.
    ///
    /// # Errors
    /// Any: at t = 0 `build` returns it; later it is the source of `StepError::Part`.
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
