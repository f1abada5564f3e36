//! Convolution weights of a ground under cells of a lattice.

use std::path::PathBuf;

use super::cells::Plan;
use super::integrals::{CellIntegrals, CellWorkspace};
use super::unions::Unions;
use crate::bem::layered::{
    CirclePoint, Compliances, INTEGRAL_TOLERANCE_FACTOR, Quadrature, QuadratureWeights, Stages,
    on_circle,
};
use crate::error::{ProgressReporter, Result, positive, same_length};
use crate::geometry::{COMPLIANCES_PER_OFFSET, COMPONENTS_IN_SPACE, Lattice};
use crate::history::PairClasses;
use crate::linalg::Complex;
use crate::soil::SoilProfile;

/// Largest number of cells for a passivity check of all cells, whose time grows with the cube of the number.
const MAX_CELLS_CHECKED: usize = 512;
/// Number of random cells in the passivity check of a plan with more cells.
const SAMPLED_CELL_COUNT: usize = 256;
/// Number of points of the half circle for the largest Laplace variable; the margin below covers their distance.
const CIRCLE_POINT_COUNT: usize = 256;
/// Factor of the largest Laplace variable at these points, because the maximum may lie between two points.
const LAPLACE_RADIUS_MARGIN: f64 = 1.02;

/// Number of cells that the passivity check samples, and number of all cells; `None` if it checks all cells.
pub(in crate::bem) fn passivity_sample(plan: &Plan) -> Option<[usize; 2]> {
    (plan.count() > MAX_CELLS_CHECKED).then_some([SAMPLED_CELL_COUNT, plan.count()])
}

/// Overwrites `matrix` (3Q × 3Q, row-major, m/Pa) with static displacements of a plan's cells due to unit tractions.
pub(in crate::bem) fn static_compliance(
    profile: &SoilProfile,
    plan: &Plan,
    tolerance: f64,
    matrix: &mut [f64],
) -> Result<()> {
    let classes = plan.classes()?;
    same_length("static compliance", matrix.len(), classes.layout().matrix_len())?;
    let s = Complex::default();
    let mut progress = ProgressReporter::unobserved();
    let integrals = CellIntegrals::new(&plan.lattice, profile, [s], tolerance, &mut progress)?;
    let mut values = vec![[Complex::default(); COMPLIANCES_PER_OFFSET]; classes.count()];
    integrals.compliance(profile, s, &mut CellWorkspace::default(), &mut values)?;
    classes.scatter(matrix, |_, pair| values[pair.class].map(|value| pair.scale * value.re));
    Ok(())
}

/// Static displacement of a cell due to a unit traction on itself, in each direction, m/Pa.
fn cell_compliance(
    profile: &SoilProfile,
    pitch: [f64; 2],
    tolerance: f64,
) -> Result<[f64; COMPONENTS_IN_SPACE]> {
    let mut matrix = [0.0; COMPONENTS_IN_SPACE * COMPONENTS_IN_SPACE];
    let cell = Plan::masked([0.0; 2], pitch, 1, &[true])?;
    static_compliance(profile, &cell, tolerance, &mut matrix)?;
    Ok([0, 1, 2].map(|k| matrix[k * (COMPONENTS_IN_SPACE + 1)]))
}

impl Plan {
    /// Unions of cells and cut cells of the plan; `None` if each element is one whole cell.
    ///
    /// # Errors
    /// As for [`static_compliance`].
    pub(in crate::bem) fn unions(
        &self,
        profile: &SoilProfile,
        tolerance: f64,
    ) -> Result<Option<Unions>> {
        if self.cell_elements.is_none() && self.cut_cells.is_empty() {
            return Ok(None);
        }
        let cell_elements: Vec<_> = (0..self.count()).map(|cell| self.element_of(cell)).collect();
        let unions = Unions::new(&cell_elements);
        if self.cut_cells.is_empty() {
            return Ok(Some(unions));
        }
        let whole_cell_compliance = cell_compliance(profile, self.pitch(), tolerance)?;
        let cut_cells = self.cut_cells.iter().map(|cell| (cell.area_ratio, cell.spring_ratio));
        Ok(Some(unions.with_cut_cells(cut_cells, whole_cell_compliance)))
    }
}

/// Convolution weights of a layered ground under the cells of a lattice.
pub(in crate::bem) type LatticeKernel = QuadratureWeights<CellIntegrals, COMPLIANCES_PER_OFFSET>;

impl LatticeKernel {
    /// Weights of `profile` under the cells of `plan` for a time step (s) and a relative tolerance.
    ///
    /// Weights that the file contains are not computed again.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a time step that is not positive,
    /// [`SoilError::NotCausal`](crate::soil::SoilError::NotCausal); as for [`CellIntegrals::untabulated`].
    pub(in crate::bem) fn in_plan(
        profile: SoilProfile,
        plan: &Plan,
        stages: Stages,
        time_step: f64,
        tolerance: f64,
        file: Option<PathBuf>,
    ) -> Result<Self> {
        positive("time step", time_step)?;
        profile.check()?;
        profile.check_causal()?;
        // λ and √q₂ are analytic in the unit disc, so that their largest magnitudes lie on the unit circle.
        let mut variables = vec![];
        for point in 0..=CIRCLE_POINT_COUNT {
            let angle = std::f64::consts::PI * point as f64 / CIRCLE_POINT_COUNT as f64;
            let CirclePoint { z, one_less_z } = on_circle(0.0, angle);
            let nodes = stages.nodes(z, one_less_z);
            variables
                .extend(nodes.map(|node| node.lambda.scale(LAPLACE_RADIUS_MARGIN / time_step)));
        }
        let integrals = CellIntegrals::untabulated(
            &plan.lattice,
            &profile,
            variables,
            INTEGRAL_TOLERANCE_FACTOR * tolerance,
        )?;
        let classes = plan.classes()?;
        let self_pairs = vec![[0; 2]; classes.count()];
        let quadrature =
            Quadrature::over(profile, integrals, self_pairs, stages, time_step, tolerance);
        let Lattice { pitch, counts } = &plan.lattice;
        let checked_classes = match passivity_sample(plan) {
            Some(_) => {
                let cells = random_sample(&plan.cells);
                Some(PairClasses::in_plan(plan.lattice.clone(), cells, [0.0; 2])?)
            }
            None => None,
        };
        let counts_as_numbers = counts.iter().map(|count| *count as f64);
        let mesh_numbers = pitch.iter().copied().chain(counts_as_numbers).collect();
        Ok(Self::new(quadrature, classes, checked_classes, mesh_numbers, file))
    }
}

/// Random sample of cells for the passivity check; the same at every call.
///
/// A regular sample could miss an error with the period of the sample.
fn random_sample(cells: &[[usize; 2]]) -> Vec<[usize; 2]> {
    let mut order: Vec<_> = (0..cells.len()).collect();
    let mut state = 1_u64;
    for position in 0..SAMPLED_CELL_COUNT.min(cells.len()) {
        // Linear congruential generator (Knuth, MMIX).
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let random = usize::try_from(state >> 33).unwrap_or(0);
        order.swap(position, position + random % (cells.len() - position));
    }
    order.into_iter().take(SAMPLED_CELL_COUNT).map(|cell| cells[cell]).collect()
}

#[cfg(test)]
mod tests;
