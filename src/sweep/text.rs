//! Tables of cases, printed.

use std::fmt;

use super::grid::LAST_COLUMNS;
use super::table::{CaseTable, heading, parameter_cells};
use crate::text::table::{LONGEST_LINE, Table};
use crate::text::unit::number;

/// Five figures, counts as they are; the smallest numbers, too, which need not be rounding here.
fn figures(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e15 {
        // No negative zero.
        format!("{}", value + 0.0)
    } else if value.abs() < 1e-6 {
        format!("{value:.3e}")
    } else {
        number(value)
    }
}

impl fmt::Display for CaseTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let columns = self.columns.len();
        let mut heading = heading(&self.grid, &self.columns);
        heading.truncate(heading.len() - LAST_COLUMNS.len());
        let rows = self.rows.iter().map(|row| {
            let mut cells = vec![row.case.to_string()];
            cells.extend(parameter_cells(&self.grid, row.case));
            match &row.outcome {
                Ok(results) => cells.extend(results.iter().map(|&value| figures(value))),
                Err(_) => cells.extend(std::iter::repeat_n("failed".to_owned(), columns)),
            }
            cells
        });
        f.write_str(&Table { heading, repeated: 1, rows: rows.collect() }.text())?;
        for row in &self.rows {
            if let Err(reason) = &row.outcome {
                for line in wrapped(&format!("case {} failed: {reason}", row.case), LONGEST_LINE) {
                    write!(f, "\n{line}")?;
                }
            }
        }
        Ok(())
    }
}

/// Lines of `text` of at most `most` characters, broken between words where that is possible.
fn wrapped(text: &str, most: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    let mut length = 0;
    for word in text.split_whitespace() {
        let mut word: Vec<char> = word.chars().filter(|sign| !sign.is_control()).collect();
        if length > 0 && length + 1 + word.len() > most {
            lines.push(String::new());
            length = 0;
        }
        if length > 0 {
            word.insert(0, ' ');
        }
        for sign in word {
            if length == most {
                lines.push(String::new());
                length = 0;
            }
            if let Some(line) = lines.last_mut() {
                line.push(sign);
            }
            length += 1;
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_texts_break() {
        assert_eq!(wrapped("one two\n three", 7), ["one two", "three"]);
        assert_eq!(wrapped("abcdefgh ij", 3), ["abc", "def", "gh", "ij"]);
        assert_eq!(wrapped("", 3), [""]);
        assert_eq!(figures(1e-12), "1.000e-12");
        assert_eq!([-0.0, 3600.0, 0.5, 1.25e20].map(figures), ["0", "3600", "0.50000", "1.250e20"]);
        assert_eq!([figures(f64::NAN), figures(f64::NEG_INFINITY)], ["NaN", "-inf"]);
    }
}
