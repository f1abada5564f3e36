//! Contact with uplift and friction in plan: Signorini's law, and Coulomb's law with shear on a disc.
//!
//! 1. If nothing slid in the previous step, its statuses are tried; their factors are kept as long as they do not
//!    change. Many elements on a lattice begin with sweeps, unless all stick and each moves many others.
//! 2. Sweeps over the elements, from the forces of the previous step; accelerated if many elements move most others.
//! 3. Newton's method, then sweeps and Newton's method in turn.
//! 4. Newton's method from other forces, with partial steps.
//! 5. The proximal point method around all of them.
//!
//! Friction above 100, or infinite, is first tried by Newton's method alone, then by all methods with a lower
//! friction, which is raised from that solution. If it cannot be raised, the step keeps the lower friction, and
//! the run warns of it.
//!
//! W is symmetric and positive definite, so a solution exists (Acary, Cadoux, Lemaréchal & Malick 2011); with
//! small friction it is unique. The shear of a sliding element lies on its disc against the slip of the same
//! solution: its friction work is never negative.
//!
//! A bond bears tension, and shear without pressure, up to its strength. The bond of an element that has opened
//! beyond it breaks in the step, which is then solved again: at most once for each element.

mod acceleration;
mod blocks;
mod bounds;
mod group;
mod low_rank;
mod low_rank_system;
mod modes;
mod newton;
mod problem;
mod proximal;
mod search;
mod status;
mod sweeps;
mod system;
#[cfg(test)]
mod tests;
mod wide;

use super::problem::{ContactInput, ContactSolver};
use super::{OnBed, SearchMethod};
use crate::error::{LawError, StepError};
use crate::geometry::{COMPONENTS_IN_SPACE, ContactLayout};
use crate::interface::{Limits, Mode};
use crate::linalg::largest;
use blocks::NearFieldBlocks;
use newton::Newton;
use problem::{Bounds, ConeProblem};
use proximal::Proximal;
use search::search;
use status::{Normal, Status, Tangential};
use wide::DenseLattice;

/// Gap at which a bond breaks, relative to the largest displacement.
const BOND_BREAKING_GAP: f64 = 1e-12;

/// A contact problem in plan, and the methods that solve it.
pub(super) struct Cone {
    problem: ConeProblem,
    newton: Newton,
    proximal: Proximal,
    areas: Vec<f64>,
    /// Compliance of each element's layer, included in W.
    layers: Vec<[f64; 2]>,
    /// Number of the present W; `None` before the first.
    generation: Option<usize>,
    /// Elements whose bonds have broken in this step.
    broken: Vec<bool>,
    /// Initial forces of a search, and forces that solve with less friction.
    start: Vec<f64>,
    limited: Vec<f64>,
    /// Whether the structure is linear: all steps then have the same W, unless layers change.
    is_linear: bool,
}

impl Cone {
    /// Search for elements with these areas, m²; `is_linear`: whether the structure is linear.
    pub(super) fn new(areas: &[f64], is_linear: bool) -> Self {
        let count = areas.len();
        Self {
            problem: ConeProblem::on_bed(count),
            newton: Newton::on_bed(count),
            proximal: Proximal::new(count),
            areas: areas.to_vec(),
            layers: vec![[0.0; 2]; count],
            generation: None,
            broken: vec![false; count],
            start: vec![0.0; 3 * count],
            limited: vec![0.0; 3 * count],
            is_linear,
        }
    }

