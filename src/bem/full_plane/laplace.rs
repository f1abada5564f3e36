//! Fundamental solution of the full elastic plane in the Laplace domain.
//!
//! A line load e^{st} in direction j at the origin (Cruse & Rizzo 1968; Eringen & Suhubi 1975,
//! § 5.10 transformed):
//!
//! * `U_ij` = (1/2πρ) {`δ_ij` K₀(z₂)/c₂² + s⁻² ∂ᵢ∂ⱼ [K₀(z₁) − K₀(z₂)]} = ψ `δ_ij` − χ `e_i` `e_j`
//! * 2πρ ψ = K₀(z₂)/c₂² + K₁(z₂)/(z₂c₂²) − K₁(z₁)/(z₁c₁²)
//! * 2πρ χ = K₂(z₂)/c₂² − K₂(z₁)/c₁²
//! * 2πρ rψ' = −z₂K₁(z₂)/c₂² − 2πρ χ
//! * 2πρ rχ' = −4πρ χ − z₂K₁(z₂)/c₂² + z₁K₁(z₁)/c₁²
//!
//! Near the load the poles 1/z² of K₁/z, and 2/z² of K₂ = K₀ + 2K₁/z, cancel between both waves. There they
//! are omitted from the start.
//!
//! | symbol | meaning |
//! |---|---|
//! | s | Laplace's variable, Re s > 0, 1/s |
//! | r, e | distance from the load and unit vector of the offset |
//! | c₁, c₂ | P and S wave speeds |
//! | z₁, z₂ | s r/c₁, s r/c₂ |

use std::f64::consts::PI;

use super::Boundary;
use super::boundary::PairClasses;
use crate::error::Result;
use crate::soil::Soil;
use complex_bessel::{Scaling, besselk_seq};
use realfft::num_complex::Complex;

/// The full plane of a soil at one s.
#[derive(Debug, Clone, Copy)]
pub(super) struct LaplacePlane {
    /// s/c₁, 1/m.
    pub(super) pressure: Complex64,
    /// s/c₂, 1/m.
    pub(super) shear: Complex64,
    /// 1/c₁² and 1/c₂² over 2πρ.
    pub(super) weights: [f64; 2],
    shear_modulus: f64,
    /// λ/μ.
    lame: f64,
}

/// ψ, χ, rψ' and rχ'.
#[derive(Debug, Clone, Copy)]
pub(super) struct Radial {
    pub(super) psi: Complex64,
    pub(super) chi: Complex64,
    pub(super) psi_slope: Complex64,
    pub(super) chi_slope: Complex64,
}

/// Displacements and tractions at a point.
pub(super) type Pair = ([[Complex64; 2]; 2], [[Complex64; 2]; 2]);

impl LaplacePlane {
    pub(super) fn new(soil: Soil, s: Complex64) -> Self {
        let (fast, slow) = (soil.pressure_wave_speed(), soil.shear_wave_speed());
        let unit = 1.0 / (2.0 * PI * soil.density());
        let nu = soil.poisson();
        Self {
            pressure: s / fast,
            shear: s / slow,
            weights: [unit / (fast * fast), unit / (slow * slow)],
            shear_modulus: soil.shear_modulus(),
            lame: 2.0 * nu / (1.0 - 2.0 * nu),
        }
    }

    pub(super) fn radial(&self, r: f64) -> Radial {
        let z = self.shear * r;
        let regular = z.norm() <= SERIES_REACH;
        let shear = modified(z, regular);
        let pressure = modified(self.pressure * r, regular);
        let [fast, slow] = self.weights;
        let psi = slow * (shear.zeroth + shear.quotient) - fast * pressure.quotient;
        let chi = slow * (shear.zeroth + 2.0 * shear.quotient)
            - fast * (pressure.zeroth + 2.0 * pressure.quotient);
        let front = slow * shear.product;
        Radial {
            psi,
            chi,
            psi_slope: -front - chi,
            chi_slope: -2.0 * chi - front + fast * pressure.product,
        }
    }

