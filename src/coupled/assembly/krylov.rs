//! Reduced coordinates: Ritz modes of a rational block Krylov space.
//!
//! | symbol | meaning |
//! |---|---|
//! | F | weights of the degrees of freedom in forces and in probes, a row each |
//! | a, d | factors of Δu in the scheme's acceleration and displacement |
//! | σ | shifts; the first is the shift √(a/d) of the time scheme, 2/Δt for the midpoint rule |
//! | Z | K_eff for the scheme's shift, K + σ² M for the others |
//!
//! The space contains rigid motions and Z⁻¹Fᵀ, Z⁻¹M Z⁻¹Fᵀ and so on. Each round adds one power of every shift (Ruhe 1984;
//! Grimme 1997). Each power of K_eff makes the response exact for two more steps after a change of traction. Lower shifts
//! represent the few modes at lower frequencies, which are complete after a few rounds. One higher shift represents motion
//! that the time step does not resolve. With many forces: `many_forces.rs`.

use std::cell::Cell;
use std::rc::Rc;

use crate::coupled::assembly::fixed_base_results::FixedBaseResponses;
use crate::coupled::assembly::response_rows::ResponseRows;
use crate::coupled::assembly::step_response::{ResponseChanges, StepResponses};
use crate::coupled::assembly::subspace::{REDUCED_COORDINATES_NAME, RitzModes, Subspace};
use crate::coupled::assembly::vibration_modes::ASYMMETRY_TOLERANCE;
use crate::coupled::base::transformation::ModalBasis;
use crate::coupled::model::assembled::Assembled;
use crate::coupled::parts::Parts;
use crate::coupled::scheme::SchemeCoefficients;
use crate::coupled::statics::compliance::ShiftedStiffnessFactor;
use crate::error::{Error, Result, finite, require, require_part};
use crate::linalg::{SparseFactor, SparseMatrix};
use crate::structure::proportional_factors;

/// Ratio of two successive shifts: powers of both then converge at all frequencies between them.
const SHIFT_RATIO: f64 = 4.0;
/// Number of forces from which vibration modes and static responses replace shifts.
const MANY_FORCES_THRESHOLD: usize = 100;
/// A direction is added if at least this fraction of it is outside the space.
pub(super) const MIN_NEW_FRACTION: f64 = 1e-2;
/// Smallest fraction of a direction outside the space, relative to the root of the tolerance.
///
/// Errors of responses depend on the square of an omitted fraction.
const NEW_FRACTION_PER_ROOT_TOLERANCE: f64 = 10.0;
/// Smallest fraction of a direction outside the space in the last rounds.
pub(super) const FINAL_MIN_NEW_FRACTION: f64 = 1e-7;
/// Factor of the smallest fraction for a repetition that finds no new direction.
const NEW_FRACTION_REDUCTION: f64 = 1e-2;
/// Largest number of rounds.
///
/// The reduction ends after half of them if it will not reach the tolerance.
const MAX_KRYLOV_ROUNDS: usize = 16;
/// Smallest ratio of the lowest shift to the scheme's shift.
///
/// It limits the number of shifts to about ten.
const MIN_SHIFT_RATIO: f64 = 1e-6;
/// Largest number of steps over which responses are compared; it bounds the time of a comparison.
const MAX_COMPARED_STEPS: usize = 10_000;
/// Name of K + σ²M in errors.
const DYNAMIC_STIFFNESS_NAME: &str = "dynamic stiffness matrix";

/// Function that factors K_eff.
pub(crate) type FactorEffective<'a> = dyn Fn() -> Result<Box<SparseFactor>> + 'a;

/// Input of a reduction to Ritz modes.
pub(crate) struct Reduction<'a> {
    pub(super) assembled: &'a Assembled,
    pub(super) coefficients: &'a SchemeCoefficients,
    pub(super) factor_effective: &'a FactorEffective<'a>,
    pub(super) fixed_base: FixedBaseResponses,
    /// Factored K + εM, until it is used.
    pub(super) shifted_stiffness: Cell<Option<Rc<ShiftedStiffnessFactor>>>,
    /// β and α of a damping in proportion to mass and to the stiffness without P–Δ.
    pub(super) damping_without_p_delta: Option<[f64; 2]>,
    /// Number of steps of the run.
    step_count: usize,
    /// Rows of forces and probes.
    pub(super) rows: ResponseRows,
    /// Initial displacement and velocity, which the modes must contain.
    pub(super) initial_motions: Vec<f64>,
}

