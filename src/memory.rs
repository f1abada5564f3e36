//! Memory that sizes given as numbers may take: one limit, and one refusal before it is allocated.

use std::sync::atomic::{AtomicU64, Ordering};

use crate::error::MemoryError;

static LIMIT: AtomicU64 = AtomicU64::new(4 << 30);

/// Most memory (bytes) that the size of one mesh, matrix, ground, record or sweep may ask for;
/// 4 GiB unless [`set_memory_limit`] was called.
pub fn memory_limit() -> u64 {
    LIMIT.load(Ordering::Relaxed)
}

/// Sets the limit (bytes) for the whole process: to what the machine has, less what else runs on
/// it.
///
/// Sizes given as numbers (columns of a block, elements of a strip, unknowns of a matrix, steps of
/// a record) are held against it before anything is allocated, and refused with a [`MemoryError`]
/// that says what they would take. It is an estimate for each part by itself, no account of all
/// that a program holds.
///
/// ```
/// use basemat::bem::Strip;
/// use basemat::{Error, MemoryError};
///
/// let error = Strip::graded(-5.0..5.0, 10_000).unwrap_err();
/// assert!(matches!(error, Error::Memory(MemoryError { asked: 10_000.0, .. })));
/// basemat::set_memory_limit(64 << 30);
/// assert_eq!(Strip::graded(-5.0..5.0, 10_000)?.elements().len(), 10_000);
/// # Ok::<(), Error>(())
/// ```
pub fn set_memory_limit(bytes: u64) {
    LIMIT.store(bytes, Ordering::Relaxed);
}

/// Refuses `asked` of `quantity` if the `needed` bytes are more than the limit, or NaN.
pub(crate) fn check(quantity: &'static str, asked: f64, needed: f64) -> Result<(), MemoryError> {
    let limit = memory_limit() as f64;
    let remedy = "`set_memory_limit` allows more";
    if needed <= limit {
        Ok(())
    } else {
        Err(MemoryError { quantity, asked, needed, limit, remedy })
    }
}
