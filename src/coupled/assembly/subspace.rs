//! A subspace of a structure's displacements, and the structure's matrices in it (Galerkin).
//!
//! | symbol | meaning |
//! |---|---|
//! | V | vectors, V M Vᵀ = 1 |
//! | F | rows of degrees of freedom: where forces act and displacements are read |
//!
//! All are rows. The first vectors are rigid translations, which K does not resist: their products with K are set
//! to zero.

use crate::coupled::base::transformation::ModalBasis;
use crate::error::{Error, Result};
use crate::linalg::{SparseMatrix, add_combined_rows, largest, row_products, symmetric_modes};

/// Residual of the eigenproblem, and of damping that counts as diagonal, relative to its terms.
pub(crate) const DECOUPLED: f64 = 1e-10;
/// Eigenvalues below this, relative to the largest, count as zero.
const ZERO: f64 = 1e-13;
/// Smallest eigenvalue above zero, relative to the largest: between the two limits it is uncertain.
const LEAST: f64 = 1e-10;
/// Name of the coordinates in errors.
pub(crate) const REDUCED: &str = "reduced coordinates";

/// Smallest independent part of a translation.
const INDEPENDENT: f64 = 1e-7;

/// V and the matrices in it.
pub(crate) struct Subspace<'a> {
    /// Mass, damping, stiffness.
    matrices: [&'a SparseMatrix; 3],
    /// V and V M.
    vectors: Vec<f64>,
    momenta: Vec<f64>,
    /// V C Vᵀ and V K Vᵀ.
    projected: [Vec<f64>; 2],
    translations: usize,
}

/// Vibration modes of a subspace, the translations first.
pub(crate) struct Ritz {
    /// λ and c.
    pub(crate) stiffness: Vec<f64>,
    pub(crate) damping: Vec<f64>,
    /// Modes in terms of V, columns of a row-major matrix.
    combinations: Vec<f64>,
}

