//! Reduced coordinates: Ritz modes of a rational block Krylov space.
//!
//! | symbol | meaning |
//! |---|---|
//! | F | inputs: rows of BᵀA, loads, probes, momenta of an initial motion |
//! | Z | dynamic stiffness σ² M + σ C + K |
//! | σ | real shifts around √(a/k) of the scheme, 2/Δt for the midpoint rule |
//! | G | compliance F Z⁻¹ Fᵀ |
//!
//! The space holds the rigid motions and, at some shifts, those combinations of the answers Z⁻¹Fᵀ
//! that the compliance needs. Its error there is the energy of the error of the answers, so that
//! the error at any shift only shrinks as vectors are added. It is looked at halfway between the
//! shifts used (Grimme 1997 on interpolation at real shifts; Druskin and Simoncini 2011 on their
//! choice where the error is largest). A step of the midpoint rule is s = 2/Δt (1 − 1/z)/(1 + 1/z) in
//! its z-transform: shifts below 2/Δt are z > 0, shifts above it z < 0, where what alternates from
//! step to step is seen, such as the answer to a change of contact.

use super::base::Base;
use super::modal_basis::ModalBasis;
use super::model::Model;
use super::subspace::Subspace;
use crate::error::{Error, ReducedError, Result, finite};
use crate::linalg::{
    SparseFactor, SparseMatrix, add_combined_rows, largest, lowest_modes, row_products,
    symmetric_modes,
};
use crate::structure::Triplets;

/// Error of the compliance at real shifts over that of a bonded response, which meets frequencies;
/// measured on towers with a damping ratio of `LEAST_RATIO` at 2/Δt: base shears err by five times the
/// tolerance then, and by 100 times with half the damping.
const MARGIN: f64 = 0.01;
/// Least damping ratio of modes above the frequency of the time step.
const LEAST_RATIO: f64 = 0.1;
/// Share of the tolerance below which a combination of answers is left out.
const SHARE: f64 = 0.1;
/// The lowest shift over the lowest frequency with the base held.
const LOWEST: f64 = 0.25;
/// Least and most decades of shifts below that of the time step.
const DECADES: [i32; 2] = [2, 6];
/// The highest shift over that of the time step, at most.
const HIGHEST: f64 = 64.0;
/// Shifts closer than this ratio show nothing new.
const CLOSEST: f64 = 1.05;

/// The Ritz modes whose compliance, as the `inputs` (rows of unknowns) see it, errs by less than a
/// hundredth of `tolerance` at real shifts; `motions` are displacements that they must contain. `of_step` is the shift of the time step.
pub(crate) fn reduce(
    model: &Model,
    base: &Base,
    inputs: Vec<f64>,
    motions: Vec<f64>,
    of_step: f64,
    tolerance: f64,
) -> Result<ModalBasis> {
    if finite("tolerance of reduced coordinates", tolerance)? <= 0.0 || tolerance >= 1.0 {
        let quantity = "tolerance of reduced coordinates";
        return Err(Error::Input { quantity, value: tolerance, needed: "above 0 and below 1" });
    }
    let matrices = model.sparse().filter(|_| model.linear).ok_or(ReducedError::Nonlinear)?;
    let names = ["mass matrix", "damping matrix", "stiffness matrix"];
    for (matrix, name) in matrices.iter().zip(names) {
        if matrix.asymmetry() > 1e-13 {
            return Err(ReducedError::Matrix { matrix: name, needed: "symmetric" }.into());
        }
    }
    if SparseFactor::positive_definite(names[0], matrices[0]).is_err() {
        return Err(ReducedError::Matrix { matrix: names[0], needed: "positive definite" }.into());
    }
    let n = model.unknowns;
    let mut translations = Vec::new();
    for vector in model.influence.parts().iter().flat_map(|part| &part.vectors) {
        let start = translations.len();
        translations.resize(start + n, 0.0);
        vector.iter().for_each(|&(i, r)| translations[start + i] = r);
    }
    let mut space = Subspace::new(matrices, translations);
    let (rotations, frequency) = held(model, base, matrices)?;
    space.extend(rotations);
    space.extend(motions);
    let inputs: Vec<f64> =
        inputs.chunks_exact(n).filter(|row| largest(row) > 0.0).flatten().copied().collect();
    let [fewest, most] = DECADES.map(|decades| of_step * 10.0_f64.powi(-decades));
    let lowest = (LOWEST * frequency).clamp(most, fewest);
    let highest = stiffest_unknown(matrices).clamp(of_step, HIGHEST * of_step);
    let mut shifts = vec![lowest, of_step, highest];
    shifts.truncate(if highest > CLOSEST * of_step { 3 } else { 2 });
    let mut search = Search { matrices, space, inputs, tolerance: MARGIN * tolerance };
    search.refine(&shifts)?;
    let modes = search.space.modes()?;
    let ratios = modes.stiffness.iter().zip(&modes.damping).map(|(k, c)| (k.max(0.0).sqrt(), c));
    let beyond = ratios.filter(|(frequency, _)| *frequency > of_step);
    let ratio = beyond.fold(f64::INFINITY, |least, (frequency, c)| least.min(0.5 * c / frequency));
    if modes.count() < n && ratio < LEAST_RATIO {
        return Err(ReducedError::Undamped { ratio, least: LEAST_RATIO }.into());
    }
    Ok(modes)
}

