//! Surface displacements of an elastic half-plane under a line load on its surface, in closed form.
//!
//! Lamb's problem by the Cagniard–de Hoop method (Achenbach 1973, ch. 7; Kausel 2006). With `c_S` = μ = 1, a
//! load δ(x)δ(t) gives `u_ij` = `f_ij`(τ)/(π|x|), τ = t/|x|, where x leads from the load to the receiver:
//!
//! * `f_zz` = −[`S_a` K²/P · H(τ−a) + 4y(y−a²) `S_b`/P · H(τ−1)]
//! * `f_xx` = −[4y(y−1) `S_a`/P · H(τ−a) + `S_b` K²/P · H(τ−1)]
//! * `f_zx` = −2τ K `S_a` √(1−y)/P on a < τ < 1, plus D δ(τ−`τ_R`), times sgn x; `f_xz` = −`f_zx`
//!
//! | symbol | meaning |
//! |---|---|
//! | y, K | τ², 1 − 2y |
//! | `S_a`, `S_b` | √(y−a²), √(y−1) |
//! | P, `y_R` | Rayleigh polynomial and root, see `Rayleigh` |
//! | F, Q, W | ∫₀^τ f dη, ∫_τ^∞ f/η dη, ∫_τ^∞ f/η² dη |
//! | J | x²F/2 + x t Q − t²W/2, the twice-integrated response to H(t) |

use crate::error::{Result, finite, positive, require};
use crate::fundamental::branch::{Branch, Branches, Power};
use crate::fundamental::rayleigh::{LATE_SERIES_TERMS, late_coefficients};
use crate::fundamental::{FundamentalSolution, LoadHistory, LoadResponse, Rayleigh};
use crate::geometry::ContactElement;
use crate::linalg::Complex;
use crate::soil::Soil;

/// Response of the surface, for the three independent pairs of displacement and load.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Surface {
    /// z displacement due to z load.
    pub zz: f64,
    /// x displacement due to x load.
    pub xx: f64,
    /// z displacement due to x load, with the receiver to the right of the load.
    pub zx: f64,
}

/// Fundamental solution of the elastic half-plane, with load and receiver on its free surface.
#[derive(Debug, Clone)]
pub struct HalfPlane {
    soil: Soil,
    branches: Branches,
    /// Coefficients of the series for late times, zz and xx.
    late_series: [[f64; LATE_SERIES_TERMS]; 2],
    /// ∫ f/η² over all times, zz and xx.
    second_tail_total: [f64; 2],
    /// Regular ∫ f η^m of zx over all times, m = 1, 0, −1, −2.
    odd_totals: [f64; 4],
}

/// Powers m of the primitives ∫ f η^m dη.
const PRIMITIVE_POWERS: [i32; 4] = [1, 0, -1, -2];

/// Index in [`PRIMITIVE_POWERS`] of m = 1, the first moment.
const FIRST_MOMENT: usize = 0;
/// Index in [`PRIMITIVE_POWERS`] of m = 0, the primitive F.
const PLAIN_PRIMITIVE: usize = 1;
/// Index in [`PRIMITIVE_POWERS`] of m = −1, the primitive Q.
const FIRST_TAIL: usize = 2;
/// Index in [`PRIMITIVE_POWERS`] of m = −2, the primitive W.
const SECOND_TAIL: usize = 3;

/// Largest discriminant of nearly equal roots, whose contribution is computed as a mean over a circle of discriminants.
const DOUBLE_ROOT_DISCRIMINANT: f64 = 1e-4;
/// Number of points on this circle, with which the mean has only rounding errors.
const AVERAGING_POINTS: u32 = 16;
/// Radius of this circle in the complex plane, twice the limit above, so that no point is close to a double root.
const AVERAGING_RADIUS: f64 = 2e-4;
/// Time, in Rayleigh arrivals, after which the series for late times is used: it then has only rounding errors.
const LATE_SERIES_START: f64 = 3.0;
/// A time τ so late that all integrals have reached their limits.
const LIMIT_TIME: f64 = 1e100;

impl HalfPlane {
    /// Creates the solution for a soil.
    pub fn new(soil: Soil) -> Self {
        let rayleigh = Rayleigh::new(soil);
        let mut plane = Self {
            soil,
            branches: Branches::new(rayleigh),
            late_series: late_coefficients(&rayleigh),
            second_tail_total: [0.0; 2],
            odd_totals: [0.0; 4],
        };
        plane.second_tail_total = plane.even_primitives(LIMIT_TIME)[SECOND_TAIL];
        plane.odd_totals = PRIMITIVE_POWERS.map(|power| plane.odd_primitive(1.0, power));
        plane
    }

