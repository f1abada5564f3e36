//! Reference tables, as comma-separated files, and comparison with them.

use std::path::PathBuf;
use std::str::FromStr;

/// Path of a file in `tests/data`.
pub fn data_path(file: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../data").join(file)
}

/// Reference table: comment lines, a line of column names, and rows.
///
/// Without that line, the last comment has the column names.
#[derive(Debug)]
pub struct ReferenceTable {
    name: String,
    comments: Vec<String>,
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

/// Reads `tests/data/{file}`; panics with the file's name if it is not a table.
pub fn table(file: &str) -> ReferenceTable {
    let text =
        std::fs::read_to_string(data_path(file)).unwrap_or_else(|error| panic!("{file}: {error}"));
    let comments: Vec<String> = text
        .lines()
        .filter_map(|line| line.strip_prefix('#'))
        .map(|line| line.trim().to_owned())
        .collect();
    let first = text.lines().find(|line| !line.starts_with('#')).unwrap_or_default();
    let has_heading = comments.is_empty() || !begins_with_number(first);
    let heading = if has_heading { first } else { comments.last().map_or("", String::as_str) };
    let columns = heading.split(',').map(|name| name.trim().to_owned()).collect();
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .has_headers(has_heading)
        .from_reader(text.as_bytes());
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.unwrap_or_else(|error| panic!("{file}: {error}"));
        rows.push(record.iter().map(str::to_owned).collect());
    }
    ReferenceTable { name: file.to_owned(), comments, columns, rows }
}

/// Whether the first field of a line is a number.
fn begins_with_number(line: &str) -> bool {
    line.split(',').next().is_some_and(|field| field.parse::<f64>().is_ok())
}

impl ReferenceTable {
    /// Comment lines, without their `#`.
    pub fn comments(&self) -> &[String] {
        &self.comments
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Text of a column.
    pub fn text(&self, column: &str) -> Vec<&str> {
        let index = self.columns.iter().position(|name| name == column).unwrap_or_else(|| {
            panic!("{}: no column '{column}' among {:?}", self.name, self.columns)
        });
        self.rows.iter().map(|row| row[index].as_str()).collect()
    }

    /// Numbers of a column.
    pub fn column(&self, column: &str) -> Vec<f64> {
        self.parsed(column)
    }

    fn parsed<T: FromStr>(&self, column: &str) -> Vec<T> {
        self.text(column)
            .into_iter()
            .map(|text| {
                text.parse().unwrap_or_else(|_| panic!("{}, {column}: '{text}'", self.name))
            })
            .collect()
    }

    /// Numbers of several columns, row by row.
    pub fn rows<const N: usize>(&self, columns: [&str; N]) -> Vec<[f64; N]> {
        let columns = columns.map(|column| self.column(column));
        (0..self.len()).map(|row| std::array::from_fn(|k| columns[k][row])).collect()
    }

    /// Numbers of the first row with this `text` in `column`.
    pub fn row<const N: usize>(&self, column: &str, text: &str, columns: [&str; N]) -> [f64; N] {
        let position = self.text(column).iter().position(|field| *field == text);
        let index = position.unwrap_or_else(|| panic!("{}: no '{text}' in {column}", self.name));
        self.rows(columns)[index]
    }

    /// Symmetric matrix, row by row, of the rows with `name` in column `matrix`: they list its upper triangle.
    pub fn symmetric(&self, name: &str, order: usize) -> Vec<f64> {
        let names = self.text("matrix");
        let rows: Vec<usize> = self.parsed("row");
        let columns: Vec<usize> = self.parsed("column");
        let values = self.column("value");
        let mut matrix = vec![0.0; order * order];
        for k in (0..self.len()).filter(|&k| names[k] == name) {
            matrix[rows[k] * order + columns[k]] = values[k];
            matrix[columns[k] * order + rows[k]] = values[k];
        }
        matrix
    }

    /// Words after `label` in the comments, up to the end of its line.
    pub fn words_after(&self, label: &str) -> Vec<&str> {
        let line = self.comments.iter().find_map(|line| line.split_once(label));
        let line = line.unwrap_or_else(|| panic!("{}: no '{label}'", self.name));
        line.1.split_whitespace().collect()
    }
}

/// Asserts |computed − expected| ≤ `absolute` + `relative`·|expected|.
#[track_caller]
pub fn assert_close(quantity: &str, computed: f64, expected: f64, absolute: f64, relative: f64) {
    let error = (computed - expected).abs();
    assert!(
        error <= absolute + relative * expected.abs(),
        "{quantity}: {computed:e}, but expected {expected:e} (error {error:.1e})"
    );
}
