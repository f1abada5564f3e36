//! GOAL: an element on soil that yields again in every cycle follows its law.
//! SCENE: one and several elements on elastic soil under random motions.
//! REFERENCE: the law by bisection.

use basemat::contact::ContactProblem;
use basemat::interface::{ContactState, CyclicYielding, Mode, PreviousContact, PreviousContacts};
use basemat_problems::random::Random;
use basemat_problems::settling_law::{SettlingLaw, SettlingState};

/// Level and threshold of the only element.
fn settling_state(start: &PreviousContacts) -> SettlingState {
    let element = start.iter().next().unwrap();
    let [level, threshold] = *element.state_variables else {
        panic!("two state variables")
    };
    SettlingState { level, threshold }
}

#[test]
fn one_element_follows_the_law_of_the_documents() {
    let mut random = Random(11);
    let mut yield_count = 0;
    let mut open_count = 0;
    let mut closed_count = 0;
    for case in 0..200 {
        let law = SettlingLaw::random(&mut random);
        let spring = random.log_within(0.3, 300.0) / law.reference_settlement;
        let compliance = vec![1.0 / spring, 0.0, 0.0, 1.0 / spring];
        let interface = Box::new(law.cyclic_yielding(0.0));
        let mut problem = ContactProblem::new(compliance, vec![interface]).unwrap();
        let initial_contact = PreviousContact::new(ContactState::default(), Mode::SlipRight, 0.1);
        let mut start = problem.start(&[initial_contact]).unwrap();
        let mut displacement = 0.0;
        for step in 0..40 {
            displacement += random.within(-1.0, 1.3) * 3.0 * law.reference_settlement;
            let state = settling_state(&start);
            let penetration = displacement - state.level;
            let expected = law.pressure(&state, penetration, spring);
            let solution = problem.solve(&[-displacement, 0.0], &start).unwrap();
            let pressure = solution.states[0].pressure;
            let mode = solution.modes[0];
            yield_count += usize::from(mode == Mode::YieldRight);
            open_count += usize::from(mode == Mode::Open);
            closed_count += usize::from(mode == Mode::SlipRight);
            let capacity = law.capacity(state.level);
            let error = (pressure - expected).abs() / capacity;
            assert!(error < 1e-7, "{case}, {step}: {pressure} {expected} {law:?} {state:?}");
            solution.commit(&mut start).unwrap();
            let end = law.end(&state, expected, penetration - expected / spring);
            let end_state = settling_state(&start);
            let scale = law.reference_settlement + end.level;
            assert!(
                (end_state.level - end.level).abs() < 1e-6 * scale,
                "{case}: {end_state:?} {end:?}"
            );
            let difference = (end_state.threshold - end.threshold).abs();
            assert!(difference < 1e-7 * capacity, "{case}: {end_state:?} {end:?}");
        }
    }
    println!("{yield_count} yield, {open_count} open, {closed_count} closed");
    assert!(yield_count > 1000 && open_count > 1000 && closed_count > 200);
}

/// Several elements on one soil, with and without friction, under random motions.
#[test]
fn coupled_elements_satisfy_the_law() {
    let mut random = Random(12);
    for case in 0..100 {
        let count = random.pick(&[2, 3, 5]);
        let law = SettlingLaw::random(&mut random);
        let friction = random.pick(&[0.0, 0.4, 0.8]);
        // G Gᵀ and a diagonal: symmetric, positive definite, normal and tangential coupled.
        let size = 2 * count;
        let root: Vec<f64> = (0..size * size).map(|_| random.within(-0.5, 0.5)).collect();
        let scale = random.log_within(0.1, 10.0) * law.reference_settlement / law.initial_capacity;
        let mut delassus = vec![0.0; size * size];
        for i in 0..size {
            for j in 0..size {
                let product: f64 = (0..size).map(|k| root[i * size + k] * root[j * size + k]).sum();
                delassus[i * size + j] = scale * (product / size as f64);
            }
            delassus[i * size + i] += scale;
        }
        let interface = Box::new(law.cyclic_yielding(friction));
        let mut problem = ContactProblem::new(delassus.clone(), vec![interface]).unwrap();
        let initial_contact = PreviousContact::new(ContactState::default(), Mode::Open, 0.1);
        let mut start = problem.start(&vec![initial_contact; count]).unwrap();
        let mut free_jump = vec![0.0; size];
        for step in 0..20 {
            for jump in &mut free_jump {
                *jump += random.within(-1.3, 1.0) * law.reference_settlement;
            }
            let states: Vec<SettlingState> = start
                .iter()
                .map(|element| SettlingState {
                    level: element.state_variables[0],
                    threshold: element.state_variables[1],
                })
                .collect();
            let solution = problem.solve(&free_jump, &start).unwrap();
            for (e, state) in states.iter().enumerate() {
                let contact = &solution.states[e];
                let violation = law.violation(state, contact.pressure, contact.gap);
                assert!(violation < 1e-7, "{case}, {step}: {contact:?} {state:?} {law:?}");
                let excess_shear = contact.shear.abs() - friction * contact.pressure;
                assert!(excess_shear < 1e-9 * law.initial_capacity, "{case}, {step}: {contact:?}");
                // The jump is that of the tractions.
                let row = &delassus[e * size..][..size];
                let elastic_displacement: f64 =
                    row.iter().zip(solution.traction).map(|(w, t)| w * t).sum();
                let gap = free_jump[e] + elastic_displacement;
                assert!((contact.gap - gap).abs() < 1e-9 * scale.max(gap.abs()), "{case}");
            }
            solution.commit(&mut start).unwrap();
        }
    }
}

#[test]
fn impossible_parameters_are_errors() {
    for (pressure, settlement, friction) in [
        (0.0, 1e-3, 0.5),
        (f64::INFINITY, 1e-3, 0.5),
        (1e5, -1e-3, 0.5),
        (1e5, f64::NAN, 0.5),
        (1e5, f64::INFINITY, 0.5),
        (1e5, 1e-3, -0.5),
    ] {
        assert!(CyclicYielding::new(pressure, settlement, friction).is_err());
    }
    let law = CyclicYielding::new(1e5, 1e-3, 0.5).unwrap();
    for range in [0.0, -0.1, 1.1, f64::NAN] {
        assert!(law.with_elastic_range(range).is_err());
    }
    for gradient in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(law.with_depth_gradient(gradient).is_err());
    }
}
