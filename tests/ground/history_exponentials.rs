//! GOAL: the history by exponentials keeps its tolerance and passivity, and bounds its own error.
//! SCENE: uniform, graded and double strips over c₁Δt/l and ν, random tractions and pulses.
//! REFERENCE: the direct sum, its work, and the coefficients themselves.

use std::sync::Arc;

use basemat::bem::{ContactElement, ElasticGround, Grading, Ground, PatchKernel, Strip};
use basemat::history::{
    ConvolutionHistory, ConvolutionWeights, DirectHistory, ExponentialHistory, HistoryMethod,
    HistoryOptions,
};
use basemat::{Error, MemoryError, Soil, unobserved};

use basemat_problems::heavy;
use basemat_problems::passivity::Scene;
use basemat_problems::random::Random;

/// A strip of length 2 with soil of unit modulus and density, β = c₁Δt over the mean element.
fn kernel(poisson: f64, beta: f64, elements: Vec<ContactElement>) -> Arc<dyn ConvolutionWeights> {
    let soil = Soil::new(1.0, poisson, 1.0).unwrap();
    let length = 2.0 / elements.len() as f64;
    let step = beta * length / soil.pressure_wave_speed();
    Arc::new(PatchKernel::new(soil, elements, step).unwrap())
}

fn strip(count: usize, grading: Grading) -> Vec<ContactElement> {
    Strip::new(-1.0..1.0, count, grading).unwrap().elements()
}

fn two_strips() -> Vec<ContactElement> {
    let mut elements = Strip::uniform(-1.0..-0.5, 2).unwrap().elements();
    elements.extend(Strip::new(0.0..1.0, 3, Grading::Cosine).unwrap().elements());
    elements
}

/// Results of a march in parallel with the direct sum.
struct March {
    /// Largest difference over the largest displacement.
    difference: f64,
    /// Largest change of a difference over a step, over what was promised.
    increment: f64,
    /// Difference of the works done, over what was promised, and what was promised over the work.
    work: [f64; 2],
}

fn march(kernel: &Arc<dyn ConvolutionWeights>, tolerance: f64) -> March {
    let mut history = ExponentialHistory::new(Arc::clone(kernel), tolerance).unwrap();
    let mut direct = DirectHistory::new(Arc::clone(kernel));
    let steps = 4 * history.fit().window + 200;
    let count = kernel.classes().elements().len();
    let size = 2 * count;
    let mut instantaneous = vec![0.0; size * size];
    kernel.step_compliance(&mut instantaneous).unwrap();
    let mut random = Random(7);
    let [mut a, mut b, mut traction, mut before, mut last] = [(); 5].map(|()| vec![0.0; size]);
    let (mut worst, mut largest, mut increment) = (0.0_f64, 0.0_f64, 0.0_f64);
    let (mut apart, mut bound, mut work) = (0.0, 0.0, 0.0);
    for _ in 0..steps {
        a.fill(f64::NAN);
        history.evaluate(&mut a).unwrap();
        direct.evaluate(&mut b).unwrap();
        let promised = history.increment_error_bound();
        for i in 0..size {
            let change = a[i] - b[i] - before[i];
            before[i] = a[i] - b[i];
            worst = worst.max(before[i].abs());
            largest = largest.max(b[i].abs());
            if change.abs() > 1e-13 * largest {
                increment = increment.max(change.abs() / promised);
            }
            traction[i] = 0.9 * traction[i] + random.within(-1.0, 1.0);
            let length = kernel.classes().elements()[i % count].length();
            apart += length * traction[i] * change;
            bound += length * traction[i].abs() * promised;
        }
        for i in 0..size {
            let row = &instantaneous[i * size..(i + 1) * size];
            let now = b[i] + row.iter().zip(&traction).map(|(g, t)| g * t).sum::<f64>();
            work += kernel.classes().elements()[i % count].length() * traction[i] * (now - last[i]);
            last[i] = now;
        }
        history.push(&traction);
        direct.push(&traction);
        assert_eq!(history.steps(), direct.steps());
    }
    March { difference: worst / largest, increment, work: [apart.abs() / bound, bound / work] }
}

#[test]
fn stays_within_its_tolerance_of_the_direct_sum() {
    for (name, elements) in [
        ("one element", strip(1, Grading::Uniform)),
        ("uniform", strip(6, Grading::Uniform)),
        ("by wavenumbers", strip(9, Grading::Uniform)),
        ("graded", strip(7, Grading::Cosine)),
        ("two strips", two_strips()),
    ] {
        for (poisson, beta) in
            [(1.0 / 3.0, 0.5), (-0.5, 0.5), (0.0, 5.0), (0.4999, 20.0), (0.263_082, 0.3)]
        {
            let kernel = kernel(poisson, beta, elements.clone());
            for tolerance in [1e-4, 1e-10] {
                let March { difference, increment, work } = march(&kernel, tolerance);
                println!(
                    "{name}, ν = {poisson}, β = {beta}, {tolerance:e}: {difference:.1e}, \
                     {increment:.1e} {work:?}"
                );
                assert!(difference <= tolerance, "{name}: {difference:e} for {tolerance:e}");
                assert!(increment <= 1.0, "{name}: {increment} times what was promised");
                assert!(work[0] <= 1.0, "{name}: {} times the work promised", work[0]);
                assert!(work[1] < 300.0 * tolerance, "{name}: promises nothing, {}", work[1]);
            }
            // Coarse exponentials must show: otherwise they were not looked at.
            assert!(march(&kernel, 1e-3).difference > 1e-9, "{name}: only the window was seen");
        }
    }
}

