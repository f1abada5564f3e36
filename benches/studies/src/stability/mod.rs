//! Maps of stability over pairs of parameters from one extreme to the other.
//!
//! They show where marches stay bounded, close their energy balance and find their contact modes. Compared are the
//! crate's scheme, the paper's, and the one by convolution quadrature; and the time schemes on the crate's soil.
//!
//! The content of `benches/studies/tables/stability.md` comes from
//!
//! ```text
//! cargo study stability --docs docs
//! ```

mod axes;
mod motions;
mod plots;
mod report;
mod run;
mod scene;

use std::path::PathBuf;

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use indicatif::{ProgressBar, ProgressStyle};

use crate::AnyError;
use crate::document::splice;
use axes::StabilityMap;
use run::MapCell;
use scene::Assessments;

/// Where runs stay bounded, close their energy balance and have a contact solution, and where they
/// end with an error.
///
/// Prints tables, and writes cells.csv, tables.md and one SVG of heat maps per sweep. Ends with an
/// error if a cell of the crate's scheme violates its guarantees.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct StabilityOptions {
    /// Folder for the files.
    #[arg(long, default_value = "target/study/stability")]
    pub(crate) out: PathBuf,
    /// Folder of the documentation; with it the tables go to benches/studies/tables, and the
    /// heat maps to its images/.
    #[arg(long)]
    pub(crate) docs: Option<PathBuf>,
    /// Few cells and few steps, as a test in seconds.
    #[arg(long)]
    pub(crate) short: bool,
    /// Cells computed at the same time.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=64))]
    pub(crate) threads: u8,
    /// Only the sweep of this name; may be repeated.
    #[arg(long = "map")]
    pub(crate) maps: Vec<String>,
    /// Only cells with this label on the horizontal axis.
    #[arg(long)]
    pub(crate) x: Option<String>,
    /// Only cells with this label on the vertical axis.
    #[arg(long, allow_hyphen_values = true)]
    pub(crate) y: Option<String>,
    /// Only this scheme: basemat, dissipative, newmark, hht, paper or quadrature.
    #[arg(long)]
    pub(crate) scheme: Option<String>,
    /// Lists the sweeps and their axes, without runs.
    #[arg(long)]
    pub(crate) list: bool,
}

pub(crate) fn run(options: &StabilityOptions) -> Result<(), AnyError> {
    let mut maps = axes::maps(options.short);
    if options.list {
        for map in &maps {
            println!("{}\n  --x, {}: {}", map.name, map.x.name, map.x.labels.join(", "));
            println!("  --y, {}: {}", map.y.name, map.y.labels.join(", "));
        }
        return Ok(());
    }
    if let Some(unknown) =
        options.maps.iter().find(|name| maps.iter().all(|map| map.name != **name))
    {
        return Err(format!("no sweep is called {unknown}; --list names them").into());
    }
    maps.retain(|map| options.maps.is_empty() || options.maps.iter().any(|name| name == map.name));
    let cells = compute(&maps, options)?;

    std::fs::create_dir_all(&options.out)?;
    report::write_cells(&options.out.join("cells.csv"), &maps, &cells)?;
    let tables = report::tables(&maps, &cells);
    println!("{tables}");
    std::fs::write(options.out.join("tables.md"), &tables)?;
    let mut folders = vec![options.out.clone()];
    if let Some(docs) = &options.docs {
        let compares_schemes = |map: &StabilityMap| map.name == axes::SCHEME_MAP;
        if maps.iter().any(compares_schemes) {
            splice("stability.md", "time_schemes", &report::schemes(&maps, &cells))?;
        }
        if !maps.iter().all(compares_schemes) {
            splice("stability.md", "stability_map", &report::document(&maps, &cells))?;
        }
        folders.push(docs.join("images"));
    }
    for folder in folders {
        for (index, map) in maps.iter().enumerate().filter(|(_, map)| map.drawn) {
            let map_cells: Vec<&MapCell> = cells.iter().filter(|cell| cell.map == index).collect();
            plots::draw(&folder.join(format!("stability_{}.svg", map.name)), map, &map_cells)?;
        }
    }
    println!("files in {}", options.out.display());
    let broken = report::broken(&maps, &cells);
    if broken.is_empty() { Ok(()) } else { Err(broken.into()) }
}

fn is_selected(label: &str, selection: Option<&str>) -> bool {
    selection.is_none_or(|selection| selection == label)
}

fn selected(labels: &[String], selection: Option<&str>) -> Vec<usize> {
    (0..labels.len()).filter(|&k| is_selected(&labels[k], selection)).collect()
}

/// Runs all cells on the requested number of threads.
fn compute(maps: &[StabilityMap], options: &StabilityOptions) -> Result<Vec<MapCell>, AnyError> {
    let mut todo = Vec::new();
    for (index, map) in maps.iter().enumerate() {
        let schemes = map.schemes.iter().copied();
        for scheme in schemes.filter(|scheme| is_selected(scheme.name(), options.scheme.as_deref()))
        {
            for x in selected(&map.x.labels, options.x.as_deref()) {
                for y in selected(&map.y.labels, options.y.as_deref()) {
                    if map.scene(scheme, x, y).exists() {
                        todo.push((index, scheme, [x, y]));
                    }
                }
            }
        }
    }
    if todo.is_empty() {
        return Err("no such cell; --list names the sweeps and the labels of their axes".into());
    }
    let bar = ProgressBar::new(todo.len() as u64);
    let style = "{prefix:>22} {bar:30} {pos}/{len} cells, {elapsed} {msg}";
    bar.set_style(ProgressStyle::with_template(style)?);
    let next = AtomicUsize::new(0);
    let done = Mutex::new(Vec::with_capacity(todo.len()));
    let assessments = Assessments::default();
    std::thread::scope(|scope| {
        for _ in 0..options.threads {
            scope.spawn(|| {
                while let Some(&(map, scheme, place)) =
                    todo.get(next.fetch_add(1, Ordering::Relaxed))
                {
                    bar.set_prefix(format!("{}, {}", maps[map].name, scheme.name()));
                    let scene = maps[map].scene(scheme, place[0], place[1]);
                    let report_progress =
                        |fraction: f64| bar.set_message(format!("({:.0} %)", 100.0 * fraction));
                    let outcome = run::march(&scene, &assessments, &report_progress);
                    bar.set_message("");
                    bar.inc(1);
                    let mut done = done.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                    done.push(MapCell { map, scheme, place, outcome });
                }
            });
        }
    });
    bar.finish_and_clear();
    let mut cells = done.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    cells.sort_by_key(|cell| (cell.map, cell.scheme, cell.place));
    Ok(cells)
}
