//! Layered, damped ground.
//!
//! | file | what is in it |
//! |---|---|
//! | compliance | surface compliance C(k, s) of a profile |
//! | wavenumber, halving, form_factors, tail | element compliances F(s): its integrals over k |
//! | runge_kutta, contour, coefficients, kernel | step coefficients Gⁿ by convolution quadrature |
//! | cost | what they cost, beforehand |
//! | passivity | the gate that they pass |
//! | kept, file | coefficients kept in memory, in a file |
//! | static_compliance, impedance | statics, rigid strips at one frequency |

mod coefficients;
mod compliance;
mod contour;
mod cost;
mod file;
mod form_factors;
mod halving;
mod impedance;
mod kept;
mod kernel;
mod passivity;
mod runge_kutta;
mod static_compliance;
mod tail;
#[cfg(test)]
pub(super) mod test_profiles;
mod wavenumber;

pub(super) use coefficients::{Block, Quadrature, Samples};
pub(super) use compliance::{Compliance, Surface};
pub use cost::Cost;
pub(super) use cost::{Look, SUMMED};
pub(super) use form_factors::{DEGREES, POINTS, legendre};
pub(super) use halving::{FLOOR, SHARE, by_halves};
pub(super) use impedance::{PER_FREQUENCY, extrapolated, points, rigid_strip_impedances_observed};
pub use impedance::{StripContact, StripImpedance, rigid_strip_impedances};
pub(super) use kept::{KeptBlocks, copy_lags, last_block, threads};
pub use kernel::LayeredKernel;
pub(super) use kernel::{LIMIT, TOLERANCE, check_limit, check_tolerance};
#[cfg(test)]
pub(super) use passivity::margin;
pub(super) use passivity::{POINTS as GATE_POINTS, check as passive};
pub use runge_kutta::Stages;
pub(super) use runge_kutta::on_circle;
pub use static_compliance::static_compliance;
pub(super) use tail::{on_grid, surface_series};
pub(super) use wavenumber::{Compliances, surface_outlook};
