//! Words for choices in settings files and command lines: `slip_left`, `auto`.

use crate::error::Error;
use crate::text::decimal::{excerpt, finite};

/// Implements `Display`, `FromStr` and the list `ALL` for an enum without fields.
///
/// The macro lists each variant and its word; the visibility before the type applies to `ALL`. The error for another
/// spelling states the right one.
#[macro_export]
macro_rules! words {
    ($(#[$attribute:meta])* $all:vis $type:ident, $quantity:literal, { $($variant:ident = $word:literal),+ $(,)? }) => {
        impl $type {
            /// All variants, in the order of their declaration.
            $(#[$attribute])*
            $all const ALL: [Self; [$($word),+].len()] = [$(Self::$variant),+];

            /// Word of the choice, as `Display` writes and `FromStr` reads it.
            pub(crate) fn word(self) -> &'static str {
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

        #[doc = concat!("One of" $(, " `", $word, "`")+, ", or an [`Error::Name`](crate::Error::Name).")]
        impl std::str::FromStr for $type {
            type Err = $crate::error::Error;

            fn from_str(text: &str) -> $crate::error::Result<Self> {
                let found = Self::ALL.into_iter().find(|choice| choice.word() == text);
                found.ok_or_else(|| $crate::text::words::unknown($quantity, text, &[$($word),+]))
            }
        }
    };
}

/// Implements words for an enum of which some variants have one number, in brackets: `reduced(1e-6)`.
#[macro_export]
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
                use $crate::text::words::Bracketed;
                match self {
                    $(Self::$plain => f.pad($word),)+
                    $(Self::$variant { $field } => {
                        f.pad(&format!(concat!($numbered, "({})"), $field.text()))
                    })+
                }
            }
        }

        $(#[$doc])*
        impl std::str::FromStr for $type {
            type Err = $crate::error::Error;

            fn from_str(text: &str) -> $crate::error::Result<Self> {
                use $crate::text::words::{Bracketed, unknown, with_number};
                let known =
                    &[$($word,)+ $(concat!($numbered, "(", stringify!($field), ")")),+];
                let read = with_number(text).and_then(|(word, number)| match (word, number) {
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

/// Error for an unknown word; for another spelling of a known word, it names only that word.
pub fn unknown(quantity: &'static str, text: &str, known: &'static [&'static str]) -> Error {
    let spelled = text.trim().to_lowercase().replace([' ', '-'], "_");
    let index = known.iter().position(|word| *word == spelled);
    let known = index.map_or(known, |index| &known[index..=index]);
    Error::no_name(quantity, &excerpt(text), known.iter().copied())
}

/// Splits a word from the number that may follow it in brackets: `reduced(1e-6)`.
pub fn with_number(text: &str) -> Option<(&str, Option<f64>)> {
    match text.strip_suffix(')') {
        None => Some((text, None)),
        Some(rest) => {
            let (word, number) = rest.split_once('(')?;
            Some((word, Some(finite(number)?)))
        }
    }
}

/// A number that may follow a word in brackets.
pub trait Bracketed: Sized {
    /// Converts the number that was read; `None` if it is not allowed.
    fn read(number: f64) -> Option<Self>;
    /// The number as it is written.
    fn text(&self) -> String;
}

impl Bracketed for f64 {
    fn read(number: f64) -> Option<Self> {
        Some(number)
    }

    fn text(&self) -> String {
        format!("{self:e}")
    }
}

impl Bracketed for usize {
    fn read(number: f64) -> Option<Self> {
        let max_count = 9.0e15_f64.min(usize::MAX as f64);
        let is_count = (0.0..=max_count).contains(&number) && number.fract() == 0.0;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
        is_count.then_some(number as usize)
    }

    fn text(&self) -> String {
        self.to_string()
    }
}
