//! Iterations of the static search that end before the solution of their linear step.
//!
//! Newton's method can lead a yielding structure past the balance, and back and for ever: on its way the tangent of a yielded
//! point is far below the stiffness of the point when it unloads. The incremental potential of associated laws is convex, so
//! that an iteration which ends where the forces do no work on the increment comes closer to the minimum.

use super::convergence::RelativeForceNorm;
use super::fictitious_springs::difference;
use super::increment_search::IncrementSearch;
use super::static_state::StaticState;
use crate::coupled::model::assembled::Assembled;
use crate::error::Result;
use crate::structure::Structure;

/// Unbalanced force, relative to the load, below which the full increment leads to the balance.
const FULL_INCREMENT_TOLERANCE: f64 = 1e-8;

/// Search along the increments of a static search, with its buffers.
pub(super) struct ShortenedIncrement<'a> {
    assembled: &'a Assembled,
    structure: &'a dyn Structure,
    search: IncrementSearch,
    start_force: Vec<f64>,
    end_force: Vec<f64>,
}

impl<'a> ShortenedIncrement<'a> {
    /// Buffers for a structure.
    pub(super) fn new(assembled: &'a Assembled, structure: &'a dyn Structure) -> Self {
        let start_force = vec![0.0; assembled.dofs()];
        let end_force = start_force.clone();
        let search = IncrementSearch::new(assembled.dofs());
        Self { assembled, structure, search, start_force, end_force }
    }

    /// Moves the end of an iteration back along its increment, if the increment passed the balance on this line.
    ///
    /// `start`: state before the iteration. `displacement` and `traction`: the end; both move. `loads`: at the start and the
    /// end. `shift`: stiffness per mass of the springs between both displacements, 1/s². Returns the position of the new end
    /// on the increment: below one if it has moved.
    pub(super) fn shorten(
        &mut self,
        relative_norm: &RelativeForceNorm,
        start: &StaticState,
        loads: [&[f64]; 2],
        shift: f64,
        (displacement, traction): (&mut [f64], &mut [f64]),
    ) -> Result<f64> {
        let Self { assembled, structure, search, start_force, end_force, .. } = self;
        let Some(nonlinear_force) = structure.nonlinear() else { return Ok(1.0) };
        let start_linear = linear_force(assembled, loads[0], &start.displacement, &start.traction);
        start_force.fill(0.0);
        nonlinear_force.force(&start.displacement, start_force)?;
        if relative_norm.of(&difference(&start_linear, start_force)) <= FULL_INCREMENT_TOLERANCE {
            return Ok(1.0);
        }
        let mut end_linear = linear_force(assembled, loads[1], displacement, traction);
        assembled.mass.multiply_add(-shift, displacement, &mut end_linear);
        assembled.mass.multiply_add(shift, &start.displacement, &mut end_linear);
        end_force.fill(0.0);
        nonlinear_force.force(displacement, end_force)?;
        search.start_at(&start.displacement, &start_linear, start_force);
        let position = search.search(displacement, &mut end_linear, end_force, |u, force| {
            force.fill(0.0);
            nonlinear_force.force(u, force)
        })?;
        for (end, start) in traction.iter_mut().zip(&start.traction) {
            *end = start + position * (*end - start);
        }
        Ok(position)
    }
}

/// Force that load, linear stiffness and tractions leave for the nonlinear force: load − K u − BᵀAτ.
fn linear_force(
    assembled: &Assembled,
    load: &[f64],
    displacement: &[f64],
    traction: &[f64],
) -> Vec<f64> {
    let mut force = load.to_vec();
    assembled.stiffness.multiply_add(-1.0, displacement, &mut force);
    assembled.base.add_forces(-1.0, traction, &mut force);
    force
}
