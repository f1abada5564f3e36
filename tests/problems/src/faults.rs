//! Faults of files as the crate reports them, for comparison in tests.

use basemat::{Error, FileFault};

/// Fault of a value that cannot be right.
pub fn value(quantity: &str, found: &str, needed: &str) -> FileFault {
    FileFault::Value { quantity: quantity.into(), found: found.into(), needed: needed.into() }
}

/// Fault of a wrong number of items.
pub fn count(items: &str, found: usize, needed: &str) -> FileFault {
    value(&format!("number of {items}"), &found.to_string(), needed)
}

/// Fault of a field that is not a finite number.
pub fn not_a_number(field: &str) -> FileFault {
    value("field", &format!("'{field}'"), "a finite number")
}

/// Whether an error names this value of a quantity of an item.
pub fn is_input_of(
    error: &Error,
    expected_item: &str,
    expected_quantity: &str,
    expected_value: f64,
) -> bool {
    let Error::Item { item, source } = error else { return false };
    match &**source {
        Error::Input { quantity, value, .. } => {
            item == expected_item
                && *quantity == expected_quantity
                && value.to_bits() == expected_value.to_bits()
        }
        _ => false,
    }
}

/// Whether a fault is a value of this quantity.
pub fn is_value(fault: &FileFault, expected_quantity: &str) -> bool {
    matches!(fault, FileFault::Value { quantity, .. } if quantity == expected_quantity)
}

/// Whether a fault is a field that is not a finite number.
pub fn is_no_number(fault: &FileFault) -> bool {
    matches!(fault, FileFault::Value { found, .. } if *fault == value("field", found, "a finite number"))
}

/// Whether a fault is a quantity that the header lacks.
pub fn is_missing(fault: &FileFault) -> bool {
    matches!(fault, FileFault::Missing { .. })
}

/// Whether a fault is a quantity of a record's header without a known number or unit.
pub fn is_unclear(fault: &FileFault) -> bool {
    matches!(fault, FileFault::Value { needed, .. } if needed == CLEAR_QUANTITY)
}

/// Requirement of a quantity that is unclear.
pub const CLEAR_QUANTITY: &str = "clear: all of it a known number, unit or word";

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
pub fn is_unwritable<T>(result: &basemat::Result<T>) -> bool {
    let Err(Error::File(error)) = result else { return false };
    matches!(error.fault, FileFault::Unwritable(_))
}
