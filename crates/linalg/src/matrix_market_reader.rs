//! Reader of Matrix Market files.

use std::io::Read;

use crate::Triplets;
use crate::matrix::check_order;
use basemat_base::error::{FileFault, memory};
use basemat_base::text::bounded_line::{self, LineResult};
use basemat_base::text::decimal::{excerpt, finite, quoted};

/// Name of the order of the matrix in errors.
const ORDER_QUANTITY: &str = "rows of the matrix";

/// Result of reading a line, or its fault.
type FieldResult<T> = std::result::Result<T, FileFault>;

/// The first line.
struct MatrixMarketHeader {
    /// Whether lines have row, column and value; otherwise they have values only.
    is_coordinate: bool,
    is_symmetric: bool,
}

/// The lines of the file.
type Lines<'a> = bounded_line::Lines<&'a mut dyn Read>;

/// The next line that is neither empty nor a comment; `None` at the end of the file.
fn data_line(lines: &mut Lines) -> LineResult<Option<String>> {
    while let Some(line) = lines.next()? {
        if !line.is_empty() && !line.starts_with('%') {
            return Ok(Some(line));
        }
    }
    Ok(None)
}

/// The next line with data; the error `missing` at the end of the file.
fn required_data_line(lines: &mut Lines, missing: FileFault) -> LineResult<String> {
    data_line(lines)?.ok_or_else(|| lines.fault(missing))
}

/// Reads a square matrix.
pub(super) fn read(source: &mut dyn Read) -> LineResult<Triplets> {
    let mut lines = Lines::new(source);
    let Some(first) = lines.next()? else {
        return Err((0, FileFault::missing("header")));
    };
    let header = lines.with_line_number(header(&first))?;
    let size_fields = if header.is_coordinate { 3 } else { 2 };
    let line = required_data_line(&mut lines, wrong_fields(0, size_fields))?;
    let size = lines.with_line_number(whole_numbers(&line, size_fields))?;
    let rows = size[0];
    let columns = size[1];
    if rows != columns {
        let found = format!("{rows} x {columns}");
        return Err(lines.fault(FileFault::value("size of the matrix", found, "square")));
    }
    lines.with_line_number(check_size(&header, rows))?;
    let mut matrix = Triplets::new(rows);
    if header.is_coordinate {
        read_coordinates(&mut lines, &header, size[2], &mut matrix)?;
    } else {
        read_array(&mut lines, &header, &mut matrix)?;
    }
    Ok(matrix)
}

/// Error unless the matrix fits into memory.
fn check_size(header: &MatrixMarketHeader, rows: usize) -> FieldResult<()> {
    check_order(ORDER_QUANTITY, rows)?;
    // An array file has one line for each entry.
    let entries = if header.is_coordinate { 0.0 } else { (rows as f64).powi(2) };
    let bytes = entries * size_of::<(usize, usize, f64)>() as f64;
    memory::check(ORDER_QUANTITY, rows as f64, bytes)?;
    Ok(())
}

fn header(line: &str) -> FieldResult<MatrixMarketHeader> {
    let words: Vec<String> = line.split_whitespace().map(str::to_ascii_lowercase).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let &["%%matrixmarket", object, format, field, symmetry] = words.as_slice() else {
        let found: String = line.chars().take(80).collect();
        let needed = "'%%MatrixMarket matrix <format> <field> <symmetry>'";
        return Err(FileFault::format(found, needed));
    };
    if object != "matrix" {
        return Err(unsupported(object));
    }
    if !["real", "double", "integer"].contains(&field) {
        return Err(unsupported(field));
    }
    let is_coordinate = match format {
        "coordinate" => true,
        "array" => false,
        _ => return Err(unsupported(format)),
    };
    let is_symmetric = match symmetry {
        "general" => false,
        "symmetric" => true,
        _ => return Err(unsupported(symmetry)),
    };
    Ok(MatrixMarketHeader { is_coordinate, is_symmetric })
}

/// Fault of a word in the header.
fn unsupported(word: &str) -> FileFault {
    let needed = "a real matrix, coordinate or array, general or symmetric";
    FileFault::format(excerpt(word), needed)
}

