//! The crate's performance targets, measured: histories, coefficients, whole runs, growth, memory,
//! scenes, reduced coordinates, sweeps.
//!
//! ```text
//! cargo run --release --features rayon --example performance                # a minute or two
//! cargo run --release --features rayon --example performance -- --short     # shorter runs
//! cargo run --release --features rayon --example performance -- --docs docs # to the documentation
//! ```
//!
//! Prints Markdown. Times are those of the thread on the processor, so that other work on the
//! machine disturbs little; the largest single step and what says so are wall time. Whole runs are
//! child processes, whose peak resident memory the system reports.

mod child;
mod histories;
mod reduced;
mod report;
mod scenes;
mod targets;

use std::path::PathBuf;

use clap::Parser;

use report::Report;
use scenes::STEPS;

type AnyError = Box<dyn std::error::Error + Send + Sync>;

/// The crate's performance targets, measured.
#[derive(Debug, Clone, Parser)]
struct Options {
    /// Shorter runs: to see that all works, not to be quoted.
    #[arg(long)]
    short: bool,
    /// Folder of the documentation: its performance.md gets the tables between its markers.
    #[arg(long)]
    docs: Option<PathBuf>,
    /// Run one scene in this process and print what it took.
    #[arg(long, hide = true)]
    child: Option<child::Scene>,
    #[arg(long, hide = true, default_value_t = STEPS)]
    steps: usize,
}

/// What `work` gives, and the seconds that this thread was on a processor for it.
fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let begin = cpu_time::ThreadTime::now();
    let result = work();
    (result, begin.elapsed().as_secs_f64())
}

fn main() -> Result<(), AnyError> {
    let options = Options::parse();
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
    if let Some(docs) = &options.docs {
        report::splice(&docs.join("performance.md"), &text)?;
    }
    Ok(())
}
