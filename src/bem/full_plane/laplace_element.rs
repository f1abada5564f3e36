//! Laplace-domain integrals over a straight element, seen from a collocation point.
//!
//! The element is x(ξ) = ξ t + d m from the point, a ≤ ξ ≤ b. The integrands are analytic except at ξ = ±i d,
//! and decay or oscillate like e^{−s r/c}. Pieces are halved until a Gauss rule has all digits. Over the
//! point's own element only the logarithm remains, because tractions are odd and vanish on a straight line.
//! The power series of the logarithm is integrated exactly.

use super::laplace::{Complex64, LaplacePlane, SERIES_REACH, series};
use crate::linalg::gauss;
use crate::soil::Soil;

/// An element relative to a collocation point at the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct View {
    /// Ends of the element, (x, z), m.
    pub(super) from: [f64; 2],
    pub(super) to: [f64; 2],
    /// Whether the point is the midpoint of this element.
    pub(super) own: bool,
}

/// Coefficients of one view: `g` xx, xz, zx, zz, then `h` in the same order, without the free term.
pub(super) type Block = [Complex64; 8];

/// A straight element in its own coordinates.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    /// ξ of both ends.
    pub(super) low: f64,
    pub(super) high: f64,
    /// Unit vector along the line, and outward normal, (x, z).
    pub(super) along: [f64; 2],
    pub(super) normal: [f64; 2],
    /// Offset of the line from the point along the normal.
    pub(super) aside: f64,
}

impl View {
    pub(super) fn line(&self) -> Line {
        let ([x, z], [to_x, to_z]) = (self.from, self.to);
        let length = (to_x - x).hypot(to_z - z);
        let along = [(to_x - x) / length, (to_z - z) / length];
        let normal = [along[1], -along[0]];
        if self.own {
            return Line { low: -0.5 * length, high: 0.5 * length, along, normal, aside: 0.0 };
        }
        let low = x * along[0] + z * along[1];
        Line { low, high: low + length, along, normal, aside: x * normal[0] + z * normal[1] }
    }

    /// Largest distance between the point and the element.
    pub(super) fn reach(&self) -> f64 {
        self.from[0].hypot(self.from[1]).max(self.to[0].hypot(self.to[1]))
    }
}

impl Line {
    /// Offset of the point ξ.
    pub(super) fn offset(&self, xi: f64) -> [f64; 2] {
        [0, 1].map(|i| xi * self.along[i] + self.aside * self.normal[i])
    }
}

/// Integrals over the element of `view` of displacements and tractions at one s.
pub(super) fn integrate(plane: &LaplacePlane, view: &View) -> Block {
    let line = view.line();
    let mut block = Block::default();
    if view.own {
        add_own(plane, &line, &mut block);
    } else {
        add_pieces(line.low, line.high, line.aside, plane, |xi, weight| {
            let (u, t) = plane.kernels(line.offset(xi), line.normal);
            // The load acts at the collocation point: the block of h is the transpose of the traction.
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                block[2 * i + j] += u[i][j] * weight;
                block[4 + 2 * i + j] += t[j][i] * weight;
            }
        });
    }
    block
}

/// Integrates over both halves of the point's own element: the logarithm by its series, the rest by pieces.
fn add_own(plane: &LaplacePlane, line: &Line, block: &mut Block) {
    let end = line.high;
    let near = end.min(SERIES_REACH / plane.shear.norm());
    let [fast, slow] = plane.weights;
    let [shear, shear_rest] = series(plane.shear * near, true);
    let [pressure, pressure_rest] = series(plane.pressure * near, true);
    let mut psi = near * (slow * (shear + shear_rest) - fast * pressure_rest);
    let mut chi =
        near * (slow * (shear + 2.0 * shear_rest) - fast * (pressure + 2.0 * pressure_rest));
    add_pieces(near, end, 0.0, plane, |xi, weight| {
        let radial = plane.radial(xi);
        psi += radial.psi * weight;
        chi += radial.chi * weight;
    });
    for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        let same = if i == j { psi } else { Complex64::default() };
        block[2 * i + j] += 2.0 * (same - chi * (line.along[i] * line.along[j]));
    }
}

/// Calls `add` with the points and weights of a rule for the kernels on [`low`, `high`].
fn add_pieces(
    low: f64,
    high: f64,
    aside: f64,
    plane: &LaplacePlane,
    mut add: impl FnMut(f64, f64),
) {
    let wave_number = plane.shear.norm();
    let mut waiting = vec![(low, high)];
    while let Some((low, high)) = waiting.pop() {
        let half = 0.5 * (high - low);
        let nearest = if low <= 0.0 && high >= 0.0 { 0.0 } else { low.abs().min(high.abs()) };
        if half <= 0.0 || plane.pressure.re * nearest.hypot(aside) > NOTHING {
            continue;
        }
        let reach =
            gauss::reach([0.0, aside], low, high).min(exponential_reach(wave_number * half));
        match gauss::rule_for(reach) {
            Some(rule) => {
                for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
                    add(low + half * (1.0 + node), half * weight);
                }
            }
            None if half > 1e-14 * nearest.max(low.abs()) => {
                waiting.push((low, low + half));
                waiting.push((low + half, high));
            }
            // The point lies on the element but is not its midpoint: this integral does not exist.
            None => {}
        }
    }
}

