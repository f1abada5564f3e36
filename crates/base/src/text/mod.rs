//! Text in messages and files: words, numbers, tables, lines and stored forms.

#[macro_use]
pub mod words;
#[macro_use]
pub mod forms;
#[macro_use]
mod trait_macros;
pub mod bounded_line;
pub mod check_sum;
pub mod column;
pub mod csv;
pub mod decimal;
pub mod file;
pub mod line_breaks;
pub mod readable_number;
pub mod table;
