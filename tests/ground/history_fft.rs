//! GOAL: the relaxed FFT history is the direct sum, and its memory is what it says.
//! SCENE: by pairs and by wavenumbers, leaves of several lengths, any tractions.
//! REFERENCE: the direct history.

use std::sync::Arc;

use basemat::bem::{ContactElement, ElasticGround, Grading, Ground, PatchKernel, Strip};
use basemat::history::{
    ConvolutionHistory, ConvolutionWeights, DirectHistory, HistoryMethod, RelaxedFftHistory,
};
use basemat::{Error, Soil, unobserved};
use proptest::prelude::*;

fn kernel(elements: Vec<ContactElement>, time_step: f64) -> Arc<dyn ConvolutionWeights> {
    let soil = Soil::new(80.0e6, 1.0 / 3.0, 1900.0).unwrap();
    Arc::new(PatchKernel::new(soil, elements, time_step).unwrap())
}

fn strip(range: std::ops::Range<f64>, count: usize, grading: Grading) -> Vec<ContactElement> {
    Strip::new(range, count, grading).unwrap().elements()
}

/// Tractions without any regularity.
fn noise(step: usize, traction: &mut [f64]) {
    for (i, value) in traction.iter_mut().enumerate() {
        *value = 1e5 * (1e4 * (1.7 + (3 * step + 7 * i) as f64).sin()).sin() + 3e4;
    }
}

/// The three kinds of relaxed history: by pairs, by wavenumbers, and by its own choice.
fn makes(kernel: &Arc<dyn ConvolutionWeights>) -> [RelaxedFftHistory; 3] {
    let new = || RelaxedFftHistory::new(Arc::clone(kernel));
    [new(), new().with_surface_transform(false), new().with_surface_transform(true)]
}

/// Largest difference from the direct sum over a march, relative to the largest value, for each
/// way to make the history.
fn difference(kernel: &Arc<dyn ConvolutionWeights>, steps: usize, reserved: usize) -> [f64; 3] {
    let size = 2 * kernel.classes().elements().len();
    let mut direct = DirectHistory::new(Arc::clone(kernel));
    let mut all = makes(kernel);
    direct.prepare(steps, &mut unobserved).unwrap();
    for relaxed in &mut all {
        relaxed.prepare(reserved, &mut unobserved).unwrap();
    }
    let (mut a, mut b) = (vec![f64::NAN; size], vec![f64::NAN; size]);
    let (mut largest, mut worst) = (0.0_f64, [0.0_f64; 3]);
    let mut traction = vec![0.0; size];
    for step in 0..steps {
        direct.evaluate(&mut a).unwrap();
        noise(step, &mut traction);
        direct.push(&traction);
        for (relaxed, worst) in all.iter_mut().zip(&mut worst) {
            b.fill(f64::NAN);
            relaxed.evaluate(&mut b).unwrap();
            for (a, b) in a.iter().zip(&b) {
                assert!(b.is_finite(), "step {step}: {b}");
                largest = largest.max(a.abs());
                *worst = worst.max((a - b).abs());
            }
            relaxed.push(&traction);
            assert_eq!(direct.steps(), relaxed.steps());
        }
    }
    assert!(largest > 0.0, "nothing to compare");
    worst.map(|worst| worst / largest)
}

