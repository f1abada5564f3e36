//! Subspace of a structure's displacements, and the structure's matrices in it (Galerkin).
//!
//! | symbol | meaning |
//! |---|---|
//! | V | vectors, V M Vᵀ = 1 |
//! | F | weights of the degrees of freedom in forces and in probes |
//!
//! All vectors are rows. The first vectors are rigid translations, which K does not resist. Their products with K are set
//! to zero.

use crate::coupled::base::transformation::ModalBasis;
use crate::error::{Error, Result};
use crate::linalg::orthonormal::{MinRemainder, OrthonormalRows};
use crate::linalg::{
    Eigenpairs, SparseMatrix, add_combined_rows, largest, row_products, symmetric_modes,
};
use crate::structure::proportional_factors;

/// Largest residual of modes, and off-diagonal modal damping, relative to their terms.
pub(crate) const MAX_MODE_COUPLING: f64 = 1e-10;
/// Eigenvalues below this ratio to the largest count as zero.
const ZERO_EIGENVALUE_RATIO: f64 = 1e-13;
/// Smallest accepted ratio of a nonzero eigenvalue to the largest.
///
/// Between both limits the eigenvalue is uncertain.
const MIN_NONZERO_EIGENVALUE_RATIO: f64 = 1e-10;
/// Name of reduced coordinates in errors.
pub(crate) const REDUCED_COORDINATES_NAME: &str = "reduced coordinates";

/// Smallest fraction of a translation outside the other translations, for an independent direction.
const MIN_TRANSLATION_REMAINDER: f64 = 1e-7;

/// Subspace V with the projected damping and stiffness.
pub(crate) struct Subspace<'a> {
    /// Damping and stiffness in degrees of freedom.
    pub(super) matrices: [&'a SparseMatrix; 2],
    /// Vectors V.
    pub(super) rows: OrthonormalRows<'a>,
    /// V C Vᵀ and V K Vᵀ.
    pub(super) projected_matrices: [Vec<f64>; 2],
    /// β and α of a damping βK + αM; `None` for any other damping.
    pub(super) damping_factors: Option<[f64; 2]>,
    /// Number of rigid translations.
    pub(super) translation_count: usize,
}

/// Vibration modes of a subspace, the translations first.
pub(crate) struct RitzModes {
    /// Modal stiffnesses λ.
    pub(crate) stiffness: Vec<f64>,
    /// Modal damping coefficients c.
    pub(crate) damping: Vec<f64>,
    /// Weights of the vectors in the modes: columns of a row-major matrix.
    combinations: Vec<f64>,
}

