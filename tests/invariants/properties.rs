//! GOAL: symmetry, units, superposition and the contact conditions hold in every run.
//! SCENE: block and tower on the half-plane that slide, uplift or stay bonded.
//! REFERENCE: the mirrored, rescaled or superposed run, and statics.

use basemat::coupled::StepError;
use basemat::coupled::{GravityStage, State};
use basemat::interface::{Bonded, InPlane, Mode, PreviousContact};
use basemat::results::Quantity;
use basemat::{Error, Simulation};
use proptest::prelude::*;

use basemat_problems::scenes::{
    Frame, GRAVITY, SI, TIME_STEP, block, friction, scene, shake, states, tower,
};
use basemat_problems::wrapped::{Pulled, Wayward};

const STEPS: usize = 400;

fn rocking(frame: Frame, strength: f64, coefficient: f64) -> Vec<State> {
    let builder = scene(frame, strength).structure(block(frame)).interface(friction(coefficient));
    states(&mut builder.build().unwrap(), STEPS)
}

/// Largest difference of two lists, relative to the largest value.
fn apart(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (mut worst, mut scale) = (0.0_f64, f64::MIN_POSITIVE);
    for (a, b) in pairs {
        worst = worst.max((a - b).abs());
        scale = scale.max(a.abs()).max(b.abs());
    }
    worst / scale
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 6, failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn mirrored_record_gives_mirrored_response(strength in 0.2..0.8, mu in 0.1..0.8) {
        let plain = rocking(SI, strength, mu);
        let mirror = rocking(Frame { mirrored: true, ..SI }, strength, mu);
        prop_assert!(plain.iter().any(|s| s.uplifted_fraction > 0.0 || s.value(Quantity::LargestSlip) > 1e-4));
        let signs = [-1.0, 1.0, -1.0];
        for (k, sign) in signs.into_iter().enumerate() {
            let of = |s: &State| s.absolute_displacement()[k];
            let found = apart(plain.iter().zip(&mirror).map(|(a, b)| (of(a), sign * of(b))));
            prop_assert!(found < 1e-10, "unknown {k}: {found:e}");
        }
        let last = plain[0].contact.len() - 1;
        let found = apart(plain.iter().zip(&mirror).flat_map(|(a, b)| {
            (0..=last).map(|e| (a.contact[e].pressure, b.contact[last - e].pressure))
        }));
        prop_assert!(found < 1e-8, "pressure: {found:e}");
    }

    #[test]
    fn units_do_not_matter(length in -3.0..3.0, time in -2.0..2.0, mass in -4.0..4.0, mu in 0.2..0.7) {
        let ten = |power: f64| 10.0_f64.powf(power);
        let frame = Frame { length: ten(length), time: ten(time), mass: ten(mass), mirrored: false };
        let (si, other) = (rocking(SI, 0.5, mu), rocking(frame, 0.5, mu));
        let found = apart(si.iter().zip(&other).map(|(a, b)| (a.base_rotation, b.base_rotation)));
        prop_assert!(found < 1e-9, "rotation: {found:e}");
        let found = apart(si.iter().zip(&other).map(|(a, b)| {
            (a.base_shear, b.base_shear / (frame.pressure() * frame.length))
        }));
        prop_assert!(found < 1e-8, "base shear: {found:e}");
    }

    #[test]
    fn bonded_responses_superpose(a in -2.0..2.0, b in -2.0..2.0) {
        let run = |strength: f64| {
            let builder = scene(SI, strength).structure(tower(SI, None)).interface(Bonded);
            states(&mut builder.build().unwrap(), 120)
        };
        let (one, two, both) = (run(a), run(b), run(a + b));
        let sum = one.iter().zip(&two).zip(&both).flat_map(|((x, y), z)| {
            x.absolute_displacement().iter().zip(y.absolute_displacement()).zip(z.absolute_displacement()).map(|((x, y), z)| (x + y, *z))
        });
        let found = apart(sum);
        prop_assert!(found < 1e-11, "{found:e}");
    }
}

/// Runs with each friction, block and tower.
fn contact_runs() -> Vec<(f64, Vec<State>)> {
    let mut runs = Vec::new();
    for mu in [0.0, 0.2, 0.5, 1.5, f64::INFINITY] {
        runs.push((mu, rocking(SI, 0.6, mu)));
        let builder = scene(SI, 0.6).structure(tower(SI, None)).interface(friction(mu));
        runs.push((mu, states(&mut builder.build().unwrap(), 200)));
    }
    runs
}

#[test]
fn contact_conditions_hold_at_every_step() {
    let (mut lifted, mut slid) = (0, 0);
    for (mu, states) in contact_runs() {
        let pressure =
            states.iter().flat_map(|s| &s.contact).fold(0.0_f64, |m, c| m.max(c.pressure));
        let length =
            states.iter().flat_map(State::displacement).fold(0.0_f64, |m, u| m.max(u.abs()));
        let input = states.iter().fold(0.0_f64, |m, s| m.max(s.energy_balance.input.abs()));
        for pair in states.windows(2) {
            for (e, (before, now)) in pair[0].contact.iter().zip(&pair[1].contact).enumerate() {
                let mode = pair[1].modes[e];
                let context = format!("friction {mu}, step {}, {mode:?}: {now:?}", pair[1].step);
                assert!(now.pressure >= -1e-11 * pressure, "tension, {context}");
                assert!(now.gap >= -1e-12 * length, "penetration, {context}");
                let force = 1e-11 * pressure;
                assert!(now.gap <= 1e-12 * length || now.pressure.abs() <= force, "{context}");
                if mu.is_finite() {
                    assert!(now.shear.abs() <= mu * now.pressure + force, "friction, {context}");
                }
                let advance = now.slip - before.slip;
                // Friction works against the slip, and only slides at its limit.
                assert!(now.shear * advance >= -1e-14 * pressure * length, "work, {context}");
                let at_limit = (now.shear.abs() - mu * now.pressure).abs() <= force
                    || now.pressure.abs() <= force;
                assert!(advance.abs() <= 1e-12 * length || at_limit, "slip, {context}");
                lifted += usize::from(mode == Mode::Open);
                slid += usize::from(mode.is_slip());
            }
            let lost = pair[1].energy_balance.contact - pair[0].energy_balance.contact;
            assert!(lost >= -1e-14 * input, "friction {mu}: {lost:e} gained");
        }
    }
    println!("{lifted} open and {slid} sliding element steps");
    assert!(lifted > 1000 && slid > 1000);
}

