//! What is wrong with a scene, and why: all that is refused while building beyond its parts themselves.
//!
//! Each question is asked where it can first be answered: signs, supports and detached parts of the
//! assembled structure; stability when weight and loads find no equilibrium; condition, and
//! mechanisms that look like a bad one, in the coordinates that are stepped.

pub(crate) mod conditioning;
pub(crate) mod mechanism;
pub(crate) mod sign;
pub(crate) mod stability;
pub(crate) mod supports;
