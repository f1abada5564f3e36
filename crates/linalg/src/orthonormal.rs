//! Rows that are orthonormal with respect to a mass matrix.
//!
//! | symbol | meaning |
//! |---|---|
//! | V | rows, V M Vᵀ = 1 |

use super::matrix::SparseMatrix;
use super::product::{add_combined_rows, largest, row_products, symmetric_products};

/// M-orthonormal rows V, with V M, to which rows can be added.
pub struct OrthonormalRows<'a> {
    mass: &'a SparseMatrix,
    /// Largest error of V M Vᵀ for which one pass of orthogonalisation is enough.
    tolerance: f64,
    vectors: Vec<f64>,
    momenta: Vec<f64>,
}

/// Smallest component outside V for which a row counts as a new direction.
#[derive(Clone, Copy)]
pub enum MinRemainder {
    /// Relative to the length of the row.
    Fraction(f64),
    /// Length, in the norm of M.
    Length(f64),
}

impl<'a> OrthonormalRows<'a> {
    /// Empty set of rows.
    ///
    /// `tolerance`: a second pass of orthogonalisation follows where the error of V M Vᵀ may be larger.
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

    /// Adds the directions of `block` whose component outside V exceeds `min_remainder`.
    pub fn extend(&mut self, mut block: Vec<f64>, min_remainder: MinRemainder) {
        let n = self.mass.order().max(1);
        let count_before = self.count();
        // The block and its orthogonalised copy exchange their buffers after each pass.
        let mut images = vec![0.0; block.len()];
        let mut orthogonal = vec![0.0; block.len()];
        let mut projections = row_products(&self.momenta, &block, n);
        for pass in 0..2 {
            let count = block.len() / n;
            if count_before > 0 {
                add_combined_rows(&projections, &self.vectors, n, -1.0, &mut block);
            }
            images.truncate(block.len());
            self.mass.multiply_many(&block, &mut images);
            let mut products = symmetric_products(&images, &block, n);
            let mut lengths = Vec::with_capacity(count);
            for i in 0..count {
                let inside: f64 =
                    (0..count_before).map(|j| projections[j * count + i].powi(2)).sum();
                lengths.push((inside + products[i * (count + 1)]).sqrt());
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
                MinRemainder::Fraction(length) | MinRemainder::Length(length) if pass == 0 => {
                    length
                }
                _ => 0.5,
            };
            let mut weights = independent_combinations(products, count, min_length * min_length);
            // The weight of a row on itself is the reciprocal of its remainder: short remainders have
            // larger rounding errors.
            let rounding = f64::EPSILON * (max_length * largest(&weights)).powi(2);
            let rank = weights.len() / count.max(1);
            for row in weights.chunks_exact_mut(count.max(1)) {
                row.iter_mut().zip(&scales).for_each(|(weight, scale)| *weight *= scale);
            }
            let columns = transpose(&weights, count);
            orthogonal.clear();
            append_combined_rows(&columns, &block, n, rank, &mut orthogonal);
            if pass == 0 {
                projections = row_products(&self.momenta, &orthogonal, n);
            }
            if pass == 1 || rounding.max(largest(&projections)) < self.tolerance {
                append_combined_rows(&columns, &images, n, rank, &mut self.momenta);
                self.vectors.append(&mut orthogonal);
                return;
            }
            std::mem::swap(&mut block, &mut orthogonal);
        }
    }
}

/// Appends `count` combinations of `rows`, each of length `order`, to `sum`.
fn append_combined_rows(
    weights: &[f64],
    rows: &[f64],
    order: usize,
    count: usize,
    sum: &mut Vec<f64>,
) {
    let start = sum.len();
    sum.resize(start + count * order, 0.0);
    add_combined_rows(weights, rows, order, 1.0, &mut sum[start..]);
}

/// Weights, a row each, of orthonormal combinations of vectors with these scalar products.
///
/// Gram–Schmidt, the longest remainder first, while its square exceeds `min_square`. Vectors of separate parts
/// stay separate.
pub fn independent_combinations(mut products: Vec<f64>, count: usize, min_square: f64) -> Vec<f64> {
    let mut remainders: Vec<Vec<f64>> = (0..count)
        .map(|i| (0..count).map(|j| f64::from(u8::from(i == j))).collect())
        .collect();
    let mut weights = Vec::new();
    let mut candidates: Vec<usize> = (0..count).collect();
    let square = |products: &[f64], i: usize| products[i * (count + 1)];
    while let Some(place) = (0..candidates.len())
        .max_by(|a, b| {
            square(&products, candidates[*a]).total_cmp(&square(&products, candidates[*b]))
        })
        .filter(|place| square(&products, candidates[*place]) > min_square)
    {
        let pivot = candidates.swap_remove(place);
        let scale = square(&products, pivot).sqrt().recip();
        let pivot_weights: Vec<f64> =
            remainders[pivot].iter().map(|weight| scale * weight).collect();
        let projections: Vec<f64> =
            (0..count).map(|j| scale * products[pivot * count + j]).collect();
        for &i in &candidates {
            for (weight, pivot_weight) in remainders[i].iter_mut().zip(&pivot_weights) {
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
pub fn transpose(rows: &[f64], columns: usize) -> Vec<f64> {
    (0..columns).flat_map(|j| rows.iter().skip(j).step_by(columns).copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Triplets;

    fn sample(k: usize) -> f64 {
        (0.37 * (k * k) as f64).sin()
    }

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
        for outside in [1.0, 0.03, 1e-2, 1e-4, 1e-6] {
            let mut rows = OrthonormalRows::new(&mass, 1e-12);
            let mut last: Vec<f64> = (0..8 * N).map(sample).collect();
            rows.extend(last.clone(), MinRemainder::Fraction(1e-9));
            for block in 1..10 {
                for (k, value) in last.iter_mut().enumerate() {
                    *value += outside * sample(k + 8 * N * block);
                }
                rows.extend(last.clone(), MinRemainder::Fraction(1e-9));
            }
            rows.extend(
                (0..8 * N).map(|k| outside * sample(k + 31)).collect(),
                MinRemainder::Length(1e-9),
            );
            assert_eq!(rows.count(), 88);
            for momenta in [rows.momenta(), &mass.times(rows.vectors())] {
                let mut products = row_products(rows.vectors(), momenta, N);
                (0..88).for_each(|i| products[89 * i] -= 1.0);
                assert!(largest(&products) < 2e-12, "{outside:e}: {:e}", largest(&products));
            }
        }
    }
}