/// Exponents above which contributions are negligible.
const NOTHING: f64 = 50.0;

/// The reach for which [`gauss::rule_for`] selects a rule that also integrates e^{qx} on [−1, 1].
///
/// The error of n points is about π q^{2n}/(4ⁿ (2n)!) [Davis & Rabinowitz 1984, § 2.7].
fn exponential_reach(q: f64) -> f64 {
    let mut error = std::f64::consts::PI;
    for n in 1..=16_u32 {
        let even = f64::from(2 * n);
        error *= q * q / (4.0 * even * (even - 1.0));
        if error < 1e-15 {
            // Largest reach for which the selected rule has at least n points.
            return (16.118 / f64::from(n)).cosh();
        }
    }
    1.0
}

// Closed form of convolution-quadrature weights after the waves have passed.
//
// K₀ and K₁ carry the factor ln s: an integral over an element is K(s) = A(s²) ln s + B(s²) with
// A and B entire. Inside the circle of convergence B and polynomials have no late coefficients, so
//
// ```text
// ωₙ = Σ_k A_k Δt^{−2k} [ζⁿ] δ(ζ)^{2k} ln δ(ζ)      once n Δt exceeds the S wave's travel time,
// ```
//
// and with [ζⁿ] (1−ζ)^m ln(1−ζ) = −(−1)^m m!/(n(n−1)…(n−m)) for n > m:
//
// * BDF1: δ = 1−ζ;
// * BDF2: δ = (1−ζ)(1 + (1−ζ)/2), expanded binomially; the factor ln(1 + (1−ζ)/2) is singular
//   only at ζ = 3 and leaves 3^{−n}.
//
// The smeared front is neglected: with ρ = r/(c₂Δt) a Cauchy circle of radius X bounds it
// by e^{ρ(X−1)} X^{−n} (BDF1) and e^{ρ(X²−1)/2} X^{−n} (BDF2, 1 < X < 3).
//
// The leading term −A₀/n is Δt times the impulse response −A₀/t at t = nΔt. BDF2 departs from
// Δt·k(nΔt) at relative order n^{−2} and more, BDF1 at n^{−1} where A₁ matters (tractions).

/// Backward-differentiation formula behind a convolution quadrature.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum CqMethod {
    /// δ = 1 − ζ: first order, strongly damped.
    Bdf1,
    /// δ = (1 − ζ) + (1 − ζ)²/2: second order.
    #[default]
    Bdf2,
}

impl CqMethod {
    /// δ(ζ).
    pub(super) fn symbol(self, zeta: Complex64) -> Complex64 {
        let difference = 1.0 - zeta;
        match self {
            Self::Bdf1 => difference,
            Self::Bdf2 => difference * (1.0 + 0.5 * difference),
        }
    }
}

/// Number of terms k: A has degree 2k along an element, and the largest Gauss rule is exact to degree 51.
pub(super) const TERMS: usize = 26;

/// A_k R^{−2k} of one view, in the order of [`Block`].
pub(super) type LogTerms = [[f64; 8]; TERMS];

/// Coefficients of s^{2k} ln s; lengths in units of `unit`, and times in units of `unit`/c₂.
///
/// With I₀ and I₁/z of the factors ln s in K₀ → −I₀ and K₁/z → I₁/z, ψ = Σ p_k (s r)^{2k} and
/// χ = Σ q_k (s r)^{2k}; r^{2k−2} x_i x_j and similar terms are polynomials on the element.
pub(super) fn log_terms(soil: Soil, view: &View, unit: f64) -> LogTerms {
    let line = view.line();
    let (p, q) = radial_terms(soil);
    let (center, half) = (0.5 * (line.low + line.high), 0.5 * (line.high - line.low));
    let nu = soil.poisson();
    let lame = 2.0 * nu / (1.0 - 2.0 * nu);
    let rule = gauss::largest();
    let mut terms = [[0.0; 8]; TERMS];
    for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
        let x = line.offset(center + half * node);
        let square = (x[0] * x[0] + x[1] * x[1]) / (unit * unit);
        let n = line.normal;
        let along = x[0] * n[0] + x[1] * n[1];
        let weight = weight * half;
        // (r/R)^{2k} and (r/R)^{2k−2}.
        let (mut power, mut lower) = (1.0, 0.0);
        for (k, term) in terms.iter_mut().enumerate() {
            let twice = (2 * k) as f64;
            let (p, q) = (p[k], q[k]);
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let delta = if i == j { 1.0 } else { 0.0 };
                let both = x[i] * x[j] / (unit * unit);
                term[2 * i + j] += weight * (p * delta * power - q * lower * both);
                if view.own || k == 0 {
                    continue;
                }
                // Traction j on the element from load i at the point.
                let scale = weight * soil.shear_modulus() / (unit * unit);
                let mut value = (twice * p - q) * (delta * along + x[j] * n[i])
                    - 2.0 * q * n[j] * x[i]
                    + lame * (twice * (p - q) - q) * x[i] * n[j];
                // 4(1−k) q_k r^{2k−4} x_i x_j x_n vanishes for k = 1.
                if k > 1 {
                    value += (4.0 - 2.0 * twice) * q * along * both / square;
                }
                term[4 + 2 * i + j] += scale * lower * value;
            }
            (lower, power) = (power, power * square);
        }
    }
    terms
}

