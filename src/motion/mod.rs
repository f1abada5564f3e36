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
mod fields;
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
mod quantity;
mod reader;
mod record;
mod ricker;
mod spectrum;
mod travelling;
mod trim;
mod unit;
mod vertical_incidence;
mod writer;

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
pub(crate) use plane_wave::check_prescribed;
pub use reader::ColumnFormat;
pub use record::Record;
pub use ricker::RickerDisplacement;
pub use spectrum::SpectralOrdinate;
pub use travelling::TravellingWave;
pub use unit::{AccelerationUnit, STANDARD_GRAVITY};
pub use vertical_incidence::VerticalIncidence;

/// Motion of the ground surface without the structure.
#[auto_impl::auto_impl(Box)]
pub trait FreeField: Send {
    /// Displacement `[horizontal, vertical up]` (m) at surface point `x` (m) and `time` (s).
    ///
    /// A run starts at rest at t = 0 and measures every element's motion from what it is then, so a
    /// field should be at rest up to t = 0; what moves already starts with a jolt.
    fn displacement(&self, x: f64, time: f64) -> [f64; 2];

    /// Velocity `[horizontal, vertical up]` (m/s) at surface point `x` and `time`. Simulations ask for displacements only;
    /// `bem::full_plane::VerticalWaves` make stresses of velocities, and a ground of your own may need
    /// them.
    ///
    /// Default: the central difference of displacements 10 µs before and after. What moves with f
    /// Hz loses (2πf · 10 µs)²/6 of its velocity (7e-8 at 10 Hz, 7e-6 at 100 Hz), and rounding
    /// adds about 2e-11 of the displacement per second. A jump or a kink is spread over 20 µs.
    /// Fields that know their velocity should say it.
    fn velocity(&self, x: f64, time: f64) -> [f64; 2] {
        differenced(self, x, time)
    }
}

/// Half the interval of the difference, s.
const DIFFERENCE: f64 = 1e-5;
/// Smallest that it may be relative to the time, for the time's own rounding.
const ROUNDING: f64 = 1e-13;

/// Velocity of `field` from its displacements.
fn differenced(field: &(impl FreeField + ?Sized), x: f64, time: f64) -> [f64; 2] {
    if time.is_nan() || time <= 0.0 {
        return [0.0; 2];
    }
    let half = DIFFERENCE.max(ROUNDING * time);
    let (before, after) = (time - half, time + half);
    let (from, to) = (field.displacement(x, before), field.displacement(x, after));
    // Not 2 · half: the two times are rounded.
    [0, 1].map(|k| (to[k] - from[k]) / (after - before))
}
