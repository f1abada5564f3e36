//! Strength of an interface law under static loads, from its modes or its limits.

use crate::interface::{
    ContactState, InterfaceLaw, LawForm, Limits, Mode, PreviousContact, Tolerance,
};

/// Small trial traction for tension and cohesion, relative to the pressure.
const TRIAL_TRACTION_FRACTION: f64 = 1e-6;
/// Ratio of shear traction to pressure that counts as an infinite friction coefficient.
const INFINITE_FRICTION_RATIO: f64 = 1e6;
/// Number of bisections of a friction coefficient: enough for all digits of double precision.
const FRICTION_BISECTION_COUNT: usize = 100;
/// Time step of the trial contact, s; static strengths do not depend on it.
const TRIAL_TIME_STEP: f64 = 1.0;
/// Pressure at which cohesion is negligible, Pa: far above the strength of soils.
const NEGLIGIBLE_COHESION_PRESSURE: f64 = 1e9;
/// Settlement that no foundation reaches, at which hardening soil has its whole strength, m.
const UNLIMITED_SETTLEMENT: f64 = 1e12;

/// Strength of a law on an element that has not moved.
pub(crate) struct InterfaceStrength {
    /// Whether the element can open.
    pub(crate) can_open: bool,
    /// Whether a bond resists tension.
    pub(crate) resists_tension: bool,
    /// Whether a bond resists shear without pressure.
    pub(crate) has_cohesion: bool,
    /// Friction coefficient, or ratio of shear traction to pressure at which the element slides.
    ///
    /// It is infinite for an element that does not slide.
    pub(crate) friction: f64,
    /// Largest pressure, Pa; infinite for a law without a limit.
    pub(crate) bearing_pressure: f64,
}

impl InterfaceStrength {
    /// Strength of an element under this mean pressure (Pa).
    ///
    /// `is_frictionless` omits friction and cohesion from limits.
    pub(crate) fn at_pressure(
        law: &dyn InterfaceLaw,
        pressure: f64,
        form: LawForm,
        is_frictionless: bool,
    ) -> Self {
        match form {
            LawForm::Modes => Self::from_modes(law, pressure),
            LawForm::Limits => Self::from_limits(law, pressure, is_frictionless),
        }
    }

    fn from_modes(law: &dyn InterfaceLaw, pressure: f64) -> Self {
        let trial_traction = TRIAL_TRACTION_FRACTION * pressure.abs().max(1.0);
        Self {
            can_open: law.modes().contains(&Mode::Open),
            resists_tension: sticks_at(
                law,
                ContactState { pressure: -trial_traction, ..ContactState::default() },
            ),
            has_cohesion: sticks_at(
                law,
                ContactState { shear: trial_traction, ..ContactState::default() },
            ),
            friction: sliding_ratio(law, pressure),
            bearing_pressure: bearing_pressure(law),
        }
    }

    fn from_limits(law: &dyn InterfaceLaw, pressure: f64, is_frictionless: bool) -> Self {
        let limits = limits_at_rest(law, pressure.max(0.0));
        let limits = if is_frictionless { limits.frictionless() } else { limits };
        let friction_coefficient = law.friction_coefficient().filter(|_| !is_frictionless);
        let attraction_friction = if limits.attraction > 0.0 { limits.friction } else { 0.0 };
        let cohesion = limits.shear_strength + attraction_friction * limits.attraction;
        let sliding_ratio = limits.friction + cohesion / pressure.max(f64::MIN_POSITIVE);
        let friction = friction_coefficient.unwrap_or(sliding_ratio);
        Self {
            can_open: !limits.bonded,
            resists_tension: !limits.bonded && limits.tension > 0.0,
            has_cohesion: !limits.bonded && cohesion > 0.0,
            friction: if limits.bonded { f64::INFINITY } else { friction },
            bearing_pressure: if limits.hardening > 0.0 {
                hardened_pressure(law)
            } else {
                limits.pressure_cap
            },
        }
    }
}

/// Friction coefficient of a law on an element at rest, without cohesion.
///
/// It is the coefficient that the law states. Otherwise it follows from the law's limits, or from the tractions at which
/// the element slides.
pub(crate) fn friction_at_rest(law: &dyn InterfaceLaw, form: LawForm) -> f64 {
    match form {
        LawForm::Modes => sliding_ratio(law, NEGLIGIBLE_COHESION_PRESSURE),
        LawForm::Limits => law.friction_coefficient().unwrap_or_else(|| {
            let limits = limits_at_rest(law, NEGLIGIBLE_COHESION_PRESSURE);
            if limits.bonded { 0.0 } else { limits.friction }
        }),
    }
}

