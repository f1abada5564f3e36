//! Text: words of choices, numbers, tables and columns, lines of files, forms in serde's formats.

#[macro_use]
pub(crate) mod words;
#[macro_use]
pub(crate) mod forms;
#[macro_use]
mod trait_macros;
pub(crate) mod bounded_line;
pub(crate) mod check_sum;
pub(crate) mod column;
pub(crate) mod csv;
pub(crate) mod decimal;
pub(crate) mod file;
pub(crate) mod line_breaks;
pub(crate) mod readable_number;
pub(crate) mod table;