    /// `u[i][j]` and `t[i][j]`, components i at `offset` with unit normal `normal`, load j.
    pub(super) fn kernels(&self, offset: [f64; 2], normal: [f64; 2]) -> Pair {
        let r = offset[0].hypot(offset[1]);
        let e = [offset[0] / r, offset[1] / r];
        let f = self.radial(r);
        let along = e[0] * normal[0] + e[1] * normal[1];
        let scale = self.shear_modulus / r;
        let shear = scale * (f.psi_slope - f.chi);
        let chi = 2.0 * scale * f.chi;
        let triple = 2.0 * (chi - scale * f.chi_slope) * along;
        let pressure = self.lame * (shear - scale * f.chi_slope);
        let mut u = [[Complex64::default(); 2]; 2];
        let mut t = u;
        for i in 0..2 {
            for j in 0..2 {
                let (same, delta) =
                    if i == j { (f.psi, along) } else { (Complex64::default(), 0.0) };
                u[i][j] = same - f.chi * (e[i] * e[j]);
                t[i][j] = shear * (delta + e[i] * normal[j]) + pressure * (e[j] * normal[i])
                    - chi * (normal[i] * e[j])
                    + triple * (e[i] * e[j]);
            }
        }
        (u, t)
    }
}

// Modified Bessel functions K₀ and K₁ of complex argument, and their power series.
//
// | symbol | meaning |
// |---|---|
// | z | argument, Re z > 0 |
// | q | (z/2)² |
// | κ | K₁(z)/z − 1/z²: K₁/z without its pole |
//
// With ψ the digamma function [Abramowitz & Stegun 1964, 9.6.10–9.6.13],
//
// * K₀ = Σ qᵏ/(k!)² · (ψ(k+1) − ln(z/2)),
// * κ = Σ qᵏ/(k!(k+1)!) · (½ ln(z/2) − ¼ψ(k+1) − ¼ψ(k+2)).

/// Complex number of double precision.
pub(super) type Complex64 = Complex<f64>;

/// Largest |z| at which the series has all digits; it loses the factor I₀/|K₀|, below 20.
pub(super) const SERIES_REACH: f64 = 2.0;

/// Real part beyond which K is below 1e-30 and counts as zero.
const NOTHING: f64 = 70.0;

/// Number of terms of the series: (q^k/k!²) is below 1e-17 at |z| = 2.
const TERMS: usize = 14;

/// Euler's constant.
const EULER: f64 = 0.577_215_664_901_532_9;

/// K₀, K₁/z or κ, and z K₁ of one argument.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Modified {
    /// K₀(z).
    pub(super) zeroth: Complex64,
    /// K₁(z)/z, or κ if `regular` was set.
    pub(super) quotient: Complex64,
    /// z K₁(z).
    pub(super) product: Complex64,
}

/// K₀ and K₁ of `z`; with `regular`, κ instead of K₁/z, for |z| ≤ [`SERIES_REACH`].
pub(super) fn modified(z: Complex64, regular: bool) -> Modified {
    if z.norm() <= SERIES_REACH {
        let [zeroth, kappa] = series(z, false);
        let square = z * z;
        let quotient = if regular { kappa } else { kappa + 1.0 / square };
        return Modified { zeroth, quotient, product: 1.0 + square * kappa };
    }
    if z.re > NOTHING {
        return Modified::default();
    }
    if let Ok(found) = besselk_seq(0.0, z, 2, Scaling::Unscaled) {
        let (zeroth, first) = (found.values[0], found.values[1]);
        return Modified { zeroth, quotient: first / z, product: first * z };
    }
    // Only arguments that are not finite reach this point; the result must not be finite either.
    let nan = Complex64::new(f64::NAN, f64::NAN);
    Modified { zeroth: nan, quotient: nan, product: nan }
}

