//! Vectors that are orthonormal with respect to a mass matrix.
//!
//! | symbol | meaning |
//! |---|---|
//! | M | mass matrix |
//! | V | matrix of the vectors, a row each, V M Vᵀ = 1 |

use super::matrix::SparseMatrix;
use super::product::{add_combined_rows, largest, row_products, symmetric_products};

/// M-orthonormal rows V, stored with V M.
pub struct OrthonormalRows<'a> {
    mass: &'a SparseMatrix,
    /// Largest error of V M Vᵀ that needs no second pass of orthogonalisation.
    tolerance: f64,
    /// V, row-major.
    vectors: Vec<f64>,
    /// V M, row-major.
    momenta: Vec<f64>,
}

/// Smallest remainder of a row for which the row is a new direction.
///
/// The remainder is the length, in the norm of M, of the component orthogonal to V.
#[derive(Clone, Copy)]
pub enum MinRemainder {
    /// Relative to the length of the row.
    Fraction(f64),
    /// Absolute.
    Length(f64),
}

/// Smallest length of a row after the second pass.
///
/// An independent row of unit length keeps nearly all its length.
const MIN_SECOND_PASS_LENGTH: f64 = 0.5;

impl<'a> OrthonormalRows<'a> {
    /// Empty set of rows.
    ///
    /// `tolerance`: largest error of V M Vᵀ that needs no second pass of orthogonalisation.
    pub fn new(mass: &'a SparseMatrix, tolerance: f64) -> Self {
        Self { mass, tolerance, vectors: Vec::new(), momenta: Vec::new() }
    }

    /// M.
    pub fn mass(&self) -> &'a SparseMatrix {
        self.mass
    }

    /// V.
    pub fn vectors(&self) -> &[f64] {
        &self.vectors
    }

    /// V, without V M.
    pub fn into_vectors(self) -> Vec<f64> {
        self.vectors
    }

    /// V M.
    pub fn momenta(&self) -> &[f64] {
        &self.momenta
    }

    /// Number of rows.
    pub fn count(&self) -> usize {
        self.vectors.len() / self.mass.order().max(1)
    }

    /// Adds the rows of `block` whose remainders exceed `min_remainder`, after orthogonalisation.
    pub fn extend(&mut self, mut block: Vec<f64>, min_remainder: MinRemainder) {
        let n = self.mass.order().max(1);
        let old_count = self.count();
        let mut block_momenta = vec![0.0; block.len()];
        // The block and its orthogonalised copy exchange their memory after each pass.
        let mut orthogonal_rows = vec![0.0; block.len()];
        let mut projections = row_products(&self.momenta, &block, n);
        for pass in 0..2 {
            let count = block.len() / n;
            if old_count > 0 {
                add_combined_rows(&projections, &self.vectors, n, -1.0, &mut block);
            }
            block_momenta.truncate(block.len());
            self.mass.multiply_many(&block, &mut block_momenta);
            let mut products = symmetric_products(&block_momenta, &block, n);
            // Lengths of the rows before their projections were subtracted.
            let mut lengths = Vec::with_capacity(count);
            for i in 0..count {
                let projected_square: f64 =
                    (0..old_count).map(|j| projections[j * count + i].powi(2)).sum();
                lengths.push((projected_square + products[i * (count + 1)]).sqrt());
            }
            let mut scales = vec![1.0; count];
            let mut max_length = largest(&lengths);
            if pass == 0 && matches!(min_remainder, MinRemainder::Fraction(_)) {
                for (scale, length) in scales.iter_mut().zip(&lengths) {
                    *scale = if *length > 0.0 { length.recip() } else { 0.0 };
                }
                max_length = 1.0;
            }
            for (k, product) in products.iter_mut().enumerate() {
                *product *= scales[k / count] * scales[k % count];
            }
            let min_length = match min_remainder {
                MinRemainder::Fraction(remainder) | MinRemainder::Length(remainder)
                    if pass == 0 =>
                {
                    remainder
                }
                _ => MIN_SECOND_PASS_LENGTH,
            };
            let mut weights = independent_combinations(products, count, min_length * min_length);
            // Weights are reciprocals of remainders: rows with short remainders have large rounding errors.
            let rounding_error = f64::EPSILON * (max_length * largest(&weights)).powi(2);
            let rank = weights.len() / count.max(1);
            for row in weights.chunks_exact_mut(count.max(1)) {
                row.iter_mut().zip(&scales).for_each(|(weight, scale)| *weight *= scale);
            }
            let weight_columns = transpose(&weights, count);
            orthogonal_rows.clear();
            append_combined_rows(&weight_columns, &block, n, rank, &mut orthogonal_rows);
            if pass == 0 {
                projections = row_products(&self.momenta, &orthogonal_rows, n);
            }
            if pass == 1 || rounding_error.max(largest(&projections)) < self.tolerance {
                append_combined_rows(&weight_columns, &block_momenta, n, rank, &mut self.momenta);
                self.vectors.append(&mut orthogonal_rows);
                return;
            }
            std::mem::swap(&mut block, &mut orthogonal_rows);
        }
    }
}

