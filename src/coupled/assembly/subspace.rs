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
    SparseMatrix, add_combined_rows, largest, row_products, symmetric_modes, symmetric_products,
};
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
    /// The space of these rigid translations; `rounding`: see [`OrthonormalRows::new`].
    pub(crate) fn new(
        [mass, damping, stiffness]: [&'a SparseMatrix; 3],
        translations: Vec<f64>,
        rounding: f64,
    ) -> Self {
        let (matrices, rows) = ([damping, stiffness], OrthonormalRows::new(mass, rounding));
        let projected = [Vec::new(), Vec::new()];
        let undamped = damping.is_empty().then_some([0.0; 2]);
        let proportional = undamped.or_else(|| combination(damping, [stiffness, mass]));
        let mut space = Self { matrices, rows, projected, proportional, translations: usize::MAX };
        space.extend(translations, INDEPENDENT);
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

    /// Adds the directions of `block` with more than the fraction `least` outside the subspace.
    pub(crate) fn extend(&mut self, block: Vec<f64>, least: f64) {
        let before = self.count();
        self.rows.extend(block, MinRemainder::Fraction(least));
        self.project(before);
    }

    /// Adds the directions of `block` with a length of more than `least` outside the subspace.
    pub(crate) fn extend_by_length(&mut self, block: Vec<f64>, least: f64) {
        let before = self.count();
        self.rows.extend(block, MinRemainder::Length(least));
        self.project(before);
    }

    /// Adds the rows and columns of the vectors from number `before` on to C and K.
    fn project(&mut self, before: usize) {
        let (n, count) = (self.order(), self.count());
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
    /// directions shorter than `least` are left out. `products`: of the vectors with the `rows` of F.
    pub(crate) fn ritz_with(
        &self,
        (block, first): (&[f64], usize),
        c: &SchemeCoefficients,
        (products, rows): (&[f64], &[f64]),
        least: f64,
    ) -> Result<(Ritz, Vec<f64>)> {
        let (n, before) = (self.order(), self.count());
        let size = block.len() / n;
        let shares = row_products(block, self.rows.momenta(), n);
        let inertia = symmetric_products(&self.rows.mass().times(block), block, n);
        // X M Xᵀ without the part inside V.
        let inside = row_products(&shares, &shares, before);
        let apart = inertia.iter().zip(&inside).map(|(whole, inside)| whole - inside).collect();
        let weights = independent_combinations(apart, size, least * least);
        // V and D in terms of V and X.
        let all = before + size;
        let mut terms = vec![0.0; before * all];
        (0..before).for_each(|i| terms[i * (all + 1)] = 1.0);
        for row in weights.chunks_exact(size.max(1)) {
            let mut own = [vec![0.0; before], row.to_vec()].concat();
            add_combined_rows(row, &shares, before, -1.0, &mut own[..before]);
            terms.extend(own);
        }
        let count = terms.len() / all;
        let projected = |k: usize, border: &[f64], fixed: usize| {
            let matrix = bordered(&self.projected[k], border, [all, fixed]);
            row_products(&row_products(&terms, &matrix, all), &terms, all)
        };
        let multiplied = |k: usize| {
            let images = self.matrices[k].times(block);
            let [beside, own] = [self.rows.vectors(), block].map(|of| row_products(&images, of, n));
            let rows = beside.chunks_exact(before).zip(own.chunks_exact(size.max(1)));
            rows.flat_map(|(beside, own)| [beside, own].concat()).collect::<Vec<_>>()
        };
        let [damping, stiffness] = if let Some([beta, alpha]) = self.proportional {
            // K X by K_eff X = f: K_eff is a combination of M and K.
            let [a, d, k] = [c.acceleration[0], c.velocity[0], c.displacement[0]];
            let (inert, stiff) = (a + alpha * d, k + beta * d);
            let bent = |(row, vector): (usize, usize)| {
                let (force, inertia) = match vector.checked_sub(before) {
                    None => {
                        (f64::from(u8::from(vector == first + row)), shares[row * before + vector])
                    }
                    Some(own) => (shares[own * before + first + row], inertia[row * size + own]),
                };
                (a * force - inert * inertia) / stiff
            };
            let border: Vec<f64> = (0..size * all).map(|at| bent((at / all, at % all))).collect();
            let stiffness = projected(1, &border, self.translations);
            [proportional_damping(&stiffness, count, [beta, alpha]), stiffness]
        } else {
            [projected(0, &multiplied(0), 0), projected(1, &multiplied(1), self.translations)]
        };
        let products = [products, &row_products(block, rows, n)].concat();
        let mut grown = vec![0.0; count * (rows.len() / n)];
        add_combined_rows(&transpose(&terms, all), &products, rows.len() / n, 1.0, &mut grown);
        Ok((self.ritz_of(count, &[damping, stiffness])?, grown))
    }

    /// The modes of `count` vectors, of which the translations are the first, with these C and K.
    fn ritz_of(&self, count: usize, [damping, stiffness]: &[Vec<f64>; 2]) -> Result<Ritz> {
        let fixed = self.translations;
        let free = count - fixed;
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

    /// The modes of all vectors, a row each.
    pub(crate) fn mode_rows(&self, modes: &Ritz) -> Vec<f64> {
        let mut rows = vec![0.0; self.rows.vectors().len()];
        add_combined_rows(&modes.combinations, self.rows.vectors(), self.order(), 1.0, &mut rows);
        rows
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
    damping.iter_mut().step_by(count + 1).for_each(|own| *own += alpha);
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
        let [mut mass, mut stiffness] = [Triplets::new(n), Triplets::new(n)];
        for i in 0..n {
            mass.add(i, i, 1.0 + 0.1 * (i as f64).sin());
            if i > 0 {
                stiffness.add_spring(i - 1, i, 50.0 + 20.0 * (i as f64).cos());
                mass.add(i, i - 1, 0.1);
                mass.add(i - 1, i, 0.1);
            }
        }
        let [mass, stiffness] =
            [mass, stiffness].map(|own| SparseMatrix::new("test", &own).unwrap());
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
            let least = 0.04;
            let with = space.ritz_with((&block, first), &c, (&products, &rows), least).unwrap();
            space.extend_by_length(block, least);
            assert!((11..16).contains(&space.count()), "{}", space.count());
            let (whole, products) = (space.ritz().unwrap(), space.products(0, &rows));
            let near = |a: &[f64], b: &[f64]| {
                let size = 1e-10 * largest(b);
                assert_eq!(a.len(), b.len());
                assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < size), "{a:?} for {b:?}");
            };
            near(&with.0.stiffness, &whole.stiffness);
            near(&with.0.damping, &whole.damping);
            let squares = |modes: &Ritz, products: &[f64]| -> Vec<f64> {
                Subspace::shares(modes, products).iter().map(|share| share * share).collect()
            };
            near(&squares(&with.0, &with.1), &squares(&whole, &products));
        }
    }
}
