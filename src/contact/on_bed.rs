//! W of a structure that moves many independent elements in few ways.
//!
//! | symbol | meaning |
//! |---|---|
//! | D | step compliance of the soil, a diagonal |
//! | L | factors of the structure's part per force: B K⁻¹ Bᵀ = L Lᵀ |
//! | A | areas of the elements |
//!
//! W = D + L Lᵀ A, with as many numbers as there are elements.

use crate::linalg::{
    DenseFactor, condition_by_products, dense_multiply_add, dot, pivoted_cholesky, scale_by,
    transposed_multiply_add,
};

/// Diagonal that the modes leave out, relative to the largest of W: rounding.
pub(super) const MODE_TOLERANCE: f64 = 1e-14;
/// Largest difference of a product with L Lᵀ from the structure's, relative to the largest number: asymmetry.
const PRODUCT_TOLERANCE: f64 = 1e-8;

/// W by its diagonal and its modes.
#[derive(Debug, Clone)]
pub(crate) struct OnBed {
    /// D, m/Pa, and A, for each contact component.
    soil: Vec<f64>,
    areas: Vec<f64>,
    /// L, row by row.
    modes: Vec<f64>,
    rank: usize,
}

/// The structure's part B K⁻¹ Bᵀ A of W.
pub(crate) struct StructurePart<C, P> {
    /// Its diagonal, m/Pa.
    pub(crate) diagonal: Vec<f64>,
    /// Overwrites a vector with the column at a place.
    pub(crate) column: C,
    /// Overwrites a vector with the product with another.
    pub(crate) product: P,
}

impl OnBed {
    /// W of a soil and a structure on elements with these areas; all lists have a number for each contact component.
    ///
    /// `None` if the structure's part has more than `max_rank` modes, or is not symmetric or not positive semi-definite per
    /// force.
    pub(crate) fn new(
        soil: &[f64],
        areas: Vec<f64>,
        max_rank: usize,
        mut structure: StructurePart<
            impl FnMut(usize, &mut [f64]),
            impl FnOnce(&[f64], &mut [f64]),
        >,
    ) -> Option<Self> {
        let size = soil.len();
        let diagonal: Vec<f64> =
            structure.diagonal.iter().zip(&areas).map(|(entry, area)| entry / area).collect();
        let max_diagonal = (0..size).map(|i| soil[i] / areas[i] + diagonal[i]).fold(0.0, f64::max);
        let tolerance = MODE_TOLERANCE * max_diagonal;
        let factors = pivoted_cholesky(diagonal, tolerance, max_rank, |pivot, column| {
            (structure.column)(pivot, column);
            for value in column {
                *value /= areas[pivot];
            }
        })?;
        let rank = factors.len();
        let modes = (0..size).flat_map(|i| factors.iter().map(move |factor| factor[i])).collect();
        let found = Self { soil: soil.to_vec(), areas, modes, rank };
        let mut expected = vec![0.0; size];
        let mut product = vec![0.0; size];
        let traction: Vec<f64> = found
            .areas
            .iter()
            .enumerate()
            .map(|(i, area)| (1.0 + i as f64).sin() / area)
            .collect();
        (structure.product)(&traction, &mut expected);
        found.add_modes(&traction, &mut product);
        let largest = expected.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
        let is_symmetric = expected
            .iter()
            .zip(&product)
            .all(|(expected, found)| (expected - found).abs() <= PRODUCT_TOLERANCE * largest);
        is_symmetric.then_some(found)
    }

    /// Soil's step compliance of a contact component, m/Pa.
    pub(super) fn soil(&self, place: usize) -> f64 {
        self.soil[place]
    }

    /// Numbers of L of a contact component.
    pub(super) fn modes(&self, place: usize) -> &[f64] {
        &self.modes[place * self.rank..][..self.rank]
    }

    /// Number of modes.
    pub(super) fn rank(&self) -> usize {
        self.rank
    }

    /// Entry on the diagonal of W.
    pub(super) fn diagonal(&self, place: usize) -> f64 {
        let modes = self.modes(place);
        self.soil[place] + dot(modes, modes) * self.areas[place]
    }

    /// jump ← jump + W τ.
    pub(super) fn multiply_add(&self, traction: &[f64], jump: &mut [f64]) {
        jump.iter_mut()
            .zip(&self.soil)
            .zip(traction)
            .for_each(|((jump, soil), traction)| *jump += soil * traction);
        self.add_modes(traction, jump);
    }

    /// jump ← jump + L Lᵀ A τ.
    fn add_modes(&self, traction: &[f64], jump: &mut [f64]) {
        if self.rank == 0 {
            return;
        }
        let forces: Vec<f64> = self.areas.iter().zip(traction).map(|(a, t)| a * t).collect();
        let mut amplitudes = vec![0.0; self.rank];
        transposed_multiply_add(&self.modes, 1.0, &forces, &mut amplitudes);
        dense_multiply_add(&self.modes, 1.0, &amplitudes, jump);
    }

