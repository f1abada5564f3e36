//! Thin elastic layer between base and soil, after Patel & Spyrakos.
//!
//! | symbol | meaning |
//! |---|---|
//! | t | thickness of the layer: ratio × height of the adjacent element |
//! | k_n = D₂₂/t, k_s = μ/t | stiffness per unit area, Pa/m; D₂₂ = λ + 2μ, plane strain |
//! | g, s, p, τ | gap, slip, pressure, shear traction; ₀ at the start of the step |
//!
//! A four-node element of length L and thickness t, integrated at its centre, has the strains ε_yy = g/t and γ = s/t,
//! where g and s are means over its long sides. Its strain ε_xx is smaller by a factor of the order of t/L. Its nodal
//! forces equal the forces of the tractions D₂₂ g/t and μ s/t on L. The layer is therefore a law between the mean gap, slip
//! and tractions of one contact element, without additional degrees of freedom. [PS] is the paper of Patel & Spyrakos.

use super::coulomb::check_friction;
use super::{
    Condition, ContactScene, ContactState, InterfaceLaw, Limits, Mode, PreviousContact, Tolerance,
};
use crate::error::{Result, not_negative, positive, require, require_part};
use crate::soil::Soil;

/// Thickness of the layer over the height of the adjacent element [PS, eq. 13].
const DEFAULT_THICKNESS_RATIO: f64 = 0.1;
/// Fraction of the stiffness that keeps the stiffness matrix of debonded elements regular.
const DEFAULT_DEBONDED_RATIO: f64 = 1e-3;

/// Pressure from which a thin layer computes its friction limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum FrictionLimit {
    /// The total pressure of this step.
    #[default]
    Total,
    /// The total pressure of the previous step.
    Lagged,
    /// The pressure of the static state, throughout the run.
    Static,
    /// The magnitude of the change of pressure from the static state to the end of the previous step.
    Dynamic,
}

words! { pub(crate) FrictionLimit, "friction limit", {
    Total = "total",
    Lagged = "lagged",
    Static = "static",
    Dynamic = "dynamic",
} }

/// Quantity that determines the direction of slip and whether slip continues.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum SlipSense {
    /// Slip beyond the elastic slip, as in plasticity.
    ///
    /// Slip starts in the direction of the shear traction and continues while the inelastic slip grows.
    #[default]
    Inelastic,
    /// The relative velocity of this step, including the elastic part [PS, eq. 12].
    Velocity,
    /// The relative velocity of the previous step.
    LastVelocity,
}

words! { pub(crate) SlipSense, "sense of slip", {
    Inelastic = "inelastic",
    Velocity = "velocity",
    LastVelocity = "last_velocity",
} }

/// Thin-layer interface elements between base and soil.
///
/// The layer is elastic in stick and in debonding [PS, eqs. 6–9]. It has Coulomb friction in slip [PS, eqs. 10–12], and
/// rebonds when the gap has closed. By default it is a tenth as thick as the adjacent elements [PS, eq. 13].
///
/// | mode | pressure | shear traction |
/// |---|---|---|
/// | stick | p = −k_n g | τ = τ₀ + k_s (s − s₀) |
/// | slip | p = −k_n g | τ = ± friction · p |
/// | debonding | p = −r k_n g | τ = r k_s × slip since it opened |
///
/// with r = 0.001 by default, so that an open element still carries a small tension. A layer a hundred times thinner
/// carries a hundred times more tension while it is open, so r must be reduced with the thickness. The shear traction in
/// stick continues from the previous step, so that inelastic slip remains. A layer of zero thickness is
/// [`Coulomb`](super::Coulomb).
///
/// With the default [`FrictionLimit`] and [`SlipSense`] and zero stiffness in slip, the shear of a closed element vanishes
/// with its pressure, as the friction limit does. An open element with r > 0 carries some shear until it closes, and then
/// loses it. A few steps may then have no solution, closed or open. Such a step returns a
/// [`StepError::Contact`](crate::coupled::StepError::Contact), which states for up to eight elements that no solution
/// exists. With [`with_debonded_ratio(0.0)`](ThinLayer::with_debonded_ratio) there are no such steps. With the other
/// options a closed element can carry shear until it opens, or slide against its traction: such steps are more frequent.
///
/// ```
/// use basemat::{Soil, interface::ThinLayer};
/// let soil = Soil::new(80.0e6, 1.0 / 3.0, 1900.0)?;
/// // Under finite elements 2 m high: a layer of 0.2 m.
/// let layer = ThinLayer::new(soil, 2.0, 0.4)?;
/// assert!((layer.stiffness()[1] / (80.0e6 / 0.2) - 1.0).abs() < 1e-12);
/// assert!((layer.stiffness()[0] / (320.0e6 / 0.2) - 1.0).abs() < 1e-12);
/// assert!(layer.with_thickness_ratio(0.0).is_err());
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "ThinLayerForm"))]
pub struct ThinLayer {
    /// k_n and k_s of a layer as thick as the adjacent element is high.
    reference_stiffness: [f64; 2],
    thickness_ratio: f64,
    #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::number"))]
    friction: f64,
    debonded_ratio: f64,
    friction_limit: FrictionLimit,
    slip_sense: SlipSense,
    slip_stiffness_ratio: f64,
}

