//! Vibration modes as the coordinates in which a linear structure is stepped.
//!
//! | symbol | meaning |
//! |---|---|
//! | Φ | modes: K φ = λ M φ, Φᵀ M Φ = 1 |
//! | q | modal coordinates, u = Φ q |
//! | c | modal damping, Φᵀ C Φ = diag(c) |
//!
//! In modes every matrix of the equation of motion is diagonal, so a step costs a few operations
//! per mode, and as many per mode and contact component to meet the ground. Only the rows of Φ
//! that the ground or a probe sees are needed in a step; the others wait until they are asked for.

use crate::linalg::matrix::{SparseMatrix, spread};
use crate::linalg::{dot, largest};

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

impl ModalBasis {
    /// The modes with these λ, c and Φ (row-major, a row per unknown), rigid translations of λ = 0
    /// among them.
    pub(crate) fn of(stiffness: Vec<f64>, damping: Vec<f64>, vectors: Vec<f64>) -> Self {
        Self { stiffness, damping, vectors }
    }

    /// Weights by mode of a weighted sum of degrees of freedom.
    pub(crate) fn row(&self, terms: &[(usize, f64)]) -> Vec<f64> {
        let n = self.count();
        let mut weights = vec![0.0; n];
        for &(unknown, weight) in terms {
            let displacements = &self.vectors[unknown * n..(unknown + 1) * n];
            weights.iter_mut().zip(displacements).for_each(|(w, phi)| *w += weight * phi);
        }
        weights
    }

    /// Number of modes.
    pub(crate) fn count(&self) -> usize {
        self.stiffness.len()
    }

    /// Adds Φᵀ f to `modal`; degrees of freedom without force cost nothing.
    pub(crate) fn project(&self, force: &[f64], modal: &mut [f64]) {
        for (row, force) in self.vectors.chunks_exact(self.count()).zip(force) {
            if *force != 0.0 {
                modal.iter_mut().zip(row).for_each(|(q, phi)| *q += phi * force);
            }
        }
    }

    /// Φᵀ M u: the coordinates of u, since Φᵀ M Φ = 1.
    pub(crate) fn coordinates(&self, dofs: &[f64], mass: &SparseMatrix) -> Vec<f64> {
        let (mut momentum, mut modal) = (vec![0.0; dofs.len()], vec![0.0; self.count()]);
        mass.multiply_add(1.0, dofs, &mut momentum);
        self.project(&momentum, &mut modal);
        modal
    }

    /// Modal coordinates of a rigid translation, M its mass matrix: only rigid modes have a share.
    pub(crate) fn translation(
        &self,
        vector: &[(usize, f64)],
        mass: &SparseMatrix,
    ) -> Vec<(usize, f64)> {
        let shares = self.coordinates(&spread(vector, mass.order()), mass);
        let noise = 1e-12 * largest(&shares);
        let rigid = shares.into_iter().zip(&self.stiffness).enumerate();
        rigid
            .filter(|(_, (q, k))| **k == 0.0 && q.abs() > noise)
            .map(|(j, (q, _))| (j, q))
            .collect()
    }

    /// Φ q.
    pub(crate) fn dofs(&self, modal: &[f64]) -> Vec<f64> {
        self.vectors.chunks_exact(self.count()).map(|row| dot(row, modal)).collect()
    }
}
