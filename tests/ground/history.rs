//! GOAL: the direct history is the convolution sum, however its memory grows.
//! SCENE: uniform, graded and double strips, random tractions, runs longer than the reserved memory.
//! REFERENCE: a plain double loop over the influence coefficients.

use std::sync::Arc;

use basemat::bem::{
    ContactElement, ElasticGround, Grading, Ground, InfluenceKernel, PatchKernel, Strip,
};
use basemat::history::{ConvolutionHistory, DirectHistory, HistoryMethod};
use basemat::{Soil, unobserved};

use basemat_problems::random::Random;

/// h = Σ G^{N−m+1} τ^m, every coefficient requested separately.
fn plain_sum(
    kernel: &InfluenceKernel,
    elements: &[ContactElement],
    tractions: &[Vec<f64>],
) -> Vec<f64> {
    let count = elements.len();
    let mut displacement = vec![0.0; 2 * count];
    for (m, traction) in tractions.iter().enumerate() {
        let lag = tractions.len() + 1 - m;
        for (p, receiver) in elements.iter().enumerate() {
            for (q, source) in elements.iter().enumerate() {
                let influence = kernel.coefficients(*receiver, *source, lag).unwrap();
                let pressure = traction[q];
                let shear = traction[count + q];
                displacement[p] += influence.zz * pressure + influence.zx * shear;
                displacement[count + p] += influence.xx * shear - influence.zx * pressure;
            }
        }
    }
    displacement
}

/// Largest difference of direct history and plain sum, relative to the largest displacement.
fn relative_difference(strips: &[Strip], poisson: f64, reserve: usize, steps: usize) -> f64 {
    let soil = Soil::new(8e7, poisson, 2000.0).unwrap();
    let elements: Vec<_> = strips.iter().flat_map(Strip::elements).collect();
    let time_step = 1.5e-3;
    let kernel = InfluenceKernel::new(soil, time_step).unwrap();
    let patch = PatchKernel::new(soil, elements.clone(), time_step).unwrap();
    let mut history = DirectHistory::new(Arc::new(patch));
    history.prepare(reserve, &mut unobserved).unwrap();
    let size = 2 * elements.len();
    let mut random = Random(3);
    let mut displacement = vec![0.0; size];
    let mut tractions: Vec<Vec<f64>> = Vec::new();
    let mut largest_difference = 0.0_f64;
    let mut max_magnitude = 0.0_f64;
    for step in 0..steps {
        assert_eq!(history.steps(), step);
        // An evaluation changes no state, and overwrites the noise in the slice.
        for _ in 0..2 {
            displacement.fill_with(|| random.within(-1e9, 1e9));
            history.evaluate(&mut displacement).unwrap();
        }
        if step % 7 == 0 || step + 3 > steps {
            let expected = plain_sum(&kernel, &elements, &tractions);
            for (computed, expected) in displacement.iter().zip(&expected) {
                largest_difference = largest_difference.max((computed - expected).abs());
                max_magnitude = max_magnitude.max(expected.abs());
            }
        }
        let traction: Vec<f64> = (0..size).map(|_| random.within(-1.0, 1.0)).collect();
        history.push(&traction);
        tractions.push(traction);
    }
    largest_difference / max_magnitude
}

/// GOAL: the direct history is the plain sum, whatever the strips and Poisson's ratio.
#[test]
fn direct_history_is_the_plain_sum() {
    let uniform_strips = [Strip::uniform(-2.0..2.0, 6).unwrap()];
    let graded_strips = [Strip::new(-2.0..2.0, 5, Grading::Cosine).unwrap()];
    let two_strips =
        [Strip::uniform(-4.0..-1.0, 3).unwrap(), Strip::new(0.5..2.0, 3, Grading::Cosine).unwrap()];
    for (name, strips) in
        [("uniform", &uniform_strips[..]), ("graded", &graded_strips), ("two strips", &two_strips)]
    {
        for poisson in [0.0, 1.0 / 3.0, 0.49] {
            let difference = relative_difference(strips, poisson, 100, 100);
            println!("{name}, ν = {poisson}: {difference:e}");
            assert!(difference < 1e-13, "{name}, ν = {poisson}: {difference:e}");
        }
    }
}

/// GOAL: the memory grows beyond the reserved steps.
/// SCENE: at least 64 lags are stored; in 150 steps the memory grows twice, and lags reach the series for late times.
#[test]
fn memory_grows_beyond_what_was_reserved() {
    let strips = [Strip::uniform(-1.0..1.0, 3).unwrap(), Strip::uniform(2.0..3.0, 1).unwrap()];
    for reserve in [0, 10, 63, 149] {
        let difference = relative_difference(&strips, 0.25, reserve, 150);
        println!("{reserve} steps reserved: {difference:e}");
        assert!(difference < 1e-13, "{reserve} steps reserved: {difference:e}");
    }
}

/// History after 200 steps of a ground prepared for `expected_steps`.
fn history_of_random_run(expected_steps: Option<usize>) -> Vec<f64> {
    let soil = Soil::new(8e7, 0.3, 2000.0).unwrap();
    let ground = ElasticGround::new(soil, Strip::uniform(-1.0..1.0, 4).unwrap()).unwrap();
    let mut ground = ground.with_history(HistoryMethod::RelaxedFft).unwrap();
    ground.prepare(2e-3, expected_steps, &mut unobserved).unwrap();
    let mut random = Random(5);
    let mut history = vec![f64::NAN; 8];
    for _ in 0..200 {
        ground.history(&mut history).unwrap();
        let traction: Vec<f64> = (0..8).map(|_| random.within(-1.0, 1.0)).collect();
        ground.commit(&traction);
    }
    history
}

/// GOAL: growth of the memory changes no bit, since the same sums are made in the same order.
#[test]
fn history_does_not_depend_on_the_expected_steps() {
    let expected = history_of_random_run(Some(200));
    assert!(expected.iter().all(|x| x.is_finite()));
    assert_eq!(history_of_random_run(None), expected);
    assert_eq!(history_of_random_run(Some(90)), expected);
}