impl<'a> Reduction<'a> {
    /// Collects the forces, initial motions and probes of a structure for a run of `step_count` steps.
    ///
    /// The tuple has the responses on a fixed base, the factored K + εM if it exists, and a function that factors K_eff.
    pub(crate) fn new(
        parts: &'a Parts,
        assembled: &'a Assembled,
        (fixed_base, shifted_stiffness, factor_effective): (
            FixedBaseResponses,
            Option<Rc<ShiftedStiffnessFactor>>,
            &'a FactorEffective<'a>,
        ),
        step_count: usize,
    ) -> Result<Self> {
        let rows = ResponseRows::new(parts, assembled, step_count)?;
        let builder = &parts.builder;
        let initial_motions =
            [&builder.initial_displacement[..], &builder.initial_velocity[..]].concat();
        let damping = &assembled.damping;
        let is_proportional = damping.is_empty()
            || proportional_factors(damping, [&assembled.stiffness, &assembled.mass]).is_some();
        let damping_without_p_delta = if is_proportional {
            None
        } else {
            assembled.damping_without_p_delta(parts.structure.as_ref())
        };
        Ok(Self {
            assembled,
            coefficients: &parts.coefficients,
            factor_effective,
            fixed_base,
            shifted_stiffness: Cell::new(shifted_stiffness),
            damping_without_p_delta,
            step_count,
            rows,
            initial_motions,
        })
    }

    /// Computes Ritz modes whose responses to forces have errors below `tolerance`.
    pub(crate) fn modes(&self, tolerance: f64) -> Result<ModalBasis> {
        const TOLERANCE_NAME: &str = "tolerance of reduced coordinates";
        finite(TOLERANCE_NAME, tolerance)?;
        require(
            TOLERANCE_NAME,
            tolerance,
            tolerance > 0.0 && tolerance < 1.0,
            "above 0 and below 1",
        )?;
        let matrices = self.checked_matrices()?;
        if self.has_many_forces() {
            return self.modes_for_many_forces(tolerance, matrices);
        }
        self.modes_for_few_forces(tolerance, matrices)
    }

    /// Whether vibration modes and static responses replace shifts.
    pub(super) fn has_many_forces(&self) -> bool {
        self.rows.force_count >= MANY_FORCES_THRESHOLD
    }

