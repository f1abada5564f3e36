//! Wavenumber integrals beyond the last panel, by a series.
//!
//! For k > K only the top layer affects the surface: e^(−2kh) is below rounding. The compliance of its soil is a power
//! series in x = q₂/k²,
//!
//! C = 1/(μk) Σ dⱼ xʲ,   `C_xx` = √(1+x)/(μkρ), `C_zz` = √(1+a²x)/(μkρ),
//! `C_xz` = (2 + x − 2√(1+x)√(1+a²x))/(μkxρ),   xρ = (2+x)² − 4√(1+x)√(1+a²x)
//!
//! with a radius of convergence of (`c_R`/`c_S`)². `S_p` `S_q` cos kX = −D²[cos ky]/k² with the second difference D² over
//! the elements' ends. The remaining integrals are
//!
//! `E_m` = ∫₁^∞ t^(−m) e^(iκt) dt,   κ = Ky,  m = 3, 5, …
//!
//! (generalised exponential integrals, Abramowitz & Stegun 5.1), which depend only on K and the mesh.

use std::sync::OnceLock;

use super::form_factors::{FormFactors, FormRow, PAIR_LANES};
use crate::linalg::Complex;

/// Number of terms of the series, of which the last is below rounding for |x| ≤ 1/16.
pub(crate) const TAIL_TERMS: usize = 16;
/// Number of terms of products of series, because the first terms of some products are zero.
const PRODUCT_TERMS: usize = TAIL_TERMS + 2;
/// Smallest K of the tail, relative to |√q₂|, for which the series converges fast.
pub(crate) const TAIL_START_RATIO: f64 = 4.0;

/// Coefficients dⱼ of the series of xx, zz and xz for a² = (`c_S`/`c_P`)².
pub(crate) fn surface_series(a2: f64) -> [[f64; TAIL_TERMS]; 3] {
    let alpha = square_root_series(a2);
    let beta = square_root_series(1.0);
    let product: [f64; PRODUCT_TERMS] =
        std::array::from_fn(|j| (0..=j).map(|i| alpha[i] * beta[j - i]).sum());
    // The first term of xρ and of the numerator of xz is the term of x.
    let mut x_rho: [f64; PRODUCT_TERMS] = product.map(|p| -4.0 * p);
    x_rho[1] += 4.0;
    x_rho[2] += 1.0;
    let mut coupling_numerator = product.map(|p| -2.0 * p);
    coupling_numerator[1] += 1.0;
    [
        series_quotient(&beta, &x_rho[1..]),
        series_quotient(&alpha, &x_rho[1..]),
        series_quotient(&coupling_numerator[1..], &x_rho[1..]),
    ]
}

/// Coefficients of √(1 + `factor` x) in powers of x.
fn square_root_series(factor: f64) -> [f64; PRODUCT_TERMS] {
    let mut series = [1.0; PRODUCT_TERMS];
    for j in 1..PRODUCT_TERMS {
        series[j] = series[j - 1] * factor * (1.5 - j as f64) / j as f64;
    }
    series
}

/// Coefficients of the quotient of two power series.
fn series_quotient(numerator: &[f64], denominator: &[f64]) -> [f64; TAIL_TERMS] {
    let mut series = [0.0; TAIL_TERMS];
    for j in 0..TAIL_TERMS {
        let lower_terms: f64 = (0..j).map(|i| series[i] * denominator[j - i]).sum();
        series[j] = (numerator[j] - lower_terms) / denominator[0];
    }
    series
}

/// Number of different rounded numbers of panels: eight multiples of each power of two of a 64-bit number.
const TAIL_TABLE_COUNT: usize = 8 * 61;

/// Integrals beyond K for all pairs, computed at the first use of each K.
#[derive(Debug)]
pub(crate) struct Tails {
    tables: Vec<OnceLock<Box<[FormRow]>>>,
}

impl Default for Tails {
    fn default() -> Self {
        Self { tables: (0..TAIL_TABLE_COUNT).map(|_| OnceLock::new()).collect() }
    }
}

/// Rounds a number of panels up to the form m·2ᵉ with m ≤ 16, so that few different numbers occur.
pub(crate) fn rounded_panel_count(panel_count: usize) -> usize {
    let step = panel_count_step(panel_count);
    panel_count.div_ceil(step) * step
}

