//! Choice of the Laplace variables at which compliances are computed, for rational functions through them.
//!
//! A quadrature evaluates compliances at the eigenvalues λ(z)/Δt of its points |z| < 1. They fill the inside of the curve of
//! a circle |z| = r near 1, on which an analytic error is largest. Samples on the curve are added where two rational functions,
//! with other samples as nodes, differ. Each new sample is a check of the functions before it. If all new samples agree,
//! rational functions take the place of further computations.

use std::collections::BTreeMap;

use super::rational::{RationalCompliances, RationalWeights, Sample, SampleSums};
use crate::bem::layered::{CirclePoint, Stages, on_circle, on_threads, thread_count};
use crate::error::{ProgressReporter, Result};
use crate::linalg::Complex;

/// ln |z| of the curve of samples: nearer to zero than panels and circles for up to 2048 lags.
const CURVE_LOG_RADIUS: f64 = -0.0024;
/// Largest distance of candidates along the half circle for the first eigenvalue, rad.
const MAX_FIRST_STEP: f64 = std::f64::consts::PI / 480.0;
/// Distance of candidates for each other eigenvalue, which is smooth, rad.
const OTHER_STEP: f64 = std::f64::consts::PI / 120.0;
/// Distance of candidates over their distance from z = 1, the branch point of long waves.
const STEP_RATIO: f64 = 0.2;
/// Angle of the first candidate, rad.
const FIRST_ANGLE: f64 = 3e-4;
/// Number of first samples.
const FIRST_SAMPLE_COUNT: usize = 40;
/// Number of samples between two pairs of rational functions.
const SAMPLES_PER_ROUND: usize = 6;
/// Largest number of samples.
const MAX_SAMPLE_COUNT: usize = 240;
/// Smallest distance of two new samples, in candidates.
const MIN_CANDIDATE_DISTANCE: usize = 5;
/// Largest error at new samples of long waves, relative to the compliances of both elements.
const MAX_LOW_ERROR: f64 = 2e-9;
/// Further error at |s| Δt = 1 and above: early weights are larger than late ones, which come from long waves.
const MAX_HIGH_ERROR: f64 = 2e-8;
/// Places of the checks of the two functions among every six samples.
const FIRST_CHECKS: [usize; 2] = [1, 4];

/// Laplace variables of a convolution quadrature.
#[derive(Debug, Clone, Copy)]
pub(super) struct QuadratureDomain {
    pub(super) stages: Stages,
    /// s.
    pub(super) time_step: f64,
}

impl QuadratureDomain {
    /// Whether `s` is inside the curve of samples.
    pub(super) fn contains(&self, s: Complex) -> bool {
        let z = self.stages.circle_point(s.scale(self.time_step));
        z.abs() <= CURVE_LOG_RADIUS.exp()
    }

    /// Largest error at `s`, relative to the compliances of both elements.
    fn max_error(&self, s: Complex) -> f64 {
        MAX_LOW_ERROR + MAX_HIGH_ERROR * s.scale(self.time_step).squared_modulus().min(1.0)
    }

    /// Laplace variables along the curve, with Im s > 0.
    fn candidates(&self) -> Vec<Complex> {
        let mut candidates = vec![];
        for node in 0..self.stages.count() {
            for angle in angles(node) {
                let CirclePoint { z, one_less_z } = on_circle(CURVE_LOG_RADIUS, angle);
                let lambda = self.stages.nodes(z, one_less_z).nth(node).map(|node| node.lambda);
                let s = lambda.unwrap_or_default().scale(1.0 / self.time_step);
                candidates.push(Complex::new(s.re, s.im.abs()));
            }
        }
        candidates
    }
}

/// Angles of the candidates of an eigenvalue, rad.
fn angles(node: usize) -> Vec<f64> {
    let mut angle = if node == 0 { FIRST_ANGLE } else { 0.5 * OTHER_STEP };
    let mut angles = vec![];
    while angle < std::f64::consts::PI {
        angles.push(angle);
        let distance = angle.hypot(CURVE_LOG_RADIUS);
        angle += if node == 0 { MAX_FIRST_STEP.min(STEP_RATIO * distance) } else { OTHER_STEP };
    }
    angles
}

/// Rational functions through samples of the compliances; `None` if too many samples do not suffice.
///
/// `compliances` overwrites values, one per class, with the compliances at a Laplace variable. `self_pairs` has, for each
/// class, the classes of the pairs of its two elements with themselves.
pub(super) fn sample<const KINDS: usize>(
    domain: QuadratureDomain,
    self_pairs: &[[usize; 2]],
    compliances: impl Fn(Complex, &mut [[Complex; KINDS]]) -> Result<()> + Sync,
    progress: &mut ProgressReporter,
) -> Result<Option<RationalCompliances<KINDS>>> {
    let candidates = domain.candidates();
    let last = candidates.len() - 1;
    let mut chosen: Vec<usize> =
        (0..FIRST_SAMPLE_COUNT).map(|k| k * last / (FIRST_SAMPLE_COUNT - 1)).collect();
    let mut samples: BTreeMap<usize, Sample<KINDS>> = BTreeMap::new();
    let mut functions: Option<RationalCompliances<KINDS>> = None;
    loop {
        let new_variables = chosen.iter().map(|candidate| candidates[*candidate]);
        let new_samples = computed_samples(new_variables, self_pairs, &compliances, progress)?;
        let is_accurate = |functions: &RationalCompliances<KINDS>| {
            let mut samples = new_samples.iter();
            samples.all(|sample| check_error(functions, sample) <= domain.max_error(sample.s))
        };
        let are_accurate = functions.as_ref().is_some_and(is_accurate);
        samples.extend(chosen.iter().copied().zip(new_samples));
        let stored: Vec<_> = samples.values().collect();
        let sums = all_sums(&stored);
        let weights_of = |check| RationalWeights::new(&sums, check);
        if are_accurate {
            return Ok(Some(RationalCompliances::new(weights_of(FIRST_CHECKS[0]), &stored)));
        }
        if samples.len() + SAMPLES_PER_ROUND > MAX_SAMPLE_COUNT {
            return Ok(None);
        }
        let weights = FIRST_CHECKS.map(weights_of);
        chosen = next_candidates(domain, &candidates, &samples, &sums, &weights);
        let [weights, _] = weights;
        functions = Some(RationalCompliances::new(weights, &stored));
    }
}

