//! Words for baseline treatments.

use std::fmt;
use std::str::FromStr;

use super::Baseline;
use crate::error::{Error, Result};
use crate::text::words::{count, unknown, with_number};

/// The words that `FromStr` reads: `remove_mean`, `rest_to_rest(4)`.
impl fmt::Display for Baseline {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (word, degree) = match *self {
            Self::None => ("none", None),
            Self::RemoveMean => ("remove_mean", None),
            Self::NewmarkParabola => ("newmark_parabola", None),
            Self::VelocityPolynomial { degree } => ("velocity_polynomial", Some(degree)),
            Self::DisplacementPolynomial { degree } => ("displacement_polynomial", Some(degree)),
            Self::RestToRest { degree } => ("rest_to_rest", Some(degree)),
        };
        match degree {
            None => f.pad(word),
            Some(degree) => f.pad(&format!("{word}({degree})")),
        }
    }
}

/// Degrees are checked where a treatment is applied.
///
/// ```
/// use basemat::motion::Baseline;
/// let baseline = Baseline::RestToRest { degree: 4 };
/// assert_eq!("rest_to_rest(4)".parse(), Ok(baseline));
/// assert_eq!(baseline.to_string(), "rest_to_rest(4)");
/// assert!("rest_to_rest".parse::<Baseline>().is_err());
/// ```
impl FromStr for Baseline {
    type Err = Error;

    /// # Errors
    /// [`Error::Word`] with those that are known.
    fn from_str(text: &str) -> Result<Self> {
        let known = &[
            "none",
            "remove_mean",
            "newmark_parabola",
            "velocity_polynomial(degree)",
            "displacement_polynomial(degree)",
            "rest_to_rest(degree)",
        ];
        let read = with_number(text);
        let found = read.and_then(|(word, number)| match (&word[..], number.map(count)) {
            ("none", None) => Some(Self::None),
            ("remove_mean", None) => Some(Self::RemoveMean),
            ("newmark_parabola", None) => Some(Self::NewmarkParabola),
            ("velocity_polynomial", Some(Some(degree))) => {
                Some(Self::VelocityPolynomial { degree })
            }
            ("displacement_polynomial", Some(Some(degree))) => {
                Some(Self::DisplacementPolynomial { degree })
            }
            ("rest_to_rest", Some(Some(degree))) => Some(Self::RestToRest { degree }),
            _ => None,
        });
        found.ok_or_else(|| unknown("baseline treatment", text, known))
    }
}
