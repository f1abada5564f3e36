//! Ground-motion records: integration, peaks, baselines, free fields.

mod baselines;
mod filters;
mod free_fields;
mod odd_columns;
mod odd_headers;
mod records;
#[path = "../support/mod.rs"]
mod support;
