//! GOAL: layered ground is used as the half-plane is, and nothing depends on how a run is cut, on
//! what is shared or on threads.
//! SCENE: sliding and uplifting blocks on layers, one or two foundations, saved, resumed and swept.
//! REFERENCE: the half-plane's closed form and uninterrupted runs, both to the last bit; limits.

use basemat::bem::layered::Stages;
use basemat::bem::{ElasticGround, Grading, Ground, SharedKernels, Strip};
use basemat::coupled::SimulationBuilder;
use basemat::history::HistoryMethod;
use basemat::interface::Coulomb;
use basemat::motion::el_centro_1940;
use basemat::soil::{GeneralizedMaxwell, SoilProfile};
use basemat::structure::{RigidBlock, StructureGroup};
use basemat::sweep::Sweep;
use basemat::{Error, Simulation, Soil, unobserved};

use basemat_problems::profiles::{constant_q, two_stages};
use basemat_problems::sampled_block::{distance, sample, under_pulse};
use basemat_problems::scenes::{SI, TIME_STEP, block, friction, scene, soil, states};

/// The soil of the scenes, 3 m of it on rock, with 5 % damping.
fn profile() -> SoilProfile {
    SoilProfile::on_half_plane(Soil::from_shear_wave_speed(600.0, 0.3, 2200.0).unwrap())
        .with_bedrock_damping(constant_q(0.01))
        .with_layer(soil(SI), 3.0)
        .unwrap()
        .with_damping(constant_q(0.05))
}

fn layered(elements: usize) -> ElasticGround {
    ElasticGround::new(profile(), Strip::graded(-2.0..2.0, elements).unwrap()).unwrap()
}

fn shaken(ground: impl Ground + 'static) -> SimulationBuilder {
    scene(SI, 0.6).structure(block(SI)).interface(friction(0.3)).ground(ground)
}

#[test]
fn one_undamped_half_plane_is_the_closed_form_to_the_last_bit() {
    let profile = SoilProfile::on_half_plane(soil(SI));
    let run = |ground: Box<dyn Ground>| {
        let mut simulation = shaken(ground).build().unwrap();
        let states = states(&mut simulation, 200);
        (states, simulation.ground().description().history)
    };
    let (found, choice) = run(Box::new(
        ElasticGround::new(profile.clone(), Strip::graded(-2.0..2.0, 8).unwrap()).unwrap(),
    ));
    let (wanted, closed) =
        run(Box::new(ElasticGround::new(soil(SI), Strip::graded(-2.0..2.0, 8).unwrap()).unwrap()));
    assert!(found == wanted && choice == closed && choice.unwrap().stages.is_none());
    // Asked for, convolution quadrature takes its place, and is close.
    let asked = ElasticGround::new(profile, Strip::graded(-2.0..2.0, 8).unwrap())
        .unwrap()
        .with_stages(Stages::Two);
    let (near, choice) = run(Box::new(asked));
    assert_eq!(choice.unwrap().stages, Some(2));
    let largest = |states: &[basemat::coupled::State]| {
        states.iter().fold(0.0_f64, |m, state| m.max(state.base_shear.abs()))
    };
    let ratio = largest(&near) / largest(&wanted);
    assert!(near != wanted && (ratio - 1.0).abs() < 0.02, "{ratio}");
}

/// Cut anywhere, saved and resumed in another simulation, whatever either had computed before.
#[test]
fn cut_and_resumed_runs_have_the_same_bits() {
    for history in [HistoryMethod::Direct, HistoryMethod::RelaxedFft] {
        let make = || shaken(layered(6).with_history(history).unwrap()).build().unwrap();
        let mut whole = make();
        let wanted = states(&mut whole, 300);
        for cut in [1, 127, 129, 200] {
            let mut first = make();
            first.run(cut, |_| {}).unwrap();
            let saved = first.checkpoint().unwrap();
            let mut second = make();
            second.run(17, |_| {}).unwrap();
            second.resume(&saved).unwrap();
            let found = states(&mut second, 300 - cut);
            assert!(found[1..] == wanted[cut + 1..], "{history:?}, cut at {cut}");
        }
    }
}

