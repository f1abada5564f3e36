//! Convolution weights of a ground under cells of a lattice.

use std::path::PathBuf;

use super::cells::Plan;
use super::integrals::{Integrals, Workspace};
use super::unions::Unions;
use crate::bem::layered::{Compliances, FINER, Quadrature, QuadratureWeights, Stages, on_circle};
use crate::error::{Result, Watch, positive, same_length};
use crate::geometry::{COMPONENTS_IN_SPACE, Lattice, SERIES_PER_OFFSET};
use crate::history::PairClasses;
use crate::linalg::Complex;
use crate::soil::SoilProfile;

/// Up to 512 cells the passivity check tests all of them; above, a random 256.
const ALL_CELLS: usize = 512;
const SOME_CELLS: usize = 256;
/// Points of the unit circle for the largest Laplace variable, and a factor for a maximum between them.
const REACH_POINTS: usize = 256;
const REACH_MARGIN: f64 = 1.02;

/// Number of cells that the passivity check samples, and of all cells; `None` if it checks all.
pub(in crate::bem) fn gate_sample(plan: &Plan) -> Option<[usize; 2]> {
    (plan.count() > ALL_CELLS).then_some([SOME_CELLS, plan.count()])
}

/// Overwrites `matrix` (3Q × 3Q, row-major, m/Pa) with the mean static displacements of the cells of a plan.
pub(in crate::bem) fn static_compliance(
    profile: &SoilProfile,
    plan: &Plan,
    tolerance: f64,
    matrix: &mut [f64],
) -> Result<()> {
    let classes = plan.classes()?;
    same_length("static compliance", matrix.len(), classes.layout().square())?;
    let s = Complex::default();
    let mut watch = Watch::nobody();
    let integrals = Integrals::new(&plan.lattice, profile, [s], tolerance, &mut watch)?;
    let mut values = vec![[Complex::default(); SERIES_PER_OFFSET]; classes.count()];
    integrals.compliance(profile, s, &mut Workspace::default(), &mut values)?;
    classes.scatter(matrix, |_, pair| values[pair.class].map(|value| pair.scale * value.re));
    Ok(())
}

/// Static compliance of one cell in its own directions, m/Pa.
fn own_compliance(
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
    /// Contact elements that are not one whole cell each; `None` if all are.
    ///
    /// # Errors
    /// As for [`static_compliance`].
    pub(in crate::bem) fn unions(
        &self,
        profile: &SoilProfile,
        tolerance: f64,
    ) -> Result<Option<Unions>> {
        if self.owners.is_none() && self.cuts.is_empty() {
            return Ok(None);
        }
        let owners: Vec<_> = (0..self.count()).map(|cell| self.owner(cell)).collect();
        let unions = Unions::new(&owners);
        if self.cuts.is_empty() {
            return Ok(Some(unions));
        }
        let own = own_compliance(profile, self.pitch(), tolerance)?;
        Ok(Some(unions.with_cuts(self.cuts.iter().map(|cut| (cut.size, cut.softness)), own)))
    }
}

/// Convolution weights of a layered ground under cells, with six series.
pub(in crate::bem) type LatticeKernel = QuadratureWeights<Integrals, SERIES_PER_OFFSET>;

impl LatticeKernel {
    /// Weights of `profile` under the cells of `plan` for a time step (s) and a relative tolerance.
    ///
    /// Weights that the file contains are not computed again.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for a bad time step,
    /// [`SoilError::NotCausal`](crate::soil::SoilError::NotCausal); as for [`Integrals::sketch`].
    pub(in crate::bem) fn in_plan(
        profile: SoilProfile,
        plan: &Plan,
        stages: Stages,
        [time_step, tolerance]: [f64; 2],
        file: Option<PathBuf>,
    ) -> Result<Self> {
        positive("time step", time_step)?;
        profile.check()?;
        profile.check_causal()?;
        // λ is analytic in the unit disc, and so is √q₂: their largest values lie on its edge.
        let nodes = (0..=REACH_POINTS).flat_map(|point| {
            let angle = std::f64::consts::PI * point as f64 / REACH_POINTS as f64;
            let [z, rest] = on_circle(0.0, angle);
            stages.nodes(z, rest)
        });
        let list = nodes.map(|node| node.lambda.scale(REACH_MARGIN / time_step));
        let integrals = Integrals::sketch(&plan.lattice, &profile, list, FINER * tolerance)?;
        let classes = plan.classes()?;
        let own = vec![[0; 2]; classes.count()];
        let quadrature = Quadrature::over(profile, integrals, own, stages, [time_step, tolerance]);
        let some = gate_sample(plan).map(|_| scattered(&plan.cells));
        let sample = some.map(|cells| PairClasses::in_plan(plan.lattice.clone(), cells, [0.0; 2]));
        let Lattice { pitch, counts } = &plan.lattice;
        let mesh = pitch.iter().copied().chain(counts.iter().map(|count| *count as f64)).collect();
        Ok(Self::new(quadrature, classes, sample.transpose()?, mesh, file))
    }
}

/// Some of many cells, without a pattern that a lattice could have.
fn scattered(cells: &[[usize; 2]]) -> Vec<[usize; 2]> {
    let mut order: Vec<_> = (0..cells.len()).collect();
    let mut state = 1_u64;
    let mut random = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(state >> 33).unwrap_or(0)
    };
    for place in 0..SOME_CELLS.min(cells.len()) {
        let other = place + random() % (cells.len() - place);
        order.swap(place, other);
    }
    order.into_iter().take(SOME_CELLS).map(|place| cells[place]).collect()
}

#[cfg(test)]
mod tests;
