//! Ground motion that differs from point to point: a disc of the literature, a containment, and the cost.
//!
//! ```text
//! cargo study incoherence --docs docs
//! ```

mod containment;

use std::fmt::Write as _;
use std::path::PathBuf;

use basemat::bem::plan::Plan;
use basemat::motion::{AbrahamsonCoherence, Coherence, Incoherence, LucoWong, Triaxial};
use basemat::prelude::*;
use basemat_problems::incoherent_disc::{
    DISC_COMPONENTS, DISC_FREQUENCIES, Disc, PUBLISHED_MEAN_SQUARES, SampledMean,
    sampled_mean_squares,
};
use cpu_time::ThreadTime;

use crate::AnyError;
use crate::document::{peak_memory, splice};

/// Ground motion that differs from point to point: a disc of the literature, a containment, and the cost.
#[derive(Debug, clap::Args)]
pub(crate) struct IncoherenceOptions {
    /// Few cells, seeds and steps, as a test.
    #[arg(long)]
    short: bool,
    /// Cells along the diameter of the disc.
    #[arg(long, default_value_t = 16)]
    cells: usize,
    /// Seeds of the disc.
    #[arg(long, default_value_t = 200)]
    disc_seeds: u64,
    /// Seeds of the containment.
    #[arg(long, default_value_t = 20)]
    seeds: u64,
    /// One part only.
    #[arg(long)]
    part: Option<IncoherencePart>,
    /// Folder for the files.
    #[arg(long, default_value = "target/study/incoherence")]
    out: PathBuf,
    /// Folder of the documentation; with it the tables go to benches/studies/tables, and the picture to its images/.
    #[arg(long, conflicts_with = "short")]
    docs: Option<PathBuf>,
}

/// Part of the study.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum IncoherencePart {
    Cost,
    Disc,
    Containment,
}

/// Runs the study.
pub(crate) fn run(options: &IncoherenceOptions) -> Result<(), AnyError> {
    std::fs::create_dir_all(&options.out)?;
    let includes = |part: IncoherencePart| options.part.is_none_or(|chosen| chosen == part);
    if includes(IncoherencePart::Cost) {
        publish(options, "cost", &cost(options.short)?)?;
    }
    if includes(IncoherencePart::Disc) {
        publish(options, "disc", &disc(options)?)?;
    }
    if includes(IncoherencePart::Containment) {
        let seeds = if options.short { 2 } else { options.seeds };
        let comparison = containment::compare(seeds, options.short)?;
        publish(options, "containment", &comparison.table)?;
        comparison.figure.draw(&options.out.join("incoherence.svg"))?;
        if let Some(docs) = &options.docs {
            comparison.figure.draw(&docs.join("images/incoherence.svg"))?;
        }
    }
    println!("files in {}", options.out.display());
    Ok(())
}

/// Prints a table, and puts it into the tables of the documents.
fn publish(options: &IncoherenceOptions, name: &str, text: &str) -> Result<(), AnyError> {
    println!("{text}");
    if options.docs.is_some() {
        splice("incoherence.md", &format!("incoherence {name}"), text)?;
    }
    Ok(())
}

/// Mean squares of the motion of a rigid disc without mass, beside the published ones.
fn disc(options: &IncoherenceOptions) -> Result<String, AnyError> {
    let cells = if options.short { 6 } else { options.cells };
    let seed_count = if options.short { 4 } else { options.disc_seeds };
    let disc = Disc::new(cells)?;
    let mut text = "| motion | a₀ | Luco and Mita (1987) | w* Γ w | difference, % | mean over seeds | its standard error |\n|---|---|---|---|---|---|---|\n".to_owned();
    for ((component, published), name) in DISC_COMPONENTS
        .into_iter()
        .zip(PUBLISHED_MEAN_SQUARES)
        .zip(["horizontal", "vertical"])
    {
        let weights = disc.weights(component)?;
        let sampled_mean_squares = sampled_mean_squares(&disc, component, &weights, seed_count)?;
        for (k, frequency) in DISC_FREQUENCIES.into_iter().enumerate() {
            let mean_square = disc.mean_square(&weights[k], frequency)?;
            let SampledMean { mean, standard_error } = sampled_mean_squares[k];
            writeln!(
                text,
                "| {name} | {frequency} | {:.3} | {mean_square:.4} | {:+.2} | {mean:.4} | {standard_error:.4} |",
                published[k],
                100.0 * (mean_square / published[k] - 1.0),
            )?;
        }
    }
    Ok(text)
}

/// Samples of the record whose motions are timed, and their interval, s.
const COST_SAMPLES: usize = 4096;
const COST_INTERVAL: f64 = 0.01;
/// Side of the mat, m, and cells along it.
const COST_SIDE: f64 = 40.0;
const COST_CELLS: usize = 20;

/// Processor time and memory of motions in three components.
fn cost(short: bool) -> Result<String, AnyError> {
    let cells = if short { 6 } else { COST_CELLS };
    let half_side = 0.5 * COST_SIDE;
    let plan = Plan::rectangle(-half_side..half_side, -half_side..half_side, cells)?;
    let elements = plan.elements();
    // White noise between quiet times, with motion up to half the sampling frequency.
    let mut noise = 1_u32;
    let mut samples = vec![0.0; COST_SAMPLES];
    for sample in &mut samples[500..COST_SAMPLES - 500] {
        noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        *sample = f64::from(noise >> 8) / f64::from(1 << 23) - 1.0;
    }
    let baseline = basemat::motion::Baseline::RestToRest { degree: 4 };
    let record = Record::new(COST_INTERVAL, samples)?.high_pass(0.2, 4)?.with_baseline(baseline)?;
    let records =
        Triaxial { x: Some(record.clone()), y: Some(record.clone()), up: Some(record.clone()) };
    let mut text = format!(
        "{} cells of {COST_SIDE} m × {COST_SIDE} m, {COST_SAMPLES} samples, three components\n\n| coherence | processor time, s | peak memory of the process, MB | smallest eigenvalue |\n|---|---|---|---|\n",
        elements.len()
    );
    let luco_wong = LucoWong::new(0.25, 300.0)?;
    time_motion("Luco and Wong, α = 0.25, 300 m/s", luco_wong, &records, &elements, &mut text)?;
    let rock = AbrahamsonCoherence::HardRockHorizontal;
    time_motion("Abrahamson, hard rock, clipped", rock, &records, &elements, &mut text)?;
    Ok(text)
}

/// Adds the row of a coherence to the table of costs.
fn time_motion(
    name: &str,
    coherence: impl Coherence + 'static,
    records: &Triaxial,
    elements: &[basemat::bem::ContactElement],
    text: &mut String,
) -> Result<(), AnyError> {
    let start = ThreadTime::now();
    let motion = Incoherence::new(coherence).clipped().motion(records, elements)?;
    let seconds = start.elapsed().as_secs_f64();
    writeln!(
        text,
        "| {name} | {seconds:.1} | {:.0} | {:.2} |",
        peak_memory().unwrap_or(f64::NAN),
        motion.min_eigenvalue()
    )?;
    Ok(())
}
