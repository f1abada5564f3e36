//! Lognormal fragility curves by maximum likelihood, and their confidence.
//!
//! P(x) = Φ(ln(x/θ)/β), median θ, dispersion β. Of n runs at level x, z exceed the limit, and
//! ln L = Σ z ln P + (n − z) ln(1 − P): Baker, "Efficient analytical fragility function fitting using
//! dynamic structural analysis", Earthquake Spectra 31 (2015), 579–599, Eq. 11. In a + b ln x, with b =
//! 1/β and a = −ln θ/β, this is a probit regression, whose likelihood has one maximum.

use libm::erfc;

/// Runs at one level of intensity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stripe {
    pub(crate) level: f64,
    pub(crate) runs: f64,
    /// Of these, those beyond the limit.
    pub(crate) exceeded: f64,
}

/// A lognormal curve; a step where the dispersion is zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FragilityCurve {
    pub(crate) median: f64,
    pub(crate) dispersion: f64,
}

impl FragilityCurve {
    /// Probability that the limit is exceeded at this level.
    pub(crate) fn probability(&self, level: f64) -> f64 {
        if level == self.median {
            return 0.5;
        }
        normal((level / self.median).ln() / self.dispersion)
    }
}

/// A fitted curve with standard errors of ln θ and β.
///
/// The Fisher information assumes that all runs are independent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Fit {
    pub(crate) curve: FragilityCurve,
    pub(crate) median_error: f64,
    pub(crate) dispersion_error: f64,
}

/// Φ(z).
pub(crate) fn normal(z: f64) -> f64 {
    0.5 * erfc(-z / std::f64::consts::SQRT_2)
}

/// φ(z)/Φ(z).
fn mills(z: f64) -> f64 {
    // Φ underflows here: the first terms of its asymptotic series.
    if z < -30.0 {
        return -z - 1.0 / z;
    }
    (-0.5 * z * z).exp() / (std::f64::consts::TAU.sqrt() * normal(z))
}

/// ln Φ(z).
fn log_normal(z: f64) -> f64 {
    if z < -30.0 {
        return -0.5 * z * z - (-z * std::f64::consts::TAU.sqrt()).ln();
    }
    normal(z).ln()
}

/// Logarithm of a level from their mean, and its numbers of runs beyond and within the limit.
struct ProbitPoint {
    y: f64,
    exceeded: f64,
    within: f64,
}

/// ln L of the coefficients a and b.
fn log_likelihood(points: &[ProbitPoint], [a, b]: [f64; 2]) -> f64 {
    let term = |count: f64, x: f64| if count > 0.0 { count * log_normal(x) } else { 0.0 };
    let mut sum = 0.0;
    for point in points {
        let x = a + b * point.y;
        sum += term(point.exceeded, x) + term(point.within, -x);
    }
    sum
}

/// Coefficients a and b of the largest likelihood, by Newton's method.
fn newton(points: &[ProbitPoint]) -> [f64; 2] {
    let mut coefficients = [0.0, 1.0];
    let mut value = log_likelihood(points, coefficients);
    for _ in 0..100 {
        let Derivatives { ga, gb, haa, hab, hbb } = derivatives(points, coefficients);
        let determinant = haa * hbb - hab * hab;
        let step = [(hbb * ga - hab * gb) / determinant, (haa * gb - hab * ga) / determinant];
        // ln L is concave, so that a sufficiently short step increases it.
        let mut fraction = 1.0;
        loop {
            let next_coefficients =
                [coefficients[0] + fraction * step[0], coefficients[1] + fraction * step[1]];
            let next_value = log_likelihood(points, next_coefficients);
            if next_value >= value || fraction < 1e-10 {
                coefficients = next_coefficients;
                value = next_value;
                break;
            }
            fraction *= 0.5;
        }
        let change = fraction * step[0].abs().max(step[1].abs());
        if change <= 1e-12 * (1.0 + coefficients[0].abs().max(coefficients[1].abs())) {
            break;
        }
    }
    coefficients
}

/// The curve of the largest likelihood.
///
/// None unless some level within the limit is above a level beyond it, and none if fewer runs exceed it at higher levels.
pub(crate) fn fit(stripes: &[Stripe]) -> Option<Fit> {
    if highest_level_within(stripes) <= lowest_level_beyond(stripes) {
        return None;
    }
    // Centred logarithms, so that both coefficients are of order one.
    let runs: f64 = stripes.iter().map(|stripe| stripe.runs).sum();
    let center = stripes.iter().map(|stripe| stripe.runs * stripe.level.ln()).sum::<f64>() / runs;
    let points: Vec<ProbitPoint> = stripes
        .iter()
        .map(|stripe| ProbitPoint {
            y: stripe.level.ln() - center,
            exceeded: stripe.exceeded,
            within: stripe.runs - stripe.exceeded,
        })
        .collect();
    let [a, b] = newton(&points);
    if !(a.is_finite() && b > 0.0) {
        return None;
    }
    let curve = FragilityCurve { median: (center - a / b).exp(), dispersion: 1.0 / b };
    // Inverse information, and the delta method for center − a/b and 1/b.
    let Derivatives { haa, hab, hbb, .. } = derivatives(&points, [a, b]);
    let determinant = haa * hbb - hab * hab;
    let vaa = hbb / determinant;
    let vab = -hab / determinant;
    let vbb = haa / determinant;
    let da = -1.0 / b;
    let db = a / (b * b);
    let median_error = (da * da * vaa + 2.0 * da * db * vab + db * db * vbb).sqrt();
    Some(Fit { curve, median_error, dispersion_error: vbb.sqrt() / (b * b) })
}

