//! Reads and writes Matrix Market files.
//!
//! The format of Boisvert, Pozo & Remington (NIST IR 5935, 1996), as far as structural matrices need it:
//! coordinate or array, real or integer, general or symmetric.

use std::fs::File;
use std::io::{Read, Write};
use std::path::Path;

use crate::error::{FileFault, Result, memory};
use crate::linalg::SparseMatrix;
use crate::linalg::matrix::check_order;
use crate::structure::Triplets;
use crate::text::bounded_line;
use crate::text::column::{excerpt, finite, quoted};
use crate::text::file::{replaced, unwritten};

impl Triplets {
    /// Reads a square matrix from a Matrix Market file (`.mtx`).
    ///
    /// Supported: `coordinate` and `array`; `real`, `double` and `integer`; `general` and `symmetric`.
    /// Entries at the same place are summed.
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) with the line and the reason.
    pub fn read_matrix_market(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let name = path.display().to_string();
        match File::open(path) {
            Ok(file) => Self::from_matrix_market(&name, file),
            Err(error) => Err(FileFault::Unreadable(error.kind()).of(name, 0)),
        }
    }

    /// Reads the same from any source of bytes; errors use `name` for the source.
    ///
    /// ```
    /// use basemat::structure::Triplets;
    /// let text = "%%MatrixMarket matrix coordinate real symmetric\n\
    ///             % a spring\n\
    ///             2 2 3\n1 1 5.0\n2 1 -5.0\n2 2 5.0\n";
    /// let spring = Triplets::from_matrix_market("spring", text.as_bytes())?;
    /// assert_eq!(spring.entries(), [(0, 0, 5.0), (1, 0, -5.0), (0, 1, -5.0), (1, 1, 5.0)]);
    ///
    /// let wrong = text.replace("2 1 -5.0", "3 1 -5.0");
    /// let error = Triplets::from_matrix_market("spring", wrong.as_bytes()).unwrap_err();
    /// assert_eq!(error.to_string(), "spring, line 5: index is 3, but must be from 1 to 2");
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) with the line and the reason.
    pub fn from_matrix_market(name: &str, mut source: impl Read) -> Result<Self> {
        read(&mut source).map_err(|(line, fault)| fault.of(name, line))
    }

    /// Writes the matrix to a Matrix Market file, in the coordinate format.
    ///
    /// The file is written whole, or not changed. Entries at the same place are summed, and zeros left out. A
    /// matrix that is symmetric to the last bit is written as symmetric. Reading the file returns the same
    /// numbers.
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) or [`Error::Input`](crate::Error::Input) for an entry out of range or not finite, [`Error::Memory`](crate::Error::Memory) for
    /// more rows than fit into memory, [`Error::File`](crate::Error::File) when the file cannot be written.
    pub fn write_matrix_market(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        let mut text = Vec::new();
        write(&self.checked()?, &mut text)
            .and_then(|()| replaced(path, &text))
            .map_err(unwritten(path))
    }

    /// Writes the same to any sink of bytes; errors use `name` for the sink.
    ///
    /// # Errors
    /// As for [`Triplets::write_matrix_market`].
    pub fn to_matrix_market(&self, name: &str, mut sink: impl Write) -> Result<()> {
        write(&self.checked()?, &mut sink)
            .map_err(|error| FileFault::Unwritable(error.kind()).of(name, 0))
    }

    fn checked(&self) -> Result<SparseMatrix> {
        SparseMatrix::new("matrix to be written", self)
    }
}

/// Coordinate format; `{:e}` prints the shortest digits that read back as the same number.
fn write(matrix: &SparseMatrix, sink: &mut dyn Write) -> std::io::Result<()> {
    let symmetric = matrix.asymmetry() == 0.0;
    let wanted =
        |&(row, column, value): &(usize, usize, f64)| value != 0.0 && (!symmetric || row >= column);
    let order = matrix.order();
    let count = matrix.entries().filter(wanted).count();
    let symmetry = if symmetric { "symmetric" } else { "general" };
    writeln!(sink, "%%MatrixMarket matrix coordinate real {symmetry}")?;
    writeln!(sink, "{order} {order} {count}")?;
    for (row, column, value) in matrix.entries().filter(wanted) {
        writeln!(sink, "{} {} {value:e}", row + 1, column + 1)?;
    }
    sink.flush()
}

// Reader of Matrix Market files.

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

fn read(source: &mut dyn Read) -> Reason<Triplets> {
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
