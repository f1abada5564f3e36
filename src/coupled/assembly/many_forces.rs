//! Reduced coordinates for many forces.
//!
//! The space contains vibration modes up to a frequency, the static responses to all forces, and powers of K_eff of the
//! remaining responses (MacNeal 1971; Rubin 1975). It omits directions far shorter than the root of the tolerance.
//! `krylov.rs` has a table of the symbols.

use std::ops::Range;
use std::rc::Rc;

use crate::coupled::assembly::krylov::{
    FINAL_MIN_NEW_FRACTION, MIN_NEW_FRACTION, Reduction, accuracy_error,
};
use crate::coupled::assembly::step_response::{ResponseChanges, StepResponses};
use crate::coupled::assembly::subspace::{RitzModes, Subspace};
use crate::coupled::base::transformation::ModalBasis;
use crate::coupled::statics::compliance::ShiftedStiffnessFactor;
use crate::error::{Error, Result};
use crate::linalg::{ModeLimit, SparseFactor, SparseMatrix, lowest_modes};

/// Growth of the frequency limit of vibration modes from one round to the next.
const FREQUENCY_LIMIT_GROWTH: f64 = std::f64::consts::SQRT_2;
/// Largest number of vibration modes; more would take longer than the full structure.
const MAX_VIBRATION_MODES: usize = 600;
/// Residual of vibration modes, relative to the root of the tolerance.
///
/// Errors of responses depend on the square of the residual.
const MODE_RESIDUAL_FACTOR: f64 = 0.1;
/// Rounding of the vectors' orthogonality after one pass, relative to the square of the tolerance.
const ORTHOGONALITY_ROUNDING_FACTOR: f64 = 1e-4;
/// Largest number of rounds, each with more vibration modes or a further power of K_eff.
const MAX_MODE_ROUNDS: usize = 5;
/// Lowest shift for vibration modes and static responses, relative to the scheme's shift.
const MIN_STATIC_SHIFT_RATIO: f64 = 1e-2;
/// Highest shift for vibration modes and static responses, relative to the scheme's shift.
const MAX_STATIC_SHIFT_RATIO: f64 = 0.5;
/// Smallest usable square of a shift, relative to the square of the scheme's shift.
///
/// With a smaller shift, rigid motions leave too few digits for the other modes.
const MIN_SQUARED_SHIFT_RATIO: f64 = 1e-9;
/// Factor of the weakest response of a probe in the length of omitted directions.
///
/// The response is relative to the energy norms of the probe's row and of the force. For a response below the reciprocal
/// of this factor, omitted directions must be shorter than the root of the tolerance.
const WEAK_PROBE_FACTOR: f64 = 10.0;
/// Smallest factor for the square of the length of omitted directions; smaller directions are rounding.
const MIN_PROBE_FACTOR: f64 = 1e-2;
/// Number of steps over which forces grow in the comparison of responses, with binomial weights.
const FORCE_GROWTH_STEPS: usize = 32;
/// Length of omitted directions, relative to the root of the tolerance.
///
/// Errors of responses depend on the square of the length.
const OMITTED_LENGTH_FACTOR: f64 = 0.5;

/// Adds the static responses to forces to a space.
///
/// Returns the index of the first one.
///
/// `block` contains the forces.
///
/// The factor is dropped before the space grows, which limits the memory.
fn add_static_responses(
    factor: Rc<ShiftedStiffnessFactor>,
    space: &mut Subspace<'_>,
    mut block: Vec<f64>,
) -> usize {
    factor.factor.solve_many(&mut block);
    drop(factor);
    let first_response = space.count();
    space.extend(block, FINAL_MIN_NEW_FRACTION);
    first_response
}

/// Initial frequency limit of vibration modes, 1/s.
///
/// The participation of modes at the limit in responses to slowly growing forces is the tolerance.
fn first_frequency_limit(scheme_shift: f64, tolerance: f64) -> f64 {
    scheme_shift * (tolerance.powf(-2.0 / FORCE_GROWTH_STEPS as f64) - 1.0).sqrt()
}

