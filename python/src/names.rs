//! Names of the core's choices in Python.

use std::sync::LazyLock;

use basemat::coupled::Face;
use basemat::interface::Mode;
use pyo3::PyResult;

use crate::error::{OrRaise, input_error};

/// All modes, in the order of their numbers in arrays.
pub(crate) static MODES: LazyLock<Vec<String>> =
    LazyLock::new(|| Mode::ALL.iter().map(ToString::to_string).collect());

/// Faces of a structure in the ground.
pub(crate) const TRENCH_FACES: [(&str, Face); 3] =
    [("left_wall", Face::LeftWall), ("base", Face::Base), ("right_wall", Face::RightWall)];

pub(crate) fn mode_name(mode: Mode) -> &'static str {
    &MODES[mode as usize]
}

/// The mode of a name.
pub(crate) fn mode(name: &str) -> PyResult<Mode> {
    name.parse().or_raise()
}

/// The value that the `word` of an `argument` stands for, out of `choices`.
///
/// The error for a word in another spelling states the right one.
pub(crate) fn choice<T: Clone>(argument: &str, word: &str, choices: &[(&str, T)]) -> PyResult<T> {
    if let Some((_, value)) = choices.iter().find(|(choice, _)| *choice == word) {
        return Ok(value.clone());
    }
    let respelled = word.to_lowercase().replace([' ', '-'], "_");
    let index = choices.iter().position(|(choice, _)| *choice == respelled);
    let candidates = index.map_or(choices, |index| &choices[index..=index]);
    let words: Vec<String> = candidates.iter().map(|(choice, _)| format!("'{choice}'")).collect();
    Err(input_error(format!("{argument} is '{word}', but must be {}", words.join(" or "))))
}