#[test]
fn the_stages_are_said_and_follow_the_rule() {
    let choice = |ground: ElasticGround, step: f64| {
        let mut ground = ground;
        ground.prepare(step, Some(100), &mut unobserved).unwrap();
        ground.description().history.unwrap()
    };
    let found = choice(layered(3), 0.002);
    assert_eq!(found.stages, Some(2));
    assert!(found.to_string().contains("Radau IIA of 2 stages"), "{found}");
    // n (ωΔt)⁴/72 = 1.3e-3 for 3 m and back at 178 m/s in steps of 6 ms.
    assert_eq!(choice(layered(3), 0.006).stages, Some(3));
    assert_eq!(choice(layered(3).with_stages(Stages::Two), 0.006).stages, Some(2));
}

#[test]
fn exponentials_are_refused() {
    let mut ground = layered(3).with_history(HistoryMethod::Exponentials).unwrap();
    let found = ground.prepare(0.002, None, &mut unobserved).unwrap_err();
    assert!(matches!(found, Error::Scene { quantity: "history by exponentials", .. }), "{found}");
}

/// Equal profiles share one kernel in a sweep; other stages, tolerances and laws have their own.
#[test]
fn shared_kernels_are_told_apart_and_change_no_bit() {
    let run = |kernels: &SharedKernels, coefficient: f64| {
        let ground = layered(6).with_shared_kernels(kernels);
        let scene = shaken(ground).interface(Coulomb::new(coefficient).unwrap());
        states(&mut scene.build().unwrap(), 150)
    };
    let (shared, list) = (SharedKernels::default(), [0.2, 0.4, f64::INFINITY]);
    let mut results = vec![vec![]; list.len()];
    Sweep::new(list.len()).run(
        |now| Ok::<_, Error>(run(&shared, list[now.index])),
        |index, states| results[index] = states.unwrap(),
    );
    assert_eq!(shared.count(), 1);
    for (found, coefficient) in results.iter().zip(list) {
        assert!(*found == run(&SharedKernels::default(), coefficient), "friction {coefficient}");
    }
    let others = [
        layered(6).with_stages(Stages::Three),
        layered(6).with_tolerance(1e-8).unwrap(),
        ElasticGround::new(
            profile().with_bedrock_damping(constant_q(0.02)),
            Strip::graded(-2.0..2.0, 6).unwrap(),
        )
        .unwrap(),
    ];
    for (index, ground) in others.into_iter().enumerate() {
        ground.with_shared_kernels(&shared).prepare(TIME_STEP, None, &mut unobserved).unwrap();
        assert_eq!(shared.count(), 2 + index);
    }
}

#[test]
fn two_foundations_talk_through_the_layers() {
    let other = RigidBlock::new(3.0, 5.0, 1500.0).unwrap();
    let pair = StructureGroup::new().with(block(SI), -4.0).unwrap().with(other, 3.0).unwrap();
    let ground =
        ElasticGround::new(profile(), Strip::under(&pair, 4, Grading::Uniform).unwrap()).unwrap();
    assert_eq!(ground.elements().len(), 8);
    let base = scene(SI, 0.6).interface(friction(0.3)).ground(ground).structure(pair);
    let run = base.build().unwrap().run(300, |_| {}).unwrap();
    assert!(run.whole.uplifted_fraction.largest().value > 0.0 && run.energy_error < 1e-9, "{run}");
}

/// The bits of a run do not depend on the threads that compute its coefficients.
#[cfg(feature = "rayon")]
#[test]
fn threads_change_no_bit() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| states(&mut shaken(layered(6)).build().unwrap(), 200))
    };
    assert!(run(1) == run(3));
}

