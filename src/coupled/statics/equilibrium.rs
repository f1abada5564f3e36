//! Equilibrium with contact conditions and a soil at rest, by proximal point iteration.

use std::cell::RefCell;
use std::rc::Rc;

use crate::contact::{ContactInput, ContactSearch, ContactSolver, ModeSearch};
use crate::coupled::model::assembled::Assembled;
use crate::coupled::statics::compliance::{
    Compliance, Floating, PROXIMAL_SPRING_FRACTION, STATIC_STIFFNESS_NAME, springs,
};
use crate::coupled::statics::static_state::StaticState;
use crate::error::{Error, Result, StepError};
use crate::interface::{ContactState, InterfaceLaw, PreviousContacts};
use crate::linalg::{CompressedMatrix, SparseMatrix, dot, largest, transposed_multiply_add};
use crate::structure::{Structure, Tangent, nonlinear_state};

/// Largest unbalanced force of an equilibrium, relative to the load.
const FORCE_BALANCE_TOLERANCE: f64 = 1e-7;
/// Condition beyond which rounding of K u exceeds that force (`tests/coupled/conditioning.rs`).
const MAX_ACCEPTED_CONDITION: f64 = 1e10;
/// Largest number of proximal iterations.
const MAX_PROXIMAL_ITERATIONS: usize = 500;
/// Iterations after which a change of up to [`LATE_CHANGE`] counts as rounding if the condition explains it.
const LATE_ITERATION_COUNT: usize = 100;
const LATE_CHANGE: f64 = 1e-8;
/// Largest unbalanced force of a steady drift, relative to the load.
const STEADY_DRIFT_TOLERANCE: f64 = 1e-8;
/// Softest springs, as a fraction of their initial stiffness.
const MIN_SPRING_FRACTION: f64 = 1e-9;
/// Decrease of their force in an iteration above which they are softened tenfold while it exceeds [`SPRING_FORCE_ROUNDING`]:
/// a structure far softer than the ground deforms only slowly against springs that are stiffer than itself.
const SLOW_DECREASE_RATIO: f64 = 0.2;
/// Largest factor by which the springs are stiffened to hold a structure that leans (P–Δ) without the ground.
const MAX_STIFFENING_FACTOR: f64 = 1e4;
/// Force of the springs, relative to the load, below which rounding may stop its decrease.
const SPRING_FORCE_ROUNDING: f64 = 1e-6;
/// Iterations after which only a slow decrease that the condition explains counts as rounding.
///
/// A force below [`SPRING_FORCE_ROUNDING`] can still switch the mode of an element of little pressure back and forth.
const ROUNDING_CHECK_ITERATION: usize = 20;
/// Iterations on springs that must stay stiff (P–Δ) from one extrapolation to the next.
const EXTRAPOLATION_INTERVAL: usize = 20;
/// Smallest ratio of two successive steps from which they are extrapolated; with a smaller one they converge soon.
const MIN_EXTRAPOLATED_RATIO: f64 = 0.5;
/// Smallest squared cosine between two successive steps that are extrapolated.
const COLLINEARITY_THRESHOLD: f64 = 0.9999;

/// A structure on a soil at rest.
pub(crate) struct Standing<'a> {
    pub(crate) assembled: &'a Assembled,
    pub(crate) structure: &'a dyn Structure,
    /// Static compliance of the ground.
    pub(crate) soil: &'a CompressedMatrix,
    /// Whether the laws act without friction and cohesion, in plan.
    pub(crate) frictionless: bool,
    /// Jumps in addition to those by displacements and tractions; empty for none.
    pub(crate) offset: &'a [f64],
    /// Compliance of a linear structure on its initial springs, which stages share.
    pub(crate) shared: &'a RefCell<Option<Compliance>>,
}