/// Power 2ᵉ to whose multiples a number of panels is rounded: an eighth to a sixteenth of it.
pub(crate) fn panel_count_step(panel_count: usize) -> usize {
    1 << (panel_count.max(8).ilog2() - 3)
}

impl Tails {
    /// Rows j = 0, 1, … of K^(2j) ∫_K^∞ k^(−1−2j) `S_p` `S_q` (cos, sin) kX dk, block by block.
    ///
    /// K is the end of the last panel; `panel_count` is [rounded](rounded_panel_count).
    pub(crate) fn rows(&self, forms: &FormFactors, panel_count: usize) -> &[FormRow] {
        let step = panel_count_step(panel_count);
        let index = 8 * step.ilog2() as usize + panel_count / step;
        let max_k = panel_count as f64 * forms.width;
        self.tables[index.min(self.tables.len() - 1)].get_or_init(|| tail_table(forms, max_k))
    }
}

/// Rows of all pairs for K = `max_k`.
fn tail_table(forms: &FormFactors, max_k: f64) -> Box<[FormRow]> {
    let mut rows = vec![FormRow::default(); forms.block_count() * TAIL_TERMS];
    for (class, shape) in forms.shapes.iter().enumerate() {
        for (y, [cosine_factor, sine_factor]) in shape.waves() {
            let integrals = exponential_integrals(max_k * y);
            for (j, integral) in integrals.iter().enumerate() {
                let row = &mut rows[class / PAIR_LANES * TAIL_TERMS + j];
                row[0][class % PAIR_LANES] += cosine_factor / (max_k * max_k) * integral.re;
                row[1][class % PAIR_LANES] += sine_factor / (max_k * max_k) * integral.im;
            }
        }
    }
    rows.into_boxed_slice()
}

/// Largest m of the integrals `E_m`.
const MAX_TAIL_ORDER: usize = 2 * TAIL_TERMS + 1;
/// Number of terms of the series of E₁ for κ < 1, after which the next term is below rounding.
const E1_SERIES_TERMS: u32 = 20;
/// Largest number of terms of the continued fraction, far above the number with which it converges.
const MAX_FRACTION_TERMS: u32 = 2000;
/// Relative change below which the continued fraction has converged, a rounding error.
const FRACTION_TOLERANCE: f64 = 1e-16;
/// Start of the numerators' ratio in Lentz's method, in place of infinity.
const LENTZ_START: f64 = 1e300;

/// Euler's constant γ.
const EULER_GAMMA: f64 = 0.577_215_664_901_532_9;

/// Integrals `E_m` for m = 3, 5, … and κ ≥ 0.
fn exponential_integrals(kappa: f64) -> [Complex; TAIL_TERMS] {
    let mut integrals = [Complex::default(); MAX_TAIL_ORDER + 1];
    if kappa == 0.0 {
        return std::array::from_fn(|j| Complex::real(1.0 / (2 * j + 2) as f64));
    }
    let wave = Complex::polar(1.0, kappa);
    let z = Complex::new(0.0, -kappa);
    // m E_{m+1} = e^(iκ) − z E_m is stable upwards for m > κ and downwards for m < κ.
    let mut start_order = 1;
    if kappa < 1.0 {
        // E₁ = −γ − ln z − Σ (−z)ⁿ/(n n!)
        let mut sum = Complex::new(-EULER_GAMMA - kappa.ln(), 0.5 * std::f64::consts::PI);
        let mut power = Complex::real(1.0);
        for n in 1..=E1_SERIES_TERMS {
            power = (power * -z).scale(1.0 / f64::from(n));
            sum = sum - power.scale(1.0 / f64::from(n));
        }
        integrals[1] = sum;
    } else {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let order = kappa.clamp(2.0, MAX_TAIL_ORDER as f64) as usize;
        start_order = order;
        integrals[start_order] = wave * continued_fraction(z, start_order as f64);
        for m in (1..start_order).rev() {
            integrals[m] = (wave - integrals[m + 1].scale(m as f64)) / z;
        }
    }
    for m in start_order..MAX_TAIL_ORDER {
        integrals[m + 1] = (wave - z * integrals[m]).scale(1.0 / m as f64);
    }
    std::array::from_fn(|j| integrals[2 * j + 3])
}

