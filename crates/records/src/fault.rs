//! Faults that several formats of records have.

use crate::error::FileFault;
use crate::text::decimal::{excerpt, quoted};

/// Largest number of characters that a message quotes from a file.
const MAX_QUOTED_CHARACTERS: usize = 60;

/// What was read, or a fault without its line number.
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

/// A quantity of the header whose number or unit is not understood.
pub(super) fn unclear(quantity: &str, text: &str) -> FileFault {
    FileFault::value(quantity, quoted(text), "clear: all of it a known number, unit or word")
}

/// Fault of a file whose number of samples is not the expected one.
pub(super) fn wrong_sample_count(sample_count: usize, expected_count: usize) -> FileFault {
    FileFault::count("samples", sample_count, expected_count.to_string())
}

/// A line with more or fewer columns than the previous lines.
pub(super) fn unequal_columns(column_count: usize, previous_count: usize) -> FileFault {
    FileFault::count("columns", column_count, format!("{previous_count}, as before"))
}

/// Lines of numbers that may be one series along the lines.
///
/// A column is a small part of such a series.
pub(super) fn may_be_one_series(numbers_per_line: usize) -> FileFault {
    let needed = "columns with titles: read values along the lines as such (`AlongLinesFormat`, in Python \
         `along_lines`), or give the number of lines (`samples`) if they are columns";
    FileFault::format(format!("{numbers_per_line} numbers a line, which may be one series"), needed)
}

/// Lines of numbers whose column of counts or times makes them a table or cards.
pub(super) fn may_be_table(column_number: usize) -> FileFault {
    let needed = "values of one series: read columns by `ColumnFormat` (in Python `columns`), cards by their Fortran \
         format (`layout`), or give the number of values (`samples`)";
    FileFault::format(format!("column {column_number}, which counts or has times"), needed)
}

/// A requested column or channel beyond the `count` in the file.
pub(super) fn out_of_range(item: &str, count: usize, number: usize) -> FileFault {
    if count == 0 {
        return FileFault::missing(format!("{item} {number}, nor any other"));
    }
    FileFault::value(format!("requested {item}"), number.to_string(), format!("from 1 to {count}"))
}

/// Another quantity than acceleration, or an unknown unit; `text` is quoted from the file.
pub(super) fn not_acceleration(text: &str) -> FileFault {
    FileFault::format(beginning(text), "an acceleration in a known unit")
}

/// Recorder data that are not yet accelerations at equal steps.
///
/// `text` is quoted from the file.
pub(super) fn unprocessed(text: &str, reason: &str) -> FileFault {
    FileFault::format(
        beginning(text),
        format!("corrected data: {reason}; read the file of corrected data (volume 2)"),
    )
}

/// A line whose numbers follow another layout than the numbers of other lines.
///
/// The columns of the file's Fortran format place the decimal points or scale the numbers. Either this line does not
/// match these columns, or it matches them and previous lines did not.
pub(super) fn not_in_format(line: &str) -> FileFault {
    let needed = "numbers in the columns of the file's format, which place the decimal points: either all lines must \
         match it, or none";
    FileFault::format(excerpt(line), needed)
}

/// A title that names another unit than the `unit` in which its column is read.
pub(super) fn other_unit_in_title(title: &str, unit: &str) -> FileFault {
    let needed = format!("without another unit than {unit}, in which the column is read");
    FileFault::value("title", quoted(title), needed)
}

/// The first characters of a text.
fn beginning(text: &str) -> String {
    text.chars().take(MAX_QUOTED_CHARACTERS).collect()
}

/// A time (s) that differs from equal steps.
pub(super) fn unequal_time_step(time: f64, expected_time: f64) -> FileFault {
    FileFault::value("time", format!("{time} s"), format!("{expected_time} s with equal steps"))
}