#[test]
fn equals_the_direct_sum() {
    let two = || {
        let mut elements = strip(-4.0..-1.0, 3, Grading::Uniform);
        elements.extend(strip(1.0..5.0, 2, Grading::Cosine));
        elements
    };
    // Equal elements with a gap of whole elements between them, and with one that is not.
    let apart = |gap: f64| {
        let mut elements = strip(-2.0..1.0, 6, Grading::Uniform);
        elements.extend(strip(1.0 + gap..3.0 + gap, 4, Grading::Uniform));
        elements
    };
    // Time steps so short that the coupling reaches over several blocks, and so long that it
    // hardly leaves the first step.
    for (name, elements, time_step, steps, reserved) in [
        ("one element", strip(-1.0..1.0, 1, Grading::Uniform), 2e-3, 500, 500),
        ("uniform", strip(-5.0..5.0, 10, Grading::Uniform), 2e-3, 1500, 1500),
        ("uniform, long coupling", strip(-5.0..5.0, 5, Grading::Uniform), 2.5e-4, 2100, 2100),
        ("uniform, short coupling", strip(-5.0..5.0, 6, Grading::Uniform), 3e-2, 700, 700),
        ("uniform, many elements", strip(0.0..23.0, 23, Grading::Uniform), 1.5e-3, 1300, 1300),
        ("graded", strip(-5.0..5.0, 5, Grading::Cosine), 1e-3, 1201, 1201),
        ("two strips", two(), 8e-4, 999, 999),
        ("two strips on one lattice", apart(1.5), 8e-4, 1111, 300),
        ("two strips off any lattice", apart(1.4), 8e-4, 700, 700),
        ("nothing reserved", strip(-5.0..5.0, 3, Grading::Uniform), 5e-4, 1300, 0),
        ("beyond what is reserved", two(), 3e-4, 1111, 130),
        ("hint much too large", strip(-5.0..5.0, 3, Grading::Uniform), 5e-4, 150, 4000),
    ] {
        let found = difference(&kernel(elements, time_step), steps, reserved);
        println!("{name}: {found:?}");
        assert!(found.iter().all(|x| *x < 1e-12), "{name}: {found:?} of the largest value");
    }
}

#[test]
fn long_march() {
    let found = difference(&kernel(strip(0.0..2.0, 2, Grading::Uniform), 1e-3), 10_000, 5_000);
    println!("10 000 steps: {found:?}");
    assert!(found.iter().all(|x| *x < 1e-12), "{found:?} of the largest value");
}

#[test]
fn evaluating_changes_nothing() {
    let kernel = kernel(strip(-5.0..5.0, 4, Grading::Uniform), 5e-4);
    for waves in [false, true] {
        evaluating_changes_nothing_of(
            RelaxedFftHistory::new(Arc::clone(&kernel)).with_surface_transform(waves),
            RelaxedFftHistory::new(Arc::clone(&kernel)).with_surface_transform(waves),
        );
    }
}

fn evaluating_changes_nothing_of(mut often: RelaxedFftHistory, mut seldom: RelaxedFftHistory) {
    let (mut a, mut b, mut traction) = ([0.0; 8], [1e9; 8], [0.0; 8]);
    for step in 0..400 {
        for _ in 0..step % 3 {
            a.fill(f64::NAN);
            often.evaluate(&mut a).unwrap();
            often.evaluate(&mut b).unwrap();
            assert_eq!(a, b, "step {step}");
        }
        noise(step, &mut traction);
        often.push(&traction);
        seldom.push(&traction);
    }
    often.evaluate(&mut a).unwrap();
    seldom.evaluate(&mut b).unwrap();
    assert_eq!(a, b);
    assert!(a.iter().all(|value| *value != 0.0));
}

#[test]
fn lengths() {
    let kernel = kernel(strip(-1.0..1.0, 2, Grading::Uniform), 1e-3);
    for mut history in makes(&kernel) {
        let mut start = [f64::NAN; 4];
        history.evaluate(&mut start).unwrap();
        assert_eq!(start, [0.0; 4]);
        for length in [0, 3, 5] {
            let found = history.evaluate(&mut vec![0.0; length]).unwrap_err();
            assert!(matches!(found, Error::Size { found, needed: 4, .. } if found == length));
        }
        // Missing entries count as zero, others are ignored.
        let mut direct = DirectHistory::new(Arc::clone(&kernel));
        let (mut a, mut b) = ([0.0; 4], [0.0; 4]);
        for traction in [&[1.0, 2.0][..], &[], &[0.0, 1.0, 3.0], &[0.0, 1.0, 3.0, 4.0, 5.0]] {
            history.push(traction);
            direct.push(traction);
            history.evaluate(&mut a).unwrap();
            direct.evaluate(&mut b).unwrap();
            let largest = b.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() <= 1e-13 * largest), "{a:?} {b:?}");
        }
    }
}