/// e^z `E_m`(z) by its continued fraction 1/(z + m − m/(z + m + 2 − …)) (Lentz's method).
fn continued_fraction(z: Complex, order: f64) -> Complex {
    let mut b = z + Complex::real(order);
    let mut c = Complex::real(LENTZ_START);
    let mut d = b.inverse();
    let mut value = d;
    for i in 1..MAX_FRACTION_TERMS {
        let n = f64::from(i);
        let a = -n * (order - 1.0 + n);
        b += Complex::real(2.0);
        d = (d.scale(a) + b).inverse();
        c = b + c.inverse().scale(a);
        let factor = c * d;
        value = value * factor;
        if (factor - Complex::real(1.0)).abs() < FRACTION_TOLERANCE {
            break;
        }
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bem::layered::compliance::LayeredCompliance;
    use crate::soil::{Soil, SoilProfile};

    /// The integrals agree with quadrature on a path without oscillations.
    #[test]
    fn tail_integrals_match_quadrature() {
        let rule = crate::linalg::gauss::largest_rule();
        for kappa in [0.0, 1e-6, 0.3, 0.999, 1.0, 2.5, 9.0, 30.0, 200.0] {
            let computed = exponential_integrals(kappa);
            for j in [0, 1, 5, TAIL_TERMS - 1] {
                let m = i32::try_from(2 * j + 3).unwrap();
                // The integrand oscillates on the real axis. The path t = 1 + iu has no oscillations.
                let mut sum = Complex::default();
                let piece_count = 400;
                for piece in 0..piece_count {
                    // u = (w/(1 − w))², w in 0..1, because for κ = 0 the integrand decays only like a power.
                    for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
                        let h = 1.0 / f64::from(piece_count);
                        let w = h * (f64::from(piece) + 0.5 * (1.0 + node));
                        let u = (w / (1.0 - w)).powi(2);
                        let derivative = 2.0 * w / (1.0 - w).powi(3);
                        let t = Complex::new(1.0, u);
                        let mut power = Complex::real(1.0);
                        for _ in 0..m {
                            power = power / t;
                        }
                        let value = power.scale((-kappa * u).exp() * derivative * 0.5 * h * weight);
                        sum += value * Complex::new(0.0, 1.0);
                    }
                }
                let expected = sum * Complex::polar(1.0, kappa);
                let error = (computed[j] - expected).abs() / expected.abs();
                assert!(error < 1e-11, "{kappa} {m} {error:e} {:?} {expected:?}", computed[j]);
            }
        }
    }

    #[test]
    fn series_agrees_with_the_half_plane() {
        for nu in [-0.9, 0.0, 0.25, 0.4999] {
            let soil = Soil::new(2.0, nu, 1.5).unwrap();
            let series = surface_series(soil.speed_ratio_squared());
            assert!((series[0][0] - (1.0 - nu)).abs() < 1e-14);
            assert!((series[2][0] + 0.5 * (1.0 - 2.0 * nu)).abs() < 1e-14);
            let s = Complex::new(0.5, 1.0);
            let mut compliance = LayeredCompliance::default();
            compliance.set(&SoilProfile::on_half_plane(soil), s).unwrap();
            let top = compliance.top();
            let k = TAIL_START_RATIO * top.q2.sqrt().abs();
            let surface = compliance.at(k);
            for (component_series, expected) in
                series.iter().zip([surface.xx, surface.zz, surface.xz])
            {
                let x = top.q2.scale(1.0 / (k * k));
                let mut sum = Complex::default();
                for d in component_series.iter().rev() {
                    sum = sum * x + Complex::real(*d);
                }
                let computed = sum / top.modulus.scale(k);
                assert!(
                    (computed - expected).abs() < 2e-14 * expected.abs().max(0.01),
                    "{nu} {computed:?} {expected:?}"
                );
            }
        }
    }

    #[test]
    fn panel_counts_are_rounded_up_by_at_most_an_eighth() {
        for n in 1..5000 {
            let rounded_count = rounded_panel_count(n);
            assert!(rounded_count >= n && rounded_count <= n + n / 8, "{n} {rounded_count}");
            assert_eq!(rounded_panel_count(rounded_count), rounded_count);
        }
    }
}
