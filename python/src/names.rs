//! Names of the core's choices in Python.

use std::sync::LazyLock;

use basemat::coupled::Face;
use basemat::interface::Mode;
use pyo3::PyResult;

use crate::error::{OrRaise, refuse};

/// All modes, in the order of their numbers in arrays.
pub(crate) static MODES: LazyLock<Vec<String>> =
    LazyLock::new(|| Mode::ALL.iter().map(ToString::to_string).collect());

/// Faces of a structure in the ground.
pub(crate) const FACES: [(&str, Face); 3] =
    [("left_wall", Face::LeftWall), ("base", Face::Base), ("right_wall", Face::RightWall)];

pub(crate) fn mode_name(mode: Mode) -> &'static str {
    &MODES[mode as usize]
}

/// The mode of a name.
pub(crate) fn mode(name: &str) -> PyResult<Mode> {
    name.parse().or_raise()
}

/// The choice of a name among `all`; `what` names the argument.
///
/// The error for a name in another spelling states the right one.
pub(crate) fn choice<T: Clone>(what: &str, name: &str, all: &[(&str, T)]) -> PyResult<T> {
    if let Some((_, found)) = all.iter().find(|(own, _)| *own == name) {
        return Ok(found.clone());
    }
    let spelled = name.to_lowercase().replace([' ', '-'], "_");
    let right = all.iter().position(|(own, _)| *own == spelled);
    let all = right.map_or(all, |at| &all[at..=at]);
    let words: Vec<String> = all.iter().map(|(own, _)| format!("'{own}'")).collect();
    Err(refuse(format!("{what} is '{name}', but must be {}", words.join(" or "))))
}
