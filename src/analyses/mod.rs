//! Analyses that build and run a scene several times, through the public interface of [`Simulation`](crate::Simulation).
//!
//! Each analysis takes a closure that builds the scene. It therefore works for every structure, ground and law.
//!
//! | function | result |
//! |---|---|
//! | [`refine()`], [`refine_each`] | errors of mesh and time step, and the run time |
//! | [`sensitivity()`] | number of reliable digits of a peak |
//! | [`largest_convergent_step`] | the longest time step whose contact problems all have a solution |
//! | [`interaction()`] | forces, period and damping on the ground and on a fixed base |
//! | [`push_over()`] | the largest static load of the foundation, and the path to it |
//! | [`push_over_by_displacement`] | load against displacement through the collapse load of structure and foundation |

mod base_rotations;
mod convergent_step;
mod displacement_search;
mod free_vibration;
mod interaction;
mod push_over;
mod push_over_by_displacement;
mod refine;
mod refine_each;
mod sensitivity;

pub use convergent_step::largest_convergent_step;
pub use interaction::{Interaction, SystemMode, interaction};
pub use push_over::{PushControl, PushOver, PushPoint, push_over};
pub use push_over_by_displacement::push_over_by_displacement;
pub use refine::{Refinement, Setting, refine};
pub use refine_each::{Refinements, refine_each};
pub use sensitivity::{PeakTwins, Sensitivity, sensitivity};
