//! Search for the modes of elements whose pressure is a curve over the settlement.

use super::ModeSearch;
use crate::contact::SearchMethod;
use crate::contact::linearisation::{Linearisation, TangentSolution, point_on_curve};
use crate::contact::problem::{ContactInput, ContactResponse};
use crate::contact::trial_line::{CurvePoint, LineMotion, TrialLine};
use crate::error::{LawError, StepError};
use crate::interface::{Mode, Tolerance};
use crate::linalg::dot;

impl ModeSearch {
    /// Finds modes with other tangents until the pressures are on the curves of their laws.
    pub(super) fn follow_curves(
        &mut self,
        input: &ContactInput<'_>,
        modes: &mut [Mode],
    ) -> Result<SearchMethod, StepError> {
        self.predict_settlements(input, modes)?;
        let mut last_method = SearchMethod::ActiveSet;
        let mut linearisation = Linearisation::new();
        loop {
            let mut bonds = std::mem::take(&mut self.bonds);
            let found = self.break_bonds(input, modes, &mut bonds);
            self.bonds = bonds;
            let Some(method) = found? else { return Err(self.failure(input, modes)) };
            last_method = last_method.max(method);
            // The active set itself ends on the curves.
            if method == SearchMethod::ActiveSet {
                return Ok(last_method);
            }
            self.move_tangents(input, modes, &mut linearisation)?;
            if linearisation.is_done()? {
                return Ok(last_method);
            }
        }
    }

    /// Linearises the laws of elements that yielded in the step before.
    ///
    /// Each at the settlement that its element alone would have under its present tractions.
    fn predict_settlements(
        &mut self,
        input: &ContactInput<'_>,
        modes: &[Mode],
    ) -> Result<(), LawError> {
        let size = self.solver.response.layout.len();
        let mut has_tractions = false;
        for (e, _) in modes.iter().enumerate().filter(|(_, mode)| mode.is_yield()) {
            let Ok(limits) = input.limits(e, 0.0) else { continue };
            let Some(line) = input.trial_lines.get(e) else { continue };
            if limits.hardening == 0.0 {
                continue;
            }
            if !has_tractions {
                self.set_present_tractions(input);
                has_tractions = true;
            }
            let row = &input.delassus[e * size..(e + 1) * size];
            let gap = input.free_jump[e] + dot(row, &self.solver.response.traction);
            let pressure = input.start.state(e).pressure;
            let compliance = self.compliance(input, e);
            let settlement = limits.gap_offset - gap - compliance.layer * pressure;
            let solution = TangentSolution {
                element: e,
                pressure,
                settlement,
                yields: true,
                stiffness: compliance.total.recip(),
                pressure_rounding: 0.0,
                settlement_rounding: 0.0,
            };
            let point = point_on_curve(input, &solution, limits)?;
            line.set(TrialLine::new(point, limits.gap_offset, solution.stiffness));
        }
        Ok(())
    }

    /// Sets the changes of traction to those at the start of the step.
    fn set_present_tractions(&mut self, input: &ContactInput<'_>) {
        let ContactResponse { layout, traction, .. } = &mut self.solver.response;
        for (i, traction) in traction.iter_mut().enumerate() {
            let [component, e] = layout.component_and_element(i);
            *traction = input.start.state(e).traction()[component] - input.static_traction[i];
        }
    }

    /// Moves the lines towards the last trial; returns how they have moved.
    ///
    /// A line stays where the trial is near enough to the curve of its law.
    pub(super) fn move_tangents(
        &mut self,
        input: &ContactInput<'_>,
        modes: &[Mode],
        linearisation: &mut Linearisation,
    ) -> Result<LineMotion, LawError> {
        linearisation.begin();
        let mut tolerance = None;
        let mut motion = LineMotion::None;
        for (e, mode) in modes.iter().enumerate() {
            let Some(cell) = input.trial_lines.get(e) else { continue };
            let mut line = cell.get();
            if !self.solver.yields_with_hardening(e, *mode) && line.settlement == 0.0 {
                continue;
            }
            let tolerance = *tolerance.get_or_insert_with(|| self.solver.tolerance(input));
            if line.slope == 0.0 && !read_gap_offset(input, e, &mut line)? {
                continue;
            }
            let solution = self.tangent_solution(input, e, *mode, line.gap_offset, tolerance);
            let next = linearisation.compare(input, &solution, line.settlement)?;
            if let Some(point) = next {
                let mut next_line = line.through(point, solution.stiffness);
                if !linearisation.is_whole() {
                    next_line = next_line.tangent();
                }
                cell.set(next_line);
                // Tangents turn with each point.
                let turns = next_line.slope != line.slope || next_line.slope == 0.0;
                let is_turned = turns || !mode.is_yield();
                motion =
                    motion.max(if is_turned { LineMotion::Turned } else { LineMotion::Shifted });
            }
        }
        Ok(motion)
    }

