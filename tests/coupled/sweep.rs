//! GOAL: a sweep gives the results of its cases alone, also after a case that fails.
//! SCENE: five coefficients of friction, one of them negative; kernels shared by cases.
//! REFERENCE: each case alone, to the last bit.

use std::sync::Mutex;

use basemat::bem::{ElasticGround, Grading, Ground, SharedKernels, Strip};
use basemat::coupled::State;
use basemat::interface::Coulomb;
use basemat::sweep::CaseError;
use basemat::sweep::Sweep;
use basemat::{Error, Soil, unobserved};

use basemat_problems::scenes::{SI_UNITS, block, scene, soil, states};

/// Coefficients of friction by case, of which the negative one is an error.
const FRICTION_COEFFICIENTS: [f64; 5] = [0.2, 0.6, -1.0, 0.4, f64::INFINITY];

fn run_case(index: usize) -> Result<Vec<State>, Error> {
    let law = Coulomb::new(FRICTION_COEFFICIENTS[index])?;
    let mut simulation = scene(SI_UNITS, 0.6).structure(block(SI_UNITS)).interface(law).build()?;
    Ok(states(&mut simulation, 150))
}

#[test]
fn sweep_has_the_bits_of_its_cases_and_continues_after_errors() {
    let count = FRICTION_COEFFICIENTS.len();
    let progress = Mutex::new(vec![Vec::new(); count]);
    let mut results = vec![None; count];
    let sweep = Sweep::new(count)
        .on_progress(|index, fraction| progress.lock().unwrap()[index].push(fraction));
    sweep.run(
        |case| {
            case.report(0.25);
            run_case(case.index)
        },
        |index, result| assert!(results[index].replace(result).is_none(), "{index} came twice"),
    );
    drop(sweep);
    for (index, result) in results.into_iter().enumerate() {
        match (result.unwrap(), run_case(index)) {
            (Ok(computed), Ok(expected)) => assert!(computed == expected, "case {index} differs"),
            (Err(computed), Err(expected)) => {
                assert_eq!(computed.to_string(), expected.to_string());
                assert_eq!(index, 2);
            }
            _ => panic!("case {index}: one fails, the other does not"),
        }
    }
    assert_eq!(progress.into_inner().unwrap(), vec![vec![0.25, 1.0]; count]);
}

/// Runs a case unless it is the fourth, which panics.
fn run_or_panic(index: usize) -> Result<Vec<State>, Error> {
    assert_ne!(index, 3, "three is too much");
    run_case(index)
}

#[test]
fn a_case_that_panics_does_not_stop_the_others() {
    let count = FRICTION_COEFFICIENTS.len();
    let progress = Mutex::new(0);
    let sweep = Sweep::new(count).on_progress(|_, _| *progress.lock().unwrap() += 1);
    let results = sweep.collect(|case| run_or_panic(case.index));
    drop(sweep);
    assert_eq!(progress.into_inner().unwrap(), count);
    assert_eq!(results.len(), count);
    for (index, result) in results.into_iter().enumerate() {
        match (index, result) {
            (3, Err(CaseError::Panicked { message })) => {
                assert!(message.contains("three is too much"), "{message}");
            }
            (2, Err(CaseError::Failed(error))) => assert!(matches!(error, Error::Input { .. })),
            (_, Ok(states)) => assert!(states == run_case(index).unwrap(), "case {index} differs"),
            (_, Err(error)) => panic!("case {index}: {error}"),
        }
    }
}

#[test]
fn an_empty_sweep_ends() {
    Sweep::new(0).run(|_| Ok::<(), ()>(()), |_, _| panic!("there is no case"));
}

/// Runs a block for so many steps with shared kernels.
fn run_with_kernels(grading: Grading, kernels: &SharedKernels, steps: usize) -> Vec<State> {
    let strip = Strip::new(-2.0..2.0, 9, grading).unwrap();
    let ground = ElasticGround::new(soil(SI_UNITS), strip).unwrap();
    let ground = ground.with_shared_kernels(kernels);
    let law = Coulomb::new(0.4).unwrap();
    let scene = scene(SI_UNITS, 0.6).structure(block(SI_UNITS)).interface(law).ground(ground);
    states(&mut scene.expected_steps(steps).build().unwrap(), steps)
}

/// GOAL: kernels that cases share change no result, and are stored once.
/// SCENE: every case with the kernels of the others, uniform (wavenumbers) and graded (pairs), runs
/// of different lengths in any order.
#[test]
fn shared_kernels_change_no_bit() {
    for grading in [Grading::Uniform, Grading::Cosine] {
        let kernels = SharedKernels::default();
        let step_counts = [150, 40, 700, 90];
        let mut results = vec![Vec::new(); step_counts.len()];
        Sweep::new(step_counts.len()).run(
            |case| Ok::<_, Error>(run_with_kernels(grading, &kernels, step_counts[case.index])),
            |index, states| results[index] = states.unwrap(),
        );
        assert_eq!(kernels.count(), 1);
        for (states, steps) in results.iter().zip(step_counts) {
            let expected = run_with_kernels(grading, &SharedKernels::default(), steps);
            assert!(*states == expected, "{grading:?}, {steps} steps");
        }
    }
}

/// Step compliance of a ground of this shear modulus with shared kernels.
fn step_compliance(
    kernels: &SharedKernels,
    shear_modulus: f64,
    elements: usize,
    time_step: f64,
) -> Vec<f64> {
    let soil = Soil::new(shear_modulus, 0.3, 1900.0).unwrap();
    let mut ground = ElasticGround::new(soil, Strip::uniform(-2.0..2.0, elements).unwrap())
        .unwrap()
        .with_shared_kernels(kernels);
    ground.prepare(time_step, None, &mut unobserved).unwrap();
    let mut matrix = vec![0.0; 4 * elements * elements];
    ground.step_compliance(&mut matrix).unwrap();
    matrix
}

#[test]
fn shared_kernels_are_distinguished_and_bounded() {
    let kernels = SharedKernels::default();
    assert_eq!(kernels.count(), 0);
    let first = step_compliance(&kernels, 8e7, 4, 1e-3);
    for (shear_modulus, elements, time_step) in [(9e7, 4, 1e-3), (8e7, 4, 2e-3), (8e7, 5, 1e-3)] {
        assert_ne!(first, step_compliance(&kernels, shear_modulus, elements, time_step));
    }
    assert_eq!(first, step_compliance(&kernels, 8e7, 4, 1e-3));
    assert_eq!(kernels.count(), 4);
    for k in 1..20 {
        step_compliance(&kernels, 8e7, 4, 1e-3 * f64::from(k));
    }
    assert_eq!(kernels.count(), 8);
}
