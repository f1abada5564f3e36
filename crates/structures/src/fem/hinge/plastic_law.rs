//! Forces of which some yield together, with kinematic hardening.
//!
//! | symbol | meaning |
//! |---|---|
//! | d, k | deformations and their stiffnesses, which do not couple |
//! | b | hardening ratio |
//! | s | the part (1 − b) k that yields: forces in (1 − b) times the yield surface |
//! | d^p | plastic deformations of this part |
//!
//! The forces are q = b k d + s. The trial forces (1 − b) k (d − d^p) go to the closest point of the yield surface in the metric of
//! the complementary energy, the return of associated flow. With x = s/√((1 − b) k) this metric is that of Euclid.

use std::fmt::Debug;

use super::convex_set::ConvexSet;
use super::hinge_force::{HingeLaw, HingeResponse};
use crate::error::{Result, finite};
use crate::fem::internal_energy::InternalEnergy;

/// D forces of which P yield together.
#[derive(Debug, Clone)]
pub(super) struct PlasticLaw<S, const D: usize, const P: usize> {
    pub(super) stiffness: [f64; D],
    hardening_ratio: f64,
    /// Indices of the deformations that yield.
    yielding: [usize; P],
    /// Yield surface in the coordinates x.
    surface: S,
}

/// The part that yields.
struct PlasticState<const P: usize> {
    forces: [f64; P],
    plastic_deformations: [f64; P],
    /// ∂x/∂x of the trial forces; `None` for an elastic state.
    derivative: Option<[[f64; P]; P]>,
}

impl<S: ConvexSet<P>, const D: usize, const P: usize> PlasticLaw<S, D, P> {
    /// Law whose yield surface `surface` returns by the factors of forces in the coordinates x.
    ///
    /// The factors hold for the whole forces: they contain 1 − b of the part that yields.
    pub(super) fn new(
        stiffness: [f64; D],
        hardening_ratio: f64,
        yielding: [usize; P],
        surface: impl FnOnce([f64; P]) -> S,
    ) -> Self {
        let factors = yielding.map(|index| ((1.0 - hardening_ratio) / stiffness[index]).sqrt());
        Self { stiffness, hardening_ratio, yielding, surface: surface(factors) }
    }

    /// Stiffness (1 − b) k of a force of the part that yields.
    fn yielding_stiffness(&self, index: usize) -> f64 {
        (1.0 - self.hardening_ratio) * self.stiffness[self.yielding[index]]
    }

    /// The part that yields at deformations, from the plastic deformations of the last step.
    fn yielding_part(&self, deformation: &[f64; D], variables: &[f64]) -> PlasticState<P> {
        let stiffness: [f64; P] = std::array::from_fn(|i| self.yielding_stiffness(i));
        let plastic: [f64; P] = std::array::from_fn(|i| variables[i]);
        let elastic: [f64; P] = std::array::from_fn(|i| deformation[self.yielding[i]] - plastic[i]);
        let trial: [f64; P] = std::array::from_fn(|i| stiffness[i].sqrt() * elastic[i]);
        let Some(closest) = self.surface.closest_point(&trial) else {
            let forces = std::array::from_fn(|i| stiffness[i] * elastic[i]);
            return PlasticState { forces, plastic_deformations: plastic, derivative: None };
        };
        PlasticState {
            forces: std::array::from_fn(|i| stiffness[i].sqrt() * closest.point[i]),
            plastic_deformations: std::array::from_fn(|i| {
                deformation[self.yielding[i]] - closest.point[i] / stiffness[i].sqrt()
            }),
            derivative: Some(closest.derivative),
        }
    }

    /// Stiffness of each deformation beside the part that yields.
    fn elastic_stiffness(&self) -> [f64; D] {
        let mut stiffness = self.stiffness;
        for index in self.yielding {
            stiffness[index] *= self.hardening_ratio;
        }
        stiffness
    }
}