impl<'a> Subspace<'a> {
    /// The space of these rigid translations.
    pub(crate) fn new(matrices: [&'a SparseMatrix; 3], translations: Vec<f64>) -> Self {
        let projected = [Vec::new(), Vec::new()];
        let (vectors, momenta) = (Vec::new(), Vec::new());
        let mut space = Self { matrices, vectors, momenta, projected, translations: usize::MAX };
        space.extend(translations, INDEPENDENT);
        space.translations = space.count();
        space
    }

    /// Number of vectors.
    pub(crate) fn count(&self) -> usize {
        self.vectors.len() / self.order()
    }

    fn order(&self) -> usize {
        self.matrices[0].order().max(1)
    }

    /// V M of the vectors from number `first` on.
    pub(crate) fn momenta(&self, first: usize) -> &[f64] {
        &self.momenta[first * self.order()..]
    }

    /// Adds the directions of `block` with more than the fraction `least` outside the subspace.
    ///
    /// Rows are scaled to a length of one.
    pub(crate) fn extend(&mut self, block: Vec<f64>, least: f64) {
        self.extend_by(block, least, true);
    }

    /// Adds the directions of `block` with a length of more than `least` outside the subspace.
    pub(crate) fn extend_by_length(&mut self, block: Vec<f64>, least: f64) {
        self.extend_by(block, least, false);
    }

    fn extend_by(&mut self, mut block: Vec<f64>, least: f64, by_fraction: bool) {
        let (n, before) = (self.order(), self.count());
        let mut momenta = Vec::new();
        // Two passes remove rounding.
        for pass in 0..2 {
            let count = block.len() / n;
            let shares = row_products(&self.momenta, &block, n);
            if before > 0 {
                add_combined_rows(&shares, &self.vectors, n, -1.0, &mut block);
            }
            let images = self.images(0, &block);
            let mut products = row_products(&images, &block, n);
            let scales: Vec<f64> = (0..count)
                .map(|i| match pass {
                    0 if by_fraction => {
                        let inside: f64 = (0..before).map(|j| shares[j * count + i].powi(2)).sum();
                        let length = (inside + products[i * (count + 1)]).sqrt();
                        if length > 0.0 { length.recip() } else { 0.0 }
                    }
                    _ => 1.0,
                })
                .collect();
            for (k, product) in products.iter_mut().enumerate() {
                *product *= scales[k / count] * scales[k % count];
            }
            let least = if pass == 0 { least } else { 0.5 };
            let mut weights = independent(products, count, least * least);
            let kept = weights.len() / count.max(1);
            for row in weights.chunks_exact_mut(count.max(1)) {
                row.iter_mut().zip(&scales).for_each(|(weight, scale)| *weight *= scale);
            }
            let combine = |rows: &[f64]| {
                let mut combined = vec![0.0; kept * n];
                add_combined_rows(&transpose(&weights, count), rows, n, 1.0, &mut combined);
                combined
            };
            block = combine(&block);
            if pass == 1 {
                momenta = combine(&images);
            }
        }
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

    /// The modes of the subspace.
    pub(crate) fn ritz(&self) -> Result<Ritz> {
        let (count, fixed) = (self.count(), self.translations);
        let free = count - fixed;
        let [damping, stiffness] = &self.projected;
        let rows = (fixed..count).flat_map(|i| &stiffness[i * count + fixed..(i + 1) * count]);
        let rows: Vec<f64> = rows.copied().collect();
        let failed = || {
            let needed = "it must be finite in the subspace";
            Error::Scene { quantity: "stiffness matrix", needed }.within(REDUCED)
        };
        let (mut values, own) = symmetric_modes(&rows, free).ok_or_else(failed)?;
        let top = largest(&values);
        values.iter_mut().filter(|value| value.abs() <= ZERO * top).for_each(|value| *value = 0.0);
        let nonzero = values.iter().filter(|value| **value != 0.0);
        let ratio = nonzero.fold(top, |least, value| value.abs().min(least)) / top;
        if ratio < LEAST {
            let quantity = "lowest eigenvalue besides zero, relative to the highest,";
            let needed = "at least 1e-10, from which double precision tells it from zero";
            return Err(Error::Input { quantity, value: ratio, needed }.within(REDUCED));
        }
        let mut combinations = vec![0.0; count * count];
        (0..fixed).for_each(|i| combinations[i * (count + 1)] = 1.0);
        for (i, row) in own.chunks_exact(free.max(1)).enumerate() {
            combinations[(fixed + i) * count + fixed..(fixed + i + 1) * count].copy_from_slice(row);
        }
        let [mut products, mut modal] = [(); 2].map(|()| vec![0.0; count * count]);
        add_combined_rows(damping, &combinations, count, 1.0, &mut products);
        add_combined_rows(&combinations, &products, count, 1.0, &mut modal);
        let damping: Vec<f64> = (0..count).map(|j| modal[j * (count + 1)]).collect();
        (0..count).for_each(|j| modal[j * (count + 1)] = 0.0);
        let coupling = largest(&modal) / largest(&damping);
        if coupling > DECOUPLED {
            let quantity =
                "coupling of the modes by the damping, relative to its largest modal coefficient,";
            let needed = "rounding, as that of proportional damping is";
            return Err(Error::Input { quantity, value: coupling, needed }.within(REDUCED));
        }
        let mut stiffness = vec![0.0; fixed];
        stiffness.extend(values);
        Ok(Ritz { stiffness, damping, combinations })
    }

    /// Forces without their resultants on the vectors, and the momenta of the vectors.
    ///
    /// If these are rigid motions, responses to the rest do not hide deformations behind them.
    pub(crate) fn balanced(&self, mut forces: Vec<f64>) -> Vec<f64> {
        let resultants = row_products(&self.vectors, &forces, self.order());
        add_combined_rows(&resultants, &self.momenta, self.order(), -1.0, &mut forces);
        forces.extend_from_slice(&self.momenta);
        forces
    }

    /// Products of the vectors from number `first` on with the rows of F, a row for each vector.
    pub(crate) fn products(&self, first: usize, rows: &[f64]) -> Vec<f64> {
        row_products(&self.vectors[first * self.order()..], rows, self.order())
    }

    /// F Φᵀ: the rows of F in terms of the modes, from the products of all vectors.
    pub(crate) fn shares(modes: &Ritz, products: &[f64]) -> Vec<f64> {
        let count = modes.stiffness.len();
        let mut shares = vec![0.0; products.len()];
        add_combined_rows(products, &modes.combinations, count, 1.0, &mut shares);
        shares
    }

    /// The modes in degrees of freedom; of the first vectors, if some were added later.
    pub(crate) fn basis(&self, modes: &Ritz) -> ModalBasis {
        let count = modes.stiffness.len();
        let own = &self.vectors[..count * self.order()];
        let mut vectors = vec![0.0; own.len()];
        add_combined_rows(own, &modes.combinations, count, 1.0, &mut vectors);
        ModalBasis::of(modes.stiffness.clone(), modes.damping.clone(), vectors)
    }
}

/// Weights, a row each, of orthonormal combinations of vectors with these scalar products.
///
/// Gram–Schmidt, the longest remainder first, while its square exceeds `least`. Vectors of separate parts stay
/// separate.
fn independent(mut products: Vec<f64>, count: usize, least: f64) -> Vec<f64> {
    let mut rest: Vec<Vec<f64>> =
        (0..count).map(|i| (0..count).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    let mut weights = Vec::new();
    let mut left: Vec<usize> = (0..count).collect();
    let length = |products: &[f64], i: usize| products[i * (count + 1)];
    while let Some(at) = (0..left.len())
        .max_by(|a, b| length(&products, left[*a]).total_cmp(&length(&products, left[*b])))
        .filter(|at| length(&products, left[*at]) > least)
    {
        let chosen = left.swap_remove(at);
        let scale = length(&products, chosen).sqrt().recip();
        let own: Vec<f64> = rest[chosen].iter().map(|weight| scale * weight).collect();
        let shares: Vec<f64> = (0..count).map(|j| scale * products[chosen * count + j]).collect();
        for &i in &left {
            rest[i].iter_mut().zip(&own).for_each(|(weight, own)| *weight -= shares[i] * own);
            let row = &mut products[i * count..(i + 1) * count];
            row.iter_mut().zip(&shares).for_each(|(product, share)| *product -= shares[i] * share);
        }
        weights.extend(own);
    }
    weights
}

/// The columns of a row-major matrix, one after the other.
pub(crate) fn transpose(rows: &[f64], columns: usize) -> Vec<f64> {
    (0..columns).flat_map(|j| rows.iter().skip(j).step_by(columns).copied()).collect()
}