    /// Roots of the Rayleigh polynomial.
    pub(crate) fn rayleigh(&self) -> &Rayleigh {
        &self.branches.rayleigh
    }

    /// Dimensionless response f(τ) to an impulse, infinite at the Rayleigh arrival.
    ///
    /// The pulse D δ(τ−`τ_R`) of zx is not included.
    pub fn impulse(&self, tau: f64) -> Surface {
        let r = self.rayleigh();
        let a = self.branches.pressure_arrival;
        if tau.is_nan() || tau <= a {
            return Surface::default();
        }
        let y = tau * tau;
        let z = (tau - a) * (tau + a);
        let excess = (tau - 1.0) * (tau + 1.0);
        let arrival = self.branches.rayleigh_arrival;
        let p = -16.0 * r.h * (tau - arrival) * (tau + arrival) * r.pair(z);
        let sa = z.sqrt();
        let k = 1.0 - 2.0 * y;
        if excess < 0.0 {
            return Surface {
                zz: -sa * k * k / p,
                xx: -4.0 * y * excess * sa / p,
                zx: -2.0 * tau * k * sa * (-excess).sqrt() / p,
            };
        }
        let sb = excess.sqrt();
        Surface {
            zz: -(sa * k * k + 4.0 * y * z * sb) / p,
            xx: -(4.0 * y * excess * sa + sb * k * k) / p,
            zx: 0.0,
        }
    }

    /// Dimensionless response F(τ) = ∫₀^τ f dη to a load H(t): u = F/(πμ).
    pub fn heaviside(&self, tau: f64) -> Surface {
        let even_primitive = self.even_primitives(tau)[PLAIN_PRIMITIVE];
        let zx = self.odd_with_pulse(tau, PLAIN_PRIMITIVE);
        Surface { zz: even_primitive[0], xx: even_primitive[1], zx }
    }

    /// Integral Q(τ) = ∫_τ^∞ f/η dη.
    pub fn first_tail(&self, tau: f64) -> Surface {
        self.tail(tau, FIRST_TAIL)
    }

    /// Integral W(τ) = ∫_τ^∞ f/η² dη.
    pub fn second_tail(&self, tau: f64) -> Surface {
        self.tail(tau, SECOND_TAIL)
    }

    /// Integral Q or W, for the index [`FIRST_TAIL`] or [`SECOND_TAIL`].
    fn tail(&self, tau: f64, primitive: usize) -> Surface {
        let arrival = self.branches.rayleigh_arrival;
        let even_tail = if tau > LATE_SERIES_START * arrival {
            self.late_series.map(|series| {
                let mut sum = 0.0;
                for (k, c) in series.iter().enumerate().rev() {
                    sum = sum / (tau * tau) + c / (2 * k + primitive - 1) as f64;
                }
                sum / tau.powi(if primitive == FIRST_TAIL { 1 } else { 2 })
            })
        } else {
            let primitive_values = self.even_primitives(tau)[primitive];
            let total = if primitive == FIRST_TAIL {
                [
                    0.5 * std::f64::consts::PI * self.branches.pressure_arrival,
                    0.5 * std::f64::consts::PI,
                ]
            } else {
                self.second_tail_total
            };
            [total[0] - primitive_values[0], total[1] - primitive_values[1]]
        };
        let zx = if tau >= arrival {
            0.0
        } else {
            let pulse = self.branches.rayleigh_pulse * arrival.powi(PRIMITIVE_POWERS[primitive]);
            self.odd_totals[primitive] + pulse - self.odd_with_pulse(tau, primitive)
        };
        Surface { zz: even_tail[0], xx: even_tail[1], zx }
    }

    /// Twice-integrated response J(x, t), m², for `path` = `c_S` t and x in m; even in x for zz and xx, odd for zx.
    pub(crate) fn twice_integrated(&self, x: f64, path: f64) -> Surface {
        let r = x.abs();
        if r == 0.0 || path.is_nan() || path <= 0.0 {
            return Surface::default();
        }
        let tau = path / r;
        let f = self.heaviside(tau);
        let q = self.first_tail(tau);
        let w = self.second_tail(tau);
        Surface {
            zz: r * (0.5 * r * f.zz + path * q.zz) - 0.5 * path * path * w.zz,
            xx: r * (0.5 * r * f.xx + path * q.xx) - 0.5 * path * path * w.xx,
            zx: (r * (0.5 * r * f.zx + path * q.zx) - 0.5 * path * path * w.zx) * x.signum(),
        }
    }

