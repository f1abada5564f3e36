//! The Rayleigh polynomial of an elastic half-plane, its roots and the Rayleigh wave.
//!
//! With y the square of a slowness in units of the shear slowness, the Rayleigh function and its
//! conjugate multiply to the cubic
//!
//! P(y) = (1−2y)⁴ + 16 y²(y−a²)(1−y) = 16(a²−1) y³ + (24−16a²) y² − 8 y + 1
//!
//! (Achenbach 1973, ch. 7; Kausel 2006). One root, `y_R` > 1, is the Rayleigh wave. The other two
//! lie below a² as a real pair for Poisson's ratios up to 0.26308…, and are a complex pair above.
//!
//! | symbol | here | meaning |
//! |---|---|---|
//! | a² | `a2` | (`c_S`/`c_P`)² |
//! | h | `h` | 1 − a² = 1/(2(1−ν)) |
//! | g | `g` | 1 − 2a² = ν/(1−ν) |
//! | z | | y − a², not below zero once the pressure wave has passed |
//! | `y_R`, `z_R` | `square`, `z` | the Rayleigh root, and `y_R` − a² |
//! | σ, ϖ | `sum`, `product` | the other two roots in z solve z² + σ z + ϖ = 0 |

use crate::linalg::Complex;
use crate::soil::Soil;

/// Roots of the Rayleigh polynomial of one soil.
///
/// The quadratic factor is stored by its coefficients. They are smooth in Poisson's ratio where its roots
/// collide (ν = 0.26308…), and precise where one of its roots tends to a² like ν⁴ (ν → 0).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rayleigh {
    /// a² = (`c_S`/`c_P`)².
    pub(crate) a2: f64,
    /// 1 − a².
    pub(crate) h: f64,
    /// 1 − 2a².
    pub(crate) g: f64,
    /// `y_R`.
    pub(crate) square: f64,
    /// `y_R` − a².
    pub(crate) z: f64,
    /// `y_R` − 1.
    pub(crate) excess: f64,
    /// Minus the sum of the other roots, measured from a².
    pub(crate) sum: f64,
    /// Product of the other roots, measured from a².
    pub(crate) product: f64,
}

impl Rayleigh {
    /// Roots for a soil.
    pub(crate) fn new(soil: Soil) -> Self {
        let nu = soil.poisson();
        let a2 = soil.speed_ratio_squared();
        let h = 0.5 / (1.0 - nu);
        let g = nu / (1.0 - nu);
        // The cubic in w = y − 1, whose one positive root is the Rayleigh wave:
        // −16 h w³ + (24 − 16a² − 48h) w² + (40 − 32a² − 48h) w + 1.
        let cubic = [-16.0 * h, 32.0 * a2 - 24.0, 16.0 * a2 - 8.0, 1.0];
        // P(1) = 1 > 0 and P → −∞: bisect, then polish by Newton's method.
        let mut low = 0.0;
        let mut high = 4.0;
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            if cubic_value(cubic, middle) > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let mut excess = 0.5 * (low + high);
        for _ in 0..3 {
            excess -= cubic_value(cubic, excess) / cubic_slope(cubic, excess);
        }
        let z = excess + h;
        // In c = a² − y: 16h c³ + C₂ c² − C₁ c + g⁴ with C₂ = 48a⁴ − 64a² + 24; its roots sum to
        // −C₂/(16h) and multiply to −g⁴/(16h); c_R = −z is one of them.
        let c2 = (48.0 * a2 - 64.0) * a2 + 24.0;
        let sum = z - c2 / (16.0 * h);
        let product = g.powi(4) / (16.0 * h * z);
        Self { a2, h, g, square: 1.0 + excess, z, excess, sum, product }
    }

    /// Time at which the Rayleigh wave passes, `c_S` t/|x|: `c_S`/`c_R`.
    pub(crate) fn arrival(&self) -> f64 {
        self.square.sqrt()
    }

    /// z² + σ z + ϖ, the factor of the two roots that are not the Rayleigh wave.
    pub(crate) fn pair(&self, z: f64) -> f64 {
        (z + self.sum) * z + self.product
    }

    /// (σ/2)² − ϖ: positive for a real pair.
    pub(crate) fn discriminant(&self) -> f64 {
        0.25 * self.sum * self.sum - self.product
    }

    /// Roots of z² + σ z + (σ/2)² − d, for a complex discriminant d = `real` + i `imaginary`.
    pub(crate) fn shifted_roots(&self, real: f64, imaginary: f64) -> [Complex; 2] {
        let root = Complex::new(real, imaginary).sqrt();
        let middle = Complex::real(-0.5 * self.sum);
        if imaginary == 0.0 && real > 0.0 && self.sum > 0.0 {
            let far = middle - root;
            return [Complex::real(self.product / far.re), far];
        }
        [middle + root, middle - root]
    }

    /// The strength D of the Rayleigh pulse in `f_zx`: `f_zx` = … + D δ(τ − `τ_R`).
    pub(crate) fn pulse(&self) -> f64 {
        let y = self.square;
        let tau = self.arrival();
        let sa = self.z.sqrt();
        let sb = self.excess.sqrt();
        let k = 1.0 - 2.0 * y;
        let slope = -8.0 * tau * (k + sa * sb) - 4.0 * y * tau * (sb / sa + sa / sb);
        std::f64::consts::PI * tau * (k + 2.0 * sa * sb) / slope
    }

    /// Residue at the Rayleigh root, in z, of numerator/P.
    pub(crate) fn residue(&self, numerator: f64) -> f64 {
        -numerator / (16.0 * self.h * self.pair(self.z))
    }
}

