//! Reader of Matrix Market files.

use std::io::Read;

use crate::Triplets;
use crate::matrix::check_order;
use basemat_base::error::{FileFault, memory};
use basemat_base::text::bounded_line::{self, LineResult};
use basemat_base::text::decimal::{excerpt, finite, quoted};

/// Largest number of characters of the first line in an error.
const MAX_QUOTED_CHARACTERS: usize = 80;

/// Name of the order of the matrix in errors.
const ORDER_QUANTITY: &str = "rows of the matrix";

/// Result of parsing text; the error is its fault, still without a line number.
type ParseResult<T> = std::result::Result<T, FileFault>;

/// Properties that the first line of the file states.
struct MatrixMarketHeader {
    /// Whether lines have row, column and value; otherwise they have values only.
    is_coordinate: bool,
    /// Whether the file has only the lower triangle of a symmetric matrix.
    is_symmetric: bool,
}

/// Entry of the matrix; row and column count from 0.
#[derive(Clone, Copy)]
struct MatrixEntry {
    row: usize,
    column: usize,
    value: f64,
}

/// Lines of the file.
type Lines<'a> = bounded_line::Lines<&'a mut dyn Read>;

/// The next line that is neither empty nor a comment.
///
/// `None` at the end of the file.
fn data_line(lines: &mut Lines) -> LineResult<Option<String>> {
    while let Some(line) = lines.next()? {
        if !line.is_empty() && !line.starts_with('%') {
            return Ok(Some(line));
        }
    }
    Ok(None)
}

/// The next line with data; `end_fault` at the end of the file.
fn required_data_line(lines: &mut Lines, end_fault: FileFault) -> LineResult<String> {
    data_line(lines)?.ok_or_else(|| lines.fault(end_fault))
}

/// Reads a square matrix.
pub(super) fn read(source: &mut dyn Read) -> LineResult<Triplets> {
    let mut lines = Lines::new(source);
    let Some(first_line) = lines.next()? else {
        return Err((0, FileFault::missing("header")));
    };
    let header = lines.with_line_number(parse_header(&first_line))?;
    let size_field_count = if header.is_coordinate { 3 } else { 2 };
    let size_line = required_data_line(&mut lines, wrong_field_count(0, size_field_count))?;
    let sizes = lines.with_line_number(whole_numbers(&size_line, size_field_count))?;
    let row_count = sizes[0];
    let column_count = sizes[1];
    if row_count != column_count {
        let found_shape = format!("{row_count} x {column_count}");
        return Err(lines.fault(FileFault::value("size of the matrix", found_shape, "square")));
    }
    lines.with_line_number(check_memory(&header, row_count))?;
    let mut matrix = Triplets::new(row_count);
    if header.is_coordinate {
        read_coordinates(&mut lines, &header, sizes[2], &mut matrix)?;
    } else {
        read_array(&mut lines, &header, &mut matrix)?;
    }
    Ok(matrix)
}

/// Returns an error unless the matrix fits into memory.
fn check_memory(header: &MatrixMarketHeader, row_count: usize) -> ParseResult<()> {
    check_order(ORDER_QUANTITY, row_count)?;
    // The number of entries of a coordinate file is limited by the file itself.
    let entry_count = if header.is_coordinate { 0.0 } else { (row_count as f64).powi(2) };
    let bytes = entry_count * size_of::<(usize, usize, f64)>() as f64;
    memory::check(ORDER_QUANTITY, row_count as f64, bytes)?;
    Ok(())
}

