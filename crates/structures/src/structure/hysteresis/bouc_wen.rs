//! Bouc–Wen spring.

use super::biaxial::BiaxialSpring;
use super::coupled_bouc_wen::CoupledBoucWen;
use super::slider::elastic_share;
use super::{Hysteresis, SpringResponse, corrupt};
use crate::error::{Result, positive, require};
use crate::linalg::gauss;
use crate::structure::InternalEnergy;

/// Bouc–Wen hysteresis (Bouc 1967, Wen 1976) with a smooth transition to yield.
///
/// ```text
/// F = α k d + (1 − α) F_y z,      ż = (1 − (β sgn(ḋ z) + γ)|z|ⁿ) ḋ/d_y,      β + γ = 1,  d_y = F_y/k
/// ```
///
/// Steps follow this equation exactly on straight paths, however long they are. With β ≥ ½ the spring never
/// releases more energy than it has stored (Erlicher & Point 2004). Stored energy is ½ α k d² + ½ (1−α) F_y d_y
/// z².
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
    curve: LoopShape,
    deformation: f64,
    z: f64,
    dissipated: f64,
}

impl BoucWen {
    /// Spring with first stiffness k, yield force F_y and hardening α.
    ///
    /// `stiffness`: N/m. `yield_force`: N. `hardening`: ratio of the last slope to the first. All per metre of
    /// thickness. The exponent n is 2 and β is ½ unless set otherwise.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless k and F_y are positive and 0 ≤ α < 1.
    pub fn new(stiffness: f64, yield_force: f64, hardening: f64) -> Result<Self> {
        positive("stiffness of the Bouc–Wen spring", stiffness)?;
        positive("yield force of the Bouc–Wen spring", yield_force)?;
        positive("yield displacement of the Bouc–Wen spring", yield_force / stiffness)?;
        elastic_share(hardening)?;
        Ok(Self {
            stiffness,
            yield_force,
            hardening,
            curve: LoopShape::new(2.0, 0.5),
            deformation: 0.0,
            z: 0.0,
            dissipated: 0.0,
        })
    }

    /// Sets the exponent n and β.
    ///
    /// The larger n, the sharper the spring yields. With β = ½ it unloads straight, above ½ along a curve that
    /// bulges.
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
        self.curve = LoopShape::new(exponent, beta);
        Ok(self)
    }

    /// A new spring with these numbers in two directions: the law of Park, Wen & Ang (1986).
    ///
    /// ```text
    /// F = α k d + (1 − α) F_y z,      ż = (ḋ − (β |ḋ·z| + γ ḋ·z) z)/d_y
    /// ```
    ///
    /// with vectors F, d and z. Steps follow this equation exactly on straight paths, however long they are. |ḋ·z|
    /// replaces the sum |ḋ_x z_x| + |ḋ_y z_y| of the paper, which depends on the axes: on an ellipse of 3 by 1.5 d_y
    /// its force changes by 0.11 F_y if the axes turn by 45°. Both agree along straight lines.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the exponent is 2, as in the paper.
    pub fn coupled(&self) -> Result<BiaxialSpring> {
        let exponent = self.curve.exponent;
        let quantity = "exponent of the coupled Bouc–Wen spring";
        require(quantity, exponent, exponent == 2.0, "2")?;
        let unloading = self.curve.unloading;
        let law = CoupledBoucWen::new(self.stiffness, self.yield_force, self.hardening, unloading);
        Ok(law.into())
    }

    /// The straight path to a deformation.
    fn follow(&self, deformation: f64) -> PathEnd {
        let change = deformation - self.deformation;
        let side = if change == 0.0 { -self.z.signum() } else { change.signum() };
        let way = change.abs() * self.stiffness / self.yield_force;
        let (y, lost) = self.curve.advance(side * self.z, way);
        PathEnd { z: side * y, slope: self.curve.slope(y), lost }
    }
}

/// End of a straight path.
struct PathEnd {
    z: f64,
    /// dz/d(d/d_y).
    slope: f64,
    /// Energy dissipated on the path, in units of (1 − α) F_y d_y.
    lost: f64,
}

impl Hysteresis for BoucWen {
    fn response(&self, deformation: f64) -> SpringResponse {
        let PathEnd { z, slope, .. } = self.follow(deformation);
        let k = self.stiffness;
        let hysteretic = 1.0 - self.hardening;
        SpringResponse {
            force: self.hardening * k * deformation + hysteretic * self.yield_force * z,
            tangent: (self.hardening + hysteretic * slope) * k,
        }
    }