validated! {
    ThinLayer as ThinLayerForm {
        reference_stiffness: [f64; 2],
        thickness_ratio: f64,
        #[serde(with = "crate::text::forms::number")]
        friction: f64,
        debonded_ratio: f64,
        friction_limit: FrictionLimit,
        slip_sense: SlipSense,
        slip_stiffness_ratio: f64,
    }
    => {
        let layer = ThinLayer::from_stiffness(reference_stiffness[0], reference_stiffness[1], friction)?
            .with_thickness_ratio(thickness_ratio)?
            .with_debonded_ratio(debonded_ratio)?
            .with_slip_stiffness_ratio(slip_stiffness_ratio)?;
        Ok(layer.with_friction_limit(friction_limit).with_slip_sense(slip_sense))
    }
}

impl ThinLayer {
    /// Creates a layer of `soil`, a tenth as thick as the adjacent elements.
    ///
    /// `neighbour_height`: height of these elements, m. The friction coefficient is zero or more; if it is infinite,
    /// nothing ever slides.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the height is finite and above zero, and `friction` not negative.
    pub fn new(soil: Soil, neighbour_height: f64, friction: f64) -> Result<Self> {
        positive("height of the element beside the thin layer", neighbour_height)?;
        let shear_modulus = soil.shear_modulus();
        let nu = soil.poisson();
        let constrained_modulus = 2.0 * shear_modulus * (1.0 - nu) / (1.0 - 2.0 * nu);
        let normal_stiffness = constrained_modulus / neighbour_height;
        let shear_stiffness = shear_modulus / neighbour_height;
        Self::from_stiffness(normal_stiffness, shear_stiffness, friction)?
            .with_thickness_ratio(DEFAULT_THICKNESS_RATIO)
    }

    /// Creates a layer from its stiffnesses k_n and k_s (Pa/m) at a thickness ratio of one.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless both are finite and above zero, and `friction` is not negative.
    pub fn from_stiffness(k_n: f64, k_s: f64, friction: f64) -> Result<Self> {
        positive("normal stiffness of the thin layer", k_n)?;
        positive("shear stiffness of the thin layer", k_s)?;
        check_friction(friction)?;
        Ok(Self {
            reference_stiffness: [k_n, k_s],
            thickness_ratio: 1.0,
            friction,
            debonded_ratio: DEFAULT_DEBONDED_RATIO,
            friction_limit: FrictionLimit::Total,
            slip_sense: SlipSense::Inelastic,
            slip_stiffness_ratio: 0.0,
        })
    }

    /// Sets the thickness, as a fraction of the height of the adjacent element.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the ratio is finite and above zero, and the stiffness finite.
    pub fn with_thickness_ratio(mut self, ratio: f64) -> Result<Self> {
        self.thickness_ratio = positive("thickness ratio of the thin layer", ratio)?;
        for stiffness in self.stiffness() {
            positive("stiffness of the thin layer", stiffness)?;
        }
        Ok(self)
    }

    /// Sets the fraction of the stiffness that remains in debonding; the default is 0.001.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) outside 0 to 1.
    pub fn with_debonded_ratio(mut self, ratio: f64) -> Result<Self> {
        self.debonded_ratio = fraction_of_one("ratio of stiffness left in debonding", ratio)?;
        Ok(self)
    }

