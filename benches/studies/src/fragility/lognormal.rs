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
pub(crate) struct Curve {
    pub(crate) median: f64,
    pub(crate) dispersion: f64,
}

impl Curve {
    /// Probability that the limit is exceeded at this level.
    pub(crate) fn probability(&self, level: f64) -> f64 {
        if level == self.median {
            return 0.5;
        }
        normal((level / self.median).ln() / self.dispersion)
    }
}

/// A fitted curve with standard errors of ln θ and β from the Fisher information, which takes all runs
/// as independent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Fit {
    pub(crate) curve: Curve,
    pub(crate) errors: [f64; 2],
}

/// Φ(z).
pub(crate) fn normal(z: f64) -> f64 {
    0.5 * erfc(-z / std::f64::consts::SQRT_2)
}

/// φ(z)/Φ(z).
fn mills(z: f64) -> f64 {
    // Far left Φ underflows: the first terms of its asymptotic series.
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

/// The curve of the largest likelihood; none unless runs within the limit reach above runs beyond
/// it, and none if fewer exceed it at higher levels.
pub(crate) fn fit(stripes: &[Stripe]) -> Option<Fit> {
    let [within, beyond] = ends(stripes);
    if within <= beyond {
        return None;
    }
    // Centred logarithms, so that both coefficients are of order one.
    let runs: f64 = stripes.iter().map(|stripe| stripe.runs).sum();
    let center = stripes.iter().map(|s| s.runs * s.level.ln()).sum::<f64>() / runs;
    let points: Vec<_> =
        stripes.iter().map(|s| (s.level.ln() - center, s.exceeded, s.runs - s.exceeded)).collect();
    let likelihood = |[a, b]: [f64; 2]| -> f64 {
        let term = |&(y, z, rest): &(f64, f64, f64)| {
            let x = a + b * y;
            let part = |count: f64, x: f64| if count > 0.0 { count * log_normal(x) } else { 0.0 };
            part(z, x) + part(rest, -x)
        };
        points.iter().map(term).sum()
    };
    let mut at = [0.0, 1.0];
    let mut value = likelihood(at);
    for _ in 0..100 {
        let ([ga, gb], [haa, hab, hbb]) = derivatives(&points, at);
        let determinant = haa * hbb - hab * hab;
        let step = [(hbb * ga - hab * gb) / determinant, (haa * gb - hab * ga) / determinant];
        // ln L is concave: a step that is short enough rises.
        let mut share = 1.0;
        let (next, higher) = loop {
            let next = [at[0] + share * step[0], at[1] + share * step[1]];
            let higher = likelihood(next);
            if higher >= value || share < 1e-10 {
                break (next, higher);
            }
            share *= 0.5;
        };
        let moved = share * step[0].abs().max(step[1].abs());
        (at, value) = (next, higher);
        if moved <= 1e-12 * (1.0 + at[0].abs().max(at[1].abs())) {
            break;
        }
    }
    let [a, b] = at;
    if !(a.is_finite() && b > 0.0) {
        return None;
    }
    let curve = Curve { median: (center - a / b).exp(), dispersion: 1.0 / b };
    // Inverse information, and the delta method for center − a/b and 1/b.
    let (_, [haa, hab, hbb]) = derivatives(&points, at);
    let determinant = haa * hbb - hab * hab;
    let [vaa, vab, vbb] = [hbb / determinant, -hab / determinant, haa / determinant];
    let (da, db) = (-1.0 / b, a / (b * b));
    let median = (da * da * vaa + 2.0 * da * db * vab + db * db * vbb).sqrt();
    Some(Fit { curve, errors: [median, vbb.sqrt() / (b * b)] })
}

/// Gradient of ln L, and its negative second derivatives aa, ab, bb.
fn derivatives(points: &[(f64, f64, f64)], [a, b]: [f64; 2]) -> ([f64; 2], [f64; 3]) {
    let (mut gradient, mut curvature) = ([0.0; 2], [0.0; 3]);
    for &(y, z, rest) in points {
        let x = a + b * y;
        let (up, down) = (mills(x), mills(-x));
        let slope = z * up - rest * down;
        let bend = z * up * (up + x) + rest * down * (down - x);
        gradient = [gradient[0] + slope, gradient[1] + slope * y];
        curvature = [curvature[0] + bend, curvature[1] + bend * y, curvature[2] + bend * y * y];
    }
    (gradient, curvature)
}

/// Highest level with a run within the limit, lowest with one beyond it.
fn ends(stripes: &[Stripe]) -> [f64; 2] {
    let levels = |counts: fn(&Stripe) -> f64| {
        stripes.iter().filter(move |s| counts(s) > 0.0).map(|s| s.level)
    };
    let within = levels(|s| s.runs - s.exceeded).fold(0.0, f64::max);
    [within, levels(|s| s.exceeded).fold(f64::INFINITY, f64::min)]
}

/// The curve that [`fit`] finds, or the step that the likelihood tends to where one level parts the
/// runs within the limit from those beyond it; none if fewer exceed it at higher levels.
pub(crate) fn curve(stripes: &[Stripe]) -> Option<Curve> {
    let [within, beyond] = ends(stripes);
    if within > beyond {
        return fit(stripes).map(|fit| fit.curve);
    }
    // At zero if all runs exceed the limit, at infinity if none does.
    let median = if within == 0.0 || beyond.is_infinite() {
        if within == 0.0 { 0.0 } else { f64::INFINITY }
    } else {
        (within * beyond).sqrt()
    };
    Some(Curve { median, dispersion: 0.0 })
}

/// Whether each record, row by row, exceeds the limit at each level; `None` for a run that failed.
pub(crate) type Outcomes = Vec<Vec<Option<bool>>>;

/// Counts of some records, which may come several times.
pub(crate) fn stripes<'a>(
    levels: &[f64],
    records: impl Iterator<Item = &'a Vec<Option<bool>>>,
) -> Vec<Stripe> {
    let empty = |&level: &f64| Stripe { level, runs: 0.0, exceeded: 0.0 };
    let mut stripes: Vec<_> = levels.iter().map(empty).collect();
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
) -> Vec<Curve> {
    let mut draw = || {
        let sample = (0..outcomes.len()).map(|_| {
            let at = random() % (outcomes.len() as u64);
            &outcomes[usize::try_from(at).unwrap_or(0)]
        });
        curve(&stripes(levels, sample))
    };
    (0..count).filter_map(|_| draw()).collect()
}

/// Value below which `share` of the values lie; NaN of none.
pub(crate) fn quantile(mut values: Vec<f64>, share: f64) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    let place = share * values.len().saturating_sub(1) as f64;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
    values.get(place.round() as usize).copied().unwrap_or(f64::NAN)
}

/// Share of the bootstrap's curves within a band.
const BAND: f64 = 0.9;

/// The curve of a friction coefficient and a width.
pub(crate) struct Group {
    pub(crate) friction: f64,
    pub(crate) width: f64,
    pub(crate) stripes: Vec<Stripe>,
    pub(crate) fit: Option<Fit>,
    /// Of the bootstrap.
    pub(crate) samples: Vec<Curve>,
}

impl Group {
    /// Bounds of the band: quantiles of a number that the curves of the bootstrap have.
    pub(crate) fn band(&self, of: impl Fn(&Curve) -> f64) -> [f64; 2] {
        let tail = 0.5 * (1.0 - BAND);
        let values: Vec<_> = self.samples.iter().map(of).collect();
        [tail, 1.0 - tail].map(|share| quantile(values.clone(), share))
    }
}
