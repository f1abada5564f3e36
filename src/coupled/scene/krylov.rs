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
//!
//! Real shifts see little of what rings on. So the compliance of the Ritz modes is then compared at
//! frequencies, where they are diagonal, with that of a space with more shifts and all answers.

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

/// Error of the compliance at real shifts, where it is smallest, over that at frequencies.
const MARGIN: f64 = 0.01;
/// Least damping ratio of modes above the frequency of the time step.
const LEAST_RATIO: f64 = 0.1;
/// Share of the tolerance below which a combination of answers is left out.
const SHARE: f64 = 0.1;
/// The lowest shift over the lowest frequency with the base held.
const LOWEST: f64 = 0.25;
/// Times that intervals between shifts are halved, every third one at a time, before the tolerance is
/// given up.
const LEVELS: usize = 9;
const STRIDE: usize = 3;
/// Frequencies at which compliances are compared.
const FREQUENCIES: u32 = 64;
/// Least and most decades of shifts below that of the time step.
const DECADES: [i32; 2] = [2, 6];
/// The highest shift over that of the time step, at most.
const HIGHEST: f64 = 64.0;
/// Shifts closer than this ratio show nothing new.
const CLOSEST: f64 = 1.05;

/// The Ritz modes whose compliance, as the `inputs` (rows of unknowns) see it, errs by less than
/// `tolerance` at frequencies up to `of_step`; `motions` are displacements that they must contain. `of_step` is the shift of the time step.
pub(crate) fn reduce(
    model: &Model,
    base: &Base,
    inputs: &[f64],
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
        for &(i, r) in vector {
            translations[start + i] = r;
        }
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
    let used = Vec::new();
    let mut search = Search { matrices, space, inputs, tolerance: MARGIN * tolerance, used };
    search.refine(&shifts)?;
    let modes = search.confirm([lowest, of_step], tolerance)?;
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
    /// Shifts looked at.
    used: Vec<f64>,
}

impl Search<'_> {
    /// Uses these shifts, then the middle of every interval between two whose compliance is not
    /// accurate there, until none is left.
    fn refine(&mut self, shifts: &[f64]) -> Result<()> {
        for shift in shifts.iter().rev() {
            self.visit(*shift, false)?;
        }
        let mut intervals: Vec<_> = shifts.windows(2).map(|pair| [pair[0], pair[1]]).collect();
        while let Some([low, high]) = intervals.pop() {
            let middle = (low * high).sqrt();
            let reached = self.visit(middle, false)?;
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

    /// The Ritz modes whose compliance at the frequencies of `band` changes by less than `tolerance`
    /// when the space is given all answers halfway between some of the shifts it knows.
    fn confirm(&mut self, band: [f64; 2], tolerance: f64) -> Result<ModalBasis> {
        let mut modes = self.space.modes()?;
        let mut reached = 0.0;
        for level in 0..LEVELS {
            if self.space.count() == self.matrices[0].order() {
                return Ok(modes);
            }
            let mut known = self.used.clone();
            known.sort_by(f64::total_cmp);
            for pair in known.windows(2).skip(level % STRIDE).step_by(STRIDE) {
                self.visit((pair[0] * pair[1]).sqrt(), true)?;
            }
            let richer = self.space.modes()?;
            reached = self.difference(&modes, &richer, band);
            if reached <= tolerance {
                return Ok(modes);
            }
            modes = richer;
        }
        let vectors = self.space.count();
        Err(ReducedError::Accuracy { tolerance, reached, vectors }.into())
    }

    /// Largest difference of two compliances at frequencies of `band`, relative to the diagonal.
    fn difference(&self, one: &ModalBasis, two: &ModalBasis, band: [f64; 2]) -> f64 {
        let count = self.inputs.len() / self.matrices[0].order();
        let shares = [one, two].map(|modes| self.shares(modes));
        let mut worst = 0.0_f64;
        for k in 0..=FREQUENCIES {
            let fraction = f64::from(k) / f64::from(FREQUENCIES);
            let frequency = band[0] * (band[1] / band[0]).powf(fraction);
            let first = compliance(one, &shares[0], frequency);
            let second = compliance(two, &shares[1], frequency);
            let size = |k: usize| first[0][k].hypot(first[1][k]);
            for k in 0..count * count {
                let apart = (first[0][k] - second[0][k]).hypot(first[1][k] - second[1][k]);
                let scale = [k / count, k % count].map(|i| size(i * (count + 1)));
                worst = worst.max(apart / (scale[0] * scale[1]).sqrt());
            }
        }
        worst
    }

    /// F Φ.
    fn shares(&self, modes: &ModalBasis) -> Vec<f64> {
        let mut shares = Vec::new();
        for input in self.inputs.chunks_exact(self.matrices[0].order()) {
            let start = shares.len();
            shares.resize(start + modes.count(), 0.0);
            modes.project(input, &mut shares[start..]);
        }
        shares
    }

    /// The relative error of the compliance at a shift; answers that the tolerance needs are then
    /// part of the space.
    /// `all` of them if so wanted.
    fn visit(&mut self, shift: f64, all: bool) -> Result<f64> {
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
        self.used.push(shift);
        if all {
            self.space.extend(answers);
            return Ok(0.0);
        }
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

/// Real and imaginary part of F Φ (λ − ω² + i ω c)⁻¹ (F Φ)ᵀ.
fn compliance(modes: &ModalBasis, shares: &[f64], frequency: f64) -> [Vec<f64>; 2] {
    let parts = modes.stiffness.iter().zip(&modes.damping).map(|(k, c)| {
        let (real, imaginary) = (k - frequency * frequency, frequency * c);
        let square = real * real + imaginary * imaginary;
        [real / square, -imaginary / square]
    });
    let parts: Vec<_> = parts.collect();
    [0, 1].map(|part| {
        let weights = parts.iter().map(|both| both[part]).cycle();
        let weighted: Vec<f64> = shares.iter().zip(weights).map(|(f, w)| f * w).collect();
        row_products(shares, &weighted, modes.count())
    })
}
