//! Modes of an extended subspace, without the vectors of its extension.
//!
//! The extension is a block of responses.
//!
//! | symbol | meaning |
//! |---|---|
//! | V | vectors of the subspace, V M Vᵀ = 1 |
//! | F | weights of the degrees of freedom in forces and in probes |
//! | X, D | a block of vectors, and its directions outside V |
//!
//! All vectors are rows.

use crate::coupled::assembly::subspace::{RitzModes, Subspace, bordered, proportional_damping};
use crate::coupled::scheme::SchemeCoefficients;
use crate::error::Result;
use crate::linalg::orthonormal::{independent_combinations, transpose};
use crate::linalg::{add_combined_rows, row_products, symmetric_products};

impl Subspace<'_> {
    /// Modes of the extended space, and the products of its vectors with F.
    ///
    /// The vectors themselves are not computed.
    ///
    /// `block` has the responses K_eff⁻¹ f to the inertia f of the vectors from index `first` on, with the scheme's factor.
    /// Directions shorter than `min_length` are omitted. `products` are the products of the vectors with the `rows` of F.
    pub(crate) fn extended_ritz(
        &self,
        (block, first): (&[f64], usize),
        c: &SchemeCoefficients,
        (products, rows): (&[f64], &[f64]),
        min_length: f64,
    ) -> Result<(RitzModes, Vec<f64>)> {
        let order = self.order();
        let vector_count = self.count();
        let block_size = block.len() / order;
        let row_count = rows.len() / order;
        // X M Vᵀ and X M Xᵀ.
        let overlaps = row_products(block, self.rows.momenta(), order);
        let inertia = symmetric_products(&self.rows.mass().times(block), block, order);
        let terms = self.extended_terms(&overlaps, &inertia, block_size, min_length);
        let total_count = vector_count + block_size;
        let extended_count = terms.len() / total_count;
        let projected_matrix = |k: usize, border: &[f64], zero_columns: usize| {
            let matrix = bordered(&self.projected_matrices[k], border, total_count, zero_columns);
            row_products(&row_products(&terms, &matrix, total_count), &terms, total_count)
        };
        let matrices = if let Some(damping_factors) = self.damping_factors {
            let border = self.stiffness_border(&overlaps, &inertia, first, c, damping_factors);
            let stiffness = projected_matrix(1, &border, self.translation_count);
            [proportional_damping(&stiffness, extended_count, damping_factors), stiffness]
        } else {
            let damping = projected_matrix(0, &self.border(0, block), 0);
            [damping, projected_matrix(1, &self.border(1, block), self.translation_count)]
        };
        let products = [products, &row_products(block, rows, order)].concat();
        let mut extended_products = vec![0.0; extended_count * row_count];
        let columns = transpose(&terms, total_count);
        add_combined_rows(&columns, &products, row_count, 1.0, &mut extended_products);
        Ok((self.ritz_of(extended_count, &matrices)?, extended_products))
    }

    /// Weights of V and X in the extended basis [V; D].
    ///
    /// `overlaps` is X M Vᵀ, `inertia` X M Xᵀ. Directions shorter than `min_length` are omitted.
    fn extended_terms(
        &self,
        overlaps: &[f64],
        inertia: &[f64],
        block_size: usize,
        min_length: f64,
    ) -> Vec<f64> {
        let vector_count = self.count();
        // X M Xᵀ without the components inside V.
        let inner_inertia = row_products(overlaps, overlaps, vector_count);
        let outer_inertia =
            inertia.iter().zip(&inner_inertia).map(|(whole, inner)| whole - inner).collect();
        let weights = independent_combinations(outer_inertia, block_size, min_length * min_length);
        let total_count = vector_count + block_size;
        let mut terms = vec![0.0; vector_count * total_count];
        (0..vector_count).for_each(|i| terms[i * (total_count + 1)] = 1.0);
        for row in weights.chunks_exact(block_size.max(1)) {
            let mut direction = [vec![0.0; vector_count], row.to_vec()].concat();
            let vector_terms = &mut direction[..vector_count];
            add_combined_rows(row, overlaps, vector_count, -1.0, vector_terms);
            terms.extend(direction);
        }
        terms
    }

    /// Products X K [V; X]ᵀ of a block X of responses, for proportional damping.
    ///
    /// The responses are K_eff⁻¹ f, and the damping is βK + αM. K_eff is then a combination of M and K, and K X
    /// follows from K_eff X = f and M X.
    fn stiffness_border(
        &self,
        overlaps: &[f64],
        inertia: &[f64],
        first_index: usize,
        c: &SchemeCoefficients,
        [beta, alpha]: [f64; 2],
    ) -> Vec<f64> {
        let vector_count = self.count();
        let block_size = overlaps.len() / vector_count.max(1);
        let total_count = vector_count + block_size;
        let inertia_factor = c.acceleration[0];
        let mass_factor = inertia_factor + alpha * c.velocity[0];
        let stiffness_factor = c.displacement[0] + beta * c.velocity[0];
        let mut border = Vec::with_capacity(block_size * total_count);
        for row in 0..block_size {
            for vector in 0..total_count {
                let (force_product, mass_product) = if vector < vector_count {
                    let is_loaded = vector == first_index + row;
                    (f64::from(u8::from(is_loaded)), overlaps[row * vector_count + vector])
                } else {
                    let column = vector - vector_count;
                    (
                        overlaps[column * vector_count + first_index + row],
                        inertia[row * block_size + column],
                    )
                };
                let product = inertia_factor * force_product - mass_factor * mass_product;
                border.push(product / stiffness_factor);
            }
        }
        border
    }

    /// Products of a block X: X C [V; X]ᵀ for `k` = 0, X K [V; X]ᵀ for `k` = 1.
    fn border(&self, k: usize, block: &[f64]) -> Vec<f64> {
        let images = self.matrices[k].times(block);
        let with_vectors = row_products(&images, self.rows.vectors(), self.order());
        let within_block = row_products(&images, block, self.order());
        let block_size = block.len() / self.order();
        let block_rows = within_block.chunks_exact(block_size.max(1));
        let rows = with_vectors.chunks_exact(self.count()).zip(block_rows);
        rows.flat_map(|(vectors, block)| [vectors, block].concat()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::{SparseFactor, SparseMatrix, Triplets, largest};

    /// A chain with a rigid translation, and damping in proportion to mass and stiffness.
    #[test]
    fn modes_of_an_extended_space_need_no_vectors() {
        let n = 40;
        let mut mass = Triplets::new(n);
        let mut stiffness = Triplets::new(n);
        for i in 0..n {
            mass.add(i, i, 1.0 + 0.1 * (i as f64).sin());
            if i > 0 {
                stiffness.add_spring(i - 1, i, 50.0 + 20.0 * (i as f64).cos());
                mass.add(i, i - 1, 0.1);
                mass.add(i - 1, i, 0.1);
            }
        }
        let mass = SparseMatrix::new("test", &mass).unwrap();
        let stiffness = SparseMatrix::new("test", &stiffness).unwrap();
        let sum = |[m, k]: [f64; 2]| SparseMatrix::sum("test", n, &[(k, &stiffness), (m, &mass)]);
        let damping = sum([0.3, 0.02]).unwrap();
        let c = SchemeCoefficients {
            displacement: [0.5, 0.0, 0.0],
            velocity: [2.0, 0.0, 0.0],
            acceleration: [6.0, 0.0, 0.0],
            new_velocity: [0.0; 3],
            new_acceleration: [0.0; 3],
            load_fraction: 1.0,
        };
        let effective = sum([6.0 + 0.6, 0.5 + 0.04]).unwrap();
        let factor = SparseFactor::positive_definite("test", &effective).unwrap();

        let wave = |k: usize| (0..n).map(move |i| (0.3 * (k * i) as f64).sin());
        let rows: Vec<f64> = [wave(11), wave(13)].into_iter().flatten().collect();
        for is_proportional in [true, false] {
            let mut space = Subspace::new([&mass, &damping, &stiffness], vec![1.0; n], 0.0);
            assert!(space.damping_factors.is_some());
            if !is_proportional {
                // The general method must give the same result.
                space.damping_factors = None;
            }
            space.extend((1..4).flat_map(wave).collect(), 1e-7);
            let first_index = space.count();
            space.extend((4..10).flat_map(wave).collect(), 1e-7);
            let mut block: Vec<f64> = space.momenta(first_index).iter().map(|f| 6.0 * f).collect();
            factor.solve_many(&mut block);
            let products = space.products(0, &rows);
            // Longer than one of the directions, which is therefore omitted.
            let min_length = 0.04;
            let predicted_modes = space
                .extended_ritz((&block, first_index), &c, (&products, &rows), min_length)
                .unwrap();
            space.extend_by_length(block, min_length);
            assert!((11..16).contains(&space.count()), "{}", space.count());
            let expected = space.ritz().unwrap();
            let products = space.products(0, &rows);
            let assert_close = |a: &[f64], b: &[f64]| {
                let tolerance = 1e-10 * largest(b);
                assert_eq!(a.len(), b.len());
                assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < tolerance), "{a:?} for {b:?}");
            };
            assert_close(&predicted_modes.0.stiffness, &expected.stiffness);
            assert_close(&predicted_modes.0.damping, &expected.damping);
            let squares = |modes: &RitzModes, products: &[f64]| -> Vec<f64> {
                Subspace::modal_rows(modes, products).iter().map(|value| value * value).collect()
            };
            assert_close(
                &squares(&predicted_modes.0, &predicted_modes.1),
                &squares(&expected, &products),
            );
        }
    }
}
