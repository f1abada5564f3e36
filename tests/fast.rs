//! Tests of parts: structures, interface laws, records, files, results and invalid input.

mod allocation;
mod contact;
mod errors;
mod io;
mod motion;
mod plugin;
mod results;
mod structures;
