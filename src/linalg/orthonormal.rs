//! Rows that are orthonormal with respect to a mass matrix.
//!
//! | symbol | meaning |
//! |---|---|
//! | V | rows, V M Vᵀ = 1 |

use super::matrix::SparseMatrix;
use super::product::{add_combined_rows, row_products, symmetric_products};

/// V and V M.
pub(crate) struct OrthonormalRows<'a> {
    mass: &'a SparseMatrix,
    vectors: Vec<f64>,
    momenta: Vec<f64>,
}

/// Smallest part of a row outside V that makes a direction.
#[derive(Clone, Copy)]
pub(crate) enum Least {
    /// Relative to the length of the row.
    Fraction(f64),
    /// Length, in the norm of M.
    Length(f64),
}

impl<'a> OrthonormalRows<'a> {
    /// No rows.
    pub(crate) fn new(mass: &'a SparseMatrix) -> Self {
        Self { mass, vectors: Vec::new(), momenta: Vec::new() }
    }

    /// M.
    pub(crate) fn mass(&self) -> &'a SparseMatrix {
        self.mass
    }

    /// V.
    pub(crate) fn vectors(&self) -> &[f64] {
        &self.vectors
    }

    /// V, without V M.
    pub(crate) fn into_vectors(self) -> Vec<f64> {
        self.vectors
    }

    /// V M.
    pub(crate) fn momenta(&self) -> &[f64] {
        &self.momenta
    }

    /// Number of rows.
    pub(crate) fn count(&self) -> usize {
        self.vectors.len() / self.mass.order().max(1)
    }

    /// Adds the directions of `block` with more than `least` outside V.
    pub(crate) fn extend(&mut self, mut block: Vec<f64>, least: Least) {
        let (n, before) = (self.mass.order().max(1), self.count());
        // Large blocks are written into two buffers in turns.
        let [mut images, mut spare] = [(); 2].map(|()| vec![0.0; block.len()]);
        // Two passes remove rounding.
        for pass in 0..2 {
            let count = block.len() / n;
            let shares = row_products(&self.momenta, &block, n);
            if before > 0 {
                add_combined_rows(&shares, &self.vectors, n, -1.0, &mut block);
            }
            images.truncate(block.len());
            self.mass.multiply_many(&block, &mut images);
            let mut products = symmetric_products(&images, &block, n);
            let scales: Vec<f64> = (0..count)
                .map(|i| match (pass, least) {
                    (0, Least::Fraction(_)) => {
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
            let least = match (pass, least) {
                (0, Least::Fraction(least) | Least::Length(least)) => least,
                _ => 0.5,
            };
            let mut weights = independent(products, count, least * least);
            let kept = weights.len() / count.max(1);
            for row in weights.chunks_exact_mut(count.max(1)) {
                row.iter_mut().zip(&scales).for_each(|(weight, scale)| *weight *= scale);
            }
            let columns = transpose(&weights, count);
            let combine = |rows: &[f64], sum: &mut Vec<f64>| {
                let start = sum.len();
                sum.resize(start + kept * n, 0.0);
                add_combined_rows(&columns, rows, n, 1.0, &mut sum[start..]);
            };
            if pass == 1 {
                combine(&block, &mut self.vectors);
                combine(&images, &mut self.momenta);
            } else {
                spare.clear();
                combine(&block, &mut spare);
                std::mem::swap(&mut block, &mut spare);
            }
        }
    }
}

/// Weights, a row each, of orthonormal combinations of vectors with these scalar products.
///
/// Gram–Schmidt, the longest remainder first, while its square exceeds `least`. Vectors of separate parts stay
/// separate.
pub(crate) fn independent(mut products: Vec<f64>, count: usize, least: f64) -> Vec<f64> {
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
