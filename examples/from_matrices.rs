//! A structure of 50 000 degrees of freedom from Matrix Market files, reduced for fast runs.
//!
//! ```text
//! cargo run --release --example from_matrices
//! ```
//!
//! Usually another program writes `mass.mtx` and `stiffness.mtx`; here a mesh of quadrilaterals writes them
//! into `target`. The files are read back, and the nodes of the base are given. A Craig–Bampton reduction keeps these
//! nodes and the lowest modes of the rest. Two periods of the full model are computed as well, for
//! comparison.

use std::path::Path;
use std::time::Instant;

use basemat::Result;
use basemat::coupled::Coordinates;
use basemat::fem::{Direction, Layer, MassKind, Material, Mesh};
use basemat::prelude::*;
use basemat::structure::{CraigBampton, DofCombination, MatrixModel};

const TIME_STEP: f64 = 0.01;
const MODES: usize = 20;
/// Number of steps in two of the tower's longest periods, 2.1 s each.
const TWO_PERIODS: usize = 430;

/// Writes the matrices of a tower; returns its base and the displacement of its top.
///
/// The tower is 10 m wide and 100 m high, of quadrilaterals of 0.2 m.
fn write_files(mass_file: &Path, stiffness_file: &Path) -> Result<(Base, DofCombination)> {
    let layer = Layer::new(100.0, 500, Material::new(5.0e9, 0.2, 600.0)?);
    let mesh = Mesh::layered_block(-5.0..5.0, 50, &[layer])?;
    let model = FemModel::on_base(mesh)?.with_mass(MassKind::Lumped);
    let [mut mass, mut stiffness] = [(); 2].map(|()| Triplets::new(model.dofs()));
    model.mass(&mut mass)?;
    model.stiffness(&mut stiffness)?;
    mass.write_matrix_market(mass_file)?;
    stiffness.write_matrix_market(stiffness_file)?;
    let top = model.row(model.mesh().node_at(0.0, 100.0)?, Direction::X)?;
    Ok((model.base(), top))
}

/// The simulation of the structure on soil, with the displacement of its top as a probe.
fn scene(
    structure: impl Structure + 'static,
    top: DofCombination,
    coordinates: Coordinates,
) -> Result<Simulation> {
    let soil = Soil::new(200.0e6, 0.33, 1900.0)?;
    Simulation::builder(TIME_STEP)
        .structure(structure)
        .ground(ElasticGround::new(soil, Strip::uniform(-5.0..5.0, 20)?)?)
        .interface(Coulomb::new(0.5)?)
        .motion(el_centro_1940())
        .probe(Probe::absolute_displacement("top", top))
        .coordinates(coordinates)
        .expected_steps(3000)
        .build()
}

/// Runs the simulation; returns the displacement of the top at every step, and the seconds per step.
fn march(simulation: &mut Simulation, steps: usize) -> Result<(Vec<f64>, f64)> {
    let start = Instant::now();
    let mut sway = Vec::new();
    simulation.run(steps, |state| sway.push(state.probes[0]))?;
    Ok((sway, start.elapsed().as_secs_f64() / steps as f64))
}

fn main() -> Result<()> {
    let [mass, stiffness] = ["target/mass.mtx", "target/stiffness.mtx"].map(Path::new);
    let (base, top) = write_files(mass, stiffness)?;

    let begin = Instant::now();
    let [mass, stiffness] = [mass, stiffness].map(Triplets::read_matrix_market);
    // 3 % of critical damping at 0.5 and 5 Hz.
    let damping = RayleighDamping::from_ratios([0.5, 5.0], [0.03; 2])?;
    let model = MatrixModel::new(mass?, stiffness?, base)?.with_rayleigh(damping);
    let read = begin.elapsed().as_secs_f64();
    println!("{} degrees of freedom read in {read:.2} s", model.dofs());

    let begin = Instant::now();
    let reduced = CraigBampton::new(MODES).reduce(model.clone())?;
    println!(
        "reduced to {} degrees of freedom in {:.2} s, modes on a fixed base {:.2} to {:.1} Hz",
        reduced.dofs(),
        begin.elapsed().as_secs_f64(),
        reduced.frequencies()[0],
        reduced.frequencies()[MODES - 1]
    );
    let recovery = reduced.recovery();

    // In the reduced model the top is not a degree of freedom but a weighted sum of them.
    let row = recovery.row(&top)?;
    let mut small = scene(reduced, row, Coordinates::Auto)?;
    let mut large = scene(model, top.clone(), Coordinates::Physical)?;
    let (sway_full, time_full) = march(&mut large, TWO_PERIODS)?;
    let (sway, time_reduced) = march(&mut small, 3000)?;

    println!("\n          degrees of freedom   ms per step   times real time");
    for (name, simulation, time) in [("full", &large, time_full), ("reduced", &small, time_reduced)]
    {
        let dofs = simulation.state().absolute_displacement().len();
        println!("{name:<8} {dofs:9} {:13.3} {:17.1}", 1e3 * time, TIME_STEP / time);
    }

    let largest = |values: &[f64]| values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let apart: Vec<f64> = sway_full.iter().zip(&sway).map(|(a, b)| a - b).collect();
    println!(
        "\nsway of the top in the first {:.1} s: {:.1} mm, reduced and full apart by {:.1e} of it",
        TIME_STEP * apart.len() as f64,
        1e3 * largest(&sway_full),
        largest(&apart) / largest(&sway_full)
    );
    // The recovery returns any degree of freedom of the full model.
    let everything = recovery.full(small.state().absolute_displacement())?;
    println!(
        "all {} degrees of freedom at the end: the top at {:.3} mm",
        everything.len(),
        1e3 * top.value(&everything)
    );
    Ok(())
}