/// Appends `count` combinations of `rows`, each of length `order`, to `destination`.
fn append_combined_rows(
    weights: &[f64],
    rows: &[f64],
    order: usize,
    count: usize,
    destination: &mut Vec<f64>,
) {
    let start = destination.len();
    destination.resize(start + count * order, 0.0);
    add_combined_rows(weights, rows, order, 1.0, &mut destination[start..]);
}

/// Weights of orthonormal combinations of vectors, a row each, from the vectors' scalar products.
///
/// Gram–Schmidt orthogonalisation of `count` vectors with the row-major `products`, the longest remainder first, while
/// the square of its length exceeds `min_square`. A vector that is orthogonal to all others has the weight zero in
/// every combination but its own.
pub fn independent_combinations(mut products: Vec<f64>, count: usize, min_square: f64) -> Vec<f64> {
    let mut remainder_weights: Vec<Vec<f64>> = (0..count)
        .map(|i| (0..count).map(|j| f64::from(u8::from(i == j))).collect())
        .collect();
    let mut weights = Vec::new();
    let mut candidates: Vec<usize> = (0..count).collect();
    let squared_length = |products: &[f64], i: usize| products[i * (count + 1)];
    while let Some(candidate_index) = (0..candidates.len())
        .max_by(|a, b| {
            squared_length(&products, candidates[*a])
                .total_cmp(&squared_length(&products, candidates[*b]))
        })
        .filter(|index| squared_length(&products, candidates[*index]) > min_square)
    {
        let pivot = candidates.swap_remove(candidate_index);
        let scale = squared_length(&products, pivot).sqrt().recip();
        let pivot_weights: Vec<f64> =
            remainder_weights[pivot].iter().map(|weight| scale * weight).collect();
        let projections: Vec<f64> =
            (0..count).map(|j| scale * products[pivot * count + j]).collect();
        for &i in &candidates {
            for (weight, pivot_weight) in remainder_weights[i].iter_mut().zip(&pivot_weights) {
                *weight -= projections[i] * pivot_weight;
            }
            let row = &mut products[i * count..(i + 1) * count];
            for (product, projection) in row.iter_mut().zip(&projections) {
                *product -= projections[i] * projection;
            }
        }
        weights.extend(pivot_weights);
    }
    weights
}

/// The columns of a row-major matrix, one after the other.
pub fn transpose(matrix: &[f64], column_count: usize) -> Vec<f64> {
    (0..column_count)
        .flat_map(|j| matrix.iter().skip(j).step_by(column_count).copied())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Triplets;

    fn sample(k: usize) -> f64 {
        (0.37 * (k * k) as f64).sin()
    }

    /// Blocks whose rows differ from the previous rows by a fraction `new_fraction` become orthonormal.
    #[test]
    fn rows_are_orthonormal_after_one_pass_or_two() {
        const N: usize = 200;
        let mut mass = Triplets::new(N);
        for i in 1..N {
            mass.add(i, i, 1.0 + 0.1 * i as f64);
            mass.add_spring(i - 1, i, 0.7);
        }
        let mass = SparseMatrix::new("mass", &mass).unwrap();
        for new_fraction in [1.0, 0.03, 1e-2, 1e-4, 1e-6] {
            let mut rows = OrthonormalRows::new(&mass, 1e-12);
            let mut block_rows: Vec<f64> = (0..8 * N).map(sample).collect();
            rows.extend(block_rows.clone(), MinRemainder::Fraction(1e-9));
            for block_index in 1..10 {
                for (k, value) in block_rows.iter_mut().enumerate() {
                    *value += new_fraction * sample(k + 8 * N * block_index);
                }
                rows.extend(block_rows.clone(), MinRemainder::Fraction(1e-9));
            }
            rows.extend(
                (0..8 * N).map(|k| new_fraction * sample(k + 31)).collect(),
                MinRemainder::Length(1e-9),
            );
            assert_eq!(rows.count(), 88);
            for momenta in [rows.momenta(), &mass.times(rows.vectors())] {
                let mut products = row_products(rows.vectors(), momenta, N);
                (0..88).for_each(|i| products[89 * i] -= 1.0);
                assert!(largest(&products) < 2e-12, "{new_fraction:e}: {:e}", largest(&products));
            }
        }
    }
}
