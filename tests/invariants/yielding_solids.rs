//! GOAL: the energies of solids that yield balance in every run.
//! SCENE: random blocks of quadrilaterals with Iwan's or Drucker–Prager's material, that yield, lift off and slide.
//! REFERENCE: the energy balance with the mid-step remainder; signs of dissipation and remainder; a resumed run.

use basemat::fem::{DruckerPrager, Iwan, Material, Mesh, Quad4, QuadFormulation, SharedMaterial};
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::Record;
use basemat::prelude::*;
use basemat_problems::heavy;
use basemat_problems::random::Random;

const RUN_STEPS: usize = 60;
/// Largest residual of the energy balance.
const BALANCE_TOLERANCE: f64 = 1e-9;
/// Largest decrease of a sum that never decreases but for rounding, relative to the largest energy.
const DECREASE_TOLERANCE: f64 = 1e-12;

/// A random scene, and whether its plastic strain is normal to the yield surface.
struct YieldingScene {
    simulation: basemat::Result<Simulation>,
    is_associated: bool,
    text: String,
}

/// Material whose strength is comparable to a pressure, Pa, and whether it is associated.
fn random_material(random: &mut Random, pressure: f64) -> (SharedMaterial, bool, String) {
    let poisson = random.within(0.1, 0.49);
    let density = random.within(1500.0, 2500.0);
    let shear_modulus = pressure * random.log_within(3e2, 1e4);
    if random.chance(0.5) {
        let strength = pressure * random.log_within(0.7, 4.0);
        let limit_strain = random.within(50.0, 300.0) * strength / shear_modulus;
        let clay =
            Iwan::hyperbolic(shear_modulus, strength, limit_strain, poisson, density).unwrap();
        return (clay.into(), true, format!("Iwan G {shear_modulus:.2e} τ_s {strength:.2e}"));
    }
    let young_modulus = 2.0 * shear_modulus * (1.0 + poisson);
    let elastic = Material::new(young_modulus, poisson, density).unwrap();
    let cohesion = pressure * random.log_within(0.2, 2.0);
    let friction_angle = random.within(0.0, 0.7);
    let dilation_angle = random.pick(&[1.0, 1.0, 0.0, 0.4]) * friction_angle;
    let sand = DruckerPrager::new(elastic, cohesion, friction_angle, dilation_angle).unwrap();
    let text =
        format!("Drucker–Prager c {cohesion:.2e} φ {friction_angle:.2} ψ {dilation_angle:.2}");
    (sand.into(), friction_angle == dilation_angle, text)
}

/// Grid lines of `count` intervals over a length from a start.
fn grid_lines(start: f64, length: f64, count: usize) -> Vec<f64> {
    (0..=count).map(|k| start + length * k as f64 / count as f64).collect()
}

/// Block of eight-node or four-node quadrilaterals.
fn random_block(random: &mut Random) -> (basemat::Result<FemModel>, bool, String) {
    let width = random.within(1.0, 8.0);
    let height = random.within(1.0, 8.0);
    let columns = random.pick(&[1, 2, 3]);
    let rows = random.pick(&[1, 2, 3]);
    let (material, is_associated, text) = random_material(random, 2.0e4 * height);
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
fn four_node_block(
    x_lines: &[f64],
    y_lines: &[f64],
    material: &SharedMaterial,
) -> basemat::Result<Mesh> {
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

fn random_scene(seed: u64) -> YieldingScene {
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

/// Counts over random scenes.
#[derive(Debug, Default)]
struct YieldingSceneCounts {
    refused: usize,
    failed: usize,
    yielded: usize,
}

/// Runs a scene and checks its energies in every step.
fn check_scene(scene: YieldingScene, counts: &mut YieldingSceneCounts) {
    let YieldingScene { simulation, is_associated, text } = scene;
    let mut simulation = match simulation {
        Ok(simulation) => simulation,
        Err(error) => {
            println!("{text}: refused: {error}");
            counts.refused += 1;
            return;
        }
    };
    let mut hysteresis = 0.0;
    let mut remainder = 0.0;
    let mut middle = None;
    for step in 0..RUN_STEPS {
        if step == RUN_STEPS / 2 {
            middle = Some(simulation.checkpoint().unwrap());
        }
        if let Err(error) = simulation.step() {
            println!("{text}: step {step} failed: {error}");
            counts.failed += 1;
            return;
        }
        let energy_balance = simulation.state().energy_balance;
        let residual = energy_balance.residual();
        assert!(residual < BALANCE_TOLERANCE, "{text}: residual {residual:.1e} in step {step}");
        let rounding = DECREASE_TOLERANCE * energy_balance.largest;
        let heat = energy_balance.hysteresis - hysteresis;
        assert!(heat >= -rounding, "{text}: dissipation {heat:.1e} in step {step}");
        let lost_work = energy_balance.midstep_remainder - remainder;
        assert!(
            !is_associated || lost_work >= -rounding,
            "{text}: remainder {lost_work:.1e} in step {step}"
        );
        hysteresis = energy_balance.hysteresis;
        remainder = energy_balance.midstep_remainder;
    }
    counts.yielded += usize::from(hysteresis > 1e-6 * simulation.state().energy_balance.largest);
    let end = simulation.state().clone();
    simulation.resume(&middle.unwrap()).unwrap();
    for _ in RUN_STEPS / 2..RUN_STEPS {
        simulation.step().unwrap();
    }
    assert_eq!(simulation.state().displacement(), end.displacement(), "{text}: resumed");
    assert_eq!(simulation.state().energy_balance, end.energy_balance, "{text}: resumed");
}

#[test]
fn energies_of_yielding_solids_balance() {
    let scene_count = if heavy() { 500 } else { 40 };
    let mut counts = YieldingSceneCounts::default();
    for seed in 0..scene_count {
        check_scene(random_scene(seed), &mut counts);
    }
    println!("{counts:?} of {scene_count}");
    let scene_count = usize::try_from(scene_count).unwrap();
    assert!(counts.refused < scene_count / 3 && counts.yielded > scene_count / 3, "{counts:?}");
    assert_eq!(counts.failed, 0);
}
