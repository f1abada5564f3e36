//! Bouc–Wen spring.

use super::bilinear::elastic_share;
use super::bouc_wen_curve::Curve;
use super::{Hysteresis, InternalEnergy, SpringResponse, corrupt};
use crate::error::{Error, Result, positive};

/// Bouc–Wen hysteresis (Bouc 1967, Wen 1976) with a smooth transition to yield.
///
/// ```text
/// F = α k d + (1 − α) F_y z,      ż = (1 − (β sgn(ḋ z) + γ)|z|ⁿ) ḋ/d_y,      β + γ = 1,  d_y = F_y/k
/// ```
///
/// Steps follow this equation exactly on straight paths, however long they are. With β ≥ ½ it
/// only takes energy (Erlicher & Point 2004); the stored part counted is ½ α k d² + ½ (1−α) F_y d_y z².
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
    curve: Curve,
    deformation: f64,
    z: f64,
    dissipated: f64,
}

impl BoucWen {
    /// Spring with first `stiffness` k (N/m), `yield_force` F_y (N) and ratio `hardening` α of the
    /// last slope to the first, per metre of thickness. Exponent n = 2 and β = ½ unless set
    /// otherwise.
    ///
    /// # Errors
    /// [`Error::Input`] unless k and F_y are positive and 0 ≤ α < 1.
    pub fn new(stiffness: f64, yield_force: f64, hardening: f64) -> Result<Self> {
        positive("stiffness of the Bouc–Wen spring", stiffness)?;
        positive("yield force of the Bouc–Wen spring", yield_force)?;
        positive("yield displacement of the Bouc–Wen spring", yield_force / stiffness)?;
        elastic_share(hardening)?;
        let curve = Curve::new(2.0, 0.5);
        let (deformation, z, dissipated) = (0.0, 0.0, 0.0);
        Ok(Self { stiffness, yield_force, hardening, curve, deformation, z, dissipated })
    }

    /// The same spring with another exponent n (the larger, the sharper it yields) and β: with
    /// ½ it unloads straight, above ½ along a curve that bulges.
    ///
    /// # Errors
    /// [`Error::Input`] unless 1 ≤ n ≤ 10 and ½ ≤ β ≤ 1.
    pub fn with_shape(mut self, exponent: f64, beta: f64) -> Result<Self> {
        for (quantity, value, range, needed) in [
            ("exponent of the Bouc–Wen spring", exponent, 1.0..=10.0, "from 1 to 10"),
            ("beta of the Bouc–Wen spring", beta, 0.5..=1.0, "from 0.5 to 1"),
        ] {
            if !range.contains(&value) {
                return Err(Error::Input { quantity, value, needed });
            }
        }
        self.curve = Curve::new(exponent, beta);
        Ok(self)
    }

    /// z at a deformation, dz/d(d/d_y) there, and what the way has dissipated, in units of
    /// (1 − α) F_y d_y.
    fn follow(&self, deformation: f64) -> (f64, f64, f64) {
        let change = deformation - self.deformation;
        let side = if change == 0.0 { -self.z.signum() } else { change.signum() };
        let way = change.abs() * self.stiffness / self.yield_force;
        let (y, dissipated) = self.curve.advance(side * self.z, way);
        (side * y, self.curve.slope(y), dissipated)
    }
}

impl Hysteresis for BoucWen {
    fn response(&self, deformation: f64) -> SpringResponse {
        let (z, slope, _) = self.follow(deformation);
        let (k, share) = (self.stiffness, 1.0 - self.hardening);
        SpringResponse {
            force: self.hardening * k * deformation + share * self.yield_force * z,
            tangent: (self.hardening + share * slope) * k,
        }
    }

    fn energy(&self, deformation: f64) -> InternalEnergy {
        let (z, _, lost) = self.follow(deformation);
        let unit = (1.0 - self.hardening) * self.yield_force * self.yield_force / self.stiffness;
        let elastic = self.hardening * self.stiffness * deformation * deformation;
        InternalEnergy {
            stored: 0.5 * (elastic + unit * z * z),
            dissipated: self.dissipated + unit * lost,
        }
    }

    fn commit(&mut self, deformation: f64) {
        self.dissipated = self.energy(deformation).dissipated;
        self.z = self.follow(deformation).0;
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
}
