//! Faults of files as the crate states them, to compare with.

use basemat::{Error, FileFault};

/// A value that cannot be right.
pub fn value(quantity: &str, found: &str, needed: &str) -> FileFault {
    let (quantity, found, needed) = (quantity.into(), found.into(), needed.into());
    FileFault::Value { quantity, found, needed }
}

/// A wrong number of items.
pub fn count(items: &str, found: usize, needed: &str) -> FileFault {
    value(&format!("number of {items}"), &found.to_string(), needed)
}

/// A field that is not a finite number.
pub fn not_a_number(field: &str) -> FileFault {
    value("field", &format!("'{field}'"), "a finite number")
}

/// Whether an error is an item's, and a value of it that must be another one.
pub fn is_input_of(error: &Error, item: &str, quantity: &str, value: f64) -> bool {
    let Error::Item { item: of, source } = error else { return false };
    let found = match &**source {
        Error::Input { quantity: named, value, .. } if *named == quantity => *value,
        _ => return false,
    };
    of == item && found.to_bits() == value.to_bits()
}

/// Whether a fault is a value of this quantity.
pub fn is_value(fault: &FileFault, quantity: &str) -> bool {
    matches!(fault, FileFault::Value { quantity: of, .. } if of == quantity)
}

/// Whether a fault is a field that is not a finite number.
pub fn is_no_number(fault: &FileFault) -> bool {
    matches!(fault, FileFault::Value { found, .. } if *fault == value("field", found, "a finite number"))
}

/// Whether a fault is a quantity of the header that is not there.
pub fn is_missing(fault: &FileFault) -> bool {
    matches!(fault, FileFault::Missing { .. })
}

/// Whether a fault is a quantity of a record's header without a known number or unit.
pub fn is_unclear(fault: &FileFault) -> bool {
    matches!(fault, FileFault::Value { needed, .. } if needed == CLEAR)
}

/// Requirement of a quantity that is unclear.
pub const CLEAR: &str = "clear: all of it a known number, unit or word";

/// Whether a fault is another quantity than acceleration, or an unknown unit.
pub fn is_no_acceleration(fault: &FileFault) -> bool {
    matches!(fault, FileFault::Format { needed, .. } if needed == "an acceleration in a known unit")
}

/// Whether a fault is unprocessed data.
pub fn is_unprocessed(fault: &FileFault) -> bool {
    matches!(fault, FileFault::Format { needed, .. } if needed.starts_with("corrected data: "))
}

/// Whether two places of a file state different values.
pub fn is_contradiction(fault: &FileFault) -> bool {
    matches!(fault, FileFault::Value { needed, .. } if needed.ends_with(", as the file states elsewhere"))
}

/// Whether a line does not match the columns of a Fortran format.
pub fn is_off_columns(fault: &FileFault) -> bool {
    matches!(fault, FileFault::Format { needed, .. } if needed.starts_with("numbers in the columns"))
}

/// Whether a file could not be written.
pub fn is_unwritable<T>(outcome: &basemat::Result<T>) -> bool {
    let Err(Error::File(error)) = outcome else { return false };
    matches!(error.fault, FileFault::Unwritable(_))
}
