//! A structure of 50 000 unknowns from Matrix Market files, reduced so that it marches in real time.
//!
//! ```text
//! cargo run --release --example from_matrices
//! ```
//!
//! Another program would have written `mass.mtx` and `stiffness.mtx`; here a mesh of quadrilaterals
//! does, into `target/from_matrices`. The files are read back, contact nodes are named, and a
//! Craig–Bampton reduction keeps these and the lowest modes of the rest. The full model marches two of
//! its periods beside the reduced one, to compare (`tests/structures/matrices/reduction.rs` does so for more
//! quantities of smaller models).

#[path = "common/tower.rs"]
mod tower;

use std::path::Path;
use std::time::Instant;

use basemat::coupled::Coordinates;
use basemat::structure::{ContactNode, CraigBampton, Row, Structure, Triplets};
use basemat::{Result, Simulation};
use tower::{TIME_STEP, Tower, damped, scene};

const MODES: usize = 20;
/// Steps in two of the tower's longest periods, 2.1 s each.
const TWO_PERIODS: usize = 430;

/// Writes the tower's matrices and returns its contact nodes and the sway of its top.
fn write_files(mass: &Path, stiffness: &Path) -> Result<(Vec<ContactNode>, Row)> {
    let tower = Tower::new()?;
    tower.mass.write_matrix_market(mass)?;
    tower.stiffness.write_matrix_market(stiffness)?;
    Ok((tower.contact, tower.top))
}

/// Marches and returns the sway of the top at every step, and seconds per step.
fn march(simulation: &mut Simulation, steps: usize) -> Result<(Vec<f64>, f64)> {
    let start = Instant::now();
    let mut sway = Vec::new();
    simulation.run(steps, |state| sway.push(state.probes[0]))?;
    Ok((sway, start.elapsed().as_secs_f64() / steps as f64))
}

fn main() -> Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/from_matrices");
    if let Err(error) = std::fs::create_dir_all(&folder) {
        eprintln!("{} cannot be made: {error}", folder.display());
    }
    let [mass, stiffness] = ["mass.mtx", "stiffness.mtx"].map(|name| folder.join(name));
    let (contact, top) = write_files(&mass, &stiffness)?;

    let begin = Instant::now();
    let model = damped(
        Triplets::read_matrix_market(&mass)?,
        Triplets::read_matrix_market(&stiffness)?,
        contact,
    )?;
    let read = begin.elapsed().as_secs_f64();
    println!("{} unknowns read in {read:.2} s", model.unknowns());

    let begin = Instant::now();
    let reduced = CraigBampton::new(MODES).reduce(model.clone())?;
    println!(
        "reduced to {} unknowns in {:.2} s, modes on a fixed base {:.2} to {:.1} Hz",
        reduced.unknowns(),
        begin.elapsed().as_secs_f64(),
        reduced.frequencies()[0],
        reduced.frequencies()[MODES - 1]
    );
    let recovery = reduced.recovery();

    // The top is no unknown of the reduced model, but a weighted sum of them.
    let row = recovery.row(&top)?;
    let mut small = scene(reduced, row, Coordinates::Auto)?;
    let mut large = scene(model, top.clone(), Coordinates::Unknowns)?;
    let (sway_full, time_full) = march(&mut large, TWO_PERIODS)?;
    let (sway, time_reduced) = march(&mut small, 3000)?;

    println!("\n          unknowns   ms per step   times real time");
    for (name, simulation, time) in [("full", &large, time_full), ("reduced", &small, time_reduced)]
    {
        let unknowns = simulation.state().absolute_displacement().len();
        println!("{name:<8} {unknowns:9} {:13.3} {:17.1}", 1e3 * time, TIME_STEP / time);
    }

    let largest = |values: &[f64]| values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let apart: Vec<f64> = sway_full.iter().zip(&sway).map(|(a, b)| a - b).collect();
    println!(
        "\nsway of the top in the first {:.1} s: {:.1} mm, reduced and full apart by {:.1e} of it",
        TIME_STEP * apart.len() as f64,
        1e3 * largest(&sway_full),
        largest(&apart) / largest(&sway_full)
    );
    println!(
        "largest sway in {:.0} s: {:.1} mm",
        TIME_STEP * sway.len() as f64,
        1e3 * largest(&sway)
    );

    // Any unknown of the full model, whenever it is wanted.
    let everything = recovery.full(small.state().absolute_displacement())?;
    println!(
        "all {} unknowns at the end: the top at {:.3} mm",
        everything.len(),
        1e3 * top.value(&everything)
    );
    Ok(())
}
