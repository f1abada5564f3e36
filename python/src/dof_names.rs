//! Names of degrees of freedom.

use std::collections::BTreeSet;
use std::sync::Arc;

use pyo3::prelude::*;

use crate::error::input_error;

/// Largest number of names that an error lists.
const MAX_LISTED_NAMES: usize = 8;

/// A name for each degree of freedom of a structure; all differ.
#[derive(Clone)]
pub(crate) struct DofNames(Arc<[String]>);

impl DofNames {
    /// Names of `dofs` degrees of freedom.
    pub(crate) fn new(names: Vec<String>, dofs: usize) -> PyResult<Self> {
        if names.len() != dofs {
            let found = names.len();
            return Err(input_error(format!("dof_names has {found} names, but must have {dofs}")));
        }
        let mut distinct = BTreeSet::new();
        match names.iter().find(|name| !distinct.insert(name.as_str())) {
            Some(repeated) => Err(input_error(format!(
                "dof_names has '{repeated}' twice, but must name each once"
            ))),
            None => Ok(Self(names.into())),
        }
    }

    /// The attribute `dof_names` of a structure with `dofs` degrees of freedom, if it has one.
    pub(crate) fn from_structure(
        structure: &Bound<'_, PyAny>,
        dofs: usize,
    ) -> PyResult<Option<Self>> {
        let found = structure.getattr_opt("dof_names")?.filter(|names| !names.is_none());
        let names =
            found.map(|names| crate::error::extract_returned("dof_names of the structure", &names));
        names.transpose()?.map(|names| Self::new(names, dofs)).transpose()
    }

    pub(crate) fn to_vec(&self) -> Vec<String> {
        self.0.to_vec()
    }

    /// The number of the degree of freedom with this name.
    pub(crate) fn number(&self, name: &str) -> PyResult<usize> {
        self.0.iter().position(|dof_name| dof_name == name).ok_or_else(|| {
            let all_dofs: Vec<usize> = (0..self.0.len()).collect();
            let names = self.describe(&all_dofs).unwrap_or_default();
            input_error(format!("there is no degree of freedom '{name}', only {names}"))
        })
    }

    /// The first names of these degrees of freedom.
    pub(crate) fn describe(&self, dofs: &[usize]) -> Option<String> {
        let names = dofs
            .iter()
            .take(MAX_LISTED_NAMES)
            .map(|&dof| Some(format!("'{}'", self.0.get(dof)?)));
        let mut text = names.collect::<Option<Vec<_>>>()?.join(", ");
        if let Some(more) = dofs.len().checked_sub(MAX_LISTED_NAMES + 1) {
            text = format!("{text} and {} more", more + 1);
        }
        Some(text)
    }
}
