//! Command line.

use std::path::PathBuf;

/// Fragility of a shear building that may uplift and slide: friction × width × motions × intensities.
///
/// Writes the table of all cases, the fitted curves and a picture. A shard writes its part of the table
/// only, and goes on where it was if it is started again.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct Options {
    /// Folder for the files.
    #[arg(long, default_value = "target/study/fragility")]
    pub(crate) out: PathBuf,
    /// Runs share I of N only, from 0: `--shard 3/16`.
    #[arg(long, value_parser = shard, conflicts_with = "merge")]
    pub(crate) shard: Option<Shard>,
    /// Runs nothing: merges the shards in the folder, and fits.
    #[arg(long)]
    pub(crate) merge: bool,
    /// Threads; more than one need the feature `rayon`, which takes all processors unless told.
    #[arg(long)]
    pub(crate) threads: Option<usize>,
    /// Few cases, in seconds: to see that all works.
    #[arg(long)]
    pub(crate) short: bool,
    /// Column of the table that is compared with the limit.
    #[arg(long, default_value = "residual_slip_m")]
    pub(crate) demand: String,
    /// Limit of the demand, in the column's unit.
    #[arg(long, default_value_t = 0.05)]
    pub(crate) limit: f64,
    /// Prints the table of all cases, too.
    #[arg(long)]
    pub(crate) table: bool,
}

/// A share of the cases.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shard {
    pub(crate) index: usize,
    pub(crate) of: usize,
}

impl Shard {
    pub(crate) fn file(self) -> String {
        format!("shard_{}_of_{}.csv", self.index, self.of)
    }
}

fn shard(text: &str) -> Result<Shard, String> {
    let numbers = text
        .split_once('/')
        .and_then(|(index, of)| Some(Shard { index: index.parse().ok()?, of: of.parse().ok()? }));
    numbers.ok_or_else(|| "must be like 3/16".to_owned())
}
