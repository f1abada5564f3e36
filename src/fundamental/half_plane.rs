//! Surface displacements of an elastic half-plane under a line load on its surface, closed form.
//!
//! Lamb's problem by Cagniard–de Hoop (Achenbach 1973, ch. 7; Kausel 2006). With `c_S` = μ = 1, a
//! load δ(x)δ(t) gives `u_ij` = `f_ij`(τ)/(π|x|), τ = t/|x|, x from the load to the receiver:
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
use crate::fundamental::{FundamentalSolution, LoadHistory, Rayleigh};
use crate::geometry::ContactElement;
use crate::linalg::Complex;
use crate::soil::Soil;

/// A quantity for the three independent pairs of surface components.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Surface {
    /// z displacement due to z load.
    pub zz: f64,
    /// x displacement due to x load.
    pub xx: f64,
    /// z displacement due to x load, receiver to the right of the load.
    pub zx: f64,
}

/// Elastic half-plane with a traction-free surface; load and receiver on that surface.
#[derive(Debug, Clone)]
pub struct HalfPlane {
    soil: Soil,
    branches: Branches,
    late: [[f64; LATE_SERIES_TERMS]; 2],
    /// ∫ f/η² over all times, zz and xx.
    total: [f64; 2],
    /// Regular ∫ f η^m of zx, m = 1, 0, −1, −2.
    total_odd: [f64; 4],
}

/// Weights of the primitives: η, 1, 1/η, 1/η².
const POWERS: [i32; 4] = [1, 0, -1, -2];

/// Discriminants below this are averaged over a circle, where the two roots never meet.
const CLOSE: f64 = 1e-4;

impl HalfPlane {
    /// The half-plane of a soil.
    pub fn new(soil: Soil) -> Self {
        let rayleigh = Rayleigh::new(soil);
        let mut plane = Self {
            soil,
            branches: Branches::new(rayleigh),
            late: late_coefficients(&rayleigh),
            total: [0.0; 2],
            total_odd: [0.0; 4],
        };
        plane.total = plane.even(1e100)[3];
        plane.total_odd = plane.odd(1.0);
        plane
    }

    /// Roots of the Rayleigh polynomial.
    pub(crate) fn rayleigh(&self) -> &Rayleigh {
        &self.branches.rayleigh
    }

