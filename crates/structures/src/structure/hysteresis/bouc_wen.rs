//! Bouc–Wen spring with one deformation.

use super::biaxial::BiaxialSpring;
use super::coupled_bouc_wen::CoupledBoucWen;
use super::slider::elastic_fraction;
use super::{Hysteresis, SpringResponse, corrupt_state};
use crate::error::{Result, positive, require};
use crate::linalg::gauss;
use crate::structure::InternalEnergy;

/// Exponent n without [`BoucWen::with_shape`]; the coupled law has the same exponent.
const DEFAULT_EXPONENT: f64 = 2.0;
/// β without [`BoucWen::with_shape`]: unloading is straight.
const DEFAULT_BETA: f64 = 0.5;

/// Bouc–Wen hysteresis (Bouc 1967, Wen 1976) with a smooth transition to yield.
///
/// ```text
/// F = α k d + (1 − α) F_y z,      ż = (1 − (β sgn(ḋ z) + γ)|z|ⁿ) ḋ/d_y,      β + γ = 1,  d_y = F_y/k
/// ```
///
/// Steps solve this equation exactly on straight paths of any length. With β ≥ ½ the spring never releases more energy
/// than it has stored (Erlicher & Point 2004). The stored energy is ½ α k d² + ½ (1−α) F_y d_y z².
///
/// ```
/// use basemat::structure::{BoucWen, Hysteresis};
///
/// let spring = BoucWen::new(1.0e6, 10.0e3, 0.0)?.with_shape(2.0, 0.5)?;
/// // n = 2: z = tanh(d/d_y)
/// assert!((spring.response(0.02).force - 10.0e3 * 2.0_f64.tanh()).abs() < 1e-9);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct BoucWen {
    stiffness: f64,
    yield_force: f64,
    hardening: f64,
    loop_shape: LoopShape,
    /// Deformation at the end of the last committed step, m.
    deformation: f64,
    /// Hysteretic variable there.
    z: f64,
    /// Dissipated energy there, J.
    dissipated_energy: f64,
}

impl BoucWen {
    /// Spring with initial stiffness k, yield force F_y and hardening α.
    ///
    /// `stiffness`: N/m. `yield_force`: N. `hardening`: ratio of the final to the initial stiffness. Stiffness and
    /// force are per metre of thickness. The exponent n is 2 and β is ½ unless set otherwise.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless k and F_y are positive and 0 ≤ α < 1.
    pub fn new(stiffness: f64, yield_force: f64, hardening: f64) -> Result<Self> {
        positive("stiffness of the Bouc–Wen spring", stiffness)?;
        positive("yield force of the Bouc–Wen spring", yield_force)?;
        positive("yield displacement of the Bouc–Wen spring", yield_force / stiffness)?;
        elastic_fraction(hardening)?;
        Ok(Self {
            stiffness,
            yield_force,
            hardening,
            loop_shape: LoopShape::new(DEFAULT_EXPONENT, DEFAULT_BETA),
            deformation: 0.0,
            z: 0.0,
            dissipated_energy: 0.0,
        })
    }

    /// Sets the exponent n and β.
    ///
    /// A larger n makes the transition to yield sharper. With β = ½ unloading is straight; with β above ½ the unloading
    /// curve bulges.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless 1 ≤ n ≤ 10 and ½ ≤ β ≤ 1.
    pub fn with_shape(mut self, exponent: f64, beta: f64) -> Result<Self> {
        for (quantity, value, range, needed) in [
            ("exponent of the Bouc–Wen spring", exponent, 1.0..=10.0, "from 1 to 10"),
            ("beta of the Bouc–Wen spring", beta, 0.5..=1.0, "from 0.5 to 1"),
        ] {
            require(quantity, value, range.contains(&value), needed)?;
        }
        self.loop_shape = LoopShape::new(exponent, beta);
        Ok(self)
    }

