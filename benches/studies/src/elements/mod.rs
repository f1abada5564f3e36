//! Benchmarks of the finite elements in space, and random flexible structures on the ground.
//!
//! Each value is compared with the value of another program of the same formulation and with an accepted target; the
//! process fails if a limit is exceeded. The content of `benches/studies/tables/elements.md` comes from
//!
//! ```text
//! cargo study elements --docs docs
//! ```

mod beam_modes;
mod beams;
mod brick_plates;
mod bricks;
mod columns;
mod containment;
mod plates;
mod raft;
mod report;
mod row;
mod scenes;
mod single;
mod strips;
mod surface;
mod vaults;

use std::path::PathBuf;

use cpu_time::ProcessTime;

use crate::AnyError;
use crate::document::{splice, write_csv};
use row::BenchmarkRows;

/// Benchmarks of finite elements in space: values, targets, gates.
#[derive(Debug, clap::Args)]
pub(crate) struct ElementsOptions {
    /// Coarse meshes only.
    #[arg(long)]
    short: bool,
    /// Only this group of benchmarks, or the random `scenes`.
    #[arg(long)]
    only: Option<String>,
    /// Folder for the files.
    #[arg(long, default_value = "target/study/elements")]
    out: PathBuf,
    /// Folder of the documentation; with it the tables go to benches/studies/tables.
    #[arg(long, conflicts_with = "short")]
    docs: Option<PathBuf>,
}

/// Name of a group and the function that runs it.
type BenchmarkGroup = (&'static str, fn(&mut BenchmarkRows, bool) -> Result<(), AnyError>);

const BENCHMARK_GROUPS: [BenchmarkGroup; 11] = [
    ("single", |rows, _| single::run(rows)),
    ("beams", |rows, _| beams::run(rows)),
    ("beam-modes", |rows, _| {
        beam_modes::run(rows);
        Ok(())
    }),
    ("columns", |rows, _| {
        columns::run(rows);
        Ok(())
    }),
    ("bricks", bricks::run),
    ("brick-plates", |rows, short| {
        brick_plates::run(rows, short);
        Ok(())
    }),
    ("strips", |rows, _| strips::run(rows)),
    ("vaults", vaults::run),
    ("plates", plates::run),
    ("containment", containment::run),
    ("raft", raft::run),
];

fn number_text(value: Option<f64>) -> String {
    value.map_or(String::new(), |value| format!("{value:.7e}"))
}

pub(crate) fn run(options: &ElementsOptions) -> Result<(), AnyError> {
    std::fs::create_dir_all(&options.out)?;
    let mut rows = BenchmarkRows::tabled();
    println!(
        "benchmark | quantity | mesh | found | tabled | difference | found / target | verdict"
    );
    for (name, run) in BENCHMARK_GROUPS {
        if options.only.as_deref().is_none_or(|only| only == name) {
            let start_time = ProcessTime::try_now()?;
            run(&mut rows, options.short)?;
            println!("{name}: {:.0} s", start_time.try_elapsed()?.as_secs_f64());
        }
    }
    let columns =
        ["table", "benchmark", "quantity", "mesh", "found", "tabled", "target", "verdict"];
    let records = rows.all.iter().map(|row| {
        let target = row.target.map(|(target, _)| target);
        [
            row.table.to_owned(),
            row.benchmark.clone(),
            row.quantity.clone(),
            row.mesh.clone(),
            number_text(row.computed),
            number_text(Some(row.tabled)),
            number_text(target),
            row.verdict().to_owned(),
        ]
    });
    write_csv(options.out.join("rows.csv"), columns, records)?;
    let computed = rows.all.iter().filter(|row| row.computed.is_some()).count();
    let mut failed_rows = rows.failed();
    if !options.short && options.only.is_none() {
        failed_rows.extend(rows.missing());
    }
    println!("{computed} of {} rows, {} fail", rows.all.len(), failed_rows.len());
    if options.docs.is_some() && options.only.is_none() {
        splice("elements.md", "elements benchmarks", &report::benchmarks(&rows)?)?;
        splice("elements.md", "elements summary", &report::summary(&rows)?)?;
    }
    if options.only.as_deref().is_none_or(|only| only == "scenes") {
        let scenes = scenes::run(options.short)?;
        if options.docs.is_some() {
            splice("elements.md", "elements scenes", &scenes)?;
        }
    }
    if failed_rows.is_empty() {
        return Ok(());
    }
    Err(format!("gates missed:\n{}", failed_rows.join("\n")).into())
}
