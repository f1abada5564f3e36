//! Words for choices, as settings files and command lines have them: `slip_left`, `auto`.

use crate::error::Error;
use crate::text::number::{excerpt, finite};

/// `Display` and `FromStr` of an enum without fields: each variant and its word. Read are upper and
/// lower case, and spaces or hyphens in place of underscores.
macro_rules! words {
    ($type:ident, $quantity:literal, { $($variant:ident = $word:literal),+ $(,)? }) => {
        impl $type {
            /// Its word, as `Display` writes and `FromStr` reads it.
            pub fn word(self) -> &'static str {
                match self {
                    $(Self::$variant => $word,)+
                }
            }
        }

        /// The word that `FromStr` reads.
        impl std::fmt::Display for $type {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(self.word())
            }
        }

        #[doc = concat!("One of" $(, " `", $word, "`")+, ", or an [`Error::Word`](crate::Error::Word).")]
        impl std::str::FromStr for $type {
            type Err = crate::error::Error;

            fn from_str(text: &str) -> crate::error::Result<Self> {
                match crate::text::words::plain(text).as_str() {
                    $($word => Ok(Self::$variant),)+
                    _ => Err(crate::text::words::unknown($quantity, text, &[$($word),+])),
                }
            }
        }
    };
}

/// In lower case, without blanks around, underscores for spaces and hyphens.
pub(crate) fn plain(text: &str) -> String {
    text.trim().to_lowercase().replace([' ', '-'], "_")
}

/// The refusal of a word.
pub(crate) fn unknown(quantity: &'static str, text: &str, known: &'static [&'static str]) -> Error {
    Error::Word { quantity, text: excerpt(text), known }
}

/// A word and the number that may stand in brackets behind it: `reduced(1e-6)`.
pub(crate) fn with_number(text: &str) -> Option<(String, Option<f64>)> {
    match text.trim().strip_suffix(')') {
        None => Some((plain(text), None)),
        Some(rest) => {
            let (word, number) = rest.split_once('(')?;
            Some((plain(word), Some(finite(number.trim())?)))
        }
    }
}

/// `value` as a count, if it is one.
pub(crate) fn count(value: f64) -> Option<usize> {
    let most = 9.0e15_f64.min(usize::MAX as f64);
    let counts = (0.0..=most).contains(&value) && value.fract() == 0.0;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
    counts.then_some(value as usize)
}
