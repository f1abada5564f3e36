//! The limit of memory for sizes given as numbers.

use pyo3::prelude::*;

/// Most memory (bytes) that the size of one mesh, matrix, ground, record or sweep may ask for;
/// 4 GiB unless :func:`set_memory_limit` was called.
#[pyfunction]
pub(crate) fn memory_limit() -> u64 {
    basemat::memory_limit()
}

/// Sets the limit for this process to so many ``bytes``: what the machine has, less what else runs on it.
/// Sizes are held against it before anything is allocated, and refused with what they would take.
#[pyfunction]
pub(crate) fn set_memory_limit(#[pyo3(from_py_with = crate::array::whole)] bytes: u64) {
    basemat::set_memory_limit(bytes);
}