    fn energy(&self, deformation: f64) -> InternalEnergy {
        let PathEnd { z, lost, .. } = self.follow(deformation);
        let unit = (1.0 - self.hardening) * self.yield_force * self.yield_force / self.stiffness;
        let elastic = self.hardening * self.stiffness * deformation * deformation;
        InternalEnergy {
            stored: 0.5 * (elastic + unit * z * z),
            dissipated: self.dissipated + unit * lost,
        }
    }

    fn commit(&mut self, deformation: f64) {
        self.dissipated = self.energy(deformation).dissipated;
        self.z = self.follow(deformation).z;
        self.deformation = deformation;
    }

    fn save(&self) -> Vec<f64> {
        vec![self.deformation, self.z, self.dissipated]
    }

    fn restore(&mut self, values: &[f64]) -> Result<()> {
        match values {
            &[deformation, z, dissipated]
                if deformation.is_finite()
                    && z.abs() <= 1.0
                    && dissipated.is_finite()
                    && dissipated >= 0.0 =>
            {
                (self.deformation, self.z, self.dissipated) = (deformation, z, dissipated);
                Ok(())
            }
            _ => Err(corrupt()),
        }
    }

    fn clone_box(&self) -> Box<dyn Hysteresis> {
        Box::new(self.clone())
    }
}

/// Exponent and shape of z, with the integrals of its equation.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LoopShape {
    exponent: f64,
    /// b = β − γ.
    unloading: f64,
}

/// Limit of Newton's iterations, which converge from one side and finally quadratically.
const MAX_NEWTON_ITERATIONS: usize = 60;

impl LoopShape {
    pub(super) fn new(exponent: f64, beta: f64) -> Self {
        Self { exponent, unloading: 2.0 * beta - 1.0 }
    }

    /// dy/dξ.
    pub(super) fn slope(&self, y: f64) -> f64 {
        let power = y.abs().powf(self.exponent);
        if y > 0.0 { 1.0 - power } else { 1.0 + self.unloading * power }
    }

    /// y after a path ξ ≥ 0 from y₀, and the energy ∫ y (1 − dy/dξ) dξ dissipated on it.
    pub(super) fn advance(&self, start: f64, way: f64) -> (f64, f64) {
        if !(start.abs() <= 1.0 && way.is_finite()) {
            return (f64::NAN, f64::NAN);
        }
        let mut start = start;
        let mut way = way;
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
        let n = self.exponent;
        let b = self.unloading;
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
        let mut power = x.powi(p + 1);
        let mut order = f64::from(p + 1);
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
        for _ in 0..MAX_NEWTON_ITERATIONS {
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
        for _ in 0..MAX_NEWTON_ITERATIONS {
            // (1 − yⁿ)/(1 − y)
            let slope = -f64::exp_m1(self.exponent * (-(-v).exp()).ln_1p()) / (-v).exp();
            let slope = if slope.is_finite() { slope } else { self.exponent };
            let step = (target - self.loaded(v)) * slope;
            v += step;
            if step.abs() <= 1e-15 * v.abs() {
                break;
            }
        }
        // Rounding must not reverse the direction.
        (-f64::exp_m1(-v)).clamp(start, 1.0)
    }

    /// X at y = 1 − exp(−v).
    fn loaded(&self, v: f64) -> f64 {
        let n = self.exponent;
        let y = -f64::exp_m1(-v);
        if y <= 0.5 {
            return self.series(1.0, y, 0);
        }
        // The integrand less its singular part 1/(n (1 − s)).
        let regular = integral(0.5, y, |s| 1.0 / (1.0 - s.powf(n)) - 1.0 / (n * (1.0 - s)));
        self.series(1.0, 0.5, 0) + (v - std::f64::consts::LN_2) / n + regular
    }
}

/// ∫ of a smooth function; zero for an empty range.
fn integral(low: f64, high: f64, f: impl Fn(f64) -> f64) -> f64 {
    if high <= low {
        return 0.0;
    }
    let middle = 0.5 * (low + high);
    let half = 0.5 * (high - low);
    let rule = gauss::largest();
    let points = rule.nodes.iter().zip(&rule.weights);
    half * points.map(|(x, weight)| weight * f(middle + half * x)).sum::<f64>()
}
