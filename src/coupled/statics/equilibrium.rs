//! Equilibrium with contact conditions and a soil at rest, by proximal point iteration.

use std::cell::RefCell;
use std::rc::Rc;

use crate::contact::{ContactInput, ContactSearch, ContactSolver};
use crate::coupled::model::assembled::Assembled;
use crate::coupled::statics::compliance::{
    Compliance, Floating, PROXIMAL_SPRING_FRACTION, STATIC_STIFFNESS_NAME, springs,
};
use crate::coupled::statics::convergence::{Measure, extrapolation, has_converged, rounding};
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
/// Softest springs, as a fraction of their initial stiffness.
const MIN_SPRING_FRACTION: f64 = 1e-9;
/// Decrease of their force in an iteration above which they are softened tenfold while it exceeds `SPRING_FORCE_ROUNDING`:
/// a structure far softer than the ground deforms only slowly against springs that are stiffer than itself.
const SLOW_DECREASE_RATIO: f64 = 0.2;
/// Largest factor by which the springs are stiffened to hold a structure that leans (P–Δ) without the ground.
const MAX_STIFFENING_FACTOR: f64 = 1e4;
/// Iterations on springs that must stay stiff (P–Δ) from one extrapolation to the next.
const EXTRAPOLATION_INTERVAL: usize = 20;
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
        let assembled = self.assembled;
        let base = &assembled.base;
        let mut springs = self.springs()?;
        let initial_stiffness = springs.stiffness;
        let mut solver =
            ContactSolver::new(base.layout(), base.areas(), false, ContactSearch::Robust);
        let measure = Measure::new(assembled, load);
        let mut tangent = Tangent::new(assembled.dofs());
        let mut compliance = None::<Compliance>;
        let mut change = f64::INFINITY;
        let mut iterations = 0;
        let mut last_step = Vec::new();
        while iterations < MAX_PROXIMAL_ITERATIONS {
            iterations += 1;
            tangent.refill(self.structure, &state.displacement)?;
            let current = match compliance.take() {
                Some(current) if assembled.linear => current,
                _ => {
                    solver.invalidate();
                    self.stiffened(&mut springs, &tangent.matrix, initial_stiffness)?
                }
            };
            let current = compliance.insert(current);
            let next = self.next(current, &mut solver, (laws, start), load, &mut state)?;
            let Some(displacement) = next else { break };
            let spring_force = springs.force(assembled, &displacement, &state.displacement);
            let previous = std::mem::replace(&mut change, measure.norm(&spring_force));
            let step = difference(&displacement, &state.displacement);
            state.displacement = displacement;
            state.traction.copy_from_slice(&solver.response().traction);
            if has_converged(previous, change, iterations, current) {
                // The springs may have no force without an equilibrium, if K u is only rounding.
                let residual = imbalance(assembled, load, &state.traction);
                if residual <= FORCE_BALANCE_TOLERANCE {
                    self.share(compliance, initial_stiffness);
                    state.substituted_friction =
                        solver.substituted_friction().or(state.substituted_friction);
                    let states = &solver.response().states;
                    state.close_gaps(laws, start, states)?;
                    return Ok((state, states.clone()));
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
        Err(self.failure(&tangent.matrix, initial_stiffness, iterations, change))
    }

    /// Shares the compliance of a linear structure on its initial springs with other searches.
    fn share(&self, compliance: Option<Compliance>, initial_stiffness: f64) {
        let is_shared = |compliance: &Compliance| {
            self.assembled.linear && compliance.floating.springs == initial_stiffness
        };
        self.shared.replace(compliance.filter(is_shared));
    }

    /// Error for iterations without an equilibrium, with the condition of the matrix on the initial springs.
    ///
    /// Softened springs leave a matrix of rounding, which has no condition.
    fn failure(
        &self,
        tangent: &SparseMatrix,
        initial_stiffness: f64,
        iterations: usize,
        change: f64,
    ) -> Error {
        let initial = Floating::new(self.assembled, tangent, initial_stiffness);
        let condition = initial.map_or(1.0, |floating| floating.condition());
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

    /// Displacements of the next iterate; `None` if its contact problem has no solution.
    ///
    /// The tractions are in `solver`.
    fn next(
        &self,
        current: &Compliance,
        solver: &mut ContactSolver,
        (laws, start): (&[Box<dyn InterfaceLaw>], &PreviousContacts),
        load: &[f64],
        state: &mut StaticState,
    ) -> Result<Option<Vec<f64>>> {
        let mut displacement = self.without_traction(current, load, state)?;
        let mut means = vec![0.0; solver.response().traction.len()];
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
            trial_settlements: &[],
            frictionless: self.frictionless,
        };
        match solver.solve(&input, &mut state.modes) {
            Ok(_) => {}
            Err(StepError::Law(error)) => return Err(Error::Law(error)),
            Err(_) => return Ok(None),
        }
        let traction = &solver.response().traction;
        transposed_multiply_add(&current.columns, -1.0, traction, &mut displacement);
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
    fn springs(&self) -> Result<FictitiousSprings> {
        let stiffness = match &*self.shared.borrow() {
            Some(compliance) if self.assembled.linear => compliance.floating.springs,
            _ => springs(self.assembled, self.soil)?,
        };
        Ok(FictitiousSprings { stiffness, softest: MIN_SPRING_FRACTION * stiffness })
    }

    /// Compliance with springs stiff enough to hold a structure that leans without the ground.
    ///
    /// Each iteration then finds the smallest energy. With softer springs it may find a structure on the verge of a
    /// fall, on a corner. If springs of [`MAX_STIFFENING_FACTOR`] times `initial_stiffness` do not help (Lagrange
    /// multipliers), or rounding is the cause, they stay unchanged.
    fn stiffened(
        &self,
        springs: &mut FictitiousSprings,
        tangent: &SparseMatrix,
        initial_stiffness: f64,
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
        while stiffness <= MAX_STIFFENING_FACTOR * initial_stiffness {
            let stiffer = self.compliance(tangent, stiffness)?;
            if stiffer.floating.factor.is_positive_definite() {
                *springs = FictitiousSprings { stiffness, softest: stiffness };
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
struct FictitiousSprings {
    /// ε.
    stiffness: f64,
    /// ε down to which the springs are softened.
    softest: f64,
}

impl FictitiousSprings {
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
