//! Solids and frames that yield: every check of their laws, elements, energies and time steps, with its limit.
//!
//! The process fails if a limit is exceeded. The table of `docs/validation.md` comes from
//!
//! ```text
//! cargo study yielding --docs docs
//! ```

mod check;
mod elements;
mod frames;
mod laws;
mod rotations;
mod run_counts;
mod runs;
mod strips;

use std::path::PathBuf;

use crate::AnyError;
use crate::document::splice_into;
use check::{Check, markdown};

/// Solids and frames that yield: checks of laws, elements, energies and time steps.
///
/// Prints a table, and fails if a limit is exceeded.
#[derive(Debug, clap::Args)]
pub(crate) struct YieldingOptions {
    /// Fewer scenes, shorter runs and coarser meshes, in less than a minute.
    #[arg(long)]
    short: bool,
    /// Folder of the documentation: given, the table goes to its `validation.md`.
    #[arg(long, conflicts_with = "short")]
    docs: Option<PathBuf>,
}

/// Runs the study.
pub(crate) fn run(options: &YieldingOptions) -> Result<(), AnyError> {
    let mut checks = laws::checks()?;
    checks.extend(elements::checks()?);
    checks.extend(strips::checks(options.short));
    let (rotation_checks, figure) = rotations::checks(options.short)?;
    checks.extend(rotation_checks);
    checks.extend(runs::checks(options.short)?);
    checks.extend(frames::checks(options.short));
    let table = markdown(&checks);
    println!("\n{table}");
    if let Some(docs) = &options.docs {
        splice_into(&docs.join("validation.md"), "yielding", &table)?;
        figure.draw(&docs.join("images/validation_moment_capacity.svg"))?;
    }
    let failed_checks: Vec<&str> =
        checks.iter().filter(|check| !check.holds()).map(Check::name).collect();
    if failed_checks.is_empty() {
        Ok(())
    } else {
        Err(format!("failed: {}", failed_checks.join("; ")).into())
    }
}
