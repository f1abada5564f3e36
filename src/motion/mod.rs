//! Ground motions: records, and free fields made of them.
//!
//! Read or build a [`Record`] and treat its [`Baseline`]; it is integrated exactly. A [`FreeField`] is the motion
//! of the ground's surface without the structure: [`VerticalIncidence`] from records, [`Triaxial`] from records in
//! three directions, [`RickerDisplacement`] a pulse in closed form, [`FreeFieldFn`] from closures, [`AtRest`]
//! without motion.

// For authors of a record format: write a file like `esm.rs` (one sample a line) or `afad.rs` (columns), with
// `read(lines) -> LineResult<Series>`, and use
//
// * `lines`: the lines of a file (`Lines`), their numbers (`push_numbers`, `read_numbers`), `required` values of a
//   header, and the results `Series`, `to_record` and `to_records`;
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
mod free_field;
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
mod out_of_phase;
mod peer;
mod plane_wave;
mod reader;
mod record;
mod slist;
mod smc;
mod spectrum;
mod travelling_wave;
mod unit;
mod unit_name;

pub use afad::AfadFormat;
pub use along_lines::AlongLinesFormat;
pub use baseline::Baseline;
pub use cosmos::CosmosFormat;
pub use esm::EsmFormat;
pub use format::RecordFormat;
pub use fortran_format::FortranFormat;
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
pub use slist::SlistFormat;
pub use smc::SmcFormat;
pub use spectrum::{CoarseSpectrum, SpectralOrdinate};
pub use travelling_wave::TravellingWave;
pub use unit::{AccelerationUnit, STANDARD_GRAVITY};
