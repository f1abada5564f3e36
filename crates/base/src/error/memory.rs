//! Memory limit for sizes that the caller states as numbers, checked before allocation.

/// A size that needs more memory than is allowed; nothing was allocated.
///
/// The limit is [`memory_limit`]; a convolution history has the limit `HistoryOptions::memory`.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "{quantity}: {asked} would take about {} of memory, but at most {} are allowed \
     ({remedy})",
    bytes_text(*.needed), bytes_text(*.limit)
)]
pub struct MemoryError {
    /// Name of the quantity.
    pub quantity: &'static str,
    /// Requested number.
    pub asked: f64,
    /// Estimated memory for this number, bytes.
    pub needed: f64,
    /// The limit, bytes.
    pub limit: f64,
    /// Ways to need less memory.
    pub remedy: &'static str,
}

/// Number of bytes from which the text has an exponent.
const EXPONENT_BYTES: f64 = 1e15;

/// A number of bytes with its unit.
fn bytes_text(bytes: f64) -> String {
    if bytes < 1e6 {
        format!("{:.1} kB", bytes / 1e3)
    } else if bytes < 1e9 {
        format!("{:.1} MB", bytes / 1e6)
    } else if bytes < EXPONENT_BYTES {
        format!("{:.1} GB", bytes / 1e9)
    } else {
        format!("{:.0e} GB", bytes / 1e9)
    }
}

/// Largest memory of one part, bytes.
///
/// Usual models need less, a model with a mistyped number needs more.
const MEMORY_LIMIT: u64 = 8 << 30;

/// Memory limit of one mesh, matrix, ground, record or sweep: 8 GiB, in bytes.
///
/// Sizes stated as numbers (columns of a block, elements of a strip, degrees of freedom of a matrix, steps of a
/// record, convolution weights of layered ground) are compared with this limit before allocation; a
/// [`MemoryError`] states the memory that they would need. The estimate is for each part alone, not for the whole
/// program.
///
/// ```
/// use basemat::bem::Strip;
/// use basemat::{Error, MemoryError};
///
/// let error = Strip::graded(-5.0..5.0, 10_000).unwrap_err();
/// assert!(matches!(error, Error::Memory(MemoryError { asked: 10_000.0, .. })));
/// ```
pub fn memory_limit() -> u64 {
    MEMORY_LIMIT
}

/// Does nothing: the limit of one part is fixed, see [`memory_limit`].
#[deprecated(
    since = "0.5.0",
    note = "the limit of one part is fixed; a history has `HistoryOptions::memory`"
)]
pub fn set_memory_limit(_bytes: u64) {}

/// Returns an error if the `needed` bytes exceed the limit, or are NaN.
///
/// `asked`: number of `quantity` for which they are needed.
pub fn check(
    quantity: &'static str,
    asked: f64,
    needed: f64,
) -> std::result::Result<(), MemoryError> {
    let limit = memory_limit() as f64;
    let remedy = "for one part of a model";
    if needed <= limit {
        Ok(())
    } else {
        Err(MemoryError { quantity, asked, needed, limit, remedy })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(needed: f64) -> String {
        let limit = 2.0_f64.powi(32);
        MemoryError { quantity: "rows", asked: 1e5, needed, limit, remedy: "less" }.to_string()
    }

    #[test]
    fn bytes_are_printed_with_their_units() {
        assert_eq!(
            message(4.84e9),
            "rows: 100000 would take about 4.8 GB of memory, but at most 4.3 GB are allowed \
             (less)"
        );
        assert!(
            message(2e6).contains("about 2.0 MB of") && message(2e30).contains("about 2e21 GB of")
        );
        assert!(message(2e4).contains("about 20.0 kB of"));
        assert!(message(f64::INFINITY).contains("about inf GB of"));
    }
}
