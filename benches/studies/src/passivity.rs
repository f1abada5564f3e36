//! Passivity of the half-plane in long runs: random tractions never extract energy, and random
//! displacements give bounded tractions. The short form of this table is a test.
//!
//! ```text
//! cargo study passivity --elements 60 --steps 10000
//! ```

use basemat::history::HistoryMethod;

use basemat_problems::passivity::PassivityScene;

/// Passivity of the half-plane under random tractions and displacements.
#[derive(Debug, clap::Args)]
pub(crate) struct PassivityOptions {
    /// Elements of the strip
    #[arg(long, default_value_t = 60)]
    elements: usize,
    /// Steps of each run
    #[arg(long, default_value_t = 10_000)]
    steps: usize,
    /// Steps over element length, c₁Δt/l
    #[arg(long, value_delimiter = ',', default_value = "0.5")]
    beta: Vec<f64>,
    /// Poisson's ratios
    #[arg(long, value_delimiter = ',', default_value = "0.3333333333333333")]
    poisson: Vec<f64>,
    /// Elements graded towards the edges too (many times slower to evaluate)
    #[arg(long)]
    graded: bool,
    /// History by exponentials of this relative accuracy, 1e-12 to 1e-2
    #[arg(long)]
    tolerance: Option<f64>,
}

pub(crate) fn run(options: &PassivityOptions) {
    let &PassivityOptions { elements, steps, .. } = options;
    println!("{elements} elements, {steps} steps");
    println!(
        "{:>8} {:>8} {:>8} {:>12} {:>20} {:>8}",
        "β", "ν", "mesh", "least work", "growth of tractions", "wall, s"
    );
    let meshes: &[bool] = if options.graded { &[false, true] } else { &[false] };
    for &beta in &options.beta {
        for &poisson in &options.poisson {
            for &graded in meshes {
                let history = if options.tolerance.is_some() {
                    HistoryMethod::Exponentials
                } else {
                    HistoryMethod::Auto
                };
                let tolerance = options.tolerance.unwrap_or(0.0);
                let scene = PassivityScene {
                    poisson,
                    beta,
                    graded,
                    elements,
                    steps,
                    seed: 1,
                    history,
                    tolerance,
                };
                let start_time = std::time::Instant::now();
                let work = scene.min_work_ratio();
                let growth = scene.growth_of_tractions();
                let mesh = if graded { "graded" } else { "uniform" };
                println!(
                    "{beta:>8} {poisson:>8.4} {mesh:>8} {work:>12.3e} {growth:>20.3} {:>8.1}",
                    start_time.elapsed().as_secs_f64()
                );
            }
        }
    }
}
