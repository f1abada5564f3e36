//! A structure in its stepping coordinates.

pub(crate) mod assembled;
mod base_responses;
pub(crate) mod condensed;
pub(crate) mod effective_stiffness;
pub(crate) mod joint_compliance;
pub(crate) mod kinematics;
pub(crate) mod load;
pub(crate) mod mechanism;
pub(crate) mod operators;
pub(crate) mod signs;
pub(crate) mod supports;

use crate::coupled::base::influence::Influence;
use crate::coupled::base::transformation::{ModalBasis, Transformation};
use crate::coupled::model::assembled::Assembled;
use crate::error::Result;
use crate::linalg::matrix::{Diagonals, Matrix};
use crate::linalg::{Elimination, SparseMatrix};
use crate::structure::Structure;
use std::sync::Arc;

/// Matrices, influence vectors and coordinates of a structure.
pub(crate) struct Model {
    /// Number of degrees of freedom of the structure.
    pub(crate) dofs: usize,
    /// Number of stepping coordinates.
    pub(crate) coordinate_count: usize,
    pub(crate) mass: Matrix,
    pub(crate) damping: Matrix,
    pub(crate) stiffness: Matrix,
    pub(crate) is_linear: bool,
    /// Whether any damping coefficient is not zero.
    pub(crate) is_damped: bool,
    /// Influence vectors in stepping coordinates.
    pub(crate) influence: Arc<Influence>,
    pub(crate) transformation: Transformation,
    /// Elimination order for factors in degrees of freedom.
    pub(crate) elimination: Elimination,
}

impl Model {
    /// The structure in its degrees of freedom.
    pub(crate) fn new(assembled: &Assembled) -> Self {
        let [mass, damping, stiffness] = assembled.shared_matrices().map(Matrix::Sparse);
        Self {
            dofs: assembled.dofs(),
            coordinate_count: assembled.dofs(),
            mass,
            is_damped: !damping.is_empty(),
            damping,
            stiffness,
            is_linear: assembled.is_linear,
            influence: assembled.influence.clone(),
            transformation: Transformation::Identity,
            elimination: assembled.elimination.clone(),
        }
    }

    /// This structure in modal coordinates.
    pub(crate) fn in_modes(self, assembled: &Assembled, modes: ModalBasis) -> Self {
        let influence = assembled
            .influence
            .converted(|vector| modes.rigid_translation(vector, &assembled.mass));
        let mode_count = modes.count();
        let damping = if modes.coupled_damping.is_empty() {
            Matrix::Diagonal(modes.damping.clone())
        } else {
            let dense_damping = modes.coupled_damping.clone();
            Matrix::Sparse(Arc::new(SparseMatrix::from_dense(mode_count, dense_damping)))
        };
        Self {
            coordinate_count: mode_count,
            mass: Matrix::Diagonal(vec![1.0; mode_count]),
            is_damped: !damping.is_empty(),
            damping,
            stiffness: Matrix::Diagonal(modes.stiffness.clone()),
            influence: Arc::new(influence),
            transformation: Transformation::Modes(Arc::new(modes)),
            elimination: Elimination::default(),
            ..self
        }
    }

    /// The three matrices if they are diagonal, otherwise `None`.
    pub(crate) fn diagonals(&self) -> Option<Diagonals<'_>> {
        match (&self.mass, &self.damping, &self.stiffness) {
            (Matrix::Diagonal(mass), Matrix::Diagonal(damping), Matrix::Diagonal(stiffness)) => {
                let damping = self.is_damped.then_some(damping.as_slice());
                Some(Diagonals { mass, damping, stiffness })
            }
            _ => None,
        }
    }

    /// Adds the structure's load at `time` minus its `static_load` to `load`, in stepping coordinates.
    ///
    /// Returns whether this difference has any nonzero entry. `load_buffer` has an entry for each degree of freedom and
    /// is overwritten. Errors come from [`Structure::load`].
    pub(crate) fn add_load(
        &self,
        structure: &dyn Structure,
        time: f64,
        static_load: &[f64],
        load_buffer: &mut [f64],
        load: &mut [f64],
    ) -> Result<bool> {
        load_buffer.fill(0.0);
        structure.load(time, load_buffer)?;
        let mut has_load = false;
        for (force, static_force) in load_buffer.iter_mut().zip(static_load) {
            *force -= static_force;
            // The loop has no branch, so the compiler can vectorize it. NaN counts as a load.
            has_load |= *force != 0.0;
        }
        if has_load {
            self.transformation.add_forces(load_buffer, load);
        }
        Ok(has_load)
    }
}
