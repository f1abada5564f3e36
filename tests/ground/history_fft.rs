//! GOAL: the relaxed FFT history is the direct sum, and its memory is as predicted.
//! SCENE: histories by pairs and by wavenumbers, blocks of several lengths, arbitrary tractions.
//! REFERENCE: the direct history.

use std::sync::Arc;

use basemat::bem::{ContactElement, ElasticGround, Grading, Ground, PatchKernel, Strip};
use basemat::history::{
    ConvolutionHistory, ConvolutionWeights, DirectHistory, HistoryMethod, RelaxedFftHistory,
};
use basemat::{Error, Soil, unobserved};
use proptest::prelude::*;

use basemat_problems::dense::largest;

fn kernel(elements: Vec<ContactElement>, time_step: f64) -> Arc<dyn ConvolutionWeights> {
    let soil = Soil::new(80.0e6, 1.0 / 3.0, 1900.0).unwrap();
    Arc::new(PatchKernel::new(soil, elements, time_step).unwrap())
}

fn strip(range: std::ops::Range<f64>, count: usize, grading: Grading) -> Vec<ContactElement> {
    Strip::new(range, count, grading).unwrap().elements()
}

/// Tractions without any regularity in time and place.
fn noise(step: usize, traction: &mut [f64]) {
    for (i, value) in traction.iter_mut().enumerate() {
        *value = 1e5 * (1e4 * (1.7 + (3 * step + 7 * i) as f64).sin()).sin() + 3e4;
    }
}

fn relaxed(kernel: &Arc<dyn ConvolutionWeights>) -> RelaxedFftHistory {
    RelaxedFftHistory::new(Arc::clone(kernel))
}

/// The three kinds of relaxed history: by its default choice, by pairs, and by wavenumbers.
fn relaxed_histories(kernel: &Arc<dyn ConvolutionWeights>) -> [RelaxedFftHistory; 3] {
    [
        relaxed(kernel),
        relaxed(kernel).with_surface_transform(false),
        relaxed(kernel).with_surface_transform(true),
    ]
}

/// Largest difference from the direct sum over a march, relative to the largest value, for each
/// kind of history.
fn relative_differences(
    kernel: &Arc<dyn ConvolutionWeights>,
    steps: usize,
    reserved: usize,
) -> [f64; 3] {
    let size = 2 * kernel.classes().elements().len();
    let mut direct_history = DirectHistory::new(Arc::clone(kernel));
    let mut histories = relaxed_histories(kernel);
    direct_history.prepare(steps, &mut unobserved).unwrap();
    for relaxed_history in &mut histories {
        relaxed_history.prepare(reserved, &mut unobserved).unwrap();
    }
    let mut expected = vec![f64::NAN; size];
    let mut computed = vec![f64::NAN; size];
    let mut max_magnitude = 0.0_f64;
    let mut differences = [0.0_f64; 3];
    let mut traction = vec![0.0; size];
    for step in 0..steps {
        direct_history.evaluate(&mut expected).unwrap();
        noise(step, &mut traction);
        direct_history.push(&traction);
        for (relaxed_history, difference) in histories.iter_mut().zip(&mut differences) {
            computed.fill(f64::NAN);
            relaxed_history.evaluate(&mut computed).unwrap();
            for (expected, computed) in expected.iter().zip(&computed) {
                assert!(computed.is_finite(), "step {step}: {computed}");
                max_magnitude = max_magnitude.max(expected.abs());
                *difference = difference.max((expected - computed).abs());
            }
            relaxed_history.push(&traction);
            assert_eq!(direct_history.steps(), relaxed_history.steps());
        }
    }
    assert!(max_magnitude > 0.0, "nothing to compare");
    differences.map(|difference| difference / max_magnitude)
}

/// A uniform and a graded strip.
fn two_strips() -> Vec<ContactElement> {
    let mut elements = strip(-4.0..-1.0, 3, Grading::Uniform);
    elements.extend(strip(1.0..5.0, 2, Grading::Cosine));
    elements
}

/// Two strips of elements half a metre long, with a gap between them.
fn strips_with_gap(gap: f64) -> Vec<ContactElement> {
    let mut elements = strip(-2.0..1.0, 6, Grading::Uniform);
    elements.extend(strip(1.0 + gap..3.0 + gap, 4, Grading::Uniform));
    elements
}