    /// Finds `modes`, starting from their present values; the solver then holds the solution.
    ///
    /// Returns the number of iterations and the last method used.
    pub(super) fn solve(
        &mut self,
        solver: &mut ContactSolver,
        input: &ContactInput<'_>,
        modes: &mut [Mode],
    ) -> Result<(usize, SearchMethod), StepError> {
        self.read_step(solver.generation, input)?;
        self.newton.begin_step();
        let mut method = SearchMethod::ActiveSet;
        for mode in modes.iter_mut() {
            *mode = mode.in_any_direction();
        }
        let tried = self.try_previous_statuses(modes);
        let mut trials = usize::from(tried);
        if !(tried && self.problem.is_solved()) {
            self.set_initial_forces(input);
            loop {
                let Self { problem, newton, proximal, start, limited, is_linear, .. } = self;
                let is_constant = has_constant_operator(*is_linear, &self.layers, input);
                let outcome = search(problem, newton, proximal, start, limited, is_constant);
                trials += outcome.iterations;
                let Some(found) = outcome.method else { return Err(self.failure(trials)) };
                method = method.max(found);
                self.newton.classify(&self.problem, false);
                if !self.break_bonds(BOND_BREAKING_GAP * input.length_scale) {
                    break;
                }
            }
            self.write_modes(modes);
        }
        solver.substituted_friction = self.substituted_friction();
        let layout = ContactLayout::new(COMPONENTS_IN_SPACE, self.areas.len());
        for (i, traction) in solver.traction.iter_mut().enumerate() {
            // Exactly zero in total if there is no force.
            *traction = match self.problem.force(i) {
                0.0 => -input.static_traction[i],
                _ => self.problem.change[i] / self.areas[layout.origin(i)[1]],
            };
        }
        StepError::check_finite("contact traction", &solver.traction)?;
        solver.evaluate_by(input, |traction, jump| self.multiply_add(input, traction, jump));
        Ok((trials, method))
    }

    /// jump ← jump + W τ, by blocks or transforms where they exist.
    ///
    /// The forces are then rounded as in the next step, which begins with the same product.
    fn multiply_add(&mut self, input: &ContactInput<'_>, traction: &[f64], jump: &mut [f64]) {
        let ConeProblem { near_field, dense_lattice, low_rank, .. } = &self.problem;
        if near_field.is_none() && dense_lattice.is_none() && low_rank.is_none() {
            return input.delassus.multiply_add(traction, jump);
        }
        let Self { problem, areas, layers, .. } = self;
        for (e, area) in areas.iter().enumerate() {
            for i in problem.places(e) {
                problem.set_force(i, area * (input.static_traction[i] + traction[i]));
            }
        }
        problem.update_motions();
        for (e, layer) in layers.iter().enumerate() {
            for (component, i) in problem.places(e).into_iter().enumerate() {
                // The jump does not contain the layer.
                let by_layer = layer[component.min(1)] / areas[e] * problem.change[i];
                jump[i] += problem.y[i] - problem.q[i] - by_layer;
            }
        }
    }

    /// Reads W, q and the limits of the laws.
    fn read_step(&mut self, generation: usize, input: &ContactInput<'_>) -> Result<(), LawError> {
        self.update_operator(generation, input)?;
        let Self { problem, areas, layers, .. } = self;
        self.broken.fill(false);
        for (e, &area) in areas.iter().enumerate() {
            let start = input.start.element(e);
            problem.bounds[e] = bounds(&limits(input, e)?, area);
            for (component, i) in problem.places(e).into_iter().enumerate() {
                problem.anchor[i] = area * input.static_traction[i];
                problem.q[i] = input.free_jump[i];
                // A layer starts from its deformation, a slip from its last value.
                let layer = layers[e][component.min(1)];
                let begin = if component == 0 { 0.0 } else { start.state.traction()[component] };
                problem.q[i] += layer * (input.static_traction[i] - begin);
                if component > 0 {
                    problem.q[i] -= start.state.jump()[component];
                }
            }
        }
        problem.min_force_scale = largest(&problem.anchor);
        let stiffest = problem.rho.iter().flatten().fold(0.0_f64, |max, rho| max.max(*rho));
        // Rounding of lengths that are not normal numbers is larger.
        let length = input.length_scale.max(f64::MIN_POSITIVE / f64::EPSILON);
        problem.rounding_residual = 4.0 * f64::EPSILON * length * stiffest;
        Ok(())
    }