    /// Condition of W, scaled by its diagonal; infinite if it is singular.
    ///
    /// (D A⁻¹ + L Lᵀ)⁻¹ = S − S L (1 + Lᵀ S L)⁻¹ Lᵀ S with S = A D⁻¹ (Woodbury 1950).
    pub(super) fn condition(&self) -> f64 {
        let size = self.soil.len();
        let rank = self.rank;
        let stiffness: Vec<f64> = self.areas.iter().zip(&self.soil).map(|(a, d)| a / d).collect();
        let mut matrix = vec![0.0; rank * rank];
        for (i, stiffness) in stiffness.iter().enumerate() {
            let modes = self.modes(i);
            for (row, entry) in matrix.chunks_exact_mut(rank.max(1)).zip(modes) {
                row.iter_mut()
                    .zip(modes)
                    .for_each(|(sum, other)| *sum += stiffness * entry * other);
            }
        }
        matrix.iter_mut().step_by(rank + 1).for_each(|entry| *entry += 1.0);
        let mut factor = DenseFactor::with_capacity(rank);
        if !factor.factor(&matrix, rank) {
            return f64::INFINITY;
        }
        let reciprocals: Vec<f64> = self.areas.iter().map(|area| area.recip()).collect();
        let diagonal: Vec<f64> = (0..size).map(|i| self.diagonal(i)).collect();
        // Wᵀ is A W A⁻¹.
        let multiply = |x: &mut [f64], transposed: bool| {
            if transposed {
                scale_by(x, &reciprocals);
            }
            let mut product = vec![0.0; size];
            self.multiply_add(x, &mut product);
            x.copy_from_slice(&product);
            if transposed {
                scale_by(x, &self.areas);
            }
        };
        let solve = |x: &mut [f64], transposed: bool| {
            if transposed {
                scale_by(x, &reciprocals);
            }
            scale_by(x, &stiffness);
            if rank > 0 {
                let mut amplitudes = vec![0.0; rank];
                transposed_multiply_add(&self.modes, 1.0, x, &mut amplitudes);
                factor.solve(&mut amplitudes);
                let mut moved = vec![0.0; size];
                dense_multiply_add(&self.modes, 1.0, &amplitudes, &mut moved);
                scale_by(&mut moved, &stiffness);
                x.iter_mut().zip(&moved).for_each(|(x, moved)| *x -= moved);
            }
            if !transposed {
                scale_by(x, &reciprocals);
            }
        };
        condition_by_products(&diagonal, multiply, solve)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::dense_condition;
    use basemat_testkit::random::Random;

    /// A random soil, areas, and a structure B M Bᵀ A of this rank; W of it, entry by entry.
    fn random_parts(random: &mut Random, size: usize, rank: usize) -> ([Vec<f64>; 2], Vec<f64>) {
        let soil: Vec<f64> = (0..size).map(|_| random.log_within(1e-2, 1.0)).collect();
        let areas: Vec<f64> = (0..size).map(|_| random.within(0.5, 2.0)).collect();
        let root: Vec<f64> = (0..size * rank).map(|_| random.within(-1.0, 1.0)).collect();
        let part = (0..size * size).map(|k| {
            let rows = [k / size, k % size].map(|i| &root[i * rank..][..rank]);
            areas[k % size] * dot(rows[0], rows[1])
        });
        let part = part.collect();
        ([soil, areas], part)
    }

    fn on_bed([soil, areas]: &[Vec<f64>; 2], part: &[f64], max_rank: usize) -> Option<OnBed> {
        let size = soil.len();
        let structure = StructurePart {
            diagonal: (0..size).map(|i| part[i * (size + 1)]).collect(),
            column: |j, out: &mut [f64]| (0..size).for_each(|i| out[i] = part[i * size + j]),
            product: |x: &[f64], out: &mut [f64]| dense_multiply_add(part, 1.0, x, out),
        };
        OnBed::new(soil, areas.clone(), max_rank, structure)
    }

    /// REFERENCE: all entries of W.
    #[test]
    fn product_diagonal_and_condition_are_those_of_all_entries() {
        let mut random = Random(5);
        for case in 0..200 {
            let size = 12 + case % 9;
            let rank = case % 5;
            let (lists, part) = random_parts(&mut random, size, rank);
            let found = on_bed(&lists, &part, 5).unwrap();
            assert_eq!(found.rank(), rank);
            let mut whole = part.clone();
            (0..size).for_each(|i| whole[i * (size + 1)] += lists[0][i]);
            let traction: Vec<f64> = (0..size).map(|_| random.within(-1.0, 1.0)).collect();
            let mut product = vec![1.0; size];
            let mut expected = vec![1.0; size];
            found.multiply_add(&traction, &mut product);
            dense_multiply_add(&whole, 1.0, &traction, &mut expected);
            for i in 0..size {
                assert!(
                    (product[i] - expected[i]).abs() < 1e-12,
                    "{case}: {product:?} {expected:?}"
                );
                assert!((found.diagonal(i) - whole[i * (size + 1)]).abs() < 1e-12, "{case}");
            }
            let ratio = found.condition() / dense_condition(&whole, size);
            assert!((0.3..1.0001).contains(&ratio), "{case}: {ratio}");
        }
    }

    #[test]
    fn other_structures_have_no_modes() {
        let mut random = Random(6);
        let (lists, part) = random_parts(&mut random, 15, 4);
        assert!(on_bed(&lists, &part, 3).is_none());
        let negative: Vec<f64> = part.iter().map(|entry| -entry).collect();
        assert!(on_bed(&lists, &negative, 15).is_none());
        // A part that is not symmetric per force.
        let mut skew = part;
        skew[1] += 1e-3;
        assert!(on_bed(&lists, &skew, 15).is_none());
    }
}
