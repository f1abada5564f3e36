//! Words for choices, as settings files and command lines have them: `slip_left`, `auto`.

use crate::error::Error;
use crate::text::number::{excerpt, finite};

/// `Display` and `FromStr` of an enum without fields: each variant and its word. Read are upper and
/// lower case, and spaces or hyphens in place of underscores.
macro_rules! words {
    ($type:ident, $quantity:literal, { $($variant:ident = $word:literal),+ $(,)? }) => {
        impl $type {
            /// All variants, in the order of their declaration.
            pub(crate) const ALL: [Self; [$($word),+].len()] = [$(Self::$variant),+];

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
                let word = crate::text::words::plain(text);
                let found = Self::ALL.into_iter().find(|own| own.word() == word);
                found.ok_or_else(|| crate::text::words::unknown($quantity, text, &[$($word),+]))
            }
        }
    };
}

/// The same for an enum of which some variants have one number, in brackets behind the word:
/// `reduced(1e-6)`.
macro_rules! words_with_numbers {
    (
        $(#[$doc:meta])*
        $type:ident, $quantity:literal, {
            $($plain:ident = $word:literal),+ ;
            $($variant:ident { $field:ident } = $numbered:literal),+ $(,)?
        }
    ) => {
        /// The word that `FromStr` reads, with its number.
        impl std::fmt::Display for $type {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                use crate::text::words::Bracketed;
                match self {
                    $(Self::$plain => f.pad($word),)+
                    $(Self::$variant { $field } => {
                        f.pad(&format!(concat!($numbered, "({})"), $field.shown()))
                    })+
                }
            }
        }

        $(#[$doc])*
        impl std::str::FromStr for $type {
            type Err = crate::error::Error;

            fn from_str(text: &str) -> crate::error::Result<Self> {
                use crate::text::words::{Bracketed, unknown, with_number};
                let known =
                    &[$($word,)+ $(concat!($numbered, "(", stringify!($field), ")")),+];
                let read = with_number(text).and_then(|(word, number)| match (&word[..], number) {
                    $(($word, None) => Some(Self::$plain),)+
                    $(($numbered, Some(number)) => {
                        Bracketed::read(number).map(|$field| Self::$variant { $field })
                    })+
                    _ => None,
                });
                read.ok_or_else(|| unknown($quantity, text, known))
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

/// A number in brackets.
pub(crate) trait Bracketed: Sized {
    fn read(number: f64) -> Option<Self>;
    fn shown(&self) -> String;
}

impl Bracketed for f64 {
    fn read(number: f64) -> Option<Self> {
        Some(number)
    }

    fn shown(&self) -> String {
        format!("{self:e}")
    }
}

impl Bracketed for usize {
    fn read(number: f64) -> Option<Self> {
        let most = 9.0e15_f64.min(usize::MAX as f64);
        let counts = (0.0..=most).contains(&number) && number.fract() == 0.0;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
        counts.then_some(number as usize)
    }

    fn shown(&self) -> String {
        self.to_string()
    }
}