    /// Copies W and adds the layers of the laws, if either has changed.
    fn update_operator(
        &mut self,
        generation: usize,
        input: &ContactInput<'_>,
    ) -> Result<(), LawError> {
        for e in 0..self.areas.len() {
            let layer = input.law(e).compliance(Mode::Stick, &input.start.element(e));
            if layer != self.layers[e] {
                for (value, quantity) in
                    layer.into_iter().zip(["normal compliance", "shear compliance"])
                {
                    if !(value >= 0.0 && value.is_finite()) {
                        let mode = Mode::Stick.word();
                        return Err(LawError::not_finite(e, mode, quantity, value));
                    }
                }
                self.layers[e] = layer;
                self.generation = None;
            }
        }
        if self.generation == Some(generation) {
            return Ok(());
        }
        self.generation = Some(generation);
        if let Some(on_bed) = input.delassus.on_bed() {
            self.read_modes(on_bed);
            return Ok(());
        }
        if self.problem.low_rank.is_some() {
            let count = self.areas.len();
            (self.problem, self.newton) = (ConeProblem::new(count), Newton::new(count));
        }
        let is_constant = has_constant_operator(self.is_linear, &self.layers, input);
        let Self { problem, areas, layers, .. } = self;
        let size = problem.size();
        let count = areas.len();
        let layer = |row: usize| layers[row % count][(row / count).min(1)] / areas[row % count];
        for (row, values) in problem.w.chunks_exact_mut(size).enumerate() {
            for (column, value) in values.iter_mut().enumerate() {
                *value = input.delassus[row * size + column] / areas[column % count];
            }
            values[row] += layer(row);
        }
        problem.update_scales();
        problem.near_field = None;
        problem.dense_lattice = None;
        // Blocks of a W that changes would not pay.
        if let Some(soil) = input.delassus.soil().filter(|_| is_constant)
            && let Some(cells) = soil.cells()
        {
            let compliance =
                |row: usize, column: usize| soil[row * size + column] / areas[column % count];
            let near_field =
                NearFieldBlocks::new(&problem.w, &problem.rho, cells, compliance, layer);
            if near_field.is_none() {
                problem.dense_lattice = DenseLattice::new(&problem.w, cells, compliance, layer);
            }
            problem.set_near_field(near_field);
        }
        problem.prepare_acceleration();
        self.newton.forget(is_constant);
        Ok(())
    }

    /// Reads W of low rank, and adds the layers of the laws.
    fn read_modes(&mut self, on_bed: &OnBed) {
        let Self { problem, newton, areas, layers, .. } = self;
        let count = areas.len();
        let layer = |row: usize| layers[row % count][(row / count).min(1)] / areas[row % count];
        let Some(low_rank) = &mut problem.low_rank else {
            (*problem, *newton) = (ConeProblem::on_bed(count), Newton::on_bed(count));
            return self.read_modes(on_bed);
        };
        low_rank.set(on_bed, areas, layer);
        newton.reserve(on_bed.rank());
        problem.update_scales();
    }

    /// Solves for the statuses of the previous step; `false` if an element slid, or if sweeps take less time.
    fn try_previous_statuses(&mut self, modes: &[Mode]) -> bool {
        let Self { newton, problem, .. } = self;
        if problem.near_field.as_ref().is_some_and(|near_field| !near_field.is_factored()) {
            return false;
        }
        for ((status, mode), bounds) in newton.statuses.iter_mut().zip(modes).zip(&problem.bounds) {
            let is_frictionless = bounds.friction == 0.0 && !bounds.has_bond();
            *status = match mode {
                Mode::Open if !bounds.bonded => Status::OPEN_FREE,
                _ if mode.is_slip() && !is_frictionless && !bounds.bonded => return false,
                _ => Status {
                    normal: if mode.is_yield() { Normal::Capped } else { Normal::Closed },
                    tangential: if is_frictionless && !bounds.bonded {
                        Tangential::Free
                    } else {
                        Tangential::Stick
                    },
                },
            };
            let capped = status.normal == Normal::Capped;
            let is_swept = problem.near_field.is_some() && *status != Status::CLOSED_STICKING;
            if is_swept || capped && bounds.interval[1] == f64::INFINITY {
                return false;
            }
        }
        problem.reset_forces();
        newton.step(problem)
    }

