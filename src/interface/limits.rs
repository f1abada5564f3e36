//! Limits of an element's tractions, and modes and conditions that follow from them.

use super::{Condition, ContactState, Mode, PreviousContact, Tolerance};
use crate::error::{Error, Result, finite, not_negative, require};

/// Bounds of the tractions of an element during a step.
///
/// See [`InterfaceLaw::limits`](super::InterfaceLaw::limits).
///
/// | | |
/// |---|---|
/// | pressure p | −`tension` ≤ p ≤ `pressure_cap` + `hardening` · settlement |
/// | gap g | `gap_offset` or more where p = −`tension`, less where p is at the upper bound, else `gap_offset` |
/// | settlement | `gap_offset` − g ≥ 0 of soil that yields; 0 else |
/// | shear traction τ, slip Δs | \|τ\| ≤ R, Δs = 0 or along τ with \|τ\| = R |
/// | R | `friction` · max(p + `attraction`, 0) + `shear_strength` |
///
/// An element with a tension, an attraction or a shear strength loses them in the step in which it opens. In the plane an
/// element that slides under more tension than its attraction opens.
/// Elastic layers are in addition to these limits: see
/// [`InterfaceLaw::compliance`](super::InterfaceLaw::compliance) of the mode stick. Hardening is linear in a step; a law
/// whose pressure is a curve returns the tangent at
/// [`PreviousContact::trial_settlement`](super::PreviousContact::trial_settlement). The default is frictionless and hard
/// contact.
///
/// ```
/// use basemat::interface::{Coulomb, ContactState, InterfaceLaw, Limits, Mode, PreviousContact};
/// let start = PreviousContact::new(ContactState::default(), Mode::Stick, 0.01);
/// let limits = Coulomb::new(0.4)?.limits(&start)?;
/// assert_eq!(limits, Limits { friction: 0.4, ..Limits::default() });
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Limits {
    /// Friction coefficient; infinite where nothing slides.
    ///
    /// With 3 or more, a step may have several solutions: see [`Coulomb::new`](super::Coulomb::new).
    pub friction: f64,
    /// Pressure that is added to p in the friction limit, Pa.
    pub attraction: f64,
    /// Shear strength in addition to friction, Pa.
    pub shear_strength: f64,
    /// Tensile strength, Pa.
    pub tension: f64,
    /// Largest pressure of soil that does not settle in the step, Pa.
    ///
    /// It is infinite if there is no bound.
    pub pressure_cap: f64,
    /// Growth of the largest pressure with the settlement in the step, Pa/m.
    ///
    /// It is zero or more.
    #[cfg_attr(feature = "serde", serde(default))]
    pub hardening: f64,
    /// Gap of a closed element, m; −∞ if the element cannot close in this step.
    pub gap_offset: f64,
    /// Whether base and soil neither separate nor slide, for any tractions.
    pub bonded: bool,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            friction: 0.0,
            attraction: 0.0,
            shear_strength: 0.0,
            tension: 0.0,
            pressure_cap: f64::INFINITY,
            hardening: 0.0,
            gap_offset: 0.0,
            bonded: false,
        }
    }
}

impl Limits {
    /// These limits without friction, attraction and shear strength.
    ///
    /// They act in a frictionless gravity stage.
    pub(crate) fn frictionless(self) -> Self {
        Self { friction: 0.0, attraction: 0.0, shear_strength: 0.0, ..self }
    }

