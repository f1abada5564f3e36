//! Faults that several formats of records have.

use crate::error::FileFault;
use crate::text::decimal::{excerpt, quoted};

/// Number of characters of a file's own words in a message.
const WORDS: usize = 60;

/// A field that is not a finite number.
pub(super) fn not_a_number(field: &str) -> FileFault {
    FileFault::value("field", quoted(field), "a finite number")
}

/// A line before all numbers that contains neither numbers nor the column titles.
pub(super) fn header_line(field: &str) -> FileFault {
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

/// A line with another number of columns than the lines before; its columns may have shifted.
pub(super) fn unequal_columns(found: usize, before: usize) -> FileFault {
    FileFault::count("columns", found, format!("{before}, as before"))
}

/// Lines of numbers that may be one series, of which a column would be a small part.
pub(super) fn along_lines(numbers: usize) -> FileFault {
    let needed = "columns with titles: read values along the lines as such (`AlongLinesFormat`, in Python \
         `along_lines`), or give the number of lines (`samples`) if they are columns";
    FileFault::format(format!("{numbers} numbers a line, which may be one series"), needed)
}

/// Lines whose values along them may be the columns of a table, or have numbers of cards.
pub(super) fn columns_of_table(column: usize) -> FileFault {
    let needed = "values of one series: read columns by `ColumnFormat` (in Python `columns`), cards by their Fortran \
         format (`layout`), or give the number of values (`samples`)";
    FileFault::format(format!("column {column}, which counts or has times"), needed)
}

/// A column or channel whose number is not among the `found` ones.
pub(super) fn out_of_range(item: &str, found: usize, number: usize) -> FileFault {
    if found == 0 {
        return FileFault::missing(format!("{item} {number}, nor any other"));
    }
    FileFault::value(format!("requested {item}"), number.to_string(), format!("from 1 to {found}"))
}

/// Another quantity than acceleration, or an unknown unit; `text` is the file's own description.
pub(super) fn no_acceleration(text: &str) -> FileFault {
    FileFault::format(cut(text), "an acceleration in a known unit")
}

/// Unprocessed data, which are no acceleration at equal steps; `text` is the file's own description.
pub(super) fn unprocessed(text: &str, kind: &str) -> FileFault {
    FileFault::format(
        cut(text),
        format!("corrected data: {kind}; read the file of corrected data (volume 2)"),
    )
}

/// A line that does not match the columns of the file's Fortran format, which place the decimal points or scale the
/// numbers; or it does, and previous lines did not.
pub(super) fn off_columns(line: &str) -> FileFault {
    let needed = "numbers in the columns of the file's format, which place the decimal points: all lines must keep to \
         it, or none";
    FileFault::format(excerpt(line), needed)
}

/// A title that names another unit than `unit`, in which the column is read.
pub(super) fn title_unit(title: &str, unit: &str) -> FileFault {
    let needed = format!("without another unit than {unit}, in which the column is read");
    FileFault::value("title", quoted(title), needed)
}

fn cut(text: &str) -> String {
    text.chars().take(WORDS).collect()
}

/// A time (s) that differs from equal steps.
pub(super) fn drifting(found: f64, expected: f64) -> FileFault {
    FileFault::value("time", format!("{found} s"), format!("{expected} s with equal steps"))
}
