//! Validation against closed forms and published tables.

mod advice;
mod analytic;
mod linear;
mod reference;
mod reference_tables;
#[path = "../support/mod.rs"]
mod support;
