//! Files of the cases of a sweep, which the core writes and reads.

use std::path::PathBuf;
use std::sync::Mutex;

use basemat::sweep::{CaseFile, CaseTable, Parameter, Sweep};
use pyo3::prelude::*;

use crate::array::{Numbers, whole_numbers};
use crate::error::{OrRaise, extract_returned, input_error};

/// Names of parameters and their values.
type ParameterGrid<'py> = Vec<(String, Bound<'py, PyAny>)>;
/// Columns of results, and for each case its number, its results, the texts of its warnings, and the text of its error.
type CaseOutcomes = (Vec<String>, Vec<(usize, Option<Vec<f64>>, Option<String>, Option<String>)>);

/// The sweep over all combinations, or a shard of it.
fn sweep_cases(grid: ParameterGrid<'_>, shard: Option<(usize, usize)>) -> PyResult<Sweep<'static>> {
    let parameters = grid.into_iter().map(|(name, values)| {
        if let Ok(texts) = values.extract::<Vec<String>>() {
            return Ok(Parameter::texts(name, texts));
        }
        let Numbers(numbers) = extract_returned(&format!("the parameter '{name}'"), &values)?;
        Ok(Parameter::numbers(name, numbers))
    });
    let sweep = Sweep::grid(parameters.collect::<PyResult<Vec<_>>>()?).or_raise()?;
    match shard {
        Some((shard_index, shard_count)) => sweep.shard(shard_index, shard_count).or_raise(),
        None => Ok(sweep),
    }
}

/// Numbers of the cases of a grid, a list of pairs (name, values), or of its ``shard`` (its index, number of shards).
#[pyfunction(name = "_case_numbers")]
#[pyo3(signature = (grid, shard=None))]
pub(crate) fn case_numbers(
    grid: ParameterGrid<'_>,
    #[pyo3(from_py_with = whole_numbers)] shard: Option<(usize, usize)>,
) -> PyResult<Vec<usize>> {
    Ok(sweep_cases(grid, shard)?.cases().collect())
}

/// Columns of results and rows of the cases in the file of a sweep.
fn case_outcomes(table: &CaseTable) -> CaseOutcomes {
    let rows = table.rows().map(|row| {
        let results = row.results.ok().map(<[f64]>::to_vec);
        let error = row.results.err().map(str::to_owned);
        let warnings = Some(row.warnings).filter(|text| !text.is_empty()).map(str::to_owned);
        (row.index, results, warnings, error)
    });
    (table.columns().to_vec(), rows.collect())
}

/// The file at ``path`` of the cases of a grid, or of its ``shard`` (its index, number of shards): rows are appended
/// while cases run.
#[pyclass(name = "_CaseFile", module = "basemat._core", frozen)]
pub(crate) struct PyCaseFile(Mutex<Option<CaseFile>>);

/// Error of a file that two threads use at the same time.
const FILE_IN_USE_ERROR: &str = "the file of cases is in use by another thread";
/// Error of a file after `finish`.
const FILE_FINISHED_ERROR: &str = "the file of cases is finished";

impl PyCaseFile {
    /// Calls a function with the file, unless `finish` has closed it.
    fn with_file<T>(&self, call: impl FnOnce(&mut CaseFile) -> PyResult<T>) -> PyResult<T> {
        let mut file = self.0.try_lock().map_err(|_| input_error(FILE_IN_USE_ERROR))?;
        call(file.as_mut().ok_or_else(|| input_error(FILE_FINISHED_ERROR))?)
    }
}

#[pymethods]
impl PyCaseFile {
    #[new]
    #[pyo3(signature = (path, grid, shard=None))]
    fn new(
        path: PathBuf,
        grid: ParameterGrid<'_>,
        #[pyo3(from_py_with = whole_numbers)] shard: Option<(usize, usize)>,
    ) -> PyResult<Self> {
        let file = sweep_cases(grid, shard)?.open(path).or_raise()?;
        Ok(Self(Mutex::new(Some(file))))
    }

    /// Columns of results, and the rows so far: number of the case, results, warnings, error.
    fn rows(&self) -> PyResult<CaseOutcomes> {
        self.with_file(|file| Ok(case_outcomes(&file.table())))
    }

    /// Appends the row of a case: ``results`` under ``names``, or the text of its ``error``.
    fn append(
        &self,
        case: usize,
        names: Vec<String>,
        results: Bound<'_, PyAny>,
        warnings: Option<String>,
        error: Option<String>,
    ) -> PyResult<()> {
        let outcome = match error {
            Some(reason) => Err(reason),
            None => Ok(extract_returned::<Numbers>(&format!("case {case}"), &results)?.0),
        };
        self.with_file(|file| {
            file.append(case, &names, outcome, &warnings.unwrap_or_default()).or_raise()
        })
    }

    /// Writes the whole file at once and returns its rows as `rows` does.
    fn finish(&self) -> PyResult<CaseOutcomes> {
        let file = self.0.try_lock().map_err(|_| input_error(FILE_IN_USE_ERROR))?.take();
        let file = file.ok_or_else(|| input_error(FILE_FINISHED_ERROR))?;
        Ok(case_outcomes(&file.finish().or_raise()?))
    }
}

/// Columns and rows of all cases of a grid from the files of its shards, as `_CaseFile.rows` returns them.
#[pyfunction(name = "_merge_cases")]
pub(crate) fn merge_cases(paths: Vec<PathBuf>, grid: ParameterGrid<'_>) -> PyResult<CaseOutcomes> {
    Ok(case_outcomes(&sweep_cases(grid, None)?.merge(paths).or_raise()?))
}
