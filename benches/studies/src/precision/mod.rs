//! Error of the base shear against processor time.
//!
//! Scenes are a rigid block with a reference table, five seconds of the containment of the example of that name, and
//! towers of 300 to 30 000 degrees of freedom. The study varies elements, grading, time step, history and time scheme,
//! and coordinates of the towers. The content of `benches/studies/tables/precision.md` comes from
//!
//! ```text
//! cargo study precision --docs docs
//! ```

mod catalogue;
pub(crate) mod force;
mod front;
mod front_picture;
mod plots;
mod report;
mod scene;
mod settings;
mod space;
mod space_models;
mod sweep;

use std::path::PathBuf;

use indicatif::{ProgressBar, ProgressStyle};

use crate::AnyError;
use crate::document::splice;
use sweep::SettingsSweep;

/// Error of the base shear against processor time, over meshes, time steps, histories and schemes.
///
/// Prints tables, and writes points.csv, tables.md and SVG plots.
#[derive(Debug, Clone, clap::Args)]
#[allow(clippy::struct_excessive_bools, reason = "flags of a command")]
pub(crate) struct PrecisionOptions {
    /// Folder for the files.
    #[arg(long, default_value = "target/study/precision")]
    pub(crate) out: PathBuf,
    /// Folder of the documentation; with it the main tables go to benches/studies/tables, and the
    /// plots to its images/.
    #[arg(long)]
    pub(crate) docs: Option<PathBuf>,
    /// Small sweeps, as a test in seconds.
    #[arg(long)]
    pub(crate) short: bool,
    /// Only the lines of error against time of structures of 300 to 30 000 degrees of freedom.
    #[arg(long)]
    pub(crate) front: bool,
    /// Only structures of shells in space.
    #[arg(long)]
    pub(crate) space: bool,
    /// With `--space`: only its references, in a quarter of an hour.
    #[arg(long, requires = "space")]
    pub(crate) reference: bool,
    /// Runs of each setting, of which the fastest is used; a single one where a run takes over a second.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u8).range(1..=100))]
    pub(crate) repeats: u8,
}

pub(crate) fn run(options: &PrecisionOptions) -> Result<(), AnyError> {
    std::fs::create_dir_all(&options.out)?;
    if options.space {
        return space::run(options.short, options.docs.is_some(), options.reference);
    }
    if options.front {
        let bar = ProgressBar::new(0);
        let lines = front::run(options.short, options.repeats, &bar)?;
        println!("{}", front_picture::table(&lines)?);
        front_picture::draw(&options.out.join("work_precision.svg"), &lines)?;
        return front::write(&options.out.join("front.csv"), &lines);
    }
    let sweeps = SettingsSweep::list(options.short)?;
    let runs = sweeps.iter().map(|sweep| sweep.settings.len() as u64).sum();
    let bar = ProgressBar::new(runs);
    bar.set_style(ProgressStyle::with_template("{prefix:>26} {bar:40} {pos}/{len} runs")?);

    // One run at a time: two runs would compete for caches and memory.
    let mut outcomes = Vec::with_capacity(sweeps.len());
    for sweep in sweeps {
        bar.set_prefix(sweep.scene.name);
        outcomes.push(sweep.run(options.repeats, &bar)?);
    }
    bar.set_prefix("300 to 30 000 degrees of freedom");
    let lines = front::run(options.short, options.repeats, &bar)?;
    bar.finish_and_clear();

    let tables = report::tables(&outcomes)?;
    println!("{tables}");
    report::write_points(&options.out.join("points.csv"), &outcomes)?;
    front::write(&options.out.join("front.csv"), &lines)?;
    let settings = front_picture::table(&lines)?;
    println!("{settings}");
    std::fs::write(options.out.join("tables.md"), &tables)?;
    let mut folders = vec![options.out.clone()];
    if let Some(docs) = &options.docs {
        splice("precision.md", "work_precision", &report::summary(&settings, &outcomes)?)?;
        folders.push(docs.join("images"));
    }
    for folder in folders {
        front_picture::draw(&folder.join("work_precision.svg"), &lines)?;
        for outcome in &outcomes {
            plots::draw(&folder.join(format!("{}.svg", file_stem(outcome.scene))), outcome)?;
        }
    }
    println!("files in {}", options.out.display());
    Ok(())
}

/// File name of a sweep: letters and digits only.
fn file_stem(scene: &str) -> String {
    let name = scene.replace("ν = 1/", "nu_").replace("0.", "0_");
    let words: Vec<&str> = name
        .split(|c: char| !c.is_ascii_alphanumeric() && c != '_')
        .filter(|word| !word.is_empty())
        .collect();
    format!("work_precision_{}", words.join("_"))
}
