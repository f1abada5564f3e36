//! Errors of a scene as a whole, found while it is built, and their causes.
//!
//! Signs of matrices, supports and detached parts are checked on the assembled structure; static stability when
//! weight and loads find no equilibrium; the condition, and mechanisms that look like a bad one, in the
//! coordinates that are stepped.

pub(crate) mod conditioning;
pub(crate) mod mechanism;
pub(crate) mod sign;
pub(crate) mod stability;
pub(crate) mod supports;
