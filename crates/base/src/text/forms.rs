//! Stored forms of values in serde's formats.

/// Implements `Deserialize` through a constructor, which checks the values.
///
/// The macro defines a struct `$form` of the stored fields, and its conversion to `$type`. The type needs the attribute
/// `serde(try_from = "$form")`.
#[macro_export]
macro_rules! validated {
    ($type:ident as $form:ident {
        $($(#[$attribute:meta])* $field:ident: $field_type:ty),+ $(,)?
    } => $constructor:expr) => {
        #[cfg(feature = "serde")]
        #[derive(serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        struct $form {
            $($(#[$attribute])* $field: $field_type,)+
        }

        #[cfg(feature = "serde")]
        impl TryFrom<$form> for $type {
            type Error = $crate::error::Error;

            fn try_from(form: $form) -> $crate::error::Result<Self> {
                let $form { $($field),+ } = form;
                $constructor
            }
        }
    };
}

/// Stored form of a number that may be infinite or NaN.
///
/// In human-readable formats NaN is null, and infinities are the texts "inf" and "-inf".
#[cfg(feature = "serde")]
pub mod number {
    use serde::de::{Deserialize, Deserializer, Error, Unexpected, Visitor};
    use serde::ser::Serializer;

    pub fn serialize<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
        if value.is_finite() || !serializer.is_human_readable() {
            serializer.serialize_f64(*value)
        } else if value.is_nan() {
            serializer.serialize_none()
        } else {
            serializer.serialize_str(if *value > 0.0 { "inf" } else { "-inf" })
        }
    }

    pub fn deserialize<'a, D: Deserializer<'a>>(deserializer: D) -> Result<f64, D::Error> {
        if deserializer.is_human_readable() {
            deserializer.deserialize_any(NumberVisitor)
        } else {
            f64::deserialize(deserializer)
        }
    }

    struct NumberVisitor;

    impl Visitor<'_> for NumberVisitor {
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

/// Stored form of lists of numbers, each in the form of [`number`].
#[cfg(feature = "serde")]
pub mod lists {
    use serde::de::{Deserialize, Deserializer};
    use serde::ser::Serializer;

    #[derive(serde::Serialize, serde::Deserialize)]
    #[serde(transparent)]
    struct StoredNumber(#[serde(with = "super::number")] f64);

    pub fn serialize<S: Serializer>(lists: &[Vec<f64>], serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(
            lists.iter().map(|list| list.iter().copied().map(StoredNumber).collect::<Vec<_>>()),
        )
    }

    pub fn deserialize<'a, D: Deserializer<'a>>(
        deserializer: D,
    ) -> Result<Vec<Vec<f64>>, D::Error> {
        let lists = Vec::<Vec<StoredNumber>>::deserialize(deserializer)?.into_iter();
        Ok(lists.map(|list| list.into_iter().map(|number| number.0).collect()).collect())
    }
}

/// Stored form of a duration: its seconds.
#[cfg(feature = "serde")]
pub mod seconds {
    use std::time::Duration;

    use serde::de::{Deserialize, Deserializer, Error};
    use serde::ser::Serializer;

    pub fn serialize<S: Serializer>(value: &Duration, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_f64(value.as_secs_f64())
    }

    pub fn deserialize<'a, D: Deserializer<'a>>(deserializer: D) -> Result<Duration, D::Error> {
        Duration::try_from_secs_f64(f64::deserialize(deserializer)?).map_err(D::Error::custom)
    }
}
