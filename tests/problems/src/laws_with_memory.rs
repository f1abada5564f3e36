//! Laws that remember something of each element.

use basemat::interface::{
    Condition, ContactState, Coulomb, InterfaceLaw, Limits, Mode, PlaneLaw, PreviousContact,
    Tolerance,
};

/// Friction that falls with the distance slid: residual + (first − residual) e^(−slid/distance).
/// The memory is that distance.
#[derive(Debug, Clone, Copy)]
pub struct SlipWeakening {
    pub first: f64,
    pub residual: f64,
    pub distance: f64,
}

impl SlipWeakening {
    pub fn friction(&self, slid: f64) -> f64 {
        self.residual + (self.first - self.residual) * (-slid / self.distance).exp()
    }

    fn now(&self, start: &PreviousContact) -> Coulomb {
        Coulomb::new(self.friction(start.state_variables[0])).unwrap()
    }
}

impl InterfaceLaw for SlipWeakening {
    fn limits(&self, start: &PreviousContact) -> basemat::Result<Limits> {
        self.now(start).limits(start)
    }

    fn modes(&self) -> &[Mode] {
        &[Mode::Stick, Mode::SlipLeft, Mode::SlipRight, Mode::Open]
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        self.now(start).conditions(mode, start)
    }

    fn next_mode(
        &self,
        mode: Mode,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        self.now(start).next_mode(mode, start, trial, tolerance)
    }

    fn state_variables(&self) -> usize {
        1
    }

    fn commit(&self, start: &PreviousContact, end: &ContactState, mode: Mode, memory: &mut [f64]) {
        assert_eq!(
            memory, start.state_variables,
            "a commit begins with the memory of the step's start"
        );
        if mode.is_slip() {
            memory[0] += (end.slip - start.state.slip).abs();
        }
    }
}

/// Glue that breaks once, by opening (and by sliding, unless it is ductile in shear): tensile strength,
/// and friction · strength of cohesion. The memory is the strength that is left, and the static
/// pressure.
#[derive(Debug, Clone, Copy)]
pub struct Adhesion {
    pub friction: f64,
    pub strength: f64,
    pub breaks_by_sliding: bool,
}

impl Adhesion {
    fn now(&self, start: &PreviousContact) -> Coulomb {
        let law = Coulomb::new(self.friction).unwrap();
        law.with_tensile_strength(start.state_variables[0]).unwrap()
    }

    /// Coulomb's law keeps no strength for what has once opened: here that is the memory's to say.
    fn seen<'a>(start: &PreviousContact<'a>) -> PreviousContact<'a> {
        let mut start = *start;
        start.has_opened = false;
        start
    }
}

impl InterfaceLaw for Adhesion {
    fn limits(&self, start: &PreviousContact) -> basemat::Result<Limits> {
        self.now(start).limits(&Self::seen(start))
    }

    fn modes(&self) -> &[Mode] {
        &[Mode::Stick, Mode::SlipLeft, Mode::SlipRight, Mode::Open]
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        self.now(start).conditions(mode, &Self::seen(start))
    }

    fn next_mode(
        &self,
        mode: Mode,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        self.now(start).next_mode(mode, &Self::seen(start), trial, tolerance)
    }

    fn state_variables(&self) -> usize {
        2
    }

    fn initial_state_variables(&self, start: &PreviousContact, memory: &mut [f64]) {
        let strength = if start.has_opened { 0.0 } else { self.strength };
        memory.copy_from_slice(&[strength, start.static_pressure]);
    }

    fn commit(&self, _: &PreviousContact, _: &ContactState, mode: Mode, memory: &mut [f64]) {
        if mode == Mode::Open || (self.breaks_by_sliding && mode.is_slip()) {
            memory[0] = 0.0;
        }
    }
}

/// Elastic pads, bonded to both sides, that soften with the largest pressure they have borne:
/// stiffness / (1 + pressure / softening). The memory is that pressure.
#[derive(Debug, Clone, Copy)]
pub struct SofteningPads {
    /// Across and along the base, Pa/m.
    pub stiffness: [f64; 2],
    pub softening: f64,
}

impl SofteningPads {
    pub fn compliance_after(&self, borne: f64) -> [f64; 2] {
        self.stiffness.map(|k| (1.0 + borne / self.softening) / k)
    }
}

impl PlaneLaw for SofteningPads {
    fn modes(&self) -> &[Mode] {
        &[Mode::Stick]
    }

    fn conditions(&self, _: Mode, start: &PreviousContact) -> [Condition; 2] {
        let [normal, shear] = self.compliance_after(start.state_variables[0]);
        [
            Condition { gap: 1.0 / normal, ..Condition::pressure_is(0.0) },
            Condition { slip: -1.0 / shear, ..Condition::shear_is(0.0) },
        ]
    }

    fn next_mode(&self, _: Mode, _: &PreviousContact, _: &ContactState, _: Tolerance) -> Mode {
        Mode::Stick
    }

    fn compliance(&self, _: Mode, start: &PreviousContact) -> [f64; 2] {
        self.compliance_after(start.state_variables[0])
    }

    fn state_variables(&self) -> usize {
        1
    }

    fn commit(&self, _: &PreviousContact, end: &ContactState, _: Mode, memory: &mut [f64]) {
        memory[0] = memory[0].max(end.pressure);
    }
}
