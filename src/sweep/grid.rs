//! All combinations of the values of some parameters, numbered.

use std::collections::HashSet;

use super::parameter::Parameter;
use crate::error::memory;
use crate::error::{Error, Result, SweepError};

/// Bytes of a case in tables and while files are merged: its number, and its outcome without the
/// results.
const BYTES_PER_CASE: f64 = 40.0;

/// Cases numbered by their place in the grid, the last parameter fastest.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Grid {
    pub(super) parameters: Vec<Parameter>,
    pub(super) count: usize,
}

impl Grid {
    /// All combinations.
    pub(super) fn new(parameters: Vec<Parameter>) -> Result<Self> {
        check_names(parameters.iter().map(Parameter::name))?;
        let mut count = 1_usize;
        for parameter in &parameters {
            parameter.check()?;
            let product = count as f64 * parameter.len() as f64;
            memory::check("cases of the sweep", product, BYTES_PER_CASE * product)?;
            count = count.saturating_mul(parameter.len());
        }
        Ok(Self { parameters, count })
    }

    /// Index of the parameter called `name`.
    fn index(&self, name: &str) -> Option<usize> {
        self.parameters.iter().position(|parameter| parameter.name() == name)
    }

    /// Place of case `case` among the values of parameter `index`.
    pub(super) fn place_of(&self, case: usize, index: usize) -> usize {
        let faster = self.parameters[index + 1..].iter().map(Parameter::len).product::<usize>();
        case / faster % self.parameters[index].len()
    }

    /// The parameter called `name`, and the place of case `case` among its values.
    fn find(&self, case: usize, name: &str) -> Option<(&Parameter, usize)> {
        let index = self.index(name)?;
        Some((&self.parameters[index], self.place_of(case, index)))
    }

    pub(super) fn number(&self, case: usize, name: &str) -> Option<f64> {
        self.find(case, name).and_then(|(parameter, place)| parameter.number(place))
    }

    pub(super) fn text(&self, case: usize, name: &str) -> Result<&str> {
        self.find(case, name)
            .and_then(|(parameter, place)| parameter.text(place))
            .ok_or_else(|| no_name("parameter with texts", name))
    }

    pub(super) fn place(&self, case: usize, name: &str) -> Result<usize> {
        self.find(case, name).map(|(_, place)| place).ok_or_else(|| no_name("parameter", name))
    }
}

/// The error of a name that is not there.
pub(super) fn no_name(quantity: &'static str, name: &str) -> Error {
    Error::Name { quantity, name: name.to_owned() }
}

/// Columns of a table behind the results.
pub(super) const LAST_COLUMNS: [&str; 2] = ["error", "check"];

/// Refuses columns without a name, and two of one name, those of every table among them.
pub(super) fn check_names<'a>(names: impl Iterator<Item = &'a str>) -> Result<()> {
    let mut before = HashSet::from(LAST_COLUMNS);
    before.insert("case");
    for name in names {
        if name.is_empty() {
            return Err(SweepError::Unnamed { quantity: "column" }.into());
        }
        if !before.insert(name) {
            return Err(Error::DuplicateName { quantity: "column", name: name.to_owned() });
        }
    }
    Ok(())
}
