//! Static equilibrium with contact conditions, by proximal point iteration.

use std::borrow::Cow;
use std::cell::RefCell;
use std::rc::Rc;

use crate::contact::{ContactInput, ContactSearch, ContactSolver};
use crate::coupled::model::assembled::Assembled;
use crate::coupled::statics::compliance::{
    Compliance, PROXIMAL_SPRING_FRACTION, STATIC_STIFFNESS_NAME, ShiftedStiffnessFactor,
    initial_shift,
};
use crate::coupled::statics::convergence::{
    RelativeForceNorm, extrapolation_factor, has_converged, spring_force_rounding,
};
use crate::coupled::statics::fictitious_springs::{FictitiousSprings, difference};
use crate::coupled::statics::imbalance::{
    force_rounding, imbalance, joint_element_that_moves_most, unbalanced_force,
};
use crate::coupled::statics::prescribed_displacement::PrescribedDisplacement;
use crate::coupled::statics::shortened_increment::ShortenedIncrement;
use crate::coupled::statics::static_state::StaticState;
use crate::error::{Error, Result, StepError};
use crate::interface::{ContactState, InterfaceLaw, PreviousContacts};
use crate::linalg::{CompressedMatrix, SparseMatrix, largest, transposed_multiply_add};
use crate::structure::{Structure, Tangent};

/// Largest unbalanced force of an equilibrium, relative to the load.
const FORCE_BALANCE_TOLERANCE: f64 = 1e-7;
/// Largest unbalanced force within a nonlinear structure, relative to the load.
///
/// It is above the rounding of K u + f(u) at the largest accepted condition, about 2e-6.
const INNER_FORCE_TOLERANCE: f64 = 1e-5;
/// Largest rounding of the forces within a nonlinear structure that is accepted in place of [`INNER_FORCE_TOLERANCE`].
///
/// Elements of a few millimetres have stiffnesses far above those of the structure, and masses far below.
const MAX_INNER_ROUNDING: f64 = 1e-3;
/// Condition beyond which rounding of K u exceeds the tolerance of the force balance (`tests/coupled/conditioning.rs`).
const MAX_ACCEPTED_CONDITION: f64 = 1e10;
/// Largest number of proximal iterations.
const MAX_PROXIMAL_ITERATIONS: usize = 500;
/// Smallest stiffness of the springs, as a fraction of their initial stiffness.
const MIN_SPRING_FRACTION: f64 = 1e-9;
/// Ratio of successive spring forces above which the springs are softened tenfold.
///
/// A structure far softer than the ground converges only slowly with springs that are stiffer than itself.
const SLOW_DECREASE_RATIO: f64 = 0.2;
/// Largest factor by which the springs are stiffened.
///
/// A structure with P–Δ that is unstable without the ground needs stiffer springs.
const MAX_STIFFENING_FACTOR: f64 = 1e4;
/// Number of iterations between two extrapolations, for springs that must stay stiff (P–Δ).
const EXTRAPOLATION_INTERVAL: usize = 20;
/// Factor between two trial stiffnesses of the springs.
const SPRING_STIFFENING_FACTOR: f64 = 10.0;

/// Static problem of a structure on its ground.
pub(crate) struct StaticProblem<'a> {
    pub(crate) assembled: &'a Assembled,
    pub(crate) structure: &'a dyn Structure,
    /// Static compliance of the ground.
    pub(crate) ground_compliance: &'a CompressedMatrix,
    /// Whether the laws act without friction and cohesion; only in plan.
    pub(crate) is_frictionless: bool,
    /// Jumps in addition to the jumps of displacements and tractions, m; empty for none.
    pub(crate) jump_offset: &'a [f64],
    /// Compliance of a linear structure on its initial springs, which the stages share.
    pub(crate) shared_compliance: &'a RefCell<Option<Compliance>>,
    /// Whether a search without a solution begins anew, with shortened increments.
    pub(crate) may_shorten_increments: bool,
    /// Load pattern whose factor follows from a displacement; `None` for constant loads.
    pub(crate) prescribed_displacement: Option<&'a PrescribedDisplacement<'a>>,
}

/// End of an iteration: displacement, and factor of the load pattern.
struct Iterate {
    displacement: Vec<f64>,
    load_factor: f64,
}

