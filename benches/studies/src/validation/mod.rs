//! Validation problems, whose references share no code with the crate.
//!
//! Each case states its errors and a limit for each; the process fails if one is exceeded. The
//! content of `benches/studies/tables/validation.md` comes from
//!
//! ```text
//! cargo study validation --docs docs
//! ```

mod cone;
mod containment;
mod convergence;
mod embedded;
mod lamb;
mod named_mats;
mod newmark_block;
mod outcome;
mod overturning;
mod plate;
mod punch;
mod report;
mod rocking_block;
mod rocking_frame;
mod scatter;
mod sliding_estimate;
mod strip_impedance;
mod transient;
mod two_springs;
mod uplift_law;
mod yim_chopra;

use std::path::PathBuf;

use cpu_time::ProcessTime;

use crate::AnyError;
use outcome::{Finished, ValidationCase};

/// The validation problems: errors against references, limits, pictures.
///
/// Prints a table for each case, writes checks.csv and SVG plots, and fails if a limit is exceeded.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct ValidationOptions {
    /// Only the case of this name.
    #[arg(long)]
    case: Option<String>,
    /// Folder for the files.
    #[arg(long, default_value = "target/study/validation")]
    pub(crate) out: PathBuf,
    /// Folder of the documentation; with it the numbers go to benches/studies/tables, and the
    /// plots to its images/.
    #[arg(long, conflicts_with = "short")]
    pub(crate) docs: Option<PathBuf>,
    /// Fewer and shorter runs, in seconds, for continuous integration.
    #[arg(long)]
    pub(crate) short: bool,
}

impl ValidationOptions {
    /// Whether the case called `name` was requested.
    pub(crate) fn selects(&self, name: &str) -> bool {
        self.case.as_deref().is_none_or(|case| case == name)
    }
}

const VALIDATION_CASES: [ValidationCase; 21] = [
    lamb::VALIDATION_CASE,
    strip_impedance::VALIDATION_CASE,
    embedded::VALIDATION_CASE,
    named_mats::VALIDATION_CASE,
    transient::BLOCK_CASE,
    transient::CANTILEVER_CASE,
    transient::THREE_STOREY_CASE,
    punch::VALIDATION_CASE,
    uplift_law::VALIDATION_CASE,
    newmark_block::VALIDATION_CASE,
    sliding_estimate::VALIDATION_CASE,
    rocking_block::VALIDATION_CASE,
    rocking_frame::VALIDATION_CASE,
    overturning::VALIDATION_CASE,
    two_springs::VALIDATION_CASE,
    scatter::VALIDATION_CASE,
    yim_chopra::VALIDATION_CASE,
    convergence::VALIDATION_CASE,
    plate::VALIDATION_CASE,
    cone::VALIDATION_CASE,
    containment::VALIDATION_CASE,
];

pub(crate) fn run(options: &ValidationOptions) -> Result<(), AnyError> {
    std::fs::create_dir_all(&options.out)?;
    let mut finished_cases = Vec::new();
    // Cases with a number outside its limits, and cases that failed.
    let mut failed_cases = Vec::new();
    for case in VALIDATION_CASES.into_iter().filter(|case| options.selects(case.name)) {
        let start_time = ProcessTime::try_now()?;
        let outcome = match (case.run)(options.short) {
            Ok(outcome) => outcome,
            Err(error) => {
                println!("\n{} ({}): {error}   <-- FAILS", case.title, case.name);
                failed_cases.push(case.name);
                continue;
            }
        };
        let seconds = start_time.try_elapsed()?.as_secs_f64();
        let case = Finished { case, outcome, seconds };
        report::print(&case);
        case.outcome.figure.draw(&options.out.join(case.image()))?;
        if !case.holds() {
            failed_cases.push(case.case.name);
        }
        finished_cases.push(case);
    }
    if finished_cases.is_empty() && failed_cases.is_empty() {
        let names: Vec<&str> = VALIDATION_CASES.iter().map(|case| case.name).collect();
        return Err(format!("no such case; there are {}", names.join(", ")).into());
    }
    report::write_checks(&options.out.join("checks.csv"), &finished_cases)?;
    if let Some(docs) = &options.docs {
        report::write_docs(docs, &finished_cases)?;
    }
    println!("files in {}", options.out.display());
    if failed_cases.is_empty() {
        return Ok(());
    }
    Err(format!("failed: {}", failed_cases.join(", ")).into())
}
