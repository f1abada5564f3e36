//! Plain tables.

use crate::text::csv::csv_line;

/// A cell on one line: line ends and other control characters become spaces.
fn one_line(cell: &str) -> String {
    cell.replace(|c: char| c.is_control() || matches!(c, '\u{2028}' | '\u{2029}'), " ")
}

/// A cell that is longer than its column is cut, and ends in `…`.
fn cut(cell: String, width: usize) -> String {
    if cell.chars().nth(width).is_none() {
        return cell;
    }
    cell.chars().take(width.saturating_sub(1)).chain(['…']).collect()
}

/// Largest number of characters of a line: below 100.
pub(crate) const LONGEST_LINE: usize = 99;
/// Largest width of the first column, and of other repeated columns, in a table that breaks into blocks,
/// characters.
const WIDEST_NAME: usize = 47;
const WIDEST_REPEATED: usize = 20;
/// Number of blanks between columns.
const GAP: usize = 2;

/// A heading and rows of cells; the first column holds names.
pub(crate) struct Table {
    pub(crate) heading: Vec<String>,
    /// Number of columns, from the first on, that every block of a wide table repeats.
    pub(crate) repeated: usize,
    pub(crate) rows: Vec<Vec<String>>,
}

impl Table {
    /// The table with columns aligned by spaces, names to the left and other columns to the right.
    ///
    /// A table that is wider than a line breaks into blocks; cells that are too long are cut, and end in `…`.
    pub(crate) fn text(&self) -> String {
        let columns = self.heading.len();
        let width = |column: usize| {
            let lines = std::iter::once(&self.heading).chain(&self.rows);
            lines.filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max()
        };
        let mut widths: Vec<usize> = (0..columns).map(|k| width(k).unwrap_or(0)).collect();
        let total = |columns: &[usize], widths: &[usize]| {
            columns.iter().map(|&k| widths[k] + GAP).sum::<usize>().saturating_sub(GAP)
        };
        let all: Vec<usize> = (0..columns).collect();
        if total(&all, &widths) <= LONGEST_LINE {
            return self.block(&all, &widths);
        }
        let (names, others) = all.split_at(self.repeated.min(columns));
        for &k in names {
            widths[k] = widths[k].min(if k == 0 { WIDEST_NAME } else { WIDEST_REPEATED });
        }
        let rest = LONGEST_LINE.saturating_sub(total(names, &widths) + GAP);
        let (mut blocks, mut block) = (Vec::new(), names.to_vec());
        for &k in others {
            widths[k] = widths[k].min(rest);
            if block.len() > names.len() && total(&block, &widths) + GAP + widths[k] > LONGEST_LINE
            {
                blocks.push(std::mem::replace(&mut block, names.to_vec()));
            }
            block.push(k);
        }
        blocks.push(block);
        blocks.iter().map(|block| self.block(block, &widths)).collect::<Vec<_>>().join("\n\n")
    }

    /// Block of a table with some of its columns.
    fn block(&self, columns: &[usize], widths: &[usize]) -> String {
        let line = |row: &Vec<String>| {
            let cells = columns.iter().filter_map(|&k| Some((k, row.get(k)?, widths[k])));
            let cells = cells.map(|(k, cell, width)| {
                let cell = cut(one_line(cell), width);
                if k == 0 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
            });
            cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
        };
        let between = GAP * columns.len().saturating_sub(1);
        let rule = "-".repeat(columns.iter().map(|&k| widths[k]).sum::<usize>() + between);
        let mut lines = vec![line(&self.heading), rule];
        lines.extend(self.rows.iter().map(line));
        lines.join("\n")
    }

    /// Writes the table as Markdown; bars and backslashes in cells are escaped.
    pub(crate) fn markdown(&self) -> String {
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

    /// Writes the table as CSV (RFC 4180).
    pub(crate) fn csv(&self) -> String {
        let mut text = String::new();
        for row in std::iter::once(&self.heading).chain(&self.rows) {
            text += &csv_line(row);
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
        let rows = vec![cells(&["x", "1", "2"])];
        let table = Table { heading, repeated: 1, rows };
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
            repeated: 1,
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
    fn wide_tables_break_into_blocks() {
        let widths = [3, 4, 40, 30, 15, 98, 200, 1];
        let cells = |sign: char| widths.map(|width| sign.to_string().repeat(width)).to_vec();
        let table = Table { heading: cells('é'), repeated: 2, rows: vec![cells('1'), cells('2')] };
        let text = table.text();
        let longest = text.lines().map(|line| line.chars().count()).max();
        // Cells of 98 and 200 characters are cut to the room left by the names.
        assert_eq!(longest, Some(LONGEST_LINE));
        let columns = |block: &str| block.lines().nth(2).unwrap().split("  ").count();
        let blocks: Vec<_> = text.split("\n\n").collect();
        assert_eq!(blocks.iter().map(|block| columns(block)).collect::<Vec<_>>(), [4, 3, 3, 3, 3]);
        assert!(
            blocks.iter().all(|block| block.lines().nth(3).unwrap().starts_with("222  2222  2"))
        );
        assert_eq!(text.matches('…').count(), 6);
        // A table one character wider than a line breaks into blocks.
        let table = |width: usize| {
            let row = vec!["a".repeat(width), "b".repeat(49)];
            Table { heading: row.clone(), repeated: 1, rows: vec![row] }.text()
        };
        assert!(!table(48).contains('…') && table(48).lines().count() == 3);
        assert!(table(49).lines().all(|line| line.chars().count() <= LONGEST_LINE));
    }
}
