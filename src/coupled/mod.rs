//! The coupled nonlinear time integrator.

mod base;
mod builder;
mod contact;
mod ledger;
mod model;
mod modes;
mod path;
mod preload;
mod run;
mod scheme;
mod simulation;
mod state;
mod step;

pub use builder::SimulationBuilder;
pub use ledger::Ledger;
pub use modes::SearchMethod;
pub use preload::Placement;
pub use run::{Flow, Peak, Run, Warning};
pub use scheme::{Midpoint, SchemeCoefficients, Theta, TimeScheme};
pub use simulation::Simulation;
pub use state::{Probe, State, Transition};
