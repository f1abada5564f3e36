//! Ground motions: records, and the free field that they stand for.
//!
//! A [`Record`] is read or built, its [`Baseline`] treated, and integrated exactly; a [`FreeField`]
//! says how the surface of the ground would move without the structure. [`VerticalIncidence`]
//! makes one of records, [`RickerDisplacement`] is a pulse in closed form, [`FreeFieldFn`] takes
//! closures, [`AtRest`] never moves.

mod at_rest;
mod baseline;
mod closure;
mod content;
mod cosmos;
mod el_centro;
mod filter;
mod fixed_columns;
mod format;
mod hilbert;
mod integral;
mod intensity;
mod k_net;
mod lines;
mod out_of_phase;
mod peer;
mod plane_wave;
mod reader;
mod record;
mod ricker;
mod spectrum;
mod travelling;
mod unit;
mod vertical_incidence;

pub use at_rest::AtRest;
pub use baseline::Baseline;
pub use closure::FreeFieldFn;
pub use content::FrequencyContent;
pub use cosmos::CosmosFormat;
pub use el_centro::el_centro_1940;
pub use format::RecordFormat;
pub(crate) use integral::quadratic_roots_within;
pub use k_net::KNetFormat;
pub use peer::PeerFormat;
pub use plane_wave::PlaneWave;
pub use reader::ColumnFormat;
pub use record::Record;
pub use ricker::RickerDisplacement;
pub use spectrum::SpectralOrdinate;
pub use travelling::TravellingWave;
pub use unit::{AccelerationUnit, STANDARD_GRAVITY};
pub use vertical_incidence::VerticalIncidence;

/// Motion of the ground surface without the structure.
pub trait FreeField: Send {
    /// Displacement `[horizontal, vertical up]` (m) at surface point `x` (m) and `time` (s); zero
    /// at and before t = 0.
    fn displacement(&self, x: f64, time: f64) -> [f64; 2];

    /// Velocity `[horizontal, vertical up]` (m/s) at surface point `x` and `time`. The crate's own
    /// grounds and time schemes ask for displacements only; a ground of your own may need it.
    fn velocity(&self, x: f64, time: f64) -> [f64; 2];
}
