//! The Bouc–Wen curve in closed form: where the hysteretic variable goes on a straight path.
//!
//! | symbol | meaning |
//! |---|---|
//! | y | hysteretic variable, positive in the direction of motion, −1 ≤ y ≤ 1 |
//! | ξ | way since the last commit, in yield displacements |
//! | n, β, γ | exponent and shape, β + γ = 1; b = β − γ |
//!
//! On a straight path the law dy/dξ = 1 − (β sgn y + γ)|y|ⁿ has separate variables,
//!
//! ```text
//! ξ = X(y₁) − X(y₀),   X(y) = ∫₀^y ds/(1 − sⁿ) for y > 0,   −∫₀^|y| ds/(1 + b sⁿ) for y < 0
//! ```
//!
//! so any number of steps along it lead to the same place. Below ½ the integrals are sums of powers,
//! above ½ Gauss's rule takes what remains when the logarithm of 1 − s is split off:
//! 1/(1 − sⁿ) − 1/(n(1 − s)) is smooth up to s = 1.

use crate::linalg::gauss;

/// Exponent and shape, with the integrals up to ½.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Curve {
    exponent: f64,
    /// b = β − γ.
    unloading: f64,
}

/// Newton's iterations; they converge from one side, quadratically at last.
const ITERATIONS: usize = 60;

impl Curve {
    pub(super) fn new(exponent: f64, beta: f64) -> Self {
        Self { exponent, unloading: 2.0 * beta - 1.0 }
    }

    /// dy/dξ.
    pub(super) fn slope(&self, y: f64) -> f64 {
        let power = y.abs().powf(self.exponent);
        if y > 0.0 { 1.0 - power } else { 1.0 + self.unloading * power }
    }

    /// y after a way ξ ≥ 0 from y₀, and ∫ y (1 − dy/dξ) dξ, what the way dissipates.
    pub(super) fn advance(&self, start: f64, way: f64) -> (f64, f64) {
        if !(start.abs() <= 1.0 && way.is_finite()) {
            return (f64::NAN, f64::NAN);
        }
        let (mut start, mut way) = (start, way);
        let mut dissipated = 0.0;
        if start < 0.0 {
            let turn = self.unloaded(-start, 0);
            if turn >= way {
                let end = self.find_unloaded(turn - way);
                return (-end, self.unloading_loss(-start, end));
            }
            dissipated = self.unloading_loss(-start, 0.0);
            way -= turn;
            start = 0.0;
        }
        let end = self.find_loaded(start, way);
        let stored = 0.5 * (end - start) * (end + start);
        let loss = way - (self.lagging(end) - self.lagging(start)) - stored;
        (end, dissipated + loss.max(0.0))
    }

    /// ∫ s/(…) · b sⁿ/(1 + b sⁿ) over an unloading from `from` to `to`.
    fn unloading_loss(&self, from: f64, to: f64) -> f64 {
        let stored = 0.5 * (from - to) * (from + to);
        (stored - (self.unloaded(from, 1) - self.unloaded(to, 1))).max(0.0)
    }

    /// ∫₀^w sᵖ ds/(1 + b sⁿ).
    fn unloaded(&self, w: f64, p: i32) -> f64 {
        let (n, b) = (self.exponent, self.unloading);
        let low = w.min(0.5);
        self.series(-b, low, p) + integral(low, w, |s| s.powi(p) / (1.0 + b * s.powf(n)))
    }

    /// ∫₀^y (1 − s)/(1 − sⁿ) ds.
    fn lagging(&self, y: f64) -> f64 {
        let low = y.min(0.5);
        self.series(1.0, low, 0) - self.series(1.0, low, 1)
            + integral(low, y, |s| (1.0 - s) / (1.0 - s.powf(self.exponent)))
    }

    /// Σ cᵏ x^(nk+p+1)/(nk+p+1) = ∫₀^x sᵖ ds/(1 − c sⁿ) for x ≤ ½ and |c| ≤ 1.
    fn series(&self, c: f64, x: f64, p: i32) -> f64 {
        let ratio = x.powf(self.exponent);
        let (mut power, mut order) = (x.powi(p + 1), f64::from(p + 1));
        let mut sum = 0.0;
        loop {
            let term = power / order;
            sum += term;
            // Also ends on NaN.
            let matters = term.abs() > 1e-18 * sum.abs();
            if !matters {
                return sum;
            }
            power *= c * ratio;
            order += self.exponent;
        }
    }

    /// w with ∫₀^w ds/(1 + b sⁿ) = `way`: Newton from the left on a concave function.
    fn find_unloaded(&self, way: f64) -> f64 {
        let mut w = way.min(1.0);
        for _ in 0..ITERATIONS {
            let step = (way - self.unloaded(w, 0)) * self.slope(-w);
            w = (w + step).min(1.0);
            if step.abs() <= 1e-16 {
                break;
            }
        }
        w
    }

    /// y after `way` from `start` ≥ 0, in v = −ln(1 − y): X is concave in v, with slopes from 1 to 1/n.
    fn find_loaded(&self, start: f64, way: f64) -> f64 {
        if start >= 1.0 || way == 0.0 {
            return start;
        }
        let target = self.loaded(-(-start).ln_1p()) + way;
        let mut v = target;
        for _ in 0..ITERATIONS {
            // (1 − yⁿ)/(1 − y)
            let slope = -f64::exp_m1(self.exponent * (-(-v).exp()).ln_1p()) / (-v).exp();
            let slope = if slope.is_finite() { slope } else { self.exponent };
            let step = (target - self.loaded(v)) * slope;
            v += step;
            if step.abs() <= 1e-15 * v.abs() {
                break;
            }
        }
        // The last digit must not turn back.
        (-f64::exp_m1(-v)).clamp(start, 1.0)
    }

    /// X at y = 1 − exp(−v).
    fn loaded(&self, v: f64) -> f64 {
        let n = self.exponent;
        let y = -f64::exp_m1(-v);
        if y <= 0.5 {
            return self.series(1.0, y, 0);
        }
        let rest = |s: f64| 1.0 / (1.0 - s.powf(n)) - 1.0 / (n * (1.0 - s));
        self.series(1.0, 0.5, 0) + (v - std::f64::consts::LN_2) / n + integral(0.5, y, rest)
    }
}

/// ∫ of a smooth function; zero for an empty range.
fn integral(low: f64, high: f64, f: impl Fn(f64) -> f64) -> f64 {
    if high <= low {
        return 0.0;
    }
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let rule = gauss::largest();
    let points = rule.nodes.iter().zip(&rule.weights);
    half * points.map(|(x, weight)| weight * f(middle + half * x)).sum::<f64>()
}
