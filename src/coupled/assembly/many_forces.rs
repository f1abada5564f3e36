//! Reduced coordinates for many forces.
//!
//! The space holds vibration modes up to a frequency, the static responses to all forces, and powers of K_eff of what
//! they leave (MacNeal 1971; Rubin 1975), without directions far shorter than the root of the tolerance. Symbols: see
//! `krylov.rs`.

use std::ops::Range;
use std::rc::Rc;

use crate::coupled::assembly::krylov::{FASTEST, LEAST_NEW, NEW, Reduction, inaccurate};
use crate::coupled::assembly::step_response::StepResponses;
use crate::coupled::assembly::subspace::{Ritz, Subspace};
use crate::coupled::base::transformation::ModalBasis;
use crate::coupled::statics::compliance::Floating;
use crate::error::Result;
use crate::linalg::{SparseFactor, SparseMatrix, lowest_modes};

/// Growth of the limit of frequency of vibration modes, from a round to the next.
const GROWTH: f64 = std::f64::consts::SQRT_2;
/// Largest number of vibration modes.
const MODES: usize = 600;
/// Residual of vibration modes, relative to the root of the tolerance: responses depend on its square.
const LOOSE: f64 = 0.1;
/// Rounding of the vectors' orthogonality after one pass, relative to the square of the tolerance.
const ROUNDING: f64 = 1e-4;
/// Largest number of rounds with vibration modes.
const ROUNDS_OF_MODES: usize = 5;
/// Lowest and highest shift for vibration modes and static responses, relative to the scheme's.
const STATIC: [f64; 2] = [1e-2, 0.5];
/// Smallest square of a shift for vibration modes, relative to the scheme's: θ of a rigid motion leaves digits for others.
const FAR: f64 = 1e-9;
/// Reciprocal of the response of a probe, relative to the energy norms of its row and of the force, below which directions
/// as short as the root of the tolerance are too long to be left out.
const WEAK: f64 = 10.0;
/// Smallest factor by which the square of the length of directions is lowered for probes: below it are rounding errors.
const LEAST_WEAKNESS: f64 = 1e-2;
/// Steps over which many forces grow, in the comparison of responses: a binomial distribution.
const SMOOTH: usize = 32;

/// Adds the static responses to the forces of `block`, and returns the number of the first; drops the factor.
fn add_static_responses(
    floating: Rc<Floating>,
    space: &mut Subspace<'_>,
    mut block: Vec<f64>,
) -> usize {
    floating.factor.solve_many(&mut block);
    drop(floating);
    let first = space.count();
    space.extend(block, LEAST_NEW);
    first
}

