//! A subspace of a structure's displacements and the structure's matrices in it (Galerkin).
//!
//! | symbol | meaning |
//! |---|---|
//! | V | vectors, V M Vᵀ = 1 |
//! | F | inputs, a row of unknowns each |
//! | Z | dynamic stiffness σ² M + σ C + K at a real shift σ |
//!
//! Vectors and inputs are rows. The first vectors are rigid translations, of which K knows nothing:
//! their products with K are zero, not rounding.

use super::modal_basis::{DECOUPLED, ModalBasis};
use crate::error::{ReducedError, Result};
use crate::linalg::{
    DenseFactor, SparseMatrix, add_combined_rows, dot, largest, row_products, symmetric_modes,
};

/// A vector that orthogonalisation shortens to this lay in the space of the others.
const DEPENDENT: f64 = 1e-11;
/// Eigenvalues below this, relative to the largest, are zeros with the error of their computation.
const ZERO: f64 = 1e-13;
/// Least eigenvalue besides zero, relative to the largest: between the two nothing is certain.
const LEAST: f64 = 1e-10;

/// V and the matrices in it.
pub(super) struct Subspace<'a> {
    /// Mass, damping, stiffness.
    matrices: [&'a SparseMatrix; 3],
    /// V and V M.
    vectors: Vec<f64>,
    momenta: Vec<f64>,
    /// V C Vᵀ and V K Vᵀ.
    projected: [Vec<f64>; 2],
    translations: usize,
}

