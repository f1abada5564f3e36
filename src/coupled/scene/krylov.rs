//! Reduced coordinates: Ritz modes of a rational block Krylov space.
//!
//! | symbol | meaning |
//! |---|---|
//! | F | rows of unknowns where forces act or something is looked at |
//! | σ | shifts, beginning with that of the scheme, √(a/k): 2/Δt for the midpoint rule |
//! | Z | K_eff for the scheme's shift, K + σ² M for others |
//!
//! The space holds rigid motions and Z⁻¹Fᵀ, Z⁻¹M Z⁻¹Fᵀ and so on, one power more of every shift in each
//! round (Ruhe 1984; Grimme 1997). Each power of K_eff makes two more steps after a change of traction
//! exact. Lower shifts serve the modes there, of which they soon have all; one above serves what a
//! step cannot follow.

use super::base::Base;
use super::modal_basis::ModalBasis;
use super::model::Model;
use super::operators::Factor;
use super::step_response::{Rows, StepResponses};
use super::subspace::Subspace;
use crate::coupled::scheme::SchemeCoefficients;
use crate::error::{Error, ReducedError, Result, finite};
use crate::linalg::matrix::spread;
use crate::linalg::{SparseFactor, SparseMatrix, dot, largest};
use crate::structure::Triplets;

/// From one shift to the next.
const RATIO: f64 = 4.0;
/// Directions are left out of which less than this share is new, and less than so many times the root
/// of the tolerance: their share in the responses is its square.
const NEW: f64 = 1e-2;
const NEW_BY_ROOT: f64 = 10.0;
/// The same, in the end.
const LEAST_NEW: f64 = 1e-7;
/// The next round changes this much less than the last, at best.
const FASTEST: f64 = 0.1;
/// Rounds after which the tolerance is given up, after half of them if it cannot be expected.
const ROUNDS: usize = 16;
/// The lowest shift over the scheme's, at least.
const LOWEST: f64 = 1e-6;
/// Steps over which responses are compared, at most.
const LONGEST: usize = 10_000;

/// All that a reduction looks at. Rows have an entry for every unknown.
pub(crate) struct Reduction<'a> {
    pub(crate) model: &'a Model,
    pub(crate) base: &'a Base,
    pub(crate) coefficients: &'a SchemeCoefficients,
    /// K_eff, factored.
    pub(crate) factor: &'a Factor,
    /// Steps of the run.
    pub(crate) steps: usize,
    /// None of them zero.
    pub(crate) rows: Rows,
    /// Displacements that the modes must contain.
    pub(crate) motions: Vec<f64>,
}