impl Standing<'_> {
    /// Finds u and τ with K u + f(u) + BᵀA τ = `load` and the contact conditions of a soil at rest.
    ///
    /// K alone is singular (rigid-body modes), and the settlement of a half-plane has no datum. Springs ε M to the
    /// last iterate make each iteration regular, and their forces vanish at convergence (proximal point method); f
    /// is linearised at each iterate (Newton). Starts from `state`, the end of the previous stage, to which the
    /// laws' `start` belongs. Also returns the states of the elements.
    pub(crate) fn equilibrium(
        &self,
        laws: &[Box<dyn InterfaceLaw>],
        start: &PreviousContacts,
        mut state: StaticState,
        load: &[f64],
    ) -> Result<(StaticState, Vec<ContactState>)> {
        let Self { assembled, structure, shared, .. } = *self;
        let base = &assembled.base;
        let mut springs = self.springs()?;
        let initial_stiffness = springs.stiffness;
        let mut solver = ContactSolver::new(base.layout());
        let mut search = ModeSearch::new(base.layout(), base.areas(), false, ContactSearch::Robust);
        let measure = Measure::new(assembled, load);
        let mut tangent = Tangent::new(assembled.dofs());
        let mut compliance = None::<Compliance>;
        let mut change = f64::INFINITY;
        let mut iterations = 0;
        let mut last_step = Vec::new();
        while iterations < MAX_PROXIMAL_ITERATIONS {
            iterations += 1;
            tangent.refill(structure, &state.displacement)?;
            let current = match compliance.take() {
                Some(current) if assembled.linear => current,
                _ => {
                    solver.invalidate();
                    let max_stiffness = MAX_STIFFENING_FACTOR * initial_stiffness;
                    self.stiffened(&mut springs, &tangent.matrix, max_stiffness)?
                }
            };
            let current = compliance.insert(current);
            let next =
                self.next(current, &mut search, &mut solver, (laws, start), load, &mut state)?;
            let Some(displacement) = next else { break };
            let spring_force = springs.force(assembled, &displacement, &state.displacement);
            let previous = std::mem::replace(&mut change, measure.norm(&spring_force));
            let step = difference(&displacement, &state.displacement);
            state.displacement = displacement;
            state.traction.copy_from_slice(&solver.traction);
            if has_converged(previous, change, iterations, current) {
                // The springs may have no force without an equilibrium, if K u is only rounding.
                let residual = imbalance(assembled, load, &state.traction);
                if residual <= FORCE_BALANCE_TOLERANCE {
                    state.substituted_friction =
                        solver.substituted_friction.or(state.substituted_friction);
                    shared.replace(compliance.filter(|compliance| {
                        assembled.linear && compliance.floating.springs == initial_stiffness
                    }));
                    state.close_gaps(laws, start, &solver.states)?;
                    return Ok((state, solver.states));
                }
                change = residual;
                break;
            }
            if !change.is_finite() {
                break;
            }
            let rounding = rounding(iterations, current);
            if change > rounding.max(SLOW_DECREASE_RATIO * previous) && springs.soften() {
                compliance = None;
                solver.invalidate();
            } else if springs.stay_stiff() && iterations.is_multiple_of(EXTRAPOLATION_INTERVAL) {
                // Close to buckling, one shape converges slowly.
                let factor = extrapolation(&assembled.mass, &last_step, &step);
                state.displacement.iter_mut().zip(&step).for_each(|(u, d)| *u += factor * d);
            }
            last_step = step;
        }
        // With the initial springs: softened springs leave a matrix of rounding, which has no condition.
        let initial = Floating::new(assembled, &tangent.matrix, initial_stiffness);
        let condition = initial.map_or(1.0, |floating| floating.condition());
        Err(failure(condition, iterations, change))
    }

    /// Displacements of the next iterate; `None` if its contact problem has no solution.
    ///
    /// The tractions are in `solver`.
    fn next(
        &self,
        current: &Compliance,
        search: &mut ModeSearch,
        solver: &mut ContactSolver,
        (laws, start): (&[Box<dyn InterfaceLaw>], &PreviousContacts),
        load: &[f64],
        state: &mut StaticState,
    ) -> Result<Option<Vec<f64>>> {
        let mut displacement = self.without_traction(current, load, state)?;
        let mut means = vec![0.0; solver.traction.len()];
        self.assembled.base.means(&displacement, &mut means);
        let mut free_jump: Vec<f64> = means.iter().map(|mean| -mean).collect();
        free_jump.iter_mut().zip(self.offset).for_each(|(jump, offset)| *jump += offset);
        let input = ContactInput {
            delassus: &current.delassus,
            free_jump: &free_jump,
            static_traction: &vec![0.0; free_jump.len()],
            start,
            laws,
            length_scale: largest(&free_jump),
            bonds: &[],
            frictionless: self.frictionless,
        };
        match search.solve(solver, &input, &mut state.modes) {
            Ok(_) => {}
            Err(StepError::Law(error)) => return Err(Error::Law(error)),
            Err(_) => return Ok(None),
        }
        transposed_multiply_add(&current.columns, -1.0, &solver.traction, &mut displacement);
        Ok(Some(displacement))
    }

    /// Displacements of the next iterate before its tractions act.
    ///
    /// (K + D + εM) (u₁ − u₀) = load − K u₀ − f(u₀) − BᵀAτ₁. With the springs alone the structure would settle by
    /// 1/`PROXIMAL_SPRING_FRACTION` settlements. The columns that subtract the response to τ₁ therefore add the response to τ₀,
    /// and the system is solved only for the unbalanced force.
    fn without_traction(
        &self,
        current: &Compliance,
        load: &[f64],
        state: &StaticState,
    ) -> Result<Vec<f64>> {
        let mut displacement = out_of_balance(self.assembled, self.structure, load, state)?;
        current.floating.factor.solve_many(&mut displacement);
        for (d, u) in displacement.iter_mut().zip(&state.displacement) {
            *d += u;
        }
        transposed_multiply_add(&current.columns, 1.0, &state.traction, &mut displacement);
        Ok(displacement)
    }

    /// The springs of the shared compliance, or the initial ones.
    fn springs(&self) -> Result<Springs> {
        let stiffness = match &*self.shared.borrow() {
            Some(compliance) if self.assembled.linear => compliance.floating.springs,
            _ => springs(self.assembled, self.soil)?,
        };
        Ok(Springs { stiffness, softest: MIN_SPRING_FRACTION * stiffness })
    }

    /// Compliance with springs stiff enough to hold a structure that leans without the ground.
    ///
    /// Each iteration then finds the smallest energy. With softer springs it may find a structure on the verge of a
    /// fall, on a corner. If springs of up to `max_stiffness` do not help (Lagrange multipliers), or rounding is the
    /// cause, they stay unchanged.
    fn stiffened(
        &self,
        springs: &mut Springs,
        tangent: &SparseMatrix,
        max_stiffness: f64,
    ) -> Result<Compliance> {
        let mut shared = self.shared.borrow_mut();
        if self.assembled.linear
            && let Some(compliance) =
                shared.take_if(|shared| shared.floating.springs == springs.stiffness)
        {
            return Ok(compliance);
        }
        drop(shared);
        let initial = self.compliance(tangent, springs.stiffness)?;
        if initial.floating.factor.is_positive_definite()
            || initial.floating.condition() > MAX_ACCEPTED_CONDITION
        {
            return Ok(initial);
        }
        let mut stiffness = 10.0 * springs.stiffness;
        while stiffness <= max_stiffness {
            let stiffer = self.compliance(tangent, stiffness)?;
            if stiffer.floating.factor.is_positive_definite() {
                *springs = Springs { stiffness, softest: stiffness };
                return Ok(stiffer);
            }
            stiffness *= 10.0;
        }
        Ok(initial)
    }

    /// Compliance with springs of this stiffness per mass.
    fn compliance(&self, tangent: &SparseMatrix, stiffness: f64) -> Result<Compliance> {
        let floating = Rc::new(Floating::new(self.assembled, tangent, stiffness)?);
        Compliance::new(floating, &self.assembled.base, self.soil)
    }
}

