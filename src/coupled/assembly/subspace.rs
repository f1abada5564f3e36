//! A subspace of a structure's displacements, and the structure's matrices in it (Galerkin).
//!
//! | symbol | meaning |
//! |---|---|
//! | V | vectors, V M Vᵀ = 1 |
//! | F | rows of degrees of freedom: where forces act and displacements are read |
//! | X, D | a block of vectors, and its directions outside V |
//!
//! All are rows. The first vectors are rigid translations, which K does not resist: their products with K are set
//! to zero.

use crate::coupled::base::transformation::ModalBasis;
use crate::coupled::scheme::SchemeCoefficients;
use crate::error::{Error, Result};
use crate::linalg::orthonormal::{
    MinRemainder, OrthonormalRows, independent_combinations, transpose,
};
use crate::linalg::{
    Eigenpairs, SparseMatrix, add_combined_rows, largest, row_products, symmetric_modes,
    symmetric_products,
};
use crate::structure::proportional_factors;

/// Largest residual of modes, and off-diagonal modal damping, relative to their terms.
pub(crate) const MAX_MODE_COUPLING: f64 = 1e-10;
/// Eigenvalues below this, relative to the largest, count as zero.
const ZERO_EIGENVALUE_RATIO: f64 = 1e-13;
/// Smallest eigenvalue above zero, relative to the largest: between the two limits it is uncertain.
const MIN_NONZERO_EIGENVALUE_RATIO: f64 = 1e-10;
/// Name of the coordinates in errors.
pub(crate) const REDUCED_COORDINATES_NAME: &str = "reduced coordinates";

