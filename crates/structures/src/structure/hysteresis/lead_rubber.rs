//! Lead–rubber bearing from its engineering parameters.

use super::biaxial::BiaxialSpring;
use super::coupled_slider::CoupledSlider;
use super::slider::{Slider, slider_law};
use crate::error::{Result, finite, positive, require};

/// Lead–rubber bearing: a bilinear spring from engineering parameters.
///
/// The rubber determines the stiffness after yield, K₂ = G A/t. The characteristic strength is Q = τ_y A_lead of the
/// lead core (the force at zero displacement of a wide loop). The initial stiffness of both is K₁ = r K₂ (Skinner,
/// Robinson & McVerry 1993; Naeim & Kelly 1999: r ≈ 10, τ_y ≈ 10 MPa).
///
/// ```
/// use basemat::structure::{Hysteresis, LeadRubber};
///
/// // G = 0.4 MPa, 0.5 m² of rubber, 0.2 m thick in all, 0.01 m² of lead.
/// let bearing = LeadRubber::new(0.4e6, 0.5, 0.2, 0.01)?;
/// assert_eq!(bearing.strength(), 100.0e3);
/// assert_eq!(bearing.response(0.2).force, 100.0e3 + 1.0e6 * 0.2);
/// assert_eq!(bearing.response(0.0).tangent, 10.0e6);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct LeadRubber {
    slider: Slider,
}

impl LeadRubber {
    /// Shear stress at which lead yields by default, Pa.
    pub(crate) const LEAD_YIELD_STRESS: f64 = 10.0e6;
    /// Default ratio of the initial stiffness to the stiffness after yield.
    pub const STIFFNESS_RATIO: f64 = 10.0;

    /// Bearing from the dimensions of its rubber and lead cores.
    ///
    /// `shear_modulus` G of the rubber: Pa. `rubber_area` A: m². `rubber_thickness` t: total, m. `lead_area` of
    /// the cores: m². Areas are per metre of the structure's thickness, out of the plane.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless all are positive.
    pub fn new(
        shear_modulus: f64,
        rubber_area: f64,
        rubber_thickness: f64,
        lead_area: f64,
    ) -> Result<Self> {
        positive("shear modulus of the rubber", shear_modulus)?;
        positive("area of the rubber", rubber_area)?;
        positive("thickness of the rubber", rubber_thickness)?;
        positive("area of the lead cores", lead_area)?;
        let rubber_stiffness = shear_modulus * rubber_area / rubber_thickness;
        Self::from_strength(rubber_stiffness, lead_area * Self::LEAD_YIELD_STRESS)
    }

    /// Bearing with stiffness after yield K₂ (N/m) and characteristic strength Q (N).
    ///
    /// Both per metre of the structure's thickness.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless both are positive.
    pub fn from_strength(stiffness: f64, strength: f64) -> Result<Self> {
        positive("stiffness of the rubber", stiffness)?;
        positive("strength of the lead cores", strength)?;
        let lead_stiffness = (Self::STIFFNESS_RATIO - 1.0) * stiffness;
        finite("initial stiffness of the bearing", lead_stiffness)?;
        Ok(Self { slider: Slider::new(stiffness, lead_stiffness, strength) })
    }

    /// Sets the ratio of the initial stiffness to the stiffness after yield.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless it is finite and above 1.
    pub fn with_stiffness_ratio(mut self, ratio: f64) -> Result<Self> {
        let requirement = "finite and above 1";
        require("ratio of stiffnesses", ratio, ratio.is_finite() && ratio > 1.0, requirement)?;
        let lead_stiffness = (ratio - 1.0) * self.slider.parallel_stiffness;
        self.slider.series_stiffness =
            positive("initial stiffness of the bearing", lead_stiffness)?;
        Ok(self)
    }

    /// Characteristic strength Q, N per metre of thickness.
    pub fn strength(&self) -> f64 {
        self.slider.limit
    }

    /// Stiffness after yield K₂, N/m per metre of thickness.
    pub fn stiffness(&self) -> f64 {
        self.slider.parallel_stiffness
    }

    /// A new bearing with these parameters for two directions.
    ///
    /// Its force is K₂ d plus the force of the lead, which yields on a circle of radius Q.
    pub fn coupled(&self) -> BiaxialSpring {
        CoupledSlider::new(&self.slider).into()
    }
}

slider_law!(LeadRubber);