/// Fictitious springs ε M between two iterates.
struct Springs {
    /// ε.
    stiffness: f64,
    /// ε down to which the springs are softened.
    softest: f64,
}

impl Springs {
    /// Force of the springs between two displacements.
    fn force(&self, assembled: &Assembled, to: &[f64], from: &[f64]) -> Vec<f64> {
        let moved = difference(to, from);
        let mut force = vec![0.0; moved.len()];
        assembled.mass.multiply_add(self.stiffness, &moved, &mut force);
        force
    }

    /// Whether softer springs would not hold the structure.
    fn stay_stiff(&self) -> bool {
        self.softest == self.stiffness
    }

    /// Softens the springs tenfold; `false` if they are as soft as allowed.
    fn soften(&mut self) -> bool {
        let can_soften = self.stiffness > self.softest;
        if can_soften {
            self.stiffness *= 0.1;
        }
        can_soften
    }
}

fn difference(to: &[f64], from: &[f64]) -> Vec<f64> {
    to.iter().zip(from).map(|(a, b)| a - b).collect()
}

/// Further steps to the limit of a geometric series with these two steps, in multiples of the last one (Aitken 1926).
///
/// Zero for steps that are no such series yet, grow, or become small quickly. Contact that opens on the way moves the limit
/// further away, so that the series does not pass an equilibrium from which the structure falls over.
fn extrapolation(mass: &SparseMatrix, before: &[f64], last: &[f64]) -> f64 {
    if before.len() != last.len() {
        return 0.0;
    }
    let square_before = mass.form(before, before);
    let square_last = mass.form(last, last);
    let product = mass.form(before, last);
    let ratio = product / square_before;
    let is_collinear = product * product > COLLINEARITY_THRESHOLD * square_before * square_last;
    let is_series = product > 0.0 && is_collinear;
    let is_slow = ratio > MIN_EXTRAPOLATED_RATIO && ratio < 1.0 - f64::EPSILON.sqrt();
    if is_series && is_slow { ratio / (1.0 - ratio) } else { 0.0 }
}