/// Gradient of ln L by a and b, and its negative second derivatives.
#[derive(Default)]
struct Derivatives {
    ga: f64,
    gb: f64,
    haa: f64,
    hab: f64,
    hbb: f64,
}

fn derivatives(points: &[ProbitPoint], [a, b]: [f64; 2]) -> Derivatives {
    let mut sums = Derivatives::default();
    for &ProbitPoint { y, exceeded, within } in points {
        let x = a + b * y;
        let up = mills(x);
        let mills_below = mills(-x);
        let slope = exceeded * up - within * mills_below;
        let curvature = exceeded * up * (up + x) + within * mills_below * (mills_below - x);
        sums.ga += slope;
        sums.gb += slope * y;
        sums.haa += curvature;
        sums.hab += curvature * y;
        sums.hbb += curvature * y * y;
    }
    sums
}

fn highest_level_within(stripes: &[Stripe]) -> f64 {
    let within = stripes.iter().filter(|stripe| stripe.runs - stripe.exceeded > 0.0);
    within.map(|stripe| stripe.level).fold(0.0, f64::max)
}

fn lowest_level_beyond(stripes: &[Stripe]) -> f64 {
    let beyond = stripes.iter().filter(|stripe| stripe.exceeded > 0.0);
    beyond.map(|stripe| stripe.level).fold(f64::INFINITY, f64::min)
}

/// The curve by [`fit`], or a step where one level separates runs within the limit from runs beyond it.
///
/// The likelihood tends to this step. None if fewer runs exceed the limit at higher levels.
pub(crate) fn curve(stripes: &[Stripe]) -> Option<FragilityCurve> {
    let within = highest_level_within(stripes);
    let beyond = lowest_level_beyond(stripes);
    if within > beyond {
        return fit(stripes).map(|fit| fit.curve);
    }
    // At zero if all runs exceed the limit, at infinity if none does.
    let median = if within == 0.0 || beyond.is_infinite() {
        if within == 0.0 { 0.0 } else { f64::INFINITY }
    } else {
        (within * beyond).sqrt()
    };
    Some(FragilityCurve { median, dispersion: 0.0 })
}

/// Whether each record, row by row, exceeds the limit at each level; `None` for a run that failed.
pub(crate) type Outcomes = Vec<Vec<Option<bool>>>;

/// Counts of some records, which may be repeated.
pub(crate) fn stripes<'a>(
    levels: &[f64],
    records: impl Iterator<Item = &'a Vec<Option<bool>>>,
) -> Vec<Stripe> {
    let mut stripes: Vec<_> =
        levels.iter().map(|&level| Stripe { level, runs: 0.0, exceeded: 0.0 }).collect();
    for record in records {
        for (stripe, exceeds) in stripes.iter_mut().zip(record) {
            stripe.runs += f64::from(u8::from(exceeds.is_some()));
            stripe.exceeded += f64::from(u8::from(*exceeds == Some(true)));
        }
    }
    stripes
}

/// Curves of `count` samples of the records, drawn with replacement: a bootstrap over records, whose
/// runs at different levels are not independent.
pub(crate) fn resampled(
    levels: &[f64],
    outcomes: &Outcomes,
    count: usize,
    mut random: impl FnMut() -> u64,
) -> Vec<FragilityCurve> {
    let mut curves = Vec::new();
    for _ in 0..count {
        let sample = (0..outcomes.len()).map(|_| {
            let record = random() % (outcomes.len() as u64);
            &outcomes[usize::try_from(record).unwrap_or(0)]
        });
        curves.extend(curve(&stripes(levels, sample)));
    }
    curves
}

/// Value below which this fraction of the values lies; NaN without values.
pub(crate) fn quantile(mut values: Vec<f64>, fraction: f64) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    let index = fraction * values.len().saturating_sub(1) as f64;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
    values.get(index.round() as usize).copied().unwrap_or(f64::NAN)
}

/// Fraction of the bootstrap's curves within a band.
const BAND_FRACTION: f64 = 0.9;

/// The curve of a friction coefficient and a width.
pub(crate) struct FragilityGroup {
    pub(crate) friction: f64,
    pub(crate) width: f64,
    pub(crate) stripes: Vec<Stripe>,
    pub(crate) fit: Option<Fit>,
    /// Curves of the bootstrap.
    pub(crate) samples: Vec<FragilityCurve>,
}

impl FragilityGroup {
    /// Bounds of the band: quantiles of a value of the bootstrap's curves.
    pub(crate) fn band(&self, value: impl Fn(&FragilityCurve) -> f64) -> [f64; 2] {
        let tail = 0.5 * (1.0 - BAND_FRACTION);
        let values: Vec<_> = self.samples.iter().map(value).collect();
        [tail, 1.0 - tail].map(|fraction| quantile(values.clone(), fraction))
    }
}
