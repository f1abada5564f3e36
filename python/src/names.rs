//! Names of the core's choices in Python.

use basemat::interface::Mode;
use basemat::results::Quantity;
use pyo3::prelude::*;

use crate::error::refuse;

/// All modes, in the order of their numbers in arrays.
const MODES: [(Mode, &str); 7] = [
    (Mode::Stick, "stick"),
    (Mode::SlipLeft, "slip left"),
    (Mode::SlipRight, "slip right"),
    (Mode::Open, "open"),
    (Mode::Yield, "yield"),
    (Mode::YieldLeft, "yield left"),
    (Mode::YieldRight, "yield right"),
];

/// Names of the modes, in the order of their numbers in arrays.
pub(crate) const MODE_NAMES: [&str; 7] =
    ["stick", "slip left", "slip right", "open", "yield", "yield left", "yield right"];

pub(crate) fn mode_name(mode: Mode) -> &'static str {
    MODE_NAMES[usize::from(mode_number(mode))]
}

/// Its number in arrays: the place in [`MODE_NAMES`].
pub(crate) fn mode_number(mode: Mode) -> u8 {
    match mode {
        Mode::SlipLeft => 1,
        Mode::SlipRight => 2,
        Mode::Open => 3,
        Mode::Yield => 4,
        Mode::YieldLeft => 5,
        Mode::YieldRight => 6,
        // Stick; others there are none.
        _ => 0,
    }
}

/// The mode of a name.
pub(crate) fn mode(name: &str) -> PyResult<Mode> {
    let found = MODES.iter().find(|(_, own)| *own == name);
    found.map(|(mode, _)| *mode).ok_or_else(|| {
        refuse(format!("mode is '{name}', but must be one of {}", MODE_NAMES.join(", ")))
    })
}

/// Scalar time series, with their keys.
pub(crate) const SERIES: [(Quantity, &str); 11] = [
    (Quantity::BaseShear, "base_shear"),
    (Quantity::BaseMoment, "base_moment"),
    (Quantity::NormalForce, "normal_force"),
    (Quantity::UpliftedFraction, "uplifted_fraction"),
    (Quantity::MeanSlip, "mean_slip"),
    (Quantity::LargestSlip, "largest_slip"),
    (Quantity::BaseRotation, "base_rotation"),
    (Quantity::FreeFieldHorizontal, "free_field_horizontal"),
    (Quantity::FreeFieldVertical, "free_field_vertical"),
    (Quantity::SlidingSafety, "sliding_safety"),
    (Quantity::OverturningSafety, "overturning_safety"),
];