    /// f(τ), dimensionless, without the pulse D δ(τ−`τ_R`) of zx; infinite at the Rayleigh arrival.
    pub fn impulse(&self, tau: f64) -> Surface {
        let r = self.rayleigh();
        let a = self.branches.first;
        if tau.is_nan() || tau <= a {
            return Surface::default();
        }
        let y = tau * tau;
        let z = (tau - a) * (tau + a);
        let excess = (tau - 1.0) * (tau + 1.0);
        let arrival = self.branches.arrival;
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

    /// F(τ) = ∫₀^τ f dη: a load H(t) gives u = F/(πμ).
    pub fn heaviside(&self, tau: f64) -> Surface {
        let even = self.even(tau)[1];
        Surface { zz: even[0], xx: even[1], zx: self.odd_sum(tau, 1) }
    }

    /// Q(τ) = ∫_τ^∞ f/η dη.
    pub fn first_tail(&self, tau: f64) -> Surface {
        self.tail(tau, 2)
    }

    /// W(τ) = ∫_τ^∞ f/η² dη.
    pub fn second_tail(&self, tau: f64) -> Surface {
        self.tail(tau, 3)
    }

    fn tail(&self, tau: f64, which: usize) -> Surface {
        let arrival = self.branches.arrival;
        let even = if tau > 3.0 * arrival {
            self.late.map(|series| {
                let mut sum = 0.0;
                for (k, c) in series.iter().enumerate().rev() {
                    sum = sum / (tau * tau) + c / (2 * k + which - 1) as f64;
                }
                sum / tau.powi(if which == 2 { 1 } else { 2 })
            })
        } else {
            let part = self.even(tau)[which];
            let total = if which == 2 {
                [0.5 * std::f64::consts::PI * self.branches.first, 0.5 * std::f64::consts::PI]
            } else {
                self.total
            };
            [total[0] - part[0], total[1] - part[1]]
        };
        let zx = if tau >= arrival {
            0.0
        } else {
            let pulse = self.branches.pulse * arrival.powi(POWERS[which]);
            self.total_odd[which] + pulse - self.odd_sum(tau, which)
        };
        Surface { zz: even[0], xx: even[1], zx }
    }

    /// J(x, t) with `path` = `c_S` t, both in m; even in x for zz and xx, odd for zx; m².
    pub(crate) fn twice_integrated(&self, x: f64, path: f64) -> Surface {
        let r = x.abs();
        if r == 0.0 || path.is_nan() || path <= 0.0 {
            return Surface::default();
        }
        let tau = path / r;
        let f = self.heaviside(tau);
        let q = self.first_tail(tau);
        let w = self.second_tail(tau);
        let join = |f: f64, q: f64, w: f64| r * (0.5 * r * f + path * q) - 0.5 * path * path * w;
        Surface {
            zz: join(f.zz, q.zz, w.zz),
            xx: join(f.xx, q.xx, w.xx),
            zx: join(f.zx, q.zx, w.zx) * x.signum(),
        }
    }

    /// Mean displacement of `receiver` (m/Pa) after a unit traction acts on `source`.
    ///
    /// `time` is the time since the traction was switched on, s.
    ///
    /// The displacement is exactly zero before the pressure wave arrives. It is computed from differences of
    /// J, so its relative error is rounding times (offset/length)²; [`crate::bem::InfluenceKernel`] has no
    /// such loss.
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
        if path <= gap * self.branches.first {
            return Ok(Surface::default());
        }
        let p = receiver;
        let q = source;
        let mut sum = Surface::default();
        for (x, sign) in [
            (p.right() - q.left(), 1.0),
            (p.left() - q.left(), -1.0),
            (p.right() - q.right(), -1.0),
            (p.left() - q.right(), 1.0),
        ] {
            let j = self.twice_integrated(x, path);
            sum.zz += sign * j.zz;
            sum.xx += sign * j.xx;
            sum.zx += sign * j.zx;
        }
        let unit = 1.0 / (std::f64::consts::PI * self.soil.shear_modulus() * p.length());
        Ok(Surface { zz: sum.zz * unit, xx: sum.xx * unit, zx: sum.zx * unit })
    }

    /// ∫₀^τ f η^m dη of zz and xx for every weight.
    fn even(&self, tau: f64) -> [[f64; 2]; 4] {
        let mut sum = [[0.0; 2]; 4];
        if tau.is_nan() || tau <= self.branches.first {
            return sum;
        }
        let r = self.rayleigh();
        let real = Complex::real(r.z);
        let weight = r.residue(1.0);
        Self::add_root(r, tau, real, Complex::real(weight), 1.0, &mut sum);
        let discriminant = r.discriminant();
        let (count, radius) = if discriminant.abs() < CLOSE { (16, 2e-4) } else { (1, 0.0) };
        for i in 0..count {
            let angle = std::f64::consts::TAU * (f64::from(i) + 0.5) / f64::from(count);
            let (sin, cos) = if count == 1 { (0.0, 0.0) } else { angle.sin_cos() };
            let (one, two) = r.shifted_roots(discriminant + radius * cos, radius * sin);
            let share = 1.0 / f64::from(count);
            for (z, other) in [(one, two), (two, one)] {
                let slope = ((z - real) * (z - other)).scale(-16.0 * r.h);
                Self::add_root(r, tau, z, Complex::real(1.0) / slope, share, &mut sum);
            }
        }
        sum
    }

