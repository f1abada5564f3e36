//! GOAL: the study fits the curves of the largest likelihood and estimates their confidence. SCENE: counts that are
//! published, computed from curves, or random. REFERENCE: probit regression in the literature, a search over the likelihood
//! with a normal distribution by Simpson's rule, and the curves of the counts.

use super::lognormal::{FragilityCurve, Stripe, curve, fit, normal, quantile, resampled, stripes};
use super::motions::Pulse;

use basemat_problems::random::Random;

fn counted(levels: &[f64], runs: &[f64], exceeded: &[f64]) -> Vec<Stripe> {
    let counts = levels.iter().zip(runs).zip(exceeded);
    counts.map(|((&level, &runs), &exceeded)| Stripe { level, runs, exceeded }).collect()
}

/// Φ by Simpson's rule.
fn integrated(z: f64) -> f64 {
    let steps = 2000;
    let width = z / 2000.0;
    let sum: f64 = (0..=steps)
        .map(|k| {
            let weight = if k == 0 || k == steps { 1.0 } else { f64::from(2 + 2 * (k % 2)) };
            let x = f64::from(k) * width;
            weight * (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt()
        })
        .sum();
    0.5 + sum * width / 3.0
}

#[test]
fn the_normal_distribution_is_the_integral_of_its_density() {
    for z in [-6.0, -2.5, -1.0, 0.0, 0.3, 1.96, 5.0] {
        assert!((normal(z) - integrated(z)).abs() < 1e-13, "{z}");
    }
}

/// Beetles under gaseous carbon disulphide, Bliss, Annals of Applied Biology 22 (1935), 134–167; probit
/// regression on the logarithm of the dose in Dobson and Barnett, "An introduction to generalized
/// linear models", 3rd edition, table 7.4: −34.94 (standard error 2.64) and 19.73 (1.48).
#[test]
fn the_beetles_of_bliss_1935_have_the_published_fit() {
    let doses = [1.6907, 1.7242, 1.7552, 1.7842, 1.8113, 1.8369, 1.8610, 1.8839];
    let levels = doses.map(|dose: f64| 10.0_f64.powf(dose));
    let beetles = [59.0, 60.0, 62.0, 56.0, 63.0, 59.0, 62.0, 60.0];
    let killed_counts = [6.0, 13.0, 18.0, 28.0, 52.0, 53.0, 61.0, 60.0];
    let fitted_curve = fit(&counted(&levels, &beetles, &killed_counts)).unwrap();
    let ten = 10.0_f64.ln();
    let slope = ten / fitted_curve.curve.dispersion;
    let intercept = -fitted_curve.curve.median.ln() / fitted_curve.curve.dispersion;
    assert!((slope - 19.73).abs() < 0.006, "{slope}");
    assert!((intercept + 34.94).abs() < 0.006, "{intercept}");
    // Error of the slope: the error of β divided by β² / ln 10.
    let error = fitted_curve.dispersion_error * ten / fitted_curve.curve.dispersion.powi(2);
    assert!((error - 1.48).abs() < 0.012, "{error}");
}

#[test]
fn fits_of_expected_counts_are_their_curves() {
    let levels = [0.1, 0.2, 0.4, 0.7, 1.0, 1.5, 2.5];
    for (median, dispersion) in [(0.5, 0.3), (1.2, 0.8), (0.15, 0.4), (30.0, 1.5), (1e-3, 2.0)] {
        let counts = levels.map(|level: f64| 40.0 * integrated((level / median).ln() / dispersion));
        let computed = fit(&counted(&levels, &[40.0; 7], &counts)).unwrap().curve;
        assert!((computed.median / median - 1.0).abs() < 1e-7, "{median}: {computed:?}");
        let error = (computed.dispersion / dispersion - 1.0).abs();
        assert!(error < 1e-7, "{dispersion}: {computed:?}");
    }
}

/// No neighbour on a fine grid has a higher likelihood, and the Fisher information is the curvature there.
#[test]
fn the_likelihood_is_highest_at_the_fit() {
    let levels = [0.2, 0.3, 0.4, 0.6, 0.7, 0.8, 0.9, 1.0];
    let runs = [40.0; 8];
    let counts = [0.0, 0.0, 0.0, 4.0, 6.0, 13.0, 12.0, 16.0];
    let fitted_curve = fit(&counted(&levels, &runs, &counts)).unwrap();
    let likelihood = |center: f64, dispersion: f64| -> f64 {
        let mut sum = 0.0;
        for k in 0..levels.len() {
            let p = integrated((levels[k].ln() - center) / dispersion);
            // Where no run exceeds the limit, 0 · ln 0 counts as zero.
            sum += counts[k] * p.ln() + (runs[k] - counts[k]) * (1.0 - p).ln();
        }
        sum
    };
    // From a coarse grid to a fine one around its best.
    let mut best_parameters = [0.0, 0.6];
    let mut span = [1.0, 0.5];
    for _ in 0..12 {
        let points = (-10..=10).flat_map(|i| (-10..=10).map(move |j| [i, j]));
        let points = points.map(|[i, j]: [i32; 2]| {
            [
                best_parameters[0] + 0.1 * f64::from(i) * span[0],
                best_parameters[1] + 0.1 * f64::from(j) * span[1],
            ]
        });
        let points = points.filter(|point| point[1] > 0.05);
        let likelier =
            |a: &[f64; 2], b: &[f64; 2]| likelihood(a[0], a[1]).total_cmp(&likelihood(b[0], b[1]));
        best_parameters = points.max_by(likelier).unwrap();
        span = span.map(|width| 0.4 * width);
    }
    assert!(
        (fitted_curve.curve.median.ln() - best_parameters[0]).abs() < 1e-4,
        "{fitted_curve:?}, {best_parameters:?}"
    );
    assert!(
        (fitted_curve.curve.dispersion - best_parameters[1]).abs() < 1e-4,
        "{fitted_curve:?}, {best_parameters:?}"
    );

    // Observed information by differences; the fit's comes from the same second derivatives.
    let h = 1e-3;
    let c = fitted_curve.curve.median.ln();
    let b = fitted_curve.curve.dispersion;
    let second_derivative = |[p, q]: [f64; 2], [r, s]: [f64; 2]| {
        let shifted = |x: f64, y: f64| likelihood(c + h * (x * p + y * r), b + h * (x * q + y * s));
        (shifted(1.0, 1.0) - shifted(1.0, -1.0) - shifted(-1.0, 1.0) + shifted(-1.0, -1.0))
            / (4.0 * h * h)
    };
    let u = [1.0, 0.0];
    let v = [0.0, 1.0];
    let uu = -second_derivative(u, u);
    let uv = -second_derivative(u, v);
    let vv = -second_derivative(v, v);
    let determinant = uu * vv - uv * uv;
    let errors = [fitted_curve.median_error, fitted_curve.dispersion_error];
    for (computed, expected) in errors.iter().zip([vv / determinant, uu / determinant]) {
        let difference = (computed / expected.sqrt() - 1.0).abs();
        assert!(difference < 1e-3, "{computed}, {expected}");
    }
}

#[test]
fn counts_without_a_finite_fit_have_a_step_or_no_curve() {
    let levels = [0.5, 1.0, 2.0];
    let of_four_runs = |counts: [f64; 3]| counted(&levels, &[4.0; 3], &counts);
    for (counts, median) in [
        ([0.0, 0.0, 0.0], f64::INFINITY),
        ([4.0, 4.0, 4.0], 0.0),
        ([0.0, 4.0, 4.0], 0.5_f64.sqrt()),
        ([0.0, 2.0, 4.0], 1.0),
    ] {
        assert_eq!(fit(&of_four_runs(counts)), None);
        let step = curve(&of_four_runs(counts)).unwrap();
        assert!((step.median == median || (step.median - median).abs() < 1e-15), "{step:?}");
        assert_eq!(step.dispersion, 0.0);
    }
    let step = FragilityCurve { median: 1.0, dispersion: 0.0 };
    assert_eq!([0.5, 1.0, 2.0].map(|level| step.probability(level)), [0.0, 0.5, 1.0]);
    for (median, probability) in [(0.0, 1.0), (f64::INFINITY, 0.0)] {
        assert_eq!(FragilityCurve { median, dispersion: 0.0 }.probability(1.0), probability);
    }
    // Fewer runs beyond the limit at higher levels, and no runs at all.
    assert_eq!(curve(&of_four_runs([3.0, 2.0, 1.0])), None);
    assert_eq!(fit(&counted(&levels, &[0.0; 3], &[0.0; 3])), None);
    // A level whose runs all failed has no effect.
    let counts = of_four_runs([1.0, 2.0, 3.0]);
    let mut with_failed_level = counts.clone();
    with_failed_level.push(Stripe { level: 3.0, runs: 0.0, exceeded: 0.0 });
    let computed = fit(&with_failed_level).unwrap().curve;
    let expected = fit(&counts).unwrap().curve;
    assert!(
        (computed.median - expected.median).abs() < 1e-12
            && computed != FragilityCurve { median: 0.0, ..computed }
    );
}

/// Motions have capacities from a lognormal distribution, and exceed the limit at every level above: the
/// band of the bootstrap contains the true median in about 90 of 100 cases, the band of independent runs in far fewer.
#[test]
fn bands_contain_the_true_median() {
    let median = 0.8;
    let dispersion = 0.5;
    let motions = 20;
    let trials = 300;
    let levels = [0.2, 0.3, 0.45, 0.6, 0.8, 1.0, 1.3, 1.6, 2.0];
    let mut random = Random(7);
    let mut in_band = 0;
    let mut within_independent_errors = 0;
    let mut mean = 0.0;
    for _ in 0..trials {
        let outcomes: Vec<Vec<_>> = (0..motions)
            .map(|_| {
                // Box and Muller.
                let u = 1.0 - random.within(0.0, 1.0);
                let v = random.within(0.0, 1.0);
                let deviate = (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos();
                let capacity = median * (dispersion * deviate).exp();
                levels.iter().map(|&level| Some(level > capacity)).collect()
            })
            .collect();
        let fitted_curve = fit(&stripes(&levels, outcomes.iter())).unwrap();
        mean += (fitted_curve.curve.median / median).ln() / f64::from(trials);
        let samples = resampled(&levels, &outcomes, 200, || random.bits());
        let medians: Vec<_> = samples.iter().map(|curve| curve.median).collect();
        let low = quantile(medians.clone(), 0.05);
        let high = quantile(medians, 0.95);
        in_band += i32::from(low <= median && median <= high);
        let error = (fitted_curve.curve.median / median).ln().abs();
        within_independent_errors += i32::from(error < 1.645 * fitted_curve.median_error);
    }
    // 90 % of 300 with a standard deviation of 1.7 %; percentiles of 20 records contain a little less.
    let covered = f64::from(in_band) / f64::from(trials);
    let independent = f64::from(within_independent_errors) / f64::from(trials);
    assert!((0.83..0.95).contains(&covered), "{covered}");
    assert!(independent < covered - 0.1, "{independent} beside {covered}");
    // Of the mean of 300: 0.5 / √(20 · 300).
    assert!(mean.abs() < 3.0 * 0.5 / (20.0_f64 * 300.0).sqrt(), "{mean}");
}

#[test]
fn accelerations_of_pulses_are_derivatives_of_their_velocities() {
    for (period, oscillations, phase) in [(0.6, 1.3, 0.0), (1.6, 2.0, 90.0), (2.5, 3.0, 45.0)] {
        let pulse = Pulse { period, oscillations, phase };
        let end = pulse.duration();
        let h = 1e-5;
        assert!((end - oscillations * period).abs() < 1e-15);
        for k in 1..40 {
            let time = end * f64::from(k) / 40.0;
            let slope = (pulse.velocity(time + h) - pulse.velocity(time - h)) / (2.0 * h);
            assert!((pulse.acceleration(time) - slope).abs() < 1e-7, "{time}: {slope}");
        }
        for rest in [0.0, end, -1.0, end + 1.0] {
            assert!(pulse.velocity(rest).abs() < 1e-12 && pulse.acceleration(rest).abs() < 1e-10);
        }
        // The envelope is 1 in the middle.
        let middle = pulse.velocity(0.5 * end);
        assert!((middle - phase.to_radians().cos()).abs() < 1e-12, "{middle}");
    }
}
