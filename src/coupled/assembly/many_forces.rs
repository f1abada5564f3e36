//! Reduced coordinates for many forces.
//!
//! The space holds vibration modes up to a frequency, the static responses to all forces, and powers of K_eff of what
//! they leave (MacNeal 1971; Rubin 1975), without directions far shorter than the root of the tolerance. Symbols: see
//! `krylov.rs`.

use std::ops::Range;
use std::rc::Rc;

use crate::coupled::assembly::krylov::{
    FINAL_MIN_NEW_FRACTION, MIN_CHANGE_RATIO, MIN_NEW_FRACTION, Reduction, inaccurate,
};
use crate::coupled::assembly::step_response::StepResponses;
use crate::coupled::assembly::subspace::{Ritz, Subspace};
use crate::coupled::base::transformation::ModalBasis;
use crate::coupled::statics::compliance::Floating;
use crate::error::{Error, Result};
use crate::linalg::{SparseFactor, SparseMatrix, lowest_modes};

/// Growth of the limit of frequency of vibration modes, from a round to the next.
const FREQUENCY_LIMIT_GROWTH: f64 = std::f64::consts::SQRT_2;
/// Largest number of vibration modes.
const MAX_VIBRATION_MODES: usize = 600;
/// Residual of vibration modes, relative to the root of the tolerance: responses depend on its square.
const MODE_RESIDUAL_FACTOR: f64 = 0.1;
/// Rounding of the vectors' orthogonality after one pass, relative to the square of the tolerance.
const ORTHOGONALITY_ROUNDING_FACTOR: f64 = 1e-4;
/// Largest number of rounds with vibration modes.
const MAX_MODE_ROUNDS: usize = 5;
/// Lowest and highest shift for vibration modes and static responses, relative to the scheme's.
const STATIC_SHIFT_RANGE: [f64; 2] = [1e-2, 0.5];
/// Smallest square of a shift for vibration modes, relative to the scheme's: θ of a rigid motion leaves digits for others.
const MIN_SQUARED_SHIFT_RATIO: f64 = 1e-9;
/// Reciprocal of the response of a probe, relative to the energy norms of its row and of the force, below which directions
/// as short as the root of the tolerance are too long to be left out.
const WEAK_PROBE_FACTOR: f64 = 10.0;
/// Smallest factor by which the square of the length of directions is lowered for probes: below it are rounding errors.
const MIN_PROBE_FACTOR: f64 = 1e-2;
/// Steps over which many forces grow, in the comparison of responses: a binomial distribution.
const FORCE_GROWTH_STEPS: usize = 32;

/// Adds the static responses to the forces of `block`, and returns the number of the first; drops the factor.
fn add_static_responses(
    floating: Rc<Floating>,
    space: &mut Subspace<'_>,
    mut block: Vec<f64>,
) -> usize {
    floating.factor.solve_many(&mut block);
    drop(floating);
    let first = space.count();
    space.extend(block, FINAL_MIN_NEW_FRACTION);
    first
}

/// First limit of frequency of vibration modes.
///
/// Modes at the limit take part by the tolerance in responses to forces that grow over many steps.
fn first_frequency_limit(scheme_shift: f64, tolerance: f64) -> f64 {
    scheme_shift * (tolerance.powf(-2.0 / FORCE_GROWTH_STEPS as f64) - 1.0).sqrt()
}

