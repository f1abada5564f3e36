//! Ground motions: records, and free fields of records and formulas.
//!
//! Read or build a [`Record`], and correct its [`Baseline`]; a record is integrated exactly. A [`FreeField`] is the motion
//! of the ground's surface without the structure: [`VerticalIncidence`] of records, [`Triaxial`] of records in three
//! directions, [`RickerDisplacement`] of a pulse in closed form, [`FreeFieldFn`] of closures, [`AtRest`] without motion,
//! [`IncoherentMotion`] of records with a [`Coherence`] from element to element.

mod coherence;
mod free_field;
mod incoherent;
mod out_of_phase;
mod plane_wave;
mod travelling_wave;

#[cfg(feature = "reference")]
pub(crate) use basemat_records::quadratic_roots_within;
#[doc(inline)]
pub use basemat_records::{
    AccelerationUnit, AfadFormat, AlongLinesFormat, Baseline, CoarseSpectrum, ColumnFormat,
    CosmosFormat, EsmFormat, FortranFormat, GeoNetFormat, KNetCsvFormat, KNetFormat, Motion,
    PeerFormat, Record, RecordFormat, STANDARD_GRAVITY, SlistFormat, SmcFormat, SpectralOrdinate,
    el_centro_1940,
};
pub use coherence::{AbrahamsonCoherence, Coherence, CoherenceFn, LucoWong};
pub use free_field::{
    AtRest, FreeField, FreeFieldFn, RickerDisplacement, Triaxial, VerticalIncidence,
};
pub use incoherent::{Incoherence, IncoherentMotion, mean_coherence};
pub use plane_wave::PlaneWave;
pub(crate) use plane_wave::check_prescribed;
#[cfg(feature = "embedded")]
pub(crate) use travelling_wave::SlownessAndOrigin;
pub use travelling_wave::TravellingWave;