impl Reduction<'_> {
    /// Ritz modes for many forces: vibration modes, static responses and powers of K_eff.
    ///
    /// The factor of the shifted stiffness is not stored between rounds, which would increase the peak memory. A third
    /// round, which few reductions need, factors the matrix again.
    pub(super) fn modes_for_many_forces(
        &self,
        tolerance: f64,
        matrices: [&SparseMatrix; 3],
    ) -> Result<ModalBasis> {
        let rounding = ORTHOGONALITY_ROUNDING_FACTOR * tolerance * tolerance;
        let mut space = self.rigid_motion_space(matrices, rounding);
        let rows = &self.rows.all_rows;
        let c = self.coefficients;
        let mut block = space.balanced(rows.clone());
        space.extend(self.initial_motions.clone(), FINAL_MIN_NEW_FRACTION);
        let scheme_shift = (c.acceleration[0] / c.displacement[0]).max(0.0).sqrt();
        let mut frequency_limit = first_frequency_limit(scheme_shift, tolerance);
        let mut previous_round: Option<(StepResponses, RitzModes)> = None;
        let mut converged: Option<RitzModes> = None;
        let mut products = Vec::new();
        let mut effective = None;
        let mut changes = ResponseChanges::none();
        // Index of the first vector of the last extension.
        let mut first_new_vector = 0;
        let mut min_length = OMITTED_LENGTH_FACTOR * tolerance.sqrt();
        for round in 0..MAX_MODE_ROUNDS {
            // The second round adds only a power of K_eff, for the comparison with the first.
            if round != 1 {
                let shifted_factor =
                    self.add_modes(&mut space, frequency_limit, scheme_shift, tolerance)?;
                let Some(shifted_factor) = shifted_factor else { break };
                frequency_limit *= FREQUENCY_LIMIT_GROWTH;
                if round == 0 {
                    first_new_vector = add_static_responses(shifted_factor, &mut space, block);
                    block = space.inertia(first_new_vector, c.acceleration[0]);
                    effective = Some(self.effective_factor()?);
                }
            }
            if let Some(factor) = &effective {
                factor.solve_many(&mut block);
            }
            if round == 0 && !self.probes().is_empty() {
                space.extend_products(&mut products, rows);
                min_length *= self.probe_length_factor(&space, &products)?;
            }
            if let Some((previous_responses, previous_modes)) = previous_round.take() {
                space.extend_products(&mut products, rows);
                let (modes, extended_products) = space.extended_ritz(
                    (&block, first_new_vector),
                    c,
                    (&products, rows),
                    min_length,
                )?;
                let responses = self.smooth_responses(&modes, &extended_products);
                changes.push(responses.difference(&previous_responses, tolerance));
                if changes.last_change <= tolerance {
                    converged = Some(previous_modes);
                    break;
                }
            }
            first_new_vector = space.count();
            space.extend_by_length(block, min_length);
            block = space.inertia(first_new_vector, c.acceleration[0]);
            let modes = space.ritz()?;
            if changes.next_change() <= tolerance || space.count() == self.assembled.dofs() {
                converged = Some(modes);
                break;
            }
            space.extend_products(&mut products, rows);
            previous_round = Some((self.smooth_responses(&modes, &products), modes));
        }
        let Some(modes) = converged else {
            return Err(self.slow_convergence(space.count(), changes.last_change, tolerance));
        };
        self.basis_of_modes(space, &modes, effective.as_deref(), scheme_shift, tolerance)
    }

    /// Error for powers of K_eff that do not reach the tolerance.
    fn slow_convergence(&self, vector_count: usize, change: f64, tolerance: f64) -> Error {
        let force_count = self.rows.force_count;
        let remedy = format!(
            "with {vector_count} vectors for {force_count} forces; with more than 99 forces, section forces of stiff \
             structures do not converge below it: use a tolerance of 1e-4, omit such probes, or use the degrees of freedom"
        );
        accuracy_error(change, tolerance, remedy)
    }

    /// The modal basis in degrees of freedom.
    fn basis_of_modes(
        &self,
        space: Subspace<'_>,
        modes: &RitzModes,
        effective: Option<&SparseFactor>,
        scheme_shift: f64,
        tolerance: f64,
    ) -> Result<ModalBasis> {
        if self.damping_without_p_delta.is_none() {
            return Ok(space.basis(modes));
        }
        let shifted_factor = self.shifted_stiffness_factor(scheme_shift)?;
        let factors: Vec<_> = effective.into_iter().chain([&shifted_factor.factor]).collect();
        self.basis_with_damping(space, modes, &factors, tolerance)
    }

    /// Indices of the rows of displacements and velocities of probes.
    fn probes(&self) -> Range<usize> {
        self.rows.force_count..self.rows.first_acceleration
    }

    /// Factor for the length of omitted directions, for the weakest response of a probe.
    fn probe_length_factor(&self, space: &Subspace<'_>, products: &[f64]) -> Result<f64> {
        let responses = self.smooth_responses(&space.ritz()?, products);
        Ok((WEAK_PROBE_FACTOR * responses.weakest_response(self.probes()))
            .clamp(MIN_PROBE_FACTOR, 1.0)
            .sqrt())
    }

    /// Adds the vibration modes up to a frequency limit, 1/s.
    ///
    /// Returns the factor for static responses. The result is `None` if there are too many modes.
    fn add_modes(
        &self,
        space: &mut Subspace<'_>,
        frequency_limit: f64,
        scheme_shift: f64,
        tolerance: f64,
    ) -> Result<Option<Rc<ShiftedStiffnessFactor>>> {
        let shifted_factor = self.shifted_stiffness_factor(scheme_shift)?;
        let max_eigenvalue = frequency_limit * frequency_limit + shifted_factor.shift;
        let max_residual = MODE_RESIDUAL_FACTOR * tolerance.sqrt();
        let modes = lowest_modes(
            &shifted_factor.factor,
            &self.assembled.mass,
            MAX_VIBRATION_MODES,
            Some(ModeLimit { eigenvalue: max_eigenvalue, residual_tolerance: max_residual }),
        );
        let all_modes = modes.filter(|modes| modes.values.len() < MAX_VIBRATION_MODES);
        Ok(all_modes.map(|modes| {
            // A small new component is the error of a mode already in the basis, not a new direction: skip it.
            space.extend(modes.vectors, MIN_NEW_FRACTION);
            shifted_factor
        }))
    }

    /// Responses to forces that grow over [`FORCE_GROWTH_STEPS`] steps.
    fn smooth_responses(&self, modes: &RitzModes, products: &[f64]) -> StepResponses {
        self.responses(modes, Subspace::modal_rows(modes, products), FORCE_GROWTH_STEPS)
    }

    /// Factors K + σ²M, or returns the static state's factor if its shift is usable.
    fn shifted_stiffness_factor(&self, scheme_shift: f64) -> Result<Rc<ShiftedStiffnessFactor>> {
        if let Some(shifted) = self.shifted_stiffness.take()
            && shifted.factor.is_positive_definite()
            && shifted.shift > MIN_SQUARED_SHIFT_RATIO * scheme_shift * scheme_shift
        {
            return Ok(shifted);
        }
        let min_shift = MIN_STATIC_SHIFT_RATIO * scheme_shift;
        let max_shift = MAX_STATIC_SHIFT_RATIO * scheme_shift;
        let shift = self.fixed_base.lowest_frequency.clamp(min_shift, max_shift);
        ShiftedStiffnessFactor::new(self.assembled, &SparseMatrix::default(), shift * shift)
            .map(Rc::new)
    }
}
