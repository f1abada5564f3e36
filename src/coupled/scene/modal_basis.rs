//! Vibration modes as the coordinates in which a linear structure is stepped.
//!
//! | symbol | meaning |
//! |---|---|
//! | Φ | modes: K φ = λ M φ, Φᵀ M Φ = 1 |
//! | q | modal coordinates, u = Φ q |
//! | c | modal damping, Φᵀ C Φ = diag(c) |
//! | R | influence vectors |
//!
//! In modes every matrix of the equation of motion is diagonal, so a step costs a few operations
//! per mode, and as many per mode and contact component to meet the ground. Only the rows of Φ
//! that the ground or a probe sees are needed in a step; the others wait until they are asked for.
//!
//! The rigid translations are modes of their own, exactly: R spans the first ones, and no deforming
//! mode has a share of it.

use crate::linalg::matrix::{SparseMatrix, spread};
use crate::linalg::{Partition, dot, generalised_modes, largest};

/// Vibration modes of a structure: all of them, or fewer Ritz modes.
#[derive(Debug)]
pub(crate) struct ModalBasis {
    /// λ.
    pub(crate) stiffness: Vec<f64>,
    /// c.
    pub(crate) damping: Vec<f64>,
    /// Φ, row-major: a row per unknown.
    vectors: Vec<f64>,
}

/// Residual of the eigenproblem, and of damping taken for diagonal, relative to its terms.
pub(super) const DECOUPLED: f64 = 1e-10;
/// Eigenvalues below this, relative to the largest, are zeros with the error of their computation.
const ZERO: f64 = 1e-11;
/// Smallest eigenvalue besides zero, relative to the largest: between the two nothing is certain.
const SMALLEST: f64 = 1e-8;
/// Rigid motions in a plane.
const RIGID_MOTIONS: usize = 3;

impl ModalBasis {
    /// The modes with these λ, c and Φ (row-major, a row per unknown), rigid translations of λ = 0
    /// among them.
    pub(super) fn of(stiffness: Vec<f64>, damping: Vec<f64>, vectors: Vec<f64>) -> Self {
        Self { stiffness, damping, vectors }
    }

    /// Modes that diagonalise mass, damping and stiffness, the rigid `translations` among them, as
    /// (unknown, displacement) terms; `None` if there are none, or not well
    /// enough.
    pub(crate) fn new(
        matrices: [&SparseMatrix; 3],
        translations: &[&[(usize, f64)]],
    ) -> Option<Self> {
        let [mass, damping, stiffness] = matrices;
        let n = mass.order();
        if matrices.iter().any(|matrix| matrix.asymmetry() > 1e-13) {
            return None;
        }
        let (mut values, vectors) = generalised_modes(stiffness, mass)?;
        let top = largest(&values);
        let noise = ZERO * top;
        let rigid = values.iter().filter(|value| value.abs() <= noise).count();
        // Below its noise an eigenvalue is a rigid motion's, unless there are too many of them.
        let smallest = values.iter().map(|v| v.abs()).filter(|v| *v > noise);
        let mut parts = Partition::new(n);
        for matrix in matrices {
            parts.couple(matrix);
        }
        let most = RIGID_MOTIONS * parts.sets().len();
        if rigid > most || smallest.fold(top, f64::min) < SMALLEST * top {
            return None;
        }
        // Rigid modes first; those that P–Δ makes unstable come before them in ascending order.
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by_key(|&j| values[j].abs() > noise);
        values = order.iter().map(|&j| values[j]).collect();
        let vectors =
            vectors.chunks_exact(n).flat_map(|row| order.iter().map(|&j| row[j])).collect();
        values[..rigid].fill(0.0);
        let mut modes = Self { stiffness: values, damping: vec![0.0; n], vectors };
        modes.separate_translations(rigid, mass, translations)?;
        modes.decouple(mass, damping, stiffness).then_some(modes)
    }