impl<'a> Subspace<'a> {
    /// The space of these rigid translations.
    pub(super) fn new(matrices: [&'a SparseMatrix; 3], translations: Vec<f64>) -> Self {
        let projected = [Vec::new(), Vec::new()];
        let (vectors, momenta) = (Vec::new(), Vec::new());
        let mut space = Self { matrices, vectors, momenta, projected, translations: usize::MAX };
        space.extend(translations);
        space.translations = space.count();
        space
    }

    /// Number of vectors.
    pub(super) fn count(&self) -> usize {
        self.vectors.len() / self.order()
    }

    fn order(&self) -> usize {
        self.matrices[0].order().max(1)
    }

    /// Adds the vectors of `block`, as far as they are independent.
    pub(super) fn extend(&mut self, mut block: Vec<f64>) {
        let (n, before) = (self.order(), self.count());
        let norms = self.norms(&block);
        for (row, norm) in block.chunks_exact_mut(n).zip(norms) {
            scale(row, norm.recip());
        }
        // Twice is enough.
        for _ in 0..2 {
            let shares = row_products(&self.momenta, &block, n);
            if before > 0 {
                add_combined_rows(&shares, &self.vectors, n, -1.0, &mut block);
            }
            let mut kept: Vec<f64> = Vec::with_capacity(block.len());
            let mut momenta: Vec<f64> = Vec::with_capacity(block.len());
            for row in block.chunks_exact_mut(n) {
                for (own, momentum) in kept.chunks_exact(n).zip(momenta.chunks_exact(n)) {
                    let share = dot(momentum, row);
                    row.iter_mut().zip(own).for_each(|(x, v)| *x -= share * v);
                }
                let norm = self.norms(row)[0];
                // Vectors come with a norm of one; what is not a number is left out as well.
                if norm > DEPENDENT {
                    scale(row, norm.recip());
                    kept.extend_from_slice(row);
                    momenta.extend(self.images(0, row));
                }
            }
            block = kept;
        }
        let momenta = self.images(0, &block);
        self.vectors.extend_from_slice(&block);
        self.momenta.extend(momenta);
        self.project(&block, before);
    }

    /// Adds the rows and columns of the `new` vectors to C and K.
    fn project(&mut self, new: &[f64], before: usize) {
        let (n, count) = (self.order(), self.count());
        for k in 0..2 {
            let images = self.images(k + 1, new);
            let products = row_products(&images, &self.vectors, n);
            let mut grown = vec![0.0; count * count];
            for i in 0..before {
                let row = &self.projected[k][i * before..(i + 1) * before];
                grown[i * count..i * count + before].copy_from_slice(row);
            }
            for (i, row) in products.chunks_exact(count.max(1)).enumerate() {
                for (j, &value) in row.iter().enumerate() {
                    let value = if k == 1 && j < self.translations { 0.0 } else { value };
                    grown[(before + i) * count + j] = value;
                    grown[j * count + before + i] = value;
                }
            }
            self.projected[k] = grown;
        }
    }

    /// Products of rows with matrix `which`.
    fn images(&self, which: usize, rows: &[f64]) -> Vec<f64> {
        let mut images = vec![0.0; rows.len()];
        let n = self.order();
        for (row, image) in rows.chunks_exact(n).zip(images.chunks_exact_mut(n)) {
            self.matrices[which].multiply_add(1.0, row, image);
        }
        images
    }

    fn norms(&self, rows: &[f64]) -> Vec<f64> {
        let norm = |row: &[f64]| self.matrices[0].form(row, row).sqrt();
        rows.chunks_exact(self.order()).map(norm).collect()
    }

    /// F Vᵀ (V Z Vᵀ)⁻¹ V Fᵀ: the compliance of the inputs as the subspace has it; `None` if it is
    /// singular there.
    pub(super) fn compliance(&self, shift: f64, inputs: &[f64]) -> Option<Vec<f64>> {
        let count = self.count();
        let [damping, stiffness] = &self.projected;
        let mut matrix: Vec<f64> =
            damping.iter().zip(stiffness).map(|(c, k)| shift * c + k).collect();
        (0..count).for_each(|i| matrix[i * (count + 1)] += shift * shift);
        let mut factor = DenseFactor::with_capacity(count);
        if !factor.factor(&matrix, count) {
            return None;
        }
        let forces = row_products(inputs, &self.vectors, self.order());
        let mut answers = forces.clone();
        answers.chunks_exact_mut(count.max(1)).for_each(|row| factor.solve(row));
        Some(row_products(&forces, &answers, count))
    }

    /// The Ritz modes.
    pub(super) fn modes(&self) -> Result<ModalBasis> {
        let (count, fixed) = (self.count(), self.translations);
        let free = count - fixed;
        let [damping, stiffness] = &self.projected;
        let rows = (fixed..count).flat_map(|i| &stiffness[i * count + fixed..(i + 1) * count]);
        let rows: Vec<f64> = rows.copied().collect();
        let failed =
            ReducedError::Matrix { matrix: "stiffness matrix", needed: "finite in the subspace" };
        let (mut values, own) = symmetric_modes(&rows, free).ok_or(failed)?;
        let top = largest(&values);
        values.iter_mut().filter(|value| value.abs() <= ZERO * top).for_each(|value| *value = 0.0);
        let nonzero = values.iter().filter(|value| **value != 0.0);
        let ratio = nonzero.fold(top, |least, value| value.abs().min(least)) / top;
        if ratio < LEAST {
            return Err(ReducedError::Spectrum { ratio, least: LEAST }.into());
        }
        // Q, columns: the translations, then the Ritz vectors.
        let mut combinations = vec![0.0; count * count];
        (0..fixed).for_each(|i| combinations[i * (count + 1)] = 1.0);
        for (i, row) in own.chunks_exact(free.max(1)).enumerate() {
            combinations[(fixed + i) * count + fixed..(fixed + i + 1) * count].copy_from_slice(row);
        }
        let mut products = vec![0.0; count * count];
        add_combined_rows(&combinations, damping, count, 1.0, &mut products);
        let mut modal = vec![0.0; count * count];
        let transposed: Vec<f64> = transpose(&products, count);
        add_combined_rows(&combinations, &transposed, count, 1.0, &mut modal);
        let damping: Vec<f64> = (0..count).map(|j| modal[j * (count + 1)]).collect();
        (0..count).for_each(|j| modal[j * (count + 1)] = 0.0);
        let coupling = largest(&modal) / largest(&damping);
        if coupling > DECOUPLED {
            return Err(ReducedError::Damping { coupling }.into());
        }
        let mut stiffness = vec![0.0; fixed];
        stiffness.extend(values);
        let mut modes = vec![0.0; self.vectors.len()];
        add_combined_rows(&combinations, &self.vectors, self.order(), 1.0, &mut modes);
        Ok(ModalBasis::of(stiffness, damping, transpose(&modes, self.order())))
    }
}

fn scale(row: &mut [f64], factor: f64) {
    for x in row {
        *x *= factor;
    }
}

fn transpose(rows: &[f64], columns: usize) -> Vec<f64> {
    (0..columns).flat_map(|j| rows.iter().skip(j).step_by(columns).copied()).collect()
}
