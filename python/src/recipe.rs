//! Recipes: Python's structures, grounds, laws and motions are descriptions, from which each
//! simulation builds separate parts.

use std::sync::Arc;

use basemat::Result;
use basemat::structure::{Base, Structure, StructureDescription, Triplets};

use crate::names::DofNames;

/// Builds a value; each call builds an equal one.
pub(crate) type Factory<T> = Arc<dyn Fn() -> Result<T> + Send + Sync>;

/// Builds a part for one simulation.
pub(crate) type Recipe<T> = Factory<Box<T>>;

/// A linear structure that several simulations read, and names of its degrees of freedom.
pub(crate) struct SharedStructure<T> {
    pub(crate) structure: Arc<T>,
    pub(crate) dof_names: Option<DofNames>,
}

impl<T> Clone for SharedStructure<T> {
    fn clone(&self) -> Self {
        Self { structure: Arc::clone(&self.structure), dof_names: self.dof_names.clone() }
    }
}

/// Methods that are forwarded to the shared structure.
macro_rules! forward_to_structure {
    ($($name:ident($($argument:ident: $type:ty),*) -> $out:ty;)+) => {
        $(fn $name(&self $(, $argument: $type)*) -> $out {
            self.structure.$name($($argument),*)
        })+
    };
}

impl<T: Structure + Sync> Structure for SharedStructure<T> {
    forward_to_structure! {
        dofs() -> usize;
        base() -> Base;
        mass(matrix: &mut Triplets) -> Result<()>;
        mass_at_rest() -> Result<Option<Vec<f64>>>;
        stiffness(matrix: &mut Triplets) -> Result<()>;
        damping(matrix: &mut Triplets) -> Result<()>;
        geometric_stiffness(matrix: &mut Triplets) -> Result<()>;
        has_active_damping() -> bool;
        has_active_stiffness() -> bool;
        description() -> StructureDescription;
        load(time: f64, load: &mut [f64]) -> Result<()>;
    }

    fn describe(&self, dofs: &[usize]) -> Option<String> {
        match &self.dof_names {
            Some(names) => names.describe(dofs),
            None => self.structure.describe(dofs),
        }
    }
}
