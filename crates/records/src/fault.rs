//! Faults that several formats of records have.

use crate::error::FileFault;
use crate::text::decimal::{excerpt, quoted};

/// Largest number of characters that a message quotes from a file.
const MAX_QUOTED_CHARACTERS: usize = 60;

/// Result of reading, or the fault without the number of a line.
pub(super) type FaultResult<T> = Result<T, FileFault>;

/// A field that is not a finite number.
pub(super) fn not_a_number(field: &str) -> FileFault {
    FileFault::value("field", quoted(field), "a finite number")
}

/// A line before all numbers that contains neither numbers nor the column titles.
pub(super) fn unexpected_header_line(field: &str) -> FileFault {
    let needed =
        "a finite number: with more than one line of header, give their number (`header_lines`)";
    FileFault::value("field", quoted(field), needed)
}

/// A quantity that the header does not have, or has without a possible value.
pub(super) fn not_in_header(quantity: &str) -> FileFault {
    FileFault::missing(format!("{quantity} in the header, or none that makes sense"))
}

/// A quantity of the header without a known number or unit.
pub(super) fn unclear(quantity: &str, text: &str) -> FileFault {
    FileFault::value(quantity, quoted(text), "clear: all of it a known number, unit or word")
}

/// A line with more or fewer columns than the lines before; its columns may have shifted.
pub(super) fn unequal_columns(found: usize, before: usize) -> FileFault {
    FileFault::count("columns", found, format!("{before}, as before"))
}

/// Lines of numbers that may be one series along the lines.
///
/// A single column would then be a small part of it.
pub(super) fn may_be_one_series(numbers: usize) -> FileFault {
    let needed = "columns with titles: read values along the lines as such (`AlongLinesFormat`, in Python \
         `along_lines`), or give the number of lines (`samples`) if they are columns";
    FileFault::format(format!("{numbers} numbers a line, which may be one series"), needed)
}

/// Lines of numbers that may be the rows of a table, or have numbers of cards.
pub(super) fn may_be_table(column: usize) -> FileFault {
    let needed = "values of one series: read columns by `ColumnFormat` (in Python `columns`), cards by their Fortran \
         format (`layout`), or give the number of values (`samples`)";
    FileFault::format(format!("column {column}, which counts or has times"), needed)
}

/// A requested column or channel that the file, which has `found` of them, does not have.
pub(super) fn out_of_range(item: &str, found: usize, number: usize) -> FileFault {
    if found == 0 {
        return FileFault::missing(format!("{item} {number}, nor any other"));
    }
    FileFault::value(format!("requested {item}"), number.to_string(), format!("from 1 to {found}"))
}

/// Another quantity than acceleration, or an unknown unit; `text` is quoted from the file.
pub(super) fn not_acceleration(text: &str) -> FileFault {
    FileFault::format(beginning(text), "an acceleration in a known unit")
}

/// Data of a recorder that are not yet an acceleration at equal steps; `text` is quoted from the file.
pub(super) fn unprocessed(text: &str, kind: &str) -> FileFault {
    FileFault::format(
        beginning(text),
        format!("corrected data: {kind}; read the file of corrected data (volume 2)"),
    )
}

/// A line whose numbers cannot be understood beside the numbers of other lines.
///
/// It does not match the columns of the file's Fortran format, which place the decimal points or scale the numbers; or it
/// does, and previous lines did not.
pub(super) fn not_in_format(line: &str) -> FileFault {
    let needed = "numbers in the columns of the file's format, which place the decimal points: all lines must keep to \
         it, or none";
    FileFault::format(excerpt(line), needed)
}

/// A title that names another unit than `unit`, in which the column is read.
pub(super) fn other_unit_in_title(title: &str, unit: &str) -> FileFault {
    let needed = format!("without another unit than {unit}, in which the column is read");
    FileFault::value("title", quoted(title), needed)
}

/// The first characters of a text.
fn beginning(text: &str) -> String {
    text.chars().take(MAX_QUOTED_CHARACTERS).collect()
}

/// A time (s) that differs from equal steps.
pub(super) fn unequal_time_step(found: f64, expected: f64) -> FileFault {
    FileFault::value("time", format!("{found} s"), format!("{expected} s with equal steps"))
}