    /// Corrects the last trial until its pressures are on the curves, while lines only shift.
    ///
    /// Returns the last motion of the lines, which have shifted after the trial.
    pub(super) fn correct(
        &mut self,
        input: &ContactInput<'_>,
        modes: &[Mode],
        linearisation: &mut Linearisation,
    ) -> Result<LineMotion, LawError> {
        loop {
            self.trials += 1;
            self.solver.correct(input, modes);
            let motion = self.move_tangents(input, modes, linearisation)?;
            if motion != LineMotion::Shifted {
                return Ok(motion);
            }
        }
    }

    /// Solution of an element in a mode, with its line in place of the curve.
    ///
    /// `gap_offset`: gap of the closed element, m.
    fn tangent_solution(
        &self,
        input: &ContactInput<'_>,
        element: usize,
        mode: Mode,
        gap_offset: f64,
        tolerance: Tolerance,
    ) -> TangentSolution {
        let ElementCompliance { layer, total } = self.compliance(input, element);
        let state = &self.solver.response.states[element];
        let Tolerance { length, traction } = tolerance;
        TangentSolution {
            element,
            pressure: state.pressure,
            settlement: gap_offset - state.gap - layer * state.pressure,
            yields: mode.is_yield(),
            stiffness: total.recip(),
            pressure_rounding: traction,
            settlement_rounding: length + traction * total,
        }
    }

    /// Compliance of an element.
    fn compliance(&self, input: &ContactInput<'_>, element: usize) -> ElementCompliance {
        let layer = input.law(element).compliance(Mode::Stick, &input.start_of(element))[0];
        let size = self.solver.response.layout.len();
        ElementCompliance { layer, total: input.delassus.diagonal(size, element) + layer }
    }

    /// Sets the lines of elements that begin to yield in the next modes.
    ///
    /// The lines pass through the points of the curves at a settlement of zero.
    ///
    /// `modes`: of the last trial.
    pub(super) fn begin_lines(&self, input: &ContactInput<'_>, modes: &[Mode]) {
        for (e, line) in input.trial_lines.iter().enumerate() {
            let begins = self.next_modes[e].is_yield() && !modes[e].is_yield();
            if begins
                && line.get().settlement == 0.0
                && let Ok(limits) = input.limits(e, 0.0)
                && limits.hardening > 0.0
            {
                let point = CurvePoint::new(0.0, &limits);
                let stiffness = self.compliance(input, e).total.recip();
                line.set(TrialLine::new(point, limits.gap_offset, stiffness));
            }
        }
    }
}

/// Normal compliance of an element, m/Pa.
struct ElementCompliance {
    /// Of the layer of its law.
    layer: f64,
    /// Of the layer, the ground and the structure, with all other tractions fixed.
    total: f64,
}

/// Reads the gap of a closed element from its law.
///
/// Returns `false` if the law has no limits, or no curve.
fn read_gap_offset(
    input: &ContactInput<'_>,
    element: usize,
    line: &mut TrialLine,
) -> Result<bool, LawError> {
    match input.limits(element, line.settlement) {
        Ok(limits) if line.settlement > 0.0 || limits.hardening > 0.0 => {
            line.gap_offset = limits.gap_offset;
            Ok(true)
        }
        // A law of the plane may have conditions of its own, and no limits.
        Ok(_) => Ok(false),
        Err(_) if line.settlement == 0.0 => Ok(false),
        Err(error) => Err(error),
    }
}
