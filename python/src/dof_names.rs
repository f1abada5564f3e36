//! Names of degrees of freedom.

use std::collections::BTreeSet;
use std::sync::Arc;

use pyo3::prelude::*;

use crate::error::refuse;

/// Most names that an error lists.
const LISTED: usize = 8;

/// A name for each degree of freedom of a structure, each another one.
#[derive(Clone)]
pub(crate) struct DofNames(Arc<[String]>);

impl DofNames {
    /// Names for so many degrees of freedom.
    pub(crate) fn new(names: Vec<String>, dofs: usize) -> PyResult<Self> {
        if names.len() != dofs {
            let found = names.len();
            return Err(refuse(format!("dof_names has {found} names, but must have {dofs}")));
        }
        let mut known = BTreeSet::new();
        match names.iter().find(|name| !known.insert(name.as_str())) {
            Some(twice) => {
                Err(refuse(format!("dof_names has '{twice}' twice, but must name each once")))
            }
            None => Ok(Self(names.into())),
        }
    }

    /// The attribute `dof_names` of a structure of so many degrees of freedom, if it has one.
    pub(crate) fn from_structure(
        structure: &Bound<'_, PyAny>,
        dofs: usize,
    ) -> PyResult<Option<Self>> {
        let found = structure.getattr_opt("dof_names")?.filter(|names| !names.is_none());
        let names = found.map(|names| crate::error::returned("dof_names of the structure", &names));
        names.transpose()?.map(|names| Self::new(names, dofs)).transpose()
    }

    pub(crate) fn to_vec(&self) -> Vec<String> {
        self.0.to_vec()
    }

    /// The number of the degree of freedom with this name.
    pub(crate) fn number(&self, name: &str) -> PyResult<usize> {
        self.0.iter().position(|own| own == name).ok_or_else(|| {
            let every: Vec<usize> = (0..self.0.len()).collect();
            let known = self.describe(&every).unwrap_or_default();
            refuse(format!("there is no degree of freedom '{name}', only {known}"))
        })
    }

    /// The first names of these degrees of freedom.
    pub(crate) fn describe(&self, dofs: &[usize]) -> Option<String> {
        let names = dofs.iter().take(LISTED).map(|&dof| Some(format!("'{}'", self.0.get(dof)?)));
        let mut text = names.collect::<Option<Vec<_>>>()?.join(", ");
        if let Some(more) = dofs.len().checked_sub(LISTED + 1) {
            text = format!("{text} and {} more", more + 1);
        }
        Some(text)
    }
}