impl<const P: usize> PlasticState<P> {
    /// Work of the forces at the end of a step on its plastic deformations.
    fn work(&self, variables: &[f64]) -> f64 {
        (0..P).map(|i| self.forces[i] * (self.plastic_deformations[i] - variables[i])).sum()
    }
}

/// Variables: plastic deformations, then the dissipated energy (J).
impl<S, const D: usize, const P: usize> HingeLaw<D> for PlasticLaw<S, D, P>
where
    S: ConvexSet<P> + Debug + Send + Sync,
{
    fn variable_count(&self) -> usize {
        P + 1
    }

    fn initialize(&self, variables: &mut [f64]) {
        variables.fill(0.0);
    }

    fn stiffness(&self) -> [f64; D] {
        self.stiffness
    }

    fn yields(&self) -> [bool; D] {
        std::array::from_fn(|index| self.yielding.contains(&index))
    }

    fn response(&self, deformation: &[f64; D], variables: &[f64]) -> Result<HingeResponse<D>> {
        let part = self.yielding_part(deformation, variables);
        let elastic_stiffness = self.elastic_stiffness();
        let mut forces = std::array::from_fn(|i| elastic_stiffness[i] * deformation[i]);
        let mut tangent = [[0.0; D]; D];
        for (index, stiffness) in elastic_stiffness.into_iter().enumerate() {
            tangent[index][index] = stiffness;
        }
        for (i, &row) in self.yielding.iter().enumerate() {
            forces[row] += part.forces[i];
            for (j, &column) in self.yielding.iter().enumerate() {
                let unit = if i == j { 1.0 } else { 0.0 };
                let derivative = part.derivative.map_or(unit, |derivative| derivative[i][j]);
                let scale = (self.yielding_stiffness(i) * self.yielding_stiffness(j)).sqrt();
                tangent[row][column] += scale * derivative;
            }
        }
        Ok(HingeResponse { forces, tangent })
    }

    fn energy(&self, deformation: &[f64; D], variables: &[f64]) -> Result<InternalEnergy> {
        let part = self.yielding_part(deformation, variables);
        let elastic_stiffness = self.elastic_stiffness();
        let elastic: f64 =
            (0..D).map(|i| 0.5 * elastic_stiffness[i] * deformation[i] * deformation[i]).sum();
        let yielding: f64 = (0..P)
            .map(|i| 0.5 * part.forces[i] * part.forces[i] / self.yielding_stiffness(i))
            .sum();
        Ok(InternalEnergy {
            stored: finite("energy of a hinge", elastic + yielding)?,
            dissipated: variables[P] + part.work(variables),
        })
    }

    /// Σ [(s_m − s_1) Δd + Δs²/(2 (1 − b) k)], and ½ k Δd (2 d_m − d_0 − d_1) of the stiffness beside it.
    fn remainder(&self, deformations: &[[f64; D]; 3], variables: &[f64]) -> Result<f64> {
        let start = &deformations[0];
        let midstep = &deformations[1];
        let end = &deformations[2];
        let parts = deformations.each_ref().map(|d| self.yielding_part(d, variables).forces);
        let elastic_stiffness = self.elastic_stiffness();
        let mut remainder = 0.0;
        for i in 0..D {
            let offset = 2.0 * midstep[i] - start[i] - end[i];
            remainder += 0.5 * elastic_stiffness[i] * (end[i] - start[i]) * offset;
        }
        for (i, &index) in self.yielding.iter().enumerate() {
            let change = parts[2][i] - parts[0][i];
            remainder += (parts[1][i] - parts[2][i]) * (end[index] - start[index])
                + 0.5 * change * change / self.yielding_stiffness(i);
        }
        finite("mid-step remainder of a hinge", remainder)
    }

    fn commit(&self, deformation: &[f64; D], variables: &mut [f64]) {
        let part = self.yielding_part(deformation, variables);
        variables[P] += part.work(variables);
        variables[..P].copy_from_slice(&part.plastic_deformations);
    }
}
