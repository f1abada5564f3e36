//! Random blocks of quadrilaterals that yield, lift off and slide, and the energies of their runs.

use basemat::bem::{ElasticGround, SpringGround};
use basemat::fem::{DruckerPrager, Iwan, Material, Mesh, Quad4, QuadFormulation, SharedMaterial};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::Record;
use basemat::structure::FemModel;
use basemat::{Result, Simulation, Soil};

use crate::random::Random;

/// Steps of a run.
pub const RUN_STEPS: usize = 60;
/// Dissipation, relative to the largest energy, from which a block counts as one that yields.
const YIELDING_THRESHOLD: f64 = 1e-6;

/// A random scene, and whether its plastic strain is normal to the yield surface.
#[allow(missing_debug_implementations, reason = "not published")]
pub struct YieldingScene {
    pub simulation: Result<Simulation>,
    pub is_associated: bool,
    /// Numbers of the scene, for messages.
    pub text: String,
}

/// A material, whether its plastic strain is normal to the yield surface, and its numbers as text.
struct RandomMaterial {
    material: SharedMaterial,
    is_associated: bool,
    text: String,
}

/// Material whose strength is comparable to a pressure, Pa.
fn random_material(random: &mut Random, pressure: f64) -> RandomMaterial {
    let poisson = random.within(0.1, 0.49);
    let density = random.within(1500.0, 2500.0);
    let shear_modulus = pressure * random.log_within(3e2, 1e4);
    if random.chance(0.5) {
        let strength = pressure * random.log_within(0.7, 4.0);
        let limit_strain = random.within(50.0, 300.0) * strength / shear_modulus;
        let clay =
            Iwan::hyperbolic(shear_modulus, strength, limit_strain, poisson, density).unwrap();
        let text = format!("Iwan G {shear_modulus:.2e} τ_s {strength:.2e}");
        return RandomMaterial { material: clay.into(), is_associated: true, text };
    }
    let young_modulus = 2.0 * shear_modulus * (1.0 + poisson);
    let elastic = Material::new(young_modulus, poisson, density).unwrap();
    let cohesion = pressure * random.log_within(0.2, 2.0);
    let friction_angle = random.within(0.0, 0.7);
    let dilation_angle = random.pick(&[1.0, 1.0, 0.0, 0.4]) * friction_angle;
    let sand = DruckerPrager::new(elastic, cohesion, friction_angle, dilation_angle).unwrap();
    let text =
        format!("Drucker–Prager c {cohesion:.2e} φ {friction_angle:.2} ψ {dilation_angle:.2}");
    let is_associated = friction_angle == dilation_angle;
    RandomMaterial { material: sand.into(), is_associated, text }
}

/// Grid lines of `count` equal intervals over a length from a start.
pub fn grid_lines(start: f64, length: f64, count: usize) -> Vec<f64> {
    (0..=count).map(|k| start + length * k as f64 / count as f64).collect()
}

/// Block of eight-node or four-node quadrilaterals.
fn random_block(random: &mut Random) -> (Result<FemModel>, bool, String) {
    let width = random.within(1.0, 8.0);
    let height = random.within(1.0, 8.0);
    let columns = random.pick(&[1, 2, 3]);
    let rows = random.pick(&[1, 2, 3]);
    let RandomMaterial { material, is_associated, text } = random_material(random, 2.0e4 * height);
    let x_lines = grid_lines(-0.5 * width, width, columns);
    let y_lines = grid_lines(0.0, height, rows);
    let has_eight_nodes = random.chance(0.6);
    let mesh = if has_eight_nodes {
        Mesh::quad8_block(&x_lines, &y_lines, |_, _| material.clone())
    } else {
        four_node_block(&x_lines, &y_lines, &material)
    };
    let node_count = if has_eight_nodes { 8 } else { 4 };
    let text =
        format!("{text}, {columns}×{rows} of {node_count} nodes, {width:.1} × {height:.1} m");
    (mesh.and_then(FemModel::on_base), is_associated, text)
}

/// Block of four-node quadrilaterals.
fn four_node_block(x_lines: &[f64], y_lines: &[f64], material: &SharedMaterial) -> Result<Mesh> {
    let mut mesh = Mesh::new();
    let grid = mesh.add_grid(y_lines.len(), x_lines.len(), |row, column| {
        [x_lines[column], y_lines[row], 0.0]
    })?;
    for row in 0..y_lines.len() - 1 {
        for column in 0..x_lines.len() - 1 {
            let lower = grid.row(row);
            let upper = grid.row(row + 1);
            let nodes = [lower[column], lower[column + 1], upper[column + 1], upper[column]];
            mesh.add(Quad4::new(nodes, material.clone(), QuadFormulation::MeanDilatation))?;
        }
    }
    Ok(mesh)
}

