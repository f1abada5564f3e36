//! Command line.

use std::path::PathBuf;

/// Where the crate stays bounded, closes its energy ledger and finds its contact modes, and where
/// it refuses.
///
/// Prints tables, and writes cells.csv, tables.md and one SVG of heat maps per sweep. Ends with an
/// error if a cell of the crate's own scheme is not as it is guaranteed to be.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct Options {
    /// Folder for the files.
    #[arg(long, default_value = "target/study/stability")]
    pub(crate) out: PathBuf,
    /// Folder of the documentation: its stability.md gets the tables between its markers, its
    /// images/ the heat maps.
    #[arg(long)]
    pub(crate) docs: Option<PathBuf>,
    /// Few cells and few steps, in seconds: to see that all is well, not to be quoted.
    #[arg(long)]
    pub(crate) short: bool,
    /// Cells computed at the same time.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=64))]
    pub(crate) threads: u8,
    /// Only the sweep of this name; may be given several times.
    #[arg(long = "map")]
    pub(crate) maps: Vec<String>,
    /// Only cells with this label on the horizontal axis.
    #[arg(long)]
    pub(crate) x: Option<String>,
    /// Only cells with this label on the vertical axis.
    #[arg(long, allow_hyphen_values = true)]
    pub(crate) y: Option<String>,
    /// Only this scheme: basemat, dissipative, newmark, hht, paper or quadrature.
    #[arg(long)]
    pub(crate) scheme: Option<String>,
    /// Names the sweeps and their axes, and computes nothing.
    #[arg(long)]
    pub(crate) list: bool,
}
