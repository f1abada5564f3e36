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
use crate::linalg::orthonormal::{Least, OrthonormalRows};
use crate::linalg::{SparseMatrix, add_combined_rows, largest, row_products, symmetric_modes};
use crate::structure::combination;

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
    /// Damping, stiffness.
    matrices: [&'a SparseMatrix; 2],
    /// V.
    rows: OrthonormalRows<'a>,
    /// V C Vᵀ and V K Vᵀ.
    projected: [Vec<f64>; 2],
    /// β and α of damping βK + αM.
    proportional: Option<[f64; 2]>,
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
    pub(crate) fn new(
        [mass, damping, stiffness]: [&'a SparseMatrix; 3],
        translations: Vec<f64>,
    ) -> Self {
        let (matrices, rows) = ([damping, stiffness], OrthonormalRows::new(mass));
        let projected = [Vec::new(), Vec::new()];
        let undamped = damping.is_empty().then_some([0.0; 2]);
        let proportional = undamped.or_else(|| combination(damping, [stiffness, mass]));
        let mut space = Self { matrices, rows, projected, proportional, translations: usize::MAX };
        space.extend(translations, INDEPENDENT);
        space.translations = space.count();
        space
    }

    /// Number of vectors.
    pub(crate) fn count(&self) -> usize {
        self.rows.count()
    }

    fn order(&self) -> usize {
        self.matrices[0].order().max(1)
    }

    /// V M of the vectors from number `first` on.
    pub(crate) fn momenta(&self, first: usize) -> &[f64] {
        &self.rows.momenta()[first * self.order()..]
    }

    /// Adds the directions of `block` with more than the fraction `least` outside the subspace.
    pub(crate) fn extend(&mut self, block: Vec<f64>, least: f64) {
        let before = self.count();
        self.rows.extend(block, Least::Fraction(least));
        self.project(before);
    }

    /// Adds the directions of `block` with a length of more than `least` outside the subspace.
    pub(crate) fn extend_by_length(&mut self, block: Vec<f64>, least: f64) {
        let before = self.count();
        self.rows.extend(block, Least::Length(least));
        self.project(before);
    }

    /// Adds the rows and columns of the vectors from number `before` on to C and K.
    fn project(&mut self, before: usize) {
        let (n, count) = (self.order(), self.count());
        for k in usize::from(self.proportional.is_some())..2 {
            let images = self.matrices[k].times(&self.rows.vectors()[before * n..]);
            let products = row_products(&images, self.rows.vectors(), n);
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
        if let Some([beta, alpha]) = self.proportional {
            self.projected[0] = self.projected[1].iter().map(|k| beta * k).collect();
            self.projected[0].iter_mut().step_by(count + 1).for_each(|own| *own += alpha);
        }
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
        let resultants = row_products(self.rows.vectors(), &forces, self.order());
        add_combined_rows(&resultants, self.rows.momenta(), self.order(), -1.0, &mut forces);
        forces.extend_from_slice(self.rows.momenta());
        forces
    }

    /// Products of the vectors from number `first` on with the rows of F, a row for each vector.
    pub(crate) fn products(&self, first: usize, rows: &[f64]) -> Vec<f64> {
        row_products(&self.rows.vectors()[first * self.order()..], rows, self.order())
    }

    /// F Φᵀ: the rows of F in terms of the modes, from the products of all vectors.
    pub(crate) fn shares(modes: &Ritz, products: &[f64]) -> Vec<f64> {
        let count = modes.stiffness.len();
        let mut shares = vec![0.0; products.len()];
        add_combined_rows(products, &modes.combinations, count, 1.0, &mut shares);
        shares
    }

    /// The modes in degrees of freedom; of the first vectors, if some were added later.
    pub(crate) fn basis(self, modes: &Ritz) -> ModalBasis {
        let count = modes.stiffness.len();
        let mut own = self.rows.into_vectors();
        own.truncate(count * self.matrices[0].order());
        let mut vectors = vec![0.0; own.len()];
        add_combined_rows(&own, &modes.combinations, count, 1.0, &mut vectors);
        ModalBasis::of(modes.stiffness.clone(), modes.damping.clone(), vectors)
    }
}