/// The answer to a pulse is the coefficients themselves, lag by lag.
#[test]
fn every_coefficient_is_within_the_bound_up_to_the_horizon_and_slowly_leaves_it() {
    let kernel = kernel(1.0 / 3.0, 0.5, strip(2, Grading::Uniform));
    let horizon = 2_000;
    for tolerance in [1e-5, 1e-9] {
        let mut history =
            ExponentialHistory::with_horizon(Arc::clone(&kernel), tolerance, horizon).unwrap();
        let bound = history.fit().error_bound;
        assert!(bound <= tolerance && bound > 0.0);
        let mut out = [0.0; 4];
        let mut beyond = 0.0_f64;
        history.push(&[1.0, 0.0, 0.0, 1.0]);
        for lag in 2..=100_000_usize {
            if lag > 40 && lag % (1 + lag / 40) == 0 || lag == history.fit().window + 1 {
                history.evaluate(&mut out).unwrap();
                let pairs = kernel.classes().pairs();
                let of = |pair: usize| {
                    let [mut zz, mut xx, mut zx] = [[0.0]; 3];
                    let class = pairs[pair].class;
                    kernel.coefficients(class, lag, &mut [&mut zz, &mut xx, &mut zx]).unwrap();
                    [pairs[pair].scale * zz[0], pairs[pair].scale * xx[0]]
                };
                let (near, far) = (of(0), of(1));
                for (found, wanted, largest) in [
                    (out[0], near[0], near[0]),
                    (out[1], far[0], near[0]),
                    (out[2], far[1], near[1]),
                    (out[3], near[1], near[1]),
                ] {
                    let error = (found - wanted).abs() / largest;
                    if lag <= horizon {
                        assert!(error <= 1.3 * bound, "lag {lag}: {error:e}, bound {bound:e}");
                    } else {
                        beyond = beyond.max(error / (lag as f64 / horizon as f64));
                    }
                }
            }
            history.push(&[]);
        }
        println!("beyond: {beyond:e} times lag over horizon");
        assert!(beyond <= 2.0 * tolerance, "{beyond:e}");
    }
}

#[test]
fn random_tractions_never_extract_energy() {
    let steps = if heavy() { 8000 } else { 2000 };
    let (mut least, mut largest) = (f64::INFINITY, 0.0_f64);
    for beta in [0.25, 0.5, 2.0, 50.0] {
        for poisson in [-0.5, 0.0, 1.0 / 3.0, 0.4999] {
            for (graded, tolerance) in [(false, 1e-3), (true, 1e-10)] {
                let scene = Scene {
                    poisson,
                    beta,
                    graded,
                    elements: 6,
                    steps,
                    seed: 5,
                    history: HistoryMethod::Exponentials,
                    tolerance,
                };
                let (work, growth) = (scene.least_work(), scene.growth_of_tractions());
                assert!(work >= 0.0, "{scene:?}: {work:e}");
                assert!(growth < 2.0, "{scene:?}: {growth}");
                (least, largest) = (least.min(work), largest.max(growth));
            }
        }
    }
    println!("least work {least:e}, largest growth {largest}");
}

#[test]
fn margins_are_positive_and_do_not_depend_on_the_tolerance() {
    for (poisson, beta) in [(1.0 / 3.0, 0.5), (0.0, 0.1), (0.49, 5.0)] {
        let kernel = kernel(poisson, beta, strip(5, Grading::Cosine));
        let margin = |tolerance| {
            let history = ExponentialHistory::new(Arc::clone(&kernel), tolerance).unwrap();
            history.fit().passivity_margin
        };
        let (coarse, fine) = (margin(1e-5), margin(1e-11));
        println!("ν = {poisson}, β = {beta}: {coarse:.6} {fine:.6}");
        assert!(fine > 1e-3, "{fine}");
        assert!((coarse / fine - 1.0).abs() < 1e-2, "{coarse} {fine}");
    }
}

#[test]
fn memory_does_not_grow() {
    let kernel = kernel(1.0 / 3.0, 0.5, strip(10, Grading::Uniform));
    let mut history = ExponentialHistory::new(kernel, 1e-9).unwrap();
    let held = history.memory();
    history.prepare(usize::MAX, &mut unobserved).unwrap();
    for step in 0..3_000 {
        history.push(&[f64::from(step % 7); 20]);
    }
    assert_eq!(history.memory(), held);
    assert!(held < 1_000_000, "{held} bytes");
    assert!(history.save().unwrap().len() < 10_000);
}

