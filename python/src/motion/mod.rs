//! Ground motion.

mod base;
mod formats;
mod record;
mod spectrum;

pub(crate) use base::{PyFreeField, recipe};
pub(crate) use record::{PyRecord, el_centro_1940};
pub(crate) use spectrum::{PySpectrum, log_spaced};