/// Smallest part of a translation that is independent of the others.
const MIN_TRANSLATION_REMAINDER: f64 = 1e-7;

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
    /// The space of these rigid translations; `rounding`: see [`OrthonormalRows::new`].
    pub(crate) fn new(
        [mass, damping, stiffness]: [&'a SparseMatrix; 3],
        translations: Vec<f64>,
        rounding: f64,
    ) -> Self {
        let matrices = [damping, stiffness];
        let rows = OrthonormalRows::new(mass, rounding);
        let projected = [Vec::new(), Vec::new()];
        let undamped = damping.is_empty().then_some([0.0; 2]);
        let proportional = undamped.or_else(|| proportional_factors(damping, [stiffness, mass]));
        let mut space = Self { matrices, rows, projected, proportional, translations: usize::MAX };
        space.extend(translations, MIN_TRANSLATION_REMAINDER);
        space.translations = space.count();
        space
    }

    /// The same space with damping βK + αM in place of a damping that couples its modes.
    pub(crate) fn with_proportional_damping(mut self, proportional: [f64; 2]) -> Self {
        if self.proportional.is_none() {
            self.proportional = Some(proportional);
            self.projected[0] =
                proportional_damping(&self.projected[1], self.count(), proportional);
        }
        self
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

    /// V M of the vectors from number `first` on, times the scheme's coefficient of the acceleration.
    pub(crate) fn inertia(&self, first: usize, coefficient: f64) -> Vec<f64> {
        self.momenta(first).iter().map(|momentum| coefficient * momentum).collect()
    }

    /// Adds the directions of `block` with more than `min_fraction` outside the subspace.
    pub(crate) fn extend(&mut self, block: Vec<f64>, min_fraction: f64) {
        let before = self.count();
        self.rows.extend(block, MinRemainder::Fraction(min_fraction));
        self.project(before);
    }

    /// Adds the directions of `block` that are longer than `min_length` outside the subspace.
    pub(crate) fn extend_by_length(&mut self, block: Vec<f64>, min_length: f64) {
        let before = self.count();
        self.rows.extend(block, MinRemainder::Length(min_length));
        self.project(before);
    }

    /// Adds the rows and columns of the vectors from number `before` on to C and K.
    fn project(&mut self, before: usize) {
        let n = self.order();
        let count = self.count();
        for k in usize::from(self.proportional.is_some())..2 {
            let images = self.matrices[k].times(&self.rows.vectors()[before * n..]);
            let products = row_products(&images, self.rows.vectors(), n);
            let fixed = if k == 1 { self.translations } else { 0 };
            self.projected[k] = bordered(&self.projected[k], &products, [count, fixed]);
        }
        if let Some(proportional) = self.proportional {
            self.projected[0] = proportional_damping(&self.projected[1], count, proportional);
        }
    }

    /// The modes of the subspace.
    pub(crate) fn ritz(&self) -> Result<Ritz> {
        self.ritz_of(self.count(), &self.projected)
    }

    /// The modes of the subspace with more directions, and all products with F, without the vectors.
    ///
    /// `block`: responses K_eff⁻¹ f to the inertia f of the vectors from number `first` on, with the scheme's factor;
    /// directions shorter than `min_length` are left out. `products`: of the vectors with the `rows` of F.
    pub(crate) fn ritz_with(
        &self,
        (block, first): (&[f64], usize),
        c: &SchemeCoefficients,
        (products, rows): (&[f64], &[f64]),
        min_length: f64,
    ) -> Result<(Ritz, Vec<f64>)> {
        let n = self.order();
        let before = self.count();
        let size = block.len() / n;
        // X M Vᵀ.
        let overlaps = row_products(block, self.rows.momenta(), n);
        let inertia = symmetric_products(&self.rows.mass().times(block), block, n);
        // X M Xᵀ without the part inside V.
        let inside = row_products(&overlaps, &overlaps, before);
        let outside = inertia.iter().zip(&inside).map(|(whole, inside)| whole - inside).collect();
        let weights = independent_combinations(outside, size, min_length * min_length);
        // V and D in terms of V and X.
        let all = before + size;
        let mut terms = vec![0.0; before * all];
        (0..before).for_each(|i| terms[i * (all + 1)] = 1.0);
        for row in weights.chunks_exact(size.max(1)) {
            let mut direction = [vec![0.0; before], row.to_vec()].concat();
            add_combined_rows(row, &overlaps, before, -1.0, &mut direction[..before]);
            terms.extend(direction);
        }
        let count = terms.len() / all;
        let projected = |k: usize, border: &[f64], fixed: usize| {
            let matrix = bordered(&self.projected[k], border, [all, fixed]);
            row_products(&row_products(&terms, &matrix, all), &terms, all)
        };
        let matrices = if let Some([beta, alpha]) = self.proportional {
            // K X by K_eff X = f: K_eff is a combination of M and K.
            let inertia_factor = c.acceleration[0];
            let mass_factor = inertia_factor + alpha * c.velocity[0];
            let stiffness_factor = c.displacement[0] + beta * c.velocity[0];
            let mut border = Vec::with_capacity(size * all);
            for row in 0..size {
                for vector in 0..all {
                    let (force, inertia) = if vector < before {
                        let is_loaded = vector == first + row;
                        (f64::from(u8::from(is_loaded)), overlaps[row * before + vector])
                    } else {
                        let other = vector - before;
                        (overlaps[other * before + first + row], inertia[row * size + other])
                    };
                    let product = inertia_factor * force - mass_factor * inertia;
                    border.push(product / stiffness_factor);
                }
            }
            let stiffness = projected(1, &border, self.translations);
            [proportional_damping(&stiffness, count, [beta, alpha]), stiffness]
        } else {
            let damping = projected(0, &self.border(0, block), 0);
            [damping, projected(1, &self.border(1, block), self.translations)]
        };
        let products = [products, &row_products(block, rows, n)].concat();
        let mut grown = vec![0.0; count * (rows.len() / n)];
        add_combined_rows(&transpose(&terms, all), &products, rows.len() / n, 1.0, &mut grown);
        Ok((self.ritz_of(count, &matrices)?, grown))
    }

    /// Products X C [V; X]ᵀ (`k` = 0) or X K [V; X]ᵀ (1) of a block X.
    fn border(&self, k: usize, block: &[f64]) -> Vec<f64> {
        let images = self.matrices[k].times(block);
        let with_vectors = row_products(&images, self.rows.vectors(), self.order());
        let within_block = row_products(&images, block, self.order());
        let size = block.len() / self.order();
        let rows =
            with_vectors.chunks_exact(self.count()).zip(within_block.chunks_exact(size.max(1)));
        rows.flat_map(|(vectors, block)| [vectors, block].concat()).collect()
    }

    /// The modes of `count` vectors, of which the translations are the first, with these C and K.
    fn ritz_of(&self, count: usize, [damping, stiffness]: &[Vec<f64>; 2]) -> Result<Ritz> {
        let fixed = self.translations;
        let free = count - fixed;
        let rows = (fixed..count).flat_map(|i| &stiffness[i * count + fixed..(i + 1) * count]);
        let found = symmetric_modes(&rows.copied().collect::<Vec<f64>>(), free);
        let Some(Eigenpairs { mut values, vectors: free_modes }) = found else {
            let needed = "it must be finite in the subspace";
            let error = Error::Scene { quantity: "stiffness matrix", needed };
            return Err(error.within(REDUCED_COORDINATES_NAME));
        };
        let top = largest(&values);
        values
            .iter_mut()
            .filter(|value| value.abs() <= ZERO_EIGENVALUE_RATIO * top)
            .for_each(|value| *value = 0.0);
        let nonzero = values.iter().filter(|value| **value != 0.0);
        let ratio = nonzero.fold(top, |lowest, value| value.abs().min(lowest)) / top;
        if ratio < MIN_NONZERO_EIGENVALUE_RATIO {
            let quantity = "lowest eigenvalue besides zero, relative to the highest,";
            let needed = "at least 1e-10, from which double precision tells it from zero";
            return Err(
                Error::Input { quantity, value: ratio, needed }.within(REDUCED_COORDINATES_NAME)
            );
        }
        let mut combinations = vec![0.0; count * count];
        (0..fixed).for_each(|i| combinations[i * (count + 1)] = 1.0);
        for (i, row) in free_modes.chunks_exact(free.max(1)).enumerate() {
            combinations[(fixed + i) * count + fixed..(fixed + i + 1) * count].copy_from_slice(row);
        }
        let mut products = vec![0.0; count * count];
        let mut modal = vec![0.0; count * count];
        add_combined_rows(damping, &combinations, count, 1.0, &mut products);
        add_combined_rows(&combinations, &products, count, 1.0, &mut modal);
        let damping: Vec<f64> = (0..count).map(|j| modal[j * (count + 1)]).collect();
        (0..count).for_each(|j| modal[j * (count + 1)] = 0.0);
        let coupling = largest(&modal) / largest(&damping);
        if coupling > MAX_MODE_COUPLING {
            let quantity =
                "coupling of the modes by the damping, relative to its largest modal coefficient,";
            let needed = "rounding, as that of proportional damping is";
            return Err(
                Error::Input { quantity, value: coupling, needed }.within(REDUCED_COORDINATES_NAME)
            );
        }
        let mut stiffness = vec![0.0; fixed];
        stiffness.extend(values);
        Ok(Ritz { stiffness, damping, combinations })
    }

    /// Forces without their resultants on the vectors, and the momenta of the vectors.
    ///
    /// If the vectors are rigid motions, responses to the remaining forces are deformations alone.
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
    pub(crate) fn modal_rows(modes: &Ritz, products: &[f64]) -> Vec<f64> {
        let count = modes.stiffness.len();
        let mut modal_rows = vec![0.0; products.len()];
        add_combined_rows(products, &modes.combinations, count, 1.0, &mut modal_rows);
        modal_rows
    }

    /// The modes of all vectors, a row each.
    pub(crate) fn mode_rows(&self, modes: &Ritz) -> Vec<f64> {
        let mut rows = vec![0.0; self.rows.vectors().len()];
        add_combined_rows(&modes.combinations, self.rows.vectors(), self.order(), 1.0, &mut rows);
        rows
    }

    /// The modes in degrees of freedom; of the first vectors, if some were added later.
    pub(crate) fn basis(self, modes: &Ritz) -> ModalBasis {
        let count = modes.stiffness.len();
        let mut basis = self.rows.into_vectors();
        basis.truncate(count * self.matrices[0].order());
        let mut vectors = vec![0.0; basis.len()];
        add_combined_rows(&basis, &modes.combinations, count, 1.0, &mut vectors);
        ModalBasis::of(modes.stiffness.clone(), modes.damping.clone(), vectors)
    }
}

/// A symmetric matrix with more rows and columns, of order `count`: zero in the first `fixed` columns.
fn bordered(matrix: &[f64], rows: &[f64], [count, fixed]: [usize; 2]) -> Vec<f64> {
    let before = count - rows.len() / count.max(1);
    let mut grown = vec![0.0; count * count];
    for i in 0..before {
        grown[i * count..i * count + before].copy_from_slice(&matrix[i * before..(i + 1) * before]);
    }
    for (i, row) in rows.chunks_exact(count.max(1)).enumerate() {
        for (j, &value) in row.iter().enumerate().skip(fixed) {
            grown[(before + i) * count + j] = value;
            grown[j * count + before + i] = value;
        }
    }
    grown
}

/// βK + αM of M-orthonormal vectors.
fn proportional_damping(stiffness: &[f64], count: usize, [beta, alpha]: [f64; 2]) -> Vec<f64> {
    let mut damping: Vec<f64> = stiffness.iter().map(|k| beta * k).collect();
    damping.iter_mut().step_by(count + 1).for_each(|entry| *entry += alpha);
    damping
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::{SparseFactor, Triplets};

    /// A chain with a rigid translation, and damping in proportion to mass and stiffness.
    #[test]
    fn modes_with_more_directions_need_no_vectors() {
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
            assert!(space.proportional.is_some());
            if !is_proportional {
                // Damping that counts as any other.
                space.proportional = None;
            }
            space.extend((1..4).flat_map(wave).collect(), 1e-7);
            let first = space.count();
            space.extend((4..10).flat_map(wave).collect(), 1e-7);
            let mut block: Vec<f64> = space.momenta(first).iter().map(|f| 6.0 * f).collect();
            factor.solve_many(&mut block);
            let products = space.products(0, &rows);
            // Longer than one of the directions.
            let min_length = 0.04;
            let with =
                space.ritz_with((&block, first), &c, (&products, &rows), min_length).unwrap();
            space.extend_by_length(block, min_length);
            assert!((11..16).contains(&space.count()), "{}", space.count());
            let whole = space.ritz().unwrap();
            let products = space.products(0, &rows);
            let near = |a: &[f64], b: &[f64]| {
                let size = 1e-10 * largest(b);
                assert_eq!(a.len(), b.len());
                assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < size), "{a:?} for {b:?}");
            };
            near(&with.0.stiffness, &whole.stiffness);
            near(&with.0.damping, &whole.damping);
            let squares = |modes: &Ritz, products: &[f64]| -> Vec<f64> {
                Subspace::modal_rows(modes, products).iter().map(|value| value * value).collect()
            };
            near(&squares(&with.0, &with.1), &squares(&whole, &products));
        }
    }
}