/// Samples at these Laplace variables, computed on all threads.
fn computed_samples<const KINDS: usize>(
    variables: impl Iterator<Item = Complex>,
    self_pairs: &[[usize; 2]],
    compliances: &(impl Fn(Complex, &mut [[Complex; KINDS]]) -> Result<()> + Sync),
    progress: &mut ProgressReporter,
) -> Result<Vec<Sample<KINDS>>> {
    let zeros = vec![[Complex::default(); KINDS]; self_pairs.len()];
    let empty = |s| Sample { s, values: zeros.clone(), scales: vec![] };
    let mut samples: Vec<_> = variables.map(empty).collect();
    let compute = |(): &mut (), sample: &mut Sample<KINDS>| {
        compliances(sample.s, &mut sample.values)?;
        sample.scales = class_scales(&sample.values, self_pairs);
        Ok(())
    };
    on_threads(thread_count(), samples.iter_mut(), compute, |_| progress.reach(0))?;
    Ok(samples)
}

/// Geometric mean of the compliances of both elements, for each class.
fn class_scales<const KINDS: usize>(
    values: &[[Complex; KINDS]],
    self_pairs: &[[usize; 2]],
) -> Vec<f64> {
    let magnitude = |class: usize| values[class][0].abs().min(values[class][1].abs());
    self_pairs
        .iter()
        .map(|pair| (magnitude(pair[0]) * magnitude(pair[1])).sqrt())
        .collect()
}

/// Sums of all samples along the curve, relative to the compliances at the sample in the middle.
fn all_sums<const KINDS: usize>(samples: &[&Sample<KINDS>]) -> Vec<SampleSums> {
    let scales = &samples[samples.len() / 2].scales;
    samples.iter().map(|sample| SampleSums::new(sample, scales)).collect()
}

/// Largest error of rational functions at a new sample, relative to the compliances of both elements.
fn check_error<const KINDS: usize>(
    functions: &RationalCompliances<KINDS>,
    new: &Sample<KINDS>,
) -> f64 {
    let mut values = vec![[Complex::default(); KINDS]; new.values.len()];
    functions.evaluate(new.s, &mut values);
    let mut max_error = 0.0_f64;
    for ((values, expected), scale) in values.iter().zip(&new.values).zip(&new.scales) {
        for (value, expected) in values.iter().zip(expected) {
            let error = (*value - *expected).abs() / scale;
            max_error = max_error.max(if error.is_nan() { f64::INFINITY } else { error });
        }
    }
    max_error
}

/// Candidates at which two rational functions differ most, relative to the largest errors.
fn next_candidates<const KINDS: usize>(
    domain: QuadratureDomain,
    candidates: &[Complex],
    samples: &BTreeMap<usize, Sample<KINDS>>,
    sums: &[SampleSums],
    functions: &[RationalWeights; 2],
) -> Vec<usize> {
    let mut differences: Vec<f64> = vec![];
    for (candidate, s) in candidates.iter().enumerate() {
        let scale = neighbour_scale(candidate, samples, sums) * domain.max_error(*s);
        let all_factors = functions.each_ref().map(|function| function.factors(*s));
        let mut max_difference = 0.0_f64;
        for k in 0..sums[0].sums.len() {
            let values = [0, 1].map(|function| {
                let nodes = functions[function].samples.iter();
                let products = nodes.zip(&all_factors[function]);
                products.fold(Complex::default(), |sum, (node, factors)| {
                    sum + factors.product(sums[*node].sums[k])
                })
            });
            max_difference = max_difference.max((values[0] - values[1]).abs() / scale);
        }
        differences.push(max_difference);
    }
    for sample in samples.keys() {
        differences[*sample] = 0.0;
    }
    let mut chosen = vec![];
    while chosen.len() < SAMPLES_PER_ROUND {
        let largest = (0..differences.len())
            .max_by(|a, b| differences[*a].total_cmp(&differences[*b]))
            .filter(|candidate| differences[*candidate] > 0.0);
        let Some(candidate) = largest else { break };
        chosen.push(candidate);
        let first = candidate.saturating_sub(MIN_CANDIDATE_DISTANCE);
        let end = differences.len().min(candidate + MIN_CANDIDATE_DISTANCE + 1);
        differences[first..end].fill(0.0);
    }
    chosen
}

/// Scale of the sample before a candidate on the curve, or of the first sample.
fn neighbour_scale<const KINDS: usize>(
    candidate: usize,
    samples: &BTreeMap<usize, Sample<KINDS>>,
    sums: &[SampleSums],
) -> f64 {
    let earlier_count = samples.range(..=candidate).count();
    sums[earlier_count.saturating_sub(1)].scale
}
