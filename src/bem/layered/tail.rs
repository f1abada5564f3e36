//! The wavenumber integral beyond the last panel, by a series.
//!
//! For k > K only the top layer affects the surface (e^(−2kh) is rounding). Its compliance is a power series
//! in x = q₂/k²,
//!
//! C = 1/(μk) Σ dⱼ xʲ,   `C_xx` = √(1+x)/(μkρ), `C_zz` = √(1+a²x)/(μkρ),
//! `C_xz` = (2 + x − 2√(1+x)√(1+a²x))/(μkxρ),   xρ = (2+x)² − 4√(1+x)√(1+a²x)
//!
//! with a radius of convergence of (`c_R`/`c_S`)². With `S_p` `S_q` cos kX = −D²[cos ky]/k², D² the second
//! difference over the elements' ends, the remaining integrals are
//!
//! `E_m` = ∫₁^∞ t^(−m) e^(iκt) dt,   κ = Ky,  m = 3, 5, …
//!
//! (generalised exponential integrals, Abramowitz & Stegun 5.1), which depend only on K and the mesh.

use std::sync::OnceLock;

use super::form_factors::{FormFactors, FormRow, PAIR_LANES};
use crate::linalg::Complex;

/// Number of terms of the series: for |x| ≤ 1/16 the last is below rounding.
pub(crate) const TAIL_TERMS: usize = 16;
/// Number of terms of products of series, some of which begin with x.
const PRODUCT_TERMS: usize = TAIL_TERMS + 2;
/// Smallest K of the tail, relative to |√q₂|.
pub(crate) const TAIL_START_RATIO: f64 = 4.0;

/// Coefficients dⱼ of xx, zz and xz for one Poisson's ratio.
pub(crate) fn surface_series(a2: f64) -> [[f64; TAIL_TERMS]; 3] {
    let alpha = square_root_series(a2);
    let beta = square_root_series(1.0);
    let product: [f64; PRODUCT_TERMS] =
        std::array::from_fn(|j| (0..=j).map(|i| alpha[i] * beta[j - i]).sum());
    // xρ and the numerator of xz begin with x.
    let mut rho: [f64; PRODUCT_TERMS] = product.map(|p| -4.0 * p);
    rho[1] += 4.0;
    rho[2] += 1.0;
    let mut coupling = product.map(|p| -2.0 * p);
    coupling[1] += 1.0;
    [
        series_quotient(&beta, &rho[1..]),
        series_quotient(&alpha, &rho[1..]),
        series_quotient(&coupling[1..], &rho[1..]),
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
        let previous: f64 = (0..j).map(|i| series[i] * denominator[j - i]).sum();
        series[j] = (numerator[j] - previous) / denominator[0];
    }
    series
}

/// Integrals beyond K for the pairs of a patch, computed when a K first occurs.
#[derive(Debug)]
pub(crate) struct Tails {
    tables: Vec<OnceLock<Box<[FormRow]>>>,
}

impl Default for Tails {
    fn default() -> Self {
        Self { tables: (0..8 * 61).map(|_| OnceLock::new()).collect() }
    }
}

/// Rounds `panels` up to the form m·2ᵉ with m ≤ 16, so that few different numbers occur.
pub(crate) fn on_grid(panels: usize) -> usize {
    let step = grid(panels);
    panels.div_ceil(step) * step
}

/// The power 2ᵉ for which `panels` is between 8 and 16 times this power.
pub(crate) fn grid(panels: usize) -> usize {
    1 << (panels.max(8).ilog2() - 3)
}

impl Tails {
    /// Rows j = 0, 1, … of K^(2j) ∫_K^∞ k^(−1−2j) `S_p` `S_q` (cos, sin) kX dk, block by block.
    ///
    /// K is at the end of a [grid](on_grid) number of panels.
    pub(crate) fn rows(&self, forms: &FormFactors, panels: usize) -> &[FormRow] {
        let step = grid(panels);
        let index = 8 * step.ilog2() as usize + panels / step;
        let limit = panels as f64 * forms.width;
        self.tables[index.min(self.tables.len() - 1)].get_or_init(|| table(forms, limit))
    }
}

/// Rows of all pairs for K = `limit`.
fn table(forms: &FormFactors, limit: f64) -> Box<[FormRow]> {
    let mut rows = vec![FormRow::default(); forms.blocks() * TAIL_TERMS];
    for (class, shape) in forms.shapes.iter().enumerate() {
        for (y, [even, odd]) in shape.waves() {
            let integrals = exponential_integrals(limit * y);
            for (j, integral) in integrals.iter().enumerate() {
                let row = &mut rows[class / PAIR_LANES * TAIL_TERMS + j];
                row[0][class % PAIR_LANES] += even / (limit * limit) * integral.re;
                row[1][class % PAIR_LANES] += odd / (limit * limit) * integral.im;
            }
        }
    }
    rows.into_boxed_slice()
}

/// Largest m of the integrals `E_m`.
const MAX_TAIL_ORDER: usize = 2 * TAIL_TERMS + 1;

