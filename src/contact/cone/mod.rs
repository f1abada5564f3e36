//! Contact with uplift and friction in space.
//!
//! Signorini's law holds for the gap, and Coulomb's law for the shear, which lies on a disc.
//!
//! A step tries these methods one after the other:
//!
//! 1. The statuses of the previous step, if no element slid in it. Their factors are reused as long as the statuses
//!    stay the same. Many elements on a lattice skip this method, unless all stick and each moves many others.
//! 2. Sweeps over the elements, from the forces of the previous step. Many elements use accelerated sweeps if each
//!    moves most others.
//! 3. Newton's method, then sweeps and Newton's method in turn.
//! 4. Newton's method with trials for elements that move together, if a pressure is bounded; then from other forces, with
//!    partial steps.
//! 5. The proximal point method, which solves a sequence of better conditioned problems by methods 2 to 4.
//!
//! For friction above 100, or infinite, the step first tries Newton's method alone. Then it uses all methods with a lower
//! friction, and raises the friction from that solution. If the friction cannot be raised, the step uses the lower
//! friction, and the run warns of it.
//!
//! W is symmetric and positive definite, so a solution exists (Acary, Cadoux, Lemaréchal & Malick 2011); with
//! small friction it is unique. The shear of a sliding element lies on the boundary of its disc and opposes the slip of
//! the same solution: its friction work is never negative.
//!
//! A bond bears tension, and shear without pressure, up to its strength. The bond breaks in the step in which the element
//! opens at that strength. The step is then solved again: at most once for each element.

mod acceleration;
mod bounds;
mod collective;
mod compliance;
mod curves;
mod group;
mod lattice;
mod low_rank;
mod low_rank_system;
mod near_field;
mod near_field_sweeps;
mod newton;
mod problem;
mod proximal;
mod read;
mod search;
mod status;
mod sweeps;
mod system;
#[cfg(test)]
mod tests;
mod unknowns;

use super::SearchMethod;
use super::problem::{ContactInput, ContactResponse};
use crate::error::StepError;
use crate::geometry::{COMPONENTS_IN_SPACE, ContactLayout};
use crate::interface::Mode;
use compliance::ComplianceForm;
use newton::Newton;
use problem::{ConeProblem, RELATIVE_RESIDUAL_TOLERANCE};
use proximal::Proximal;
use search::find_forces;
use status::{Normal, Status, Tangential};

/// Residual at which the tangents of curves first move, relative to the largest force.
///
/// More exact forces gain nothing: tangents and forces then converge together.
const TANGENT_TOLERANCE: f64 = 1e-2;
/// Gap at which a bond breaks, relative to the largest displacement: above its rounding.
const BOND_BREAKING_GAP: f64 = 1e-12;

/// Search for the contact forces of a step in space.
pub(crate) struct ForceSearch {
    /// Tractions, jumps and states of the last solution.
    pub(super) response: ContactResponse,
    problem: ConeProblem,
    newton: Newton,
    proximal: Proximal,
    areas: Vec<f64>,
    /// Compliance of each element's layer, included in W.
    layers: Vec<[f64; 2]>,
    /// Whether the problem's W is that of the step, with the same layers.
    has_valid_operator: bool,
    /// Whether the bond of each element has broken in this step.
    has_broken_bond: Vec<bool>,
    /// Whether an element's largest pressure grows with its settlement in this step.
    hardens: bool,
    /// Settlements at which the laws are linearised, m; without meaning if nothing hardens.
    trial_settlements: Vec<f64>,
    /// Changes of force with which a search begins, N.
    initial_change: Vec<f64>,
    /// Changes of force that solve with less friction, or with the first tangents of a step, N.
    limited_change: Vec<f64>,
    /// Whether the structure is linear: all steps then have the same W, unless layers change.
    is_linear: bool,
}

impl ForceSearch {
    /// Search for elements with these areas, m²; `is_linear`: whether the structure is linear.
    pub(super) fn new(areas: &[f64], is_linear: bool) -> Self {
        let count = areas.len();
        Self {
            response: ContactResponse::new(ContactLayout::new(COMPONENTS_IN_SPACE, count)),
            problem: ConeProblem::on_bed(count),
            newton: Newton::on_bed(count),
            proximal: Proximal::new(count),
            areas: areas.to_vec(),
            layers: vec![[0.0; 2]; count],
            has_valid_operator: false,
            has_broken_bond: vec![false; count],
            hardens: false,
            trial_settlements: vec![0.0; count],
            initial_change: vec![0.0; 3 * count],
            limited_change: vec![0.0; 3 * count],
            is_linear,
        }
    }

