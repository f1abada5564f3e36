//! Pictures of a run, as SVG (feature `plot`) and PNG (feature `png`).
//!
//! Every function returns an [`Svg`], to be saved or put into an HTML page; with the feature `png` also as a
//! bitmap (`Svg::save_png`). Some functions need frames of contact or motion, which the
//! [`crate::results::Recorder`] stores on request.
//!
//! | picture | function |
//! |---|---|
//! | one quantity of one or more runs over time | [`time_series`], [`probe_time_series`], [`curves`] |
//! | moment or settlement of a foundation over its rotation, beside measured points | [`moment_rotation`], [`settlement_rotation`] |
//! | shear stress over shear strain at points of a solid | [`stress_strain`] |
//! | load over displacement of a push-over | [`push_over`](push_over()) |
//! | contact modes over base and time | [`mode_map`] |
//! | largest, smallest and static pressure along the base; in plan the largest under each element | [`pressure_envelope`] |
//! | pressure, uplift and sliding in plan at an instant | [`contact_plan`] |
//! | one value for each shell of a mat, such as a bending moment | [`shell_plan`] |
//! | one value for each solid element of a section, such as a plastic strain | [`solid_section`] |
//! | terms of the energy balance over time | [`energy`] |
//! | response spectra | [`spectra`] |
//! | wave speeds and strains of a site over depth, and spectra | [`site_response`] |
//! | error against run time | [`refinement`](refinement()) |
//! | the structure at some instants, in plan in two elevations | [`deformed_shapes`] |
//! | the structure in motion, with its base and, in plan, its contact from above | [`animation`] (an SVG that browsers play) |
//! | a printed run with pictures, as one HTML file | [`page`](page()) |
//!
//! ```no_run
//! # fn recorded() -> basemat::results::TimeSeries { unimplemented!() }
//! use basemat::{plot, results::Quantity};
//! let time_series = recorded();
//! plot::time_series("Base shear", &[("friction 0.4", &time_series)], Quantity::BaseShear)?
//!     .save("base_shear.svg")?;
//! plot::mode_map("Contact", &time_series)?.save("modes.svg")?;
//! # Ok::<(), basemat::Error>(())
//! ```

mod animation;
mod axes;
mod base;
mod base_axis;
mod cells;
mod classes;
mod deformed;
mod drawing;
mod element_state;
mod element_values;
mod key;
mod lines;
mod marks;
mod paths;
mod plan;
#[cfg(feature = "png")]
mod png;
mod push_over;
mod refinement;
mod rocking;
mod site_response;
mod stress_strain;
mod svg;
mod text_width;
mod ticks;
mod view;

pub use animation::animation;
pub use base::{mode_map, pressure_envelope};
pub use deformed::deformed_shapes;
pub use element_values::{shell_plan, solid_section};
pub use lines::{Curve, curves, energy, probe_time_series, spectra, time_series};
pub use plan::contact_plan;
pub use push_over::push_over;
pub use refinement::refinement;
pub use rocking::{moment_rotation, settlement_rotation};
pub use site_response::site_response;
pub use stress_strain::stress_strain;
pub use svg::{Svg, page};
