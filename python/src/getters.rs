//! Getters of a class as a table.

/// Getters `name: type = value;` of a `$class`, whose values may ask for the object by the name `$own`.
macro_rules! getters {
    ($class:ident, $own:ident; $($(#[doc = $doc:tt])+ $name:ident: $type:ty = $value:expr;)+) => {
        #[pyo3::pymethods]
        impl $class {
            $(
                $(#[doc = $doc])+
                #[getter]
                pub(crate) fn $name(&self) -> $type {
                    let $own = self;
                    $value
                }
            )+
        }
    };
}