/// K₀ and κ at `z`; with `mean`, their means over the line from 0 to `z`.
pub(super) fn series(z: Complex64, mean: bool) -> [Complex64; 2] {
    let half = 0.5 * z;
    let (log, q) = (half.ln(), half * half);
    let mut power = Complex64::new(1.0, 0.0);
    let mut sums = [Complex64::default(); 2];
    let mut digamma = -EULER;
    for k in 0..TERMS {
        let next = (k + 1) as f64;
        // ∫₀¹ x^{2k} ln(xz/2) dx = (ln(z/2) − 1/(2k+1))/(2k+1)
        let (scale, log) = if mean {
            let odd = (2 * k + 1) as f64;
            (power / odd, log - 1.0 / odd)
        } else {
            (power, log)
        };
        sums[0] += scale * (digamma - log);
        sums[1] += scale / next * (0.5 * log - 0.5 * digamma - 0.25 / next);
        digamma += 1.0 / next;
        power *= q / (next * next);
    }
    sums
}

// The static limit of the boundary equation (Kelvin's solution).
//
// With time the functions of [`super::step_integrals`] tend to D = (c₂⁻²−c₁⁻²)/2, Q = c⁻², and
// L₁ + L₂ to −(c₁⁻²+c₂⁻²) ln(r/L₀), L₀ a length that no static plane fixes.

/// The primitives of displacement (dd, dn, nn; 1/2πρ) and traction (μ/2πρ) at one end.
fn primitive(square: [f64; 2], lame: f64, s: f64, h: f64, datum: f64) -> [f64; 7] {
    let r = s.hypot(h);
    let d = 0.5 * (square[1] - square[0]);
    let growth = -(square[0] + square[1]);
    let log = (r / datum).ln();
    let angle = if h == 0.0 { 0.0 } else { (s / h).atan() };
    let logs = s * log - s + h * angle;
    let middle = 0.5 * (growth * logs - d * s);
    let dd = middle + d * (s - h * angle);
    let nn = middle + d * h * angle;
    let dn = d * h * log;
    // ∫ h/r², s/r², s h²/r⁴, h³/r⁴; D and Q are constants.
    let (one, two) = (angle, log);
    let three = -0.5 * (h / r).powi(2);
    let four = 0.5 * (h * s / (r * r) + angle);
    let bend = 8.0 * d + 2.0 * (square[0] - square[1]);
    let across = 2.0 * d * two - bend * three;
    [
        dd,
        dn,
        nn,
        (2.0 * d - square[1]) * one - bend * (one - four),
        across - square[1] * two,
        across - lame * square[0] * two,
        (6.0 * d - 2.0 * square[1] - lame * square[0]) * one - bend * four,
    ]
}