    /// Sets the pressure from which the friction limit is computed.
    #[must_use]
    pub fn with_friction_limit(mut self, limit: FrictionLimit) -> Self {
        self.friction_limit = limit;
        self
    }

    /// Sets the quantity that determines the direction of slip.
    #[must_use]
    pub fn with_slip_sense(mut self, sense: SlipSense) -> Self {
        self.slip_sense = sense;
        self
    }

    /// Sets the fraction of the shear stiffness that resists slip besides friction.
    ///
    /// It resists the slip of each step like a viscosity. The default is zero.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) outside 0 to 1.
    pub fn with_slip_stiffness_ratio(mut self, ratio: f64) -> Result<Self> {
        self.slip_stiffness_ratio =
            fraction_of_one("ratio of shear stiffness left in slip", ratio)?;
        Ok(self)
    }

    /// Normal and shear stiffness k_n and k_s of the layer, Pa/m.
    pub fn stiffness(&self) -> [f64; 2] {
        self.reference_stiffness.map(|stiffness| stiffness / self.thickness_ratio)
    }

    /// Friction limit, Pa; `None` if it is infinite or depends on the pressure in the step.
    fn prescribed_limit(&self, start: &PreviousContact) -> Option<f64> {
        let pressure = match self.friction_limit {
            FrictionLimit::Total => return None,
            _ if self.friction == f64::INFINITY => return None,
            FrictionLimit::Lagged => start.state.pressure.max(0.0),
            FrictionLimit::Static => start.static_pressure,
            FrictionLimit::Dynamic => (start.state.pressure - start.static_pressure).abs(),
        };
        Some(self.friction * pressure)
    }

    /// Condition ±τ = limit + `slip_stiffness_ratio` · k_s (±Δs) of a sliding element.
    ///
    /// `direction`: 1 to the right, −1 to the left. For infinite friction the condition is p = 0, with any shear traction.
    fn slip_condition(&self, direction: f64, start: &PreviousContact) -> Condition {
        let slip_stiffness = self.slip_stiffness_ratio * self.stiffness()[1];
        let traction_offset = slip_stiffness * start.state.slip;
        if let Some(limit) = self.prescribed_limit(start) {
            let value = direction * limit - traction_offset;
            return Condition { shear: 1.0, slip: -slip_stiffness, value, ..Condition::default() };
        }
        let scale = 1.0 / self.friction.max(1.0);
        let pressure_coefficient = if self.friction > 1.0 { -1.0 } else { -self.friction };
        Condition {
            shear: direction * scale,
            slip: -direction * scale * slip_stiffness,
            pressure: pressure_coefficient,
            value: -direction * scale * traction_offset,
            ..Condition::default()
        }
    }

    /// Whether slip in this direction ends, as [`SlipSense`] defines; `tolerance` is a slip, m.
    fn ends_slip(
        &self,
        direction: f64,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: f64,
    ) -> bool {
        let increment = trial.slip - start.state.slip;
        let elastic_increment = (trial.shear - start.state.shear) / self.stiffness()[1];
        match self.slip_sense {
            SlipSense::Inelastic => direction * (increment - elastic_increment) < -tolerance,
            SlipSense::Velocity => direction * increment < -tolerance,
            // The velocity of the previous step does not change with the trial, so that it needs no tolerance.
            SlipSense::LastVelocity => direction * start.slip_rate < 0.0,
        }
    }
}

/// Returns `value` if it is from 0 to 1, else an error.
fn fraction_of_one(quantity: &'static str, value: f64) -> Result<f64> {
    not_negative(quantity, value)?;
    require(quantity, value, value <= 1.0, "from 0 to 1")
}

impl InterfaceLaw for ThinLayer {
    fn modes(&self) -> &[Mode] {
        Mode::with_friction(self.friction)
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        let stiffness_ratio = if mode == Mode::Open { self.debonded_ratio } else { 1.0 };
        let [normal_stiffness, shear_stiffness] = self.stiffness().map(|k| stiffness_ratio * k);
        let normal_condition = Condition { gap: normal_stiffness, ..Condition::pressure_is(0.0) };
        let tangential_condition = match mode {
            Mode::SlipRight => self.slip_condition(1.0, start),
            Mode::SlipLeft => self.slip_condition(-1.0, start),
            _ => {
                // The shear that a closed layer carried is lost when it opens.
                let is_opening = mode == Mode::Open && start.mode.is_closed();
                let initial_shear = if is_opening { 0.0 } else { start.state.shear };
                let value = initial_shear - shear_stiffness * start.state.slip;
                Condition { slip: -shear_stiffness, ..Condition::shear_is(value) }
            }
        };
        [normal_condition, tangential_condition]
    }