impl Reduction<'_> {
    /// The Ritz modes with which the responses to suddenly applied forces err by less than `tolerance`.
    pub(crate) fn modes(&self, tolerance: f64) -> Result<ModalBasis> {
        const NAME: &str = "tolerance of reduced coordinates";
        if finite(NAME, tolerance)? <= 0.0 || tolerance >= 1.0 {
            let needed = "above 0 and below 1";
            return Err(Error::Input { quantity: NAME, value: tolerance, needed });
        }
        let matrices = self.matrices()?;
        let translations = self.translations();
        let (rotations, lowest) = self.held(&translations, matrices)?;
        let mut space = Subspace::new(matrices, translations);
        space.extend(rotations, LEAST_NEW);
        space.extend(self.motions.clone(), LEAST_NEW);
        let rows = &self.rows.all;
        let factors = self.shifts(lowest, matrices).collect::<Result<Vec<_>>>()?;
        let k_eff = self.factor.sparse().ok_or(ReducedError::Nonlinear)?;
        let factors: Vec<_> = std::iter::once(k_eff).chain(&factors).collect();
        let mut blocks = vec![rows.clone(); factors.len()];
        let mut least = NEW.min(NEW_BY_ROOT * tolerance.sqrt());
        let mut last: Option<StepResponses> = None;
        let [mut change, mut reached] = [f64::INFINITY; 2];
        for round in 1..=ROUNDS {
            let before = space.count();
            for (factor, block) in factors.iter().zip(&mut blocks) {
                let before = space.count();
                factor.solve_many(block);
                space.extend(std::mem::take(block), least);
                block.extend_from_slice(space.momenta(before));
            }
            if space.count() == before {
                if least <= LEAST_NEW {
                    return Ok(space.basis(&space.ritz()?));
                }
                // Again, for the little that was left out.
                least = LEAST_NEW.max(NEW * least);
                blocks.fill(rows.clone());
                continue;
            }
            let modes = space.ritz()?;
            let shares = space.shares(&modes, rows);
            let steps = self.steps.clamp(1, LONGEST);
            let responses =
                StepResponses::new(&modes, shares, &self.rows, self.coefficients, steps);
            let mut rate = 1.0;
            if let Some(last) = &last {
                let by = responses.difference(last, tolerance);
                if change.is_finite() {
                    rate = (by / change).clamp(FASTEST, 1.0);
                }
                // Estimated change by the next round, at the rate of this one.
                (change, reached) = (by, by * rate);
            }
            if reached <= tolerance || space.count() == self.model.unknowns {
                return Ok(space.basis(&modes));
            }
            let left = i32::try_from(ROUNDS - round).unwrap_or(0);
            if 2 * round >= ROUNDS && reached * rate.powi(left) > tolerance {
                break;
            }
            last = Some(responses);
        }
        Err(ReducedError::Accuracy { tolerance, reached, vectors: space.count() }.into())
    }

    /// Mass, damping and stiffness, if they can be reduced.
    fn matrices(&self) -> Result<[&SparseMatrix; 3]> {
        let matrices = self.model.sparse().filter(|_| self.model.linear);
        let matrices = matrices.ok_or(ReducedError::Nonlinear)?;
        let names = ["mass matrix", "damping matrix", "stiffness matrix"];
        for (matrix, name) in matrices.iter().zip(names) {
            if matrix.asymmetry() > 1e-13 {
                return Err(ReducedError::Matrix { matrix: name, needed: "symmetric" }.into());
            }
        }
        if SparseFactor::positive_definite(names[0], matrices[0]).is_err() {
            let needed = "positive definite";
            return Err(ReducedError::Matrix { matrix: names[0], needed }.into());
        }
        Ok(matrices)
    }

    /// Factors at one shift above the scheme's and those below it.
    fn shifts(
        &self,
        lowest: f64,
        [mass, _, stiffness]: [&SparseMatrix; 3],
    ) -> impl Iterator<Item = Result<SparseFactor>> {
        let pairs = stiffness.diagonal().into_iter().zip(mass.diagonal());
        let stiffest = pairs.fold(0.0, |most: f64, (k, m)| most.max(k / m)).sqrt();
        let c = self.coefficients;
        let own = (c.acceleration[0] / c.displacement[0]).sqrt().min(RATIO * stiffest);
        let lowest = lowest.max(LOWEST * own);
        let below = std::iter::successors(Some(own / RATIO), |shift| Some(shift / RATIO));
        let shifts = std::iter::once(RATIO * own).chain(below.take_while(move |s| *s > lowest));
        shifts.filter(move |shift| *shift < stiffest).map(|shift| {
            let mut matrix = Triplets::new(mass.order());
            mass.add_to(shift * shift, &mut matrix);
            stiffness.add_to(1.0, &mut matrix);
            SparseFactor::new("dynamic stiffness matrix", &matrix)
        })
    }

    /// Rigid translations of the parts.
    fn translations(&self) -> Vec<f64> {
        let vectors = self.model.influence.parts().iter().flat_map(|part| &part.vectors);
        let vectors = vectors.filter(|vector| !vector.is_empty());
        vectors.flat_map(|vector| spread(vector, self.model.unknowns)).collect()
    }

    /// Answers to a rotation of each part's base, which are rigid rotations of the parts that stand on
    /// one level, and about the lowest frequency with the base held (Rayleigh's quotient).
    fn held(
        &self,
        translations: &[f64],
        [mass, _, stiffness]: [&SparseMatrix; 3],
    ) -> Result<(Vec<f64>, f64)> {
        let n = self.model.unknowns;
        let stiffest = largest(&stiffness.diagonal());
        let tie = if stiffest > 0.0 { stiffest } else { 1.0 };
        let (matrix, _) = self.base.held(stiffness, tie);
        let factor = SparseFactor::new("stiffness matrix with its base held", &matrix)?;
        let parts = self.model.influence.parts();
        let mut rotations = vec![0.0; parts.len() * n];
        for (part, rotation) in parts.iter().zip(rotations.chunks_exact_mut(n)) {
            let own = self.base.foundations().filter(|(_, e)| part.elements().contains(&e.start));
            let nodes: Vec<_> = own.flat_map(|(nodes, _)| nodes).collect();
            let middle = nodes.iter().map(|node| node.x).sum::<f64>() / nodes.len().max(1) as f64;
            for node in nodes {
                for &(i, weight) in &node.vertical {
                    rotation[i] += tie * weight * (node.x - middle);
                }
            }
        }
        factor.solve_many(&mut rotations);
        let mut inertia = vec![0.0; translations.len()];
        for (row, force) in translations.chunks_exact(n).zip(inertia.chunks_exact_mut(n)) {
            mass.multiply_add(1.0, row, force);
        }
        let mut bent = inertia.clone();
        factor.solve_many(&mut bent);
        let pairs = inertia.chunks_exact(n).zip(bent.chunks_exact(n));
        let squares = pairs.map(|(force, bent)| dot(force, bent) / mass.form(bent, bent));
        Ok((rotations, squares.fold(f64::INFINITY, f64::min).max(0.0).sqrt()))
    }
}