    /// Adds the part of one root y = a² + z; `weight` is 1/P'.
    fn add_root(
        r: &Rayleigh,
        tau: f64,
        z: Complex,
        weight: Complex,
        share: f64,
        sum: &mut [[f64; 2]; 4],
    ) {
        let y = z + Complex::real(r.a2);
        let k = Complex::real(r.g) - z.scale(2.0);
        let k2 = k * k;
        let shear = z - Complex::real(r.h);
        let four_z = (y * z).scale(4.0);
        let four_s = (y * shear).scale(4.0);
        for (speed, root, zz, xx) in [(r.a2.sqrt(), z, k2, four_s), (1.0, shear, four_z, k2)] {
            if tau <= speed {
                continue;
            }
            let s = ((tau - speed) * (tau + speed)).sqrt();
            let w0 = (root / y).sqrt();
            let v0 = root.sqrt();
            let mut near = Complex::real(0.0);
            let mut path = Complex::real(0.0);
            if root.abs() > 0.0 {
                near = w0 * (Complex::real(s / tau) / w0).atanh();
                path = v0 * (Complex::real(s) / v0).atanh();
            }
            let integrals = [
                Complex::real(s) - path,
                Complex::real((s / speed).asinh()) - near,
                (Complex::real(speed * (s / speed).atan()) - path) / y,
                (Complex::real(s / tau) - near) / y,
            ];
            for (sum, integral) in sum.iter_mut().zip(integrals) {
                let value = weight * integral;
                sum[0] -= share * (zz * value).re;
                sum[1] -= share * (xx * value).re;
            }
        }
    }

    /// Regular ∫ f η^m dη of zx up to τ for every weight; elliptic integrals (m = ±1) by Gauss rules.
    fn odd(&self, tau: f64) -> [f64; 4] {
        POWERS.map(|power| self.odd_power(tau, power))
    }

    fn odd_power(&self, tau: f64, power: i32) -> f64 {
        let mut sum = [0.0; 2];
        for part in [Branch::OddLow, Branch::OddHigh] {
            self.branches.add(part, self.branches.first, tau.min(1.0), &Power(power), &mut sum);
        }
        sum[0]
    }

    /// Odd sum over the branches, with the Rayleigh pulse once it has passed.
    fn odd_sum(&self, tau: f64, which: usize) -> f64 {
        if tau.is_nan() || tau <= self.branches.first {
            return 0.0;
        }
        let regular =
            if tau >= 1.0 { self.total_odd[which] } else { self.odd_power(tau, POWERS[which]) };
        if tau >= self.branches.arrival {
            regular + self.branches.pulse * self.branches.arrival.powi(POWERS[which])
        } else {
            regular
        }
    }
}

impl FundamentalSolution for HalfPlane {
    fn soil(&self) -> Soil {
        self.soil
    }

    /// Load and receiver lie on the surface: `offset[1]` must be 0. [`LoadHistory::Impulse`] omits the
    /// Rayleigh pulse of the coupled components.
    fn displacement(
        &self,
        offset: [f64; 2],
        time: f64,
        load: LoadHistory,
    ) -> Result<[[f64; 2]; 2]> {
        let r = surface_distance(offset)?;
        finite("time", time)?;
        let speed = self.soil.shear_wave_speed();
        let tau = time * speed / r;
        let unit = 1.0 / (std::f64::consts::PI * self.soil.shear_modulus());
        let (value, unit) = match load {
            LoadHistory::Impulse => (self.impulse(tau), unit * speed / r),
            LoadHistory::Step => (self.heaviside(tau), unit),
            LoadHistory::Ramp => {
                let f = self.heaviside(tau);
                let moment = self.even(tau)[0];
                let value = Surface {
                    zz: tau * f.zz - moment[0],
                    xx: tau * f.xx - moment[1],
                    zx: tau * f.zx - self.odd_sum(tau, 0),
                };
                (value, unit * r / speed)
            }
        };
        let coupled = value.zx * unit * offset[0].signum();
        Ok([[value.xx * unit, -coupled], [coupled, value.zz * unit]])
    }

    /// The surface is free of traction: zero for a vertical normal.
    fn traction(
        &self,
        offset: [f64; 2],
        normal: [f64; 2],
        time: f64,
        _load: LoadHistory,
    ) -> Result<[[f64; 2]; 2]> {
        surface_distance(offset)?;
        finite("time", time)?;
        let upright = normal[0] == 0.0 && normal[1].abs() == 1.0;
        let needed = "0, with z component 1 or -1: only the surface itself is known";
        require("x component of the normal", normal[0], upright, needed)?;
        Ok([[0.0; 2]; 2])
    }
}

/// |x| of an offset along the surface.
fn surface_distance(offset: [f64; 2]) -> Result<f64> {
    let [x, z] = offset;
    require("z component of the offset", z, z == 0.0, "0: load and receiver on the surface")?;
    let fits = x.is_finite() && x != 0.0;
    require("x component of the offset", x, fits, "finite and not zero").map(f64::abs)
}
