//! GOAL: the history by exponentials keeps its tolerance and passivity, and bounds its own error.
//! SCENE: uniform, graded and double strips over c₁Δt/l and ν, random tractions and pulses.
//! REFERENCE: the direct sum, its work, and the coefficients themselves.

use std::sync::Arc;

use basemat::bem::{ContactElement, ElasticGround, Grading, Ground, PatchKernel, Strip};
use basemat::history::{
    ConvolutionHistory, ConvolutionWeights, DirectHistory, ExponentialHistory, HistoryMethod,
    HistoryOptions,
};
use basemat::{Error, MemoryError, Result, Soil, unobserved};

use basemat_problems::dense::dot;
use basemat_problems::heavy;
use basemat_problems::passivity::PassivityScene;
use basemat_problems::random::Random;

/// Weights of elements over a length of 2 on soil of unit modulus and density.
///
/// `beta` is c₁Δt over the mean element length.
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
struct ComparedMarch {
    /// Largest difference over the largest displacement.
    difference: f64,
    /// Largest change of a difference over a step, over its bound.
    increment: f64,
    /// Difference of the works done, over its bound.
    work_difference: f64,
    /// Bound on the difference of the works, over the work.
    relative_work_bound: f64,
}

fn march(kernel: &Arc<dyn ConvolutionWeights>, tolerance: f64) -> ComparedMarch {
    let mut history = ExponentialHistory::new(Arc::clone(kernel), tolerance).unwrap();
    let mut direct_history = DirectHistory::new(Arc::clone(kernel));
    let elements = kernel.classes().elements();
    let size = 2 * elements.len();
    let mut step_compliance = vec![0.0; size * size];
    kernel.step_compliance(&mut step_compliance).unwrap();
    let mut random = Random(7);
    let mut computed = vec![0.0; size];
    let mut expected = vec![0.0; size];
    let mut traction = vec![0.0; size];
    let mut difference = vec![0.0; size];
    let mut displacement = vec![0.0; size];
    let mut largest_difference = 0.0_f64;
    let mut max_magnitude = 0.0_f64;
    let mut increment = 0.0_f64;
    let mut work_difference = 0.0;
    let mut work_bound = 0.0;
    let mut work = 0.0;
    for _ in 0..4 * history.fit().window + 200 {
        computed.fill(f64::NAN);
        history.evaluate(&mut computed).unwrap();
        direct_history.evaluate(&mut expected).unwrap();
        let bound = history.increment_error_bound();
        for i in 0..size {
            let change = computed[i] - expected[i] - difference[i];
            difference[i] = computed[i] - expected[i];
            largest_difference = largest_difference.max(difference[i].abs());
            max_magnitude = max_magnitude.max(expected[i].abs());
            if change.abs() > 1e-13 * max_magnitude {
                increment = increment.max(change.abs() / bound);
            }
            traction[i] = 0.9 * traction[i] + random.within(-1.0, 1.0);
            let length = elements[i % elements.len()].length();
            work_difference += length * traction[i] * change;
            work_bound += length * traction[i].abs() * bound;
        }
        for i in 0..size {
            let end = expected[i] + dot(&step_compliance[i * size..(i + 1) * size], &traction);
            let length = elements[i % elements.len()].length();
            work += length * traction[i] * (end - displacement[i]);
            displacement[i] = end;
        }
        history.push(&traction);
        direct_history.push(&traction);
        assert_eq!(history.steps(), direct_history.steps());
    }
    ComparedMarch {
        difference: largest_difference / max_magnitude,
        increment,
        work_difference: work_difference.abs() / work_bound,
        relative_work_bound: work_bound / work,
    }
}

/// GOAL: differences of displacements, of their increments and of work stay within tolerance and bounds.
#[test]
fn exponentials_are_within_their_tolerance_of_the_direct_sum() {
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
                let march = march(&kernel, tolerance);
                let difference = march.difference;
                println!(
                    "{name}, ν = {poisson}, β = {beta}, {tolerance:e}: {difference:.1e}, {:.1e} \
                     [{}, {}]",
                    march.increment, march.work_difference, march.relative_work_bound
                );
                assert!(difference <= tolerance, "{name}: {difference:e} for {tolerance:e}");
                assert!(march.increment <= 1.0, "{name}: {} times the bound", march.increment);
                let work_difference = march.work_difference;
                assert!(work_difference <= 1.0, "{name}: {work_difference} times the work's bound");
                let work_bound = march.relative_work_bound;
                assert!(
                    work_bound < 300.0 * tolerance,
                    "{name}: the bound is useless: {work_bound}"
                );
            }
            // Coarse exponentials must differ; otherwise the march compares only the window of exact lags.
            assert!(march(&kernel, 1e-3).difference > 1e-9, "{name}: only the window was compared");
        }
    }
}

