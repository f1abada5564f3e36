//! GOAL: the direct history is the convolution sum, however its memory grows.
//! SCENE: uniform, graded and double strips, random tractions, runs longer than what was reserved.
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
                let (pressure, shear) = (traction[q], traction[count + q]);
                displacement[p] += influence.zz * pressure + influence.zx * shear;
                displacement[count + p] += influence.xx * shear - influence.zx * pressure;
            }
        }
    }
    displacement
}

/// Largest difference between both, relative to the largest displacement; noise goes into `out`.
fn difference(strips: &[Strip], poisson: f64, reserve: usize, steps: usize) -> f64 {
    let soil = Soil::new(8e7, poisson, 2000.0).unwrap();
    let elements: Vec<_> = strips.iter().flat_map(Strip::elements).collect();
    let time_step = 1.5e-3;
    let kernel = InfluenceKernel::new(soil, time_step).unwrap();
    let patch = PatchKernel::new(soil, elements.clone(), time_step).unwrap();
    let mut history = DirectHistory::new(Arc::new(patch));
    history.prepare(reserve, &mut unobserved).unwrap();
    let size = 2 * elements.len();
    let mut random = Random(3);
    let mut out = vec![0.0; size];
    let mut tractions: Vec<Vec<f64>> = Vec::new();
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for step in 0..steps {
        assert_eq!(history.steps(), step);
        // Evaluating changes nothing, and what was in the slice does not matter.
        for _ in 0..2 {
            out.fill_with(|| random.within(-1e9, 1e9));
            history.evaluate(&mut out).unwrap();
        }
        if step % 7 == 0 || step + 3 > steps {
            let wanted = plain_sum(&kernel, &elements, &tractions);
            for (a, b) in out.iter().zip(&wanted) {
                worst = worst.max((a - b).abs());
                largest = largest.max(b.abs());
            }
        }
        let traction: Vec<f64> = (0..size).map(|_| random.within(-1.0, 1.0)).collect();
        history.push(&traction);
        tractions.push(traction);
    }
    worst / largest
}

#[test]
fn direct_history_is_the_plain_sum() {
    let uniform = [Strip::uniform(-2.0..2.0, 6).unwrap()];
    let graded = [Strip::new(-2.0..2.0, 5, Grading::Cosine).unwrap()];
    let two =
        [Strip::uniform(-4.0..-1.0, 3).unwrap(), Strip::new(0.5..2.0, 3, Grading::Cosine).unwrap()];
    for (name, strips) in [("uniform", &uniform[..]), ("graded", &graded), ("two strips", &two)] {
        for poisson in [0.0, 1.0 / 3.0, 0.49] {
            let found = difference(strips, poisson, 100, 100);
            println!("{name}, ν = {poisson}: {found:e}");
            assert!(found < 1e-13, "{name}, ν = {poisson}: {found:e}");
        }
    }
}

/// 64 lags are the least that is kept: 150 steps grow twice, and reach the series for late times.
#[test]
fn memory_grows_beyond_what_was_reserved() {
    let strips = [Strip::uniform(-1.0..1.0, 3).unwrap(), Strip::uniform(2.0..3.0, 1).unwrap()];
    for reserve in [0, 10, 63, 149] {
        let found = difference(&strips, 0.25, reserve, 150);
        println!("{reserve} steps reserved: {found:e}");
        assert!(found < 1e-13, "{reserve} steps reserved: {found:e}");
    }
}

/// Growing must not move a bit: the same sums in the same order.
#[test]
fn ground_does_not_depend_on_the_hint() {
    let soil = Soil::new(8e7, 0.3, 2000.0).unwrap();
    let run = |hint: Option<usize>| {
        let ground = ElasticGround::new(soil, Strip::uniform(-1.0..1.0, 4).unwrap()).unwrap();
        let ground = ground.with_history(HistoryMethod::RelaxedFft);
        let mut ground = ground.unwrap();
        ground.prepare(2e-3, hint, &mut unobserved).unwrap();
        let mut random = Random(5);
        let mut out = vec![f64::NAN; 8];
        for _ in 0..200 {
            ground.history(&mut out).unwrap();
            let traction: Vec<f64> = (0..8).map(|_| random.within(-1.0, 1.0)).collect();
            ground.commit(&traction);
        }
        out
    };
    let wanted = run(Some(200));
    assert!(wanted.iter().all(|x| x.is_finite()));
    assert_eq!(run(None), wanted);
    assert_eq!(run(Some(90)), wanted);
}