    /// A new spring with these parameters for two directions.
    ///
    /// It follows the law of Park, Wen & Ang (1986),
    ///
    /// ```text
    /// F = α k d + (1 − α) F_y z,      ż = (ḋ − (β |ḋ·z| + γ ḋ·z) z)/d_y
    /// ```
    ///
    /// with vectors F, d and z. Steps solve this equation exactly on straight paths of any length. Here |ḋ·z| replaces
    /// the sum |ḋ_x z_x| + |ḋ_y z_y| of the paper, with which the force depends on the axes: on an ellipse of 3 by 1.5
    /// d_y it changes by 0.11 F_y if the axes are rotated by 45°. Both laws agree along straight lines.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the exponent is 2, as in the paper.
    pub fn coupled(&self) -> Result<BiaxialSpring> {
        let exponent = self.loop_shape.exponent;
        let quantity = "exponent of the coupled Bouc–Wen spring";
        require(quantity, exponent, exponent == 2.0, "2")?;
        let unloading = self.loop_shape.unloading;
        let law = CoupledBoucWen::new(self.stiffness, self.yield_force, self.hardening, unloading);
        Ok(law.into())
    }

    /// State at the end of a straight path to a deformation.
    fn path_end(&self, deformation: f64) -> PathEnd {
        let change = deformation - self.deformation;
        let direction = if change == 0.0 { -self.z.signum() } else { change.signum() };
        let path_length = change.abs() * self.stiffness / self.yield_force;
        let LoopEnd { y, lost_energy } = self.loop_shape.advance(direction * self.z, path_length);
        PathEnd { z: direction * y, slope: self.loop_shape.slope(y), lost_energy }
    }
}

/// End of a straight path.
struct PathEnd {
    z: f64,
    /// Derivative dz/d(d/d_y).
    slope: f64,
    /// Energy dissipated on the path, in units of (1 − α) F_y d_y.
    lost_energy: f64,
}

impl Hysteresis for BoucWen {
    fn response(&self, deformation: f64) -> SpringResponse {
        let PathEnd { z, slope, .. } = self.path_end(deformation);
        let k = self.stiffness;
        let hysteretic_fraction = 1.0 - self.hardening;
        SpringResponse {
            force: self.hardening * k * deformation + hysteretic_fraction * self.yield_force * z,
            tangent: (self.hardening + hysteretic_fraction * slope) * k,
        }
    }

    fn energy(&self, deformation: f64) -> InternalEnergy {
        let PathEnd { z, lost_energy, .. } = self.path_end(deformation);
        let energy_scale =
            (1.0 - self.hardening) * self.yield_force * self.yield_force / self.stiffness;
        let parallel_energy = self.hardening * self.stiffness * deformation * deformation;
        InternalEnergy {
            stored: 0.5 * (parallel_energy + energy_scale * z * z),
            dissipated: self.dissipated_energy + energy_scale * lost_energy,
        }
    }

    fn commit(&mut self, deformation: f64) {
        self.dissipated_energy = self.energy(deformation).dissipated;
        self.z = self.path_end(deformation).z;
        self.deformation = deformation;
    }

    fn save(&self) -> Vec<f64> {
        vec![self.deformation, self.z, self.dissipated_energy]
    }

    fn restore(&mut self, values: &[f64]) -> Result<()> {
        match values {
            &[deformation, z, dissipated_energy]
                if deformation.is_finite()
                    && z.abs() <= 1.0
                    && dissipated_energy.is_finite()
                    && dissipated_energy >= 0.0 =>
            {
                (self.deformation, self.z, self.dissipated_energy) =
                    (deformation, z, dissipated_energy);
                Ok(())
            }
            _ => Err(corrupt_state()),
        }
    }

    fn clone_box(&self) -> Box<dyn Hysteresis> {
        Box::new(self.clone())
    }
}

/// Shape of the hysteresis loop.
///
/// It is y over the path length ξ = |d|/d_y, where y = ±z in the direction of a path.
///
/// dy/dξ = 1 − yⁿ while the spring loads (y > 0), and 1 + b |y|ⁿ while it unloads (y < 0).
#[derive(Debug, Clone, PartialEq)]
struct LoopShape {
    /// Exponent n.
    exponent: f64,
    /// Factor b = β − γ.
    unloading: f64,
}

