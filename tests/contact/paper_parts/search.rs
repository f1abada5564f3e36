//! GOAL: the paper's flow chart alone finds the modes of the robust search, or ends in an error.
//! SCENE: sliding blocks of several strengths and coefficients of friction.
//! REFERENCE: the robust search, step by step; an unchanged state after an error.

use basemat::Error;
use basemat::contact::{ContactSearch, SearchMethod};
use basemat::coupled::SimulationBuilder;
use basemat::coupled::StepError;
use basemat_problems::scenes::{SI, block, friction, scene};

const CHART: ContactSearch = ContactSearch::FlowChart { iterations: 60 };

fn sliding(strength: f64, coefficient: f64) -> SimulationBuilder {
    scene(SI, strength).structure(block(SI)).interface(friction(coefficient))
}

/// Where the flow chart settles it finds what the robust search finds, step by step; where the
/// robust search needed more, the flow chart is an error and the simulation stays where it was.
#[test]
fn flow_chart_follows_the_robust_search_until_it_cycles() {
    let (mut cycled, mut settled) = (0, 0);
    for (strength, coefficient) in [(0.5, 0.3), (0.8, 0.7), (1.2, f64::INFINITY), (2.0, 1.0)] {
        let mut robust = sliding(strength, coefficient).build().unwrap();
        let mut chart = sliding(strength, coefficient).contact_search(CHART).build().unwrap();
        for step in 1..=500 {
            let before = chart.state().clone();
            robust.step().unwrap();
            if robust.state().method == SearchMethod::ActiveSet {
                assert_eq!(chart.step().unwrap(), robust.state());
                settled += 1;
                continue;
            }
            let error = chart.step().unwrap_err();
            let Error::Step { step: failed, source, .. } = &error else { panic!("{error}") };
            let StepError::Contact { iterations, residual, modes, .. } = source else {
                panic!("{error}")
            };
            assert_eq!(*failed, step);
            assert!(*iterations >= 2 && *iterations <= 60, "{error}");
            assert!(*residual > 0.0 && modes.len() == 8);
            assert_eq!(chart.state(), &before);
            cycled += 1;
            break;
        }
    }
    println!("{settled} steps settled, {cycled} runs cycled");
    assert!(settled > 500 && cycled > 0);
}

#[test]
fn too_few_iterations_are_an_error() {
    let chart = |iterations| {
        sliding(0.5, 0.2).contact_search(ContactSearch::FlowChart { iterations }).build()
    };
    assert!(matches!(chart(0), Err(Error::Scene { quantity: "contact search", .. })));
    // One solve per step can change no mode.
    let mut simulation = chart(1).unwrap();
    let error = simulation.run(500, |_| {}).unwrap_err();
    let Error::Step { source: StepError::Contact { iterations: 1, .. }, .. } = error else {
        panic!("{error}")
    };
    assert!(simulation.state().transitions.is_empty());
}
