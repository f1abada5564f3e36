//! W of many independent elements under a structure with few modes.
//!
//! | symbol | meaning |
//! |---|---|
//! | D | step compliance of the soil, a diagonal |
//! | L | modes: factors of the structure's compliance, B K⁻¹ Bᵀ = L Lᵀ, m/N |
//! | A | areas of the elements |
//!
//! W = D + L Lᵀ A. Its storage grows in proportion to the number of elements.

use crate::linalg::{
    DenseFactor, PivotedCholesky, condition_by_products, dense_multiply_add, dot, largest,
    scale_by, transposed_multiply_add,
};

/// Largest diagonal entry that needs no further mode, relative to the largest of W.
///
/// It is the rounding error of the entries.
pub(super) const MODE_TOLERANCE: f64 = 1e-14;
/// Largest relative difference between products with L Lᵀ and the structure's compliance.
///
/// A larger difference shows that the compliance is not symmetric.
const PRODUCT_TOLERANCE: f64 = 1e-8;

/// W in terms of its diagonal D and its modes L.
#[derive(Debug, Clone)]
pub(crate) struct OnBed {
    /// D, m/Pa, for each contact component.
    soil: Vec<f64>,
    /// A, m², for each contact component.
    areas: Vec<f64>,
    /// L, row by row.
    modes: Vec<f64>,
    mode_count: usize,
    /// L, column by column.
    factor: PivotedCholesky,
    check: SymmetryCheck,
}

/// Buffers for the check that the structure's compliance is symmetric.
#[derive(Debug, Clone)]
struct SymmetryCheck {
    /// Any traction in which all components differ, Pa.
    traction: Vec<f64>,
    /// Product with the structure's compliance.
    expected: Vec<f64>,
    /// Product with L Lᵀ A.
    product: Vec<f64>,
    forces: Vec<f64>,
    amplitudes: Vec<f64>,
}

/// The structure's part B K⁻¹ Bᵀ A of W.
pub(crate) struct StructurePart<D, C, P> {
    /// Returns the entry on the diagonal in a row, m/Pa.
    pub(crate) diagonal: D,
    /// Overwrites a vector with the column of this index.
    pub(crate) column: C,
    /// Overwrites the second vector with the product with the first.
    pub(crate) product: P,
}

impl OnBed {
    /// W of a soil and a structure on elements with these areas.
    ///
    /// Both lists have a number for each contact component. `None` as for a false [`refill`](OnBed::refill).
    pub(crate) fn new(
        soil: &[f64],
        areas: Vec<f64>,
        max_mode_count: usize,
        structure: StructurePart<
            impl Fn(usize) -> f64,
            impl FnMut(usize, &mut [f64]),
            impl FnOnce(&[f64], &mut [f64]),
        >,
    ) -> Option<Self> {
        let zeros = vec![0.0; soil.len()];
        let numbered_areas = areas.iter().enumerate();
        let traction = numbered_areas.map(|(i, area)| (1.0 + i as f64).sin() / area).collect();
        let mut operator = Self {
            soil: soil.to_vec(),
            areas,
            modes: Vec::new(),
            mode_count: 0,
            factor: PivotedCholesky::default(),
            check: SymmetryCheck {
                traction,
                expected: zeros.clone(),
                product: zeros.clone(),
                forces: zeros,
                amplitudes: Vec::new(),
            },
        };
        operator.refill(max_mode_count, structure).then_some(operator)
    }

    /// Computes W again for another structure; allocates only if the number of modes grows.
    ///
    /// False if the structure has more than `max_mode_count` modes, or its compliance per force is not symmetric or not
    /// positive semi-definite. The operator then has no meaning.
    pub(crate) fn refill(
        &mut self,
        max_mode_count: usize,
        mut structure: StructurePart<
            impl Fn(usize) -> f64,
            impl FnMut(usize, &mut [f64]),
            impl FnOnce(&[f64], &mut [f64]),
        >,
    ) -> bool {
        let Self { soil, areas, modes, mode_count, factor, .. } = self;
        let diagonal = |i: usize| (structure.diagonal)(i) / areas[i];
        let size = soil.len();
        let max_diagonal = (0..size).map(|i| soil[i] / areas[i] + diagonal(i)).fold(0.0, f64::max);
        let tolerance = MODE_TOLERANCE * max_diagonal;
        let write_column = |pivot: usize, column: &mut [f64]| {
            (structure.column)(pivot, column);
            for value in column {
                *value /= areas[pivot];
            }
        };
        let diagonals = (0..size).map(diagonal);
        if !factor.factor(diagonals, tolerance, max_mode_count, write_column) {
            return false;
        }
        *mode_count = factor.rank();
        modes.clear();
        modes.resize(size * factor.rank(), 0.0);
        for (k, column) in factor.columns().enumerate() {
            let rows = modes.chunks_exact_mut(*mode_count);
            rows.zip(column).for_each(|(row, entry)| row[k] = *entry);
        }
        self.is_symmetric(structure.product)
    }