    fn next_mode(
        &self,
        mode: Mode,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        let traction_tolerance = tolerance.traction;
        if mode == Mode::Open {
            return if trial.gap < -tolerance.length { self.modes()[0] } else { Mode::Open };
        }
        if trial.pressure < -traction_tolerance {
            return Mode::Open;
        }
        let prescribed_limit = self.prescribed_limit(start);
        let shear_limit = prescribed_limit.unwrap_or(self.friction * trial.pressure.max(0.0));
        let mode_after_sliding = |direction: f64| {
            let slip_tolerance = tolerance.length + traction_tolerance / self.stiffness()[1];
            let has_slip_stiffness = self.slip_stiffness_ratio > 0.0 && self.friction.is_finite();
            // The shear is then ± friction · p: its sign is opposite to `direction` only under tension.
            let is_shear_from_pressure = prescribed_limit.is_none() && !has_slip_stiffness;
            if self.friction == 0.0 {
                mode
            } else if is_shear_from_pressure && direction * trial.shear < -traction_tolerance {
                Mode::Open
            } else if self.ends_slip(direction, start, trial, slip_tolerance) {
                Mode::Stick
            } else {
                mode
            }
        };
        let has_last_velocity = self.slip_sense == SlipSense::LastVelocity;
        match mode {
            Mode::SlipRight => mode_after_sliding(1.0),
            Mode::SlipLeft => mode_after_sliding(-1.0),
            // The shear limit is NaN for infinite friction without pressure.
            _ if self.friction == f64::INFINITY => Mode::Stick,
            _ if trial.shear.abs() <= shear_limit + traction_tolerance => Mode::Stick,
            _ if has_last_velocity && start.slip_rate < 0.0 => Mode::SlipLeft,
            _ if has_last_velocity && start.slip_rate > 0.0 => Mode::SlipRight,
            _ if trial.shear > 0.0 => Mode::SlipRight,
            _ => Mode::SlipLeft,
        }
    }

    fn compliance(&self, mode: Mode, _: &PreviousContact) -> [f64; 2] {
        match mode {
            Mode::Open if self.debonded_ratio == 0.0 => [0.0; 2],
            Mode::Open => self.stiffness().map(|stiffness| 1.0 / (self.debonded_ratio * stiffness)),
            _ => self.stiffness().map(f64::recip),
        }
    }

    /// Never returns an error; the default would reject a layer without limits.
    fn check_start(&self, _start: &PreviousContact) -> Result<()> {
        Ok(())
    }

    /// Limits in plan, for inelastic [`SlipSense`] without slip stiffness and traction in debonding.
    fn limits(&self, start: &PreviousContact) -> Result<Limits> {
        let quantity = "thin layer in plan";
        let needed = "`with_debonded_ratio(0.0)`: an open element in plan has no traction";
        require_part(quantity, self.debonded_ratio == 0.0, needed)?;
        let has_inelastic_slip = self.slip_sense == SlipSense::Inelastic;
        let is_plastic = has_inelastic_slip && self.slip_stiffness_ratio == 0.0;
        require_part(quantity, is_plastic, "slip that is inelastic, without a stiffness in slip")?;
        Ok(match self.prescribed_limit(start) {
            Some(limit) => Limits { shear_strength: limit, ..Limits::default() },
            None => Limits { friction: self.friction, ..Limits::default() },
        })
    }

    /// Friction coefficient of the law, for any [`FrictionLimit`].
    fn friction_coefficient(&self) -> Option<f64> {
        Some(self.friction)
    }

    fn frictionless(&self) -> Box<dyn InterfaceLaw> {
        let friction_limit = FrictionLimit::Total;
        Box::new(Self { friction: 0.0, friction_limit, slip_stiffness_ratio: 0.0, ..*self })
    }

    fn check(&self, scene: &ContactScene) -> Result<()> {
        let has_pressure = self.friction_limit != FrictionLimit::Static || scene.gravity != 0.0;
        let needed = "there is none without gravity";
        require_part("friction limited by the static pressure", has_pressure, needed)
    }
}
