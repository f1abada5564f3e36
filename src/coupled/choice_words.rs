//! Words for choices that have a number with them.

use std::fmt;
use std::str::FromStr;

use super::coordinates::Coordinates;
use crate::contact::ContactSearch;
use crate::error::{Error, Result};
use crate::text::words::{count, unknown, with_number};

/// The words that `FromStr` reads: `auto`, `reduced(1e-6)`.
impl fmt::Display for Coordinates {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => f.pad("auto"),
            Self::Unknowns => f.pad("unknowns"),
            Self::Modes => f.pad("modes"),
            Self::Reduced { tolerance } => f.pad(&format!("reduced({tolerance:e})")),
        }
    }
}

/// ```
/// use basemat::coupled::Coordinates;
/// let reduced = Coordinates::Reduced { tolerance: 1e-6 };
/// assert_eq!("reduced(1e-6)".parse(), Ok(reduced));
/// assert_eq!(reduced.to_string(), "reduced(1e-6)");
/// let refused = "ritz".parse::<Coordinates>().unwrap_err();
/// let known = "auto, unknowns, modes, reduced(tolerance)";
/// assert_eq!(refused.to_string(), format!("there is no kind of coordinates 'ritz', only {known}"));
/// ```
impl FromStr for Coordinates {
    type Err = Error;

    /// # Errors
    /// [`Error::Word`] with those that are known.
    fn from_str(text: &str) -> Result<Self> {
        let known = &["auto", "unknowns", "modes", "reduced(tolerance)"];
        let read = with_number(text);
        Ok(match read.as_ref().map(|(word, number)| (&word[..], *number)) {
            Some(("auto", None)) => Self::Auto,
            Some(("unknowns", None)) => Self::Unknowns,
            Some(("modes", None)) => Self::Modes,
            Some(("reduced", Some(tolerance))) => Self::Reduced { tolerance },
            _ => return Err(unknown("kind of coordinates", text, known)),
        })
    }
}

/// The words that `FromStr` reads: `robust`, `flow_chart(50)`.
impl fmt::Display for ContactSearch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Robust => f.pad("robust"),
            Self::FlowChart { iterations } => f.pad(&format!("flow_chart({iterations})")),
        }
    }
}

/// ```
/// use basemat::coupled::ContactSearch;
/// assert_eq!("flow_chart(50)".parse(), Ok(ContactSearch::FlowChart { iterations: 50 }));
/// assert!("flow_chart(0.5)".parse::<ContactSearch>().is_err());
/// ```
impl FromStr for ContactSearch {
    type Err = Error;

    /// # Errors
    /// [`Error::Word`] with those that are known.
    fn from_str(text: &str) -> Result<Self> {
        let known = &["robust", "flow_chart(iterations)"];
        let read = with_number(text);
        read.and_then(|(word, number)| match (&word[..], number) {
            ("robust", None) => Some(Self::Robust),
            ("flow_chart", Some(number)) => {
                count(number).map(|iterations| Self::FlowChart { iterations })
            }
            _ => None,
        })
        .ok_or_else(|| unknown("contact search", text, known))
    }
}
