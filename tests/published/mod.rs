//! Validation against closed forms and published tables.

mod analytic;
mod layered;
mod linear;
mod overturning;
mod reference;
mod reference_tables;
mod refine;
mod soil_closed_forms;
