//! Command line.

use std::path::PathBuf;

use clap::Parser;

/// The validation problems: errors against references, limits, pictures.
///
/// Prints a table a case, writes checks.csv and SVG plots, and fails if a limit is exceeded.
#[derive(Debug, Clone, Parser)]
pub(crate) struct Options {
    /// Only the case of this name.
    #[arg(long)]
    case: Option<String>,
    /// Folder for the files.
    #[arg(long, default_value = "target/validation")]
    pub(crate) out: PathBuf,
    /// Folder of the documentation: its accuracy.md gets the numbers between its markers, its
    /// images/ the plots.
    #[arg(long, conflicts_with_all = ["case", "short"])]
    pub(crate) docs: Option<PathBuf>,
    /// Fewer and shorter runs, in seconds: for continuous integration.
    #[arg(long)]
    pub(crate) short: bool,
}

impl Options {
    /// Whether the case called `name` was asked for.
    pub(crate) fn wants(&self, name: &str) -> bool {
        self.case.as_deref().is_none_or(|case| case == name)
    }
}
