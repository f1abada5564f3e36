//! GOAL: layered ground is used as the half-plane is; interruptions, sharing and threads change no result.
//! SCENE: sliding and uplifting blocks on layers, one or two foundations, saved, resumed and swept.
//! REFERENCE: the half-plane's closed form and uninterrupted runs, both to the last bit; limits.

use basemat::bem::layered::Stages;
use basemat::bem::{ElasticGround, Grading, Ground, SharedKernels, Strip};
use basemat::coupled::{SimulationBuilder, State};
use basemat::history::{HistoryChoice, HistoryMethod};
use basemat::interface::Coulomb;
use basemat::motion::el_centro_1940;
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::structure::{RigidBlock, StructureGroup};
use basemat::sweep::Sweep;
use basemat::{Error, Simulation, Soil, unobserved};

use basemat_problems::profiles::{constant_q, two_stages};
use basemat_problems::sampled_block::{SampledSeries, distance, sample, under_pulse};
use basemat_problems::scenes::{SI_UNITS, TIME_STEP, block, friction, scene, soil, states};

/// The soil of the scenes, 3 m of it on rock, with 5 % damping.
fn profile() -> SoilProfile {
    SoilProfile::on_half_plane(Soil::from_shear_wave_speed(600.0, 0.3, 2200.0).unwrap())
        .with_bedrock_damping(constant_q(0.01))
        .with_layer(soil(SI_UNITS), 3.0)
        .unwrap()
        .with_damping(constant_q(0.05))
}

fn graded_ground(profile: impl Into<SoilProfile>, elements: usize) -> ElasticGround {
    ElasticGround::new(profile, Strip::graded(-2.0..2.0, elements).unwrap()).unwrap()
}

fn layered(elements: usize) -> ElasticGround {
    graded_ground(profile(), elements)
}

fn shaken(ground: impl Ground + 'static) -> SimulationBuilder {
    scene(SI_UNITS, 0.6)
        .structure(block(SI_UNITS))
        .interface(friction(0.3))
        .ground(ground)
}

/// States of 200 steps, and the ground's choice of history.
struct HalfPlaneRun {
    states: Vec<State>,
    choice: Option<HistoryChoice>,
}

fn run_half_plane(ground: ElasticGround) -> HalfPlaneRun {
    let mut simulation = shaken(ground).build().unwrap();
    let states = states(&mut simulation, 200);
    HalfPlaneRun { states, choice: simulation.ground().description().history }
}

fn largest_shear(states: &[State]) -> f64 {
    states.iter().fold(0.0_f64, |largest, state| largest.max(state.base_shear.abs()))
}

#[test]
fn one_undamped_half_plane_is_the_closed_form_to_the_last_bit() {
    let profile = SoilProfile::on_half_plane(soil(SI_UNITS));
    let by_profile = run_half_plane(graded_ground(profile.clone(), 8));
    let by_soil = run_half_plane(graded_ground(soil(SI_UNITS), 8));
    assert!(by_profile.states == by_soil.states);
    assert!(by_profile.choice == by_soil.choice && by_soil.choice.unwrap().stages.is_none());
    // On request convolution quadrature replaces the closed form, with nearly the same results.
    let by_quadrature = run_half_plane(graded_ground(profile, 8).with_stages(Stages::Two));
    assert_eq!(by_quadrature.choice.unwrap().stages, Some(2));
    let ratio = largest_shear(&by_quadrature.states) / largest_shear(&by_soil.states);
    assert!(by_quadrature.states != by_soil.states && (ratio - 1.0).abs() < 0.02, "{ratio}");
}

fn with_history(history: HistoryMethod) -> Simulation {
    shaken(layered(6).with_history(history).unwrap()).build().unwrap()
}

/// Runs interrupted anywhere resume to the last bit, also in a simulation that was used before.
#[test]
fn interrupted_and_resumed_runs_have_the_same_bits() {
    for history in [HistoryMethod::Direct, HistoryMethod::RelaxedFft] {
        let expected = states(&mut with_history(history), 300);
        for interruption in [1, 127, 129, 200] {
            let mut first = with_history(history);
            first.run(interruption, |_| {}).unwrap();
            let checkpoint = first.checkpoint().unwrap();
            let mut second = with_history(history);
            second.run(17, |_| {}).unwrap();
            second.resume(&checkpoint).unwrap();
            let resumed_states = states(&mut second, 300 - interruption);
            assert!(
                resumed_states[1..] == expected[interruption + 1..],
                "{history:?}, interrupted at {interruption}"
            );
        }
    }
}

/// Choice of history of a ground for 100 steps.
fn choice(mut ground: ElasticGround, time_step: f64) -> HistoryChoice {
    ground.prepare(time_step, Some(100), &mut unobserved).unwrap();
    ground.description().history.unwrap()
}

