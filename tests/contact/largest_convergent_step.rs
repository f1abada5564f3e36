//! GOAL: where steps have no solution, the longest time step is found with which a run completes.
//! SCENE: a block on a law that accepts no mode in steps longer than some limit.
//! REFERENCE: the limit.

use basemat::analyses::largest_convergent_step;
use basemat::bem::SpringGround;
use basemat::coupled::StepError;
use basemat::interface::{Coulomb, InPlane, Mode, PreviousContact};
use basemat::motion::el_centro_1940;
use basemat::structure::RigidBlock;
use basemat::{Error, Result, Simulation};

use basemat_problems::wrapped::LawWithNextMode;

/// A block on Coulomb's law, which accepts no mode in steps longer than `limit` (s).
fn block_with_step_limit(time_step: f64, limit: f64) -> Result<Simulation> {
    let next_mode = move |mode: Mode, start: &PreviousContact, law_mode: Mode| match mode {
        _ if start.time_step <= limit => law_mode,
        Mode::Open => Mode::Stick,
        _ => Mode::Open,
    };
    Simulation::builder(time_step)
        .structure(RigidBlock::new(4.0, 6.0, 2000.0)?)
        .ground(SpringGround::new(-2.0..2.0, 3, 8e7, 4e7)?)
        .interface(InPlane(LawWithNextMode { law: Coulomb::new(0.5)?, next: next_mode }))
        .motion(el_centro_1940())
        .build()
}

#[test]
fn the_longest_step_of_a_complete_run_is_found() {
    let error =
        block_with_step_limit(0.02, 0.003).unwrap().run(10, |_| {}).map(|_| ()).unwrap_err();
    assert!(matches!(error, Error::Step { source: StepError::Contact { .. }, .. }), "{error}");
    assert!(error.to_string().contains("`analyses::largest_convergent_step`"), "{error}");
    for (limit, expected, expected_runs) in
        [(0.02, Some(0.02), 1), (0.003, Some(0.0025), 4), (1e-6, None, 11)]
    {
        let mut runs = 0;
        let computed = largest_convergent_step(0.02, 0.1, |time_step| {
            runs += 1;
            block_with_step_limit(time_step, limit)
        });
        assert_eq!(computed, Ok(expected), "{limit}");
        assert_eq!(runs, expected_runs, "{limit}");
    }
}

#[test]
fn other_errors_are_returned() {
    for (time_step, duration) in [(f64::NAN, 1.0), (0.0, 1.0), (0.01, -1.0), (0.01, f64::INFINITY)]
    {
        let result = largest_convergent_step(time_step, duration, |time_step| {
            block_with_step_limit(time_step, 1.0)
        });
        assert!(result.is_err());
    }
    let error = Error::part("my scene", "no");
    assert_eq!(largest_convergent_step(0.01, 1.0, |_| Err(error.clone())), Err(error));
}