/// End of a path along the loop.
struct LoopEnd {
    y: f64,
    /// Energy ∫ y (1 − dy/dξ) dξ dissipated on the path.
    lost_energy: f64,
}

/// Largest number of Newton iterations, which converge from one side and finally quadratically.
const MAX_NEWTON_ITERATIONS: usize = 60;
/// Change of y ≤ 1 at which Newton's method has converged.
///
/// It is the rounding of y.
const UNLOADING_TOLERANCE: f64 = 1e-16;
/// Relative change of v at which Newton's method has converged: a few roundings.
const LOADING_TOLERANCE: f64 = 1e-15;
/// Relative size of a term that no longer changes the sum of a series.
const NEGLIGIBLE_TERM_RATIO: f64 = 1e-18;
/// Argument up to which integrals are evaluated by series, whose terms then at least halve.
const MAX_SERIES_ARGUMENT: f64 = 0.5;

impl LoopShape {
    fn new(exponent: f64, beta: f64) -> Self {
        Self { exponent, unloading: 2.0 * beta - 1.0 }
    }

    /// Derivative dy/dξ.
    fn slope(&self, y: f64) -> f64 {
        let power = y.abs().powf(self.exponent);
        if y > 0.0 { 1.0 - power } else { 1.0 + self.unloading * power }
    }

    /// End of a path of the length ξ = `path_length` from y = `start`.
    ///
    /// NaN for invalid arguments.
    fn advance(&self, start: f64, path_length: f64) -> LoopEnd {
        if !(start.abs() <= 1.0 && path_length.is_finite()) {
            return LoopEnd { y: f64::NAN, lost_energy: f64::NAN };
        }
        if start >= 0.0 {
            return self.load(start, path_length);
        }
        let unloading_length = self.unloading_integral(-start, 0);
        if unloading_length >= path_length {
            let end = self.find_unloaded(unloading_length - path_length);
            return LoopEnd { y: -end, lost_energy: self.unloading_loss(-start, end) };
        }
        let unloading_loss = self.unloading_loss(-start, 0.0);
        let LoopEnd { y, lost_energy } = self.load(0.0, path_length - unloading_length);
        LoopEnd { y, lost_energy: unloading_loss + lost_energy }
    }

    /// End of a loading path from y = `start` ≥ 0.
    fn load(&self, start: f64, path_length: f64) -> LoopEnd {
        let end = self.find_loaded(start, path_length);
        let stored_energy = 0.5 * (end - start) * (end + start);
        let elastic_length = self.elastic_integral(end) - self.elastic_integral(start);
        let lost_energy = path_length - elastic_length - stored_energy;
        LoopEnd { y: end, lost_energy: lost_energy.max(0.0) }
    }

    /// Energy lost in an unloading from |y| = `start` to `end`: ∫ s · b sⁿ/(1 + b sⁿ) ds.
    fn unloading_loss(&self, start: f64, end: f64) -> f64 {
        let stored_energy = 0.5 * (start - end) * (start + end);
        let released_work = self.unloading_integral(start, 1) - self.unloading_integral(end, 1);
        (stored_energy - released_work).max(0.0)
    }

    /// ∫₀^w sᵖ ds/(1 + b sⁿ).
    ///
    /// For p = 0 it is the path length of an unloading, for p = 1 its work.
    fn unloading_integral(&self, w: f64, p: i32) -> f64 {
        let n = self.exponent;
        let b = self.unloading;
        let series_end = w.min(MAX_SERIES_ARGUMENT);
        self.series(-b, series_end, p)
            + integral(series_end, w, |s| s.powi(p) / (1.0 + b * s.powf(n)))
    }

    /// ∫₀^y (1 − s)/(1 − sⁿ) ds: path length of a loading less its work.
    fn elastic_integral(&self, y: f64) -> f64 {
        let series_end = y.min(MAX_SERIES_ARGUMENT);
        self.series(1.0, series_end, 0) - self.series(1.0, series_end, 1)
            + integral(series_end, y, |s| (1.0 - s) / (1.0 - s.powf(self.exponent)))
    }