#[test]
fn the_stages_are_described_and_follow_the_rule() {
    let two_stages = choice(layered(3), 0.002);
    assert_eq!(two_stages.stages, Some(2));
    assert!(two_stages.to_string().contains("Radau IIA of 2 stages"), "{two_stages}");
    // n (ωΔt)⁴/72 = 1.3e-3 for the way of 6 m to the rock and back at 178 m/s in steps of 6 ms.
    assert_eq!(choice(layered(3), 0.006).stages, Some(3));
    assert_eq!(choice(layered(3).with_stages(Stages::Two), 0.006).stages, Some(2));
}

#[test]
fn exponentials_are_errors() {
    let mut ground = layered(3).with_history(HistoryMethod::Exponentials).unwrap();
    let error = ground.prepare(0.002, None, &mut unobserved).unwrap_err();
    assert!(matches!(error, Error::Scene { quantity: "history by exponentials", .. }), "{error}");
}

/// Runs the block on layers with shared kernels.
fn run_with_kernels(kernels: &SharedKernels, coefficient: f64) -> Vec<State> {
    let ground = layered(6).with_shared_kernels(kernels);
    let scene = shaken(ground).interface(Coulomb::new(coefficient).unwrap());
    states(&mut scene.build().unwrap(), 150)
}

/// Equal profiles share one kernel in a sweep; other stages, tolerances and laws have separate ones.
#[test]
fn shared_kernels_are_distinguished_and_change_no_bit() {
    let kernels = SharedKernels::default();
    let coefficients = [0.2, 0.4, f64::INFINITY];
    let mut results = vec![vec![]; coefficients.len()];
    Sweep::new(coefficients.len()).run(
        |case| Ok::<_, Error>(run_with_kernels(&kernels, coefficients[case.index])),
        |index, states| results[index] = states.unwrap(),
    );
    assert_eq!(kernels.count(), 1);
    for (states, coefficient) in results.iter().zip(coefficients) {
        let expected = run_with_kernels(&SharedKernels::default(), coefficient);
        assert!(*states == expected, "friction {coefficient}");
    }
    let other_grounds = [
        layered(6).with_stages(Stages::Three),
        layered(6).with_tolerance(1e-8).unwrap(),
        graded_ground(profile().with_bedrock_damping(constant_q(0.02)), 6),
    ];
    for (index, ground) in other_grounds.into_iter().enumerate() {
        ground
            .with_shared_kernels(&kernels)
            .prepare(TIME_STEP, None, &mut unobserved)
            .unwrap();
        assert_eq!(kernels.count(), 2 + index);
    }
}

#[test]
fn two_foundations_interact_through_the_layers() {
    let other_block = RigidBlock::new(3.0, 5.0, 1500.0).unwrap();
    let pair = StructureGroup::new()
        .with(block(SI_UNITS), -4.0)
        .unwrap()
        .with(other_block, 3.0)
        .unwrap();
    let ground =
        ElasticGround::new(profile(), Strip::under(&pair, 4, Grading::Uniform).unwrap()).unwrap();
    assert_eq!(ground.elements().len(), 8);
    let builder = scene(SI_UNITS, 0.6).interface(friction(0.3)).ground(ground).structure(pair);
    let run = builder.build().unwrap().run(300, |_| {}).unwrap();
    assert!(run.whole.uplifted_fraction.largest().value > 0.0 && run.energy_error < 1e-9, "{run}");
}

#[cfg(feature = "rayon")]
fn run_in_threads(threads: usize) -> Vec<State> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| states(&mut shaken(layered(6)).build().unwrap(), 200))
}

/// The bits of a run do not depend on the number of threads.
#[cfg(feature = "rayon")]
#[test]
fn threads_change_no_bit() {
    assert!(run_in_threads(1) == run_in_threads(3));
}

fn upper_soil() -> Soil {
    Soil::new(1.0, 0.3, 1.0).unwrap()
}

/// A layer of this thickness on rock.
fn layer_on_rock(thickness: f64) -> SoilProfile {
    let rock = Soil::from_shear_wave_speed(4.0, 0.3, 1.2).unwrap();
    SoilProfile::on_half_plane(rock)
        .with_layer(upper_soil(), thickness)
        .unwrap()
        .with_damping(GeneralizedMaxwell::constant_q(0.0, [0.1, 1.0], 1.0).unwrap())
}

/// Convolution weights of 60 lags of an element to its neighbour: zz, xx and zx.
fn neighbour_weights(profile: SoilProfile) -> [Vec<f64>; 3] {
    let strip = Strip::graded(-1.0..1.0, 4).unwrap();
    let kernel = two_stages(profile, &strip).weights(0.1).unwrap();
    let mut lists = [vec![0.0; 60], vec![0.0; 60], vec![0.0; 60]];
    kernel.coefficients(1, 1, &mut lists.each_mut().map(Vec::as_mut_slice)).unwrap();
    lists
}