/// Reads the first line.
fn parse_header(line: &str) -> ParseResult<MatrixMarketHeader> {
    let words: Vec<String> = line.split_whitespace().map(str::to_ascii_lowercase).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let &["%%matrixmarket", object, format, field, symmetry] = words.as_slice() else {
        let line_start: String = line.chars().take(MAX_QUOTED_CHARACTERS).collect();
        let needed = "'%%MatrixMarket matrix <format> <field> <symmetry>'";
        return Err(FileFault::format(line_start, needed));
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

/// Fault of a word in the header that is not supported.
fn unsupported(word: &str) -> FileFault {
    let needed = "a real matrix, coordinate or array, general or symmetric";
    FileFault::format(excerpt(word), needed)
}

/// Splits a line into exactly `needed_count` fields.
fn split_fields(line: &str, needed_count: usize) -> ParseResult<Vec<&str>> {
    let fields: Vec<&str> = line.split_ascii_whitespace().collect();
    if fields.len() == needed_count {
        Ok(fields)
    } else {
        Err(wrong_field_count(fields.len(), needed_count))
    }
}

/// Fault of a line with another number of fields than needed.
fn wrong_field_count(found_count: usize, needed_count: usize) -> FileFault {
    FileFault::count("fields", found_count, needed_count.to_string())
}

/// Fault of a file with another number of entries than its size line states.
fn wrong_entry_count(found_count: usize, stated_count: usize) -> FileFault {
    let needed = format!("{stated_count}, as the size line states");
    FileFault::count("entries", found_count, needed)
}

/// The `needed_count` whole numbers of a line.
fn whole_numbers(line: &str, needed_count: usize) -> ParseResult<Vec<usize>> {
    split_fields(line, needed_count)?.into_iter().map(whole_number).collect()
}

/// The whole number of a field.
fn whole_number(field: &str) -> ParseResult<usize> {
    field.parse().map_err(|_| FileFault::value("field", quoted(field), "a whole number"))
}

/// The finite number of a field.
fn finite_number(field: &str) -> ParseResult<f64> {
    finite(field).ok_or_else(|| FileFault::value("field", quoted(field), "a finite number"))
}

/// The index of a field, which counts from 1, as an index from 0.
fn index(field: &str, order: usize) -> ParseResult<usize> {
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
    entry_count: usize,
    matrix: &mut Triplets,
) -> LineResult<()> {
    for read_count in 0..entry_count {
        let line = required_data_line(lines, wrong_entry_count(read_count, entry_count))?;
        let entry = lines.with_line_number(coordinate_entry(&line, matrix.order()))?;
        if header.is_symmetric && entry.row < entry.column {
            let place_text = format!("({}, {})", entry.row + 1, entry.column + 1);
            let needed = "on or below the diagonal of a symmetric matrix";
            return Err(lines.fault(FileFault::value("entry", place_text, needed)));
        }
        add_entry(matrix, header, entry);
    }
    check_end(lines, entry_count)
}

/// Parses a line of row, column and value.
fn coordinate_entry(line: &str, order: usize) -> ParseResult<MatrixEntry> {
    let fields = split_fields(line, 3)?;
    Ok(MatrixEntry {
        row: index(fields[0], order)?,
        column: index(fields[1], order)?,
        value: finite_number(fields[2])?,
    })
}

/// Reads values column by column, from the diagonal down if symmetric; zeros are omitted.
fn read_array(
    lines: &mut Lines,
    header: &MatrixMarketHeader,
    matrix: &mut Triplets,
) -> LineResult<()> {
    let order = matrix.order();
    let entry_count = if header.is_symmetric { order * (order + 1) / 2 } else { order * order };
    let mut read_count = 0;
    for column in 0..order {
        let first_row = if header.is_symmetric { column } else { 0 };
        for row in first_row..order {
            let line = required_data_line(lines, wrong_entry_count(read_count, entry_count))?;
            let field = lines.with_line_number(split_fields(&line, 1))?[0];
            let value = lines.with_line_number(finite_number(field))?;
            read_count += 1;
            if value != 0.0 {
                add_entry(matrix, header, MatrixEntry { row, column, value });
            }
        }
    }
    check_end(lines, entry_count)
}

/// Adds an entry, and its mirrored entry in a symmetric matrix.
fn add_entry(matrix: &mut Triplets, header: &MatrixMarketHeader, entry: MatrixEntry) {
    let MatrixEntry { row, column, value } = entry;
    matrix.add(row, column, value);
    if header.is_symmetric && row != column {
        matrix.add(column, row, value);
    }
}

/// Returns an error for more entries than the size line states.
fn check_end(lines: &mut Lines, entry_count: usize) -> LineResult<()> {
    match data_line(lines)? {
        Some(_) => Err(lines.fault(wrong_entry_count(entry_count + 1, entry_count))),
        None => Ok(()),
    }
}
