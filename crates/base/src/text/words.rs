//! Words for choices in settings files and command lines: `slip_left`, `auto`.

use crate::error::Error;
use crate::text::decimal::{excerpt, finite};

/// Implements `Display`, `FromStr` and the list `ALL` for an enum without fields.
///
/// The macro lists each variant with its word; the visibility before the type applies to `ALL`. The error for another
/// spelling of a word states the right spelling.
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
                let variant = Self::ALL.into_iter().find(|variant| variant.word() == text);
                variant.ok_or_else(|| $crate::text::words::unknown_word_error($quantity, text, &[$($word),+]))
            }
        }
    };
}

/// Implements words for an enum whose variants may have one number, in brackets: `reduced(1e-6)`.
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
                use $crate::text::words::{Bracketed, unknown_word_error, word_and_number};
                let valid_words =
                    &[$($word,)+ $(concat!($numbered, "(", stringify!($field), ")")),+];
                let variant = word_and_number(text).and_then(|(word, number)| match (word, number) {
                    $(($word, None) => Some(Self::$plain),)+
                    $(($numbered, Some(number)) => {
                        Bracketed::read(number).map(|$field| Self::$variant { $field })
                    })+
                    _ => None,
                });
                variant.ok_or_else(|| unknown_word_error($quantity, text, valid_words))
            }
        }
    };
}

/// Error for an unknown word.
///
/// For another spelling of a valid word, the error lists only this word.
pub fn unknown_word_error(
    quantity: &'static str,
    text: &str,
    valid_words: &'static [&'static str],
) -> Error {
    let normalized_text = text.trim().to_lowercase().replace([' ', '-'], "_");
    let index = valid_words.iter().position(|word| *word == normalized_text);
    let listed_words = index.map_or(valid_words, |index| &valid_words[index..=index]);
    Error::no_name(quantity, &excerpt(text), listed_words.iter().copied())
}

/// Splits a word and the number that may follow in brackets: `reduced(1e-6)`.
pub fn word_and_number(text: &str) -> Option<(&str, Option<f64>)> {
    match text.strip_suffix(')') {
        None => Some((text, None)),
        Some(text) => {
            let (word, number) = text.split_once('(')?;
            Some((word, Some(finite(number)?)))
        }
    }
}

/// A number that may follow a word in brackets.
pub trait Bracketed: Sized {
    /// Converts a number from a file; `None` if it is not allowed.
    fn read(number: f64) -> Option<Self>;
    /// Text of the number.
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

/// Largest count: all whole numbers up to it are exact in double precision.
const MAX_EXACT_COUNT: f64 = 9.0e15;

impl Bracketed for usize {
    fn read(number: f64) -> Option<Self> {
        let max_count = MAX_EXACT_COUNT.min(usize::MAX as f64);
        let is_count = (0.0..=max_count).contains(&number) && number.fract() == 0.0;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
        is_count.then_some(number as usize)
    }

    fn text(&self) -> String {
        self.to_string()
    }
}
