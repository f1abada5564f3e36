//! El Centro on a containment that may uplift and slide: the problem of Patel & Spyrakos,
//! "Uplifting-sliding response of flexible structures to seismic loads".
//!
//! Five runs as in the paper's Table 1 (bonded, uplift only, friction 0.4, 0.3, 0.2), a table, CSV
//! files and plots. The figure with the dimensions is lost: contact length and height are calibrated
//! on the first two rows of Table 1, and the soil's density is an assumption. All are options:
//!
//! ```text
//! cargo run --release --example containment               # 1 s
//! cargo run --release --example containment -- --sweep    # friction from 0.05 to 0.8 as well: 4 s
//! cargo run --release --example containment -- --meshes   # 15 elements as well: 3 s
//! cargo run --release --features rayon --example containment -- --help
//! ```

mod case;
#[path = "../common/chart.rs"]
mod chart;
mod conclusions;
#[path = "../common/containment.rs"]
mod containment;
mod figures;
mod options;
mod plots;
mod report;

use basemat::motion::Record;
use basemat::{CaseError, Sweep};
use clap::Parser;
use indicatif::{MultiProgress, ProgressBar, ProgressStyle};

use case::{Case, Outcome};
use options::Options;

type AnyError = Box<dyn std::error::Error + Send + Sync>;

fn main() -> Result<(), AnyError> {
    let options = Options::parse();
    let record = options.record()?;
    let steps = options.steps(&record);
    let cases = Case::list(&options.friction);
    // A folder that cannot be written is better known before the runs than after.
    std::fs::create_dir_all(&options.out)?;
    println!(
        "containment {} ft wide, {} ft high on soil with c_S = {} ft/s, c_P = {} ft/s; \
         {steps} steps of {:.4} ms",
        options.width_ft,
        options.height_ft,
        options.shear_speed_fts,
        options.pressure_speed_fts,
        1e3 * options.time_step_s(),
    );

    let bars = MultiProgress::new();
    let style = ProgressStyle::with_template("{prefix:>14} {bar:40} {percent:>3} %  {eta} left")?;
    let bars: Vec<_> = cases
        .iter()
        .map(|case| {
            let bar = bars.add(ProgressBar::new(steps as u64));
            bar.set_style(style.clone());
            bar.set_prefix(case.name.clone());
            bar
        })
        .collect();

    // Cases are independent: with the feature `rayon`, as many at a time as there are processors.
    let mut outcomes: Vec<Option<Result<Outcome, CaseError<AnyError>>>> =
        cases.iter().map(|_| None).collect();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to the steps")]
    let set_bar = |k: usize, fraction: f64| bars[k].set_position((fraction * steps as f64) as u64);
    Sweep::new(cases.len()).on_progress(set_bar).run(
        |now| case::run(&cases[now.index()], &options, &record, steps, now),
        |k, outcome| {
            bars[k].finish();
            outcomes[k] = Some(outcome);
        },
    );
    let mut results = Vec::new();
    for (case, outcome) in cases.iter().zip(outcomes) {
        let outcome = outcome.ok_or_else(|| format!("{}: the run did not end", case.name))?;
        results.push(outcome.map_err(|e| format!("{}: {e}", case.name))?);
    }

    report::print_table(&results);
    report::write_summary(&options.out, &results)?;
    report::write_histories(&options.out, &results)?;
    plots::draw_all(&options.out, &results)?;
    conclusions::print(&results, options.containment().weights());
    report::write_serviceability(&options.out, &results)?;
    figures::draw(&options.out, &results)?;
    if options.sweep {
        let peaks = sweep(&options, &record, steps)?;
        figures::draw_sweep(&options.out, &peaks, results[1].peak_shear)?;
    }
    if options.meshes {
        let fine = options.on_elements(15);
        let fine = Sweep::new(cases.len()).collect(|now| {
            case::run(&cases[now.index()], &fine, &record, fine.steps(&record), now)
        });
        let fine: Vec<Outcome> = fine.into_iter().collect::<Result<_, _>>()?;
        conclusions::compare_meshes(&options.out, &results, &fine)?;
    }
    println!("\nfiles in {}", options.out.display());
    Ok(())
}

/// Peak base shear (N/m) over friction; writes friction_sweep.csv.
fn sweep(options: &Options, record: &Record, steps: usize) -> Result<Vec<(f64, f64)>, AnyError> {
    let frictions: Vec<f64> = (1..=16).map(|k| 0.05 * f64::from(k)).collect();
    let cases = Case::list(&frictions).split_off(2);
    let runs = Sweep::new(cases.len())
        .collect(|now| case::run(&cases[now.index()], options, record, steps, now));
    let mut writer = csv::Writer::from_path(options.out.join("friction_sweep.csv"))?;
    writer.write_record(["friction", "peak_base_shear_n_per_m", "max_slip_m"])?;
    let mut peaks = Vec::new();
    for (friction, outcome) in frictions.into_iter().zip(runs) {
        let outcome = outcome?;
        let slip = outcome.run.whole.mean_slip.magnitude();
        writer.write_record([friction, outcome.peak_shear, slip].map(|v| v.to_string()))?;
        peaks.push((friction, outcome.peak_shear));
    }
    writer.flush()?;
    Ok(peaks)
}
