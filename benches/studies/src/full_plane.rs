//! Number of free-surface elements that the full-plane ground needs.
//!
//! Impedances of the bonded rigid strip are compared with their table, a coupled run with the half-plane.
//! The difference from the same mesh with many free elements separates the error of the truncated surface from the error of
//! the mesh. Each row states whether its march is bounded.
//!
//! ```text
//! cargo study full-plane
//! ```
//!
//! Writes impedances.csv and impedances.svg.

use std::path::PathBuf;

use plotters::prelude::SeriesLabelPosition;

use crate::AnyError;
use crate::figure::{CURVE_BLUE, CURVE_GREEN, CURVE_RED, CURVE_VIOLET, Figure, FigurePanel};
use basemat::Soil;
use basemat::bem::full_plane::CqMethod;
use basemat_problems::series::print_errors;
use basemat_problems::truncation::{
    FullPlaneMesh, block_errors, bonded_impedances, distances, tabled,
};

/// Errors of the full-plane ground over the number of free-surface elements.
#[derive(Debug, clap::Args)]
pub(crate) struct FullPlaneOptions {
    /// Folder for the files.
    #[arg(long, default_value = "target/study/full_plane")]
    out: PathBuf,
    /// Small meshes, as a test in seconds.
    #[arg(long)]
    short: bool,
}

const IMPEDANCE_NAMES: [&str; 4] = ["khh", "kvv", "krr", "khr"];

const POISSON_RATIO: f64 = 1.0 / 3.0;

/// Smallest growth per step that is searched for.
const SMALLEST_GROWTH: f64 = 1e-4;

/// β = c₁Δt/l of the strip.
const STRIP_BETA: f64 = 1.15;

/// Errors of one mesh.
struct TruncationRow {
    mesh: FullPlaneMesh,
    /// Growth per step with the base uplifted and bonded.
    growth: [f64; 2],
    /// Difference from the table.
    total: [f64; 4],
    /// Difference from the same mesh with four times the largest number of free elements, if its
    /// march is bounded.
    truncation: Option<[f64; 4]>,
}

impl TruncationRow {
    /// Length of the free surface on either side, relative to the half width of the strip.
    fn length(&self) -> f64 {
        2.0 * self.mesh.free as f64 / self.mesh.elements as f64
    }
}

fn rows(
    quadrature: Option<CqMethod>,
    elements: usize,
    frees: &[usize],
) -> Result<Vec<TruncationRow>, AnyError> {
    let (frequencies, references) = tabled("0333");
    let mesh = FullPlaneMesh { elements, free: 0, beta: STRIP_BETA, quadrature };
    let longest_surface = FullPlaneMesh { free: frees.last().map_or(0, |free| 4 * free), ..mesh };
    // A march with the time kernel is unstable on so long a surface.
    let without_truncation =
        quadrature.map(|_| bonded_impedances(POISSON_RATIO, longest_surface, &frequencies));
    let soil = Soil::new(1.0, POISSON_RATIO, 1.0)?;
    frees
        .iter()
        .map(|&free| {
            let mesh = FullPlaneMesh { free, ..mesh };
            let computed = bonded_impedances(POISSON_RATIO, mesh, &frequencies);
            let states = mesh.ground(soil).assess(mesh.time_step(soil), SMALLEST_GROWTH)?;
            Ok(TruncationRow {
                mesh,
                growth: states.map(|state| state.growth_per_step),
                total: distances(&computed, &references),
                truncation: without_truncation
                    .as_ref()
                    .map(|references| distances(&computed, references)),
            })
        })
        .collect()
}

fn joined(errors: &[f64; 4]) -> String {
    errors.map(|error| format!("{error:.1e}")).join("  ")
}

fn print(rows: &[TruncationRow]) {
    println!(
        "{:>5} {:>5} {:>7} {:>9}  {:<36} truncation alone: the same",
        "elem.", "free", "length", "growth", "from the table: khh kvv krr khr"
    );
    for row in rows {
        let growth = row.growth[0].max(row.growth[1]);
        let growth = if growth > 0.0 { format!("{growth:.1e}") } else { "none".to_owned() };
        println!(
            "{:>5} {:>5} {:>7.2} {:>9}  {:<36} {}",
            row.mesh.elements,
            row.mesh.free,
            row.length(),
            growth,
            joined(&row.total),
            row.truncation.as_ref().map_or(String::new(), joined)
        );
    }
}

