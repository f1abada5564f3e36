//! Macros that implement methods by calling another part, and a short `Debug`.

/// Implements methods of a part by calling the same methods of another part.
///
/// `forward! { part; signatures }`: the other part, and the signatures of the methods as in the `impl` block.
/// `tests/plugin/forwarding` fails if a list of signatures omits a method.
#[macro_export]
macro_rules! forward {
    ($part:expr;) => {};
    (
        $part:expr;
        fn $name:ident(&mut $self_word:ident $(, $argument:ident: $type:ty)*) $(-> $return_type:ty)?;
        $($other_signatures:tt)*
    ) => {
        fn $name(&mut $self_word $(, $argument: $type)*) $(-> $return_type)? {
            $part.$name($($argument),*)
        }
        $crate::forward! { $part; $($other_signatures)* }
    };
    (
        $part:expr;
        fn $name:ident(&$self_word:ident $(, $argument:ident: $type:ty)*) $(-> $return_type:ty)?;
        $($other_signatures:tt)*
    ) => {
        fn $name(&$self_word $(, $argument: $type)*) $(-> $return_type)? {
            $part.$name($($argument),*)
        }
        $crate::forward! { $part; $($other_signatures)* }
    };
}

/// Implements a short `Debug`: `short_debug! { Name; self; field: value }`; values may use `self`.
#[macro_export]
macro_rules! short_debug {
    ($name:ident $(<$life:lifetime>)?; $self_word:ident; $($field:ident: $value:expr),* $(,)?) => {
        impl std::fmt::Debug for $name $(<$life>)? {
            fn fmt(&$self_word, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                let mut fields = formatter.debug_struct(stringify!($name));
                $(fields.field(stringify!($field), &$value);)*
                fields.finish_non_exhaustive()
            }
        }
    };
}

/// Implements former names of associated constants, as deprecated.
///
/// Use: `former_constants! { Type { OLD: usize = NEW, "note"; } }`.
#[macro_export]
macro_rules! former_constants {
    ($name:ty { $($former_name:ident: $type:ty = $name_now:ident, $note:literal;)+ }) => {
        impl $name {
            $(
                #[doc = concat!("Former name of `", stringify!($name_now), "`.")]
                #[deprecated(since = "0.5.0", note = $note)]
                pub const $former_name: $type = Self::$name_now;
            )+
        }
    };
}
