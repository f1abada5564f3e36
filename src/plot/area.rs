//! Where charts are drawn, and what drawing returns.

use plotters::prelude::*;

/// Where charts are drawn.
pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

/// Whatever goes wrong while drawing into memory.
pub(super) type Drawing<T> = std::result::Result<T, Box<dyn std::error::Error + Send + Sync>>;
