//! A structure from Matrix Market files, reduced for fast runs.
//!
//! ```text
//! cargo run --release --example from_matrices
//! ```
//!
//! Usually another program writes `mass.mtx` and `stiffness.mtx`; this example assembles them from a mesh of
//! quadrilaterals and writes them into `target`. The structure has 50 000 degrees of freedom. The files are read back,
//! and the nodes of the base are added. A Craig–Bampton reduction keeps these nodes and the lowest modes of the
//! structure on a fixed base. Two periods of the full model are computed as well, for comparison.

use std::path::Path;
use std::time::Instant;

use basemat::Result;
use basemat::coupled::Coordinates;
use basemat::fem::{Direction, Layer, MassKind, Material, Mesh};
use basemat::prelude::*;
use basemat::structure::{CraigBampton, DofCombination, MatrixModel};

/// Time step, s.
const TIME_STEP: f64 = 0.01;
/// Number of modes on a fixed base that the reduced model keeps.
const FIXED_BASE_MODES: usize = 20;
/// Number of steps of the reduced model.
const STEP_COUNT: usize = 3000;
/// Number of steps of the full model: two of the tower's longest periods, 2.1 s each.
const TWO_PERIOD_STEPS: usize = 430;

/// Writes the matrices of a tower; returns its base and the displacement of its top.
///
/// The tower is 10 m wide and 100 m high, of quadrilaterals of 0.2 m.
fn write_files(mass_file: &Path, stiffness_file: &Path) -> Result<(Base, DofCombination)> {
    let layer = Layer::new(100.0, 500, Material::new(5.0e9, 0.2, 600.0)?);
    let mesh = Mesh::layered_block(-5.0..5.0, 50, &[layer])?;
    let model = FemModel::on_base(mesh)?.with_mass(MassKind::Lumped);
    let mut mass = Triplets::new(model.dofs());
    let mut stiffness = Triplets::new(model.dofs());
    model.mass(&mut mass)?;
    model.stiffness(&mut stiffness)?;
    mass.write_matrix_market(mass_file)?;
    stiffness.write_matrix_market(stiffness_file)?;
    let top = model.row(model.mesh().node_at(0.0, 100.0)?, Direction::X)?;
    Ok((model.base(), top))
}

/// The simulation of the structure on soil, with the displacement of its top as a probe.
fn simulation(
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
        .expected_steps(STEP_COUNT)
        .build()
}

/// Motion of the tower's top, and the computing time.
struct TopMotion {
    /// Displacement at the end of every step, m.
    displacement: Vec<f64>,
    /// Mean computing time of a step, s.
    step_seconds: f64,
}

fn run(simulation: &mut Simulation, steps: usize) -> Result<TopMotion> {
    let start = Instant::now();
    let mut displacement = Vec::new();
    simulation.run(steps, |state| displacement.push(state.probes[0]))?;
    Ok(TopMotion { displacement, step_seconds: start.elapsed().as_secs_f64() / steps as f64 })
}

fn largest_magnitude(values: &[f64]) -> f64 {
    values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()))
}

fn main() -> Result<()> {
    let mass_file = Path::new("target/mass.mtx");
    let stiffness_file = Path::new("target/stiffness.mtx");
    let (base, top) = write_files(mass_file, stiffness_file)?;

    let start_time = Instant::now();
    let mass = Triplets::read_matrix_market(mass_file)?;
    let stiffness = Triplets::read_matrix_market(stiffness_file)?;
    // 3 % of critical damping at 0.5 and 5 Hz.
    let damping = RayleighDamping::from_ratios([0.5, 5.0], [0.03; 2])?;
    let model = MatrixModel::new(mass, stiffness, base)?.with_rayleigh(damping);
    let read_seconds = start_time.elapsed().as_secs_f64();
    println!("{} degrees of freedom read in {read_seconds:.2} s", model.dofs());

    let start_time = Instant::now();
    let reduced_model = CraigBampton::new(FIXED_BASE_MODES).reduce(model.clone())?;
    println!(
        "reduced to {} degrees of freedom in {:.2} s, modes on a fixed base {:.2} to {:.1} Hz",
        reduced_model.dofs(),
        start_time.elapsed().as_secs_f64(),
        reduced_model.frequencies()[0],
        reduced_model.frequencies()[FIXED_BASE_MODES - 1]
    );
    let recovery = reduced_model.recovery();

    // In the reduced model the top is not a degree of freedom but a weighted sum of them.
    let reduced_top = recovery.row(&top)?;
    let mut small_simulation = simulation(reduced_model, reduced_top, Coordinates::Auto)?;
    let mut large_simulation = simulation(model, top.clone(), Coordinates::Physical)?;
    let full_motion = run(&mut large_simulation, TWO_PERIOD_STEPS)?;
    let reduced_motion = run(&mut small_simulation, STEP_COUNT)?;

    println!("\n          degrees of freedom   ms per step   times real time");
    for (name, simulation, motion) in
        [("full", &large_simulation, &full_motion), ("reduced", &small_simulation, &reduced_motion)]
    {
        let dofs = simulation.state().absolute_displacement().len();
        let seconds = motion.step_seconds;
        println!("{name:<8} {dofs:9} {:13.3} {:17.1}", 1e3 * seconds, TIME_STEP / seconds);
    }

    let pairs = full_motion.displacement.iter().zip(&reduced_motion.displacement);
    let difference: Vec<f64> = pairs.map(|(full, reduced)| full - reduced).collect();
    let largest_displacement = largest_magnitude(&full_motion.displacement);
    println!(
        "\nsway of the top in the first {:.1} s: {:.1} mm, reduced and full apart by {:.1e} of it",
        TIME_STEP * difference.len() as f64,
        1e3 * largest_displacement,
        largest_magnitude(&difference) / largest_displacement
    );
    // The recovery returns any degree of freedom of the full model.
    let displacement = recovery.full(small_simulation.state().absolute_displacement())?;
    println!(
        "all {} degrees of freedom at the end: the top at {:.3} mm",
        displacement.len(),
        1e3 * top.value(&displacement)
    );
    Ok(())
}
