//! Search for the modes of elements whose pressure is a curve over the settlement.

use super::ModeSearch;
use crate::contact::SearchMethod;
use crate::contact::linearisation::{Linearisation, TangentSolution};
use crate::contact::problem::ContactInput;
use crate::error::{LawError, StepError};
use crate::interface::{Mode, Tolerance};

impl ModeSearch {
    /// Finds modes with other tangents until the pressures are on the curves of their laws.
    pub(super) fn follow_curves(
        &mut self,
        input: &ContactInput<'_>,
        modes: &mut [Mode],
        trial_settlements: &mut [f64],
    ) -> Result<SearchMethod, StepError> {
        let mut last_method = SearchMethod::ActiveSet;
        let mut linearisation = Linearisation::new();
        loop {
            let linearised = ContactInput { trial_settlements, ..*input };
            let mut bonds = std::mem::take(&mut self.bonds);
            let found = self.break_bonds(&linearised, modes, &mut bonds);
            self.bonds = bonds;
            let Some(method) = found? else { return Err(self.failure(&linearised, modes)) };
            last_method = last_method.max(method);
            linearisation.begin();
            for (e, mode) in modes.iter().enumerate() {
                let hardens = self.solver.hardens(e, *mode);
                if hardens || trial_settlements[e] > 0.0 {
                    let solution = self.tangent_solution(input, e, *mode, trial_settlements[e])?;
                    if let Some(solution) = solution {
                        linearisation.compare(input, &solution, &mut trial_settlements[e])?;
                    }
                }
            }
            if linearisation.is_done()? {
                return Ok(last_method);
            }
        }
    }

    /// Solution of an element in a mode with the tangent at a trial settlement (m).
    ///
    /// `None` if the limits of the law do not harden there.
    fn tangent_solution(
        &self,
        input: &ContactInput<'_>,
        element: usize,
        mode: Mode,
        trial_settlement: f64,
    ) -> Result<Option<TangentSolution>, LawError> {
        // A law of the plane may have conditions of its own, and no limits.
        let start = input.start.element(element);
        if trial_settlement == 0.0 && input.law(element).limits(&start).is_err() {
            return Ok(None);
        }
        let limits = input.limits(element, trial_settlement)?;
        if trial_settlement == 0.0 && limits.hardening == 0.0 {
            return Ok(None);
        }
        let layer = input.law(element).compliance(Mode::Stick, &start)[0];
        let size = self.solver.response.layout.len();
        let compliance = input.delassus.diagonal(size, element) + layer;
        let state = &self.solver.response.states[element];
        let Tolerance { length, traction } = self.solver.tolerance(input);
        Ok(Some(TangentSolution {
            element,
            pressure: state.pressure,
            settlement: limits.gap_offset - state.gap - layer * state.pressure,
            yields: mode.is_yield(),
            stiffness: compliance.recip(),
            pressure_rounding: traction,
            settlement_rounding: length + traction * compliance,
        }))
    }
}
