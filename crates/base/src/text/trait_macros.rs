//! Macros that implement traits of parts: methods that call another part, and a short `Debug`.

/// Implements methods of a part by calling the same methods of another part.
///
/// `forward! { part; signatures }` takes the other part and the signatures as they would stand in the `impl`
/// block. `tests/plugin/forwarding` finds any method that a list of signatures omits.
#[macro_export]
macro_rules! forward {
    ($to:expr;) => {};
    (
        $to:expr;
        fn $name:ident(&mut $self_word:ident $(, $arg:ident: $type:ty)*) $(-> $out:ty)?;
        $($rest:tt)*
    ) => {
        fn $name(&mut $self_word $(, $arg: $type)*) $(-> $out)? {
            $to.$name($($arg),*)
        }
        $crate::forward! { $to; $($rest)* }
    };
    (
        $to:expr;
        fn $name:ident(&$self_word:ident $(, $arg:ident: $type:ty)*) $(-> $out:ty)?;
        $($rest:tt)*
    ) => {
        fn $name(&$self_word $(, $arg: $type)*) $(-> $out)? {
            $to.$name($($arg),*)
        }
        $crate::forward! { $to; $($rest)* }
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

/// Implements former names of associated constants, as deprecated: `former_constants! { Type { OLD: usize = NEW, "note"; } }`.
#[macro_export]
macro_rules! former_constants {
    ($name:ty { $($old:ident: $type:ty = $new:ident, $note:literal;)+ }) => {
        impl $name {
            $(
                #[doc = concat!("Former name of `", stringify!($new), "`.")]
                #[deprecated(since = "0.5.0", note = $note)]
                pub const $old: $type = Self::$new;
            )+
        }
    };
}