    /// Mean displacement of `receiver` (m/Pa) due to a unit traction on `source`.
    ///
    /// The traction is constant from `time` (s) before the evaluation on. The displacement is exactly zero before the
    /// pressure wave arrives. It is computed from differences of J, so its relative error is the rounding error times
    /// (offset/length)²; [`crate::bem::InfluenceKernel`] has no such loss.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless `time` and the elements' ends are finite, the left one first.
    pub fn element_mean(
        &self,
        receiver: ContactElement,
        source: ContactElement,
        time: f64,
    ) -> Result<Surface> {
        finite("time", time)?;
        for element in [receiver, source] {
            positive("length of an element", element.length())?;
        }
        let path = time * self.soil.shear_wave_speed();
        let gap = (source.left() - receiver.right()).max(receiver.left() - source.right()).max(0.0);
        if path <= gap * self.branches.pressure_arrival {
            return Ok(Surface::default());
        }
        let mut sum = Surface::default();
        for (x, sign) in [
            (receiver.right() - source.left(), 1.0),
            (receiver.left() - source.left(), -1.0),
            (receiver.right() - source.right(), -1.0),
            (receiver.left() - source.right(), 1.0),
        ] {
            let j = self.twice_integrated(x, path);
            sum.zz += sign * j.zz;
            sum.xx += sign * j.xx;
            sum.zx += sign * j.zx;
        }
        let unit = 1.0 / (std::f64::consts::PI * self.soil.shear_modulus() * receiver.length());
        Ok(Surface { zz: sum.zz * unit, xx: sum.xx * unit, zx: sum.zx * unit })
    }

    /// Integrals ∫₀^τ f η^m dη of zz and xx, for the four [`PRIMITIVE_POWERS`] m.
    fn even_primitives(&self, tau: f64) -> [[f64; 2]; 4] {
        let mut sum = [[0.0; 2]; 4];
        if tau.is_nan() || tau <= self.branches.pressure_arrival {
            return sum;
        }
        let r = self.rayleigh();
        let rayleigh_root = Complex::real(r.z);
        let inverse_slope = r.residue(1.0);
        Self::add_root(r, tau, rayleigh_root, Complex::real(inverse_slope), 1.0, &mut sum);
        let discriminant = r.discriminant();
        if discriminant.abs() < DOUBLE_ROOT_DISCRIMINANT {
            for i in 0..AVERAGING_POINTS {
                let angle =
                    std::f64::consts::TAU * (f64::from(i) + 0.5) / f64::from(AVERAGING_POINTS);
                let real_part = discriminant + AVERAGING_RADIUS * angle.cos();
                let roots = r.shifted_roots(real_part, AVERAGING_RADIUS * angle.sin());
                let fraction = 1.0 / f64::from(AVERAGING_POINTS);
                Self::add_root_pair(r, tau, roots, fraction, &mut sum);
            }
        } else {
            Self::add_root_pair(r, tau, r.shifted_roots(discriminant, 0.0), 1.0, &mut sum);
        }
        sum
    }

    /// Adds `fraction` of the contributions of the two roots other than the Rayleigh wave.
    fn add_root_pair(
        r: &Rayleigh,
        tau: f64,
        roots: [Complex; 2],
        fraction: f64,
        sum: &mut [[f64; 2]; 4],
    ) {
        for (z, other) in [(roots[0], roots[1]), (roots[1], roots[0])] {
            let slope = ((z - Complex::real(r.z)) * (z - other)).scale(-16.0 * r.h);
            Self::add_root(r, tau, z, Complex::real(1.0) / slope, fraction, sum);
        }
    }

    /// Adds `fraction` of the contribution of one root y = a² + z; `inverse_slope` is 1/P'.
    fn add_root(
        r: &Rayleigh,
        tau: f64,
        z: Complex,
        inverse_slope: Complex,
        fraction: f64,
        sum: &mut [[f64; 2]; 4],
    ) {
        let y = z + Complex::real(r.a2);
        let k = Complex::real(r.g) - z.scale(2.0);
        let k2 = k * k;
        let shear = z - Complex::real(r.h);
        let four_z = (y * z).scale(4.0);
        let four_s = (y * shear).scale(4.0);
        // Pressure wave, then shear wave.
        for (arrival, root, zz, xx) in [(r.a2.sqrt(), z, k2, four_s), (1.0, shear, four_z, k2)] {
            if tau <= arrival {
                continue;
            }
            let s = ((tau - arrival) * (tau + arrival)).sqrt();
            let ratio_root = (root / y).sqrt();
            let plain_root = root.sqrt();
            let mut ratio_term = Complex::real(0.0);
            let mut plain_term = Complex::real(0.0);
            if root.abs() > 0.0 {
                ratio_term = ratio_root * (Complex::real(s / tau) / ratio_root).atanh();
                plain_term = plain_root * (Complex::real(s) / plain_root).atanh();
            }
            let integrals = [
                Complex::real(s) - plain_term,
                Complex::real((s / arrival).asinh()) - ratio_term,
                (Complex::real(arrival * (s / arrival).atan()) - plain_term) / y,
                (Complex::real(s / tau) - ratio_term) / y,
            ];
            for (sum, integral) in sum.iter_mut().zip(integrals) {
                let value = inverse_slope * integral;
                sum[0] -= fraction * (zz * value).re;
                sum[1] -= fraction * (xx * value).re;
            }
        }
    }

