//! Memory that sizes given as numbers may take: one limit, and one refusal before it is allocated.

use std::sync::atomic::{AtomicU64, Ordering};

use super::{Error, Result};

/// A size for which more memory would be needed than is allowed: by [`memory_limit`](crate::memory_limit) for what is
/// given, by [`HistoryOptions::memory`](crate::history::HistoryOptions::memory) for a convolution history. Nothing was
/// allocated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "{quantity}: {asked} would take about {} of memory, but at most {} are allowed \
     ({remedy})",
    bytes(*.needed), bytes(*.limit)
)]
pub struct MemoryError {
    /// Name of the quantity.
    pub quantity: &'static str,
    /// Number that was requested.
    pub asked: f64,
    /// Memory that they would take, estimated, bytes.
    pub needed: f64,
    /// The limit, bytes.
    pub limit: f64,
    /// Ways out.
    pub remedy: &'static str,
}

fn bytes(number: f64) -> String {
    match number {
        few if few < 1e9 => format!("{:.0} MB", few / 1e6),
        many if many < 1e15 => format!("{:.1} GB", many / 1e9),
        endless => format!("{:.0e} GB", endless / 1e9),
    }
}

static LIMIT: AtomicU64 = AtomicU64::new(4 << 30);

/// Most memory (bytes) that the size of one mesh, matrix, ground, record or sweep may ask for;
/// 4 GiB unless [`set_memory_limit`] was called.
pub fn memory_limit() -> u64 {
    LIMIT.load(Ordering::Relaxed)
}

/// Sets the limit (bytes) for the whole process: to what the machine has, less what else runs on
/// it.
///
/// Sizes given as numbers (columns of a block, elements of a strip, degrees of freedom of a matrix, steps of
/// a record, convolution weights of layered ground) are compared with it before anything is allocated: a
/// [`MemoryError`] says what they would take. It is an estimate for each part by itself, no account of all
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
pub(crate) fn check(
    quantity: &'static str,
    asked: f64,
    needed: f64,
) -> std::result::Result<(), MemoryError> {
    let limit = memory_limit() as f64;
    let remedy = "`set_memory_limit` allows more";
    if needed <= limit {
        Ok(())
    } else {
        Err(MemoryError { quantity, asked, needed, limit, remedy })
    }
}

// Checks of numbers and sizes.

/// Writes a file, in a folder that is made if it is not there.
pub(crate) fn write_file(path: &std::path::Path, content: impl AsRef<[u8]>) -> Result<()> {
    path.parent()
        .map_or(Ok(()), std::fs::create_dir_all)
        .and_then(|()| std::fs::write(path, content))
        .map_err(|error| Error::Write { file: path.display().to_string(), reason: error.kind() })
}

/// `value` if what is `needed` of it `holds`.
pub(crate) fn require(
    quantity: &'static str,
    value: f64,
    holds: bool,
    needed: &'static str,
) -> Result<f64> {
    if holds { Ok(value) } else { Err(Error::Input { quantity, value, needed }) }
}

/// `value` if it is finite and above zero.
pub(crate) fn positive(quantity: &'static str, value: f64) -> Result<f64> {
    require(quantity, value, value.is_finite() && value > 0.0, "finite and above zero")
}

/// `value` if it is finite and not below zero.
pub(crate) fn not_negative(quantity: &'static str, value: f64) -> Result<f64> {
    require(quantity, value, value.is_finite() && value >= 0.0, "finite and not below zero")
}

/// `value` if it is a damping ratio: that of critical damping is 1, and 5 % are 0.05.
pub(crate) fn damping_ratio(quantity: &'static str, value: f64) -> Result<f64> {
    require(quantity, value, (0.0..1.0).contains(&value), "from 0 to below 1 (0.05 is 5 %)")
}

/// `value` if it is finite.
pub(crate) fn finite(quantity: &'static str, value: f64) -> Result<f64> {
    require(quantity, value, value.is_finite(), "finite")
}

/// The first of `values` that is not finite, with its place.
pub(crate) fn not_finite(values: &[f64]) -> Option<(usize, f64)> {
    values.iter().copied().enumerate().find(|(_, value)| !value.is_finite())
}

/// Refuses `values` of which one is not finite.
pub(crate) fn all_finite(quantity: &'static str, values: &[f64]) -> Result<()> {
    match not_finite(values) {
        None => Ok(()),
        Some((index, value)) => Err(Error::NotFinite { quantity, index, value }),
    }
}

/// Error unless `found == needed`.
pub(crate) fn same_length(quantity: &'static str, found: usize, needed: usize) -> Result<()> {
    if found == needed { Ok(()) } else { Err(Error::Size { quantity, found, needed }) }
}

impl Error {
    /// [`Error::Name`] for a name that none of `known` is.
    pub(crate) fn no_name<T: Into<String>>(
        quantity: &'static str,
        name: &str,
        known: impl Iterator<Item = T>,
    ) -> Self {
        Self::Name { quantity, name: name.into(), known: known.map(Into::into).collect() }
    }
}

/// The first twelve of the names that there are.
pub(crate) fn names(known: &[String]) -> String {
    let listed = known[..known.len().min(12)].join(", ");
    if known.is_empty() { listed } else { format!(", only {listed}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_told_in_their_units() {
        let text = |needed: f64| {
            let limit = 2.0_f64.powi(32);
            MemoryError { quantity: "rows", asked: 1e5, needed, limit, remedy: "less" }.to_string()
        };
        assert_eq!(
            text(4.84e9),
            "rows: 100000 would take about 4.8 GB of memory, but at most 4.3 GB are allowed \
             (less)"
        );
        assert!(text(2e6).contains("about 2 MB of") && text(2e30).contains("about 2e21 GB of"));
        assert!(text(f64::INFINITY).contains("about inf GB of"));
    }
}
