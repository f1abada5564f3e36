//! Reader of Matrix Market files.

use std::io::Read;

use crate::error::{FileFault, memory};
use crate::linalg::matrix::check_order;
use crate::structure::Triplets;
use crate::text::bounded_line;
use crate::text::decimal::{excerpt, finite, quoted};

const ROWS: &str = "rows of the matrix";

/// Contents of a line, or its fault.
type Fallible<T> = std::result::Result<T, FileFault>;

/// Contents of lines; the error holds the number of the line and its fault.
type Reason<T> = std::result::Result<T, (usize, FileFault)>;

/// The first line.
struct Header {
    coordinate: bool,
    symmetric: bool,
}

/// The lines of the file.
type Lines<'a> = bounded_line::Lines<&'a mut dyn Read>;

/// The next line that is neither empty nor a comment; `None` at the end of the file.
fn data(lines: &mut Lines) -> Reason<Option<String>> {
    while let Some(line) = lines.next()? {
        if !line.is_empty() && !line.starts_with('%') {
            return Ok(Some(line));
        }
    }
    Ok(None)
}

/// The next line with data; the error `missing` at the end of the file.
fn needed_data(lines: &mut Lines, missing: FileFault) -> Reason<String> {
    data(lines)?.ok_or_else(|| lines.refuse(missing))
}

pub(super) fn read(source: &mut dyn Read) -> Reason<Triplets> {
    let mut lines = Lines::new(source);
    let Some(first) = lines.next()? else { return Err((0, FileFault::missing("header"))) };
    let header = header(&first).map_err(|reason| lines.refuse(reason))?;
    let needed = if header.coordinate { 3 } else { 2 };
    let line = needed_data(&mut lines, wrong_fields(0, needed))?;
    let size = fields(&line, needed)
        .and_then(|fields| fields.into_iter().map(whole_number).collect::<Fallible<Vec<_>>>())
        .map_err(|reason| lines.refuse(reason))?;
    let (rows, columns) = (size[0], size[1]);
    if rows != columns {
        return Err(lines.refuse(FileFault::value(
            "size of the matrix",
            format!("{rows} x {columns}"),
            "square",
        )));
    }
    let fits = || {
        check_order(ROWS, rows)?;
        // An array file has one line for each entry.
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

fn header(line: &str) -> Fallible<Header> {
    let words: Vec<String> = line.split_whitespace().map(str::to_ascii_lowercase).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let &["%%matrixmarket", object, format, field, symmetry] = words.as_slice() else {
        let found: String = line.chars().take(80).collect();
        let needed = "'%%MatrixMarket matrix <format> <field> <symmetry>'";
        return Err(FileFault::format(found, needed));
    };
    let unsupported = |word: &str| {
        let needed = "a real matrix, coordinate or array, general or symmetric";
        FileFault::format(excerpt(word), needed)
    };
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

/// Splits a line into exactly `needed` fields.
fn fields(line: &str, needed: usize) -> Fallible<Vec<&str>> {
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

fn whole_number(field: &str) -> Fallible<usize> {
    field.parse().map_err(|_| FileFault::value("field", quoted(field), "a whole number"))
}

fn number(field: &str) -> Fallible<f64> {
    finite(field).ok_or_else(|| FileFault::value("field", quoted(field), "a finite number"))
}

/// Converts an index that starts from 1 to one that starts from 0.
fn index(field: &str, order: usize) -> Fallible<usize> {
    let index = whole_number(field)?;
    if (1..=order).contains(&index) {
        Ok(index - 1)
    } else {
        Err(FileFault::value("index", index.to_string(), format!("from 1 to {order}")))
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
    let entry = |line: &str| -> Fallible<(usize, usize, f64)> {
        let fields = fields(line, 3)?;
        Ok((index(fields[0], order)?, index(fields[1], order)?, number(fields[2])?))
    };
    for found in 0..needed {
        let line = needed_data(lines, wrong_entries(found, needed))?;
        let (row, column, value) = entry(&line).map_err(|reason| lines.refuse(reason))?;
        if header.symmetric && row < column {
            let found = format!("({}, {})", row + 1, column + 1);
            let needed = "on or below the diagonal of a symmetric matrix";
            return Err(lines.refuse(FileFault::value("entry", found, needed)));
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
            let line = needed_data(lines, wrong_entries(found, needed))?;
            let value = fields(&line, 1)
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

/// Error for more entries than the size line announced.
fn end(lines: &mut Lines, needed: usize) -> Reason<()> {
    match data(lines)? {
        Some(_) => Err(lines.refuse(wrong_entries(needed + 1, needed))),
        None => Ok(()),
    }
}