#[test]
fn preload_is_in_equilibrium() {
    let weight = block(SI).total_mass() * GRAVITY;
    for gravity_stage in [GravityStage::Frictionless, GravityStage::Frictional] {
        for mu in [0.0, 0.4, f64::INFINITY] {
            let simulations =
                [scene(SI, 0.0).structure(block(SI)), scene(SI, 0.0).structure(tower(SI, None))]
                    .map(|b| {
                        b.interface(friction(mu)).gravity_stage(gravity_stage).build().unwrap()
                    });
            for simulation in simulations {
                let state = simulation.state();
                assert!(
                    (state.normal_force / weight - 1.0).abs() < 1e-10,
                    "{}",
                    state.normal_force
                );
                assert!(state.base_shear.abs() < 1e-10 * weight, "{}", state.base_shear);
                assert!(state.base_moment.abs() < 1e-10 * weight * 2.0, "{}", state.base_moment);
                assert!(state.contact.iter().all(|c| c.pressure > 0.0));
            }
        }
    }
}

/// A weight beside the middle: the moment of the pressures is the weight times its arm.
#[test]
fn eccentric_preload_balances_moments() {
    let along = block(SI).vertical_at(1.3);
    let leaning = Pulled { structure: block(SI), along, force: |_| -2e5 };
    let build = scene(SI, 0.0).structure(leaning).interface(friction(0.5)).build();
    let state = build.unwrap().state().clone();
    let weight = block(SI).total_mass() * GRAVITY + 2e5;
    assert!((state.normal_force / weight - 1.0).abs() < 1e-10);
    assert!((state.base_moment / (-2e5 * 1.3) - 1.0).abs() < 1e-9, "{}", state.base_moment);
}

#[test]
fn standing_still_stays_still() {
    let simulation = scene(SI, 0.0).structure(tower(SI, None)).interface(friction(0.3)).build();
    let states = states(&mut simulation.unwrap(), 50);
    let moved = states.iter().flat_map(State::displacement).fold(0.0_f64, |m, u| m.max(u.abs()));
    println!("moved {moved:e}");
    assert!(moved < 1e-13, "{moved:e}");
}

#[test]
fn runs_repeat_to_the_bit() {
    assert_eq!(rocking(SI, 0.5, 0.4), rocking(SI, 0.5, 0.4));
}

/// The ground stops being a number after a while: the step fails, and nothing has changed.
#[test]
fn failed_step_changes_nothing() {
    let good = |steps: usize| {
        let builder = scene(SI, 0.5).structure(block(SI)).interface(friction(0.4));
        states(&mut builder.build().unwrap(), steps).pop().unwrap()
    };
    let field = shake(SI, 0.5);
    let broken = basemat::motion::FreeFieldFn::new(move |x, t| {
        use basemat::motion::FreeField;
        if t > 100.5 * TIME_STEP { [f64::NAN; 2] } else { field.displacement(x, t) }
    });
    let builder = scene(SI, 0.5).motion(broken).structure(block(SI)).interface(friction(0.4));
    let mut simulation = builder.build().unwrap();
    for _ in 0..100 {
        simulation.step().unwrap();
    }
    for _ in 0..2 {
        let error = simulation.step().unwrap_err();
        let Error::Step { step: 101, source: StepError::NotFinite { .. }, .. } = error else {
            panic!("{error}")
        };
        assert_eq!(simulation.state(), &good(100));
    }
}

/// A law that never agrees fails in the mode search, with the step's number, residual and modes.
#[test]
fn step_without_modes_changes_nothing() {
    // Restless once it slides.
    let next = |mode: Mode, start: &PreviousContact, next: Mode| match mode {
        _ if start.state.slip.abs() <= 1e-5 || next != mode => next,
        Mode::Stick => Mode::Open,
        _ => Mode::Stick,
    };
    let law = InPlane(Wayward { law: friction(0.2), next });
    let mut simulation: Simulation =
        scene(SI, 0.6).structure(block(SI)).interface(law).build().unwrap();
    let mut last = simulation.state().clone();
    let error = loop {
        match simulation.step() {
            Ok(state) => last = state.clone(),
            Err(error) => break error,
        }
        assert!(last.step < STEPS, "the base never slid");
    };
    let Error::Step { step, time, source: StepError::Contact { modes, iterations, .. } } = error
    else {
        panic!("{error}")
    };
    assert_eq!((step, modes.len()), (last.step + 1, last.modes.len()));
    assert!(iterations > 1 && (time - step as f64 * TIME_STEP).abs() < 1e-12);
    assert_eq!(simulation.state(), &last);
}
