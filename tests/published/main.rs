//! Validation against closed forms and published tables.

mod advice;
mod analytic;
mod layered;
mod linear;
mod reference;
mod reference_tables;
