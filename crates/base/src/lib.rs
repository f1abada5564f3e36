//! Errors, texts and contact geometry that the parts of `basemat` share.
//!
//! Its public items are re-exported by `basemat`; the others serve `basemat` and its parts and may change with any
//! version.
#![forbid(unsafe_code)]
#![allow(
    missing_docs,
    missing_debug_implementations,
    clippy::len_without_is_empty,
    clippy::missing_errors_doc,
    clippy::missing_panics_doc,
    clippy::return_self_not_must_use,
    clippy::should_implement_trait,
    reason = "helpers of basemat, which documents its public items"
)]

#[macro_use]
pub mod text;

pub mod error;
pub mod geometry;

pub use error::{Error, Result};