#[test]
fn fewer_steps_leave_the_memory() {
    let mut history = RelaxedFftHistory::new(kernel(strip(0.0..1.0, 1, Grading::Uniform), 1e-2));
    history.prepare(0, &mut unobserved).unwrap();
    history.prepare(1000, &mut unobserved).unwrap();
    let held = history.memory();
    history.prepare(10, &mut unobserved).unwrap();
    assert_eq!(history.memory(), held);
    for steps in [1 << 40, usize::MAX] {
        let found = history.prepare(steps, &mut unobserved);
        assert!(matches!(found, Err(Error::Memory(_))), "{found:?}");
        assert_eq!(history.memory(), held);
    }
}

/// The headline problem: 54 000 steps, ten elements.
#[test]
fn memory() {
    let elements = strip(-2.286..2.286, 10, Grading::Uniform);
    let mut history = RelaxedFftHistory::new(kernel(elements, 0.577e-3));
    history.prepare(54_000, &mut unobserved).unwrap();
    let held = history.memory();
    println!("{:.1} MB", held as f64 / 1e6);
    assert!(held > 54_000 * 20 * 8 && held < 52_000_000, "{held} bytes");
}

#[test]
fn grounds_with_either_history_agree() {
    let soil = Soil::new(80.0e6, 0.25, 1900.0).unwrap();
    let ground = |history| {
        let ground = ElasticGround::new(soil, Strip::graded(-3.0..3.0, 4).unwrap()).unwrap();
        let mut ground = match history {
            Some(history) => ground.with_history(history).unwrap(),
            None => ground,
        };
        ground.prepare(1e-3, None, &mut unobserved).unwrap();
        ground
    };
    let kinds = [
        Some(HistoryMethod::Direct),
        Some(HistoryMethod::RelaxedFft),
        Some(HistoryMethod::Auto),
        None,
    ];
    let mut grounds = kinds.map(ground);
    let mut traction = [0.0; 8];
    for step in 0..200 {
        let found = grounds.each_mut().map(|ground| {
            let mut displacement = [f64::NAN; 8];
            ground.history(&mut displacement).unwrap();
            displacement
        });
        let largest = found[0].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for other in &found[1..] {
            let close = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-12 * largest;
            assert!(found[0].iter().zip(other).all(close), "step {step}: {found:?}");
        }
        noise(step, &mut traction);
        for ground in &mut grounds {
            ground.commit(&traction);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn any_tractions(
        count in 1_usize..6,
        cosine in any::<bool>(),
        time_step in 1e-4..2e-2,
        reserved in 0_usize..600,
        along_surface in any::<bool>(),
        tractions in prop::collection::vec(prop::collection::vec(-1e6..1e6, 10), 1..500),
    ) {
        let grading = if cosine { Grading::Cosine } else { Grading::Uniform };
        let kernel = kernel(strip(-2.0..3.0, count, grading), time_step);
        let mut direct = DirectHistory::new(Arc::clone(&kernel));
        let mut relaxed = RelaxedFftHistory::new(kernel)
            .with_surface_transform(along_surface);
        relaxed.prepare(reserved, &mut unobserved).unwrap();
        let (mut a, mut b) = (vec![0.0; 2 * count], vec![f64::NAN; 2 * count]);
        let (mut largest, mut worst) = (0.0_f64, 0.0_f64);
        for traction in &tractions {
            direct.push(traction);
            relaxed.push(traction);
            direct.evaluate(&mut a).unwrap();
            relaxed.evaluate(&mut b).unwrap();
            for (a, b) in a.iter().zip(&b) {
                largest = largest.max(a.abs());
                worst = worst.max((a - b).abs());
                prop_assert!(b.is_finite());
            }
        }
        prop_assert!(worst <= 1e-12 * largest, "{worst:e} of {largest:e}");
    }
}
