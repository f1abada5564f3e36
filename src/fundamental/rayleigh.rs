//! The Rayleigh polynomial of an elastic half-plane, its roots and the Rayleigh wave.
//!
//! y is the square of a slowness divided by the shear slowness. The product of the Rayleigh function and its
//! conjugate is the cubic
//!
//! P(y) = (1−2y)⁴ + 16 y²(y−a²)(1−y) = 16(a²−1) y³ + (24−16a²) y² − 8 y + 1
//!
//! (Achenbach 1973, ch. 7; Kausel 2006). One root, `y_R` > 1, is that of the Rayleigh wave. The other two are a
//! real pair below a² for Poisson's ratios up to 0.26308…, and a complex pair for larger ratios.
//!
//! | symbol | here | meaning |
//! |---|---|---|
//! | a² | `a2` | (`c_S`/`c_P`)² |
//! | h | `h` | 1 − a² = 1/(2(1−ν)) |
//! | g | `g` | 1 − 2a² = ν/(1−ν) |
//! | z | | y − a², not below zero after the arrival of the pressure wave |
//! | `y_R`, `z_R` | `square`, `z` | the Rayleigh root, and `y_R` − a² |
//! | σ, ϖ | `sum`, `product` | the other two roots in z solve z² + σ z + ϖ = 0 |

use crate::linalg::Complex;
use crate::soil::Soil;

/// Roots of the Rayleigh polynomial of one soil.
///
/// The coefficients of the quadratic factor are stored instead of its roots. They are smooth functions of Poisson's
/// ratio even at the double root (ν = 0.26308…), and precise even for ν → 0, where one root tends to a² like ν⁴.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rayleigh {
    /// Squared ratio of the wave speeds, a² = (`c_S`/`c_P`)².
    pub(crate) a2: f64,
    /// Difference h = 1 − a².
    pub(crate) h: f64,
    /// Difference g = 1 − 2a².
    pub(crate) g: f64,
    /// Rayleigh root `y_R`, the squared arrival of the Rayleigh wave.
    pub(crate) square: f64,
    /// Rayleigh root in z, `y_R` − a².
    pub(crate) z: f64,
    /// Excess `y_R` − 1 over the squared arrival of the shear wave.
    pub(crate) excess: f64,
    /// Coefficient σ: minus the sum of the other two roots in z.
    pub(crate) sum: f64,
    /// Coefficient ϖ: product of the other two roots in z.
    pub(crate) product: f64,
}

