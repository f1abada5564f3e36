//! GOAL: where steps have no solution, the longest step is found that gets a scene through.
//! SCENE: a block on a law that is never content with steps longer than some limit.
//! REFERENCE: the limit.

use basemat::analyses::largest_convergent_step;
use basemat::bem::SpringGround;
use basemat::coupled::StepError;
use basemat::interface::{Coulomb, InPlane, Mode, PreviousContact};
use basemat::motion::el_centro_1940;
use basemat::structure::RigidBlock;
use basemat::{Error, Result, Simulation};

use basemat_problems::wrapped::Wayward;

/// Coulomb's law in steps of length `limit` (s) or shorter ones; in others always for another mode.
fn scene(step: f64, limit: f64) -> Result<Simulation> {
    let next = move |mode: Mode, start: &PreviousContact, next: Mode| match mode {
        _ if start.time_step <= limit => next,
        Mode::Open => Mode::Stick,
        _ => Mode::Open,
    };
    Simulation::builder(step)
        .structure(RigidBlock::new(4.0, 6.0, 2000.0)?)
        .ground(SpringGround::new(-2.0..2.0, 3, 8e7, 4e7)?)
        .interface(InPlane(Wayward { law: Coulomb::new(0.5)?, next }))
        .motion(el_centro_1940())
        .build()
}

#[test]
fn the_longest_step_that_gets_through_is_found() {
    let error = scene(0.02, 0.003).unwrap().run(10, |_| {}).map(|_| ()).unwrap_err();
    assert!(matches!(error, Error::Step { source: StepError::Contact { .. }, .. }), "{error}");
    assert!(error.to_string().contains("`analyses::largest_convergent_step`"), "{error}");
    for (limit, wanted) in [(0.02, Some(0.02)), (0.003, Some(0.0025)), (1e-6, None)] {
        let mut tried = 0;
        let found = largest_convergent_step(0.02, 0.1, |step| {
            tried += 1;
            scene(step, limit)
        });
        assert_eq!(found, Ok(wanted), "{limit}");
        assert_eq!(
            tried,
            if wanted.is_none() {
                11
            } else if limit < 0.02 {
                4
            } else {
                1
            }
        );
    }
}

#[test]
fn other_failures_are_handed_on() {
    for (step, duration) in [(f64::NAN, 1.0), (0.0, 1.0), (0.01, -1.0), (0.01, f64::INFINITY)] {
        assert!(largest_convergent_step(step, duration, |step| scene(step, 1.0)).is_err());
    }
    let reason = || Error::part("my scene", "no");
    assert_eq!(largest_convergent_step(0.01, 1.0, |_| Err(reason())), Err(reason()));
}
