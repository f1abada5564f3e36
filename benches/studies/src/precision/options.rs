//! Command line.

use std::path::PathBuf;

/// Error of the base shear against processor time, over meshes, time steps, histories and schemes.
///
/// Prints tables, and writes points.csv, advice.csv, tables.md and SVG plots.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct Options {
    /// Folder for the files.
    #[arg(long, default_value = "target/study/precision")]
    pub(crate) out: PathBuf,
    /// Folder of the documentation: its accuracy.md gets the main tables between its markers, its
    /// images/ the plots.
    #[arg(long)]
    pub(crate) docs: Option<PathBuf>,
    /// Small sweeps, in seconds: to see that all works, not to be quoted.
    #[arg(long)]
    pub(crate) short: bool,
    /// Only the advice, on many bonded scenes drawn at random: writes advice_sweep.csv.
    #[arg(long)]
    pub(crate) advice: bool,
    /// Only the lines of error against time of structures of 300 to 30 000 unknowns.
    #[arg(long)]
    pub(crate) front: bool,
    /// Runs of each setting, of which the fastest counts; one only where a run takes over a second.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u8).range(1..=100))]
    pub(crate) repeats: u8,
}
