//! GOAL: symmetry, units, superposition and the contact conditions hold in every run.
//! SCENE: block and tower on the half-plane that slide, uplift or stay bonded.
//! REFERENCE: the mirrored, rescaled or superposed run, and statics.

use basemat::coupled::{GravityStage, State, StepError};
use basemat::interface::{Bonded, InPlane, Mode, PreviousContact};
use basemat::results::Quantity;
use basemat::{Error, Simulation};
use proptest::prelude::*;

use basemat_problems::scenes::{
    SCENE_GRAVITY, SI_UNITS, TIME_STEP, UnitFrame, block, friction, scene, shake, states, tower,
};
use basemat_problems::wrapped::{LawWithNextMode, StructureWithForce};

const STEP_COUNT: usize = 400;

/// States of a block that rocks and slides.
fn rocking_states(frame: UnitFrame, strength: f64, coefficient: f64) -> Vec<State> {
    let builder = scene(frame, strength).structure(block(frame)).interface(friction(coefficient));
    states(&mut builder.build().unwrap(), STEP_COUNT)
}

/// States of a bonded tower.
fn bonded_states(strength: f64) -> Vec<State> {
    let builder = scene(SI_UNITS, strength).structure(tower(SI_UNITS, None)).interface(Bonded);
    states(&mut builder.build().unwrap(), 120)
}

/// Largest difference of two lists, relative to the largest value.
fn relative_difference(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
    let mut max_difference = 0.0_f64;
    let mut max_value = f64::MIN_POSITIVE;
    for (a, b) in pairs {
        max_difference = max_difference.max((a - b).abs());
        max_value = max_value.max(a.abs()).max(b.abs());
    }
    max_difference / max_value
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 6, failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn mirrored_record_gives_mirrored_response(strength in 0.2..0.8, mu in 0.1..0.8) {
        let reference_states = rocking_states(SI_UNITS, strength, mu);
        let mirrored_states = rocking_states(UnitFrame { mirrored: true, ..SI_UNITS }, strength, mu);
        prop_assert!(reference_states.iter().any(|s| s.uplifted_fraction > 0.0 || s.value(Quantity::LargestSlip) > 1e-4));
        let signs = [-1.0, 1.0, -1.0];
        for (k, sign) in signs.into_iter().enumerate() {
            let pairs = reference_states.iter().zip(&mirrored_states).map(|(a, b)| {
                (a.absolute_displacement()[k], sign * b.absolute_displacement()[k])
            });
            let error = relative_difference(pairs);
            prop_assert!(error < 1e-10, "degree of freedom {k}: {error:e}");
        }
        let last_index = reference_states[0].contact.len() - 1;
        let error = relative_difference(reference_states.iter().zip(&mirrored_states).flat_map(|(a, b)| {
            (0..=last_index).map(|e| (a.contact[e].pressure, b.contact[last_index - e].pressure))
        }));
        prop_assert!(error < 1e-8, "pressure: {error:e}");
    }

    #[test]
    fn units_have_no_effect(length in -3.0..3.0, time in -2.0..2.0, mass in -4.0..4.0, mu in 0.2..0.7) {
        let frame = UnitFrame {
            length: 10.0_f64.powf(length),
            time: 10.0_f64.powf(time),
            mass: 10.0_f64.powf(mass),
            mirrored: false,
        };
        let in_si = rocking_states(SI_UNITS, 0.5, mu);
        let in_frame = rocking_states(frame, 0.5, mu);
        let pairs = in_si.iter().zip(&in_frame);
        let error = relative_difference(pairs.clone().map(|(a, b)| (a.base_rotation, b.base_rotation)));
        prop_assert!(error < 1e-9, "rotation: {error:e}");
        let error = relative_difference(pairs.map(|(a, b)| {
            (a.base_shear, b.base_shear / (frame.pressure() * frame.length))
        }));
        prop_assert!(error < 1e-8, "base shear: {error:e}");
    }

    #[test]
    fn bonded_responses_superpose(a in -2.0..2.0, b in -2.0..2.0) {
        let first = bonded_states(a);
        let second = bonded_states(b);
        let states_of_the_sum = bonded_states(a + b);
        let mut pairs = Vec::new();
        for (step, states_of_the_sum) in states_of_the_sum.iter().enumerate() {
            let x = first[step].absolute_displacement();
            let y = second[step].absolute_displacement();
            for (dof, z) in states_of_the_sum.absolute_displacement().iter().enumerate() {
                pairs.push((x[dof] + y[dof], *z));
            }
        }
        let error = relative_difference(pairs.into_iter());
        prop_assert!(error < 1e-11, "{error:e}");
    }
}