/// Coefficients zz and xx of a pair of elements at a lag.
fn pair_coefficients(kernel: &dyn ConvolutionWeights, pair: usize, lag: usize) -> [f64; 2] {
    let pair = kernel.classes().pairs()[pair];
    let mut weights = [[0.0]; 3];
    kernel
        .coefficients(pair.class, lag, &mut weights.each_mut().map(|list| &mut list[..]))
        .unwrap();
    [pair.scale * weights[0][0], pair.scale * weights[1][0]]
}

/// GOAL: the response to a unit traction of one step is the list of coefficients, lag by lag, up to the horizon.
#[test]
fn every_coefficient_is_within_the_bound_up_to_the_horizon_and_slowly_leaves_it() {
    let kernel = kernel(1.0 / 3.0, 0.5, strip(2, Grading::Uniform));
    let horizon = 2_000;
    for tolerance in [1e-5, 1e-9] {
        let mut history =
            ExponentialHistory::with_horizon(Arc::clone(&kernel), tolerance, horizon).unwrap();
        let bound = history.fit().error_bound;
        assert!(bound <= tolerance && bound > 0.0);
        let mut displacement = [0.0; 4];
        let mut error_beyond = 0.0_f64;
        history.push(&[1.0, 0.0, 0.0, 1.0]);
        for lag in 2..=100_000_usize {
            if lag > 40 && lag % (1 + lag / 40) == 0 || lag == history.fit().window + 1 {
                history.evaluate(&mut displacement).unwrap();
                let weights_of_near_pair = pair_coefficients(kernel.as_ref(), 0, lag);
                let weights_of_far_pair = pair_coefficients(kernel.as_ref(), 1, lag);
                for (computed, expected, largest) in [
                    (displacement[0], weights_of_near_pair[0], weights_of_near_pair[0]),
                    (displacement[1], weights_of_far_pair[0], weights_of_near_pair[0]),
                    (displacement[2], weights_of_far_pair[1], weights_of_near_pair[1]),
                    (displacement[3], weights_of_near_pair[1], weights_of_near_pair[1]),
                ] {
                    let error = (computed - expected).abs() / largest;
                    if lag <= horizon {
                        assert!(error <= 1.3 * bound, "lag {lag}: {error:e}, bound {bound:e}");
                    } else {
                        error_beyond = error_beyond.max(error / (lag as f64 / horizon as f64));
                    }
                }
            }
            history.push(&[]);
        }
        println!("beyond: {error_beyond:e} times lag over horizon");
        assert!(error_beyond <= 2.0 * tolerance, "{error_beyond:e}");
    }
}

/// GOAL: random tractions never extract energy, and tractions of random displacements do not grow.
#[test]
fn random_tractions_never_extract_energy() {
    let steps = if heavy() { 8000 } else { 2000 };
    let mut smallest_work = f64::INFINITY;
    let mut largest_growth = 0.0_f64;
    for beta in [0.25, 0.5, 2.0, 50.0] {
        for poisson in [-0.5, 0.0, 1.0 / 3.0, 0.4999] {
            for (graded, tolerance) in [(false, 1e-3), (true, 1e-10)] {
                let scene = PassivityScene {
                    poisson,
                    beta,
                    graded,
                    elements: 6,
                    steps,
                    seed: 5,
                    history: HistoryMethod::Exponentials,
                    tolerance,
                };
                let work = scene.min_work_ratio();
                let growth = scene.growth_of_tractions();
                assert!(work >= 0.0, "{scene:?}: {work:e}");
                assert!(growth < 2.0, "{scene:?}: {growth}");
                smallest_work = smallest_work.min(work);
                largest_growth = largest_growth.max(growth);
            }
        }
    }
    println!("smallest work {smallest_work:e}, largest growth {largest_growth}");
}

/// GOAL: the margin of passivity is positive, and a property of the kernel.
#[test]
fn margins_are_positive_and_do_not_depend_on_the_tolerance() {
    for (poisson, beta) in [(1.0 / 3.0, 0.5), (0.0, 0.1), (0.49, 5.0)] {
        let kernel = kernel(poisson, beta, strip(5, Grading::Cosine));
        let [coarse, fine] = [1e-5, 1e-11].map(|tolerance| {
            let history = ExponentialHistory::new(Arc::clone(&kernel), tolerance).unwrap();
            history.fit().passivity_margin
        });
        println!("ν = {poisson}, β = {beta}: {coarse:.6} {fine:.6}");
        assert!(fine > 1e-3, "{fine}");
        assert!((coarse / fine - 1.0).abs() < 1e-2, "{coarse} {fine}");
    }
}

/// GOAL: the memory of the exponentials does not depend on the number of steps.
#[test]
fn memory_does_not_grow() {
    let kernel = kernel(1.0 / 3.0, 0.5, strip(10, Grading::Uniform));
    let mut history = ExponentialHistory::new(kernel, 1e-9).unwrap();
    let memory_before = history.memory();
    history.prepare(usize::MAX, &mut unobserved).unwrap();
    for step in 0..3_000 {
        history.push(&[f64::from(step % 7); 20]);
    }
    assert_eq!(history.memory(), memory_before);
    assert!(memory_before < 1_000_000, "{memory_before} bytes");
    assert!(history.save().unwrap().len() < 10_000);
}