/// Smaller of a bond's tensile and shear strength at rest, Pa; `None` without bonds.
///
/// `pressure` is the mean pressure, Pa. A law without limits has no bond strength.
pub(crate) fn bond_at_rest(law: &dyn InterfaceLaw, pressure: f64) -> Option<f64> {
    let limits = limits_at_rest(law, pressure.max(0.0));
    let strengths = [limits.tension, limits.shear_strength];
    strengths.into_iter().filter(|strength| *strength > 0.0).reduce(f64::min)
}

/// Normal and shear compliance of a law on an element that has not moved, m/Pa.
pub(crate) fn compliance_at_rest(law: &dyn InterfaceLaw) -> [f64; 2] {
    let start = PreviousContact::new(ContactState::default(), Mode::Stick, TRIAL_TIME_STEP);
    let state_variables = start.first_state_variables(law);
    let compliance = law.compliance(Mode::Stick, &start.with_state_variables(&state_variables));
    compliance.map(|value| if value.is_finite() { value.max(0.0) } else { 0.0 })
}

/// Limits of a law on an element that has not moved.
///
/// A law without limits has the default limits. Where such a law is an error, the build has already returned it.
fn limits_at_rest(law: &dyn InterfaceLaw, pressure: f64) -> Limits {
    let under_pressure = ContactState { pressure, ..ContactState::default() };
    let start = PreviousContact::new(under_pressure, Mode::Stick, TRIAL_TIME_STEP);
    let state_variables = start.first_state_variables(law);
    law.limits(&start.with_state_variables(&state_variables)).unwrap_or_default()
}

/// Friction coefficient of a law.
///
/// If the law has none, it is the ratio of shear traction to pressure at which an element slides. It is infinite for an
/// element that does not slide. `pressure` is in Pa.
fn sliding_ratio(law: &dyn InterfaceLaw, pressure: f64) -> f64 {
    if let Some(coefficient) = law.friction_coefficient() {
        return coefficient;
    }
    let sticks_at_ratio = |ratio: f64| {
        sticks_at(
            law,
            ContactState { pressure, shear: ratio * pressure, ..ContactState::default() },
        )
    };
    if law.modes().len() == 1 || sticks_at_ratio(INFINITE_FRICTION_RATIO) {
        return f64::INFINITY;
    }
    let mut low = 0.0;
    let mut high = INFINITE_FRICTION_RATIO;
    for _ in 0..FRICTION_BISECTION_COUNT {
        let middle = 0.5 * (low + high);
        if sticks_at_ratio(middle) { low = middle } else { high = middle }
    }
    high
}

/// Whether an element that has not moved sticks under the tractions of `trial`.
fn sticks_at(law: &dyn InterfaceLaw, trial: ContactState) -> bool {
    let under_pressure =
        ContactState { pressure: trial.pressure.max(0.0), ..ContactState::default() };
    let start = PreviousContact::new(under_pressure, Mode::Stick, TRIAL_TIME_STEP);
    let state_variables = start.first_state_variables(law);
    let start = start.with_state_variables(&state_variables);
    let tolerance = Tolerance::new(0.0, 0.0);
    // A bonded base has no other mode.
    law.modes().len() > 1 && law.next_mode(Mode::Stick, &start, &trial, tolerance) == Mode::Stick
}

/// Bearing pressure of a law, Pa; infinite if it has no mode of yielding.
fn bearing_pressure(law: &dyn InterfaceLaw) -> f64 {
    let start = PreviousContact::new(ContactState::default(), Mode::Stick, TRIAL_TIME_STEP);
    let yield_modes = law.modes().iter().filter(|mode| mode.is_yield());
    let conditions = yield_modes.flat_map(|&mode| law.conditions(mode, &start));
    let mut max_pressure = None::<f64>;
    for condition in conditions {
        let pressure = if condition.gap == 0.0 {
            condition.pressure_alone()
        } else {
            Some(hardened_pressure(law))
        };
        max_pressure = max_pressure.into_iter().chain(pressure).reduce(f64::max);
    }
    max_pressure.unwrap_or(f64::INFINITY)
}

/// Pressure of a law after a settlement without limit, Pa; infinite for a law without limits.
fn hardened_pressure(law: &dyn InterfaceLaw) -> f64 {
    let mut start = PreviousContact::new(ContactState::default(), Mode::Stick, TRIAL_TIME_STEP);
    start.trial_settlement = UNLIMITED_SETTLEMENT;
    let state_variables = start.first_state_variables(law);
    law.limits(&start.with_state_variables(&state_variables))
        .map_or(f64::INFINITY, |limits| {
            limits.pressure_cap + limits.hardening * UNLIMITED_SETTLEMENT
        })
}