impl<'a> Subspace<'a> {
    /// The space of the rigid translations.
    ///
    /// `rounding`: see [`OrthonormalRows::new`].
    pub(crate) fn new(
        [mass, damping, stiffness]: [&'a SparseMatrix; 3],
        translations: Vec<f64>,
        rounding: f64,
    ) -> Self {
        let matrices = [damping, stiffness];
        let rows = OrthonormalRows::new(mass, rounding);
        let projected_matrices = [Vec::new(), Vec::new()];
        let undamped_coefficients = damping.is_empty().then_some([0.0; 2]);
        let damping_factors =
            undamped_coefficients.or_else(|| proportional_factors(damping, [stiffness, mass]));
        let mut space = Self {
            matrices,
            rows,
            projected_matrices,
            damping_factors,
            translation_count: usize::MAX,
        };
        space.extend(translations, MIN_TRANSLATION_REMAINDER);
        space.translation_count = space.count();
        space
    }

    /// Replaces a damping that couples the modes by βK + αM.
    pub(crate) fn with_proportional_damping(mut self, damping_factors: [f64; 2]) -> Self {
        if self.damping_factors.is_none() {
            self.damping_factors = Some(damping_factors);
            self.projected_matrices[0] =
                proportional_damping(&self.projected_matrices[1], self.count(), damping_factors);
        }
        self
    }

    /// Number of vectors.
    pub(crate) fn count(&self) -> usize {
        self.rows.count()
    }

    /// Number of degrees of freedom, at least one.
    pub(super) fn order(&self) -> usize {
        self.matrices[0].order().max(1)
    }

    /// Products V M of the vectors from index `first_index` on.
    pub(crate) fn momenta(&self, first_index: usize) -> &[f64] {
        &self.rows.momenta()[first_index * self.order()..]
    }

    /// Products V M of the vectors from index `first_index` on, times a coefficient.
    ///
    /// `coefficient`: that of the acceleration in the scheme.
    pub(crate) fn inertia(&self, first_index: usize, coefficient: f64) -> Vec<f64> {
        self.momenta(first_index).iter().map(|momentum| coefficient * momentum).collect()
    }

    /// Adds the directions of `block` of which more than `min_fraction` is outside the subspace.
    pub(crate) fn extend(&mut self, block: Vec<f64>, min_fraction: f64) {
        let first_new = self.count();
        self.rows.extend(block, MinRemainder::Fraction(min_fraction));
        self.project(first_new);
    }

    /// Adds the directions of `block` whose component outside the subspace is longer than `min_length`.
    pub(crate) fn extend_by_length(&mut self, block: Vec<f64>, min_length: f64) {
        let first_new = self.count();
        self.rows.extend(block, MinRemainder::Length(min_length));
        self.project(first_new);
    }

    /// Extends the projected C and K by the vectors from index `first_new` on.
    fn project(&mut self, first_new: usize) {
        let order = self.order();
        let count = self.count();
        for k in usize::from(self.damping_factors.is_some())..2 {
            let images = self.matrices[k].times(&self.rows.vectors()[first_new * order..]);
            let products = row_products(&images, self.rows.vectors(), order);
            let zero_columns = if k == 1 { self.translation_count } else { 0 };
            self.projected_matrices[k] =
                bordered(&self.projected_matrices[k], &products, count, zero_columns);
        }
        if let Some(damping_factors) = self.damping_factors {
            self.projected_matrices[0] =
                proportional_damping(&self.projected_matrices[1], count, damping_factors);
        }
    }

    /// The modes of the subspace.
    pub(crate) fn ritz(&self) -> Result<RitzModes> {
        self.ritz_of(self.count(), &self.projected_matrices)
    }

    /// Modes of `count` vectors with their projected C and K; the first vectors are the translations.
    pub(super) fn ritz_of(
        &self,
        count: usize,
        [projected_damping, projected_stiffness]: &[Vec<f64>; 2],
    ) -> Result<RitzModes> {
        let translation_count = self.translation_count;
        let deforming_count = count - translation_count;
        let rows = (translation_count..count)
            .flat_map(|i| &projected_stiffness[i * count + translation_count..(i + 1) * count]);
        let eigenpairs = symmetric_modes(&rows.copied().collect::<Vec<f64>>(), deforming_count);
        let Some(Eigenpairs { mut values, vectors: deforming_modes }) = eigenpairs else {
            let needed = "it must be finite in the subspace";
            let error = Error::Scene { quantity: "stiffness matrix", needed };
            return Err(error.within(REDUCED_COORDINATES_NAME));
        };
        let max_eigenvalue = largest(&values);
        values
            .iter_mut()
            .filter(|value| value.abs() <= ZERO_EIGENVALUE_RATIO * max_eigenvalue)
            .for_each(|value| *value = 0.0);
        let nonzero = values.iter().filter(|value| **value != 0.0);
        let min_ratio =
            nonzero.fold(max_eigenvalue, |min, value| value.abs().min(min)) / max_eigenvalue;
        if min_ratio < MIN_NONZERO_EIGENVALUE_RATIO {
            let quantity = "smallest nonzero eigenvalue, relative to the largest,";
            let needed = "at least 1e-10, which double precision distinguishes from zero";
            return Err(Error::Input { quantity, value: min_ratio, needed }
                .within(REDUCED_COORDINATES_NAME));
        }
        let mut combinations = vec![0.0; count * count];
        (0..translation_count).for_each(|i| combinations[i * (count + 1)] = 1.0);
        for (i, row) in deforming_modes.chunks_exact(deforming_count.max(1)).enumerate() {
            let start = (translation_count + i) * count;
            combinations[start + translation_count..start + count].copy_from_slice(row);
        }
        let mut products = vec![0.0; count * count];
        let mut modal_damping = vec![0.0; count * count];
        add_combined_rows(projected_damping, &combinations, count, 1.0, &mut products);
        add_combined_rows(&combinations, &products, count, 1.0, &mut modal_damping);
        let damping: Vec<f64> = (0..count).map(|j| modal_damping[j * (count + 1)]).collect();
        (0..count).for_each(|j| modal_damping[j * (count + 1)] = 0.0);
        let coupling = largest(&modal_damping) / largest(&damping);
        if coupling > MAX_MODE_COUPLING {
            let quantity =
                "coupling of the modes by the damping, relative to its largest modal coefficient,";
            let needed = "no larger than rounding, as for proportional damping";
            return Err(
                Error::Input { quantity, value: coupling, needed }.within(REDUCED_COORDINATES_NAME)
            );
        }
        let mut stiffness = vec![0.0; translation_count];
        stiffness.extend(values);
        Ok(RitzModes { stiffness, damping, combinations })
    }

    /// Forces without their projections on the vectors, followed by the momenta of the vectors.
    ///
    /// If the vectors are rigid motions, the remaining forces are balanced and cause only deformations.
    pub(crate) fn balanced(&self, mut forces: Vec<f64>) -> Vec<f64> {
        let resultants = row_products(self.rows.vectors(), &forces, self.order());
        add_combined_rows(&resultants, self.rows.momenta(), self.order(), -1.0, &mut forces);
        forces.extend_from_slice(self.rows.momenta());
        forces
    }

    /// Products of the vectors from index `first_index` on with the rows of F.
    ///
    /// One row for each vector.
    pub(crate) fn products(&self, first_index: usize, rows: &[f64]) -> Vec<f64> {
        row_products(&self.rows.vectors()[first_index * self.order()..], rows, self.order())
    }

    /// Adds the newest vectors' products with F to those of all earlier vectors.
    ///
    /// One row for each vector.
    pub(super) fn extend_products(&self, products: &mut Vec<f64>, rows: &[f64]) {
        let row_count = (rows.len() / self.order()).max(1);
        products.extend(self.products(products.len() / row_count, rows));
    }

    /// Modal weights F Φᵀ of the rows of F, from the products of all vectors.
    pub(crate) fn modal_rows(modes: &RitzModes, products: &[f64]) -> Vec<f64> {
        let count = modes.stiffness.len();
        let mut modal_rows = vec![0.0; products.len()];
        add_combined_rows(products, &modes.combinations, count, 1.0, &mut modal_rows);
        modal_rows
    }

    /// The modes in degrees of freedom, one in each row.
    pub(crate) fn mode_rows(&self, modes: &RitzModes) -> Vec<f64> {
        let mut rows = vec![0.0; self.rows.vectors().len()];
        add_combined_rows(&modes.combinations, self.rows.vectors(), self.order(), 1.0, &mut rows);
        rows
    }

    /// The modal basis in degrees of freedom.
    ///
    /// Vectors that were added after the modes are not used.
    pub(crate) fn basis(self, modes: &RitzModes) -> ModalBasis {
        let count = modes.stiffness.len();
        let mut rows = self.rows.into_vectors();
        rows.truncate(count * self.matrices[0].order());
        let mut vectors = vec![0.0; rows.len()];
        add_combined_rows(&rows, &modes.combinations, count, 1.0, &mut vectors);
        ModalBasis::of(modes.stiffness.clone(), modes.damping.clone(), vectors)
    }
}

/// Extends a symmetric matrix by rows and columns to the order `count`.
///
/// The first `zero_columns` entries of each new row are zero.
pub(super) fn bordered(
    matrix: &[f64],
    rows: &[f64],
    count: usize,
    zero_columns: usize,
) -> Vec<f64> {
    let old_count = count - rows.len() / count.max(1);
    let mut extended_matrix = vec![0.0; count * count];
    for i in 0..old_count {
        extended_matrix[i * count..i * count + old_count]
            .copy_from_slice(&matrix[i * old_count..(i + 1) * old_count]);
    }
    for (i, row) in rows.chunks_exact(count.max(1)).enumerate() {
        for (j, &value) in row.iter().enumerate().skip(zero_columns) {
            extended_matrix[(old_count + i) * count + j] = value;
            extended_matrix[j * count + old_count + i] = value;
        }
    }
    extended_matrix
}

/// Projected damping βK + αM of M-orthonormal vectors.
pub(super) fn proportional_damping(
    stiffness: &[f64],
    count: usize,
    [beta, alpha]: [f64; 2],
) -> Vec<f64> {
    let mut damping: Vec<f64> = stiffness.iter().map(|k| beta * k).collect();
    damping.iter_mut().step_by(count + 1).for_each(|entry| *entry += alpha);
    damping
}
