//! GOAL: the study fits the curves of the largest likelihood and estimates their confidence. SCENE: counts that are
//! published, made by formula, or drawn. REFERENCE: probit regression in the literature, a search over the likelihood
//! with a normal distribution of its own, and the curves that counts were made of.

use super::lognormal::{Curve, Stripe, curve, fit, normal, quantile, resampled, stripes};
use super::motions::Pulse;

use basemat_problems::random::Random;

fn counted(levels: &[f64], runs: &[f64], exceeded: &[f64]) -> Vec<Stripe> {
    let each = levels.iter().zip(runs).zip(exceeded);
    each.map(|((&level, &runs), &exceeded)| Stripe { level, runs, exceeded }).collect()
}

/// Φ by Simpson's rule.
fn integrated(z: f64) -> f64 {
    let (steps, width) = (2000, z / 2000.0);
    let density = |x: f64| (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt();
    let sum: f64 = (0..=steps)
        .map(|k| {
            let weight = if k == 0 || k == steps { 1.0 } else { f64::from(2 + 2 * (k % 2)) };
            weight * density(f64::from(k) * width)
        })
        .sum();
    0.5 + sum * width / 3.0
}

#[test]
fn the_normal_distribution() {
    for z in [-6.0, -2.5, -1.0, 0.0, 0.3, 1.96, 5.0] {
        assert!((normal(z) - integrated(z)).abs() < 1e-13, "{z}");
    }
}

/// Beetles under gaseous carbon disulphide, Bliss, Annals of Applied Biology 22 (1935), 134–167; probit
/// regression on the logarithm of the dose in Dobson and Barnett, "An introduction to generalized
/// linear models", 3rd edition, table 7.4: −34.94 (standard error 2.64) and 19.73 (1.48).
#[test]
fn bliss_1935_beetles() {
    let doses = [1.6907, 1.7242, 1.7552, 1.7842, 1.8113, 1.8369, 1.8610, 1.8839];
    let levels = doses.map(|dose: f64| 10.0_f64.powf(dose));
    let beetles = [59.0, 60.0, 62.0, 56.0, 63.0, 59.0, 62.0, 60.0];
    let killed = [6.0, 13.0, 18.0, 28.0, 52.0, 53.0, 61.0, 60.0];
    let found = fit(&counted(&levels, &beetles, &killed)).unwrap();
    let ten = 10.0_f64.ln();
    let slope = ten / found.curve.dispersion;
    let intercept = -found.curve.median.ln() / found.curve.dispersion;
    assert!((slope - 19.73).abs() < 0.006, "{slope}");
    assert!((intercept + 34.94).abs() < 0.006, "{intercept}");
    // Error of the slope: the error of β divided by β² / ln 10.
    let error = found.errors[1] * ten / found.curve.dispersion.powi(2);
    assert!((error - 1.48).abs() < 0.012, "{error}");
}

#[test]
fn expected_counts_give_their_curve_back() {
    let levels = [0.1, 0.2, 0.4, 0.7, 1.0, 1.5, 2.5];
    for (median, dispersion) in [(0.5, 0.3), (1.2, 0.8), (0.15, 0.4), (30.0, 1.5), (1e-3, 2.0)] {
        let share = |level: f64| integrated((level / median).ln() / dispersion);
        let counts = levels.map(|level| 40.0 * share(level));
        let found = fit(&counted(&levels, &[40.0; 7], &counts)).unwrap().curve;
        assert!((found.median / median - 1.0).abs() < 1e-7, "{median}: {found:?}");
        assert!((found.dispersion / dispersion - 1.0).abs() < 1e-7, "{dispersion}: {found:?}");
    }
}

/// No neighbour on a fine grid is likelier, and the Fisher information is the curvature there.
#[test]
fn the_likelihood_is_highest_at_the_fit() {
    let levels = [0.2, 0.3, 0.4, 0.6, 0.7, 0.8, 0.9, 1.0];
    let (runs, counts) = ([40.0; 8], [0.0, 0.0, 0.0, 4.0, 6.0, 13.0, 12.0, 16.0]);
    let found = fit(&counted(&levels, &runs, &counts)).unwrap();
    let likelihood = |center: f64, dispersion: f64| -> f64 {
        let term = |k: usize| {
            let p = integrated((levels[k].ln() - center) / dispersion);
            counts[k] * p.ln() + (runs[k] - counts[k]) * (1.0 - p).ln()
        };
        // Where nothing exceeds, 0 · ln 0 counts as zero.
        (0..levels.len()).map(term).sum()
    };
    // From a coarse grid to a fine one around its best.
    let (mut best, mut span) = ([0.0, 0.6], [1.0, 0.5]);
    for _ in 0..12 {
        let [center, dispersion] = best;
        let points = (-10..=10).flat_map(|i| (-10..=10).map(move |j| [i, j]));
        let points = points.map(|[i, j]: [i32; 2]| {
            [center + 0.1 * f64::from(i) * span[0], dispersion + 0.1 * f64::from(j) * span[1]]
        });
        let value = |point: &[f64; 2]| likelihood(point[0], point[1]);
        let points = points.filter(|point| point[1] > 0.05);
        best = points.max_by(|a, b| value(a).total_cmp(&value(b))).unwrap();
        span = span.map(|width| 0.4 * width);
    }
    assert!((found.curve.median.ln() - best[0]).abs() < 1e-4, "{found:?}, {best:?}");
    assert!((found.curve.dispersion - best[1]).abs() < 1e-4, "{found:?}, {best:?}");

    // Observed information by differences; the fit's comes from the same second derivatives.
    let (h, [c, b]) = (1e-3, [found.curve.median.ln(), found.curve.dispersion]);
    let second = |[p, q]: [f64; 2], [r, s]: [f64; 2]| {
        let at = |x: f64, y: f64| likelihood(c + h * (x * p + y * r), b + h * (x * q + y * s));
        (at(1.0, 1.0) - at(1.0, -1.0) - at(-1.0, 1.0) + at(-1.0, -1.0)) / (4.0 * h * h)
    };
    let (u, v) = ([1.0, 0.0], [0.0, 1.0]);
    let (uu, uv, vv) = (-second(u, u), -second(u, v), -second(v, v));
    let determinant = uu * vv - uv * uv;
    for (found, wanted) in found.errors.iter().zip([vv / determinant, uu / determinant]) {
        assert!((found / wanted.sqrt() - 1.0).abs() < 1e-3, "{found}, {wanted}");
    }
}

#[test]
fn counts_without_a_finite_fit() {
    let levels = [0.5, 1.0, 2.0];
    let of = |counts: [f64; 3]| counted(&levels, &[4.0; 3], &counts);
    for (counts, median) in [
        ([0.0, 0.0, 0.0], f64::INFINITY),
        ([4.0, 4.0, 4.0], 0.0),
        ([0.0, 4.0, 4.0], 0.5_f64.sqrt()),
        ([0.0, 2.0, 4.0], 1.0),
    ] {
        assert_eq!(fit(&of(counts)), None);
        let step = curve(&of(counts)).unwrap();
        assert!((step.median == median || (step.median - median).abs() < 1e-15), "{step:?}");
        assert_eq!(step.dispersion, 0.0);
    }
    let step = Curve { median: 1.0, dispersion: 0.0 };
    assert_eq!([0.5, 1.0, 2.0].map(|level| step.probability(level)), [0.0, 0.5, 1.0]);
    for (median, probability) in [(0.0, 1.0), (f64::INFINITY, 0.0)] {
        assert_eq!(Curve { median, dispersion: 0.0 }.probability(1.0), probability);
    }
    // Fewer at higher levels, and no runs at all.
    assert_eq!(curve(&of([3.0, 2.0, 1.0])), None);
    assert_eq!(fit(&counted(&levels, &[0.0; 3], &[0.0; 3])), None);
    // A level whose runs all failed does not matter.
    let counts = of([1.0, 2.0, 3.0]);
    let mut more = counts.clone();
    more.push(Stripe { level: 3.0, runs: 0.0, exceeded: 0.0 });
    let (found, wanted) = (fit(&more).unwrap().curve, fit(&counts).unwrap().curve);
    assert!(
        (found.median - wanted.median).abs() < 1e-12 && found != Curve { median: 0.0, ..found }
    );
}

/// Motions have capacities drawn from a lognormal distribution, and exceed at every level above: the
/// bootstrap's band holds the true median as often as it says, errors of independent runs do not.
#[test]
fn bands_hold_the_truth() {
    let (median, dispersion, motions, trials) = (0.8, 0.5, 20, 300);
    let levels = [0.2, 0.3, 0.45, 0.6, 0.8, 1.0, 1.3, 1.6, 2.0];
    let mut random = Random(7);
    let (mut held, mut independent, mut mean) = (0, 0, 0.0);
    for _ in 0..trials {
        let outcomes: Vec<Vec<_>> = (0..motions)
            .map(|_| {
                // Box and Muller.
                let (u, v) = (1.0 - random.within(0.0, 1.0), random.within(0.0, 1.0));
                let deviate = (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos();
                let capacity = median * (dispersion * deviate).exp();
                levels.iter().map(|&level| Some(level > capacity)).collect()
            })
            .collect();
        let found = fit(&stripes(&levels, outcomes.iter())).unwrap();
        mean += (found.curve.median / median).ln() / f64::from(trials);
        let samples = resampled(&levels, &outcomes, 200, || random.bits());
        let medians: Vec<_> = samples.iter().map(|curve| curve.median).collect();
        let [low, high] = [0.05, 0.95].map(|share| quantile(medians.clone(), share));
        held += i32::from(low <= median && median <= high);
        let off = (found.curve.median / median).ln().abs();
        independent += i32::from(off < 1.645 * found.errors[0]);
    }
    // 90 % of 300 with a standard deviation of 1.7 %; percentiles of 20 records hold a little less.
    let [held, independent] = [held, independent].map(|count| f64::from(count) / f64::from(trials));
    assert!((0.83..0.95).contains(&held), "{held}");
    assert!(independent < held - 0.1, "{independent} beside {held}");
    // Of the mean of 300: 0.5 / √(20 · 300).
    assert!(mean.abs() < 3.0 * 0.5 / (20.0_f64 * 300.0).sqrt(), "{mean}");
}

#[test]
fn pulses_are_derivatives_of_their_velocities() {
    for (period, oscillations, phase) in [(0.6, 1.3, 0.0), (1.6, 2.0, 90.0), (2.5, 3.0, 45.0)] {
        let pulse = Pulse { period, oscillations, phase };
        let (end, h) = (pulse.duration(), 1e-5);
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