    /// Sets the initial forces of the step.
    fn set_initial_forces(&mut self, input: &ContactInput<'_>) {
        for (e, area) in self.areas.iter().enumerate() {
            let traction = input.start.state(e).traction();
            for (i, traction) in self.problem.places(e).into_iter().zip(traction) {
                self.problem.set_force(i, area * traction);
            }
        }
    }

    /// Breaks the bonds of elements that have opened; returns whether any broke.
    fn break_bonds(&mut self, gone: f64) -> bool {
        let mut any = false;
        for (e, status) in self.newton.statuses.iter().enumerate() {
            let bounds = &mut self.problem.bounds[e];
            let gap = self.problem.y[e] - bounds.offset;
            if status.normal == Normal::Open && bounds.has_bond() && gap > gone {
                *bounds = bounds.broken();
                (self.broken[e], any) = (true, true);
            }
        }
        any
    }

    /// Modes of the statuses.
    fn write_modes(&self, modes: &mut [Mode]) {
        for (e, (mode, status)) in modes.iter_mut().zip(&self.newton.statuses).enumerate() {
            // A bond at its strength still holds; a broken one stays broken.
            let has_bond = self.problem.bounds[e].has_bond();
            let slides = status.tangential != Tangential::Stick || self.broken[e];
            let closed = if slides { Mode::Slip } else { Mode::Stick };
            *mode = match status.normal {
                Normal::Open if !has_bond => Mode::Open,
                Normal::Capped => closed.yielding(),
                _ => closed,
            };
        }
    }

    /// Smallest friction bound that replaced the law's larger one on a sliding element.
    fn substituted_friction(&self) -> Option<f64> {
        let elements = self.newton.statuses.iter().zip(&self.problem.bounds);
        let substituted = elements.filter(|(status, bounds)| status.slips_below(bounds.friction));
        substituted.map(|(_, bounds)| bounds.effective_friction()).reduce(f64::min)
    }

    fn failure(&mut self, iterations: usize) -> StepError {
        let problem = &mut self.problem;
        // With the friction of the laws.
        problem.limit_friction(f64::INFINITY);
        let residual = problem.residual();
        let tolerance = problem.tolerance();
        let elements = (0..problem.count)
            .filter(|e| {
                let residual = problem.element_residual(*e);
                residual > tolerance || residual.is_nan()
            })
            .collect();
        let scale = problem.largest_force().max(f64::MIN_POSITIVE);
        StepError::Cone { iterations, residual: residual / scale, elements }
    }
}

/// Whether W is constant for the whole run.
///
/// True if the structure is linear, and laws with layers have no state variables.
fn has_constant_operator(is_linear: bool, layers: &[[f64; 2]], input: &ContactInput<'_>) -> bool {
    is_linear
        && layers
            .iter()
            .enumerate()
            .all(|(e, layer)| *layer == [0.0; 2] || input.law(e).state_variables() == 0)
}

/// Limits of an element's law, checked.
fn limits(input: &ContactInput<'_>, element: usize) -> Result<Limits, LawError> {
    let law = input.law(element);
    let start = input.start.element(element);
    let mode = start.mode.word();
    let limits = law.limits(&start).and_then(Limits::checked).map_err(|reason| LawError {
        element,
        mode,
        reason: Box::new(reason),
    })?;
    Ok(if input.frictionless { limits.frictionless() } else { limits })
}

/// Bounds of the forces on an area, m².
fn bounds(limits: &Limits, area: f64) -> Bounds {
    Bounds {
        friction: limits.friction,
        friction_limit: f64::INFINITY,
        attraction: limits.attraction * area,
        strength: limits.shear_strength * area,
        interval: [-limits.tension * area, limits.pressure_cap * area],
        offset: limits.gap_offset,
        bonded: limits.bonded,
    }
}
