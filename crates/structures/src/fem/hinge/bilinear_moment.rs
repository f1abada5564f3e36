//! Moment–rotation law with two straight branches.

use crate::error::{Result, positive, require};
use crate::fem::fiber::{BilinearSteel, UniaxialMaterial, UniaxialResponse};
use crate::fem::internal_energy::InternalEnergy;

/// Moment of a hinge with two straight branches and kinematic hardening.
///
/// The moment M is elastic with the stiffness k up to the plastic moment M_p, and has the stiffness b k beyond. After a
/// reversal it is elastic over a range of 2 M_p. As a [`UniaxialMaterial`] its strain is the rotation (rad) and its stress
/// the moment (N m, in the plane per metre of thickness).
///
/// ```
/// use basemat::fem::{BilinearMoment, UniaxialMaterial};
///
/// // 400 kN m at 0.01 rad, a hundredth of the stiffness beyond.
/// let law = BilinearMoment::new(400.0e3, 40.0e6, 0.01)?;
/// let moment = law.response(0.03, &[0.0; 2])?.stress;
/// assert!((moment - 408.0e3).abs() < 1e-6);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BilinearMoment(BilinearSteel);

/// Returns an error unless a hardening ratio is from 0 to below 1.
pub(super) fn check_hardening_ratio(hardening_ratio: f64) -> Result<f64> {
    let is_ratio = (0.0..1.0).contains(&hardening_ratio);
    require("hardening ratio of the hinge", hardening_ratio, is_ratio, "from 0 to below 1")
}

impl BilinearMoment {
    /// Law of a plastic moment M_p (N m), rotational stiffness k (N m/rad) and hardening ratio b.
    ///
    /// In the plane moments are per metre of thickness.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless M_p and k are positive and 0 ≤ b < 1.
    pub fn new(plastic_moment: f64, stiffness: f64, hardening_ratio: f64) -> Result<Self> {
        positive("plastic moment of the hinge", plastic_moment)?;
        positive("rotational stiffness of the hinge", stiffness)?;
        check_hardening_ratio(hardening_ratio)?;
        Ok(Self(BilinearSteel::new(plastic_moment, stiffness, hardening_ratio)?))
    }
}

/// Variables: plastic rotation, and dissipated energy (J).
impl UniaxialMaterial for BilinearMoment {
    fn modulus(&self) -> f64 {
        self.0.modulus()
    }

    fn variable_count(&self) -> usize {
        self.0.variable_count()
    }

    fn response(&self, strain: f64, variables: &[f64]) -> Result<UniaxialResponse> {
        self.0.response(strain, variables)
    }

    fn energy(&self, strain: f64, variables: &[f64]) -> Result<InternalEnergy> {
        self.0.energy(strain, variables)
    }

    fn remainder(&self, strains: [f64; 3], variables: &[f64]) -> Result<f64> {
        self.0.remainder(strains, variables)
    }

    fn commit(&self, strain: f64, variables: &mut [f64]) {
        self.0.commit(strain, variables);
    }
}