impl Reduction<'_> {
    /// Ritz modes for many forces: vibration modes, static responses and powers of K_eff.
    ///
    /// Few reductions need a third round, which makes the factor again: kept, it would add to the peak of memory of all.
    pub(super) fn modes_of_many(
        &self,
        tolerance: f64,
        matrices: [&SparseMatrix; 3],
    ) -> Result<ModalBasis> {
        let mut space = self.rigid(matrices, ROUNDING * tolerance * tolerance);
        let (rows, c) = (&self.rows.all, self.coefficients);
        let count = (rows.len() / self.assembled.dofs()).max(1);
        let mut block = space.balanced(rows.clone());
        space.extend(self.motions.clone(), LEAST_NEW);
        let own = (c.acceleration[0] / c.displacement[0]).max(0.0).sqrt();
        // Modes at the limit take part by the tolerance in responses to forces that grow over many steps.
        let mut limit = own * (tolerance.powf(-2.0 / SMOOTH as f64) - 1.0).sqrt();
        let mut last: Option<(StepResponses, Ritz)> = None;
        let (mut products, mut effective) = (Vec::new(), None);
        let (mut change, mut newest) = (f64::INFINITY, 0);
        let mut least = 0.5 * tolerance.sqrt();
        for round in 0..ROUNDS_OF_MODES {
            // One more power alone is the comparison.
            if round != 1 {
                let Some(floating) = self.add_modes(&mut space, [limit, own], tolerance)? else {
                    break;
                };
                limit *= GROWTH;
                if round == 0 {
                    newest = add_static_responses(floating, &mut space, block);
                    block = space.inertia(newest, c.acceleration[0]);
                    effective = Some(self.effective()?);
                }
            }
            effective = effective.inspect(|factor| factor.solve_many(&mut block));
            if round == 0 && !self.probes().is_empty() {
                products.extend(space.products(0, rows));
                least *= self.probe_factor(&space, &products)?;
            }
            let mut is_last = false;
            if let Some((last, fewer)) = &last {
                products.extend(space.products(products.len() / count, rows));
                let (modes, all) =
                    space.ritz_with((&block, newest), c, (&products, rows), least)?;
                let by = self.smooth_responses(&modes, &all).difference(last, tolerance);
                if by <= tolerance {
                    return self.basis_of_many(space, fewer, effective, own, tolerance);
                }
                is_last = change.is_finite() && by * (by / change).clamp(FASTEST, 1.0) <= tolerance;
                change = by;
            }
            newest = space.count();
            space.extend_by_length(block, least);
            block = space.inertia(newest, c.acceleration[0]);
            let modes = space.ritz()?;
            if is_last || space.count() == self.assembled.dofs() {
                return self.basis_of_many(space, &modes, effective, own, tolerance);
            }
            products.extend(space.products(products.len() / count, rows));
            last = Some((self.smooth_responses(&modes, &products), modes));
        }
        let (vectors, forces) = (space.count(), self.rows.counts[1]);
        let remedy = format!(
            "with {vectors} vectors; it has {forces} forces, and with more than 99 few powers of the effective stiffness are \
             tried, by which section forces of stiff structures do not converge below it: ask for 1e-4, leave out such \
             probes, or take the degrees of freedom"
        );
        Err(inaccurate(change, tolerance, remedy))
    }

    /// The modes in degrees of freedom; `own`: shift of the scheme.
    fn basis_of_many(
        &self,
        space: Subspace<'_>,
        modes: &Ritz,
        effective: Option<Box<SparseFactor>>,
        own: f64,
        tolerance: f64,
    ) -> Result<ModalBasis> {
        if self.without_p_delta.is_none() {
            return Ok(space.basis(modes));
        }
        let floating = self.on_springs(own)?;
        let factors: Vec<_> =
            effective.iter().map(|own| &**own).chain([&floating.factor]).collect();
        self.basis(space, modes, &factors, tolerance)
    }

    /// Numbers of the rows of probes.
    fn probes(&self) -> Range<usize> {
        self.rows.counts[1]..self.rows.counts[2]
    }

    /// Factor on the length of directions that are left out, where the weakest response of a probe is small.
    fn probe_factor(&self, space: &Subspace<'_>, products: &[f64]) -> Result<f64> {
        let responses = self.smooth_responses(&space.ritz()?, products);
        Ok((WEAK * responses.weakest(self.probes())).clamp(LEAST_WEAKNESS, 1.0).sqrt())
    }

    /// Adds the vibration modes up to a frequency `limit`; returns the factor, or `None` for too many modes.
    fn add_modes(
        &self,
        space: &mut Subspace<'_>,
        [limit, own]: [f64; 2],
        tolerance: f64,
    ) -> Result<Option<Rc<Floating>>> {
        let floating = self.on_springs(own)?;
        let upto = Some((limit * limit + floating.springs, LOOSE * tolerance.sqrt()));
        let found = lowest_modes(&floating.factor, &self.assembled.mass, MODES, upto);
        let found = found.filter(|(squares, _)| squares.len() < MODES);
        Ok(found.map(|(_, modes)| {
            // A small new part is an error of a mode that is there, and no mode: it would need powers of its own.
            space.extend(modes, NEW);
            floating
        }))
    }

    /// Responses to forces that grow over [`SMOOTH`] steps.
    fn smooth_responses(&self, modes: &Ritz, products: &[f64]) -> StepResponses {
        self.responses(modes, Subspace::shares(modes, products), SMOOTH)
    }

    /// Factored K + σ²M: of the static state, if it is known; `own`: shift of the scheme.
    fn on_springs(&self, own: f64) -> Result<Rc<Floating>> {
        let known = self
            .floating
            .take()
            .filter(|known| known.factor.is_positive_definite() && known.springs > FAR * own * own);
        let shift = self.held.lowest.clamp(STATIC[0] * own, STATIC[1] * own);
        let shifted = || Floating::new(self.assembled, &SparseMatrix::default(), shift * shift);
        known.map_or_else(|| shifted().map(Rc::new), Ok)
    }
}
