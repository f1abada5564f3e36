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
use blocks::Blocks;
use newton::Newton;
use problem::{Bounds, Problem};
use proximal::Proximal;
use search::search;
use status::{Normal, Status, Tangential};
use wide::Wide;

/// Gap at which a bond breaks, relative to the largest displacement.
const GONE: f64 = 1e-12;

/// A contact problem in plan, and the methods that solve it.
pub(super) struct Cone {
    problem: Problem,
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
            problem: Problem::on_bed(count),
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

    /// Finds `modes`, starting from the given ones; the solver then holds the solution.
    ///
    /// Returns the number of iterations and the last method used.
    pub(super) fn solve(
        &mut self,
        solver: &mut ContactSolver,
        input: &ContactInput<'_>,
        modes: &mut [Mode],
    ) -> Result<(usize, SearchMethod), StepError> {
        self.take(solver.generation, input)?;
        self.newton.begin_step();
        let (mut trials, mut method) = (0, SearchMethod::ActiveSet);
        for mode in modes.iter_mut() {
            *mode = mode.in_any_direction();
        }
        let tried = self.repeat(modes);
        if tried {
            trials += 1;
        }
        if !(tried && self.problem.is_solved()) {
            self.begin(input);
            loop {
                let Self { problem, newton, proximal, start, limited, is_linear, .. } = self;
                let lasts = lasts(*is_linear, &self.layers, input);
                let (iterations, found) =
                    search(problem, newton, proximal, [start, limited], lasts);
                trials += iterations;
                let Some(found) = found else { return Err(self.failure(trials)) };
                method = method.max(found);
                self.newton.classify(&self.problem, false);
                if !self.break_bonds(GONE * input.length_scale) {
                    break;
                }
            }
            self.name(modes);
        }
        solver.stand_in = self.stand_in();
        let layout = ContactLayout::new(COMPONENTS_IN_SPACE, self.areas.len());
        for (i, traction) in solver.traction.iter_mut().enumerate() {
            let [_, e] = layout.origin(i);
            // Exactly zero in total if there is no force.
            *traction = match self.problem.force(i) {
                0.0 => -input.static_traction[i],
                _ => self.problem.change[i] / self.areas[e],
            };
        }
        StepError::check_finite("contact traction", &solver.traction)?;
        solver.evaluate_by(input, |traction, jump| self.multiply_add(input, traction, jump));
        Ok((trials, method))
    }

    /// jump ← jump + W τ, by blocks or transforms where there are.
    ///
    /// The forces are then rounded as in the next step, which begins with the same product.
    fn multiply_add(&mut self, input: &ContactInput<'_>, traction: &[f64], jump: &mut [f64]) {
        let Problem { blocks, wide, low_rank, .. } = &self.problem;
        if blocks.is_none() && wide.is_none() && low_rank.is_none() {
            return input.delassus.multiply_add(traction, jump);
        }
        let Self { problem, areas, layers, .. } = self;
        for (e, area) in areas.iter().enumerate() {
            for i in problem.places(e) {
                problem.set(i, area * (input.static_traction[i] + traction[i]));
            }
        }
        problem.respond();
        for (e, layer) in layers.iter().enumerate() {
            for (component, i) in problem.places(e).into_iter().enumerate() {
                // The jump does not contain the layer.
                let own = layer[component.min(1)] / areas[e] * problem.change[i];
                jump[i] += problem.y[i] - problem.q[i] - own;
            }
        }
    }

    /// Reads W, q and the limits of the laws.
    fn take(&mut self, generation: usize, input: &ContactInput<'_>) -> Result<(), LawError> {
        self.find_operator(generation, input)?;
        let Self { problem, areas, layers, .. } = self;
        self.broken.fill(false);
        for (e, &area) in areas.iter().enumerate() {
            let start = input.start.element(e);
            problem.bounds[e] = bounds(&limits(input, e)?, area);
            let (jump, shear) = (start.state.jump(), start.state.traction());
            for (component, i) in problem.places(e).into_iter().enumerate() {
                problem.anchor[i] = area * input.static_traction[i];
                problem.q[i] = input.free_jump[i];
                // A layer starts from its deformation, a slip from its last value.
                let layer = layers[e][component.min(1)];
                let begin = if component == 0 { 0.0 } else { shear[component] };
                problem.q[i] += layer * (input.static_traction[i] - begin);
                if component > 0 {
                    problem.q[i] -= jump[component];
                }
            }
        }
        problem.scale = largest(&problem.anchor);
        let stiffest = problem.rho.iter().flatten().fold(0.0_f64, |most, rho| most.max(*rho));
        // Rounding of lengths that are not normal numbers is larger.
        let length = input.length_scale.max(f64::MIN_POSITIVE / f64::EPSILON);
        problem.finest = 4.0 * f64::EPSILON * length * stiffest;
        Ok(())
    }