/// GOAL: all kinds of relaxed history equal the direct sum.
/// SCENE: time steps so short that the coupling reaches over several blocks, and so long that it
/// hardly leaves the first step; gaps of whole elements and others.
#[test]
fn transforms_equal_the_direct_sum() {
    for (name, elements, time_step, steps, reserved) in [
        ("one element", strip(-1.0..1.0, 1, Grading::Uniform), 2e-3, 500, 500),
        ("uniform", strip(-5.0..5.0, 10, Grading::Uniform), 2e-3, 1500, 1500),
        ("uniform, long coupling", strip(-5.0..5.0, 5, Grading::Uniform), 2.5e-4, 2100, 2100),
        ("uniform, short coupling", strip(-5.0..5.0, 6, Grading::Uniform), 3e-2, 700, 700),
        ("uniform, many elements", strip(0.0..23.0, 23, Grading::Uniform), 1.5e-3, 1300, 1300),
        ("graded", strip(-5.0..5.0, 5, Grading::Cosine), 1e-3, 1201, 1201),
        ("two strips", two_strips(), 8e-4, 999, 999),
        ("two strips on one lattice", strips_with_gap(1.5), 8e-4, 1111, 300),
        ("two strips off any lattice", strips_with_gap(1.4), 8e-4, 700, 700),
        ("nothing reserved", strip(-5.0..5.0, 3, Grading::Uniform), 5e-4, 1300, 0),
        ("beyond what is reserved", two_strips(), 3e-4, 1111, 130),
        ("far more reserved", strip(-5.0..5.0, 3, Grading::Uniform), 5e-4, 150, 4000),
    ] {
        let differences = relative_differences(&kernel(elements, time_step), steps, reserved);
        println!("{name}: {differences:?}");
        assert!(differences.iter().all(|x| *x < 1e-12), "{name}: {differences:?}");
    }
}

/// GOAL: the difference from the direct sum does not accumulate over a long march.
#[test]
fn differences_do_not_accumulate_in_a_long_march() {
    let kernel = kernel(strip(0.0..2.0, 2, Grading::Uniform), 1e-3);
    let differences = relative_differences(&kernel, 10_000, 5_000);
    println!("10 000 steps: {differences:?}");
    assert!(differences.iter().all(|x| *x < 1e-12), "{differences:?}");
}

/// GOAL: evaluation does not change the state of the history.
#[test]
fn evaluating_changes_nothing() {
    let kernel = kernel(strip(-5.0..5.0, 4, Grading::Uniform), 5e-4);
    for along_surface in [false, true] {
        check_evaluation_keeps_state(
            relaxed(&kernel).with_surface_transform(along_surface),
            relaxed(&kernel).with_surface_transform(along_surface),
        );
    }
}

/// Compares a history that is evaluated in between with one that is evaluated at the end.
fn check_evaluation_keeps_state(
    mut evaluated_history: RelaxedFftHistory,
    mut pushed_history: RelaxedFftHistory,
) {
    let mut first = [0.0; 8];
    let mut second = [1e9; 8];
    let mut traction = [0.0; 8];
    for step in 0..400 {
        for _ in 0..step % 3 {
            first.fill(f64::NAN);
            evaluated_history.evaluate(&mut first).unwrap();
            evaluated_history.evaluate(&mut second).unwrap();
            assert_eq!(first, second, "step {step}");
        }
        noise(step, &mut traction);
        evaluated_history.push(&traction);
        pushed_history.push(&traction);
    }
    evaluated_history.evaluate(&mut first).unwrap();
    pushed_history.evaluate(&mut second).unwrap();
    assert_eq!(first, second);
    assert!(first.iter().all(|value| *value != 0.0));
}

/// GOAL: displacements of a wrong length are errors; tractions are padded by zeros or cut.
#[test]
fn wrong_lengths_are_errors_and_tractions_are_padded() {
    let kernel = kernel(strip(-1.0..1.0, 2, Grading::Uniform), 1e-3);
    for mut history in relaxed_histories(&kernel) {
        let mut start = [f64::NAN; 4];
        history.evaluate(&mut start).unwrap();
        assert_eq!(start, [0.0; 4]);
        for length in [0, 3, 5] {
            let error = history.evaluate(&mut vec![0.0; length]).unwrap_err();
            assert!(matches!(error, Error::Size { found, needed: 4, .. } if found == length));
        }
        // Missing entries count as zero, others are ignored.
        let mut direct_history = DirectHistory::new(Arc::clone(&kernel));
        let mut a = [0.0; 4];
        let mut b = [0.0; 4];
        for traction in [&[1.0, 2.0][..], &[], &[0.0, 1.0, 3.0], &[0.0, 1.0, 3.0, 4.0, 5.0]] {
            history.push(traction);
            direct_history.push(traction);
            history.evaluate(&mut a).unwrap();
            direct_history.evaluate(&mut b).unwrap();
            let limit = 1e-13 * largest(&b);
            assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() <= limit), "{a:?} {b:?}");
        }
    }
}