/// Ground of unit modulus and density under a strip of length 2.
fn unit_ground(strip: Strip) -> ElasticGround {
    ElasticGround::new(Soil::new(1.0, 0.3, 1.0).unwrap(), strip).unwrap()
}

/// GOAL: tolerances, time steps and memory out of range give typed errors.
#[test]
fn invalid_input_is_an_error() {
    let kernel = kernel(0.3, 0.5, strip(2, Grading::Uniform));
    for tolerance in [0.0, -1.0, 1e-13, 0.1, f64::NAN, f64::INFINITY] {
        let result = ExponentialHistory::new(Arc::clone(&kernel), tolerance).err();
        assert!(matches!(result, Some(Error::Input { .. })), "{tolerance}: {result:?}");
    }
    let uniform_strip = Strip::uniform(-1.0..1.0, 2).unwrap();
    let no_tolerance = HistoryOptions { tolerance: Some(f64::NAN), ..HistoryOptions::default() };
    assert!(unit_ground(uniform_strip.clone()).with_history(no_tolerance).is_err());
    // Windows of more than a million steps are errors; `Auto` uses transforms instead.
    let mut ground = unit_ground(uniform_strip).with_history(HistoryMethod::Exponentials).unwrap();
    assert!(matches!(ground.prepare(1e-7, None, &mut unobserved), Err(Error::Input { .. })));
    // More memory than allowed is an error before any of it is allocated.
    let start_time = std::time::Instant::now();
    for (time_step, memory) in [(2e-5, None), (1e-3, Some(100_000))] {
        let mut options = HistoryOptions::from(HistoryMethod::Exponentials);
        options.memory = memory.unwrap_or(options.memory);
        let ground = unit_ground(Strip::graded(-1.0..1.0, 24).unwrap());
        let mut ground = ground.with_history(options).unwrap();
        let result = ground.prepare(time_step, None, &mut unobserved).unwrap_err();
        let Error::Memory(MemoryError { needed, limit, .. }) = result else {
            panic!("{result}")
        };
        assert!(needed > limit && limit == memory.unwrap_or(1 << 30) as f64, "{result}");
    }
    assert!(start_time.elapsed().as_secs_f64() < 1.0, "{:?}", start_time.elapsed());
    let mut history = ExponentialHistory::with_horizon(kernel, 1e-6, 0).unwrap();
    history.evaluate(&mut [0.0; 4]).unwrap();
    assert!(matches!(history.evaluate(&mut [0.0; 3]), Err(Error::Size { .. })));
}

/// Ground for the choice of a method: six elements on a soil in SI units.
fn six_element_ground() -> ElasticGround {
    let soil = Soil::new(80.0e6, 0.3, 1900.0).unwrap();
    ElasticGround::new(soil, Strip::uniform(-2.0..2.0, 6).unwrap()).unwrap()
}

/// The method that the ground chooses, and its error bound.
fn choose(
    tolerance: Option<f64>,
    memory: Option<usize>,
    steps: Option<usize>,
    time_step: f64,
) -> Result<(HistoryMethod, f64)> {
    let mut options = HistoryOptions { tolerance, ..HistoryOptions::default() };
    options.memory = memory.unwrap_or(options.memory);
    let mut ground = six_element_ground().with_history(options).unwrap();
    assert_eq!(ground.description().history, None);
    ground.prepare(time_step, steps, &mut unobserved)?;
    let choice = ground.description().history.unwrap();
    println!("{choice}");
    assert_eq!(choice.to_string().contains("no known end"), steps.is_none());
    Ok((choice.kind, choice.error_bound))
}

/// GOAL: exponentials are chosen on the half-plane, unless they begin late or need more memory than allowed.
#[test]
fn the_choice_is_made_and_explained() {
    use HistoryMethod::{Exponentials, RelaxedFft};

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
    // They begin after more lags than the run is expected to have, or need more memory.
    assert_eq!(choose(None, None, Some(500), 1e-6), Ok((RelaxedFft, 0.0)));
    assert_eq!(choose(None, Some(35_000), Some(60), 1e-3), Ok((RelaxedFft, 0.0)));
    for memory in [35_000, 1_000] {
        let result = choose(None, Some(memory), Some(1_500), 1e-3).unwrap_err();
        let Error::Memory(MemoryError { asked, needed, limit, .. }) = result else {
            panic!("{result}")
        };
        assert!(asked == 1_500.0 && limit == memory as f64 && needed > limit);
    }
    let mut ground = six_element_ground().with_history(Exponentials).unwrap();
    ground.prepare(1e-3, None, &mut unobserved).unwrap();
    let choice = ground.description().history.unwrap();
    assert_eq!(choice.kind, Exponentials);
    assert!(choice.error_bound > 0.0 && choice.error_bound <= 1e-10);
}