/// A cubic at `w`, coefficients from the highest power down.
fn cubic_value(cubic: [f64; 4], w: f64) -> f64 {
    ((cubic[0] * w + cubic[1]) * w + cubic[2]) * w + cubic[3]
}

/// Derivative of the cubic at `w`.
fn cubic_slope(cubic: [f64; 4], w: f64) -> f64 {
    (3.0 * cubic[0] * w + 2.0 * cubic[1]) * w + cubic[2]
}

impl Soil {
    /// Rayleigh (R) wave speed, m/s: the speed of the surface wave (Achenbach 1973, § 5.11).
    pub fn rayleigh_wave_speed(&self) -> f64 {
        self.shear_wave_speed() / Rayleigh::new(*self).arrival()
    }
}

/// Number of terms of the series at late times.
///
/// They suffice for an error at rounding level from three Rayleigh arrivals on.
pub(crate) const LATE_SERIES_TERMS: usize = 20;

/// Coefficients of the kernel's series at late times, zz and xx.
///
/// `c_k` of f = Σ `c_k` τ^(−2k−1), which converges for τ above the Rayleigh arrival.
/// f = τ⁻¹ n(v)/p(v) with v = τ⁻² and p(v) = v³ P(1/v): the numerators are binomial series, and
/// the division by the cubic is a recurrence, stable because the Rayleigh root dominates.
pub(crate) fn late_coefficients(rayleigh: &Rayleigh) -> [[f64; LATE_SERIES_TERMS]; 2] {
    let a2 = rayleigh.a2;
    let sa = square_root_series(a2);
    let sb = square_root_series(1.0);
    let mut result = [[0.0; LATE_SERIES_TERMS]; 2];
    let p = [-16.0 * rayleigh.h, 24.0 - 16.0 * a2, -8.0, 1.0];
    for k in 0..LATE_SERIES_TERMS {
        let sa_k = last_three(&sa, k);
        let sb_k = last_three(&sb, k);
        let numerator = [
            (4.0 * sa_k[0] - 4.0 * sa_k[1] + sa_k[2]) + 4.0 * (sb_k[0] - a2 * sb_k[1]),
            4.0 * (sa_k[0] - sa_k[1]) + (4.0 * sb_k[0] - 4.0 * sb_k[1] + sb_k[2]),
        ];
        for (series, numerator) in result.iter_mut().zip(numerator) {
            let mut value = -numerator;
            for back in 1..=3.min(k) {
                value -= p[back] * series[k - back];
            }
            series[k] = value / p[0];
        }
    }
    result
}

/// Coefficients of √(1 − `factor` v) in powers of v.
fn square_root_series(factor: f64) -> [f64; LATE_SERIES_TERMS] {
    let mut series = [1.0; LATE_SERIES_TERMS];
    for k in 1..LATE_SERIES_TERMS {
        series[k] = series[k - 1] * factor * (k as f64 - 1.5) / k as f64;
    }
    series
}

/// Coefficients k, k − 1 and k − 2 of a series; zero before its first.
fn last_three(series: &[f64], k: usize) -> [f64; 3] {
    [0, 1, 2].map(|back| if k >= back { series[k - back] } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn soil(nu: f64) -> Soil {
        Soil::new(1.0, nu, 1.0).unwrap()
    }

    #[test]
    fn known_wave_speeds() {
        // nu = 1/4: y = (3 + sqrt 3)/4 exactly; nu = 0: c_R^2 = 3 - sqrt 5.
        let quarter = Rayleigh::new(soil(0.25));
        assert!((quarter.square - (3.0 + 3.0_f64.sqrt()) / 4.0).abs() < 4e-16);
        let roots = quarter.shifted_roots(quarter.discriminant(), 0.0);
        let first = quarter.a2 + roots[0].re;
        let second = quarter.a2 + roots[1].re;
        assert!((first - (3.0 - 3.0_f64.sqrt()) / 4.0).abs() < 4e-16);
        assert!((second - 0.25).abs() < 4e-16);
        let speed = soil(0.0).rayleigh_wave_speed();
        assert!((speed - (3.0 - 5.0_f64.sqrt()).sqrt()).abs() < 4e-16);
    }

    #[test]
    fn small_root_keeps_its_relative_precision() {
        // c (C1 - C2 c + ...) = g^4 with C1 = -P'(a^2).
        for nu in [1e-1, 1e-3, 1e-6, -1e-4] {
            let r = Rayleigh::new(soil(nu));
            let c = -r.shifted_roots(r.discriminant(), 0.0)[0].re;
            let k = r.g + 2.0 * c;
            let residual = k.powi(4) - 16.0 * (r.a2 - c).powi(2) * c * (r.h + c);
            assert!(residual.abs() < 1e-14 * r.g.powi(4), "{nu} {c:e} {residual:e}");
        }
    }

    #[test]
    fn factors_multiply_to_the_polynomial() {
        for nu in [-0.9, -0.5, 0.0, 1e-4, 0.2, 0.25, 0.2630, 0.263_082_06, 0.45, 0.4999] {
            let r = Rayleigh::new(soil(nu));
            for y in [0.0, 0.1, 0.3, 0.9, 1.0, 1.1, 2.0, 5.0] {
                let k: f64 = 1.0 - 2.0 * y;
                let direct = k.powi(4) + 16.0 * y * y * (y - r.a2) * (1.0 - y);
                let scale = k.powi(4) + 16.0 * y * y * (y + 1.0) * (1.0 + y);
                let z = y - r.a2;
                let product = -16.0 * r.h * (z - r.z) * r.pair(z);
                assert!((product - direct).abs() < 4e-15 * scale, "{nu} {y}");
            }
        }
    }
}
