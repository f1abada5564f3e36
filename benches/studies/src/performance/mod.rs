//! The crate's performance targets, measured.
//!
//! They concern histories, convolution weights, whole runs, growth, memory, scenes, reduced coordinates and sweeps.
//!
//! ```text
//! cargo study performance                # a minute or two
//! cargo study performance --short     # shorter runs
//! cargo study performance --docs docs # to the documentation
//! ```
//!
//! Prints Markdown. Times are processor times of the thread, so that other work on the machine
//! has little effect; the largest single step, and numbers marked so, are wall time. Whole runs are
//! child processes, whose peak resident memory the system reports.

mod child;
mod histories;
mod reduced;
mod report;
mod targets;

use std::path::PathBuf;

use crate::AnyError;
use crate::document::splice;
use basemat_problems::headline::RECORD_STEPS;
use report::Report;

/// The crate's performance targets, measured.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct PerformanceOptions {
    /// Shorter runs, as a test.
    #[arg(long)]
    short: bool,
    /// Folder of the documentation; with it the tables go to benches/studies/tables/performance.md.
    #[arg(long)]
    docs: Option<PathBuf>,
    /// Run one scene in this process and print its times and memory.
    #[arg(long, hide = true)]
    child: Option<child::RunScene>,
    #[arg(long, hide = true, default_value_t = RECORD_STEPS)]
    steps: usize,
}

pub(crate) fn run(options: &PerformanceOptions) -> Result<(), AnyError> {
    if let Some(scene) = options.child {
        return child::run(scene, options.steps);
    }
    let mut report = Report::new();
    targets::runs(&mut report, options.short)?;
    targets::histories(&mut report, options.short)?;
    targets::scenes(&mut report, options.short)?;
    reduced::table(&mut report, options.short)?;
    targets::sweep(&mut report, options.short)?;
    let text = report.text();
    println!("{text}");
    if options.docs.is_some() {
        splice("performance.md", "performance", &text)?;
    }
    Ok(())
}