    /// Makes the influence vectors the first of the `rigid` modes, the others orthogonal to them.
    fn separate_translations(
        &mut self,
        rigid: usize,
        mass: &SparseMatrix,
        translations: &[&[(usize, f64)]],
    ) -> Option<()> {
        let n = self.count();
        let mut column: Vec<Vec<f64>> =
            (0..n).map(|j| (0..n).map(|i| self.vectors[i * n + j]).collect()).collect();
        let mut basis: Vec<[Vec<f64>; 2]> = Vec::with_capacity(rigid);
        let product = |vector: &[f64]| {
            let mut product = vec![0.0; n];
            mass.multiply_add(1.0, vector, &mut product);
            product
        };
        // Twice is enough.
        let project = |vector: &mut [f64], basis: &[[Vec<f64>; 2]]| {
            for [own, image] in basis.iter().chain(basis) {
                let share = dot(image, vector);
                vector.iter_mut().zip(own).for_each(|(v, b)| *v -= share * b);
            }
        };
        let normalise = |mut vector: Vec<f64>| {
            let scale = dot(&vector, &product(&vector)).sqrt().recip();
            for v in &mut vector {
                *v *= scale;
            }
            let image = product(&vector);
            scale.is_finite().then_some([vector, image])
        };
        for vector in translations {
            if !vector.is_empty() {
                let mut own = spread(vector, n);
                project(&mut own, &basis);
                basis.push(normalise(own)?);
            }
        }
        if basis.len() > rigid {
            return None;
        }
        let separated = basis.len();
        while basis.len() < rigid {
            // The rigid mode with most left over.
            let norm = |vector: &Vec<f64>| dot(vector, &product(vector));
            for vector in &mut column[..rigid] {
                project(vector, &basis);
            }
            let most = (0..rigid).max_by(|a, b| norm(&column[*a]).total_cmp(&norm(&column[*b])))?;
            let mut chosen = std::mem::replace(&mut column[most], vec![0.0; n]);
            chosen = normalise(chosen)?.into_iter().next()?;
            project(&mut chosen, &basis);
            basis.push(normalise(chosen)?);
        }
        for vector in &mut column[rigid..] {
            project(vector, &basis[..separated]);
        }
        for (own, [vector, _]) in column.iter_mut().zip(basis) {
            *own = vector;
        }
        for (j, vector) in column.iter().enumerate() {
            for (i, value) in vector.iter().enumerate() {
                self.vectors[i * n + j] = *value;
            }
        }
        Some(())
    }

    /// Finds c, and checks K φ = λ M φ and C φ = c M φ.
    fn decouple(
        &mut self,
        mass: &SparseMatrix,
        damping: &SparseMatrix,
        stiffness: &SparseMatrix,
    ) -> bool {
        let n = self.stiffness.len();
        let mut products = [(); 3].map(|()| vec![0.0; n]);
        let mut mode = vec![0.0; n];
        let (mut sizes, mut residuals) = ([0.0_f64; 2], [0.0_f64; 2]);
        for j in 0..n {
            for (i, value) in mode.iter_mut().enumerate() {
                *value = self.vectors[i * n + j];
            }
            for (product, matrix) in products.iter_mut().zip([mass, damping, stiffness]) {
                product.fill(0.0);
                matrix.multiply_add(1.0, &mode, product);
            }
            self.damping[j] = dot(&mode, &products[1]);
            let [inertia, dashpots, springs] = &products;
            let factors = [self.damping[j], self.stiffness[j]];
            for (k, (forces, factor)) in [dashpots, springs].into_iter().zip(factors).enumerate() {
                let apart = forces.iter().zip(inertia).map(|(f, m)| f - factor * m);
                sizes[k] = sizes[k].max(largest(forces));
                residuals[k] = apart.fold(residuals[k], |r, x| r.max(x.abs()));
            }
        }
        (0..2).all(|k| residuals[k] <= DECOUPLED * sizes[k])
    }

    /// Displacements of an unknown in all modes.
    pub(crate) fn row(&self, unknown: usize) -> &[f64] {
        let n = self.count();
        &self.vectors[unknown * n..(unknown + 1) * n]
    }

    /// Number of modes.
    pub(crate) fn count(&self) -> usize {
        self.stiffness.len()
    }

    /// Adds Φᵀ f to `modal`; unknowns without force cost nothing.
    pub(crate) fn project(&self, force: &[f64], modal: &mut [f64]) {
        for (row, force) in self.vectors.chunks_exact(self.count()).zip(force) {
            if *force != 0.0 {
                modal.iter_mut().zip(row).for_each(|(q, phi)| *q += phi * force);
            }
        }
    }

    /// Modal coordinates of a rigid translation, M its mass matrix: only rigid modes have a share.
    pub(crate) fn coordinates(
        &self,
        vector: &[(usize, f64)],
        mass: &SparseMatrix,
    ) -> Vec<(usize, f64)> {
        // u = Φ q and Φᵀ M Φ = 1: q = Φᵀ M u.
        let [mut full, mut momentum] = [(); 2].map(|()| vec![0.0; mass.order()]);
        let mut shares = vec![0.0; self.count()];
        for &(i, r) in vector {
            full[i] = r;
        }
        mass.multiply_add(1.0, &full, &mut momentum);
        self.project(&momentum, &mut shares);
        let noise = 1e-12 * largest(&shares);
        let rigid = shares.into_iter().zip(&self.stiffness).enumerate();
        rigid
            .filter(|(_, (q, k))| **k == 0.0 && q.abs() > noise)
            .map(|(j, (q, _))| (j, q))
            .collect()
    }

    /// Φ q.
    pub(crate) fn unknowns(&self, modal: &[f64]) -> Vec<f64> {
        self.vectors.chunks_exact(self.count()).map(|row| dot(row, modal)).collect()
    }
}