    /// Discards W; call this when it has changed.
    pub(super) fn invalidate(&mut self) {
        self.has_valid_operator = false;
    }

    /// Finds `modes`, starting from their present values; the response is then the solution.
    ///
    /// Returns the number of iterations and the last method used.
    pub(super) fn solve(
        &mut self,
        input: &ContactInput<'_>,
        modes: &mut [Mode],
    ) -> Result<(usize, SearchMethod), StepError> {
        self.read_step(input)?;
        self.newton.begin_step(self.hardens);
        let mut method = SearchMethod::ActiveSet;
        for mode in modes.iter_mut() {
            *mode = mode.in_any_direction();
        }
        // The tangents of curves change before the solution is exact.
        self.problem.relative_tolerance =
            if self.hardens { TANGENT_TOLERANCE } else { RELATIVE_RESIDUAL_TOLERANCE };
        let has_tried = self.try_previous_statuses(modes);
        let mut trials = usize::from(has_tried);
        if !(has_tried && self.problem.is_solved()) {
            self.set_initial_forces(input);
            method = self.search_forces(input, &mut trials)?;
            self.write_modes(modes);
        }
        if self.hardens {
            method = method.max(self.follow_curves(input, method, modes, &mut trials)?);
        }
        self.update_traction(input)?;
        self.update_jump(input);
        self.response.update_states(input);
        Ok((trials, method))
    }

    /// Finds forces from the present ones, and breaks overloaded bonds; returns the last method used.
    fn search_forces(
        &mut self,
        input: &ContactInput<'_>,
        trials: &mut usize,
    ) -> Result<SearchMethod, StepError> {
        let mut method = SearchMethod::ActiveSet;
        loop {
            let is_constant = self.has_constant_operator(input);
            let Self { problem, newton, proximal, initial_change, limited_change, .. } = self;
            let outcome =
                find_forces(problem, newton, proximal, initial_change, limited_change, is_constant);
            *trials += outcome.iterations;
            let Some(last_method) = outcome.method else {
                return Err(self.failure(*trials));
            };
            method = method.max(last_method);
            self.newton.classify(&self.problem, false);
            // Forces that are not exact break no bond.
            let is_exact = self.problem.relative_tolerance <= RELATIVE_RESIDUAL_TOLERANCE;
            if !(is_exact && self.break_bonds(BOND_BREAKING_GAP * input.length_scale)) {
                return Ok(method);
            }
        }
    }

    /// Computes the changes of traction for the present forces.
    fn update_traction(&mut self, input: &ContactInput<'_>) -> Result<(), StepError> {
        let Self { response, problem, areas, .. } = self;
        let layout = response.layout;
        for (i, traction) in response.traction.iter_mut().enumerate() {
            // The total traction of an element without force is exactly zero.
            *traction = match problem.force(i) {
                0.0 => -input.static_traction[i],
                _ => problem.force_change[i] / areas[layout.component_and_element(i)[1]],
            };
        }
        StepError::check_finite("contact traction", &response.traction)
    }

    /// Computes the jump for the present tractions.
    ///
    /// It uses the form of W where that takes less time than all entries.
    ///
    /// The forces are then rounded as in the next step, which begins with the same product.
    fn update_jump(&mut self, input: &ContactInput<'_>) {
        let Self { response, problem, areas, layers, .. } = self;
        let ContactResponse { traction, jump, .. } = response;
        jump.copy_from_slice(input.free_jump);
        if matches!(problem.form, ComplianceForm::Entries) {
            return input.delassus.multiply_add(traction, jump);
        }
        for (e, area) in areas.iter().enumerate() {
            for i in problem.component_indices(e) {
                problem.set_force(i, area * (input.static_traction[i] + traction[i]));
            }
        }
        problem.update_displacements();
        for (e, layer) in layers.iter().enumerate() {
            for (component, i) in problem.component_indices(e).into_iter().enumerate() {
                // The jump does not contain the layer.
                let layer_change = layer[component.min(1)] / areas[e] * problem.force_change[i];
                jump[i] += problem.y[i] - problem.q[i] - layer_change;
            }
        }
    }