/// Whether the last two forces of the springs show convergence.
fn has_converged(previous: f64, change: f64, iterations: usize, current: &Compliance) -> bool {
    // The force of the springs has the accuracy of the solution.
    let has_stalled = change <= 1e-10 && change >= 0.5 * previous;
    // A motion that nothing resists (a frictionless base along the ground) drifts for ever by the same amount under
    // the rounding of the sums of K, a fraction that grows with its size.
    let drifts = change <= STEADY_DRIFT_TOLERANCE && (change - previous).abs() <= 1e-3 * change;
    if change <= 1e-13 || has_stalled || drifts {
        return true;
    }
    iterations > LATE_ITERATION_COUNT
        && change <= LATE_CHANGE
        && change <= current.floating.condition() * f64::EPSILON
}

/// Force of the springs, relative to the load, that counts as rounding after so many iterations.
fn rounding(iterations: usize, current: &Compliance) -> f64 {
    match iterations {
        0..ROUNDING_CHECK_ITERATION => SPRING_FORCE_ROUNDING,
        _ => SPRING_FORCE_ROUNDING.min(current.floating.condition() * f64::EPSILON),
    }
}

/// Error for a search that did not converge.
fn failure(condition: f64, iterations: usize, change: f64) -> Error {
    if condition <= MAX_ACCEPTED_CONDITION {
        return Error::Preload { iterations, residual: change };
    }
    Error::IllConditioned {
        matrix: STATIC_STIFFNESS_NAME,
        condition,
        limit: MAX_ACCEPTED_CONDITION,
        quantity: "stiffness of the structure over that of the ground",
        ratio: PROXIMAL_SPRING_FRACTION * condition,
    }
}

/// Relative force imbalance: K resists no translation, so tractions alone must carry the resultants of the load.
fn imbalance(assembled: &Assembled, load: &[f64], traction: &[f64]) -> f64 {
    let mut residual = load.to_vec();
    assembled.base.add_forces(-1.0, traction, &mut residual);
    let mut max_resultant = 0.0_f64;
    let mut scale = 0.0_f64;
    for vector in &assembled.influence.of_all(load.len()) {
        max_resultant = max_resultant.max(dot(vector, &residual).abs());
        scale = scale.max(vector.iter().zip(load).map(|(r, f)| (r * f).abs()).sum());
    }
    max_resultant / scale.max(f64::MIN_POSITIVE)
}

/// load − K u − f(u) − BᵀAτ.
fn out_of_balance(
    assembled: &Assembled,
    structure: &dyn Structure,
    load: &[f64],
    state: &StaticState,
) -> Result<Vec<f64>> {
    let mut residual = load.to_vec();
    assembled.stiffness.multiply_add(-1.0, &state.displacement, &mut residual);
    assembled.base.add_forces(-1.0, &state.traction, &mut residual);
    let force = nonlinear_state(structure, &state.displacement)?.0;
    residual.iter_mut().zip(&force).for_each(|(r, f)| *r -= f);
    Ok(residual)
}

/// Size of a force relative to the load: each component over the square root of its mass, so that forces and
/// moments compare in any units.
struct Measure {
    weights: Vec<f64>,
    scale: f64,
}

impl Measure {
    fn new(assembled: &Assembled, load: &[f64]) -> Self {
        let mut weights = assembled.mass.diagonal();
        for weight in &mut weights {
            *weight = if *weight > 0.0 { weight.sqrt().recip() } else { 0.0 };
        }
        let weighted = weights.iter().zip(load).map(|(w, f)| w * f.abs());
        let scale = weighted.fold(0.0_f64, f64::max);
        if scale > 0.0 && scale.is_finite() {
            return Self { weights, scale };
        }
        // Only massless degrees of freedom are loaded.
        let weights = vec![1.0; load.len()];
        Self { scale: largest(load).max(f64::MIN_POSITIVE), weights }
    }

    fn norm(&self, force: &[f64]) -> f64 {
        let weighted = self.weights.iter().zip(force).map(|(w, f)| w * f.abs());
        // Unlike `max`, the sum keeps NaN.
        let sum: f64 = force.iter().sum();
        if sum.is_finite() { weighted.fold(0.0, f64::max) / self.scale } else { f64::INFINITY }
    }
}
