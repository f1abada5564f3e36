//! Ground-motion records: integration, peaks, baselines, free fields.

mod baselines;
mod filters;
mod free_fields;
mod fuzz;
mod inclined_waves;
mod motion_formats;
mod motion_reader;
mod records;
mod response_spectrum;
#[path = "../support/mod.rs"]
mod support;
