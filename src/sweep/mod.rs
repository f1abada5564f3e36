//! Many independent simulations: sweeps over parameters, their tables, and shards of both.
//!
//! A [`Sweep`] runs its cases by one closure: with the feature `rayon` on all processors, without it one
//! after the other. Results are the same bit for bit, because each simulation is built, run and dropped on
//! one thread. An error or a panic in one case does not affect the others.
//!
//! ```
//! use basemat::prelude::*;
//!
//! let sweep = Sweep::grid([
//!     Parameter::numbers("friction", [0.2, 0.4]),
//!     Parameter::texts("record", ["El Centro", "El Centro, halved"]),
//! ])?;
//! let table = sweep.table(["peak_slip_m"], |case| {
//!     let factor = [1.0, 0.5][case.place("record")?];
//!     let run = Simulation::builder(0.01)
//!         .ground(SpringGround::new(-3.0..3.0, 6, 2.0e7, 1.5e7)?.with_dashpots(4.0e5, 2.0e5)?)
//!         .structure(RigidBlock::new(6.0, 3.0, 2000.0)?)
//!         .interface(Coulomb::new(case.value("friction")?)?)
//!         .motion(el_centro_1940().scaled(factor)?)
//!         .build()?
//!         .run(400, |_| {})?;
//!     basemat::Result::Ok([run.whole.mean_slip.magnitude()])
//! })?;
//!
//! println!("{table}");
//! let slips = table.rows().map(|row| row.value("peak_slip_m"));
//! let slips = slips.collect::<basemat::Result<Vec<_>>>()?;
//! assert!(slips[0] > slips[1] && slips[0] > slips[2]);
//! # Ok::<(), basemat::Error>(())
//! ```
//!
//! Thousands of runs can be distributed over many processes. [`Sweep::shard`] selects a part of the cases.
//! [`Sweep::table_in`] stores their rows in a file, from which a restarted process continues. [`Sweep::merge`]
//! combines the files of all shards. `docs/guide.md` has a complete job array.

#[cfg(feature = "io")]
mod case_file;
#[cfg(feature = "io")]
mod file;
mod run;
#[cfg(feature = "io")]
mod stored;
mod table;

#[doc(inline)]
pub use crate::error::{CaseError, SweepError};
#[cfg(feature = "io")]
pub use case_file::CaseFile;
pub use run::{Sweep, SweepCase};
pub use table::{CaseRow, CaseTable};

use std::collections::HashSet;
use std::hash::Hash;

use crate::error::{Error, Result, all_finite, at_least, memory, require_part};

/// Bytes of a case in tables and merged files: its number, and its outcome without results.
const BYTES_PER_CASE: f64 = 40.0;

/// All combinations of the parameters' values, numbered with the last parameter fastest.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CaseGrid {
    pub(super) parameters: Vec<Parameter>,
    /// Number of combinations.
    pub(super) case_count: usize,
}

impl CaseGrid {
    /// Grid of these parameters; an error for an invalid one, or too many cases.
    pub(super) fn new(parameters: Vec<Parameter>) -> Result<Self> {
        check_names(parameters.iter().map(Parameter::name))?;
        let mut case_count = 1_usize;
        for parameter in &parameters {
            parameter.check()?;
            let product = case_count as f64 * parameter.len() as f64;
            memory::check("cases of the sweep", product, BYTES_PER_CASE * product)?;
            case_count = case_count.saturating_mul(parameter.len());
        }
        Ok(Self { parameters, case_count })
    }

    /// Index of the parameter called `name`.
    fn parameter_index(&self, name: &str) -> Option<usize> {
        self.parameters.iter().position(|parameter| parameter.name() == name)
    }

    /// Index of the value that a parameter has in a case.
    pub(super) fn value_index(&self, case: usize, parameter_index: usize) -> usize {
        let cases_per_value =
            self.parameters[parameter_index + 1..].iter().map(Parameter::len).product::<usize>();
        case / cases_per_value % self.parameters[parameter_index].len()
    }

    /// The parameter called `name`, and the index of its value in a case.
    fn parameter_and_value_index(&self, case: usize, name: &str) -> Option<(&Parameter, usize)> {
        let index = self.parameter_index(name)?;
        Some((&self.parameters[index], self.value_index(case, index)))
    }

    /// Number of a parameter in a case, if there is such a parameter.
    pub(super) fn number(&self, case: usize, name: &str) -> Option<f64> {
        self.parameter_and_value_index(case, name)
            .and_then(|(parameter, index)| parameter.number(index))
    }

    /// Text of a parameter in a case; an error if there is no such parameter.
    pub(super) fn text(&self, case: usize, name: &str) -> Result<&str> {
        self.parameter_and_value_index(case, name)
            .and_then(|(parameter, index)| parameter.text(index))
            .ok_or_else(|| self.missing_name_error("parameter with texts", name, &[]))
    }