    /// Whether products with L Lᵀ are those with the structure's compliance.
    fn is_symmetric(&mut self, structure_product: impl FnOnce(&[f64], &mut [f64])) -> bool {
        let Self { areas, modes, mode_count, check, .. } = self;
        let SymmetryCheck { traction, expected, product, forces, amplitudes } = check;
        structure_product(traction, expected);
        product.fill(0.0);
        amplitudes.clear();
        amplitudes.resize(*mode_count, 0.0);
        forces.clear();
        forces.extend(areas.iter().zip(&*traction).map(|(a, t)| a * t));
        add_modal_product(modes, forces, amplitudes, product);
        let tolerance = PRODUCT_TOLERANCE * largest(expected);
        let mut pairs = expected.iter().zip(&*product);
        pairs.all(|(expected, value)| (expected - value).abs() <= tolerance)
    }

    /// Soil's step compliance of a contact component, m/Pa.
    pub(super) fn soil(&self, i: usize) -> f64 {
        self.soil[i]
    }

    /// Row of L of a contact component.
    pub(super) fn modes(&self, i: usize) -> &[f64] {
        &self.modes[i * self.mode_count..][..self.mode_count]
    }

    /// Number of modes.
    pub(super) fn mode_count(&self) -> usize {
        self.mode_count
    }

    /// Entry on the diagonal of W.
    pub(super) fn diagonal(&self, i: usize) -> f64 {
        let modes = self.modes(i);
        self.soil[i] + dot(modes, modes) * self.areas[i]
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
        if self.mode_count == 0 {
            return;
        }
        let forces: Vec<f64> = self.areas.iter().zip(traction).map(|(a, t)| a * t).collect();
        let mut amplitudes = vec![0.0; self.mode_count];
        add_modal_product(&self.modes, &forces, &mut amplitudes, jump);
    }

    /// Condition number of W, scaled by its diagonal; infinite if W is singular.
    ///
    /// (D A⁻¹ + L Lᵀ)⁻¹ = S − S L (1 + Lᵀ S L)⁻¹ Lᵀ S with S = A D⁻¹ (Woodbury 1950).
    pub(super) fn condition(&self) -> f64 {
        let size = self.soil.len();
        let mode_count = self.mode_count;
        let stiffness: Vec<f64> = self.areas.iter().zip(&self.soil).map(|(a, d)| a / d).collect();
        let mut matrix = vec![0.0; mode_count * mode_count];
        for (i, stiffness) in stiffness.iter().enumerate() {
            let modes = self.modes(i);
            for (row, entry) in matrix.chunks_exact_mut(mode_count.max(1)).zip(modes) {
                row.iter_mut()
                    .zip(modes)
                    .for_each(|(sum, other)| *sum += stiffness * entry * other);
            }
        }
        matrix.iter_mut().step_by(mode_count + 1).for_each(|entry| *entry += 1.0);
        let mut factor = DenseFactor::with_capacity(mode_count);
        if !factor.factor(&matrix, mode_count) {
            return f64::INFINITY;
        }
        let reciprocals: Vec<f64> = self.areas.iter().map(|area| area.recip()).collect();
        let diagonal: Vec<f64> = (0..size).map(|i| self.diagonal(i)).collect();
        // Wᵀ is A W A⁻¹.
        let multiply = |x: &mut [f64], is_transposed: bool| {
            if is_transposed {
                scale_by(x, &reciprocals);
            }
            let mut product = vec![0.0; size];
            self.multiply_add(x, &mut product);
            x.copy_from_slice(&product);
            if is_transposed {
                scale_by(x, &self.areas);
            }
        };
        let solve = |x: &mut [f64], is_transposed: bool| {
            if is_transposed {
                scale_by(x, &reciprocals);
            }
            scale_by(x, &stiffness);
            if mode_count > 0 {
                let mut amplitudes = vec![0.0; mode_count];
                transposed_multiply_add(&self.modes, 1.0, x, &mut amplitudes);
                factor.solve(&mut amplitudes);
                let mut modal_part = vec![0.0; size];
                dense_multiply_add(&self.modes, 1.0, &amplitudes, &mut modal_part);
                scale_by(&mut modal_part, &stiffness);
                x.iter_mut().zip(&modal_part).for_each(|(x, modal_part)| *x -= modal_part);
            }
            if !is_transposed {
                scale_by(x, &reciprocals);
            }
        };
        condition_by_products(&diagonal, multiply, solve)
    }
}