    /// Σ cᵏ x^(nk+p+1)/(nk+p+1) = ∫₀^x sᵖ ds/(1 − c sⁿ) for x ≤ ½ and |c| ≤ 1.
    fn series(&self, c: f64, x: f64, p: i32) -> f64 {
        let ratio = x.powf(self.exponent);
        let mut power = x.powi(p + 1);
        let mut denominator = f64::from(p + 1);
        let mut sum = 0.0;
        loop {
            let term = power / denominator;
            sum += term;
            // The comparison is also false for NaN, which ends the loop.
            let is_significant = term.abs() > NEGLIGIBLE_TERM_RATIO * sum.abs();
            if !is_significant {
                return sum;
            }
            power *= c * ratio;
            denominator += self.exponent;
        }
    }

    /// w = |y| at which the spring is unloaded after the further path `remaining_length`.
    ///
    /// Solves ∫₀^w ds/(1 + b sⁿ) = `remaining_length` by Newton's method, which converges from the left: the integral
    /// is concave.
    fn find_unloaded(&self, remaining_length: f64) -> f64 {
        let mut w = remaining_length.min(1.0);
        for _ in 0..MAX_NEWTON_ITERATIONS {
            let step = (remaining_length - self.unloading_integral(w, 0)) * self.slope(-w);
            w = (w + step).min(1.0);
            if step.abs() <= UNLOADING_TOLERANCE {
                break;
            }
        }
        w
    }

    /// y after a loading path of the length `path_length` from `start` ≥ 0.
    ///
    /// Newton's method in v = −ln(1 − y), in which the loading length is concave, with slopes from 1 to 1/n.
    fn find_loaded(&self, start: f64, path_length: f64) -> f64 {
        if start >= 1.0 || path_length == 0.0 {
            return start;
        }
        let target = self.loading_length(-(-start).ln_1p()) + path_length;
        let mut v = target;
        for _ in 0..MAX_NEWTON_ITERATIONS {
            // (1 − yⁿ)/(1 − y), which tends to n for large v.
            let quotient = -f64::exp_m1(self.exponent * (-(-v).exp()).ln_1p()) / (-v).exp();
            let inverse_slope = if quotient.is_finite() { quotient } else { self.exponent };
            let step = (target - self.loading_length(v)) * inverse_slope;
            v += step;
            if step.abs() <= LOADING_TOLERANCE * v.abs() {
                break;
            }
        }
        // Rounding must not reverse the direction.
        (-f64::exp_m1(-v)).clamp(start, 1.0)
    }

    /// Path length ∫₀^y ds/(1 − sⁿ) of a loading from zero to y = 1 − exp(−v).
    fn loading_length(&self, v: f64) -> f64 {
        let n = self.exponent;
        let y = -f64::exp_m1(-v);
        if y <= MAX_SERIES_ARGUMENT {
            return self.series(1.0, y, 0);
        }
        // Integral of 1/(1 − sⁿ) less its singular part 1/(n (1 − s)).
        let regular_part =
            integral(MAX_SERIES_ARGUMENT, y, |s| 1.0 / (1.0 - s.powf(n)) - 1.0 / (n * (1.0 - s)));
        self.series(1.0, MAX_SERIES_ARGUMENT, 0) + (v - std::f64::consts::LN_2) / n + regular_part
    }
}

/// Integral of a smooth function from `low` to `high`; zero for an empty range.
fn integral(low: f64, high: f64, f: impl Fn(f64) -> f64) -> f64 {
    if high <= low {
        return 0.0;
    }
    let middle = 0.5 * (low + high);
    let half_width = 0.5 * (high - low);
    let rule = gauss::largest_rule();
    let points = rule.nodes.iter().zip(&rule.weights);
    half_width * points.map(|(x, weight)| weight * f(middle + half_width * x)).sum::<f64>()
}
