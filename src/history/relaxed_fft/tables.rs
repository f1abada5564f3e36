//! Tables of coefficients over short delays.
//!
//! The index d of a coefficient counts the steps after the step of the traction.
//! It is the lag d + 1 of the convolution weights.

use crate::history::pair_classes::MAX_PLANE_KINDS;

/// Coefficients d = 0 … of one class, kind by kind; empty for kinds that the ground does not have.
pub(super) type ClassCoefficients = [Vec<f64>; MAX_PLANE_KINDS];

/// Coefficients that are summed directly: kind by kind and class by class, d = 0 … leaf − 1.
///
/// The coefficient of d = 0 is zero. The coupling is stored as long as it is not zero.
pub(crate) type ShortLagTables = [Vec<Vec<f64>>; MAX_PLANE_KINDS];