/// GOAL: preparation for fewer steps does not release memory, and impossible sizes are errors.
#[test]
fn fewer_steps_leave_the_memory() {
    let mut history = RelaxedFftHistory::new(kernel(strip(0.0..1.0, 1, Grading::Uniform), 1e-2));
    history.prepare(0, &mut unobserved).unwrap();
    history.prepare(1000, &mut unobserved).unwrap();
    let memory = history.memory();
    history.prepare(10, &mut unobserved).unwrap();
    assert_eq!(history.memory(), memory);
    for steps in [1 << 40, usize::MAX] {
        let result = history.prepare(steps, &mut unobserved);
        assert!(matches!(result, Err(Error::Memory(_))), "{result:?}");
        assert_eq!(history.memory(), memory);
    }
}

/// GOAL: the headline problem, 54 000 steps of ten elements, needs less than 52 MB.
#[test]
fn memory_of_the_headline_problem_is_bounded() {
    let elements = strip(-2.286..2.286, 10, Grading::Uniform);
    let mut history = RelaxedFftHistory::new(kernel(elements, 0.577e-3));
    history.prepare(54_000, &mut unobserved).unwrap();
    let memory = history.memory();
    println!("{:.1} MB", memory as f64 / 1e6);
    assert!(memory > 54_000 * 20 * 8 && memory < 52_000_000, "{memory} bytes");
}

/// A ground with this history, or the default, prepared for steps of 1 ms.
fn prepared_ground(history: Option<HistoryMethod>) -> ElasticGround {
    let soil = Soil::new(80.0e6, 0.25, 1900.0).unwrap();
    let ground = ElasticGround::new(soil, Strip::graded(-3.0..3.0, 4).unwrap()).unwrap();
    let mut ground = match history {
        Some(history) => ground.with_history(history).unwrap(),
        None => ground,
    };
    ground.prepare(1e-3, None, &mut unobserved).unwrap();
    ground
}

/// GOAL: grounds have the same response with every method of the history.
#[test]
fn grounds_with_either_history_agree() {
    let mut grounds = [
        Some(HistoryMethod::Direct),
        Some(HistoryMethod::RelaxedFft),
        Some(HistoryMethod::Auto),
        None,
    ]
    .map(prepared_ground);
    let mut traction = [0.0; 8];
    for step in 0..200 {
        let displacements = grounds.each_mut().map(|ground| {
            let mut displacement = [f64::NAN; 8];
            ground.history(&mut displacement).unwrap();
            displacement
        });
        let limit = 1e-12 * largest(&displacements[0]);
        for displacement in &displacements[1..] {
            for (a, b) in displacements[0].iter().zip(displacement) {
                assert!((a - b).abs() <= limit, "step {step}: {displacements:?}");
            }
        }
        noise(step, &mut traction);
        for ground in &mut grounds {
            ground.commit(&traction);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// GOAL: the relaxed history is the direct sum for arbitrary strips and tractions.
    #[test]
    fn any_tractions_have_the_direct_sum(
        count in 1_usize..6,
        cosine in any::<bool>(),
        time_step in 1e-4..2e-2,
        reserved in 0_usize..600,
        along_surface in any::<bool>(),
        tractions in prop::collection::vec(prop::collection::vec(-1e6..1e6, 10), 1..500),
    ) {
        let grading = if cosine { Grading::Cosine } else { Grading::Uniform };
        let kernel = kernel(strip(-2.0..3.0, count, grading), time_step);
        let mut direct_history = DirectHistory::new(Arc::clone(&kernel));
        let mut relaxed_history = RelaxedFftHistory::new(kernel)
            .with_surface_transform(along_surface);
        relaxed_history.prepare(reserved, &mut unobserved).unwrap();
        let mut expected = vec![0.0; 2 * count];
        let mut computed = vec![f64::NAN; 2 * count];
        let mut max_magnitude = 0.0_f64;
        let mut difference = 0.0_f64;
        for traction in &tractions {
            direct_history.push(traction);
            relaxed_history.push(traction);
            direct_history.evaluate(&mut expected).unwrap();
            relaxed_history.evaluate(&mut computed).unwrap();
            for (expected, computed) in expected.iter().zip(&computed) {
                max_magnitude = max_magnitude.max(expected.abs());
                difference = difference.max((expected - computed).abs());
                prop_assert!(computed.is_finite());
            }
        }
        prop_assert!(difference <= 1e-12 * max_magnitude, "{difference:e} of {max_magnitude:e}");
    }
}
