//! Dynamic stiffness of the strips of an elastic ground.

use super::layered::{StripContact, StripImpedance, impedance_progress, strip_impedances};
use super::{ElasticGround, Ground};
use crate::error::{Error, Observer, Result};
use crate::geometry::ContactLayout;

impl ElasticGround {
    /// Dynamic stiffness of all strips as one rigid body, at each of `frequencies` (Hz).
    ///
    /// The error on cosine-graded strips is of second order in the element length. The observer's progress is the
    /// number of Laplace variables, eight per frequency.
    ///
    /// The result at frequency 0 on rigid bedrock is the static stiffness. Layers may have any damping, also hysteretic
    /// damping.
    ///
    /// ```
    /// use basemat::{Soil, unobserved};
    /// use basemat::bem::layered::StripContact;
    /// use basemat::bem::{ElasticGround, Strip};
    /// use basemat::soil::SoilProfile;
    /// let soil = Soil::from_shear_wave_speed(150.0, 0.33, 1800.0)?;
    /// let strip = Strip::graded(-3.0..3.0, 16)?;
    /// let ground = ElasticGround::new(soil, &strip)?;
    /// let impedances = ground.impedances(&[2.0, 8.0], StripContact::Bonded, &mut unobserved)?;
    /// // The vertical dashpot is close to the dashpot of plane waves, ρ c₁ per area.
    /// let plane_wave_dashpot = 1800.0 * soil.pressure_wave_speed() * 6.0;
    /// assert!((impedances[1].dashpots()[1] / plane_wave_dashpot - 1.0).abs() < 0.1);
    ///
    /// let layer = SoilProfile::on_rigid_bedrock().with_layer(soil, 6.0)?;
    /// let ground = ElasticGround::new(layer, strip)?;
    /// let impedances = ground.impedances(&[1.0, 9.0], StripContact::Bonded, &mut unobserved)?;
    /// // Below the layer's first natural frequency, 6.25 Hz, the strip radiates no waves.
    /// assert!(impedances[0].horizontal.im < 1e-6 * impedances[0].horizontal.re);
    /// assert!(impedances[1].horizontal.im > 0.5 * impedances[1].horizontal.re);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Scene`] for a ground in plan; [`Error::Input`] for a frequency that is negative or not
    /// finite, or 0 on a half-plane, whose static stiffness is 0;
    /// [`GroundError::Unresolved`](crate::bem::GroundError::Unresolved) without damping at a frequency at which
    /// guided waves begin; [`Error::Singular`] if two elements have nearly equal equations;
    /// [`Error::Stopped`] by the observer.
    pub fn impedances(
        &self,
        frequencies: &[f64],
        contact: StripContact,
        observer: &mut Observer<'_>,
    ) -> Result<Vec<StripImpedance>> {
        if ContactLayout::for_elements(self.elements()).is_plan() {
            return Err(Error::Scene {
                quantity: "ground in plan",
                needed: "`bem::plan::impedances_in_plan`: these are impedances of strips",
            });
        }
        let progress = &mut impedance_progress(frequencies, observer);
        strip_impedances(self.profile(), self.elements(), frequencies, contact, progress)
    }
}
