//! Rows that are orthonormal with respect to a mass matrix.
//!
//! | symbol | meaning |
//! |---|---|
//! | V | rows, V M Vᵀ = 1 |

use super::matrix::SparseMatrix;
use super::product::{add_combined_rows, largest, row_products, symmetric_products};

/// V and V M.
pub(crate) struct OrthonormalRows<'a> {
    mass: &'a SparseMatrix,
    /// Largest error of V M Vᵀ for which one pass of orthogonalisation is enough.
    rounding: f64,
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
    ///
    /// `rounding`: a second pass of orthogonalisation follows where V M Vᵀ errs by more.
    pub(crate) fn new(mass: &'a SparseMatrix, rounding: f64) -> Self {
        Self { mass, rounding, vectors: Vec::new(), momenta: Vec::new() }
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
        let mut shares = row_products(&self.momenta, &block, n);
        for pass in 0..2 {
            let count = block.len() / n;
            if before > 0 {
                add_combined_rows(&shares, &self.vectors, n, -1.0, &mut block);
            }
            images.truncate(block.len());
            self.mass.multiply_many(&block, &mut images);
            let mut products = symmetric_products(&images, &block, n);
            let length = |i: usize| {
                let inside: f64 = (0..before).map(|j| shares[j * count + i].powi(2)).sum();
                (inside + products[i * (count + 1)]).sqrt()
            };
            let lengths: Vec<f64> = (0..count).map(length).collect();
            let (scales, longest) = match (pass, least) {
                (0, Least::Fraction(_)) => {
                    let inverse = |length: &f64| if *length > 0.0 { length.recip() } else { 0.0 };
                    (lengths.iter().map(inverse).collect(), 1.0)
                }
                _ => (vec![1.0; count], largest(&lengths)),
            };
            for (k, product) in products.iter_mut().enumerate() {
                *product *= scales[k / count] * scales[k % count];
            }
            let least = match (pass, least) {
                (0, Least::Fraction(least) | Least::Length(least)) => least,
                _ => 0.5,
            };
            let mut weights = independent(products, count, least * least);
            // The weight of a row on itself is the reciprocal of its remainder: short ones have more rounding.
            let rounding = f64::EPSILON * (longest * largest(&weights)).powi(2);
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
            spare.clear();
            combine(&block, &mut spare);
            if pass == 0 {
                shares = row_products(&self.momenta, &spare, n);
            }
            if pass == 1 || rounding.max(largest(&shares)) < self.rounding {
                combine(&images, &mut self.momenta);
                self.vectors.append(&mut spare);
                return;
            }
            std::mem::swap(&mut block, &mut spare);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::Triplets;

    /// Rows of which a fraction `outside` is new, block after block, are orthonormal.
    #[test]
    fn rows_are_orthonormal_after_one_pass_or_two() {
        const N: usize = 200;
        let mut mass = Triplets::new(N);
        for i in 1..N {
            mass.add(i, i, 1.0 + 0.1 * i as f64);
            mass.add_spring(i - 1, i, 0.7);
        }
        let mass = SparseMatrix::new("mass", &mass).unwrap();
        let wave = |k: usize| (0.37 * (k * k) as f64).sin();
        for outside in [1.0, 0.03, 1e-2, 1e-4, 1e-6] {
            let mut rows = OrthonormalRows::new(&mass, 1e-12);
            let mut last: Vec<f64> = (0..8 * N).map(wave).collect();
            rows.extend(last.clone(), Least::Fraction(1e-9));
            for block in 1..10 {
                let new = |k: usize| wave(k + 8 * N * block);
                last = last.iter().enumerate().map(|(k, old)| old + outside * new(k)).collect();
                rows.extend(last.clone(), Least::Fraction(1e-9));
            }
            rows.extend((0..8 * N).map(|k| outside * wave(k + 31)).collect(), Least::Length(1e-9));
            assert_eq!(rows.count(), 88);
            for momenta in [rows.momenta(), &mass.times(rows.vectors())] {
                let mut products = row_products(rows.vectors(), momenta, N);
                (0..88).for_each(|i| products[89 * i] -= 1.0);
                assert!(largest(&products) < 2e-12, "{outside:e}: {:e}", largest(&products));
            }
        }
    }
}
