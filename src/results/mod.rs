//! Results for engineers: time series, peaks with their times, envelopes, factors of safety.
//!
//! [`Simulation::run`](crate::Simulation::run) returns a [`Run`]: peaks, envelopes and factors of safety, which
//! print as one page of a report. A [`Comparison`] puts several runs into one table. A [`Recorder`] selects time
//! series and snapshots to keep; [`TimeSeries`] stores them as the observer of the run. [`Rocking`] has moment,
//! rotation and settlement of one foundation, and the equivalent damping of a cycle.
//!
//! ```
//! use basemat::bem::ElasticGround;
//! use basemat::coupled::Probe;
//! use basemat::interface::Coulomb;
//! use basemat::motion::{STANDARD_GRAVITY, el_centro_1940};
//! use basemat::results::{Quantity, Recorder, log_spaced};
//! use basemat::structure::RigidBlock;
//! use basemat::{Simulation, Soil};
//!
//! let block = RigidBlock::new(4.0, 6.0, 2000.0)?;
//! let roof = block.horizontal_at(6.0);
//! let weight = STANDARD_GRAVITY * block.total_mass();
//! let mut simulation = Simulation::builder(0.01)
//!     .ground(ElasticGround::under(Soil::new(80.0e6, 0.33, 1900.0)?, &block, 8)?)
//!     .structure(block)
//!     .interface(Coulomb::new(0.4)?)
//!     .motion(el_centro_1940())
//!     .probe(Probe::acceleration("roof", roof))
//!     .build()?;
//!
//! let mut time_series = Recorder::new().start(&simulation)?;
//! time_series.reserve(500)?; // An error if they do not fit in the memory that is allowed.
//! let run = simulation.run(500, |state| time_series.record(state))?;
//!
//! println!("{run}");
//! assert!((run.whole.static_normal_force / weight - 1.0).abs() < 1e-9);
//! // Coulomb's limit: the factor of safety never falls below one.
//! assert!(run.whole.sliding_safety.lowest.value > 1.0 - 1e-9);
//! // The fractions of the energy add up to all of it.
//! let fractions = run.energy_balance.fractions().unwrap_or_default();
//! assert!((fractions.iter().map(|(_, fraction)| fraction).sum::<f64>() - 1.0).abs() < 1e-9);
//!
//! // A time series, and the response spectrum of the roof.
//! assert_eq!(time_series.series(Quantity::BaseShear).len(), 501);
//! let floor = time_series.floor_spectrum("roof", &log_spaced(0.1, 2.0, 20)?, 0.05)?;
//! assert_eq!(floor.len(), 20);
//! # Ok::<(), basemat::Error>(())
//! ```
//!
//! # Columns and numbers in files
//!
//! One rule for CSV and for the arrays of NPZ: the name of a column is its quantity in `snake_case`, followed by
//! the unit in words (`base_shear_n_per_m`, `roof_m_per_s2`, `base_rotation_rad`; a ratio has no unit). Probes
//! follow the same rule. Of two equal names the second ends in `_2`. Values are in SI units, probes in their own
//! units. Numbers have all digits, so that they read back as the same number. A missing or unknown number (NaN) is
//! an empty cell, infinities are `inf` and `-inf`, as pandas reads them.
//!
//! # Memory
//!
//! Results that are not requested use no memory. Scalar time series take 28 numbers, in plan 39, and one per probe at
//! every kept step (224 kB for 1000 steps in the plane). Contact and motion frames are off by default, see
//! [`TimeSeries::bytes`]. All of them together keep to the [limit](crate::memory_limit) of memory. A [`Run`] stores
//! numbers per element and the slip events. Its peaks, envelopes and events cover all steps, even if the time series
//! keep only some.
//!
//! # Conventions
//!
//! Forces act on the soil, per metre of thickness (in plan in total), as in [`crate::coupled::State`]. A value belongs
//! to the end of its step. The base moment is the total moment, static part included.

mod columns;
mod comparison;
mod csv;
#[cfg(any(feature = "io", feature = "plot"))]
mod deformed_shape;
mod floor;
mod foundation_series;
mod frames;
mod item_lists;
mod joint_results;
mod joint_series;
#[cfg(feature = "npz")]
mod npz;
mod recorder;
mod rocking;
#[cfg(any(feature = "io", feature = "plot"))]
pub(crate) mod shape_cell;
mod time_series;

pub use crate::coupled::run::{
    ElementEnvelope, Extremes, Fallbacks, GroundMotion, Peak, ProbeExtremes, Quantity, Run,
    ServiceCheck, Sliding, SlipEvent, Summary, Uplift,
};
pub use crate::coupled::serviceability::{Criterion, Serviceability};
#[doc(inline)]
pub use crate::text::csv::Csv;
pub use comparison::Comparison;
pub use csv::spectrum_csv;
#[cfg(any(feature = "io", feature = "plot"))]
pub use deformed_shape::{DeformedShape, ShapePoint};
pub use floor::{broadened, log_spaced};
pub use frames::{ContactFrame, MotionFrame};
pub use joint_series::JointQuantity;
pub use recorder::Recorder;
pub use rocking::{Rocking, equivalent_damping};
pub use time_series::TimeSeries;