/// Runs of block and tower with each friction coefficient.
fn contact_runs() -> Vec<(f64, Vec<State>)> {
    let mut runs = Vec::new();
    for mu in [0.0, 0.2, 0.5, 1.5, f64::INFINITY] {
        runs.push((mu, rocking_states(SI_UNITS, 0.6, mu)));
        let builder = scene(SI_UNITS, 0.6).structure(tower(SI_UNITS, None)).interface(friction(mu));
        runs.push((mu, states(&mut builder.build().unwrap(), 200)));
    }
    runs
}

#[test]
fn contact_conditions_hold_at_every_step() {
    let mut open_count = 0;
    let mut slip_count = 0;
    for (mu, states) in contact_runs() {
        let max_pressure =
            states.iter().flat_map(|s| &s.contact).fold(0.0_f64, |m, c| m.max(c.pressure));
        let max_displacement =
            states.iter().flat_map(State::displacement).fold(0.0_f64, |m, u| m.max(u.abs()));
        let max_input = states.iter().fold(0.0_f64, |m, s| m.max(s.energy_balance.input.abs()));
        for pair in states.windows(2) {
            for (e, (start, end)) in pair[0].contact.iter().zip(&pair[1].contact).enumerate() {
                let mode = pair[1].modes[e];
                let context = format!("friction {mu}, step {}, {mode:?}: {end:?}", pair[1].step);
                let traction_tolerance = 1e-11 * max_pressure;
                let gap_tolerance = 1e-12 * max_displacement;
                let is_without_pressure = end.pressure.abs() <= traction_tolerance;
                assert!(end.pressure >= -1e-11 * max_pressure, "tension, {context}");
                assert!(end.gap >= -1e-12 * max_displacement, "penetration, {context}");
                assert!(end.gap <= gap_tolerance || is_without_pressure, "{context}");
                if mu.is_finite() {
                    let limit = mu * end.pressure + traction_tolerance;
                    assert!(end.shear.abs() <= limit, "friction, {context}");
                }
                let slip_increment = end.slip - start.slip;
                // Friction works against the slip, and an element slides at the friction limit only.
                let min_work = -1e-14 * max_pressure * max_displacement;
                assert!(end.shear * slip_increment >= min_work, "work, {context}");
                let is_at_limit = (end.shear.abs() - mu * end.pressure).abs() <= traction_tolerance;
                let may_slide = is_at_limit || is_without_pressure;
                assert!(slip_increment.abs() <= gap_tolerance || may_slide, "slip, {context}");
                open_count += usize::from(mode == Mode::Open);
                slip_count += usize::from(mode.is_slip());
            }
            let dissipated_energy = pair[1].energy_balance.contact - pair[0].energy_balance.contact;
            assert!(
                dissipated_energy >= -1e-14 * max_input,
                "friction {mu}: {dissipated_energy:e} gained"
            );
        }
    }
    println!("{open_count} open and {slip_count} sliding element steps");
    assert!(open_count > 1000 && slip_count > 1000);
}