/// `p_k` and `q_k` for powers of s r/c₂: (s r/c₂)^{2k}.
fn radial_terms(soil: Soil) -> ([f64; TERMS], [f64; TERMS]) {
    let ratio = soil.speed_ratio_squared();
    let slow = soil.shear_wave_speed();
    let unit = 1.0 / (2.0 * std::f64::consts::PI * soil.density() * slow * slow);
    let (mut p, mut q) = ([0.0; TERMS], [0.0; TERMS]);
    // 1/(4^k k!²) and (c₂/c₁)^{2k+2}.
    let (mut scale, mut power) = (unit, ratio);
    for k in 0..TERMS {
        let next = (k + 1) as f64;
        p[k] = scale * (0.5 * (1.0 - power) / next - 1.0);
        // 1/((k−1)!(k+1)!) = k/((k+1) k!²), from I₂.
        q[k] = -scale * (1.0 - power) * k as f64 / next;
        scale /= 4.0 * next * next;
        power *= ratio;
    }
    (p, q)
}

/// [ζⁿ] (ρδ)^{2k} ln δ for all k, n > 2·TERMS·2.
pub(super) fn weights(method: CqMethod, lag: usize, rho: f64) -> [f64; TERMS] {
    let n = lag as f64;
    let mut weights = [0.0; TERMS];
    match method {
        CqMethod::Bdf1 => {
            let mut power = -1.0 / n;
            for (k, weight) in weights.iter_mut().enumerate() {
                *weight = power;
                for m in [2 * k + 1, 2 * k + 2] {
                    power *= -(m as f64) * rho / (n - m as f64);
                }
            }
        }
        CqMethod::Bdf2 => {
            // (ρ(1−ζ))^m ln(1−ζ)
            let mut powers = [0.0; 4 * TERMS];
            let mut power = -1.0 / n;
            for (m, entry) in powers.iter_mut().enumerate() {
                *entry = power;
                let m = (m + 1) as f64;
                power *= -m * rho / (n - m);
            }
            for (k, weight) in weights.iter_mut().enumerate() {
                let mut binomial = 1.0;
                for j in 0..=2 * k {
                    *weight += binomial * powers[2 * k + j];
                    binomial *= (2 * k - j) as f64 / (j + 1) as f64 * 0.5 / rho;
                }
            }
        }
    }
    weights
}

/// First lag at which the closed form has all digits, for distances up to ρ c₂ Δt.
pub(super) fn first_lag(method: CqMethod, rho: f64) -> usize {
    let mut lag = 8 * TERMS;
    while !is_late(method, lag, rho) {
        lag += 8 + lag / 16;
    }
    lag
}

/// Minus the logarithm of a negligible contribution.
const NEGLIGIBLE: f64 = 37.0;

fn is_late(method: CqMethod, lag: usize, rho: f64) -> bool {
    let n = lag as f64;
    if n <= 1.5 * rho {
        return false;
    }
    // Best radius of the circle, inside the singularity at 3 of BDF2.
    let front = match method {
        CqMethod::Bdf1 => {
            let x = n / rho;
            n * x.ln() - rho * (x - 1.0)
        }
        CqMethod::Bdf2 => {
            let x = (n / rho).sqrt().min(2.9);
            n * x.ln() - 0.5 * rho * (x * x - 1.0)
        }
    };
    // Last term of the series relative to the first: the largest A_k is below 1/(4^k k!²).
    let weights = weights(method, lag, rho);
    let factor: f64 = (1..TERMS).map(|k| 0.25 / (k * k) as f64).product();
    front > NEGLIGIBLE && (weights[TERMS - 1] * factor).abs() < 1e-17 * weights[0].abs()
}
