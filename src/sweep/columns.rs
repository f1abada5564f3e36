//! Columns of a table between its parameters and its errors.

/// Names of the results, and whether a column of warnings follows them.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Columns {
    pub(super) names: Vec<String>,
    pub(super) with_warnings: bool,
}

impl Columns {
    /// Columns of results alone.
    pub(super) fn of_results(names: Vec<String>) -> Self {
        Self { names, with_warnings: false }
    }

    /// The `results` of columns with other `names`, in the order of these columns; NaN where there is none.
    #[cfg(feature = "io")]
    pub(super) fn arranged(&self, names: &[String], results: Vec<f64>) -> Vec<f64> {
        if self.names == names {
            return results;
        }
        let result = |name| names.iter().position(|other| other == name).map(|at| results[at]);
        self.names.iter().map(|name| result(name).unwrap_or(f64::NAN)).collect()
    }
}
