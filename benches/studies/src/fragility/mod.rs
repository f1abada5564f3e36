//! Fragility curves from thousands of runs: friction × width of the base × motions × intensities.
//!
//! ```text
//! cargo study fragility
//! cargo study fragility --shard 0/2 --out runs    # and 1/2, elsewhere
//! cargo study fragility --merge --out runs
//! ```
//!
//! A shear building stands on a mat that may uplift and slide. El Centro and near-fault pulses are scaled to levels of
//! peak ground velocity. Runs whose demand (by default the residual slip) exceeds its limit are counted; a lognormal
//! curve is fitted to the counts of each friction and width by maximum likelihood. Bands contain 90 % of the curves of
//! a bootstrap over the motions: all levels have the same motions, so that runs are not independent.
//!
//! Cases are rows of one table. The row of a case that fails states the reason; it is not counted.
//! A run that is stopped continues from its table; `docs/guide.md`, Sweeps, distributes it over a cluster.

mod lognormal;
pub(crate) mod motions;
mod picture;
mod scene;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use basemat::bem::SharedKernels;
use basemat::sweep::{CaseTable, Parameter, Sweep};
use basemat_problems::random::Random;
use cpu_time::ProcessTime;
use indicatif::{ProgressBar, ProgressStyle};

use crate::AnyError;
use crate::document::write_csv;
use lognormal::{FragilityGroup, Outcomes};
use motions::EnsembleMotion;

/// Curves of the bootstrap.
const BOOTSTRAP_SAMPLES: usize = 1000;

/// Fragility of a shear building that may uplift and slide: friction × width × motions × intensities.
///
/// Writes the table of all cases, the fitted curves and a picture. A shard writes its part of the table
/// only, and continues it if it is started again.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct FragilityOptions {
    /// Folder for the files.
    #[arg(long, default_value = "target/study/fragility")]
    pub(crate) out: PathBuf,
    /// Runs part I of N only, from 0: `--shard 3/16`.
    #[arg(long, value_parser = shard, conflicts_with = "merge")]
    pub(crate) shard: Option<Shard>,
    /// Merges the shards in the folder and fits, without runs.
    #[arg(long)]
    pub(crate) merge: bool,
    /// Threads; more than one need the feature `rayon`, which uses all processors by default.
    #[arg(long)]
    pub(crate) threads: Option<usize>,
    /// Few cases, as a test in seconds.
    #[arg(long)]
    pub(crate) short: bool,
    /// Column of the table that is compared with the limit.
    #[arg(long, default_value = "residual_slip_m")]
    pub(crate) demand: String,
    /// Limit of the demand, in the column's unit.
    #[arg(long, default_value_t = 0.05)]
    pub(crate) limit: f64,
    /// Also prints the table of all cases.
    #[arg(long)]
    pub(crate) table: bool,
}

/// A part of the cases.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shard {
    pub(crate) index: usize,
    pub(crate) count: usize,
}

impl Shard {
    pub(crate) fn file(self) -> String {
        format!("shard_{}_of_{}.csv", self.index, self.count)
    }
}

fn shard(text: &str) -> Result<Shard, String> {
    let shard = text.split_once('/').and_then(|(index, count)| {
        Some(Shard { index: index.parse().ok()?, count: count.parse().ok()? })
    });
    shard.ok_or_else(|| "must be like 3/16".to_owned())
}

pub(crate) fn run(options: &FragilityOptions) -> Result<(), AnyError> {
    threads(options.threads)?;
    let motions = motions::list(scene::TIME_STEP, options.short)?;
    let mut frictions: &[f64] = &[0.2, 0.3, 0.4];
    let mut widths: &[f64] = &[6.0, 9.0, 12.0];
    let mut levels: &[f64] = &[0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0, 1.3, 1.6, 2.0];
    if options.short {
        frictions = &[0.2, 0.4];
        widths = &[8.0];
        levels = &[0.2, 0.5, 1.0, 1.6];
    }
    let sweep = Sweep::grid([
        Parameter::numbers("friction", frictions.iter().copied()),
        Parameter::numbers("width_m", widths.iter().copied()),
        Parameter::texts("motion", motions.iter().map(|(name, _)| name)),
        Parameter::numbers("peak_velocity_m_per_s", levels.iter().copied()),
    ])?;
    std::fs::create_dir_all(&options.out)?;
    if let Some(shard) = options.shard {
        let path = options.out.join(shard.file());
        compute(sweep.shard(shard.index, shard.count)?, &path, &motions)?;
        return Ok(());
    }
    let cases = options.out.join("cases.csv");
    let table = if options.merge {
        let table = sweep.merge(shards(&options.out)?)?;
        table.csv().save(&cases)?;
        table
    } else {
        compute(sweep, &cases, &motions)?
    };
    if options.table {
        println!("{table}\n");
    }

    let mut groups = Vec::new();
    for &friction in frictions {
        for &width in widths {
            groups.push(group(&table, friction, width, levels, motions.len(), options)?);
        }
    }
    report(&groups, options);
    write(&options.out.join("curves.csv"), &groups)?;
    let title = format!("{} above {}: fitted curves, bands of 90 %", options.demand, options.limit);
    picture::draw(&options.out.join("fragility.svg"), &title, &groups, widths)?;
    println!("files in {}", options.out.display());
    Ok(())
}

/// Sets the requested number of threads.
fn threads(count: Option<usize>) -> Result<(), AnyError> {
    #[cfg(feature = "rayon")]
    if let Some(count) = count {
        rayon::ThreadPoolBuilder::new().num_threads(count).build_global()?;
    }
    if cfg!(not(feature = "rayon")) && count.is_some_and(|count| count > 1) {
        return Err("more than one thread needs the feature `rayon`".into());
    }
    Ok(())
}