    /// Subspace of the rigid motions; `rounding` as for [`Subspace::new`].
    pub(super) fn rigid_motion_space<'m>(
        &self,
        matrices: [&'m SparseMatrix; 3],
        rounding: f64,
    ) -> Subspace<'m> {
        let translations = self.assembled.influence.part_vectors(self.assembled.dofs());
        let mut space = Subspace::new(matrices, translations, rounding);
        if let Some(damping_factors) = self.damping_without_p_delta {
            space = space.with_proportional_damping(damping_factors);
        }
        space.extend(self.fixed_base.rotations.clone(), FINAL_MIN_NEW_FRACTION);
        space
    }

    /// Ritz modes for few forces: powers of several shifts.
    fn modes_for_few_forces(
        &self,
        tolerance: f64,
        matrices: [&SparseMatrix; 3],
    ) -> Result<ModalBasis> {
        let mut space = self.rigid_motion_space(matrices, 0.0);
        space.extend(self.initial_motions.clone(), FINAL_MIN_NEW_FRACTION);
        let rows = &self.rows.all_rows;
        self.shifted_stiffness.take();
        let effective = self.effective_factor()?;
        let shifted_factors = self
            .shifts()
            .map(|shift| self.factor_of_sum(shift * shift, 1.0))
            .collect::<Result<Vec<_>>>()?;
        let factors: Vec<_> = std::iter::once(&*effective).chain(&shifted_factors).collect();
        let mut blocks = vec![rows.clone(); factors.len()];
        let mut products = Vec::new();
        let mut min_fraction =
            MIN_NEW_FRACTION.min(NEW_FRACTION_PER_ROOT_TOLERANCE * tolerance.sqrt());
        let mut previous_responses: Option<StepResponses> = None;
        let mut changes = ResponseChanges::none();
        for round in 1..=MAX_KRYLOV_ROUNDS {
            if !add_powers(&mut space, &factors, &mut blocks, min_fraction) {
                if min_fraction <= FINAL_MIN_NEW_FRACTION {
                    let modes = space.ritz()?;
                    return self.basis_with_damping(space, &modes, &factors, tolerance);
                }
                // Repeat with a lower limit for omitted directions.
                min_fraction = FINAL_MIN_NEW_FRACTION.max(NEW_FRACTION_REDUCTION * min_fraction);
                blocks.fill(rows.clone());
                continue;
            }
            let modes = space.ritz()?;
            space.extend_products(&mut products, rows);
            let modal_rows = Subspace::modal_rows(&modes, &products);
            let responses = self.responses(&modes, modal_rows, 0);
            if let Some(previous) = &previous_responses {
                changes.push(responses.difference(previous, tolerance));
            }
            if changes.next_change() <= tolerance || space.count() == self.assembled.dofs() {
                return self.basis_with_damping(space, &modes, &factors, tolerance);
            }
            let remaining_rounds = i32::try_from(MAX_KRYLOV_ROUNDS - round).unwrap_or(0);
            let final_change = changes.next_change() * changes.change_ratio.powi(remaining_rounds);
            if 2 * round >= MAX_KRYLOV_ROUNDS && final_change > tolerance {
                break;
            }
            previous_responses = Some(responses);
        }
        let vector_count = space.count();
        let remedy =
            format!("with {vector_count} vectors; damping in proportion to stiffness helps");
        Err(accuracy_error(changes.next_change(), tolerance, remedy))
    }

    /// Factors K_eff; a damping that is proportional but for P–Δ is made proportional.
    pub(super) fn effective_factor(&self) -> Result<Box<SparseFactor>> {
        let Some([beta, alpha]) = self.damping_without_p_delta else {
            return (self.factor_effective)();
        };
        let c = self.coefficients;
        let mass_factor = c.acceleration[0] + c.velocity[0] * alpha;
        let stiffness_factor = c.displacement[0] + c.velocity[0] * beta;
        self.factor_of_sum(mass_factor, stiffness_factor).map(Box::new)
    }

    /// Responses over the steps of the run to forces that grow over `growth_steps` steps.
    pub(super) fn responses(
        &self,
        modes: &RitzModes,
        modal_rows: Vec<f64>,
        growth_steps: usize,
    ) -> StepResponses {
        let steps = self.step_count.clamp(1, MAX_COMPARED_STEPS);
        StepResponses::new(modes, modal_rows, &self.rows, self.coefficients, steps, growth_steps)
    }

    /// Mass, damping and stiffness; an error if the structure cannot be reduced.
    fn checked_matrices(&self) -> Result<[&SparseMatrix; 3]> {
        require_part(
            REDUCED_COORDINATES_NAME,
            self.assembled.is_linear,
            "they need a linear structure",
        )?;
        let matrices = self.assembled.matrices();
        let names = ["mass matrix", "damping matrix", "stiffness matrix"];
        for (matrix, name) in matrices.iter().zip(names) {
            if matrix.asymmetry() > ASYMMETRY_TOLERANCE {
                let error = Error::Scene { quantity: name, needed: "it must be symmetric" };
                return Err(error.within(REDUCED_COORDINATES_NAME));
            }
        }
        if !self.assembled.is_massive {
            let needed = "it must be positive definite";
            let error = Error::Scene { quantity: names[0], needed };
            return Err(error.within(REDUCED_COORDINATES_NAME));
        }
        Ok(matrices)
    }

    /// One shift above the scheme's shift, and the shifts below it, 1/s.
    fn shifts(&self) -> impl Iterator<Item = f64> + use<> {
        let Assembled { mass, stiffness, .. } = self.assembled;
        let pairs = stiffness.diagonal().into_iter().zip(mass.diagonal());
        let max_shift = pairs.fold(0.0, |max: f64, (k, m)| max.max(k / m)).sqrt();
        let c = self.coefficients;
        let scheme_shift =
            (c.acceleration[0] / c.displacement[0]).sqrt().min(SHIFT_RATIO * max_shift);
        let min_shift = self.fixed_base.lowest_frequency.max(MIN_SHIFT_RATIO * scheme_shift);
        let next_shift = scheme_shift / SHIFT_RATIO;
        let lower_shifts =
            std::iter::successors(Some(next_shift), |shift| Some(shift / SHIFT_RATIO))
                .take_while(move |shift| *shift > min_shift);
        let higher_shift = std::iter::once(SHIFT_RATIO * scheme_shift);
        higher_shift.chain(lower_shifts).filter(move |shift| *shift < max_shift)
    }

    /// Factors the sum of the mass and the stiffness with these factors.
    fn factor_of_sum(&self, mass_factor: f64, stiffness_factor: f64) -> Result<SparseFactor> {
        let Assembled { mass, stiffness, elimination, .. } = self.assembled;
        let terms = [(mass_factor, &**mass), (stiffness_factor, &**stiffness)];
        let matrix = SparseMatrix::sum(DYNAMIC_STIFFNESS_NAME, mass.order(), &terms)?;
        SparseFactor::with_elimination(DYNAMIC_STIFFNESS_NAME, &matrix, elimination)
    }
}

/// Adds the next power of each shift; returns whether there is a new direction.
fn add_powers(
    space: &mut Subspace<'_>,
    factors: &[&SparseFactor],
    blocks: &mut [Vec<f64>],
    min_fraction: f64,
) -> bool {
    let initial_count = space.count();
    for (factor, block) in factors.iter().zip(blocks) {
        let first_new = space.count();
        factor.solve_many(block);
        space.extend(std::mem::take(block), min_fraction);
        block.extend_from_slice(space.momenta(first_new));
    }
    space.count() > initial_count
}

/// Error for reduced coordinates that do not reach a tolerance.
pub(super) fn accuracy_error(reached: f64, tolerance: f64, remedy: String) -> Error {
    let quantity = "response of reduced coordinates to tractions";
    Error::Accuracy { quantity, reached, tolerance, remedy }
}
