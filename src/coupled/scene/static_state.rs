//! A static state: what weight and loads at t = 0 leave, contact conditions included.

use crate::interface::{ContactState, InterfaceLaw, Mode, StepStarts, law_of};
use crate::structure::InternalEnergy;

/// Static tractions, gaps, displacements and modes.
#[derive(Debug, Clone)]
pub(crate) struct StaticState {
    pub(crate) traction: Vec<f64>,
    /// Gaps: of uplifted elements, and (negative) of compressed layers; hard contact has zero.
    pub(crate) gap: Vec<f64>,
    pub(crate) displacement: Vec<f64>,
    pub(crate) modes: Vec<Mode>,
    /// The structure's own load at t = 0.
    pub(crate) load: Vec<f64>,
    /// Memory of each element's law where that acted in it; empty where the law begins anew.
    pub(crate) memory: Vec<Vec<f64>>,
    /// f(u) of a nonlinear structure, and its energies where it knows them.
    pub(crate) force: Vec<f64>,
    pub(crate) energy: Option<InternalEnergy>,
}

impl StaticState {
    /// No weight: everything touches, nothing presses.
    pub(crate) fn weightless(elements: usize, unknowns: usize) -> Self {
        Self {
            traction: vec![0.0; 2 * elements],
            gap: vec![0.0; elements],
            displacement: vec![0.0; unknowns],
            modes: vec![Mode::Stick; elements],
            load: vec![0.0; unknowns],
            memory: Vec::new(),
            force: Vec::new(),
            energy: None,
        }
    }

    /// Gaps from the states of the contact solver, exactly where a law pins them.
    pub(super) fn close_gaps(
        &mut self,
        laws: &[Box<dyn InterfaceLaw>],
        start: &StepStarts,
        states: &[ContactState],
    ) {
        for (e, gap) in self.gap.iter_mut().enumerate() {
            let conditions = law_of(laws, e).conditions(self.modes[e], &start.of(e));
            let pinned = conditions.iter().find_map(|c| c.gap_at(self.traction[e]));
            *gap = pinned.unwrap_or(states[e].gap);
        }
    }
}
