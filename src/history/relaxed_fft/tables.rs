//! Tables of coefficients over short delays.
//!
//! Index d of a coefficient counts the steps after the step of the traction. Lag d + 1 of the kernel belongs to it.

use crate::history::pair_classes::MOST_KINDS;

/// Coefficients d = 0 … of one class, kind by kind; empty for kinds that the ground does not have.
pub(super) type Class = [Vec<f64>; MOST_KINDS];

/// Coefficients that are summed directly: kind by kind and class by class, d = 0 … leaf − 1.
///
/// The first of them is zero. The coupling is stored as long as it is not zero.
pub(crate) type Tables = [Vec<Vec<f64>>; MOST_KINDS];