/// Static displacements of the contact elements per unit traction on them.
///
/// A 2Q × 2Q matrix in the order of contact vectors; all other elements are free.
pub(super) fn static_compliance(
    soil: Soil,
    boundary: &Boundary,
    datum: f64,
    matrix: &mut [f64],
) -> Result<()> {
    let (segments, layout) = (boundary.segments(), boundary.layout());
    let square = [soil.pressure_wave_speed(), soil.shear_wave_speed()].map(|c| 1.0 / (c * c));
    let lame = 2.0 * soil.poisson() / (1.0 - 2.0 * soil.poisson());
    let unit = 1.0 / (2.0 * std::f64::consts::PI * soil.density());
    let (mut g, mut h) = (vec![0.0; layout.square()], vec![0.0; layout.square()]);
    PairClasses::new(segments).fill(segments, &mut g, &mut h, 0.5, |ends, height| {
        let [low, high] = ends.map(|s| primitive(square, lame, s, height, datum));
        let at = |k: usize| unit * (high[k] - low[k]);
        let mu = soil.shear_modulus();
        [[[at(0), at(1)], [at(1), at(2)]], [[mu * at(3), mu * at(5)], [mu * at(4), mu * at(6)]]]
    });
    let (_, mobility) = boundary.mobility(&g, &h)?;
    boundary.compliance(&mobility, matrix);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: both branches have all digits. TABLE: mpmath, made by tests/data/bessel_k.py.
    #[test]
    fn values_agree_with_the_table() {
        let table = include_str!("../../../tests/data/bessel_k.csv");
        let mut rows = 0;
        for line in table.lines().filter(|line| !line.starts_with(['#', 'r'])) {
            let x: Vec<f64> = line.split(',').map(|field| field.parse().unwrap()).collect();
            let [z, k0, k1] = [0, 2, 4].map(|k| Complex64::new(x[k], x[k + 1]));
            let found = modified(z, false);
            for (what, found, wanted) in [
                ("K0", found.zeroth, k0),
                ("K1/z", found.quotient, k1 / z),
                ("zK1", found.product, k1 * z),
            ] {
                let error = (found - wanted).norm() / wanted.norm();
                assert!(error < 5e-14, "{what}({z}): {found} instead of {wanted}: {error:.1e}");
            }
            rows += 1;
        }
        assert_eq!(rows, 112);
    }

    /// GOAL: the regular part of K₁/z at the joint of both branches; near 0, its leading terms.
    #[test]
    fn regular_part_is_what_the_pole_leaves() {
        let z = Complex64::new(1.2, -1.5);
        let kappa = modified(z, true).quotient;
        let k1 = besselk_seq(0.0, z, 2, Scaling::Unscaled).unwrap().values[1];
        assert!((kappa - (k1 / z - 1.0 / (z * z))).norm() < 1e-14);
        let tiny = Complex64::new(3e-9, 1e-9);
        let leading = 0.5 * (0.5 * tiny).ln() + 0.5 * EULER - 0.25;
        assert!((modified(tiny, true).quotient - leading).norm() < 1e-14);
    }

    /// GOAL: means over [0, z] against a Gauss rule on a part away from the logarithm.
    #[test]
    fn means_are_integrals() {
        let z = Complex64::new(0.9, 1.1);
        let whole = series(z, true).map(|mean| mean * z);
        let half = series(0.5 * z, true).map(|mean| mean * 0.5 * z);
        let rule = crate::linalg::gauss::largest();
        let mut sums = [Complex64::default(); 2];
        for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
            let point = z * (0.75 + 0.25 * node);
            for (sum, value) in sums.iter_mut().zip(series(point, false)) {
                *sum += value * z * (0.25 * weight);
            }
        }
        for k in 0..2 {
            assert!((whole[k] - half[k] - sums[k]).norm() < 1e-14);
        }
    }
}

#[cfg(test)]
mod static_limit_tests {
    use super::*;
    use crate::bem::full_plane::step_integrals::{Medium, step_integrals};

    /// Response to a load that was switched on long ago, without its growth in time.
    #[test]
    fn a_held_load_tends_to_the_static_limit() {
        let soil = Soil::new(1.0, 0.2, 1.0).unwrap();
        let speeds = [soil.pressure_wave_speed(), soil.shear_wave_speed()];
        let square = speeds.map(|c| 1.0 / (c * c));
        let medium = Medium { speeds, lame: 0.4 / 0.6 };
        for (ends, h) in [([0.3, 1.1], 0.0), ([-0.4, 0.9], 0.6), ([1.0, 2.0], -0.5)] {
            let [low, high] = ends.map(|s| primitive(square, medium.lame, s, h, 1.0));
            let late = step_integrals(&medium, ends, h, 1e4);
            let t = late.traction.as_flattened();
            let [dd, dn, nn] = late.displacement;
            // ½ Σ c⁻² ln(2 c t) of each displacement.
            let growth: f64 = (0..2).map(|k| 0.5 * square[k] * (2e4 * speeds[k]).ln()).sum();
            let rise = growth * (ends[1] - ends[0]);
            let found = [dd - rise, dn, nn - rise, t[0], t[1], t[2], t[3]];
            for k in 0..7 {
                let wanted = high[k] - low[k];
                assert!((found[k] - wanted).abs() < 2e-7, "{ends:?} {k}: {} {wanted}", found[k]);
            }
        }
    }
}
