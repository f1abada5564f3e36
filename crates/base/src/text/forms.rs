//! Forms in which values are stored in serde's formats.

/// Implements `Deserialize` through a constructor, which checks the values.
///
/// It defines a struct of the fields as they are stored, and the conversion to the type, which has
/// `serde(try_from)`.
#[macro_export]
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
            type Error = $crate::error::Error;

            fn try_from(form: $form) -> $crate::error::Result<Self> {
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
pub mod number {
    use serde::de::{Deserialize, Deserializer, Error, Unexpected, Visitor};
    use serde::ser::Serializer;

    pub fn serialize<S: Serializer>(value: &f64, to: S) -> Result<S::Ok, S::Error> {
        if value.is_finite() || !to.is_human_readable() {
            to.serialize_f64(*value)
        } else if value.is_nan() {
            to.serialize_none()
        } else {
            to.serialize_str(if *value > 0.0 { "inf" } else { "-inf" })
        }
    }

    pub fn deserialize<'a, D: Deserializer<'a>>(from: D) -> Result<f64, D::Error> {
        if from.is_human_readable() {
            from.deserialize_any(NumberVisitor)
        } else {
            f64::deserialize(from)
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

/// Lists of numbers, each as [`number`] writes it.
#[cfg(feature = "serde")]
pub mod lists {
    use serde::de::{Deserialize, Deserializer};
    use serde::ser::Serializer;

    #[derive(serde::Serialize, serde::Deserialize)]
    #[serde(transparent)]
    struct StoredNumber(#[serde(with = "super::number")] f64);

    pub fn serialize<S: Serializer>(lists: &[Vec<f64>], to: S) -> Result<S::Ok, S::Error> {
        to.collect_seq(
            lists.iter().map(|list| list.iter().copied().map(StoredNumber).collect::<Vec<_>>()),
        )
    }

    pub fn deserialize<'a, D: Deserializer<'a>>(from: D) -> Result<Vec<Vec<f64>>, D::Error> {
        let lists = Vec::<Vec<StoredNumber>>::deserialize(from)?.into_iter();
        Ok(lists.map(|list| list.into_iter().map(|number| number.0).collect()).collect())
    }
}

/// A duration in seconds.
#[cfg(feature = "serde")]
pub mod seconds {
    use std::time::Duration;

    use serde::de::{Deserialize, Deserializer, Error};
    use serde::ser::Serializer;

    pub fn serialize<S: Serializer>(value: &Duration, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_f64(value.as_secs_f64())
    }

    pub fn deserialize<'a, D: Deserializer<'a>>(from: D) -> Result<Duration, D::Error> {
        Duration::try_from_secs_f64(f64::deserialize(from)?).map_err(D::Error::custom)
    }
}
