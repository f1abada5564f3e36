//! A structure in its stepping coordinates.

pub(crate) mod assembled;
pub(crate) mod condensed;
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
    /// Degrees of freedom of the structure, and number of stepping coordinates.
    pub(crate) dofs: usize,
    pub(crate) coordinates: usize,
    pub(crate) mass: Matrix,
    pub(crate) damping: Matrix,
    pub(crate) stiffness: Matrix,
    pub(crate) linear: bool,
    /// Whether any damping coefficient is not zero.
    pub(crate) damped: bool,
    /// Influence vectors in stepping coordinates.
    pub(crate) influence: Arc<Influence>,
    pub(crate) transformation: Transformation,
    /// Order in which factors in degrees of freedom are eliminated.
    pub(crate) elimination: Elimination,
}

impl Model {
    /// The structure in its degrees of freedom.
    pub(crate) fn new(assembled: &Assembled) -> Self {
        let [mass, damping, stiffness] = assembled.shared().map(Matrix::Sparse);
        Self {
            dofs: assembled.dofs(),
            coordinates: assembled.dofs(),
            mass,
            damped: !damping.is_empty(),
            damping,
            stiffness,
            linear: assembled.linear,
            influence: assembled.influence.clone(),
            transformation: Transformation::Identity,
            elimination: assembled.elimination.clone(),
        }
    }

    /// This structure in modal coordinates.
    pub(crate) fn in_modes(self, assembled: &Assembled, modes: ModalBasis) -> Self {
        let influence =
            assembled.influence.converted(|vector| modes.translation(vector, &assembled.mass));
        let count = modes.count();
        let damping = if modes.coupled_damping.is_empty() {
            Matrix::Diagonal(modes.damping.clone())
        } else {
            let coupled = modes.coupled_damping.clone();
            Matrix::Sparse(Arc::new(SparseMatrix::from_dense(count, coupled)))
        };
        Self {
            coordinates: count,
            mass: Matrix::Diagonal(vec![1.0; count]),
            damped: !damping.is_empty(),
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
                let damping = self.damped.then_some(damping.as_slice());
                Some(Diagonals { mass, damping, stiffness })
            }
            _ => None,
        }
    }

    /// Adds the external load at `time`, without weight, minus `at_start`, to `load`.
    ///
    /// Returns whether there is any load. `scratch` has an entry for every degree of freedom. An error comes from
    /// the structure.
    pub(crate) fn load(
        &self,
        structure: &dyn Structure,
        time: f64,
        at_start: &[f64],
        scratch: &mut [f64],
        load: &mut [f64],
    ) -> Result<bool> {
        scratch.fill(0.0);
        structure.load(time, scratch)?;
        let mut differs = false;
        for (now, at_start) in scratch.iter_mut().zip(at_start) {
            *now -= at_start;
            // Without a branch, for the vector units; NaN differs.
            differs |= *now != 0.0;
        }
        if differs {
            self.transformation.add_forces(scratch, load);
        }
        Ok(differs)
    }
}