/// Until waves return from its bottom, a layer has the convolution weights of a half-plane.
#[test]
fn layers_are_half_planes_until_waves_return() {
    let layer = neighbour_weights(layer_on_rock(6.0));
    let half_plane = neighbour_weights(SoilProfile::on_half_plane(upper_soil()));
    let max_magnitude = half_plane[0].iter().fold(0.0_f64, |max, value| max.max(value.abs()));
    let tolerance = 10.0 * (1e-10_f64.powf(2.0 / 3.0) + 1e-10) * max_magnitude;
    for (computed, expected) in layer.iter().zip(&half_plane) {
        // Pressure waves return after 12/1.87 = 6.4; the fronts of the method arrive a little earlier.
        for lag in 0..50 {
            let error = (computed[lag] - expected[lag]).abs();
            assert!(error < tolerance, "lag {}: {error:e} of {tolerance:e}", lag + 1);
        }
    }
}

/// Base displacement, rotation and base shear of a square block under a pulse.
fn pulse_response(profile: impl Into<SoilProfile>) -> SampledSeries {
    let ground = ElasticGround::new(profile, Strip::graded(-1.0..1.0, 6).unwrap()).unwrap();
    let block = RigidBlock::new(2.0, 2.0, 1.0).unwrap();
    sample(&mut under_pulse(block, ground, 0.1), 300, 1).unwrap().0
}

/// The thicker a layer is, the less waves return from its bottom.
#[test]
fn thick_layers_tend_to_the_half_plane() {
    let reference = pulse_response(upper_soil());
    let mut previous = [f64::INFINITY; 3];
    for thickness in [4.0, 8.0, 16.0, 32.0] {
        let errors = distance(&pulse_response(layer_on_rock(thickness)), &reference);
        println!("{thickness}: {errors:?}");
        for (error, previous) in errors.iter().zip(previous) {
            assert!(*error < 0.9 * previous, "{thickness}: {errors:?}");
        }
        previous = errors;
    }
    assert!(previous.iter().all(|error| *error < 1e-2), "{previous:?}");
}

/// A soft layer over rock radiates less than a half-plane of its soil, and a larger part of the base uplifts.
///
/// Damping of the layer reduces the difference.
#[test]
fn a_layer_on_rock_uplifts_more_than_the_half_plane() {
    let soft_soil = Soil::from_shear_wave_speed(150.0, 1.0 / 3.0, 1800.0).unwrap();
    let rock = Soil::from_shear_wave_speed(500.0, 0.3, 2200.0).unwrap();
    let plane = SoilProfile::on_half_plane(soft_soil);
    let elastic = SoilProfile::on_half_plane(rock).with_layer(soft_soil, 6.0).unwrap();
    let damped_layer =
        elastic.clone().with_damping(constant_q(0.05)).with_bedrock_damping(constant_q(0.01));
    // Base shear (kN/m) and open elements of 12, with coefficients of another program.
    for (name, profile, sliding, shear, open) in [
        ("half-plane", &plane, false, 224.9, 7.0),
        ("elastic layer on rock", &elastic, false, 274.5, 10.0),
        ("damped layer on rock", &damped_layer, false, 239.0, 8.0),
        ("half-plane", &plane, true, 164.5, 4.0),
        ("elastic layer on rock", &elastic, true, 175.7, 6.0),
        ("damped layer on rock", &damped_layer, true, 167.1, 5.0),
    ] {
        let law = if sliding { Coulomb::new(0.3).unwrap() } else { Coulomb::uplift_only() };
        let ground =
            ElasticGround::new(profile.clone(), Strip::uniform(-3.0..3.0, 12).unwrap()).unwrap();
        let builder = Simulation::builder(0.005)
            .structure(RigidBlock::new(6.0, 9.0, 1000.0).unwrap())
            .ground(ground)
            .interface(law)
            .motion(el_centro_1940());
        let run = builder.build().unwrap().run(2000, |_| {}).unwrap();
        let computed_shear = run.whole.base_shear.magnitude() / 1e3;
        let computed_open = 12.0 * run.whole.uplifted_fraction.largest().value;
        let label = format!("{name}, sliding {sliding}: {computed_shear:.2} {computed_open:.2}");
        println!("{label}, energy balance {:.1e}", run.energy_error);
        assert!((computed_shear / shear - 1.0).abs() < 0.01, "{label}");
        assert!((computed_open - open).abs() < 0.01, "{label}");
        assert!(run.energy_error < 1e-9);
    }
}
