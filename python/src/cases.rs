//! Files of a sweep's cases, as the core writes and reads them.

use std::path::PathBuf;

use basemat::sweep::{Parameter, Sweep};
use pyo3::prelude::*;

use crate::array::{Numbers, whole};
use crate::error::{OrRaise, returned};

/// Names of parameters and their values.
type Grid<'py> = Vec<(String, Bound<'py, PyAny>)>;
/// Columns of results, and for each case its results or the text of its error.
type Merged = (Vec<String>, Vec<(Option<Vec<f64>>, Option<String>)>);

/// The sweep over all combinations, or a shard of it.
fn sweep(grid: Grid<'_>, shard: Option<(usize, usize)>) -> PyResult<Sweep<'static>> {
    let parameters = grid.into_iter().map(|(name, values)| {
        if let Ok(texts) = values.extract::<Vec<String>>() {
            return Ok(Parameter::texts(name, texts));
        }
        let Numbers(numbers) = returned(&format!("the parameter '{name}'"), &values)?;
        Ok(Parameter::numbers(name, numbers))
    });
    let sweep = Sweep::grid(parameters.collect::<PyResult<Vec<_>>>()?).or_raise()?;
    match shard {
        Some((index, of)) => sweep.shard(index, of).or_raise(),
        None => Ok(sweep),
    }
}

/// Numbers of the cases of a grid, a list of pairs (name, values), or of its ``shard`` (index, of).
#[pyfunction(name = "_case_numbers")]
#[pyo3(signature = (grid, shard=None))]
pub(crate) fn case_numbers(
    grid: Grid<'_>,
    #[pyo3(from_py_with = whole)] shard: Option<(usize, usize)>,
) -> PyResult<Vec<usize>> {
    Ok(sweep(grid, shard)?.cases().collect())
}

/// Writes a file of cases: ``outcomes`` is the list of the results, in the order of ``columns``, or
/// the text of the error of each case.
#[pyfunction(name = "_save_cases")]
pub(crate) fn save_cases(
    path: PathBuf,
    grid: Grid<'_>,
    #[pyo3(from_py_with = whole)] shard: Option<(usize, usize)>,
    columns: Vec<String>,
    outcomes: Vec<Bound<'_, PyAny>>,
) -> PyResult<()> {
    let outcomes = outcomes.iter().map(|outcome| match outcome.extract::<String>() {
        Ok(reason) => Ok(Err(reason)),
        Err(_) => returned::<Numbers>("a case", outcome).map(|numbers| Ok(numbers.0)),
    });
    let outcomes: Vec<_> = outcomes.collect::<PyResult<_>>()?;
    let table = sweep(grid, shard)?.tabulate(&columns, outcomes).or_raise()?;
    table.csv().save(path).or_raise()
}

/// Columns and results of all cases of a grid from the files of its shards, and the texts of errors.
#[pyfunction(name = "_merge_cases")]
pub(crate) fn merge_cases(paths: Vec<PathBuf>, grid: Grid<'_>) -> PyResult<Merged> {
    let table = sweep(grid, None)?.merge(paths).or_raise()?;
    let outcomes = table.rows().map(|row| match row.results {
        Ok(results) => (Some(results.to_vec()), None),
        Err(reason) => (None, Some(reason.to_owned())),
    });
    Ok((table.columns().to_vec(), outcomes.collect()))
}
