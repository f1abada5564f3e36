//! Tables of text cells, written as plain text, Markdown or CSV.

use crate::text::csv::csv_line;

/// Text of a cell in one line: line ends and other control characters become spaces.
fn one_line(cell: &str) -> String {
    cell.replace(
        |character: char| character.is_control() || matches!(character, '\u{2028}' | '\u{2029}'),
        " ",
    )
}

/// Text of a cell, truncated to the width of its column.
///
/// A truncated text ends in `…`.
fn truncated(cell: String, width: usize) -> String {
    if cell.chars().nth(width).is_none() {
        return cell;
    }
    cell.chars().take(width.saturating_sub(1)).chain(['…']).collect()
}

/// Largest number of characters of a line, for terminals of 100 columns.
pub const MAX_LINE_CHARACTERS: usize = 99;
/// Largest width of the first column in a table of several blocks, characters: half a line.
const MAX_NAME_WIDTH: usize = 47;
/// Largest width of the other repeated columns, characters: they leave room for columns of numbers.
const MAX_REPEATED_WIDTH: usize = 20;
/// Number of spaces between columns.
const COLUMN_GAP: usize = 2;

/// Heading and rows of cells; the first column contains names.
pub struct Table {
    /// Titles of the columns.
    pub heading: Vec<String>,
    /// Number of first columns that every block of a wide table repeats.
    pub repeated_column_count: usize,
    /// Cells of each row.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// Writes the table in columns aligned by spaces.
    ///
    /// Names are aligned to the left, other cells to the right. A table that is wider than a line is split into
    /// blocks; cells that are too long are truncated, and end in `…`.
    pub fn text(&self) -> String {
        let mut widths: Vec<usize> =
            (0..self.heading.len()).map(|column| self.column_width(column)).collect();
        let columns: Vec<usize> = (0..self.heading.len()).collect();
        if line_width(&columns, &widths) <= MAX_LINE_CHARACTERS {
            return self.block_text(&columns, &widths);
        }
        let (repeated_columns, other_columns) =
            columns.split_at(self.repeated_column_count.min(columns.len()));
        for &column in repeated_columns {
            let max_width = if column == 0 { MAX_NAME_WIDTH } else { MAX_REPEATED_WIDTH };
            widths[column] = widths[column].min(max_width);
        }
        let remaining_width =
            MAX_LINE_CHARACTERS.saturating_sub(line_width(repeated_columns, &widths) + COLUMN_GAP);
        let mut blocks = Vec::new();
        let mut block = repeated_columns.to_vec();
        for &column in other_columns {
            widths[column] = widths[column].min(remaining_width);
            let block_width = line_width(&block, &widths) + COLUMN_GAP + widths[column];
            if block.len() > repeated_columns.len() && block_width > MAX_LINE_CHARACTERS {
                blocks.push(std::mem::replace(&mut block, repeated_columns.to_vec()));
            }
            block.push(column);
        }
        blocks.push(block);
        blocks
            .iter()
            .map(|block| self.block_text(block, &widths))
            .collect::<Vec<_>>()
            .join("\n\n")
    }

    /// Largest number of characters of a cell in a column.
    fn column_width(&self, column: usize) -> usize {
        let rows = std::iter::once(&self.heading).chain(&self.rows);
        let cells = rows.filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    }

    /// Text of a block with some of the table's columns.
    fn block_text(&self, columns: &[usize], widths: &[usize]) -> String {
        let total_gap = COLUMN_GAP * columns.len().saturating_sub(1);
        let separator = "-".repeat(columns.iter().map(|&k| widths[k]).sum::<usize>() + total_gap);
        let mut lines = vec![text_line(&self.heading, columns, widths), separator];
        lines.extend(self.rows.iter().map(|row| text_line(row, columns, widths)));
        lines.join("\n")
    }

    /// Writes the table as Markdown; bars and backslashes in cells are escaped.
    pub fn markdown(&self) -> String {
        let alignments = vec!["---:"; self.heading.len().saturating_sub(1)];
        let mut lines =
            vec![markdown_line(&self.heading), format!("|---|{}|", alignments.join("|"))];
        lines.extend(self.rows.iter().map(|row| markdown_line(row)));
        lines.join("\n")
    }