#[test]
fn bad_input_is_an_error() {
    let kernel = kernel(0.3, 0.5, strip(2, Grading::Uniform));
    for tolerance in [0.0, -1.0, 1e-13, 0.1, f64::NAN, f64::INFINITY] {
        let found = ExponentialHistory::new(Arc::clone(&kernel), tolerance).err();
        assert!(matches!(found, Some(Error::Input { .. })), "{tolerance}: {found:?}");
    }
    let soil = Soil::new(1.0, 0.3, 1.0).unwrap();
    let ground = || ElasticGround::new(soil, Strip::uniform(-1.0..1.0, 2).unwrap()).unwrap();
    let options = HistoryOptions::default();
    assert!(
        ground().with_history(HistoryOptions { tolerance: Some(f64::NAN), ..options }).is_err()
    );
    // Windows of more than a million steps are refused; Auto takes the transforms instead.
    let mut short = ground().with_history(HistoryMethod::Exponentials).unwrap();
    assert!(matches!(short.prepare(1e-7, None, &mut unobserved), Err(Error::Input { .. })));
    // So is what takes more memory than allowed, before any of it is taken.
    let begin = std::time::Instant::now();
    for (step, memory) in [(2e-5, None), (1e-3, Some(100_000))] {
        let asked = ElasticGround::new(soil, Strip::graded(-1.0..1.0, 24).unwrap()).unwrap();
        let mut own = HistoryOptions::from(HistoryMethod::Exponentials);
        own.memory = memory.unwrap_or(own.memory);
        let mut asked = asked.with_history(own).unwrap();
        let refused = asked.prepare(step, None, &mut unobserved).unwrap_err();
        let Error::Memory(MemoryError { needed, limit, .. }) = refused else { panic!("{refused}") };
        assert!(needed > limit && limit == memory.unwrap_or(1 << 30) as f64, "{refused}");
    }
    assert!(begin.elapsed().as_secs_f64() < 1.0, "{:?}", begin.elapsed());
    let mut history = ExponentialHistory::with_horizon(kernel, 1e-6, 0).unwrap();
    history.evaluate(&mut [0.0; 4]).unwrap();
    assert!(matches!(history.evaluate(&mut [0.0; 3]), Err(Error::Size { .. })));
}

/// One rule: exponentials on the half-plane, unless they begin late or take more memory than is allowed.
#[test]
fn the_choice_is_made_and_explained() {
    use HistoryMethod::{Exponentials, RelaxedFft};

    let soil = Soil::new(80.0e6, 0.3, 1900.0).unwrap();
    let choose = |tolerance: Option<f64>, memory: Option<usize>, steps: Option<usize>, dt| {
        let ground = ElasticGround::new(soil, Strip::uniform(-2.0..2.0, 6).unwrap()).unwrap();
        let mut options = HistoryOptions { tolerance, ..HistoryOptions::default() };
        options.memory = memory.unwrap_or(options.memory);
        let mut ground = ground.with_history(options).unwrap();
        assert_eq!(ground.description().history, None);
        ground.prepare(dt, steps, &mut unobserved)?;
        let choice = ground.description().history.unwrap();
        println!("{choice}");
        assert_eq!(choice.to_string().contains("no known end"), steps.is_none());
        Ok::<_, Error>((choice.kind, choice.error_bound))
    };
    for (tolerance, steps) in [
        (None, Some(40)),
        (None, Some(20_000)),
        (None, None),
        (Some(1e-8), Some(40)),
        (Some(1e-8), None),
    ] {
        let (kind, bound) = choose(tolerance, None, steps, 1e-3).unwrap();
        assert_eq!(kind, Exponentials);
        assert!(0.0 < bound && bound <= tolerance.unwrap_or(1e-12), "{bound:e}");
    }
    // They begin after more lags than a run is expected to have, or take more memory.
    assert_eq!(choose(None, None, Some(500), 1e-6), Ok((RelaxedFft, 0.0)));
    assert_eq!(choose(None, Some(35_000), Some(60), 1e-3), Ok((RelaxedFft, 0.0)));
    for memory in [35_000, 1_000] {
        let refused = choose(None, Some(memory), Some(1_500), 1e-3).unwrap_err();
        let Error::Memory(MemoryError { asked, needed, limit, .. }) = refused else {
            panic!("{refused}")
        };
        assert!(asked == 1_500.0 && limit == memory as f64 && needed > limit);
    }
    let mut asked = ElasticGround::new(soil, Strip::uniform(-2.0..2.0, 6).unwrap())
        .unwrap()
        .with_history(Exponentials)
        .unwrap();
    asked.prepare(1e-3, None, &mut unobserved).unwrap();
    let choice = asked.description().history.unwrap();
    assert_eq!(choice.kind, Exponentials);
    assert!(choice.error_bound > 0.0 && choice.error_bound <= 1e-10);
}
