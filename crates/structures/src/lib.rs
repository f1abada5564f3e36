//! Finite elements, and models of structures: their matrices, damping, reduction and hysteretic springs.
//!
//! `basemat` re-exports both modules under the same paths, which the examples have.
#![forbid(unsafe_code)]

#[macro_use]
extern crate basemat_base;

#[macro_use]
pub mod structure;

pub mod fem;

pub use basemat_base::{Error, Result};
use basemat_base::{error, geometry, text};
use basemat_linalg as linalg;
