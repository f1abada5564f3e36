//! `Debug` for values that are too large to be shown in full.

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