/// Until waves have come back from its bottom, a layer is a half-plane; the thicker it is, the less
/// comes back at all.
#[test]
fn thick_layers_tend_to_the_half_plane() {
    let top = Soil::new(1.0, 0.3, 1.0).unwrap();
    let rock = Soil::from_shear_wave_speed(4.0, 0.3, 1.2).unwrap();
    let on = |thickness: f64| {
        SoilProfile::on_half_plane(rock)
            .with_layer(top, thickness)
            .unwrap()
            .with_damping(GeneralizedMaxwell::constant_q(0.0, [0.1, 1.0], 1.0).unwrap())
    };
    let (step, lags) = (0.1, 60);
    let strip = Strip::graded(-1.0..1.0, 4).unwrap();
    let series = |profile: SoilProfile| {
        let kernel = two_stages(profile, &strip).weights(step).unwrap();
        let mut lists = [vec![0.0; lags], vec![0.0; lags], vec![0.0; lags]];
        let [zz, xx, zx] = &mut lists;
        kernel.coefficients(1, 1, &mut [zz, xx, zx]).unwrap();
        lists
    };
    // Pressure waves are back after 12/1.87 = 6.4: the method's fronts come a little early.
    let (found, wanted) = (series(on(6.0)), series(SoilProfile::on_half_plane(top)));
    let largest = wanted[0].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let allowed = 10.0 * (1e-10_f64.powf(2.0 / 3.0) + 1e-10) * largest;
    for (found, wanted) in found.iter().zip(&wanted) {
        for lag in 0..50 {
            let error = (found[lag] - wanted[lag]).abs();
            assert!(error < allowed, "lag {}: {error:e} of {allowed:e}", lag + 1);
        }
    }

    let run = |ground: Box<dyn Ground>| {
        let block = RigidBlock::new(2.0, 2.0, 1.0).unwrap();
        sample(&mut under_pulse(block, ground, 0.1), 300, 1).unwrap().0
    };
    let wanted =
        run(Box::new(ElasticGround::new(top, Strip::graded(-1.0..1.0, 6).unwrap()).unwrap()));
    let mut before = [f64::INFINITY; 3];
    for thickness in [4.0, 8.0, 16.0, 32.0] {
        let ground =
            ElasticGround::new(on(thickness), Strip::graded(-1.0..1.0, 6).unwrap()).unwrap();
        let error = distance(&run(Box::new(ground)), &wanted);
        println!("{thickness}: {error:?}");
        for (now, before) in error.iter().zip(&mut before) {
            assert!(*now < 0.9 * *before, "{thickness}: {error:?}");
            *before = *now;
        }
    }
    assert!(before.iter().all(|error| *error < 1e-2), "{before:?}");
}

/// A block on six metres of soft soil over rock opens far more of its base than on a half-plane of
/// that soil, which radiates too much; damping of the layer takes part of that back.
#[test]
fn a_layer_on_rock_uplifts_more_than_the_half_plane() {
    let soft = Soil::from_shear_wave_speed(150.0, 1.0 / 3.0, 1800.0).unwrap();
    let rock = Soil::from_shear_wave_speed(500.0, 0.3, 2200.0).unwrap();
    let plane = SoilProfile::on_half_plane(soft);
    let elastic = SoilProfile::on_half_plane(rock).with_layer(soft, 6.0).unwrap();
    let damped =
        elastic.clone().with_damping(constant_q(0.05)).with_bedrock_damping(constant_q(0.01));
    // Base shear (kN/m) and elements open of 12, of another program's coefficients.
    for (name, profile, sliding, shear, open) in [
        ("half-plane", &plane, false, 224.9, 7.0),
        ("elastic layer on rock", &elastic, false, 274.5, 10.0),
        ("damped layer on rock", &damped, false, 239.0, 8.0),
        ("half-plane", &plane, true, 164.5, 4.0),
        ("elastic layer on rock", &elastic, true, 175.7, 6.0),
        ("damped layer on rock", &damped, true, 167.1, 5.0),
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
        let found = [
            run.whole.base_shear.magnitude() / 1e3,
            12.0 * run.whole.uplifted_fraction.largest().value,
        ];
        println!("{name}, sliding {sliding}: {found:.2?}, energy balance {:.1e}", run.energy_error);
        assert!((found[0] / shear - 1.0).abs() < 0.01, "{name}, sliding {sliding}: {found:?}");
        assert!((found[1] - open).abs() < 0.01, "{name}, sliding {sliding}: {found:?}");
        assert!(run.energy_error < 1e-9);
    }
}