/// Euler's constant γ.
const EULER_GAMMA: f64 = 0.577_215_664_901_532_9;

/// `E_m` for m = 3, 5, …, κ ≥ 0.
fn exponential_integrals(kappa: f64) -> [Complex; TAIL_TERMS] {
    let mut integrals = [Complex::default(); MAX_TAIL_ORDER + 1];
    if kappa == 0.0 {
        return std::array::from_fn(|j| Complex::real(1.0 / (2 * j + 2) as f64));
    }
    let wave = Complex::polar(1.0, kappa);
    let z = Complex::new(0.0, -kappa);
    // m E_{m+1} = e^(iκ) − z E_m is stable upwards for m > κ and downwards for m < κ.
    let mut start = 1;
    if kappa < 1.0 {
        // E₁ = −γ − ln z − Σ (−z)ⁿ/(n n!)
        let mut sum = Complex::new(-EULER_GAMMA - kappa.ln(), 0.5 * std::f64::consts::PI);
        let mut power = Complex::real(1.0);
        for n in 1..=20 {
            power = (power * -z).scale(1.0 / f64::from(n));
            sum = sum - power.scale(1.0 / f64::from(n));
        }
        integrals[1] = sum;
    } else {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let middle = kappa.clamp(2.0, MAX_TAIL_ORDER as f64) as usize;
        start = middle;
        integrals[start] = wave * continued_fraction(z, start as f64);
        for m in (1..start).rev() {
            integrals[m] = (wave - integrals[m + 1].scale(m as f64)) / z;
        }
    }
    for m in start..MAX_TAIL_ORDER {
        integrals[m + 1] = (wave - z * integrals[m]).scale(1.0 / m as f64);
    }
    std::array::from_fn(|j| integrals[2 * j + 3])
}

/// e^z `E_m`(z) by its continued fraction 1/(z + m − m/(z + m + 2 − …)) (Lentz's method).
fn continued_fraction(z: Complex, order: f64) -> Complex {
    let mut b = z + Complex::real(order);
    let mut c = Complex::real(1e300);
    let mut d = b.inverse();
    let mut value = d;
    for i in 1..2000 {
        let n = f64::from(i);
        let a = -n * (order - 1.0 + n);
        b += Complex::real(2.0);
        d = (d.scale(a) + b).inverse();
        c = b + c.inverse().scale(a);
        let factor = c * d;
        value = value * factor;
        if (factor - Complex::real(1.0)).abs() < 1e-16 {
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

    /// E_m by repeated integration by parts at large κ, and by the series near 0, satisfies the recurrence.
    #[test]
    fn tail_integrals_match_quadrature() {
        let rule = crate::linalg::gauss::largest();
        for kappa in [0.0, 1e-6, 0.3, 0.999, 1.0, 2.5, 9.0, 30.0, 200.0] {
            let found = exponential_integrals(kappa);
            for j in [0, 1, 5, TAIL_TERMS - 1] {
                let m = i32::try_from(2 * j + 3).unwrap();
                // t = 1/v: ∫₀¹ v^(m−2) e^(iκ/v) dv oscillates. The path is rotated instead: t = 1 + iu.
                let mut sum = Complex::default();
                let pieces = 400;
                for piece in 0..pieces {
                    // u = (w/(1 − w))², w in 0..1, because for κ = 0 the integrand decays only like a power.
                    for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
                        let h = 1.0 / f64::from(pieces);
                        let w = h * (f64::from(piece) + 0.5 * (1.0 + node));
                        let u = (w / (1.0 - w)).powi(2);
                        let slope = 2.0 * w / (1.0 - w).powi(3);
                        let t = Complex::new(1.0, u);
                        let mut power = Complex::real(1.0);
                        for _ in 0..m {
                            power = power / t;
                        }
                        let value = power.scale((-kappa * u).exp() * slope * 0.5 * h * weight);
                        sum += value * Complex::new(0.0, 1.0);
                    }
                }
                let wanted = sum * Complex::polar(1.0, kappa);
                let error = (found[j] - wanted).abs() / wanted.abs();
                assert!(error < 1e-11, "{kappa} {m} {error:e} {:?} {wanted:?}", found[j]);
            }
        }
    }

    #[test]
    fn series_is_the_half_plane() {
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
            let wanted = compliance.at(k);
            for (series, wanted) in series.iter().zip([wanted.xx, wanted.zz, wanted.xz]) {
                let x = top.q2.scale(1.0 / (k * k));
                let mut sum = Complex::default();
                for d in series.iter().rev() {
                    sum = sum * x + Complex::real(*d);
                }
                let found = sum / top.modulus.scale(k);
                assert!(
                    (found - wanted).abs() < 2e-14 * wanted.abs().max(0.01),
                    "{nu} {found:?} {wanted:?}"
                );
            }
        }
    }

    #[test]
    fn grid_is_coarse_and_never_below() {
        for n in 1..5000 {
            let found = on_grid(n);
            assert!(found >= n && found <= n + n / 8, "{n} {found}");
            assert_eq!(on_grid(found), found);
        }
    }
}
