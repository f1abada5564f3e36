//! Checks of numbers and sizes.

use super::{Error, Result};

/// Writes a file, in a folder that is made if it is not there.
pub(crate) fn write_file(path: &std::path::Path, content: impl AsRef<[u8]>) -> Result<()> {
    path.parent()
        .map_or(Ok(()), std::fs::create_dir_all)
        .and_then(|()| std::fs::write(path, content))
        .map_err(|error| Error::Write { file: path.display().to_string(), reason: error.kind() })
}

/// `value` if it is finite and above zero.
pub(crate) fn positive(quantity: &'static str, value: f64) -> Result<f64> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(Error::Input { quantity, value, needed: "finite and above zero" })
    }
}

/// `value` if it is finite and not below zero.
pub(crate) fn not_negative(quantity: &'static str, value: f64) -> Result<f64> {
    if value.is_finite() && value >= 0.0 {
        Ok(value)
    } else {
        Err(Error::Input { quantity, value, needed: "finite and not below zero" })
    }
}

/// `value` if it is a damping ratio: that of critical damping is 1, and 5 % are 0.05.
pub(crate) fn damping_ratio(quantity: &'static str, value: f64) -> Result<f64> {
    if (0.0..1.0).contains(&value) {
        Ok(value)
    } else {
        Err(Error::Input { quantity, value, needed: "from 0 to below 1 (0.05 is 5 %)" })
    }
}

/// `value` if it is finite.
pub(crate) fn finite(quantity: &'static str, value: f64) -> Result<f64> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(Error::Input { quantity, value, needed: "finite" })
    }
}

/// Error unless `found == needed`.
pub(crate) fn same_length(quantity: &'static str, found: usize, needed: usize) -> Result<()> {
    if found == needed { Ok(()) } else { Err(Error::Size { quantity, found, needed }) }
}