impl StaticProblem<'_> {
    /// Computes the displacement u and the tractions τ under `load`.
    ///
    /// They satisfy K u + f(u) + BᵀA τ = `load` and the static contact conditions.
    ///
    /// K alone is singular (rigid-body modes), and the settlement of a half-plane has no datum. Springs ε M to the last
    /// iterate make each iteration regular, and their forces vanish at convergence (proximal point method). f is linearised
    /// at each iterate (Newton's method). The search starts from `state`, the end of the previous stage. `start` has the
    /// contact of this state for the laws. The result also contains the contact state of each element.
    ///
    /// Newton's method may pass the balance of a yielding structure for ever. Without a solution the search therefore begins
    /// anew, with increments that end where the forces do no work on them.
    pub(crate) fn equilibrium(
        &self,
        laws: &[Box<dyn InterfaceLaw>],
        start: &PreviousContacts,
        state: StaticState,
        load: &[f64],
    ) -> Result<(StaticState, Vec<ContactState>)> {
        if self.assembled.is_linear || !self.may_shorten_increments {
            return self.search(laws, start, state, load, false);
        }
        self.search(laws, start, state.clone(), load, false).or_else(|error| {
            let short_search = self.search(laws, start, state, load, true);
            short_search.map_err(|_| error)
        })
    }

    /// The search, with increments that are shortened or not.
    fn search(
        &self,
        laws: &[Box<dyn InterfaceLaw>],
        start: &PreviousContacts,
        mut state: StaticState,
        load: &[f64],
        has_short_increments: bool,
    ) -> Result<(StaticState, Vec<ContactState>)> {
        let assembled = self.assembled;
        let base = &assembled.base;
        let mut springs = self.springs()?;
        let initial_shift = springs.shift;
        let mut solver =
            ContactSolver::new(base.layout(), base.areas(), false, ContactSearch::Robust);
        let mut relative_norm = RelativeForceNorm::new(assembled, load);
        let start_displacement = state.displacement.clone();
        let mut tangent = Tangent::new(assembled.dofs());
        let mut stored_compliance = None::<Compliance>;
        let mut change = f64::INFINITY;
        let mut iterations = 0;
        let mut last_step = Vec::new();
        let mut short_increment =
            has_short_increments.then(|| ShortenedIncrement::new(assembled, self.structure));
        while iterations < MAX_PROXIMAL_ITERATIONS {
            iterations += 1;
            tangent.refill(self.structure, &state.displacement)?;
            let compliance = match stored_compliance.take() {
                Some(compliance) if assembled.is_linear => compliance,
                _ => {
                    solver.invalidate();
                    self.stiffened_compliance(&mut springs, &tangent.matrix, initial_shift)?
                }
            };
            let compliance = stored_compliance.insert(compliance);
            let iterate =
                self.next_iterate(compliance, &mut solver, (laws, start), load, &mut state)?;
            let Some(Iterate { mut displacement, load_factor }) = iterate else { break };
            let mut traction = solver.response().traction.clone();
            let start_load = self.applied_load(load, state.load_factor);
            let end_load = self.applied_load(load, load_factor);
            if self.prescribed_displacement.is_some() {
                relative_norm = RelativeForceNorm::new(assembled, &end_load);
            }
            let mut position = 1.0;
            if let Some(increment) = &mut short_increment {
                let loads = [&*start_load, &*end_load];
                let end = (&mut *displacement, &mut *traction);
                position = increment.shorten(&relative_norm, &state, loads, springs.shift, end)?;
            }
            let is_shortened = position < 1.0;
            let spring_force = springs.force(assembled, &displacement, &state.displacement);
            let previous_change = std::mem::replace(&mut change, relative_norm.of(&spring_force));
            let step = difference(&displacement, &state.displacement);
            state.displacement = displacement;
            state.traction = traction;
            if is_shortened {
                state.load_factor += position * (load_factor - state.load_factor);
                last_step = step;
                continue;
            }
            state.load_factor = load_factor;
            if has_converged(previous_change, change, iterations, compliance) {
                // If K u is only rounding, the springs may have no force without an equilibrium.
                let residual = imbalance(assembled, &end_load, &state.traction);
                let inner_residual = self.yielding_residual(&relative_norm, load, &state)?;
                let matrices = [&*assembled.stiffness, &tangent.matrix];
                let rounding = force_rounding(&relative_norm, matrices, &state.displacement);
                let inner_tolerance = rounding.clamp(INNER_FORCE_TOLERANCE, MAX_INNER_ROUNDING);
                if residual <= FORCE_BALANCE_TOLERANCE && inner_residual <= inner_tolerance {
                    self.share(stored_compliance, initial_shift);
                    state.substituted_friction =
                        solver.substituted_friction().or(state.substituted_friction);
                    let states = &solver.response().states;
                    state.set_gaps(laws, start, states)?;
                    return Ok((state, states.clone()));
                }
                change = residual.max(inner_residual);
                last_step = step;
                break;
            }
            if !change.is_finite() {
                break;
            }
            let rounding = spring_force_rounding(iterations, compliance);
            let decreases_slowly = change > rounding.max(SLOW_DECREASE_RATIO * previous_change);
            if decreases_slowly && springs.soften() {
                stored_compliance = None;
                solver.invalidate();
            } else if springs.must_stay_stiff() && iterations.is_multiple_of(EXTRAPOLATION_INTERVAL)
            {
                // Close to buckling, one shape converges slowly.
                let factor = extrapolation_factor(&assembled.mass, &last_step, &step);
                state.displacement.iter_mut().zip(&step).for_each(|(u, d)| *u += factor * d);
            }
            last_step = step;
        }
        // Springs on a structure that yields without limit may have little force far from an equilibrium.
        if let Ok(residual) = self.yielding_residual(&relative_norm, load, &state) {
            change = change.max(residual);
        }
        let joint_element = joint_element_that_moves_most(&assembled.base, &last_step);
        let error = Error::Preload { iterations, residual: change, joint_element };
        // The tangent of a structure that yields without limit is unrelated to the ground; the first one is used.
        tangent.refill(self.structure, &start_displacement)?;
        Err(self.ill_conditioned(&tangent.matrix, initial_shift).unwrap_or(error))
    }

    /// The constant load with the load pattern times its factor.
    fn applied_load<'l>(&self, load: &'l [f64], load_factor: f64) -> Cow<'l, [f64]> {
        match self.prescribed_displacement {
            None => Cow::Borrowed(load),
            Some(target) => {
                let forces = load.iter().zip(target.pattern);
                Cow::Owned(forces.map(|(force, p)| force + load_factor * p).collect())
            }
        }
    }

    /// Unbalanced force of a nonlinear structure, relative to the load; zero for a linear one.
    ///
    /// A structure that yields without limit under its load moves until an iteration adds less than the last digit of
    /// its displacement. The springs then have no force, although nothing is in equilibrium.
    fn yielding_residual(
        &self,
        relative_norm: &RelativeForceNorm,
        load: &[f64],
        state: &StaticState,
    ) -> Result<f64> {
        if self.assembled.is_linear {
            return Ok(0.0);
        }
        let load = self.applied_load(load, state.load_factor);
        let force = unbalanced_force(self.assembled, self.structure, &load, state)?;
        Ok(relative_norm.of(&force))
    }

    /// Shares the compliance of a linear structure on its initial springs with later searches.
    fn share(&self, compliance: Option<Compliance>, initial_shift: f64) {
        let can_share = |compliance: &Compliance| {
            self.assembled.is_linear && compliance.factor.shift == initial_shift
        };
        self.shared_compliance.replace(compliance.filter(can_share));
    }

    /// Error for a search without an equilibrium whose matrix is ill-conditioned; `None` for another matrix.
    ///
    /// It has the condition number of the matrix with the initial springs. With soft springs the matrix contains only
    /// rounding in rigid motions.
    fn ill_conditioned(&self, tangent: &SparseMatrix, initial_shift: f64) -> Option<Error> {
        let initial_factor = ShiftedStiffnessFactor::new(self.assembled, tangent, initial_shift);
        let condition = initial_factor.map_or(1.0, |factor| factor.condition());
        (condition > MAX_ACCEPTED_CONDITION).then_some(Error::IllConditioned {
            matrix: STATIC_STIFFNESS_NAME,
            condition,
            limit: MAX_ACCEPTED_CONDITION,
            quantity: "stiffness of the structure over that of the ground",
            ratio: PROXIMAL_SPRING_FRACTION * condition,
        })
    }

    /// The next iterate; `None` if its contact problem has no solution.
    ///
    /// The tractions are stored in `solver`.
    fn next_iterate(
        &self,
        compliance: &Compliance,
        solver: &mut ContactSolver,
        (laws, start): (&[Box<dyn InterfaceLaw>], &PreviousContacts),
        load: &[f64],
        state: &mut StaticState,
    ) -> Result<Option<Iterate>> {
        let Iterate { mut displacement, mut load_factor } =
            self.iterate_without_traction(compliance, load, state)?;
        let mut means = vec![0.0; solver.response().traction.len()];
        self.assembled.base.means(&displacement, &mut means);
        let mut free_jump: Vec<f64> = means.iter().map(|mean| -mean).collect();
        free_jump.iter_mut().zip(self.jump_offset).for_each(|(jump, offset)| *jump += offset);
        let input = ContactInput {
            delassus: &compliance.delassus,
            free_jump: &free_jump,
            static_traction: &vec![0.0; free_jump.len()],
            start,
            laws,
            length_scale: largest(&free_jump),
            bonds: &[],
            trial_lines: &[],
            frictionless: self.is_frictionless,
        };
        match solver.solve(&input, &mut state.modes) {
            Ok(_) => {}
            Err(StepError::Law(error)) => return Err(Error::Law(error)),
            Err(_) => return Ok(None),
        }
        let traction = &solver.response().traction;
        transposed_multiply_add(&compliance.traction_responses, -1.0, traction, &mut displacement);
        if let Some(response) = &compliance.pattern_response {
            load_factor += response.factor_of_tractions(&state.traction, traction);
        }
        Ok(Some(Iterate { displacement, load_factor }))
    }

    /// The next iterate without the response to its tractions τ₁.
    ///
    /// (K + D + εM) (u₁ − u₀) = load − K u₀ − f(u₀) − BᵀAτ₁. With the springs alone the structure would settle
    /// 1/`PROXIMAL_SPRING_FRACTION` times as much as on the ground. The system is therefore solved for the unbalanced force
    /// only, and the response to the last tractions τ₀ is added with the traction responses of the compliance.
    fn iterate_without_traction(
        &self,
        compliance: &Compliance,
        load: &[f64],
        state: &StaticState,
    ) -> Result<Iterate> {
        let mut load_factor = state.load_factor;
        let load = self.applied_load(load, load_factor);
        let mut displacement = unbalanced_force(self.assembled, self.structure, &load, state)?;
        if let Some(target) = self.prescribed_displacement {
            let remainder = target.missing_displacement(&state.displacement);
            target.add_spring_force(remainder, &mut displacement);
        }
        compliance.factor.factor.solve_many(&mut displacement);
        if let (Some(target), Some(response)) =
            (self.prescribed_displacement, &compliance.pattern_response)
        {
            let remainder = target.missing_displacement(&state.displacement);
            load_factor += response.move_control(target.control, remainder, &mut displacement);
        }
        for (d, u) in displacement.iter_mut().zip(&state.displacement) {
            *d += u;
        }
        let responses = &compliance.traction_responses;
        transposed_multiply_add(responses, 1.0, &state.traction, &mut displacement);
        Ok(Iterate { displacement, load_factor })
    }

    /// The springs of the shared compliance, or the initial springs without one.
    fn springs(&self) -> Result<FictitiousSprings> {
        let shift = match &*self.shared_compliance.borrow() {
            Some(compliance) if self.assembled.is_linear => compliance.factor.shift,
            _ => initial_shift(self.assembled, self.ground_compliance)?,
        };
        Ok(FictitiousSprings { shift, min_shift: MIN_SPRING_FRACTION * shift })
    }

    /// Compliance with springs stiff enough for a structure that is unstable without the ground.
    ///
    /// Each iteration then minimises the energy. With softer springs it may end at an unstable equilibrium, for
    /// example of a block on its corner. The springs stay unchanged if a factor of [`MAX_STIFFENING_FACTOR`] is not sufficient
    /// (Lagrange multipliers), if rounding is the cause, or if the tangent is not symmetric and so has no energy.
    fn stiffened_compliance(
        &self,
        springs: &mut FictitiousSprings,
        tangent: &SparseMatrix,
        initial_shift: f64,
    ) -> Result<Compliance> {
        let mut cell = self.shared_compliance.borrow_mut();
        if self.assembled.is_linear
            && let Some(compliance) = cell.take_if(|stored| stored.factor.shift == springs.shift)
        {
            return Ok(compliance);
        }
        drop(cell);
        let compliance = self.compliance(tangent, springs.shift)?;
        if compliance.factor.factor.is_positive_definite()
            || !tangent.is_symmetric()
            || compliance.factor.condition() > MAX_ACCEPTED_CONDITION
        {
            return Ok(compliance);
        }
        let mut shift = SPRING_STIFFENING_FACTOR * springs.shift;
        while shift <= MAX_STIFFENING_FACTOR * initial_shift {
            let stiffer_compliance = self.compliance(tangent, shift)?;
            if stiffer_compliance.factor.factor.is_positive_definite() {
                *springs = FictitiousSprings { shift, min_shift: shift };
                return Ok(stiffer_compliance);
            }
            shift *= SPRING_STIFFENING_FACTOR;
        }
        Ok(compliance)
    }

    /// Compliance with springs of stiffness `shift` per mass.
    fn compliance(&self, tangent: &SparseMatrix, shift: f64) -> Result<Compliance> {
        let Self { assembled, ground_compliance, prescribed_displacement: target, .. } = *self;
        let spring = match target {
            Some(target) => target.spring(assembled.dofs())?,
            None => SparseMatrix::default(),
        };
        let factor = ShiftedStiffnessFactor::with_spring(assembled, tangent, shift, &spring)?;
        Compliance::with_control(Rc::new(factor), &assembled.base, ground_compliance, target)
    }
}
