//! The coupled nonlinear time integrator.
//!
//! [`Simulation::builder`] collects the parts and compares them with each other. [`Simulation::step`] makes one step,
//! [`Simulation::run`] many.
//!
//! # A step
//!
//! Let y be the mean translation of the free field under a connected part of the structure, R the influence vectors of
//! the part, and R y + u the displacement. Only u, relative to the ground, is stored, so that a large displacement of
//! the ground causes no loss of digits. Let τ be the contact tractions of the step as **changes** against the static
//! state, and s the soil's displacement due to them. A [`TimeScheme`] defines the total acceleration a*, the total
//! velocity v* and u* as functions of the increment R Δy + Δu:
//!
//! ```text
//! M a* + C (v* − R v_y) + K u* + f(u*) = p(t*) − Bᵀ A τ
//! jump = gap₀ + (s_ff − y) + h + G¹ τ − B (u₀ + Δu)
//! ```
//!
//! where v_y is the velocity of y, f the nonlinear force, p the load, B computes element means of the base displacement
//! from degrees of freedom (normal components down), A contains the element lengths, h is the convolution history of
//! all earlier tractions, and `s_ff` the free field. K R = 0, and B R is a unit translation. The normal components of
//! the jump are gaps; slip is minus the tangential components. Eliminating Δu leaves one linear relation between jumps
//! and tractions,
//!
//! ```text
//! jump = j_free + W τ,     W = G¹ + B K_eff⁻¹ Bᵀ A     (Delassus operator, 2Q × 2Q)
//! K_eff = M/(θΔt²) + C/Δt + θ (K + ∂f/∂u),             θ = ½ for the midpoint rule
//! ```
//!
//! Elements of a [`Joint`] follow those of the ground. Their rows of B are the means of the upper side minus those of the
//! lower side, and their rows of G¹ and h are zero. A part without foundations has the translation y of the ground under
//! what it stands on; a joint between parts of different y begins with their difference.
//!
//! [`Simulation::step`] computes in this order:
//!
//! 1. forcing: free field, its translation y, convolution history, load (`step/forcing.rs`);
//! 2. predicted increment: one solution with the factors of K_eff (`step/linear.rs`);
//! 3. contact: the mode of each element and τ, from `j_free` and W alone (`crate::contact`);
//! 4. increment: the response Δu to τ; nothing is committed so far;
//! 5. energy balance (`step/energy_accumulator.rs`), state (`step/advance.rs`); ground and structure commit the increment.
//!
//! For a linear structure W is computed once. For a nonlinear structure Newton's method repeats steps 2 and 3, with a
//! new W whenever the tangent changes. Where a full step of the iteration does not reduce the out-of-balance force, a
//! search along the increment shortens it (`step/increment_search.rs`). A step that does not converge returns
//! [`StepError::Newton`] with the largest out-of-balance force and the state of the structure there. The simulation
//! then stays at the last accepted step.
//!
//! # Mode search
//!
//! In the plane the search starts from the modes of the previous step. It solves the linear system for these modes,
//! evaluates the next mode of each [`crate::interface::InterfaceLaw`], and repeats this until no mode changes. If a
//! mode vector recurs, the search has a cycle. It then uses Gauss–Seidel over the elements, each solved exactly by
//! trying its modes. If this does not converge either, it follows a path of solutions from a solved state.
//! [`State::method`] is the last method used, [`State::trials`] the number of trials. If no method converges, the step
//! returns an [`crate::Error::Step`] and the simulation stays at the last accepted step.
//!
//! In plan the search finds the forces of the elements by sweeps and Newton's method, since a shear may have any direction
//! ([`crate::contact::SearchMethod`]).
//!
//! # Static state
//!
//! With [`SimulationBuilder::gravity`] above zero, the run starts from a static state that is computed in stages:
//! first the weight, as [`GravityStage`] defines, then all other loads at t = 0 with the interface laws, in increments
//! if elements slide or yield. The state satisfies the contact conditions, with the static compliance of the ground.
//! Without equilibrium, the error names the cause ([`crate::coupled::StabilityError`]). The structure has no support
//! besides the ground, and the half-plane has no static datum. The search is therefore a proximal point iteration: weak
//! springs connect the structure to its last iterate, and their forces vanish at convergence. An equilibrium may be
//! unstable: a block that P–Δ would overturn stands until the ground shakes.
//!
//! # Energy balance
//!
//! ```text
//! kinetic + strain + hysteresis + damping + algorithmic + midstep_remainder + soil + contact + interface
//!     + static_contact = input
//! ```
//!
//! holds exactly for the discrete equations; see [`EnergyBalance`] for the terms. [`Run::energy_error`]
//! is the largest violation of a run, relative to the largest energy until then.
//!
//! [`Run::energy_error`]: crate::results::Run::energy_error
//! [`Simulation::builder`]: crate::Simulation::builder
//! [`Simulation::run`]: crate::Simulation::run
//! [`Simulation::step`]: crate::Simulation::step

pub(crate) mod assembly;
pub(crate) mod base;
mod builder;
mod checkpoint;
mod conditioning;
mod coordinates;
mod former_paths;
mod gravity_stage;
mod ground_order;
mod identity;
mod joint;
pub(crate) mod model;
pub(crate) mod parts;
mod preparation;
pub(crate) mod run;
pub(crate) mod scene;
mod scheme;
pub(crate) mod serviceability;
pub(crate) mod simulation;
pub(crate) mod state;
mod statics;
mod step;
mod step_compliance;

#[doc(inline)]
pub use crate::error::{CheckpointError, CoarseBaseError, StabilityError, StepError};
#[doc(inline)]
pub use basemat_structures::internal::Probe;
pub use builder::SimulationBuilder;
pub use checkpoint::Checkpoint;
pub use conditioning::Conditioning;
pub use coordinates::Coordinates;
#[doc(hidden)]
pub use former_paths::*;
pub use gravity_stage::GravityStage;
pub use identity::Change;
pub use joint::Joint;
pub use model::load::Load;
pub use run::mistake::Mistake;
pub use run::warning::Warning;
pub use scheme::{
    DissipativeMidpoint, HhtAlpha, Midpoint, Newmark, SchemeCoefficients, Theta, TimeScheme,
};
pub use simulation::Observed;
pub use state::energy_balance::{EnergyBalance, EnergyTerm};
#[cfg(feature = "embedded")]
pub use state::face_forces::{Face, FaceForces};
pub use state::foundation::Foundation;
pub use state::joint_state::JointState;
pub use state::{State, Transition};