/// Splits a line into exactly `needed` fields.
fn fields(line: &str, needed: usize) -> FieldResult<Vec<&str>> {
    let fields: Vec<&str> = line.split_ascii_whitespace().collect();
    let found = fields.len();
    if found == needed { Ok(fields) } else { Err(wrong_fields(found, needed)) }
}

fn wrong_fields(found: usize, needed: usize) -> FileFault {
    FileFault::count("fields", found, needed.to_string())
}

fn wrong_entries(found: usize, needed: usize) -> FileFault {
    FileFault::count("entries", found, format!("{needed}, as the size line states"))
}

/// The `needed` whole numbers of a line.
fn whole_numbers(line: &str, needed: usize) -> FieldResult<Vec<usize>> {
    fields(line, needed)?.into_iter().map(whole_number).collect()
}

fn whole_number(field: &str) -> FieldResult<usize> {
    field.parse().map_err(|_| FileFault::value("field", quoted(field), "a whole number"))
}

fn number(field: &str) -> FieldResult<f64> {
    finite(field).ok_or_else(|| FileFault::value("field", quoted(field), "a finite number"))
}

/// Converts an index that starts from 1 to one that starts from 0.
fn index(field: &str, order: usize) -> FieldResult<usize> {
    let index = whole_number(field)?;
    if (1..=order).contains(&index) {
        Ok(index - 1)
    } else {
        Err(FileFault::value("index", index.to_string(), format!("from 1 to {order}")))
    }
}

/// Reads lines of row, column and value.
fn read_coordinates(
    lines: &mut Lines,
    header: &MatrixMarketHeader,
    needed: usize,
    matrix: &mut Triplets,
) -> LineResult<()> {
    for found in 0..needed {
        let line = required_data_line(lines, wrong_entries(found, needed))?;
        let (row, column, value) =
            lines.with_line_number(coordinate_entry(&line, matrix.order()))?;
        if header.is_symmetric && row < column {
            let found = format!("({}, {})", row + 1, column + 1);
            let needed = "on or below the diagonal of a symmetric matrix";
            return Err(lines.fault(FileFault::value("entry", found, needed)));
        }
        add_entry(matrix, header, row, column, value);
    }
    check_end(lines, needed)
}

/// Row and column, from 0, and value of an entry.
fn coordinate_entry(line: &str, order: usize) -> FieldResult<(usize, usize, f64)> {
    let fields = fields(line, 3)?;
    Ok((index(fields[0], order)?, index(fields[1], order)?, number(fields[2])?))
}

/// Reads values column by column, from the diagonal down if symmetric; zeros are left out.
fn read_array(
    lines: &mut Lines,
    header: &MatrixMarketHeader,
    matrix: &mut Triplets,
) -> LineResult<()> {
    let order = matrix.order();
    let needed = if header.is_symmetric { order * (order + 1) / 2 } else { order * order };
    let mut found = 0;
    for column in 0..order {
        for row in if header.is_symmetric { column } else { 0 }..order {
            let line = required_data_line(lines, wrong_entries(found, needed))?;
            let field = lines.with_line_number(fields(&line, 1))?[0];
            let value = lines.with_line_number(number(field))?;
            found += 1;
            if value != 0.0 {
                add_entry(matrix, header, row, column, value);
            }
        }
    }
    check_end(lines, needed)
}

/// Adds an entry, and its mirror image in a symmetric matrix.
fn add_entry(
    matrix: &mut Triplets,
    header: &MatrixMarketHeader,
    row: usize,
    column: usize,
    value: f64,
) {
    matrix.add(row, column, value);
    if header.is_symmetric && row != column {
        matrix.add(column, row, value);
    }
}

/// Error for more entries than the size line states.
fn check_end(lines: &mut Lines, needed: usize) -> LineResult<()> {
    match data_line(lines)? {
        Some(_) => Err(lines.fault(wrong_entries(needed + 1, needed))),
        None => Ok(()),
    }
}
