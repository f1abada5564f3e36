//! Reference tables, as comma-separated files, and comparison with them.

use std::path::PathBuf;

/// Path of a file in `tests/data`.
pub fn data_path(file: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../data").join(file)
}

/// Reference table: comment lines, then a line of column names (or the last comment has them), then
/// the rows.
#[derive(Debug)]
pub struct Table {
    name: String,
    comments: Vec<String>,
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

/// Reads `tests/data/{file}`; panics with the file's name if it is not a table.
pub fn table(file: &str) -> Table {
    let text =
        std::fs::read_to_string(data_path(file)).unwrap_or_else(|error| panic!("{file}: {error}"));
    let comments: Vec<String> = text
        .lines()
        .filter_map(|line| line.strip_prefix('#'))
        .map(|line| line.trim().to_owned())
        .collect();
    let names = |line: &str| line.split(',').map(|name| name.trim().to_owned()).collect();
    let numeric = |line: &str| line.split(',').next().is_some_and(|x| x.parse::<f64>().is_ok());
    let first = text.lines().find(|line| !line.starts_with('#')).unwrap_or_default();
    let (columns, headed): (Vec<String>, bool) = match comments.last() {
        Some(last) if numeric(first) => (names(last), false),
        _ => (names(first), true),
    };
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .has_headers(headed)
        .from_reader(text.as_bytes());
    let fields = |record: &csv::StringRecord| record.iter().map(str::to_owned).collect();
    let rows = reader
        .records()
        .map(|record| fields(&record.unwrap_or_else(|error| panic!("{file}: {error}"))))
        .collect();
    Table { name: file.to_owned(), comments, columns, rows }
}

impl Table {
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
        let parse = |text: &str| {
            text.parse().unwrap_or_else(|_| panic!("{}, {column}: '{text}'", self.name))
        };
        self.text(column).into_iter().map(parse).collect()
    }

    /// Numbers of several columns, row by row.
    pub fn rows<const N: usize>(&self, columns: [&str; N]) -> Vec<[f64; N]> {
        let columns = columns.map(|column| self.column(column));
        (0..self.len()).map(|row| std::array::from_fn(|k| columns[k][row])).collect()
    }

    /// Numbers of the first row whose `column` holds `text`.
    pub fn row<const N: usize>(&self, column: &str, text: &str, columns: [&str; N]) -> [f64; N] {
        let found = self.text(column).iter().position(|field| *field == text);
        let index = found.unwrap_or_else(|| panic!("{}: no '{text}' in {column}", self.name));
        self.rows(columns)[index]
    }

    /// Symmetric matrix, row by row, of the rows whose column `matrix` holds `name`: they list its upper triangle.
    pub fn symmetric(&self, name: &str, order: usize) -> Vec<f64> {
        let index = |column| {
            let parse = |text: &str| {
                text.parse().unwrap_or_else(|_| panic!("{}, {column}: '{text}'", self.name))
            };
            self.text(column).into_iter().map(parse).collect::<Vec<usize>>()
        };
        let [rows, columns] = ["row", "column"].map(index);
        let (matrices, values) = (self.text("matrix"), self.column("value"));
        let mut all = vec![0.0; order * order];
        for k in (0..self.len()).filter(|&k| matrices[k] == name) {
            all[rows[k] * order + columns[k]] = values[k];
            all[columns[k] * order + rows[k]] = values[k];
        }
        all
    }

    /// Words after `label` in the comments, up to the end of its line.
    pub fn words_after(&self, label: &str) -> Vec<&str> {
        let found = self.comments.iter().find_map(|line| line.split_once(label));
        let (_, words) = found.unwrap_or_else(|| panic!("{}: no '{label}'", self.name));
        words.split_whitespace().collect()
    }
}

/// Asserts |found − wanted| ≤ `absolute` + `relative`·|wanted|.
#[track_caller]
pub fn close(what: &str, found: f64, wanted: f64, absolute: f64, relative: f64) {
    let error = (found - wanted).abs();
    assert!(
        error <= absolute + relative * wanted.abs(),
        "{what}: {found:e}, but {wanted:e} wanted (error {error:.1e})"
    );
}
