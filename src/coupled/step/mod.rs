//! One step: what acts in it, and the increment that answers.

pub(super) mod forcing;
pub(super) mod increment;
mod linear;
mod modal;
mod newton;
pub(super) mod solver;
