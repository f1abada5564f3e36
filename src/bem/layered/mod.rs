//! Layered, damped ground.
//!
//! | file | content |
//! |---|---|
//! | compliance | surface compliance C(k, s) of a profile |
//! | wavenumber, halving, form_factors, tail | element compliances F(s), integrals of C over k |
//! | runge_kutta, contour, panel_evaluation, coefficients | convolution weights Gⁿ by convolution quadrature |
//! | passivity | passivity check of convolution weights |
//! | block_store, block_file | blocks of convolution weights in memory and in a file |
//! | threads | computations on several threads |
//! | weights | convolution weights for a history |
//! | static_compliance, impedance | static compliance, dynamic stiffness of rigid strips |

mod block_file;
mod block_store;
mod coefficients;
mod compliance;
mod contour;
mod form_factors;
mod halving;
mod impedance;
mod panel_evaluation;
mod passivity;
mod runge_kutta;
mod static_compliance;
mod tail;
#[cfg(test)]
pub(super) mod test_profiles;
mod threads;
mod wavenumber;
mod weights;

pub(super) use coefficients::{INTEGRAL_TOLERANCE_FACTOR, Quadrature};
pub(super) use compliance::{LayeredCompliance, SurfaceCompliance};
#[cfg(feature = "embedded")]
pub(super) use contour::self_pair_classes;
pub(super) use form_factors::{LEGENDRE_DEGREES, PANEL_POINTS, legendre};
pub(super) use halving::{
    PANEL_TOLERANCE_EXPONENT, ROUNDING_FLOOR_FACTOR, by_halves, last_coefficients, median,
};
pub use impedance::{StripContact, StripImpedance};
pub(super) use impedance::{
    extrapolated_stiffnesses, impedance_progress, laplace_variables, strip_impedances,
};
#[cfg(test)]
pub(super) use passivity::margin;
pub use runge_kutta::Stages;
pub(super) use runge_kutta::{CirclePoint, on_circle};
pub(super) use static_compliance::static_compliance;
pub(super) use tail::{rounded_panel_count, surface_series};
pub(super) use threads::{on_threads, thread_count};
pub(super) use wavenumber::{Compliances, SurrogateLengths, top_layer_wavenumber, unresolved};
pub(super) use weights::{QuadratureWeights, StripWeights};
