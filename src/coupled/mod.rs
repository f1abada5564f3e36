//! The coupled nonlinear time integrator.
//!
//! [`Simulation::builder`] takes the parts and checks them against each other;
//! [`Simulation::step`] makes one step, [`Simulation::run`] many.
//!
//! # A step
//!
//! Let y be the mean translation of the free field under a connected part of the structure, R its
//! influence vectors, and R y + u the displacement: only u, relative to the ground, is stored, so
//! that a ground that travels far costs no digits. Let τ be the contact tractions of the step as
//! **changes** against the static state, and s the soil's displacement by them. With the
//! coefficients that a [`TimeScheme`] gives for a* and v* (total) and u* as functions of the
//! increment R Δy + Δu,
//!
//! ```text
//! M a* + C (v* − R v_y) + K u* + f(u*) = p(t*) − Bᵀ A τ
//! jump = gap₀ + (s_ff − y) + h + G¹ τ − B (u₀ + Δu)
//! ```
//!
//! where B takes degrees of freedom to element means of the base displacement (normal components down), A
//! holds the element lengths, h is the convolution history of all earlier tractions and `s_ff` the
//! free field; K R = 0 and B R is a unit translation.
//! The normal components of the jump are gaps; slip is minus the tangential ones. Eliminating Δu
//! leaves one linear relation between jumps and tractions,
//!
//! ```text
//! jump = j_free + W τ,     W = G¹ + B K_eff⁻¹ Bᵀ A     (Delassus operator, 2Q × 2Q)
//! K_eff = M/(θΔt²) + C/Δt + θ (K + ∂f/∂u),             θ = ½ for the midpoint rule
//! ```
//!
//! [`Simulation::step`] reads in this order:
//!
//! 1. forcing: free field, its translation y, convolution history, load (`model/load.rs`);
//! 2. predicted increment: one solve with the factors of K_eff (`step/linear.rs`);
//! 3. contact: the mode of each element and τ, from `j_free` and W alone (`crate::contact`);
//! 4. increment: the response Δu to τ; nothing is committed so far;
//! 5. energy balance (`energy_accumulator.rs`), state (`advance.rs`), ground and structure take over the increment.
//!
//! For a linear structure W is computed once. For a nonlinear one Newton's method goes around
//! steps 2 and 3, with a new W whenever the tangent changes.
//!
//! # Mode search
//!
//! Starting from the modes of the step before: solve the linear system that the modes define, let
//! each [`crate::interface::InterfaceLaw`] say its next mode, repeat until nothing changes. A mode vector that
//! comes back is a cycle; then Gauss–Seidel over the elements, each solved exactly by trying its
//! modes, and at last a path of solutions followed from a known state. [`State::method`] names what was
//! needed, [`State::trials`] how many linear solves. If nothing converges, the step is an
//! [`crate::Error::Step`] and the simulation stays at the last accepted one.
//!
//! # Preload
//!
//! With [`SimulationBuilder::gravity`] above zero, the run starts from a static state in stages: the
//! weight first, placed as [`GravityStage`] says, then the loads at t = 0 with the interface laws, in
//! increments where elements slide or yield; contact conditions included, with the static compliance
//! of the ground. Without equilibrium, the error names the cause ([`crate::StabilityError`]).
//! The structure has no support of its own and the half-plane no static datum, so the search is a
//! proximal point iteration: weak springs to the last iterate, which pull at nothing once it
//! converges. An equilibrium need not be stable:
//! a block that P–Δ would topple is found standing, and falls when the ground shakes.
//!
//! # Energy balance
//!
//! ```text
//! kinetic + strain + hysteresis + damping + algorithmic + soil + contact + interface + static_contact = input
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
mod checkpoint;
mod conditioning;
mod coordinates;
mod free_vibration;
mod gravity_stage;
mod identity;
mod interaction;
pub(crate) mod model;
pub(crate) mod parts;
mod refine;
mod refine_each;
pub(crate) mod run;
pub(crate) mod scene;
mod scheme;
mod sensitivity;
pub(crate) mod serviceability;
pub(crate) mod simulation;
pub(crate) mod state;
mod statics;
mod step;

pub use crate::structure::probe::Probe;
pub use checkpoint::Checkpoint;
pub use conditioning::Conditioning;
pub use coordinates::Coordinates;
pub use gravity_stage::GravityStage;
pub use identity::Change;
pub use interaction::{Interaction, SystemMode, interaction};
pub use model::load::Load;
pub use parts::SimulationBuilder;
pub use refine::{Refinement, Setting, largest_convergent_step, refine};
pub use refine_each::{Refinements, refine_each};
pub use run::warning::Warning;
pub use scheme::{
    DissipativeMidpoint, HhtAlpha, Midpoint, Newmark, SchemeCoefficients, Theta, TimeScheme,
};
pub use sensitivity::{PeakTwins, Sensitivity, sensitivity};
pub use simulation::Observed;
pub use state::energy_balance::{EnergyBalance, EnergyTerm};
pub use state::foundation::Foundation;
pub use state::{State, Transition};
