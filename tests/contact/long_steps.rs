//! GOAL: contact that uplifts and never slides is solved in steps in which waves cross many elements.
//! SCENE: random buildings on the half-plane, c₁Δt/l from 13 to 60, shaken strongly.
//! REFERENCE: Signorini's conditions and sticking, evaluated independently.
//!
//! `LONG_STEPS=10000 cargo test --test fast long_steps` runs more scenes.

use basemat::bem::{ElasticGround, Grading, Strip};
use basemat::contact::SearchMethod;
use basemat::coupled::State;
use basemat::fem::{Layer, Material, Mesh};
use basemat::interface::{ContactState, Coulomb};
use basemat::motion::FreeFieldFn;
use basemat::structure::{FemModel, RigidBlock, ShearBuilding, Storey, Structure};
use basemat::{Simulation, Soil};

use basemat_problems::random::Random;

const RUN_STEPS: usize = 80;

/// Seeds and largest numbers of elements of scenes with a step that eight paths from even starts do not solve.
const DIFFICULT_SCENES: [(u64, usize); 8] = [
    (3_001_293, 8),
    (3_003_146, 8),
    (3_007_558, 8),
    (4_002_304, 6),
    (4_005_685, 6),
    (4_020_049, 6),
    (4_026_041, 6),
    (5_014_466, 16),
];

/// A random number of this range, both ends included.
fn random_count(min: usize, max: usize, random: &mut Random) -> usize {
    random.pick(&(min..=max).collect::<Vec<_>>())
}

fn structure(random: &mut Random) -> Box<dyn Structure> {
    match random.pick(&[0, 1, 2]) {
        0 => {
            let height = random.within(0.5, 12.0);
            let density = random.log_within(300.0, 3000.0);
            Box::new(RigidBlock::new(4.0, height, density).unwrap())
        }
        1 => {
            let storey = Storey::new(3.0, 10e3, random.log_within(1e6, 1e9));
            let storeys = vec![storey; random_count(1, 3, random)];
            Box::new(ShearBuilding::new(4.0, 3e4, 5e4, &storeys).unwrap())
        }
        _ => {
            let material = Material::new(random.log_within(1e8, 3e10), 0.2, 2000.0).unwrap();
            let layers =
                [Layer::new(random.within(0.5, 10.0), random_count(1, 3, random), material)];
            let columns = random_count(1, 4, random);
            let mesh = Mesh::layered_block(-2.0..2.0, columns, &layers).unwrap();
            Box::new(FemModel::on_base(mesh).unwrap())
        }
    }
}

/// Pulses or jumps to the right and upwards, of accelerations from 0.1 to 10 g.
fn random_motion(duration: f64, random: &mut Random) -> FreeFieldFn {
    let strength = random.log_within(0.1, 10.0);
    let amplitude = strength * 9.81 * (duration / 19.0).powi(2);
    let pulses: Vec<[f64; 3]> = (0..random_count(1, 5, random))
        .map(|_| [random.within(0.05, 0.95), random.within(-1.0, 1.0), random.within(-1.0, 1.0)])
        .collect();
    let has_jumps = random.chance(0.5);
    FreeFieldFn::new(move |_, time| {
        let phase = time / duration;
        let mut displacement = [0.0; 2];
        for &[middle, right, up] in pulses.iter().filter(|_| phase > 0.0) {
            let phase_after = phase - middle;
            let shape = if !has_jumps {
                let s = 12.0 * phase_after;
                (1.0 - 2.0 * s * s) * (-s * s).exp()
            } else if phase_after >= 0.0 {
                0.3
            } else {
                0.0
            };
            displacement[0] += amplitude * shape * right;
            displacement[1] += amplitude * shape * up;
        }
        displacement
    })
}

fn random_scene(seed: u64, max_elements: usize) -> Simulation {
    let mut random = Random(seed);
    let count = random_count(3, max_elements, &mut random);
    let poisson = random.within(0.0, 0.49);
    let soil = Soil::new(random.log_within(1e6, 1e9), poisson, 1900.0).unwrap();
    let courant = random.log_within(13.0, 60.0);
    let time_step = courant * 4.0 / count as f64 / soil.pressure_wave_speed();
    let grading = if random.chance(0.5) { Grading::Cosine } else { Grading::Uniform };
    let strip = Strip::new(-2.0..2.0, count, grading).unwrap();
    let structure = structure(&mut random);
    Simulation::builder(time_step)
        .structure(structure)
        .ground(ElasticGround::new(soil, strip).unwrap())
        .interface(Coulomb::uplift_only())
        .motion(random_motion(RUN_STEPS as f64 * time_step, &mut random))
        .build()
        .unwrap()
}

/// Largest tractions and displacements of contact in a run.
struct RunScales {
    traction: f64,
    /// Largest gap or slip, at least a micrometre.
    length: f64,
}

impl RunScales {
    fn of(states: &[State]) -> Self {
        let mut scales = Self { traction: 0.0, length: 1e-6 };
        for contact in states.iter().flat_map(|state| &state.contact) {
            scales.traction = scales.traction.max(contact.pressure.abs()).max(contact.shear.abs());
            scales.length = scales.length.max(contact.gap.abs()).max(contact.slip.abs());
        }
        scales
    }

    /// Distance of an element from its contact conditions at the end of a step, relative to the scales.
    fn violation(&self, start: &ContactState, end: &ContactState) -> f64 {
        let pressure = end.pressure / self.traction;
        let shear = end.shear / self.traction;
        let gap = end.gap / self.length;
        let slip_increment = (end.slip - start.slip) / self.length;
        let open_violation = pressure.abs().max(shear.abs()).max(-gap);
        let stuck = gap.abs().max(slip_increment.abs()).max(-pressure);
        // An element without pressure that slides under a shear traction along its slip.
        let against_slip = shear.abs().min(-slip_increment * shear.signum());
        let opening = gap.abs().max(pressure.abs()).max(against_slip);
        open_violation.min(stuck).min(opening)
    }
}

/// Largest distance of a run from the contact conditions.
fn largest_violation(states: &[State]) -> f64 {
    let scales = RunScales::of(states);
    let mut max_value = 0.0_f64;
    for pair in states.windows(2) {
        for (start, end) in pair[0].contact.iter().zip(&pair[1].contact) {
            max_value = max_value.max(scales.violation(start, end));
        }
    }
    max_value
}

#[test]
fn bases_that_never_slide_are_solved_in_long_steps() {
    let scenes = std::env::var("LONG_STEPS").ok().and_then(|text| text.parse().ok());
    let more_scenes = (0..scenes.unwrap_or(100)).map(|k| (7_000_021 + k, 16));
    let mut failed_scenes = Vec::new();
    let mut violation = 0.0_f64;
    let mut path_steps = 0;
    for (seed, max_elements) in DIFFICULT_SCENES.into_iter().chain(more_scenes) {
        let mut simulation = random_scene(seed, max_elements);
        let mut states = vec![simulation.state().clone()];
        for _ in 0..RUN_STEPS {
            match simulation.step() {
                Ok(state) => states.push(state.clone()),
                Err(error) => {
                    println!("seed {seed}: {error}");
                    failed_scenes.push(seed);
                    break;
                }
            }
        }
        violation = violation.max(largest_violation(&states));
        path_steps += states.iter().filter(|state| state.method == SearchMethod::Path).count();
    }
    println!("{path_steps} steps by paths, violation {violation:e}");
    assert!(failed_scenes.is_empty(), "{failed_scenes:?}");
    assert!(path_steps > 10 && violation < 1e-9, "{path_steps} {violation:e}");
}
