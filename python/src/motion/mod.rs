//! Ground motion.

mod base;
mod formats;
mod function;
mod record;
mod spectrum;
mod waves;

pub(crate) use base::{PyFreeField, given};
pub(crate) use function::free_field;
pub(crate) use record::{PyRecord, el_centro_1940};
pub(crate) use spectrum::{PySpectrum, log_spaced};
pub(crate) use waves::{
    PyColumn, PyInclinedWave, PyPlaneWave, ricker, travelling_wave, triaxial, vertical_incidence,
};
