//! Ground motion: records, waves, spectra and motions by functions.

mod coherence;
mod function;
mod incoherent;
mod record;
mod record_file;
mod spectrum;
mod trench;
mod waves;

pub(crate) use coherence::{
    PyAbrahamsonCoherence, PyCoherence, PyCoherenceFn, PyLucoWong, mean_coherence,
};
pub(crate) use function::{PyFreeField, free_field, free_field_object};
pub(crate) use incoherent::{PyIncoherence, PyIncoherentMotion};
pub(crate) use record::{PyRecord, el_centro_1940};
pub(crate) use spectrum::{PySpectrum, coarse_period_warnings, log_spaced};
pub(crate) use trench::PyTrenchMotion;
pub(crate) use waves::{
    PyColumn, PyInclinedWave, PyPlaneWave, control_point, ricker, travelling_wave, triaxial,
    vertical_incidence,
};
