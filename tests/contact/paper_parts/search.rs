//! GOAL: the paper's flow chart alone finds the modes of the robust search, or ends in an error.
//! SCENE: sliding blocks under several strengths of shaking, with several coefficients of friction.
//! REFERENCE: the robust search, step by step; an unchanged state after an error.

use basemat::contact::{ContactSearch, SearchMethod};
use basemat::coupled::SimulationBuilder;
use basemat::coupled::StepError;
use basemat::{Error, Result, Simulation};
use basemat_problems::scenes::{SI_UNITS, block, friction, scene};

const FLOW_CHART: ContactSearch = ContactSearch::FlowChart { iterations: 60 };

fn sliding_block(strength: f64, coefficient: f64) -> SimulationBuilder {
    scene(SI_UNITS, strength).structure(block(SI_UNITS)).interface(friction(coefficient))
}

/// Where the flow chart converges it finds the modes of the robust search.
///
/// Where the robust search needs another method, the flow chart fails and the state is unchanged.
#[test]
fn flow_chart_follows_the_robust_search_until_it_cycles() {
    let mut cycling_runs = 0;
    let mut converged_steps = 0;
    for (strength, coefficient) in [(0.5, 0.3), (0.8, 0.7), (1.2, f64::INFINITY), (2.0, 1.0)] {
        let mut robust = sliding_block(strength, coefficient).build().unwrap();
        let mut chart =
            sliding_block(strength, coefficient).contact_search(FLOW_CHART).build().unwrap();
        for step in 1..=500 {
            let state = chart.state().clone();
            robust.step().unwrap();
            if robust.state().method == SearchMethod::ActiveSet {
                assert_eq!(chart.step().unwrap(), robust.state());
                converged_steps += 1;
                continue;
            }
            let error = chart.step().unwrap_err();
            let Error::Step { step: failed_step, source, .. } = &error else {
                panic!("{error}")
            };
            let StepError::Contact { iterations, residual, modes, .. } = source else {
                panic!("{error}")
            };
            assert_eq!(*failed_step, step);
            assert!(*iterations >= 2 && *iterations <= 60, "{error}");
            assert!(*residual > 0.0 && modes.len() == 8);
            assert_eq!(chart.state(), &state);
            cycling_runs += 1;
            break;
        }
    }
    println!("{converged_steps} steps converged, {cycling_runs} runs cycled");
    assert!(converged_steps > 500 && cycling_runs > 0);
}

fn build_with_iterations(iterations: usize) -> Result<Simulation> {
    let search = ContactSearch::FlowChart { iterations };
    sliding_block(0.5, 0.2).contact_search(search).build()
}

#[test]
fn too_few_iterations_are_an_error() {
    let without_iterations = build_with_iterations(0);
    assert!(matches!(without_iterations, Err(Error::Scene { quantity: "contact search", .. })));
    // One solve per step can change no mode.
    let mut simulation = build_with_iterations(1).unwrap();
    let error = simulation.run(500, |_| {}).unwrap_err();
    let Error::Step { source: StepError::Contact { iterations: 1, .. }, .. } = error else {
        panic!("{error}")
    };
    assert!(simulation.state().transitions.is_empty());
}
