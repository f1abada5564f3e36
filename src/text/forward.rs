//! Methods of a part that contains another part of the same kind.

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
