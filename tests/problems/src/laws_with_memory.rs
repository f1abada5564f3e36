//! Laws with state variables of each element.

use basemat::interface::{
    Condition, ContactState, Coulomb, InterfaceLaw, Limits, Mode, PlaneLaw, PreviousContact,
    Tolerance,
};

/// Friction that decreases with the sliding distance s: residual + (first − residual) e^(−s/distance).
///
/// The state variable is s.
#[derive(Debug, Clone, Copy)]
pub struct SlipWeakening {
    pub first: f64,
    pub residual: f64,
    pub distance: f64,
}

impl SlipWeakening {
    pub fn friction(&self, sliding_distance: f64) -> f64 {
        self.residual + (self.first - self.residual) * (-sliding_distance / self.distance).exp()
    }

    /// Coulomb's law with the present state variables.
    fn current_law(&self, start: &PreviousContact) -> Coulomb {
        Coulomb::new(self.friction(start.state_variables[0])).unwrap()
    }
}

impl InterfaceLaw for SlipWeakening {
    fn limits(&self, start: &PreviousContact) -> basemat::Result<Limits> {
        self.current_law(start).limits(start)
    }

    fn modes(&self) -> &[Mode] {
        &[Mode::Stick, Mode::SlipLeft, Mode::SlipRight, Mode::Open]
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        self.current_law(start).conditions(mode, start)
    }

    fn next_mode(
        &self,
        mode: Mode,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        self.current_law(start).next_mode(mode, start, trial, tolerance)
    }

    fn state_variables(&self) -> usize {
        1
    }

    fn commit(
        &self,
        start: &PreviousContact,
        end: &ContactState,
        mode: Mode,
        variables: &mut [f64],
    ) {
        assert_eq!(
            variables, start.state_variables,
            "a commit begins with the state variables at the step's start"
        );
        if mode.is_slip() {
            variables[0] += (end.slip - start.state.slip).abs();
        }
    }
}

/// A bond that breaks for good by opening, and by sliding unless it is ductile in shear.
///
/// It has a tensile strength, and friction · strength of cohesion. State variables are the remaining strength and the
/// static pressure.
#[derive(Debug, Clone, Copy)]
pub struct BreakingBond {
    pub friction: f64,
    pub strength: f64,
    pub breaks_by_sliding: bool,
}

impl BreakingBond {
    /// Coulomb's law with the present state variables.
    fn current_law(&self, start: &PreviousContact) -> Coulomb {
        let law = Coulomb::new(self.friction).unwrap();
        law.with_tensile_strength(start.state_variables[0]).unwrap()
    }

    /// The contact as one that has never opened, since Coulomb's law has no strength after an opening.
    fn without_opening<'a>(start: &PreviousContact<'a>) -> PreviousContact<'a> {
        let mut start = *start;
        start.has_opened = false;
        start
    }
}

impl InterfaceLaw for BreakingBond {
    fn limits(&self, start: &PreviousContact) -> basemat::Result<Limits> {
        self.current_law(start).limits(&Self::without_opening(start))
    }

    fn modes(&self) -> &[Mode] {
        &[Mode::Stick, Mode::SlipLeft, Mode::SlipRight, Mode::Open]
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact) -> [Condition; 2] {
        self.current_law(start).conditions(mode, &Self::without_opening(start))
    }

    fn next_mode(
        &self,
        mode: Mode,
        start: &PreviousContact,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        self.current_law(start)
            .next_mode(mode, &Self::without_opening(start), trial, tolerance)
    }

    fn state_variables(&self) -> usize {
        2
    }

    fn initial_state_variables(&self, start: &PreviousContact, variables: &mut [f64]) {
        let strength = if start.has_opened { 0.0 } else { self.strength };
        variables.copy_from_slice(&[strength, start.static_pressure]);
    }

    fn commit(&self, _: &PreviousContact, _: &ContactState, mode: Mode, variables: &mut [f64]) {
        if mode == Mode::Open || (self.breaks_by_sliding && mode.is_slip()) {
            variables[0] = 0.0;
        }
    }
}

/// Elastic pads, bonded to both sides, that soften with the largest pressure they have carried.
///
/// The stiffness is divided by 1 + pressure/softening. The state variable is that pressure.
#[derive(Debug, Clone, Copy)]
pub struct SofteningPads {
    /// Normal and tangential stiffness, Pa/m.
    pub stiffness: [f64; 2],
    pub softening: f64,
}

impl SofteningPads {
    pub fn compliance_after(&self, max_pressure: f64) -> [f64; 2] {
        self.stiffness.map(|k| (1.0 + max_pressure / self.softening) / k)
    }
}

impl PlaneLaw for SofteningPads {
    fn modes(&self) -> &[Mode] {
        &[Mode::Stick]
    }

    fn conditions(&self, _: Mode, start: &PreviousContact) -> [Condition; 2] {
        let compliance = self.compliance_after(start.state_variables[0]);
        [
            Condition { gap: 1.0 / compliance[0], ..Condition::pressure_is(0.0) },
            Condition { slip: -1.0 / compliance[1], ..Condition::shear_is(0.0) },
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

    fn commit(&self, _: &PreviousContact, end: &ContactState, _: Mode, variables: &mut [f64]) {
        variables[0] = variables[0].max(end.pressure);
    }
}
