//! Records of strong ground motion: files of agencies, baselines, filters, integrals and response spectra.
//!
//! Read or build a [`Record`] and treat its [`Baseline`]; it is integrated exactly. `basemat` re-exports all of this as
//! `basemat::motion`, so examples have the paths of `basemat`; here the same items stand at the root.
#![forbid(unsafe_code)]

#[macro_use]
extern crate basemat_base;

// For authors of a record format: write a file like `esm.rs` (one sample a line) or `afad.rs` (columns), with
// `read(lines) -> LineResult<Series>` or `LineResult<Vec<Series>>`, and use
//
// * `lines`: the lines of a file (`Lines`), their numbers (`push_numbers`, `read_numbers`), `required` values of a
//   header;
// * `series`: `Series`, the samples of a component, and `check_sample_count`;
// * `format`: `read_one_component` or `read_components`, which implement `RecordFormat` by `read`;
// * `fortran_format`: numbers in columns of fixed width, which may touch;
// * `header_number`: a quantity of a header with its unit; `unit_name`: names of units of acceleration;
// * `column_title` and `header_line`: titles of columns, and the units that they name;
// * `agreement`: number of samples, duration and peak that a file states twice;
// * `block`: the titles of COSMOS and CSMIP that describe a block of numbers; `clock`: columns of times;
// * `fault`: errors that several formats have.
//
// `reader` and `along_lines` read tables and series without a header; `number_table` distinguishes these two.
mod afad;
mod agreement;
mod along_lines;
mod baseline;
mod block;
mod clock;
mod column_title;
mod cosmos;
mod csmip;
mod esm;
mod fault;
mod filter;
mod format;
mod fortran_format;
mod geonet;
mod header_line;
mod header_number;
mod hilbert;
mod integral;
mod intensity;
mod k_net;
mod k_net_csv;
mod lines;
mod number_table;
mod peer;
mod reader;
mod record;
mod series;
mod slist;
mod smc;
mod spectrum;
mod unit;
mod unit_name;

pub use afad::AfadFormat;
pub use along_lines::AlongLinesFormat;
pub use baseline::Baseline;
pub use basemat_base::error::{FileError, FileFault, Observer, Progress, unobserved};
pub use basemat_base::{Error, Result};
use basemat_base::{error, text};
pub use cosmos::CosmosFormat;
pub use esm::EsmFormat;
pub use format::RecordFormat;
pub use fortran_format::FortranFormat;
pub use geonet::GeoNetFormat;
#[doc(hidden)]
pub use hilbert::hilbert;
pub use integral::Motion;
#[doc(hidden)]
pub use integral::quadratic_roots_within;
pub use k_net::KNetFormat;
pub use k_net_csv::KNetCsvFormat;
pub use peer::PeerFormat;
pub use reader::{ColumnFormat, el_centro_1940};
pub use record::Record;
pub use slist::SlistFormat;
pub use smc::SmcFormat;
pub use spectrum::{CoarseSpectrum, SpectralOrdinate};
pub use unit::{AccelerationUnit, STANDARD_GRAVITY};

/// The README's program is compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct RecordsReadme;
