//! Ground motion.

mod function;
mod record;
mod waves;

pub(crate) use function::{PyFreeField, free_field, given};
pub(crate) use record::{PyRecord, PySpectrum, coarse, el_centro_1940, log_spaced};
pub(crate) use waves::{
    PyColumn, PyInclinedWave, PyPlaneWave, control, ricker, travelling_wave, triaxial,
    vertical_incidence,
};