impl Reduction<'_> {
    /// Ritz modes for many forces: vibration modes, static responses and powers of K_eff.
    ///
    /// Few reductions need a third round, which factors again: keeping the factor would raise the memory peak of all.
    pub(super) fn modes_of_many(
        &self,
        tolerance: f64,
        matrices: [&SparseMatrix; 3],
    ) -> Result<ModalBasis> {
        let mut space = self.rigid(matrices, ORTHOGONALITY_ROUNDING_FACTOR * tolerance * tolerance);
        let rows = &self.rows.all;
        let c = self.coefficients;
        let count = (rows.len() / self.assembled.dofs()).max(1);
        let mut block = space.balanced(rows.clone());
        space.extend(self.motions.clone(), FINAL_MIN_NEW_FRACTION);
        let scheme_shift = (c.acceleration[0] / c.displacement[0]).max(0.0).sqrt();
        let mut limit = first_frequency_limit(scheme_shift, tolerance);
        let mut last: Option<(StepResponses, Ritz)> = None;
        let mut converged: Option<Ritz> = None;
        let mut products = Vec::new();
        let mut effective = None;
        let mut change = f64::INFINITY;
        let mut newest = 0;
        let mut min_length = 0.5 * tolerance.sqrt();
        for round in 0..MAX_MODE_ROUNDS {
            // One more power alone is the comparison.
            if round != 1 {
                let Some(floating) = self.add_modes(&mut space, limit, scheme_shift, tolerance)?
                else {
                    break;
                };
                limit *= FREQUENCY_LIMIT_GROWTH;
                if round == 0 {
                    newest = add_static_responses(floating, &mut space, block);
                    block = space.inertia(newest, c.acceleration[0]);
                    effective = Some(self.effective()?);
                }
            }
            effective = effective.inspect(|factor| factor.solve_many(&mut block));
            if round == 0 && !self.probes().is_empty() {
                products.extend(space.products(0, rows));
                min_length *= self.probe_factor(&space, &products)?;
            }
            let mut is_last = false;
            if let Some((fewer_responses, fewer_modes)) = last.take() {
                products.extend(space.products(products.len() / count, rows));
                let (modes, all) =
                    space.ritz_with((&block, newest), c, (&products, rows), min_length)?;
                let new_change =
                    self.smooth_responses(&modes, &all).difference(&fewer_responses, tolerance);
                if new_change <= tolerance {
                    converged = Some(fewer_modes);
                    break;
                }
                let ratio = (new_change / change).clamp(MIN_CHANGE_RATIO, 1.0);
                is_last = change.is_finite() && new_change * ratio <= tolerance;
                change = new_change;
            }
            newest = space.count();
            space.extend_by_length(block, min_length);
            block = space.inertia(newest, c.acceleration[0]);
            let modes = space.ritz()?;
            if is_last || space.count() == self.assembled.dofs() {
                converged = Some(modes);
                break;
            }
            products.extend(space.products(products.len() / count, rows));
            last = Some((self.smooth_responses(&modes, &products), modes));
        }
        let Some(modes) = converged else {
            return Err(self.slow_convergence(space.count(), change, tolerance));
        };
        self.basis_of_many(space, &modes, effective.as_deref(), scheme_shift, tolerance)
    }

    /// Error for powers of K_eff that do not reach the tolerance.
    fn slow_convergence(&self, vectors: usize, reached: f64, tolerance: f64) -> Error {
        let forces = self.rows.force_count;
        let remedy = format!(
            "with {vectors} vectors; it has {forces} forces, and with more than 99 few powers of the effective stiffness are \
             tried, by which section forces of stiff structures do not converge below it: ask for 1e-4, leave out such \
             probes, or take the degrees of freedom"
        );
        inaccurate(reached, tolerance, remedy)
    }

    /// The modes in degrees of freedom.
    fn basis_of_many(
        &self,
        space: Subspace<'_>,
        modes: &Ritz,
        effective: Option<&SparseFactor>,
        scheme_shift: f64,
        tolerance: f64,
    ) -> Result<ModalBasis> {
        if self.without_p_delta.is_none() {
            return Ok(space.basis(modes));
        }
        let floating = self.on_springs(scheme_shift)?;
        let factors: Vec<_> = effective.into_iter().chain([&floating.factor]).collect();
        self.basis(space, modes, &factors, tolerance)
    }

    /// Numbers of the rows of probes.
    fn probes(&self) -> Range<usize> {
        self.rows.force_count..self.rows.first_acceleration
    }

    /// Factor on the length of directions that are left out, where the weakest response of a probe is small.
    fn probe_factor(&self, space: &Subspace<'_>, products: &[f64]) -> Result<f64> {
        let responses = self.smooth_responses(&space.ritz()?, products);
        Ok((WEAK_PROBE_FACTOR * responses.weakest(self.probes()))
            .clamp(MIN_PROBE_FACTOR, 1.0)
            .sqrt())
    }

    /// Adds the vibration modes up to a frequency `limit`; returns the factor, or `None` for too many modes.
    fn add_modes(
        &self,
        space: &mut Subspace<'_>,
        limit: f64,
        scheme_shift: f64,
        tolerance: f64,
    ) -> Result<Option<Rc<Floating>>> {
        let floating = self.on_springs(scheme_shift)?;
        let upto =
            Some((limit * limit + floating.springs, MODE_RESIDUAL_FACTOR * tolerance.sqrt()));
        let found = lowest_modes(&floating.factor, &self.assembled.mass, MAX_VIBRATION_MODES, upto);
        let found = found.filter(|modes| modes.values.len() < MAX_VIBRATION_MODES);
        Ok(found.map(|modes| {
            // A small new component is the error of a mode already in the basis, not a new direction: skip it.
            space.extend(modes.vectors, MIN_NEW_FRACTION);
            floating
        }))
    }

    /// Responses to forces that grow over [`FORCE_GROWTH_STEPS`] steps.
    fn smooth_responses(&self, modes: &Ritz, products: &[f64]) -> StepResponses {
        self.responses(modes, Subspace::modal_rows(modes, products), FORCE_GROWTH_STEPS)
    }

    /// Factored K + σ²M; the factor of the static state is taken if it is usable.
    fn on_springs(&self, scheme_shift: f64) -> Result<Rc<Floating>> {
        if let Some(floating) = self.floating.take()
            && floating.factor.is_positive_definite()
            && floating.springs > MIN_SQUARED_SHIFT_RATIO * scheme_shift * scheme_shift
        {
            return Ok(floating);
        }
        let min_shift = STATIC_SHIFT_RANGE[0] * scheme_shift;
        let max_shift = STATIC_SHIFT_RANGE[1] * scheme_shift;
        let shift = self.fixed_base.lowest.clamp(min_shift, max_shift);
        Floating::new(self.assembled, &SparseMatrix::default(), shift * shift).map(Rc::new)
    }
}
