//! Forms of values in serde's formats.

/// `Deserialize` through a constructor, so that no value comes in that it would refuse: a struct of
/// the fields as they are written, and the type made of them. The type has `serde(try_from)`.
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

/// A number that need not be finite: in formats that people read, NaN is null and infinities are the
/// texts "inf" and "-inf".
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

// Traits of parts that are made of another part of the same kind.

/// Methods that a part answers by asking another one: `forward! { place; signatures }`, the place
/// and the signatures as they would stand in the `impl` block.
///
/// `tests/plugin/forwarding` finds any method that a list of signatures has forgotten.
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

// `Debug` for what is too large to be shown whole, or has parts that cannot be shown.

/// A short `Debug`: `short_debug! { Name; self; field: value }`, values made of `self`.
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
