//! Words for choices in settings files and command lines: `slip_left`, `auto`.

use crate::error::Error;
use crate::text::column::{excerpt, finite};

/// Implements `Display`, `FromStr` and the list `ALL` (with the given visibility) for an enum without fields.
///
/// The macro lists each variant and its word. The error for another spelling states the right one.
macro_rules! words {
    ($all:vis $type:ident, $quantity:literal, { $($variant:ident = $word:literal),+ $(,)? }) => {
        impl $type {
            /// All variants, in the order of their declaration.
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
            type Err = crate::error::Error;

            fn from_str(text: &str) -> crate::error::Result<Self> {
                let found = Self::ALL.into_iter().find(|own| own.word() == text);
                found.ok_or_else(|| crate::text::words::unknown($quantity, text, &[$($word),+]))
            }
        }
    };
}

/// Implements words for an enum of which some variants have one number, in brackets: `reduced(1e-6)`.
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

/// Error for a word that is not known; of a known word in another spelling it has the right spelling only.
pub(crate) fn unknown(quantity: &'static str, text: &str, known: &'static [&'static str]) -> Error {
    let spelled = text.trim().to_lowercase().replace([' ', '-'], "_");
    let right = known.iter().position(|word| *word == spelled);
    let known = right.map_or(known, |place| &known[place..=place]);
    Error::no_name(quantity, &excerpt(text), known.iter().copied())
}

/// Splits a word from the number that may follow it in brackets: `reduced(1e-6)`.
pub(crate) fn with_number(text: &str) -> Option<(&str, Option<f64>)> {
    match text.strip_suffix(')') {
        None => Some((text, None)),
        Some(rest) => {
            let (word, number) = rest.split_once('(')?;
            Some((word, Some(finite(number)?)))
        }
    }
}

/// A number that may follow a word in brackets.
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

// Forms of values in serde's formats.

/// Implements `Deserialize` through a constructor, which checks the values.
///
/// It defines a struct of the fields as they are stored, and the conversion to the type, which has
/// `serde(try_from)`.
macro_rules! validated {
    ($type:ident as $form:ident {
        $($(#[$attribute:meta])* $field:ident: $kind:ty),+ $(,)?
    } => $make:expr) => {
        #[cfg(feature = "serde")]
        #[derive(serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        struct $form {
            $($(#[$attribute])* $field: $kind,)+
        }

        #[cfg(feature = "serde")]
        impl TryFrom<$form> for $type {
            type Error = crate::error::Error;

            fn try_from(form: $form) -> crate::error::Result<Self> {
                let $form { $($field),+ } = form;
                $make
            }
        }
    };
}

/// A number that need not be finite.
///
/// In human-readable formats NaN is null, and infinities are the texts "inf" and "-inf".
#[cfg(feature = "serde")]
pub(crate) mod number {
    use serde::de::{Deserialize, Deserializer, Error, Unexpected, Visitor};
    use serde::ser::Serializer;

    #[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde calls it")]
    pub(crate) fn serialize<S: Serializer>(value: &f64, to: S) -> Result<S::Ok, S::Error> {
        if value.is_finite() || !to.is_human_readable() {
            to.serialize_f64(*value)
        } else if value.is_nan() {
            to.serialize_none()
        } else {
            to.serialize_str(if *value > 0.0 { "inf" } else { "-inf" })
        }
    }

    pub(crate) fn deserialize<'a, D: Deserializer<'a>>(from: D) -> Result<f64, D::Error> {
        if from.is_human_readable() { from.deserialize_any(Number) } else { f64::deserialize(from) }
    }

    struct Number;

    impl Visitor<'_> for Number {
        type Value = f64;

        fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
            f.write_str("a number, null, \"inf\" or \"-inf\"")
        }

        fn visit_f64<E: Error>(self, value: f64) -> Result<f64, E> {
            Ok(value)
        }

        fn visit_i64<E: Error>(self, value: i64) -> Result<f64, E> {
            Ok(value as f64)
        }

        fn visit_u64<E: Error>(self, value: u64) -> Result<f64, E> {
            Ok(value as f64)
        }

        fn visit_unit<E: Error>(self) -> Result<f64, E> {
            Ok(f64::NAN)
        }

        fn visit_none<E: Error>(self) -> Result<f64, E> {
            Ok(f64::NAN)
        }

        fn visit_str<E: Error>(self, text: &str) -> Result<f64, E> {
            match text {
                "inf" => Ok(f64::INFINITY),
                "-inf" => Ok(f64::NEG_INFINITY),
                _ => Err(E::invalid_value(Unexpected::Str(text), &self)),
            }
        }
    }
}

/// Lists of numbers, each as [`number`] writes it.
#[cfg(feature = "serde")]
pub(crate) mod lists {
    use serde::de::{Deserialize, Deserializer};
    use serde::ser::Serializer;

    #[derive(serde::Serialize, serde::Deserialize)]
    #[serde(transparent)]
    struct Number(#[serde(with = "super::number")] f64);

    pub(crate) fn serialize<S: Serializer>(lists: &[Vec<f64>], to: S) -> Result<S::Ok, S::Error> {
        let numbers = |list: &Vec<f64>| list.iter().copied().map(Number).collect::<Vec<_>>();
        to.collect_seq(lists.iter().map(numbers))
    }

    pub(crate) fn deserialize<'a, D: Deserializer<'a>>(from: D) -> Result<Vec<Vec<f64>>, D::Error> {
        let lists = Vec::<Vec<Number>>::deserialize(from)?.into_iter();
        Ok(lists.map(|list| list.into_iter().map(|number| number.0).collect()).collect())
    }
}

/// A duration in seconds.
#[cfg(feature = "serde")]
pub(crate) mod seconds {
    use std::time::Duration;

    use serde::de::{Deserialize, Deserializer, Error};
    use serde::ser::Serializer;

    pub(crate) fn serialize<S: Serializer>(value: &Duration, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_f64(value.as_secs_f64())
    }

    pub(crate) fn deserialize<'a, D: Deserializer<'a>>(from: D) -> Result<Duration, D::Error> {
        Duration::try_from_secs_f64(f64::deserialize(from)?).map_err(D::Error::custom)
    }
}

// Traits of parts that contain another part of the same kind.

/// Implements methods of a part by calling the same methods of another part.
///
/// `forward! { place; signatures }` takes the place and the signatures as they would stand in the `impl`
/// block. `tests/plugin/forwarding` finds any method that a list of signatures omits.
macro_rules! forward {
    ($to:expr;) => {};
    (
        $to:expr;
        fn $name:ident(&mut $own:ident $(, $arg:ident: $type:ty)*) $(-> $out:ty)?;
        $($rest:tt)*
    ) => {
        fn $name(&mut $own $(, $arg: $type)*) $(-> $out)? {
            $to.$name($($arg),*)
        }
        forward! { $to; $($rest)* }
    };
    (
        $to:expr;
        fn $name:ident(&$own:ident $(, $arg:ident: $type:ty)*) $(-> $out:ty)?;
        $($rest:tt)*
    ) => {
        fn $name(&$own $(, $arg: $type)*) $(-> $out)? {
            $to.$name($($arg),*)
        }
        forward! { $to; $($rest)* }
    };
}

// `Debug` for values that are too large to be shown in full, or have parts that cannot be shown.

/// Implements a short `Debug`: `short_debug! { Name; self; field: value }`; values may use `self`.
macro_rules! short_debug {
    ($name:ident $(<$life:lifetime>)?; $own:ident; $($field:ident: $value:expr),* $(,)?) => {
        impl std::fmt::Debug for $name $(<$life>)? {
            fn fmt(&$own, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                let mut fields = formatter.debug_struct(stringify!($name));
                $(fields.field(stringify!($field), &$value);)*
                fields.finish_non_exhaustive()
            }
        }
    };
}
