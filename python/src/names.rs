//! Names of the core's choices in Python.

use basemat::interface::Mode;
use pyo3::prelude::*;

use crate::error::{OrRaise, refuse};

/// All modes, in the order of their numbers in arrays.
pub(crate) const MODES: [(Mode, &str); 9] = [
    (Mode::Stick, "stick"),
    (Mode::SlipLeft, "slip left"),
    (Mode::SlipRight, "slip right"),
    (Mode::Open, "open"),
    (Mode::Yield, "yield"),
    (Mode::YieldLeft, "yield left"),
    (Mode::YieldRight, "yield right"),
    (Mode::Slip, "slip"),
    (Mode::YieldSlip, "yield slip"),
];

/// Its number in arrays, and its name.
fn known(mode: Mode) -> PyResult<(u8, &'static str)> {
    let mut all = (0..).zip(MODES);
    let found = all.find_map(|(number, (own, name))| (own == mode).then_some((number, name)));
    found.ok_or_else(|| refuse(format!("mode '{mode}' has no number")))
}

pub(crate) fn mode_name(mode: Mode) -> PyResult<&'static str> {
    known(mode).map(|(_, name)| name)
}

pub(crate) fn mode_number(mode: Mode) -> PyResult<u8> {
    known(mode).map(|(number, _)| number)
}

/// The mode of a name.
pub(crate) fn mode(name: &str) -> PyResult<Mode> {
    name.parse().or_raise()
}

/// The choice of a name among `all`; `what` names the argument.
pub(crate) fn choice<T: Clone>(what: &str, name: &str, all: &[(&str, T)]) -> PyResult<T> {
    if let Some((_, found)) = all.iter().find(|(own, _)| *own == name) {
        return Ok(found.clone());
    }
    let words: Vec<String> = all.iter().map(|(own, _)| format!("'{own}'")).collect();
    Err(refuse(format!("{what} is '{name}', but must be {}", words.join(" or "))))
}