/// jump ← jump + L Lᵀ r for L row by row; `amplitudes`: zeros, which become Lᵀ r.
fn add_modal_product(modes: &[f64], forces: &[f64], amplitudes: &mut [f64], jump: &mut [f64]) {
    transposed_multiply_add(modes, 1.0, forces, amplitudes);
    dense_multiply_add(modes, 1.0, amplitudes, jump);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::dense_condition;
    use basemat_testkit::random::Random;

    /// A random soil with areas, and a structure's compliance of this rank.
    fn random_parts(random: &mut Random, size: usize, rank: usize) -> ([Vec<f64>; 2], Vec<f64>) {
        let soil: Vec<f64> = (0..size).map(|_| random.log_within(1e-2, 1.0)).collect();
        let areas: Vec<f64> = (0..size).map(|_| random.within(0.5, 2.0)).collect();
        let root: Vec<f64> = (0..size * rank).map(|_| random.within(-1.0, 1.0)).collect();
        let row = |i: usize| &root[i * rank..][..rank];
        let structure = (0..size * size)
            .map(|k| areas[k % size] * dot(row(k / size), row(k % size)))
            .collect();
        ([soil, areas], structure)
    }

    /// W of this soil and of the structure with these entries.
    fn on_bed(
        [soil, areas]: &[Vec<f64>; 2],
        entries: &[f64],
        max_mode_count: usize,
    ) -> Option<OnBed> {
        let size = soil.len();
        let structure = StructurePart {
            diagonal: |i: usize| entries[i * (size + 1)],
            column: |j, column: &mut [f64]| {
                (0..size).for_each(|i| column[i] = entries[i * size + j]);
            },
            product: |x: &[f64], product: &mut [f64]| dense_multiply_add(entries, 1.0, x, product),
        };
        OnBed::new(soil, areas.clone(), max_mode_count, structure)
    }

    /// REFERENCE: all entries of W.
    #[test]
    fn product_diagonal_and_condition_are_those_of_all_entries() {
        let mut random = Random(5);
        for case in 0..200 {
            let size = 12 + case % 9;
            let rank = case % 5;
            let (soil_and_areas, structure) = random_parts(&mut random, size, rank);
            let operator = on_bed(&soil_and_areas, &structure, 5).unwrap();
            assert_eq!(operator.mode_count(), rank);
            let mut entries = structure.clone();
            (0..size).for_each(|i| entries[i * (size + 1)] += soil_and_areas[0][i]);
            let traction: Vec<f64> = (0..size).map(|_| random.within(-1.0, 1.0)).collect();
            let mut product = vec![1.0; size];
            let mut expected = vec![1.0; size];
            operator.multiply_add(&traction, &mut product);
            dense_multiply_add(&entries, 1.0, &traction, &mut expected);
            for i in 0..size {
                assert!(
                    (product[i] - expected[i]).abs() < 1e-12,
                    "{case}: {product:?} {expected:?}"
                );
                assert!((operator.diagonal(i) - entries[i * (size + 1)]).abs() < 1e-12, "{case}");
            }
            let condition_ratio = operator.condition() / dense_condition(&entries, size);
            assert!((0.3..1.0001).contains(&condition_ratio), "{case}: {condition_ratio}");
        }
    }

    #[test]
    fn structures_with_too_many_modes_or_without_symmetry_are_rejected() {
        let mut random = Random(6);
        let (soil_and_areas, structure) = random_parts(&mut random, 15, 4);
        assert!(on_bed(&soil_and_areas, &structure, 3).is_none());
        let negative: Vec<f64> = structure.iter().map(|entry| -entry).collect();
        assert!(on_bed(&soil_and_areas, &negative, 15).is_none());
        // A compliance that is not symmetric per force.
        let mut asymmetric = structure;
        asymmetric[1] += 1e-3;
        assert!(on_bed(&soil_and_areas, &asymmetric, 15).is_none());
    }
}