    /// Writes the table as CSV (RFC 4180).
    pub fn csv(&self) -> String {
        let mut text = String::new();
        for row in std::iter::once(&self.heading).chain(&self.rows) {
            text += &csv_line(row);
        }
        text
    }
}

/// Number of characters of a line with these columns.
fn line_width(columns: &[usize], widths: &[usize]) -> usize {
    columns
        .iter()
        .map(|&k| widths[k] + COLUMN_GAP)
        .sum::<usize>()
        .saturating_sub(COLUMN_GAP)
}

/// Line of the cells of a row in some columns, aligned by spaces.
fn text_line(row: &[String], columns: &[usize], widths: &[usize]) -> String {
    let mut cells = Vec::new();
    for &column in columns {
        if let Some(cell) = row.get(column) {
            let width = widths[column];
            let text = truncated(one_line(cell), width);
            let is_name = column == 0;
            cells.push(if is_name { format!("{text:<width$}") } else { format!("{text:>width$}") });
        }
    }
    cells.join(&" ".repeat(COLUMN_GAP)).trim_end().to_owned()
}

/// Line of a Markdown table.
fn markdown_line(row: &[String]) -> String {
    let mut cells = Vec::new();
    for cell in row {
        cells.push(one_line(cell).replace('\\', "\\\\").replace('|', "\\|"));
    }
    format!("| {} |", cells.join(" | "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(row: &[&str]) -> Vec<String> {
        row.iter().map(|&cell| cell.to_owned()).collect()
    }

    fn column_count(block: &str) -> usize {
        block.lines().nth(2).unwrap().split("  ").count()
    }

    /// A table of two columns of equal rows.
    fn two_columns(first_width: usize) -> String {
        let row = vec!["a".repeat(first_width), "b".repeat(49)];
        Table { heading: row.clone(), repeated_column_count: 1, rows: vec![row] }.text()
    }

    #[test]
    fn cells_stay_in_their_row() {
        let heading = cells(&["", "two\nlines", "a\\|b\r\u{2028}\u{85}\x1b"]);
        let rows = vec![cells(&["x", "1", "2"])];
        let table = Table { heading, repeated_column_count: 1, rows };
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
        let table = Table {
            heading: cells(&["name", "µ, x"]),
            repeated_column_count: 1,
            rows: vec![cells(&["a|b", "1"]), cells(&["c \"d\"", "22.5"])],
        };
        assert_eq!(table.text(), "name   µ, x\n-----------\na|b       1\nc \"d\"  22.5");
        assert_eq!(
            table.markdown(),
            "| name | µ, x |\n|---|---:|\n| a\\|b | 1 |\n| c \"d\" | 22.5 |"
        );
        assert_eq!(table.csv(), "name,\"µ, x\"\na|b,1\n\"c \"\"d\"\"\",22.5\n");
    }

    #[test]
    fn wide_tables_are_split_into_blocks() {
        let widths = [3, 4, 40, 30, 15, 98, 200, 1];
        let heading = widths.map(|width| "é".repeat(width)).to_vec();
        let rows = ["1", "2"].map(|sign| widths.map(|width| sign.repeat(width)).to_vec()).to_vec();
        let text = Table { heading, repeated_column_count: 2, rows }.text();
        let max_characters = text.lines().map(|line| line.chars().count()).max();
        // Cells of 98 and 200 characters are truncated to the width beside the names.
        assert_eq!(max_characters, Some(MAX_LINE_CHARACTERS));
        let blocks: Vec<_> = text.split("\n\n").collect();
        let column_counts: Vec<_> = blocks.iter().map(|block| column_count(block)).collect();
        assert_eq!(column_counts, [4, 3, 3, 3, 3]);
        assert!(
            blocks.iter().all(|block| block.lines().nth(3).unwrap().starts_with("222  2222  2"))
        );
        assert_eq!(text.matches('…').count(), 6);
        // A table one character wider than a line is split into blocks.
        assert!(!two_columns(48).contains('…') && two_columns(48).lines().count() == 3);
        let is_short = |line: &str| line.chars().count() <= MAX_LINE_CHARACTERS;
        assert!(two_columns(49).lines().all(is_short));
    }
}