/// Upper bound of `y_R` − 1: Rayleigh waves are faster than 0.6 times shear waves for all Poisson's ratios.
const MAX_EXCESS: f64 = 4.0;
/// Number of bisections, after which the error of 4/2³⁰ is small enough for Newton's method.
const BISECTION_COUNT: usize = 30;
/// Number of Newton's iterations, after which the error of the root is a rounding error.
const NEWTON_ITERATIONS: usize = 3;

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
        // P(1) = 1 > 0 and P → −∞: bisection brackets the root, and Newton's method refines it.
        let mut low = 0.0;
        let mut high = MAX_EXCESS;
        for _ in 0..BISECTION_COUNT {
            let middle = 0.5 * (low + high);
            if cubic_value(cubic, middle) > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let mut excess = 0.5 * (low + high);
        for _ in 0..NEWTON_ITERATIONS {
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

    /// Arrival τ of the Rayleigh wave: `c_S`/`c_R`.
    pub(crate) fn arrival(&self) -> f64 {
        self.square.sqrt()
    }

    /// Factor z² + σ z + ϖ of the two roots other than the Rayleigh root.
    pub(crate) fn pair(&self, z: f64) -> f64 {
        (z + self.sum) * z + self.product
    }

    /// Discriminant (σ/2)² − ϖ of the pair: positive for real roots.
    pub(crate) fn discriminant(&self) -> f64 {
        0.25 * self.sum * self.sum - self.product
    }

    /// Roots of z² + σ z + (σ/2)² − d, for a complex discriminant d = `real` + i `imaginary`.
    pub(crate) fn shifted_roots(&self, real: f64, imaginary: f64) -> [Complex; 2] {
        let root = Complex::new(real, imaginary).sqrt();
        let middle = Complex::real(-0.5 * self.sum);
        if imaginary == 0.0 && real > 0.0 && self.sum > 0.0 {
            // The smaller root is computed from the product of the roots, without cancellation.
            let larger_root = middle - root;
            return [Complex::real(self.product / larger_root.re), larger_root];
        }
        [middle + root, middle - root]
    }

    /// Strength D of the Rayleigh pulse D δ(τ − `τ_R`) in `f_zx`.
    pub(crate) fn pulse(&self) -> f64 {
        let y = self.square;
        let tau = self.arrival();
        let sa = self.z.sqrt();
        let sb = self.excess.sqrt();
        let k = 1.0 - 2.0 * y;
        let slope = -8.0 * tau * (k + sa * sb) - 4.0 * y * tau * (sb / sa + sa / sb);
        std::f64::consts::PI * tau * (k + 2.0 * sa * sb) / slope
    }

    /// Residue of `numerator`/P at the Rayleigh root, in the variable z.
    pub(crate) fn residue(&self, numerator: f64) -> f64 {
        -numerator / (16.0 * self.h * self.pair(self.z))
    }
}

/// Value of a cubic at `w`, with coefficients from the highest power down.
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

/// Number of terms of the series for late times, whose error after three Rayleigh arrivals is a rounding error.
pub(crate) const LATE_SERIES_TERMS: usize = 20;

/// Coefficients of the kernel's series for late times, zz and xx.
///
/// The series is f = Σ `c_k` τ^(−2k−1), which converges for τ above the Rayleigh arrival. With v = τ⁻² and
/// p(v) = v³ P(1/v), f = τ⁻¹ n(v)/p(v). The numerators n are binomial series. The division by the cubic p is a
/// recurrence, which is stable because the Rayleigh root dominates.
pub(crate) fn late_coefficients(rayleigh: &Rayleigh) -> [[f64; LATE_SERIES_TERMS]; 2] {
    let a2 = rayleigh.a2;
    let sa = square_root_series(a2);
    let sb = square_root_series(1.0);
    let mut coefficients = [[0.0; LATE_SERIES_TERMS]; 2];
    let p = [-16.0 * rayleigh.h, 24.0 - 16.0 * a2, -8.0, 1.0];
    for k in 0..LATE_SERIES_TERMS {
        let sa_k = descending_coefficients(&sa, k);
        let sb_k = descending_coefficients(&sb, k);
        let numerator = [
            (4.0 * sa_k[0] - 4.0 * sa_k[1] + sa_k[2]) + 4.0 * (sb_k[0] - a2 * sb_k[1]),
            4.0 * (sa_k[0] - sa_k[1]) + (4.0 * sb_k[0] - 4.0 * sb_k[1] + sb_k[2]),
        ];
        for (series, numerator) in coefficients.iter_mut().zip(numerator) {
            let mut value = -numerator;
            for back in 1..=3.min(k) {
                value -= p[back] * series[k - back];
            }
            series[k] = value / p[0];
        }
    }
    coefficients
}

/// Coefficients of √(1 − `factor` v) in powers of v.
fn square_root_series(factor: f64) -> [f64; LATE_SERIES_TERMS] {
    let mut series = [1.0; LATE_SERIES_TERMS];
    for k in 1..LATE_SERIES_TERMS {
        series[k] = series[k - 1] * factor * (k as f64 - 1.5) / k as f64;
    }
    series
}

/// Coefficients k, k − 1 and k − 2 of a series; zero for negative indices.
fn descending_coefficients(series: &[f64], k: usize) -> [f64; 3] {
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
        let first_root = quarter.a2 + roots[0].re;
        let second_root = quarter.a2 + roots[1].re;
        assert!((first_root - (3.0 - 3.0_f64.sqrt()) / 4.0).abs() < 4e-16);
        assert!((second_root - 0.25).abs() < 4e-16);
        let speed = soil(0.0).rayleigh_wave_speed();
        assert!((speed - (3.0 - 5.0_f64.sqrt()).sqrt()).abs() < 4e-16);
    }

    #[test]
    fn small_roots_are_relatively_precise() {
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
                let expected = k.powi(4) + 16.0 * y * y * (y - r.a2) * (1.0 - y);
                let scale = k.powi(4) + 16.0 * y * y * (y + 1.0) * (1.0 + y);
                let z = y - r.a2;
                let product = -16.0 * r.h * (z - r.z) * r.pair(z);
                assert!((product - expected).abs() < 4e-15 * scale, "{nu} {y}");
            }
        }
    }
}