    /// Index of the value that the parameter called `name` has in a case.
    pub(super) fn named_value_index(&self, case: usize, name: &str) -> Result<usize> {
        self.parameter_and_value_index(case, name)
            .map(|(_, index)| index)
            .ok_or_else(|| self.missing_name_error("parameter", name, &[]))
    }

    /// The error for a name that is neither a parameter nor one of `columns`.
    pub(super) fn missing_name_error(
        &self,
        quantity: &'static str,
        name: &str,
        columns: &[String],
    ) -> Error {
        let parameters = self.parameters.iter().map(Parameter::name);
        Error::no_name(quantity, name, parameters.chain(columns.iter().map(String::as_str)))
    }
}

/// Column of a table after the results, in files of programs whose runs warn.
pub(super) const WARNINGS_COLUMN: &str = "warnings";

/// Last column of a table.
pub(super) const ERROR_COLUMN: &str = "error";

/// Error for a column without a name, or with a name that occurs twice or is reserved.
pub(super) fn check_names<'a>(names: impl Iterator<Item = &'a str>) -> Result<()> {
    let mut earlier_names = HashSet::from(["case", WARNINGS_COLUMN, ERROR_COLUMN]);
    for name in names {
        require_part("column", !name.is_empty(), "it must have a name")?;
        if !earlier_names.insert(name) {
            return Err(Error::DuplicateName { quantity: "column", name: name.to_owned() });
        }
    }
    Ok(())
}

/// A parameter of a [`Sweep`]: its name and its values, numbers or texts.
///
/// [`Sweep::grid`](Sweep::grid) checks the values. A constant of the study is a parameter with one value: its
/// column then distinguishes the tables of different studies.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    name: String,
    values: ParameterValues,
}

/// Values of a parameter, all of one kind.
#[derive(Debug, Clone, PartialEq)]
enum ParameterValues {
    Numbers(Vec<f64>),
    Texts(Vec<String>),
}

impl Parameter {
    /// A parameter with numbers; its name should contain the unit: `width_m`.
    pub fn numbers(name: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        Self {
            name: name.into(),
            values: ParameterValues::Numbers(values.into_iter().collect()),
        }
    }

    /// A parameter with texts, for example names of records.
    pub fn texts(
        name: impl Into<String>,
        values: impl IntoIterator<Item = impl Into<String>>,
    ) -> Self {
        let values = values.into_iter().map(Into::into).collect();
        Self { name: name.into(), values: ParameterValues::Texts(values) }
    }

    /// Name of the parameter and of its column.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// Number of values.
    pub(crate) fn len(&self) -> usize {
        match &self.values {
            ParameterValues::Numbers(numbers) => numbers.len(),
            ParameterValues::Texts(texts) => texts.len(),
        }
    }

    /// Number at `index`; `None` for a parameter with texts or beyond the last value.
    pub(super) fn number(&self, index: usize) -> Option<f64> {
        match &self.values {
            ParameterValues::Numbers(numbers) => numbers.get(index).copied(),
            ParameterValues::Texts(_) => None,
        }
    }

    /// Text at `index`; `None` for a parameter with numbers or beyond the last value.
    pub(super) fn text(&self, index: usize) -> Option<&str> {
        match &self.values {
            ParameterValues::Numbers(_) => None,
            ParameterValues::Texts(texts) => texts.get(index).map(String::as_str),
        }
    }

    /// Error for no values, a repeated value, a number that is not finite, or an empty text.
    pub(super) fn check(&self) -> Result<()> {
        let item = format!("parameter '{}'", self.name);
        match self.repeated_value().map_err(|error| error.within(item.clone()))? {
            None => Ok(()),
            Some(name) => {
                let error = Error::DuplicateName { quantity: "value", name };
                Err(error.within(item))
            }
        }
    }

    /// A value that occurs twice; an error for no values or a value that is not valid.
    fn repeated_value(&self) -> Result<Option<String>> {
        at_least("list of values", self.len(), 1)?;
        match &self.values {
            ParameterValues::Numbers(numbers) => {
                all_finite("list of values", numbers)?;
                // Positive and negative zero are the same value.
                let repeated_number = first_repeated(numbers, |value| (value + 0.0).to_bits());
                Ok(repeated_number.map(f64::to_string))
            }
            ParameterValues::Texts(texts) => {
                let has_no_empty_text = !texts.iter().any(String::is_empty);
                require_part("value", has_no_empty_text, "it must not be an empty text")?;
                Ok(first_repeated(texts, String::as_str).cloned())
            }
        }
    }
}

/// The first value whose key has occurred before.
fn first_repeated<'a, T, K: Hash + Eq>(values: &'a [T], key: impl Fn(&'a T) -> K) -> Option<&'a T> {
    let mut earlier_keys = HashSet::new();
    values.iter().find(|value| !earlier_keys.insert(key(value)))
}