    /// Solves for the statuses of the previous step.
    ///
    /// `false` if an element slid, the system is singular, or sweeps take less time.
    fn try_previous_statuses(&mut self, modes: &[Mode]) -> bool {
        let Self { newton, problem, .. } = self;
        let near_field = problem.form.near_field();
        let has_near_field = near_field.is_some();
        if near_field.is_some_and(|near_field| !near_field.prefers_factors()) {
            return false;
        }
        for ((status, mode), bounds) in newton.statuses.iter_mut().zip(modes).zip(&problem.bounds) {
            let is_frictionless = bounds.friction == 0.0 && !bounds.has_bond();
            *status = match mode {
                Mode::Open if !bounds.is_bonded => Status::OPEN_FREE,
                _ if mode.is_slip() && !is_frictionless && !bounds.is_bonded => return false,
                _ => Status {
                    normal: if mode.is_yield() { bounds.status_at_cap() } else { Normal::Closed },
                    tangential: if is_frictionless && !bounds.is_bonded {
                        Tangential::Free
                    } else {
                        Tangential::Stick
                    },
                },
            };
            let is_swept = has_near_field && *status != Status::CLOSED_STICKING;
            if is_swept || status.is_yield() && bounds.interval[1] == f64::INFINITY {
                return false;
            }
        }
        problem.reset_forces();
        newton.solve_for_statuses(problem)
    }

    /// Sets the forces to those at the start of the step.
    fn set_initial_forces(&mut self, input: &ContactInput<'_>) {
        for (e, area) in self.areas.iter().enumerate() {
            let traction = input.start.state(e).traction();
            for (i, traction) in self.problem.component_indices(e).into_iter().zip(traction) {
                self.problem.set_force(i, area * traction);
            }
        }
    }

    /// Breaks the bonds of elements that have opened too far; returns whether any broke.
    ///
    /// `breaking_gap`: opening at which a bond breaks, m.
    fn break_bonds(&mut self, breaking_gap: f64) -> bool {
        let mut has_broken = false;
        for (e, status) in self.newton.statuses.iter().enumerate() {
            let bounds = &mut self.problem.bounds[e];
            let gap = self.problem.y[e] - bounds.closed_gap;
            if status.normal == Normal::Open && bounds.has_bond() && gap > breaking_gap {
                *bounds = bounds.with_broken_bond();
                self.has_broken_bond[e] = true;
                has_broken = true;
            }
        }
        has_broken
    }

    /// Writes the modes of the present statuses.
    fn write_modes(&self, modes: &mut [Mode]) {
        for (e, (mode, status)) in modes.iter_mut().zip(&self.newton.statuses).enumerate() {
            // A bond at its strength is intact; an element whose bond broke in this step slips.
            let has_bond = self.problem.bounds[e].has_bond();
            let slides = status.tangential != Tangential::Stick || self.has_broken_bond[e];
            let closed_mode = if slides { Mode::Slip } else { Mode::Stick };
            *mode = match status.normal {
                Normal::Open if !has_bond => Mode::Open,
                Normal::Capped | Normal::Hardening(_) => closed_mode.yielding(),
                _ => closed_mode,
            };
        }
    }

    /// Smallest friction bound that replaced the law's larger one on a sliding element.
    pub(super) fn substituted_friction(&self) -> Option<f64> {
        let elements = self.newton.statuses.iter().zip(&self.problem.bounds);
        let substituted = elements.filter(|(status, bounds)| status.slips_below(bounds.friction));
        substituted.map(|(_, bounds)| bounds.effective_friction()).reduce(f64::min)
    }

    /// Error of a search without a solution.
    ///
    /// It contains the residual with the laws' friction, and the elements above the tolerance.
    fn failure(&mut self, iterations: usize) -> StepError {
        let problem = &mut self.problem;
        problem.limit_friction(f64::INFINITY);
        let residual = problem.residual();
        let tolerance = problem.tolerance();
        let elements = (0..problem.element_count)
            .filter(|e| {
                let residual = problem.element_residual(*e);
                residual > tolerance || residual.is_nan()
            })
            .collect();
        let scale = problem.largest_force().max(f64::MIN_POSITIVE);
        StepError::Cone { iterations, residual: residual / scale, elements }
    }
}