#[test]
fn preload_is_in_equilibrium() {
    let weight = block(SI_UNITS).total_mass() * SCENE_GRAVITY;
    for gravity_stage in [GravityStage::Frictionless, GravityStage::Frictional] {
        for mu in [0.0, 0.4, f64::INFINITY] {
            let builders = [
                scene(SI_UNITS, 0.0).structure(block(SI_UNITS)),
                scene(SI_UNITS, 0.0).structure(tower(SI_UNITS, None)),
            ];
            for builder in builders {
                let builder = builder.interface(friction(mu)).gravity_stage(gravity_stage);
                let simulation = builder.build().unwrap();
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

/// Under a weight beside the middle, the moment of the pressures is the weight times its arm.
#[test]
fn eccentric_preload_balances_moments() {
    let along = block(SI_UNITS).vertical_at(1.3);
    let eccentric = StructureWithForce { structure: block(SI_UNITS), along, force: |_| -2e5 };
    let simulation = scene(SI_UNITS, 0.0).structure(eccentric).interface(friction(0.5)).build();
    let state = simulation.unwrap().state().clone();
    let weight = block(SI_UNITS).total_mass() * SCENE_GRAVITY + 2e5;
    assert!((state.normal_force / weight - 1.0).abs() < 1e-10);
    assert!((state.base_moment / (-2e5 * 1.3) - 1.0).abs() < 1e-9, "{}", state.base_moment);
}

#[test]
fn a_structure_at_rest_stays_at_rest() {
    let simulation = scene(SI_UNITS, 0.0)
        .structure(tower(SI_UNITS, None))
        .interface(friction(0.3))
        .build();
    let states = states(&mut simulation.unwrap(), 50);
    let displacements = states.iter().flat_map(State::displacement);
    let max_displacement = displacements.fold(0.0_f64, |max, u| max.max(u.abs()));
    println!("moved {max_displacement:e}");
    assert!(max_displacement < 1e-13, "{max_displacement:e}");
}

#[test]
fn repeated_runs_have_the_same_bits() {
    assert_eq!(rocking_states(SI_UNITS, 0.5, 0.4), rocking_states(SI_UNITS, 0.5, 0.4));
}

/// The ground motion becomes NaN: the step fails, and the state is unchanged.
#[test]
fn a_failed_step_leaves_the_state_unchanged() {
    let builder = scene(SI_UNITS, 0.5).structure(block(SI_UNITS)).interface(friction(0.4));
    let expected = states(&mut builder.build().unwrap(), 100).pop().unwrap();
    let field = shake(SI_UNITS, 0.5);
    let broken_field = basemat::motion::FreeFieldFn::new(move |x, t| {
        use basemat::motion::FreeField;
        if t > 100.5 * TIME_STEP { [f64::NAN; 2] } else { field.displacement(x, t) }
    });
    let builder = scene(SI_UNITS, 0.5)
        .motion(broken_field)
        .structure(block(SI_UNITS))
        .interface(friction(0.4));
    let mut simulation = builder.build().unwrap();
    for _ in 0..100 {
        simulation.step().unwrap();
    }
    for _ in 0..2 {
        let error = simulation.step().unwrap_err();
        let Error::Step { step: 101, source: StepError::NotFinite { .. }, .. } = error else {
            panic!("{error}")
        };
        assert_eq!(simulation.state(), &expected);
    }
}

/// Changes the mode in every iteration once an element slides.
fn never_converged(mode: Mode, start: &PreviousContact, next_mode: Mode) -> Mode {
    match mode {
        _ if start.state.slip.abs() <= 1e-5 || next_mode != mode => next_mode,
        Mode::Stick => Mode::Open,
        _ => Mode::Stick,
    }
}

/// A law whose modes never converge fails in the mode search, with the step's number, residual and modes.
#[test]
fn a_step_without_solution_leaves_the_state_unchanged() {
    let law = InPlane(LawWithNextMode { law: friction(0.2), next: never_converged });
    let mut simulation: Simulation =
        scene(SI_UNITS, 0.6).structure(block(SI_UNITS)).interface(law).build().unwrap();
    let mut last_state = simulation.state().clone();
    let error = loop {
        match simulation.step() {
            Ok(state) => last_state = state.clone(),
            Err(error) => break error,
        }
        assert!(last_state.step < STEP_COUNT, "the base never slid");
    };
    let Error::Step { step, time, source: StepError::Contact { modes, iterations, .. } } = error
    else {
        panic!("{error}")
    };
    assert_eq!(step, last_state.step + 1);
    assert_eq!(modes.len(), last_state.modes.len());
    assert!(iterations > 1 && (time - step as f64 * TIME_STEP).abs() < 1e-12);
    assert_eq!(simulation.state(), &last_state);
}
