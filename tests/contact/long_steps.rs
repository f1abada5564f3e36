//! GOAL: contact that uplifts and never slides, in steps in which waves cross many elements.
//! SCENE: random buildings on the half-plane, c₁Δt/l from 13 to 60, shaken strongly.
//! REFERENCE: Signorini's conditions and sticking, written down anew.
//!
//! `LONG_STEPS=10000 cargo test --test fast long_steps` runs more scenes.

use basemat::bem::{ElasticGround, Grading, Strip};
use basemat::contact::SearchMethod;
use basemat::coupled::State;
use basemat::fem::{Layer, Material, Mesh};
use basemat::interface::Coulomb;
use basemat::motion::FreeFieldFn;
use basemat::structure::{FemModel, RigidBlock, ShearBuilding, Storey, Structure};
use basemat::{Simulation, Soil};

use basemat_problems::random::Random;

const STEPS: usize = 80;

/// Seeds of scenes with a step that eight paths from even starts did not solve, and the most
/// elements that a scene of that series has.
const LOST: [(u64, usize); 8] = [
    (3_001_293, 8),
    (3_003_146, 8),
    (3_007_558, 8),
    (4_002_304, 6),
    (4_005_685, 6),
    (4_020_049, 6),
    (4_026_041, 6),
    (5_014_466, 16),
];

fn up_to(low: usize, high: usize, random: &mut Random) -> usize {
    random.pick(&(low..=high).collect::<Vec<_>>())
}

fn structure(random: &mut Random) -> Box<dyn Structure> {
    match random.pick(&[0, 1, 2]) {
        0 => {
            let (height, density) = (random.within(0.5, 12.0), random.log_within(300.0, 3000.0));
            Box::new(RigidBlock::new(4.0, height, density).unwrap())
        }
        1 => {
            let storey = Storey::new(3.0, 10e3, random.log_within(1e6, 1e9));
            let storeys = vec![storey; up_to(1, 3, random)];
            Box::new(ShearBuilding::new(4.0, 3e4, 5e4, &storeys).unwrap())
        }
        _ => {
            let material = Material::new(random.log_within(1e8, 3e10), 0.2, 2000.0).unwrap();
            let layers = [Layer::new(random.within(0.5, 10.0), up_to(1, 3, random), material)];
            let columns = up_to(1, 4, random);
            let mesh = Mesh::layered_block(-2.0..2.0, columns, &layers).unwrap();
            Box::new(FemModel::on_base(mesh).unwrap())
        }
    }
}

/// Pulses or jumps, right and up, of accelerations from 0.1 to 10 g.
fn shaking(duration: f64, random: &mut Random) -> FreeFieldFn {
    let strength = random.log_within(0.1, 10.0);
    let amplitude = strength * 9.81 * (duration / 19.0).powi(2);
    let pulses: Vec<[f64; 3]> = (0..up_to(1, 5, random))
        .map(|_| [random.within(0.05, 0.95), random.within(-1.0, 1.0), random.within(-1.0, 1.0)])
        .collect();
    let jumps = random.chance(0.5);
    FreeFieldFn::new(move |_, time| {
        let phase = time / duration;
        let mut displacement = [0.0; 2];
        for &[middle, right, up] in pulses.iter().filter(|_| phase > 0.0) {
            let after = phase - middle;
            let shape = if !jumps {
                let s = 12.0 * after;
                (1.0 - 2.0 * s * s) * (-s * s).exp()
            } else if after >= 0.0 {
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

fn scene(seed: u64, most: usize) -> Simulation {
    let mut random = Random(seed);
    let count = up_to(3, most, &mut random);
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
        .motion(shaking(STEPS as f64 * time_step, &mut random))
        .build()
        .unwrap()
}

/// Largest distance of a run from the contact conditions: of pressures and shear relative to the
/// largest traction of the run, of gaps and advances to the largest gap or slip, a micrometre at
/// least.
fn violation(states: &[State]) -> f64 {
    let contact = || states.iter().flat_map(|state| &state.contact);
    let traction = contact().fold(0.0_f64, |m, s| m.max(s.pressure.abs()).max(s.shear.abs()));
    let length = contact().fold(1e-6_f64, |m, s| m.max(s.gap.abs()).max(s.slip.abs()));
    let pairs = states.windows(2).flat_map(|pair| pair[0].contact.iter().zip(&pair[1].contact));
    pairs.fold(0.0_f64, |worst, (start, end)| {
        let [pressure, shear] = [end.pressure, end.shear].map(|x| x / traction);
        let [gap, advance] = [end.gap, end.slip - start.slip].map(|x| x / length);
        // Open, pressed and stuck, or about to open under a shear traction along the slip.
        let open = pressure.abs().max(shear.abs()).max(-gap);
        let stuck = gap.abs().max(advance.abs()).max(-pressure);
        let backwards = shear.abs().min(-advance * shear.signum());
        let letting_go = gap.abs().max(pressure.abs()).max(backwards);
        worst.max(open.min(stuck).min(letting_go))
    })
}

#[test]
fn bases_that_never_slide_are_solved_in_long_steps() {
    let scenes = std::env::var("LONG_STEPS").ok().and_then(|text| text.parse().ok());
    let more = (0..scenes.unwrap_or(100)).map(|k| (7_000_021 + k, 16));
    let (mut failed, mut worst, mut paths) = (Vec::new(), 0.0_f64, 0);
    for (seed, most) in LOST.into_iter().chain(more) {
        let mut simulation = scene(seed, most);
        let mut states = vec![simulation.state().clone()];
        for _ in 0..STEPS {
            match simulation.step() {
                Ok(state) => states.push(state.clone()),
                Err(error) => {
                    println!("seed {seed}: {error}");
                    failed.push(seed);
                    break;
                }
            }
        }
        worst = worst.max(violation(&states));
        paths += states.iter().filter(|state| state.method == SearchMethod::Path).count();
    }
    println!("{paths} steps by paths, violation {worst:e}");
    assert!(failed.is_empty(), "{failed:?}");
    assert!(paths > 10 && worst < 1e-9, "{paths} {worst:e}");
}
