//! GOAL: the energy balance closes on layered ground of all scales.
//! SCENE: 60 blocks (HEAVY_TESTS: 200) on one to three layers, uplifting and sliding; steps from 0.02 to 50 elements
//! per wave, ν up to 0.4999, contrasts from 1 to 100, layers from 1/20 of an element to 100 bases,
//! damping from 0 to 20 %.
//! REFERENCE: the energy balance.

use basemat::Simulation;
use basemat::bem::layered::Stages;
use basemat::bem::{ElasticGround, Strip};
use basemat::interface::Coulomb;
use basemat::motion::FreeFieldFn;
use basemat::soil::{GeneralizedMaxwell, KelvinVoigt, SoilProfile};
use basemat::structure::RigidBlock;
use basemat::{Result, Soil};

use basemat_problems::heavy;
use basemat_problems::random::Random;

const RUN_STEPS: usize = 60;
const BASE_WIDTH: f64 = 4.0;

/// What occurred in a run of a random scene.
struct SceneResult {
    energy_error: f64,
    opened: bool,
    slid: bool,
}

fn run_scene(seed: u64) -> Result<SceneResult> {
    let mut random = Random(seed);
    let elements = random.pick(&[3, 4, 5, 6]);
    let length = BASE_WIDTH / elements as f64;
    // Every fifth scene stands at an end of the ranges.
    let poisson = if seed.is_multiple_of(5) {
        random.pick(&[0.0, 0.4999])
    } else {
        random.within(0.0, 0.4999)
    };
    let top = Soil::from_shear_wave_speed(random.log_within(80.0, 400.0), poisson, 1900.0)?;
    let mut profile = if random.chance(0.3) {
        SoilProfile::on_rigid_bedrock()
    } else {
        let contrast = if seed % 5 == 1 {
            random.pick(&[1.0, 100.0])
        } else {
            random.log_within(1.0, 100.0)
        };
        SoilProfile::on_half_plane(Soil::new(contrast * top.shear_modulus(), 0.25, 2200.0)?)
    };
    for layer in 0..random.pick(&[1, 1, 2, 3]) {
        let min_thickness = length / 20.0;
        let max_thickness = 100.0 * BASE_WIDTH;
        let thickness = if seed % 5 == 2 {
            random.pick(&[min_thickness, max_thickness])
        } else {
            random.log_within(min_thickness, max_thickness)
        };
        let scale = if layer == 0 { 1.0 } else { random.log_within(0.5, 30.0) };
        let soil = Soil::new(scale * top.shear_modulus(), poisson, 1900.0)?;
        let ratio = if seed % 5 == 3 { random.pick(&[0.0, 0.2]) } else { random.within(0.0, 0.2) };
        profile = profile.with_layer(soil, thickness)?;
        profile = match random.pick(&[0, 1, 1]) {
            0 => profile.with_damping(KelvinVoigt::with_ratio(ratio, 5.0)?),
            _ => profile.with_damping(GeneralizedMaxwell::constant_q(ratio, [0.1, 30.0], 1.0)?),
        };
    }
    let courant = if seed % 5 == 4 {
        random.pick(&[0.02, 50.0])
    } else {
        random.log_within(0.02, 50.0)
    };
    let step = courant * length / top.pressure_wave_speed();
    let half = 0.5 * BASE_WIDTH;
    let ground = if random.chance(0.5) {
        ElasticGround::new(profile, Strip::graded(-half..half, elements)?)?
    } else {
        ElasticGround::new(profile, Strip::uniform(-half..half, elements)?)?
    };
    let ground = if random.chance(0.3) { ground.with_stages(Stages::Three) } else { ground };
    // Two periods in the run; short steps need violent shaking to move the block at all.
    let rate = 2.0 * std::f64::consts::TAU / (RUN_STEPS as f64 * step);
    let amplitude = random.within(0.3, 1.5) * 9.81 / rate.powi(2) * (1.0 + 0.02 * rate);
    let motion = FreeFieldFn::new(move |_, t| {
        let x = rate * t;
        [amplitude * (x.sin() - x * (-x).exp()), 0.3 * amplitude * (1.0 - (1.3 * x).cos())]
    });
    let mut simulation = Simulation::builder(step)
        .structure(RigidBlock::new(BASE_WIDTH, random.within(2.0, 10.0), 2000.0)?)
        .ground(ground)
        .interface(Coulomb::new(random.within(0.15, 0.8))?)
        .motion(motion)
        .build()?;
    let run = simulation.run(RUN_STEPS, |_| {})?;
    Ok(SceneResult {
        energy_error: run.energy_error,
        opened: run.whole.uplifted_fraction.largest().value > 0.0,
        slid: run.whole.largest_slip.largest().value > 0.0,
    })
}

#[test]
fn energy_balance_closes_over_all_scales() {
    let mut largest_error = 0.0_f64;
    let mut scenes_opened = 0;
    let mut scenes_slid = 0;
    let scenes = if heavy() { 200 } else { 60 };
    for seed in 0..scenes {
        let result = run_scene(seed).unwrap_or_else(|error| panic!("scene {seed}: {error}"));
        assert!(result.energy_error < 1e-9, "scene {seed}: {:e}", result.energy_error);
        largest_error = largest_error.max(result.energy_error);
        scenes_opened += u64::from(result.opened);
        scenes_slid += u64::from(result.slid);
    }
    println!("largest error {largest_error:e}; {scenes_opened} opened, {scenes_slid} slid");
    assert!(scenes_opened > scenes / 2, "{scenes_opened} opened");
    assert!(scenes_slid > scenes / 2, "{scenes_slid} slid");
}