    /// Copies W and adds the layers of the laws, if either has changed.
    fn find_operator(
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
            self.take_modes(on_bed);
            return Ok(());
        }
        if self.problem.low_rank.is_some() {
            let count = self.areas.len();
            (self.problem, self.newton) = (Problem::new(count), Newton::new(count));
        }
        let lasts = lasts(self.is_linear, &self.layers, input);
        let Self { problem, areas, layers, .. } = self;
        let (size, count) = (problem.size(), areas.len());
        let layer = |row: usize| layers[row % count][(row / count).min(1)] / areas[row % count];
        for (row, values) in problem.w.chunks_exact_mut(size).enumerate() {
            for (column, value) in values.iter_mut().enumerate() {
                *value = input.delassus[row * size + column] / areas[column % count];
            }
            values[row] += layer(row);
        }
        problem.find_scales();
        (problem.blocks, problem.wide) = (None, None);
        // Blocks of a W that changes would not pay.
        if let Some(soil) = input.delassus.soil().filter(|_| lasts)
            && let Some(cells) = soil.cells()
        {
            let compliance =
                |row: usize, column: usize| soil[row * size + column] / areas[column % count];
            let blocks = Blocks::new(&problem.w, &problem.rho, cells, compliance, layer);
            if blocks.is_none() {
                problem.wide = Wide::new(&problem.w, cells, compliance, layer);
            }
            problem.take_blocks(blocks);
        }
        problem.prepare_acceleration();
        self.newton.forget(lasts);
        Ok(())
    }

    /// Takes W of low rank, and adds the layers of the laws.
    fn take_modes(&mut self, on_bed: &OnBed) {
        let Self { problem, newton, areas, layers, .. } = self;
        let count = areas.len();
        let layer = |row: usize| layers[row % count][(row / count).min(1)] / areas[row % count];
        let Some(low_rank) = &mut problem.low_rank else {
            (*problem, *newton) = (Problem::on_bed(count), Newton::on_bed(count));
            return self.take_modes(on_bed);
        };
        low_rank.set(on_bed, areas, layer);
        newton.reserve(on_bed.rank());
        problem.find_scales();
    }

    /// Solves for the statuses of the previous step; `false` if an element slid, or if sweeps take less time.
    fn repeat(&mut self, modes: &[Mode]) -> bool {
        let Self { newton, problem, .. } = self;
        if problem.blocks.as_ref().is_some_and(|blocks| !blocks.is_factored()) {
            return false;
        }
        for ((status, mode), bounds) in newton.statuses.iter_mut().zip(modes).zip(&problem.bounds) {
            let smooth = bounds.friction == 0.0 && !bounds.has_bond();
            *status = match mode {
                Mode::Open if !bounds.bonded => Status::OPEN,
                _ if mode.is_slip() && !smooth && !bounds.bonded => return false,
                _ => Status {
                    normal: if mode.is_yield() { Normal::Capped } else { Normal::Closed },
                    tangential: if smooth && !bounds.bonded {
                        Tangential::Free
                    } else {
                        Tangential::Stick
                    },
                },
            };
            let capped = status.normal == Normal::Capped;
            let is_swept = problem.blocks.is_some() && *status != Status::STICK;
            if is_swept || capped && bounds.interval[1] == f64::INFINITY {
                return false;
            }
        }
        problem.rest();
        newton.step(problem)
    }

    /// Sets the initial forces of the step.
    fn begin(&mut self, input: &ContactInput<'_>) {
        for (e, area) in self.areas.iter().enumerate() {
            let traction = input.start.state(e).traction();
            for (i, traction) in self.problem.places(e).into_iter().zip(traction) {
                self.problem.set(i, area * traction);
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
    fn name(&self, modes: &mut [Mode]) {
        for (e, (mode, status)) in modes.iter_mut().zip(&self.newton.statuses).enumerate() {
            // A bond at its strength still holds; a broken one stays broken.
            let held = self.problem.bounds[e].has_bond();
            let slides = status.tangential != Tangential::Stick || self.broken[e];
            let closed = if slides { Mode::Slip } else { Mode::Stick };
            *mode = match status.normal {
                Normal::Open if !held => Mode::Open,
                Normal::Capped => closed.yielding(),
                _ => closed,
            };
        }
    }

    /// Smallest friction bound that replaced the law's larger one on a sliding element.
    fn stand_in(&self) -> Option<f64> {
        let elements = self.newton.statuses.iter().zip(&self.problem.bounds);
        let taken = elements.filter(|(status, bounds)| status.is_held_by(bounds.friction));
        taken.map(|(_, bounds)| bounds.taken()).reduce(f64::min)
    }

    fn failure(&mut self, iterations: usize) -> StepError {
        let problem = &mut self.problem;
        // With the friction of the laws.
        problem.hold(f64::INFINITY);
        let residual = problem.residual();
        let tolerance = problem.tolerance();
        let missed = |e: &usize| problem.miss(*e) > tolerance || problem.miss(*e).is_nan();
        let elements = (0..problem.count).filter(missed).collect();
        let scale = problem.largest().max(f64::MIN_POSITIVE);
        StepError::Cone { iterations, residual: residual / scale, elements }
    }
}

/// Whether W is constant for the whole run.
///
/// True if the structure is linear, and laws with layers have no state variables.
fn lasts(is_linear: bool, layers: &[[f64; 2]], input: &ContactInput<'_>) -> bool {
    let is_fixed =
        |(e, layer): (usize, &[f64; 2])| *layer == [0.0; 2] || input.law(e).state_variables() == 0;
    is_linear && layers.iter().enumerate().all(is_fixed)
}

/// Limits of an element's law, checked.
fn limits(input: &ContactInput<'_>, element: usize) -> Result<Limits, LawError> {
    let (law, start) = (input.law(element), input.start.element(element));
    let mode = start.mode.word();
    let refused = |reason| LawError { element, mode, reason: Box::new(reason) };
    let limits = law.limits(&start).and_then(Limits::checked).map_err(refused)?;
    Ok(if input.frictionless { limits.frictionless() } else { limits })
}

/// Bounds of the forces on an area, m².
fn bounds(limits: &Limits, area: f64) -> Bounds {
    Bounds {
        friction: limits.friction,
        grip: f64::INFINITY,
        attraction: limits.attraction * area,
        strength: limits.shear_strength * area,
        interval: [-limits.tension * area, limits.pressure_cap * area],
        offset: limits.gap_offset,
        bonded: limits.bonded,
    }
}
