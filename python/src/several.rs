//! Lists of objects of a class, and of pairs, as Python gives them: messages that say what was given in their place.

use std::ops::Deref;

use pyo3::conversion::FromPyObjectOwned;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};
use pyo3::{PyClass, PyTypeInfo};

use crate::error::refuse;

/// A list, or another sequence, of objects of the class `T`; a single object is a list of one.
pub(crate) struct Several<'py, T>(Vec<Bound<'py, T>>);

impl<'py, T> Deref for Several<'py, T> {
    type Target = [Bound<'py, T>];

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl<T> Several<'_, T> {
    pub(crate) fn unbound(self) -> Vec<Py<T>> {
        self.0.into_iter().map(Bound::unbind).collect()
    }
}

impl<'py, T: PyClass> FromPyObject<'_, 'py> for Several<'py, T> {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(own) = object.cast::<T>() {
            return Ok(Self(vec![own.to_owned()]));
        }
        let name = <T as PyTypeInfo>::type_object(object.py()).name()?;
        let needed = format!("a list of {name}");
        if object.is_instance_of::<PyDict>() {
            return Err(no_such(&object, &format!("{needed} without keys: list(….values())")));
        }
        let entries = object.try_iter().map_err(|_| no_such(&object, &needed))?;
        let entry = |entry: PyResult<Bound<'py, PyAny>>| {
            let entry = entry?;
            let own = entry.cast::<T>().map_err(|_| no_such(&entry, &needed))?;
            Ok(own.clone())
        };
        entries.map(entry).collect::<PyResult<_>>().map(Self)
    }
}

/// A list, or another sequence, of pairs.
pub(crate) struct Pairs<A, B>(pub(crate) Vec<(A, B)>);

impl<'py, A: FromPyObjectOwned<'py>, B: FromPyObjectOwned<'py>> FromPyObject<'_, 'py>
    for Pairs<A, B>
{
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let needed = "a list of pairs (a, b)";
        let entries = object.try_iter().map_err(|_| no_such(&object, needed))?;
        let entry = |entry: PyResult<Bound<'py, PyAny>>| {
            let entry = entry?;
            let two = entry.len().is_ok_and(|length| length == 2);
            let [one, other] = [0, 1].map(|k| entry.get_item(k).ok().filter(|_| two));
            let (Some(one), Some(other)) = (one, other) else {
                return Err(no_such(&entry, "a pair (a, b) of a list of pairs"));
            };
            Ok((one.extract().map_err(Into::into)?, other.extract().map_err(Into::into)?))
        };
        entries.map(entry).collect::<PyResult<_>>().map(Self)
    }
}

/// The error of an argument that is none of what is `needed`.
pub(crate) fn no_such(object: &Bound<'_, PyAny>, needed: &str) -> PyErr {
    if let Err(error) = no_class(object) {
        return error;
    }
    let found = object.get_type().name().map_or_else(|_| "object".into(), |name| name.to_string());
    PyTypeError::new_err(format!("of the type {found}, but must be {needed}"))
}

/// Refuses a class where one of its objects is needed.
pub(crate) fn no_class(object: &Bound<'_, PyAny>) -> PyResult<()> {
    let Ok(class) = object.cast::<PyType>() else { return Ok(()) };
    let name = class.name()?;
    Err(refuse(format!("the class {name} itself, but must be an object of it: {name}(…)")))
}
