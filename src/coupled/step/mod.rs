//! One step: what acts in it, and the increment that answers.

pub(super) mod forcing;
pub(super) mod increment;
pub(super) mod newton;
pub(super) mod solver;