    /// Error of [`InterfaceLaw::limits`](super::InterfaceLaw::limits) for a law of the plane alone.
    ///
    /// # Errors
    /// Always [`Error::Scene`](crate::Error::Scene), with the name of the law.
    #[deprecated(
        since = "0.5.0",
        note = "implement `PlaneLaw`, and pass the law as `InPlane(law)`"
    )]
    pub fn only_in_plane<Law: ?Sized>() -> Result<Self> {
        Self::missing(std::any::type_name::<Law>())
    }

    /// Returns an error for a law without limits; `type_name`: its path.
    pub(super) fn missing(type_name: &'static str) -> Result<Self> {
        let quantity = type_name.rsplit("::").next().unwrap_or(type_name);
        Err(Error::Scene { quantity, needed: "`limits`, to act on a ground in plan" })
    }

    /// Whether all limits are valid, as [`Limits::checked`] needs them.
    #[inline]
    pub(crate) fn are_valid(&self) -> bool {
        let strengths = [self.attraction, self.shear_strength, self.tension, self.hardening];
        let has_valid_gap = self.gap_offset.is_finite() || self.gap_offset == f64::NEG_INFINITY;
        // Comparisons with NaN are false.
        let are_not_negative = strengths.iter().all(|value| (0.0..f64::INFINITY).contains(value));
        self.friction >= 0.0 && self.pressure_cap >= 0.0 && are_not_negative && has_valid_gap
    }

    /// Returns these limits, or an error that names an invalid one.
    #[inline]
    pub(crate) fn checked(self) -> Result<Self> {
        if self.are_valid() { Ok(self) } else { self.with_invalid_named() }
    }

    /// Returns an error that names the first invalid limit, or these limits if all are valid.
    #[cold]
    fn with_invalid_named(self) -> Result<Self> {
        for (quantity, value) in
            [("friction coefficient", self.friction), ("greatest pressure", self.pressure_cap)]
        {
            require(quantity, value, value >= 0.0, "zero or more, or infinite")?;
        }
        not_negative("attraction of the interface", self.attraction)?;
        not_negative("shear strength of the interface", self.shear_strength)?;
        not_negative("tensile strength of the interface", self.tension)?;
        not_negative("hardening of the soil", self.hardening)?;
        if self.gap_offset != f64::NEG_INFINITY {
            finite("gap of a closed element", self.gap_offset)?;
        }
        Ok(self)
    }

    /// The two conditions of a mode in the plane: normal, then tangential.
    ///
    /// `compliance`: of the law's elastic layer, as in [`InterfaceLaw::compliance`](super::InterfaceLaw::compliance).
    /// The conditions are NaN for invalid limits, which [`Limits::checked`] reports.
    pub(super) fn conditions(
        &self,
        mode: Mode,
        start: &PreviousContact,
        compliance: [f64; 2],
    ) -> [Condition; 2] {
        if !self.are_valid() {
            return [Condition::gap_is(f64::NAN), Condition::slip_is(f64::NAN)];
        }
        let open_conditions = [Condition::pressure_is(0.0), Condition::shear_is(0.0)];
        let [normal_compliance, shear_compliance] = compliance;
        let ContactState { slip, shear, .. } = start.state;
        let closed_condition =
            Condition { pressure: normal_compliance, ..Condition::gap_is(self.gap_offset) };
        let stick_condition = Condition {
            shear: 0.0 - shear_compliance,
            ..Condition::slip_is(slip - shear_compliance * shear)
        };
        if self.bonded {
            return [closed_condition, stick_condition];
        }
        if mode == Mode::Open || self.gap_offset == f64::NEG_INFINITY {
            return open_conditions;
        }
        let is_yielding = mode.is_yield() && self.pressure_cap.is_finite();
        let normal_condition =
            if is_yielding { self.yield_condition(normal_compliance) } else { closed_condition };
        let tangential_condition = match mode.elastic() {
            Mode::SlipRight => self.slip_condition(1.0),
            Mode::SlipLeft => self.slip_condition(-1.0),
            _ => stick_condition,
        };
        [normal_condition, tangential_condition]
    }

    /// Condition p = cap + hardening · settlement of yielding soil.
    ///
    /// `normal_compliance`: of the elastic layer above the soil, m/Pa. The settlement of the soil excludes the
    /// compression of the layer.
    fn yield_condition(&self, normal_compliance: f64) -> Condition {
        let Self { pressure_cap, hardening, gap_offset, .. } = *self;
        Condition {
            gap: hardening,
            pressure: 1.0 + hardening * normal_compliance,
            value: pressure_cap + hardening * gap_offset,
            ..Condition::default()
        }
    }

    /// Condition τ = ±R of a sliding element.
    ///
    /// Its form remains finite for infinite friction.
    ///
    /// `direction`: 1 to the right, −1 to the left. For infinite friction the condition is p + attraction = 0 with any
    /// shear traction. Without this mode the incremental problem need not have a solution: an element that is about to
    /// open under shear could neither stick nor open.
    fn slip_condition(&self, direction: f64) -> Condition {
        let Self { friction, attraction, shear_strength, .. } = *self;
        // Above a coefficient of one, the condition is divided by the coefficient.
        if friction > 1.0 {
            let value = -attraction - shear_strength / friction;
            return Condition {
                pressure: 1.0,
                shear: -direction / friction,
                value,
                ..Condition::default()
            };
        }
        let value = friction * attraction + shear_strength;
        Condition { pressure: -friction, shear: direction, value, ..Condition::default() }
    }

    /// The mode to try next in the plane, after a `trial` in `mode`.
    ///
    /// `closing_mode`: mode of an element that closes. `compliance`: as for [`Limits::conditions`]. An element that
    /// slides opens at a tension above the attraction.
    pub(super) fn next_mode(
        &self,
        mode: Mode,
        closing_mode: Mode,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: Tolerance,
        compliance: [f64; 2],
    ) -> Mode {
        if self.bonded {
            return Mode::Stick;
        }
        if self.gap_offset == f64::NEG_INFINITY {
            return Mode::Open;
        }
        let [normal_compliance, shear_compliance] = compliance;
        let inelastic_gap = trial.gap - self.gap_offset + normal_compliance * trial.pressure;
        if mode == Mode::Open {
            return if inelastic_gap < -tolerance.length { closing_mode } else { Mode::Open };
        }
        let traction_tolerance = tolerance.traction;
        let friction_pressure = trial.pressure + self.attraction;
        let has_shear = self.friction > 0.0 || self.shear_strength > 0.0;
        let slip_increment =
            trial.slip - start.state.slip - shear_compliance * (trial.shear - start.state.shear);
        let slip_tolerance = tolerance.length + shear_compliance * traction_tolerance;
        let sliding_mode = |direction: f64| {
            if friction_pressure < -traction_tolerance
                || (has_shear && direction * trial.shear < -traction_tolerance)
            {
                Mode::Open
            } else if has_shear && direction * slip_increment < -slip_tolerance {
                Mode::Stick
            } else {
                mode.elastic()
            }
        };
        let shear_limit = self.friction * friction_pressure.max(0.0) + self.shear_strength;
        let elastic_mode = match mode.elastic() {
            Mode::SlipRight => sliding_mode(1.0),
            Mode::SlipLeft => sliding_mode(-1.0),
            _ if trial.pressure + self.tension < -traction_tolerance => Mode::Open,
            // The shear limit is NaN for infinite friction without pressure.
            _ if self.friction == f64::INFINITY => Mode::Stick,
            _ if trial.shear > shear_limit + traction_tolerance => Mode::SlipRight,
            _ if trial.shear < -shear_limit - traction_tolerance => Mode::SlipLeft,
            _ => Mode::Stick,
        };
        let is_yielding = if mode.is_yield() {
            self.pressure_cap.is_finite() && inelastic_gap <= tolerance.length
        } else {
            trial.pressure > self.pressure_cap + traction_tolerance
        };
        if is_yielding { elastic_mode.yielding() } else { elastic_mode }
    }
}
