//! Reader of Matrix Market files.

use std::io::Read;

use crate::error::MatrixFileError;
use crate::error::memory;
use crate::linalg::matrix::check_order;
use crate::structure::Triplets;
use crate::text::bounded_line;
use crate::text::number::{excerpt, finite};

const ROWS: &str = "rows of the matrix";

/// Why a line is refused, and which.
type Reason<T> = Result<T, (usize, MatrixFileError)>;

/// The first line.
struct Header {
    coordinate: bool,
    symmetric: bool,
}

/// The lines of the file.
struct Lines<'a> {
    source: bounded_line::Lines<&'a mut dyn Read>,
    /// The present line, without white space at its ends.
    text: String,
}

impl Lines<'_> {
    /// Reads the next line; false at the end of the file.
    fn advance(&mut self) -> Reason<bool> {
        let there = self.source.advance()?;
        self.text.clear();
        self.text.push_str(self.source.text().trim_ascii());
        Ok(there)
    }

    /// The next line that is neither empty nor a comment; false at the end of the file.
    fn advance_to_data(&mut self) -> Reason<bool> {
        while self.advance()? {
            if !self.text.is_empty() && !self.text.starts_with('%') {
                return Ok(true);
            }
        }
        Ok(false)
    }

    fn refuse(&self, reason: MatrixFileError) -> (usize, MatrixFileError) {
        (self.source.number, reason)
    }
}

pub(super) fn read(source: &mut dyn Read) -> Reason<Triplets> {
    let mut lines = Lines { source: bounded_line::Lines::new(source), text: String::new() };
    if !lines.advance()? {
        return Err((0, MatrixFileError::Empty));
    }
    let header = header(&lines.text).map_err(|reason| lines.refuse(reason))?;
    if !lines.advance_to_data()? {
        return Err(lines.refuse(MatrixFileError::Fields { found: 0, needed: sizes(&header) }));
    }
    let size = fields(&lines.text, sizes(&header))
        .and_then(|fields| fields.into_iter().map(whole_number).collect::<Result<Vec<_>, _>>())
        .map_err(|reason| lines.refuse(reason))?;
    let (rows, columns) = (size[0], size[1]);
    if rows != columns {
        return Err(lines.refuse(MatrixFileError::NotSquare { rows, columns }));
    }
    let fits = || {
        check_order(ROWS, rows)?;
        // An array has a line for each entry.
        let entries = if header.coordinate { 0.0 } else { (rows as f64).powi(2) };
        memory::check(ROWS, rows as f64, entries * size_of::<(usize, usize, f64)>() as f64)
    };
    fits().map_err(|reason| lines.refuse(reason.into()))?;
    let mut matrix = Triplets::new(rows);
    if header.coordinate {
        coordinates(&mut lines, &header, size[2], &mut matrix)?;
    } else {
        array(&mut lines, &header, &mut matrix)?;
    }
    Ok(matrix)
}

/// Numbers in the size line.
fn sizes(header: &Header) -> usize {
    if header.coordinate { 3 } else { 2 }
}

fn header(line: &str) -> Result<Header, MatrixFileError> {
    let cut = || line.chars().take(80).collect::<String>();
    let words: Vec<String> = line.split_whitespace().map(str::to_ascii_lowercase).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let &["%%matrixmarket", object, format, field, symmetry] = words.as_slice() else {
        return Err(MatrixFileError::Header { text: cut() });
    };
    let unsupported = |word: &str| MatrixFileError::Unsupported { text: word.to_owned() };
    if object != "matrix" {
        return Err(unsupported(object));
    }
    if !["real", "double", "integer"].contains(&field) {
        return Err(unsupported(field));
    }
    let coordinate = match format {
        "coordinate" => true,
        "array" => false,
        _ => return Err(unsupported(format)),
    };
    let symmetric = match symmetry {
        "general" => false,
        "symmetric" => true,
        _ => return Err(unsupported(symmetry)),
    };
    Ok(Header { coordinate, symmetric })
}

/// Exactly `needed` fields.
fn fields(line: &str, needed: usize) -> Result<Vec<&str>, MatrixFileError> {
    let fields: Vec<&str> = line.split_ascii_whitespace().collect();
    let found = fields.len();
    if found == needed { Ok(fields) } else { Err(MatrixFileError::Fields { found, needed }) }
}

fn not_a_number(field: &str) -> MatrixFileError {
    MatrixFileError::NotANumber { text: excerpt(field) }
}

fn whole_number(field: &str) -> Result<usize, MatrixFileError> {
    field.parse().map_err(|_| not_a_number(field))
}

fn number(field: &str) -> Result<f64, MatrixFileError> {
    finite(field).ok_or_else(|| not_a_number(field))
}

/// An index from 1, as one from 0.
fn index(field: &str, order: usize) -> Result<usize, MatrixFileError> {
    let index = whole_number(field)?;
    if (1..=order).contains(&index) {
        Ok(index - 1)
    } else {
        Err(MatrixFileError::Index { index, order })
    }
}

/// Lines of row, column and value.
fn coordinates(
    lines: &mut Lines,
    header: &Header,
    needed: usize,
    matrix: &mut Triplets,
) -> Reason<()> {
    let order = matrix.order();
    let entry = |line: &str| -> Result<(usize, usize, f64), MatrixFileError> {
        let fields = fields(line, 3)?;
        Ok((index(fields[0], order)?, index(fields[1], order)?, number(fields[2])?))
    };
    for found in 0..needed {
        if !lines.advance_to_data()? {
            return Err(lines.refuse(MatrixFileError::Entries { found, needed }));
        }
        let (row, column, value) = entry(&lines.text).map_err(|reason| lines.refuse(reason))?;
        if header.symmetric && row < column {
            return Err(
                lines.refuse(MatrixFileError::AboveDiagonal { row: row + 1, column: column + 1 })
            );
        }
        matrix.add(row, column, value);
        if header.symmetric && row != column {
            matrix.add(column, row, value);
        }
    }
    end(lines, needed)
}

/// Values column by column, from the diagonal down if symmetric; zeros are left out.
fn array(lines: &mut Lines, header: &Header, matrix: &mut Triplets) -> Reason<()> {
    let order = matrix.order();
    let needed = if header.symmetric { order * (order + 1) / 2 } else { order * order };
    let mut found = 0;
    for column in 0..order {
        for row in if header.symmetric { column } else { 0 }..order {
            if !lines.advance_to_data()? {
                return Err(lines.refuse(MatrixFileError::Entries { found, needed }));
            }
            let value = fields(&lines.text, 1)
                .and_then(|fields| number(fields[0]))
                .map_err(|reason| lines.refuse(reason))?;
            found += 1;
            if value == 0.0 {
                continue;
            }
            matrix.add(row, column, value);
            if header.symmetric && row != column {
                matrix.add(column, row, value);
            }
        }
    }
    end(lines, needed)
}

/// Refuses more entries than the size line announced.
fn end(lines: &mut Lines, needed: usize) -> Reason<()> {
    if lines.advance_to_data()? {
        return Err(lines.refuse(MatrixFileError::Entries { found: needed + 1, needed }));
    }
    Ok(())
}
