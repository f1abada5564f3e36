//! Random contact problems, each solved by a simulation's step and by brute force.
//!
//! The table states which method found the modes, in how many solves, and where the solution is not unique.
//!
//! ```text
//! cargo study contact-problems
//! cargo study contact-problems --published target/published_problems     # see export.py
//! ```

mod published;

use std::path::PathBuf;

use basemat_problems::contact_problems::{ContactTally, SEQUENCE_STEPS, sequence};
use basemat_problems::random::Random;

use crate::AnyError;

/// Random contact problems against brute force.
#[derive(Debug, clap::Args)]
pub(crate) struct ContactProblemsOptions {
    /// Problems, about
    #[arg(long, default_value_t = 100_000)]
    problems: usize,
    /// Seed of the random numbers
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Folder of problems written by export.py, which replace the random ones.
    #[arg(long)]
    published: Option<PathBuf>,
    /// Folder of the documentation; with it the published problems go to benches/studies/tables, and the picture to its
    /// images/.
    #[arg(long, requires = "published")]
    docs: Option<PathBuf>,
}

/// Ranges of the friction coefficient.
const FRICTION_RANGES: [[f64; 2]; 6] =
    [[0.0, 0.0], [0.0, 0.3], [0.3, 0.6], [0.6, 1.0], [1.0, 2.0], [2.0, 3.0]];
/// Numbers of elements, and how many of a hundred sequences have them.
const ELEMENT_COUNTS: [(usize, usize); 5] = [(1, 10), (2, 30), (3, 40), (4, 18), (5, 2)];

pub(crate) fn run(options: &ContactProblemsOptions) -> Result<(), AnyError> {
    if let Some(folder) = &options.published {
        return published::run(folder, options.docs.as_deref());
    }
    let mut random = Random(options.seed);
    println!(
        "| operator | friction | problems | active set | Gauss–Seidel | path | solves, mean | most \
         | several solutions | most | none | failed | conditions off by | from brute force |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    let mut total = ContactTally::default();
    for real in [true, false] {
        for range in FRICTION_RANGES {
            let mut tally = ContactTally::default();
            let sequences = options.problems.div_ceil(2 * FRICTION_RANGES.len() * SEQUENCE_STEPS);
            for (count, percent) in ELEMENT_COUNTS {
                for _ in 0..(sequences * percent).div_ceil(100) {
                    let friction = random.within(range[0], range[1].max(f64::MIN_POSITIVE));
                    let friction = if range[1] == 0.0 { 0.0 } else { friction };
                    tally.add(&sequence(count, friction, real, &mut random));
                }
            }
            let operator = if real { "scene" } else { "invented" };
            print_row(operator, &format!("{} to {}", range[0], range[1]), &tally);
            total.add(&tally);
        }
    }
    print_row("all", "0 to 3", &total);
    Ok(())
}

fn print_row(operator: &str, friction: &str, tally: &ContactTally) {
    let mean = tally.trials as f64 / (tally.problems - tally.failed_steps).max(1) as f64;
    println!(
        "| {operator} | {friction} | {} | {} | {} | {} | {mean:.2} | {} | {} | {} | {} | {} \
         | {:.0e} | {:.0e} |",
        tally.problems,
        tally.methods[0],
        tally.methods[1],
        tally.methods[2],
        tally.max_trials,
        tally.ambiguous_problems,
        tally.max_solutions,
        tally.unsolvable_problems,
        tally.failed_steps,
        tally.max_violation,
        tally.max_distance
    );
}