    /// Integral ∫ f η^m dη of zx up to τ, m = `power`, without the Rayleigh pulse.
    ///
    /// It is computed by Gauss rules, because the integral is elliptic for m = ±1.
    fn odd_primitive(&self, tau: f64, power: i32) -> f64 {
        let start = self.branches.pressure_arrival;
        let mut sum = [0.0; 2];
        for branch in [Branch::OddLow, Branch::OddHigh] {
            self.branches.add_integral(branch, start, tau.min(1.0), &Power(power), &mut sum);
        }
        sum[0]
    }

    /// Integral ∫ f η^m dη of zx up to τ, with the Rayleigh pulse after its arrival.
    fn odd_with_pulse(&self, tau: f64, primitive: usize) -> f64 {
        if tau.is_nan() || tau <= self.branches.pressure_arrival {
            return 0.0;
        }
        let power = PRIMITIVE_POWERS[primitive];
        let regular_part =
            if tau >= 1.0 { self.odd_totals[primitive] } else { self.odd_primitive(tau, power) };
        if tau >= self.branches.rayleigh_arrival {
            regular_part + self.branches.rayleigh_pulse * self.branches.rayleigh_arrival.powi(power)
        } else {
            regular_part
        }
    }
}

impl FundamentalSolution for HalfPlane {
    fn soil(&self) -> Soil {
        self.soil
    }

    /// Load and receiver lie on the surface: `offset[1]` must be 0. [`LoadHistory::Impulse`] omits the
    /// Rayleigh pulse of the coupled components.
    fn displacement(&self, offset: [f64; 2], time: f64, load: LoadHistory) -> Result<LoadResponse> {
        let r = surface_distance(offset)?;
        finite("time", time)?;
        let speed = self.soil.shear_wave_speed();
        let tau = time * speed / r;
        let step_unit = 1.0 / (std::f64::consts::PI * self.soil.shear_modulus());
        let unit = match load {
            LoadHistory::Impulse => step_unit * speed / r,
            LoadHistory::Step => step_unit,
            LoadHistory::Ramp => step_unit * r / speed,
        };
        let value = match load {
            LoadHistory::Impulse => self.impulse(tau),
            LoadHistory::Step => self.heaviside(tau),
            LoadHistory::Ramp => {
                let f = self.heaviside(tau);
                let moment = self.even_primitives(tau)[FIRST_MOMENT];
                Surface {
                    zz: tau * f.zz - moment[0],
                    xx: tau * f.xx - moment[1],
                    zx: tau * f.zx - self.odd_with_pulse(tau, FIRST_MOMENT),
                }
            }
        };
        let coupling = value.zx * unit * offset[0].signum();
        Ok([[value.xx * unit, -coupling], [coupling, value.zz * unit]])
    }

    /// The surface is free of traction: zero for a vertical normal.
    fn traction(
        &self,
        offset: [f64; 2],
        normal: [f64; 2],
        time: f64,
        _load: LoadHistory,
    ) -> Result<LoadResponse> {
        surface_distance(offset)?;
        finite("time", time)?;
        let is_vertical = normal[0] == 0.0 && normal[1].abs() == 1.0;
        let needed = "0, with z component 1 or -1: the solution is for the surface only";
        require("x component of the normal", normal[0], is_vertical, needed)?;
        Ok([[0.0; 2]; 2])
    }
}

/// Distance |x| of an offset along the surface; an error for another offset.
fn surface_distance(offset: [f64; 2]) -> Result<f64> {
    let x = offset[0];
    let z = offset[1];
    require("z component of the offset", z, z == 0.0, "0: load and receiver on the surface")?;
    let is_valid = x.is_finite() && x != 0.0;
    require("x component of the offset", x, is_valid, "finite and not zero").map(f64::abs)
}
