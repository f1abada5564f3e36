//! Recipes: Python's structures, grounds, laws and motions are descriptions, from which every
//! simulation gets a part of its own.

use std::sync::Arc;

use basemat::Result;
use basemat::structure::{ContactNode, FaceNode, Structure, Triplets};

use crate::dof_names::DofNames;

/// Makes a part for one simulation.
pub(crate) type Recipe<T> = Arc<dyn Fn() -> Result<Box<T>> + Send + Sync>;

/// A linear structure that several simulations read, and names of its degrees of freedom.
pub(crate) struct Shared<T>(pub(crate) Arc<T>, pub(crate) Option<DofNames>);

impl<T> Clone for Shared<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0), self.1.clone())
    }
}

impl<T: Structure + Sync> Structure for Shared<T> {
    fn dofs(&self) -> usize {
        self.0.dofs()
    }

    fn contact_nodes(&self) -> Vec<ContactNode> {
        self.0.contact_nodes()
    }

    fn foundation_ends(&self) -> Vec<usize> {
        self.0.foundation_ends()
    }

    fn contact_faces(&self) -> Vec<Vec<FaceNode>> {
        self.0.contact_faces()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        self.0.mass(matrix)
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.0.stiffness(matrix)
    }

    fn damping(&self, matrix: &mut Triplets) -> Result<()> {
        self.0.damping(matrix)
    }

    fn has_active_damping(&self) -> bool {
        self.0.has_active_damping()
    }

    fn describe(&self, dofs: &[usize]) -> Option<String> {
        match &self.1 {
            Some(names) => names.describe(dofs),
            None => self.0.describe(dofs),
        }
    }

    fn load(&self, time: f64, load: &mut [f64]) -> Result<()> {
        self.0.load(time, load)
    }
}
