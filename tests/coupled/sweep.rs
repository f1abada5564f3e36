//! GOAL: a sweep gives what its cases give alone, and outlives the one that fails.
//! SCENE: five coefficients of friction, one of them negative; kernels shared by cases.
//! REFERENCE: each case alone, to the last bit.

use std::sync::Mutex;

use basemat::bem::{ElasticGround, Grading, Ground, SharedKernels, Strip};
use basemat::coupled::State;
use basemat::interface::Coulomb;
use basemat::sweep::CaseError;
use basemat::sweep::Sweep;
use basemat::{Error, Soil, unobserved};

use basemat_problems::scenes::{SI, block, scene, soil, states};

/// Negative friction is refused.
const FRICTION: [f64; 5] = [0.2, 0.6, -1.0, 0.4, f64::INFINITY];

fn case(index: usize) -> Result<Vec<State>, Error> {
    let law = Coulomb::new(FRICTION[index])?;
    let mut simulation = scene(SI, 0.6).structure(block(SI)).interface(law).build()?;
    Ok(states(&mut simulation, 150))
}

#[test]
fn sweep_is_bitwise_sequential_and_outlives_errors() {
    let progress = Mutex::new(vec![Vec::new(); FRICTION.len()]);
    let mut results = vec![None; FRICTION.len()];
    let sweep = Sweep::new(FRICTION.len())
        .on_progress(|index, fraction| progress.lock().unwrap()[index].push(fraction));
    sweep.run(
        |now| {
            now.report(0.25);
            case(now.index)
        },
        |index, result| assert!(results[index].replace(result).is_none(), "{index} came twice"),
    );
    drop(sweep);
    for (index, result) in results.into_iter().enumerate() {
        match (result.unwrap(), case(index)) {
            (Ok(found), Ok(wanted)) => assert!(found == wanted, "case {index} differs"),
            (Err(found), Err(wanted)) => {
                assert_eq!(found.to_string(), wanted.to_string());
                assert_eq!(index, 2);
            }
            _ => panic!("case {index}: one fails, the other does not"),
        }
    }
    assert_eq!(progress.into_inner().unwrap(), vec![vec![0.25, 1.0]; FRICTION.len()]);
}

/// A case that panics.
fn spoilt(index: usize) -> Result<Vec<State>, Error> {
    assert_ne!(index, 3, "three is too much");
    case(index)
}

#[test]
fn a_case_that_panics_leaves_the_others() {
    let progress = Mutex::new(0);
    let sweep = Sweep::new(FRICTION.len()).on_progress(|_, _| *progress.lock().unwrap() += 1);
    let found = sweep.collect(|now| spoilt(now.index));
    drop(sweep);
    assert_eq!(progress.into_inner().unwrap(), FRICTION.len());
    assert_eq!(found.len(), FRICTION.len());
    for (index, found) in found.into_iter().enumerate() {
        match (index, found) {
            (3, Err(CaseError::Panicked { message })) => {
                assert!(message.contains("three is too much"), "{message}");
            }
            (2, Err(CaseError::Failed(error))) => assert!(matches!(error, Error::Input { .. })),
            (_, Ok(found)) => assert!(found == case(index).unwrap(), "case {index} differs"),
            (_, Err(error)) => panic!("case {index}: {error}"),
        }
    }
}

#[test]
fn an_empty_sweep_ends() {
    Sweep::new(0).run(|_| Ok::<(), ()>(()), |_, _| panic!("there is no case"));
}

/// GOAL: kernels that cases share change nothing, and are held once.
/// SCENE: every case with the kernels of the others, uniform (wavenumbers) and graded (pairs), runs
/// of different lengths in any order.
#[test]
fn shared_kernels_change_no_bit() {
    for grading in [Grading::Uniform, Grading::Cosine] {
        let run = |kernels: &SharedKernels, steps: usize| {
            let strip = Strip::new(-2.0..2.0, 9, grading).unwrap();
            let ground = ElasticGround::new(soil(SI), strip).unwrap();
            let ground = ground.with_shared_kernels(kernels);
            let law = Coulomb::new(0.4).unwrap();
            let scene = scene(SI, 0.6).structure(block(SI)).interface(law).ground(ground);
            states(&mut scene.expected_steps(steps).build().unwrap(), steps)
        };
        let (shared, lengths) = (SharedKernels::default(), [150, 40, 700, 90]);
        let mut results = vec![Vec::new(); lengths.len()];
        Sweep::new(lengths.len()).run(
            |now| Ok::<_, Error>(run(&shared, lengths[now.index])),
            |index, states| results[index] = states.unwrap(),
        );
        assert_eq!(shared.count(), 1);
        for (found, steps) in results.iter().zip(lengths) {
            assert!(*found == run(&SharedKernels::default(), steps), "{grading:?}, {steps} steps");
        }
    }
}

#[test]
fn shared_kernels_are_told_apart_and_bounded() {
    let kernels = SharedKernels::default();
    assert_eq!(kernels.count(), 0);
    let prepare = |modulus: f64, count: usize, step: f64| {
        let soil = Soil::new(modulus, 0.3, 1900.0).unwrap();
        let mut ground = ElasticGround::new(soil, Strip::uniform(-2.0..2.0, count).unwrap())
            .unwrap()
            .with_shared_kernels(&kernels);
        ground.prepare(step, None, &mut unobserved).unwrap();
        let mut matrix = vec![0.0; 4 * count * count];
        ground.step_compliance(&mut matrix).unwrap();
        matrix
    };
    let first = prepare(8e7, 4, 1e-3);
    for other in [prepare(9e7, 4, 1e-3), prepare(8e7, 4, 2e-3), prepare(8e7, 5, 1e-3)] {
        assert_ne!(first, other);
    }
    assert_eq!(first, prepare(8e7, 4, 1e-3));
    assert_eq!(kernels.count(), 4);
    for k in 1..20 {
        prepare(8e7, 4, 1e-3 * f64::from(k));
    }
    assert_eq!(kernels.count(), 8);
}