/// Runs the cases that the file does not have yet, and prints their times.
fn compute(
    sweep: Sweep<'_>,
    path: &Path,
    motions: &[EnsembleMotion],
) -> Result<CaseTable, AnyError> {
    let bar = ProgressBar::new(sweep.cases().len() as u64);
    bar.set_style(ProgressStyle::with_template("{bar:40} {pos}/{len} cases, {eta} left")?);
    let start_time = Instant::now();
    let before = ProcessTime::try_now()?;
    let kernels = SharedKernels::default();
    let runs = AtomicUsize::new(0);
    let table =
        sweep.on_progress(|_, _| bar.inc(1)).table_in(path, scene::RESULT_COLUMNS, |case| {
            runs.fetch_add(1, Ordering::Relaxed);
            let friction = case.value("friction")?;
            let width = case.value("width_m")?;
            let motion = &motions[case.place("motion")?].1;
            scene::shake(friction, width, motion, case.value("peak_velocity_m_per_s")?, &kernels)
        })?;
    bar.finish_and_clear();
    let wall = start_time.elapsed();
    let processors = before.try_elapsed()?;
    let runs = runs.into_inner();
    let failed_cases = failures(&table);
    let existing = table.rows().len() - runs;
    println!(
        "{}: {runs} cases run, {existing} already there, {failed_cases} failed",
        path.display()
    );
    if runs > 0 {
        let thousands = 1e-3 * runs as f64;
        println!(
            "{:.2} s by the clock, {:.2} s of processors; a thousand runs {:.2} s, {:.2} s of processors",
            wall.as_secs_f64(),
            processors.as_secs_f64(),
            wall.as_secs_f64() / thousands,
            processors.as_secs_f64() / thousands
        );
    }
    Ok(table)
}

fn failures(table: &CaseTable) -> usize {
    table.rows().filter(|row| row.results.is_err()).count()
}

/// Files of shards in a folder.
fn shards(folder: &Path) -> Result<Vec<PathBuf>, AnyError> {
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if name.starts_with("shard_") && path.extension().is_some_and(|end| end == "csv") {
            paths.push(path);
        }
    }
    paths.sort();
    Ok(paths)
}

/// Counts, curve and bootstrap of one friction coefficient and width.
fn group(
    table: &CaseTable,
    friction: f64,
    width: f64,
    levels: &[f64],
    motions: usize,
    options: &FragilityOptions,
) -> Result<FragilityGroup, AnyError> {
    let mut outcomes: Outcomes = vec![vec![None; levels.len()]; motions];
    for row in table.rows() {
        if row.value("friction")? == friction && row.value("width_m")? == width {
            let motion = row.place("motion")?;
            let level = row.place("peak_velocity_m_per_s")?;
            if row.results.is_ok() {
                let demand = row.value(&options.demand)?;
                outcomes[motion][level] = (!demand.is_nan()).then_some(demand > options.limit);
            }
        }
    }
    let stripes = lognormal::stripes(levels, outcomes.iter());
    // The same samples in every run.
    let mut random = Random(1);
    let samples = lognormal::resampled(levels, &outcomes, BOOTSTRAP_SAMPLES, || random.bits());
    Ok(FragilityGroup { friction, width, fit: lognormal::fit(&stripes), stripes, samples })
}

fn report(groups: &[FragilityGroup], options: &FragilityOptions) {
    println!(
        "\nPeak ground velocity at which {} exceeds {}, m/s: median and dispersion of the lognormal\n\
         curve, 90 % of a bootstrap over the motions, standard errors if all runs were independent\n",
        options.demand, options.limit
    );
    println!("| friction | width, m | runs | median | 90 % | dispersion | 90 % | errors |");
    println!("|---|---|---|---|---|---|---|---|");
    for group in groups {
        let runs: f64 = group.stripes.iter().map(|stripe| stripe.runs).sum();
        print!("| {} | {} | {runs} |", group.friction, group.width);
        match group.fit {
            None => {
                let exceedances: f64 = group.stripes.iter().map(|stripe| stripe.exceeded).sum();
                println!(" no curve: {exceedances} beyond the limit | | | | |");
            }
            Some(fit) => {
                let median = group.band(|curve| curve.median);
                let dispersion = group.band(|curve| curve.dispersion);
                println!(
                    " {:.3} | {:.3} to {:.3} | {:.2} | {:.2} to {:.2} | {:.3}, {:.2} |",
                    fit.curve.median,
                    median[0],
                    median[1],
                    fit.curve.dispersion,
                    dispersion[0],
                    dispersion[1],
                    fit.curve.median * fit.median_error,
                    fit.dispersion_error
                );
            }
        }
    }
    println!();
}

/// Writes the fits as CSV.
fn write(path: &Path, groups: &[FragilityGroup]) -> Result<(), AnyError> {
    let mut rows = Vec::new();
    for group in groups {
        let medians = group.band(|curve| curve.median);
        let dispersions = group.band(|curve| curve.dispersion);
        let values = [
            group.friction,
            group.width,
            group.fit.map_or(f64::NAN, |fit| fit.curve.median),
            medians[0],
            medians[1],
            group.fit.map_or(f64::NAN, |fit| fit.curve.dispersion),
            dispersions[0],
            dispersions[1],
        ];
        rows.push(values.map(|value| value.to_string()));
    }
    let columns = [
        "friction",
        "width_m",
        "median_m_per_s",
        "median_low_m_per_s",
        "median_high_m_per_s",
        "dispersion",
        "dispersion_low",
        "dispersion_high",
    ];
    write_csv(path, columns, rows)
}