/// The scene of a seed.
pub fn random_scene(seed: u64) -> YieldingScene {
    let mut random = Random(seed);
    let (model, is_associated, block_text) = random_block(&mut random);
    let time_step = random.log_within(0.002, 0.02);
    let amplitude = random.log_within(0.5, 8.0);
    let frequency = random.log_within(0.5, 5.0);
    let is_on_springs = random.chance(0.5);
    let is_bonded = random.chance(0.3);
    let friction = random.within(0.2, 0.8);
    let text = format!(
        "seed {seed}: {block_text}, springs {is_on_springs}, bonded {is_bonded}, friction {friction:.2}, \
         {amplitude:.1} m/s² at {frequency:.1} Hz, Δt {time_step:.4}"
    );
    let simulation = model.and_then(|model| {
        let motion = Record::from_fn(time_step, RUN_STEPS as f64 * time_step, |time| {
            amplitude * (std::f64::consts::TAU * frequency * time).sin()
        })?;
        let builder = Simulation::builder(time_step).motion(motion);
        let builder = if is_on_springs {
            builder.ground(SpringGround::under(&model, 8, 5.0e7, 3.0e7)?)
        } else {
            builder.ground(ElasticGround::under(Soil::new(1.5e8, 0.3, 2000.0)?, &model, 8)?)
        };
        let builder = builder.structure(model);
        if is_bonded {
            builder.interface(Bonded).build()
        } else {
            builder.interface(Coulomb::new(friction)?).build()
        }
    });
    YieldingScene { simulation, is_associated, text }
}

/// Energies of a run.
#[derive(Debug, Clone, Copy)]
pub struct BlockEnergies {
    /// Largest residual of the energy balance.
    pub residual: f64,
    /// Smallest dissipation in a step, relative to the largest energy.
    pub min_dissipation: f64,
    /// Smallest mid-step remainder in a step, relative to the largest energy.
    pub min_remainder: f64,
    pub yields: bool,
    /// Whether the second half of the run, resumed from its middle, has the same displacements and energies.
    pub resumes: bool,
}

/// The smaller of two numbers, or NaN if one is NaN.
fn smaller(one: f64, other: f64) -> f64 {
    if other.is_nan() || other < one { other } else { one }
}

/// Runs a simulation of [`random_scene`] to its end, and its second half again.
///
/// # Errors
/// That of a step.
pub fn block_energies(simulation: &mut Simulation) -> Result<BlockEnergies> {
    let mut energies = BlockEnergies {
        residual: 0.0,
        min_dissipation: f64::INFINITY,
        min_remainder: f64::INFINITY,
        yields: false,
        resumes: false,
    };
    let mut hysteresis = 0.0;
    let mut remainder = 0.0;
    let mut middle = None;
    for step in 0..RUN_STEPS {
        if step == RUN_STEPS / 2 {
            middle = Some(simulation.checkpoint()?);
        }
        let energy_balance = simulation.step()?.energy_balance;
        let scale = energy_balance.largest.max(f64::MIN_POSITIVE);
        let dissipation = (energy_balance.hysteresis - hysteresis) / scale;
        let step_remainder = (energy_balance.midstep_remainder - remainder) / scale;
        energies.residual = -smaller(-energies.residual, -energy_balance.residual());
        energies.min_dissipation = smaller(energies.min_dissipation, dissipation);
        energies.min_remainder = smaller(energies.min_remainder, step_remainder);
        hysteresis = energy_balance.hysteresis;
        remainder = energy_balance.midstep_remainder;
    }
    energies.yields = hysteresis > YIELDING_THRESHOLD * simulation.state().energy_balance.largest;
    let end = simulation.state().clone();
    if let Some(middle) = middle {
        simulation.resume(&middle)?;
    }
    for _ in RUN_STEPS / 2..RUN_STEPS {
        simulation.step()?;
    }
    let resumed_state = simulation.state();
    energies.resumes = resumed_state.displacement() == end.displacement()
        && resumed_state.energy_balance == end.energy_balance;
    Ok(energies)
}
