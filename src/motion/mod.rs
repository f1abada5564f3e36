//! Ground motions: records, and the free field that they stand for.
//!
//! A [`Record`] is read or built, its [`Baseline`] treated, and integrated exactly; a [`FreeField`] says how the
//! surface of the ground would move without the structure. [`VerticalIncidence`] makes one of records, [`Triaxial`] one
//! in three directions, [`RickerDisplacement`] is a pulse in closed form, [`FreeFieldFn`] takes closures, [`AtRest`]
//! never moves.

mod afad;
mod agreement;
mod baseline;
mod block;
mod clock;
mod column_title;
mod cosmos;
mod csmip;
mod esm;
mod filter;
mod fixed_columns;
mod format;
mod free_field;
mod geonet;
mod integral;
mod k_net;
mod k_net_csv;
mod lines;
mod out_of_phase;
mod peer;
mod plane_wave;
mod reader;
mod record;
mod smc;
mod spectrum;
mod travelling_wave;
mod unit;

pub use afad::AfadFormat;
pub use baseline::Baseline;
pub use cosmos::CosmosFormat;
pub use esm::EsmFormat;
pub use format::RecordFormat;
pub use free_field::{
    AtRest, FreeField, FreeFieldFn, RickerDisplacement, Triaxial, VerticalIncidence,
};
pub use geonet::GeoNetFormat;
pub use integral::Motion;
pub(crate) use integral::quadratic_roots_within;
pub use k_net::KNetFormat;
pub use k_net_csv::KNetCsvFormat;
pub use peer::PeerFormat;
pub use plane_wave::PlaneWave;
pub(crate) use plane_wave::check_prescribed;
pub use reader::{ColumnFormat, el_centro_1940};
pub use record::Record;
pub use smc::SmcFormat;
pub use spectrum::{CoarseSpectrum, SpectralOrdinate};
pub use travelling_wave::TravellingWave;
pub use unit::{AccelerationUnit, STANDARD_GRAVITY};
