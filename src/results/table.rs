//! Plain tables.

use std::borrow::Cow;

/// A cell as CSV has it (RFC 4180): in quotes where it needs them.
pub(super) fn csv_cell(cell: &str) -> Cow<'_, str> {
    if cell.contains([',', '"', '\n', '\r']) {
        Cow::Owned(format!("\"{}\"", cell.replace('"', "\"\"")))
    } else {
        Cow::Borrowed(cell)
    }
}

/// A cell on one line: line ends and other control characters become spaces.
fn one_line(cell: &str) -> String {
    cell.replace(|c: char| c.is_control() || matches!(c, '\u{2028}' | '\u{2029}'), " ")
}

/// A heading and rows of cells; the first column holds names.
pub(super) struct Table {
    pub(super) heading: Vec<String>,
    pub(super) rows: Vec<Vec<String>>,
}

impl Table {
    /// Columns aligned with spaces, names to the left and the rest to the right.
    pub(super) fn text(&self) -> String {
        let columns = self.heading.len();
        let width = |column: usize| {
            let lines = std::iter::once(&self.heading).chain(&self.rows);
            lines.filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max()
        };
        let widths: Vec<usize> = (0..columns).map(|column| width(column).unwrap_or(0)).collect();
        let line = |row: &Vec<String>| {
            let cells = row.iter().map(|cell| one_line(cell)).zip(&widths).enumerate();
            let cells = cells.map(|(column, (cell, &width))| {
                if column == 0 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
            });
            cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
        };
        let rule = "-".repeat(widths.iter().sum::<usize>() + 2 * columns.saturating_sub(1));
        let mut lines = vec![line(&self.heading), rule];
        lines.extend(self.rows.iter().map(line));
        lines.join("\n")
    }

    /// As Markdown; bars and backslashes in cells are escaped.
    pub(super) fn markdown(&self) -> String {
        let escaped = |cell: &str| one_line(cell).replace('\\', "\\\\").replace('|', "\\|");
        let line = |row: &Vec<String>| {
            let cells: Vec<_> = row.iter().map(|cell| escaped(cell)).collect();
            format!("| {} |", cells.join(" | "))
        };
        let rule = vec!["---:"; self.heading.len().saturating_sub(1)];
        let mut lines = vec![line(&self.heading), format!("|---|{}|", rule.join("|"))];
        lines.extend(self.rows.iter().map(line));
        lines.join("\n")
    }

    /// As CSV (RFC 4180).
    pub(super) fn csv(&self) -> String {
        let mut text = String::new();
        for row in std::iter::once(&self.heading).chain(&self.rows) {
            text += &row.iter().map(|cell| csv_cell(cell)).collect::<Vec<_>>().join(",");
            text.push('\n');
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_stay_in_their_row() {
        let cells = |row: &[&str]| row.iter().map(|&cell| cell.to_owned()).collect::<Vec<_>>();
        let heading = cells(&["", "two\nlines", "a\\|b\r\u{2028}\u{85}\x1b"]);
        let table = Table { heading, rows: vec![cells(&["x", "1", "2"])] };
        assert_eq!(
            table.text(),
            "   two lines  a\\|b\n----------------------\nx          1         2"
        );
        assert_eq!(
            table.markdown(),
            "|  | two lines | a\\\\\\|b     |\n|---|---:|---:|\n| x | 1 | 2 |"
        );
    }

    #[test]
    fn three_ways_to_write_a_table() {
        let cells = |row: &[&str]| row.iter().map(|&cell| cell.to_owned()).collect::<Vec<_>>();
        let table = Table {
            heading: cells(&["name", "µ, x"]),
            rows: vec![cells(&["a|b", "1"]), cells(&["c \"d\"", "22.5"])],
        };
        assert_eq!(table.text(), "name   µ, x\n-----------\na|b       1\nc \"d\"  22.5");
        assert_eq!(
            table.markdown(),
            "| name | µ, x |\n|---|---:|\n| a\\|b | 1 |\n| c \"d\" | 22.5 |"
        );
        assert_eq!(table.csv(), "name,\"µ, x\"\na|b,1\n\"c \"\"d\"\"\",22.5\n");
    }
}
