//! Recipes: Python's structures, grounds, laws and motions are descriptions, from which every
//! simulation gets a part of its own.

use std::sync::Arc;

use basemat::Result;
use basemat::structure::{Base, Structure, StructureDescription, Triplets};

use crate::dof_names::DofNames;

/// Makes a value, always the same.
pub(crate) type Make<T> = Arc<dyn Fn() -> Result<T> + Send + Sync>;

/// Makes a part for one simulation.
pub(crate) type Recipe<T> = Make<Box<T>>;

/// A linear structure that several simulations read, and names of its degrees of freedom.
pub(crate) struct Shared<T>(pub(crate) Arc<T>, pub(crate) Option<DofNames>);

impl<T> Clone for Shared<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0), self.1.clone())
    }
}

/// Methods that are forwarded to the shared structure.
macro_rules! forward {
    ($($name:ident($($argument:ident: $type:ty),*) -> $out:ty;)+) => {
        $(fn $name(&self $(, $argument: $type)*) -> $out {
            self.0.$name($($argument),*)
        })+
    };
}

impl<T: Structure + Sync> Structure for Shared<T> {
    forward! {
        dofs() -> usize;
        base() -> Base;
        mass(matrix: &mut Triplets) -> Result<()>;
        stiffness(matrix: &mut Triplets) -> Result<()>;
        damping(matrix: &mut Triplets) -> Result<()>;
        geometric_stiffness(matrix: &mut Triplets) -> Result<()>;
        has_active_damping() -> bool;
        has_active_stiffness() -> bool;
        description() -> StructureDescription;
        load(time: f64, load: &mut [f64]) -> Result<()>;
    }

    fn describe(&self, dofs: &[usize]) -> Option<String> {
        match &self.1 {
            Some(names) => names.describe(dofs),
            None => self.0.describe(dofs),
        }
    }
}
