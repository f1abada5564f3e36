//! Strength of an interface law under static loads, by its modes or by its limits.

use crate::interface::{
    ContactState, InterfaceLaw, LawForm, Limits, Mode, PreviousContact, Tolerance,
};

/// Traction that counts as zero, relative to the pressure.
const ZERO_TRACTION_FRACTION: f64 = 1e-6;
/// Ratio of shear traction to pressure that counts as infinite.
const INFINITE_FRICTION_RATIO: f64 = 1e6;
/// Pressure at which cohesion is negligible, Pa.
const NEGLIGIBLE_COHESION_PRESSURE: f64 = 1e9;
/// Settlement that no foundation reaches, at which hardening soil has its whole strength, m.
const UNLIMITED_SETTLEMENT: f64 = 1e12;

/// Strength of a law on an element that has not moved so far.
pub(crate) struct Strength {
    /// Whether the element can open.
    pub(crate) opens: bool,
    /// Whether a bond bears tension.
    pub(crate) pulls: bool,
    /// Whether a bond bears shear without pressure.
    pub(crate) coheres: bool,
    /// Friction coefficient, or the ratio of shear traction to pressure at which the element slides.
    ///
    /// Infinite if it does not slide.
    pub(crate) friction: f64,
    /// Largest pressure, Pa; infinite for a law without a limit.
    pub(crate) bearing_pressure: f64,
}

impl Strength {
    /// Strength of an element under this mean pressure (Pa).
    ///
    /// `frictionless` omits friction and cohesion from limits.
    pub(crate) fn at_pressure(
        law: &dyn InterfaceLaw,
        pressure: f64,
        form: LawForm,
        frictionless: bool,
    ) -> Self {
        match form {
            LawForm::Modes => Self::by_modes(law, pressure),
            LawForm::Limits => Self::by_limits(law, pressure, frictionless),
        }
    }

    fn by_modes(law: &dyn InterfaceLaw, pressure: f64) -> Self {
        let traction = ZERO_TRACTION_FRACTION * pressure.abs().max(1.0);
        Self {
            opens: law.modes().contains(&Mode::Open),
            pulls: sticks_at(law, ContactState { pressure: -traction, ..ContactState::default() }),
            coheres: sticks_at(law, ContactState { shear: traction, ..ContactState::default() }),
            friction: friction(law, pressure),
            bearing_pressure: bearing_pressure(law),
        }
    }

    fn by_limits(law: &dyn InterfaceLaw, pressure: f64, frictionless: bool) -> Self {
        let limits = limits_at_rest(law, pressure.max(0.0));
        let limits = if frictionless { limits.frictionless() } else { limits };
        let friction_coefficient = law.friction_coefficient().filter(|_| !frictionless);
        let attraction_friction = if limits.attraction > 0.0 { limits.friction } else { 0.0 };
        let cohesion = limits.shear_strength + attraction_friction * limits.attraction;
        let ratio = limits.friction + cohesion / pressure.max(f64::MIN_POSITIVE);
        let friction = friction_coefficient.unwrap_or(ratio);
        Self {
            opens: !limits.bonded,
            pulls: !limits.bonded && limits.tension > 0.0,
            coheres: !limits.bonded && cohesion > 0.0,
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
/// As the law states it; else by its limits, or by the tractions at which the element slides.
pub(crate) fn friction_at_rest(law: &dyn InterfaceLaw, form: LawForm) -> f64 {
    match form {
        LawForm::Modes => friction(law, NEGLIGIBLE_COHESION_PRESSURE),
        LawForm::Limits => law.friction_coefficient().unwrap_or_else(|| {
            let limits = limits_at_rest(law, NEGLIGIBLE_COHESION_PRESSURE);
            if limits.bonded { 0.0 } else { limits.friction }
        }),
    }
}

/// Smallest strength of a bond of a law on an element at rest under this mean pressure (Pa); `None` without bonds.
///
/// Of tensile and shear strength, Pa. Laws that state no limits have none.
pub(crate) fn bond_at_rest(law: &dyn InterfaceLaw, pressure: f64) -> Option<f64> {
    let limits = limits_at_rest(law, pressure.max(0.0));
    let strengths = [limits.tension, limits.shear_strength];
    strengths.into_iter().filter(|strength| *strength > 0.0).reduce(f64::min)
}

/// Elastic opening and slip per traction of a law on an element that has not moved so far, m/Pa.
pub(crate) fn compliance_at_rest(law: &dyn InterfaceLaw) -> [f64; 2] {
    let start = PreviousContact::new(ContactState::default(), Mode::Stick, 1.0);
    let state_variables = start.first_state_variables(law);
    let compliance = law.compliance(Mode::Stick, &start.with_state_variables(&state_variables));
    compliance.map(|value| if value.is_finite() { value.max(0.0) } else { 0.0 })
}

/// Limits of a law on an element that has not moved so far.
///
/// Default limits for a law without any, which the build has reported before.
fn limits_at_rest(law: &dyn InterfaceLaw, pressure: f64) -> Limits {
    let pressed = ContactState { pressure, ..ContactState::default() };
    let start = PreviousContact::new(pressed, Mode::Stick, 1.0);
    let state_variables = start.first_state_variables(law);
    law.limits(&start.with_state_variables(&state_variables)).unwrap_or_default()
}

/// The friction coefficient of a law, or the ratio of tractions at which an element under this pressure slides.
///
/// Infinite if it does not slide.
fn friction(law: &dyn InterfaceLaw, pressure: f64) -> f64 {
    if let Some(coefficient) = law.friction_coefficient() {
        return coefficient;
    }
    let sticks = |ratio: f64| {
        sticks_at(
            law,
            ContactState { pressure, shear: ratio * pressure, ..ContactState::default() },
        )
    };
    if law.modes().len() == 1 || sticks(INFINITE_FRICTION_RATIO) {
        return f64::INFINITY;
    }
    let mut low = 0.0;
    let mut high = INFINITE_FRICTION_RATIO;
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if sticks(middle) { low = middle } else { high = middle }
    }
    high
}

/// Whether a law holds an element that has not moved so far at these tractions, without sliding or opening.
fn sticks_at(law: &dyn InterfaceLaw, trial: ContactState) -> bool {
    let pressed = ContactState { pressure: trial.pressure.max(0.0), ..ContactState::default() };
    let start = PreviousContact::new(pressed, Mode::Stick, 1.0);
    let state_variables = start.first_state_variables(law);
    let start = start.with_state_variables(&state_variables);
    let tolerance = Tolerance::new(0.0, 0.0);
    // A bonded base has no other mode.
    law.modes().len() > 1 && law.next_mode(Mode::Stick, &start, &trial, tolerance) == Mode::Stick
}

/// The largest pressure of a law; infinite if it has no mode of yielding.
fn bearing_pressure(law: &dyn InterfaceLaw) -> f64 {
    let start = PreviousContact::new(ContactState::default(), Mode::Stick, 1.0);
    let yielding = law.modes().iter().filter(|mode| mode.is_yield());
    let conditions = yielding.flat_map(|&mode| law.conditions(mode, &start));
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
    let mut start = PreviousContact::new(ContactState::default(), Mode::Stick, 1.0);
    start.trial_settlement = UNLIMITED_SETTLEMENT;
    let state_variables = start.first_state_variables(law);
    law.limits(&start.with_state_variables(&state_variables))
        .map_or(f64::INFINITY, |limits| {
            limits.pressure_cap + limits.hardening * UNLIMITED_SETTLEMENT
        })
}