fn write(path: &std::path::Path, rows: &[TruncationRow]) -> Result<(), AnyError> {
    let mut file = csv::Writer::from_path(path)?;
    let header = ["kernel", "elements", "free", "length", "growth_uplifted", "growth_bonded"];
    let kinds = ["total", "truncation"].into_iter();
    let columns = kinds.flat_map(|kind| IMPEDANCE_NAMES.map(|name| format!("{kind}_{name}")));
    file.write_record(header.map(str::to_owned).into_iter().chain(columns))?;
    for row in rows {
        let kernel = row.mesh.quadrature.map_or("time".to_owned(), |q| format!("{q:?}"));
        let mesh = [kernel, row.mesh.elements.to_string(), row.mesh.free.to_string()];
        let figures = [row.length(), row.growth[0], row.growth[1]];
        let truncation = row.truncation.unwrap_or([f64::NAN; 4]);
        let numbers = figures.iter().chain(&row.total).chain(&truncation);
        file.write_record(mesh.into_iter().chain(numbers.map(|x| format!("{x:.4e}"))))?;
    }
    file.flush()?;
    Ok(())
}

pub(crate) fn run(options: &FullPlaneOptions) -> Result<(), AnyError> {
    std::fs::create_dir_all(&options.out)?;
    let meshes = if options.short { [4, 8] } else { [8, 16] };
    let frees: &[usize] = if options.short { &[0, 2, 5] } else { &[0, 1, 2, 5, 10, 20, 40] };
    println!("bonded strip over 0.1 <= a0 <= 4, beta = {STRIP_BETA}; lengths over the half width");
    let mut all_rows = vec![];
    for (name, quadrature) in [("BDF2", Some(CqMethod::Bdf2)), ("time kernel", None)] {
        println!("{name}");
        for elements in meshes {
            let rows = rows(quadrature, elements, frees)?;
            print(&rows);
            all_rows.extend(rows);
        }
    }
    write(&options.out.join("impedances.csv"), &all_rows)?;
    draw(&options.out.join("impedances.svg"), &all_rows)?;
    println!("rigid block under a Ricker pulse against the half-plane, time kernel at beta = 1");
    for (elements, frees) in [(8, &[0, 5, 10, 20][..]), (16, &[0, 5, 10, 20])] {
        for &free in frees.iter().take(if options.short { 2 } else { 4 }) {
            let mesh = FullPlaneMesh { elements, free, beta: 1.0, quadrature: None };
            let scene = format!("{elements} elements, {free} free on either side");
            print_errors(&scene, &["u_base", "theta", "V"], &block_errors(mesh));
        }
    }
    Ok(())
}

fn quadrature_rows(rows: &[TruncationRow]) -> impl Iterator<Item = &TruncationRow> {
    rows.iter().filter(|row| row.mesh.quadrature.is_some())
}

/// Errors over the free elements for a mesh of convolution quadrature; zero is drawn at half an element.
fn error_points(
    rows: &[TruncationRow],
    elements: usize,
    error: impl Fn(&TruncationRow) -> Option<f64>,
) -> Vec<(f64, f64)> {
    let mesh_rows = quadrature_rows(rows).filter(|row| row.mesh.elements == elements);
    mesh_rows
        .filter_map(|row| Some(((row.mesh.free as f64).max(0.5), error(row)?)))
        .collect()
}

/// Draws errors of the impedances over the free elements, a panel per mesh of convolution quadrature.
///
/// Lines are errors from the table, circles errors of the truncation alone.
fn draw(path: &std::path::Path, rows: &[TruncationRow]) -> Result<(), AnyError> {
    let mut meshes: Vec<usize> = quadrature_rows(rows).map(|row| row.mesh.elements).collect();
    meshes.dedup();
    let mut panels = Vec::new();
    for elements in meshes {
        let x = format!("free elements on either side of {elements} (0 at 0.5)");
        let mut panel =
            FigurePanel::new(&x, "relative error, root mean square").double_logarithmic();
        panel = panel.legend(SeriesLabelPosition::LowerLeft).room(0.4, 0.05);
        for (k, (name, color)) in IMPEDANCE_NAMES
            .iter()
            .zip([CURVE_BLUE, CURVE_GREEN, CURVE_VIOLET, CURVE_RED])
            .enumerate()
        {
            let total = error_points(rows, elements, |row| Some(row.total[k]));
            let truncation =
                error_points(rows, elements, |row| row.truncation.map(|errors| errors[k]));
            panel = panel.line(&format!("{name}, from the table"), color, total);
            panel = panel.circles(&format!("{name}, truncation alone"), color, truncation);
        }
        panels.push(panel);
    }
    let title = "Full plane, BDF2: errors of the bonded strip over the free-surface elements";
    Figure::new(title, 2, panels).draw(path)
}
