//! Names of the core's choices, names of degrees of freedom, and texts in notebooks.

use std::collections::BTreeSet;
use std::sync::{Arc, LazyLock};

use basemat::coupled::Face;
use basemat::interface::Mode;
use pyo3::prelude::*;

use crate::error::{OrRaise, extract_returned, input_error};

/// All modes, in the order of their numbers in arrays.
pub(crate) static MODES: LazyLock<Vec<String>> =
    LazyLock::new(|| Mode::ALL.iter().map(ToString::to_string).collect());

/// Faces of a structure in the ground by their names.
pub(crate) const TRENCH_FACES: [(&str, Face); 3] =
    [("left_wall", Face::LeftWall), ("base", Face::Base), ("right_wall", Face::RightWall)];

/// Name of a mode in Python.
pub(crate) fn mode_name(mode: Mode) -> &'static str {
    &MODES[mode as usize]
}

/// The mode with this name.
pub(crate) fn parse_mode(name: &str) -> PyResult<Mode> {
    name.parse().or_raise()
}

/// The value that the `word` of an `argument` stands for, out of `choices`.
///
/// For a word in another spelling, the error states the correct spelling.
pub(crate) fn choice<T: Clone>(argument: &str, word: &str, choices: &[(&str, T)]) -> PyResult<T> {
    if let Some((_, value)) = choices.iter().find(|(choice, _)| *choice == word) {
        return Ok(value.clone());
    }
    let respelled_word = word.to_lowercase().replace([' ', '-'], "_");
    let choice_index = choices.iter().position(|(choice, _)| *choice == respelled_word);
    let candidates =
        choice_index.map_or(choices, |choice_index| &choices[choice_index..=choice_index]);
    let quoted_words: Vec<String> =
        candidates.iter().map(|(choice, _)| format!("'{choice}'")).collect();
    Err(input_error(format!("{argument} is '{word}', but must be {}", quoted_words.join(" or "))))
}

/// Largest number of names that an error lists: they fill about one line.
const MAX_LISTED_NAMES: usize = 8;

/// A name for each degree of freedom of a structure; all differ.
#[derive(Clone)]
pub(crate) struct DofNames(Arc<[String]>);

impl DofNames {
    /// Checked names of a structure with this number of degrees of freedom.
    pub(crate) fn new(names: Vec<String>, dof_count: usize) -> PyResult<Self> {
        if names.len() != dof_count {
            let name_count = names.len();
            return Err(input_error(format!(
                "dof_names has {name_count} names, but must have {dof_count}"
            )));
        }
        let mut distinct_names = BTreeSet::new();
        match names.iter().find(|name| !distinct_names.insert(name.as_str())) {
            Some(repeated) => Err(input_error(format!(
                "dof_names has '{repeated}' twice, but must name each once"
            ))),
            None => Ok(Self(names.into())),
        }
    }

    /// The attribute `dof_names` of a structure, if it has one.
    pub(crate) fn from_structure(
        structure: &Bound<'_, PyAny>,
        dof_count: usize,
    ) -> PyResult<Option<Self>> {
        let attribute = structure.getattr_opt("dof_names")?.filter(|names| !names.is_none());
        let Some(attribute) = attribute else { return Ok(None) };
        let names = extract_returned("dof_names of the structure", &attribute)?;
        Self::new(names, dof_count).map(Some)
    }

    pub(crate) fn to_vec(&self) -> Vec<String> {
        self.0.to_vec()
    }

    /// Index of the degree of freedom with this name.
    pub(crate) fn dof_index(&self, name: &str) -> PyResult<usize> {
        self.0.iter().position(|dof_name| dof_name == name).ok_or_else(|| {
            let all_dofs: Vec<usize> = (0..self.0.len()).collect();
            let names = self.describe(&all_dofs).unwrap_or_default();
            input_error(format!("there is no degree of freedom '{name}', only {names}"))
        })
    }

    /// Text with the names of these degrees of freedom; of more than eight the first eight, and how many more there
    /// are.
    pub(crate) fn describe(&self, dofs: &[usize]) -> Option<String> {
        let names = dofs
            .iter()
            .take(MAX_LISTED_NAMES)
            .map(|&dof| Some(format!("'{}'", self.0.get(dof)?)));
        let mut text = names.collect::<Option<Vec<_>>>()?.join(", ");
        if let Some(unlisted_count) = dofs.len().checked_sub(MAX_LISTED_NAMES + 1) {
            text = format!("{text} and {} more", unlisted_count + 1);
        }
        Some(text)
    }
}

/// A text as HTML that keeps its lines.
pub(crate) fn preformatted(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    format!("<pre style=\"line-height: 1.2\">{text}</pre>")
}