/// Answers to a rotation of each part's base, which are rigid rotations of the parts that stand on
/// one level, and the lowest frequency with the base held.
fn held(model: &Model, base: &Base, matrices: [&SparseMatrix; 3]) -> Result<(Vec<f64>, f64)> {
    let (n, stiffness) = (model.unknowns, matrices[2]);
    let stiffest = largest(&stiffness.diagonal());
    let tie = if stiffest > 0.0 { stiffest } else { 1.0 };
    let mut matrix = Triplets::new(n);
    stiffness.add_to(1.0, &mut matrix);
    let [mut right, mut up] = [(); 2].map(|()| vec![0.0; n]);
    base.tie_nodes(tie, &mut matrix, [&mut right, &mut up]);
    let mut factor = SparseFactor::new("stiffness matrix with its base held", &matrix)?;
    let mut rotations = Vec::new();
    for part in model.influence.parts() {
        let mut rotation = vec![0.0; n];
        let own = base.foundations().filter(|(_, e)| part.elements().contains(&e.start));
        let nodes: Vec<_> = own.flat_map(|(nodes, _)| nodes).collect();
        let middle = nodes.iter().map(|node| node.x).sum::<f64>() / nodes.len().max(1) as f64;
        for node in nodes {
            for &(i, weight) in &node.vertical {
                rotation[i] += tie * weight * (node.x - middle);
            }
        }
        factor.solve(&mut rotation);
        rotations.extend(rotation);
    }
    let lowest = factor.is_positive_definite().then(|| lowest_modes(&factor, matrices[0], 1));
    let square = lowest.flatten().and_then(|(values, _)| values.first().copied());
    Ok((rotations, square.unwrap_or(0.0).max(0.0).sqrt()))
}

/// Highest frequency of an unknown by itself.
fn stiffest_unknown([mass, _, stiffness]: [&SparseMatrix; 3]) -> f64 {
    let pairs = stiffness.diagonal().into_iter().zip(mass.diagonal());
    pairs.fold(0.0, |most: f64, (k, m)| most.max(k / m)).sqrt()
}

/// The growing space and the inputs on which it is tried.
struct Search<'a> {
    matrices: [&'a SparseMatrix; 3],
    space: Subspace<'a>,
    inputs: Vec<f64>,
    tolerance: f64,
}

impl Search<'_> {
    /// Uses these shifts, then the middle of every interval between two whose compliance is not
    /// accurate there, until none is left.
    fn refine(&mut self, shifts: &[f64]) -> Result<()> {
        for shift in shifts.iter().rev() {
            self.visit(*shift)?;
        }
        let mut intervals: Vec<_> = shifts.windows(2).map(|pair| [pair[0], pair[1]]).collect();
        while let Some([low, high]) = intervals.pop() {
            let middle = (low * high).sqrt();
            let reached = self.visit(middle)?;
            if reached <= self.tolerance {
                continue;
            }
            if high < CLOSEST * low {
                let (tolerance, reached) = (self.tolerance / MARGIN, reached / MARGIN);
                let vectors = self.space.count();
                return Err(ReducedError::Accuracy { tolerance, reached, vectors }.into());
            }
            intervals.extend([[low, middle], [middle, high]]);
        }
        Ok(())
    }

    /// The relative error of the compliance at a shift; answers that the tolerance needs are then
    /// part of the space.
    fn visit(&mut self, shift: f64) -> Result<f64> {
        const NAME: &str = "dynamic stiffness matrix";
        let [mass, damping, stiffness] = self.matrices;
        let n = mass.order();
        let count = self.inputs.len() / n;
        let mut matrix = Triplets::new(n);
        mass.add_to(shift * shift, &mut matrix);
        damping.add_to(shift, &mut matrix);
        stiffness.add_to(1.0, &mut matrix);
        let mut answers = self.inputs.clone();
        SparseFactor::new(NAME, &matrix)?.solve_many(&mut answers);
        let mut error = row_products(&self.inputs, &answers, n);
        let singular = || Error::Singular { matrix: NAME, order: self.space.count() };
        let reduced = self.space.compliance(shift, &self.inputs).ok_or_else(singular)?;
        let scales: Vec<f64> =
            (0..count).map(|i| error[i * (count + 1)].abs().sqrt().recip()).collect();
        for (k, (error, reduced)) in error.iter_mut().zip(&reduced).enumerate() {
            *error = (*error - reduced) * scales[k / count] * scales[k % count];
        }
        if error.iter().any(|value| !value.is_finite()) {
            return Err(singular());
        }
        let (values, directions) = symmetric_modes(&error, count).ok_or_else(singular)?;
        let reached = largest(&values);
        if reached <= self.tolerance {
            return Ok(reached);
        }
        let needed: Vec<usize> =
            (0..count).rev().filter(|&j| values[j].abs() > SHARE * self.tolerance).collect();
        let weights: Vec<f64> = (0..count)
            .flat_map(|i| needed.iter().map(move |&j| (i, j)))
            .map(|(i, j)| scales[i] * directions[i * count + j])
            .collect();
        let mut block = vec![0.0; needed.len() * n];
        add_combined_rows(&weights, &answers, n, 1.0, &mut block);
        self.space.extend(block);
        Ok(reached)
    }
}
