//! Random numbers, reference tables, comparison of series and plain dense algebra for tests.
//!
//! Nothing here depends on basemat: the unit tests of basemat and of the crates below it can use it.

#![allow(missing_docs, missing_debug_implementations, reason = "not published")]
#![allow(
    clippy::len_without_is_empty,
    clippy::missing_errors_doc,
    clippy::missing_panics_doc,
    reason = "not published"
)]

/// Whether tests run all their scenes, as they do every night: `HEAVY_TESTS` is set.
pub fn heavy() -> bool {
    std::env::var_os("HEAVY_TESTS").is_some()
}

/// Nodes of a distorted quadrilateral: corners, then nodes between them.
pub const DISTORTED_QUAD_NODES: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [2.1, 0.2, 0.0],
    [1.9, 1.6, 0.0],
    [-0.2, 1.3, 0.0],
    [1.0, 0.05, 0.0],
    [2.1, 0.8, 0.0],
    [0.9, 1.5, 0.0],
    [-0.05, 0.7, 0.0],
];

pub mod check_sum;
pub mod dense;
mod maxwell;
pub mod random;
pub mod series;
pub mod table;

pub use csv;
pub use maxwell::gmb_numbers;
pub use table::{ReferenceTable, assert_close, data_path, table};
