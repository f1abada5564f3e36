//! Arguments that are lists of objects of a class or lists of pairs, with errors that name the type of the argument.

use std::ops::Deref;

use pyo3::conversion::FromPyObjectOwned;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyType};
use pyo3::{PyClass, PyTypeInfo};

use crate::error::input_error;

/// A list, or another sequence, of objects of the class `T`; a single object is a list of one.
pub(crate) struct ListOf<'py, T>(Vec<Bound<'py, T>>);

impl<'py, T> Deref for ListOf<'py, T> {
    type Target = [Bound<'py, T>];

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl<T> ListOf<'_, T> {
    pub(crate) fn unbound(self) -> Vec<Py<T>> {
        self.0.into_iter().map(Bound::unbind).collect()
    }
}

impl<'py, T: PyClass> FromPyObject<'_, 'py> for ListOf<'py, T> {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(entry) = object.cast::<T>() {
            return Ok(Self(vec![entry.to_owned()]));
        }
        let class_name = <T as PyTypeInfo>::type_object(object.py()).name()?;
        let requirement = format!("a list of {class_name}");
        if object.is_instance_of::<PyDict>() {
            return Err(type_error(
                &object,
                &format!("{requirement} without keys: list(….values())"),
            ));
        }
        let entries = object.try_iter().map_err(|_| type_error(&object, &requirement))?;
        let mut objects = Vec::new();
        for entry in entries {
            let entry = entry?;
            objects.push(entry.cast::<T>().map_err(|_| type_error(&entry, &requirement))?.clone());
        }
        Ok(Self(objects))
    }
}

/// A list, or another sequence, of pairs.
pub(crate) struct PairList<A, B>(pub(crate) Vec<(A, B)>);

impl<'py, A: FromPyObjectOwned<'py>, B: FromPyObjectOwned<'py>> FromPyObject<'_, 'py>
    for PairList<A, B>
{
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let requirement = "a list of pairs (a, b)";
        let entries = object.try_iter().map_err(|_| type_error(&object, requirement))?;
        let mut pairs = Vec::new();
        for entry in entries {
            let entry = entry?;
            let is_pair = entry.len().is_ok_and(|item_count| item_count == 2);
            let items = is_pair.then(|| (entry.get_item(0), entry.get_item(1)));
            let Some((Ok(first_item), Ok(second_item))) = items else {
                return Err(type_error(&entry, "a pair (a, b) of a list of pairs"));
            };
            let first_value = first_item.extract().map_err(Into::into)?;
            let second_value = second_item.extract().map_err(Into::into)?;
            pairs.push((first_value, second_value));
        }
        Ok(Self(pairs))
    }
}

/// Error for an argument whose type is not the required one.
pub(crate) fn type_error(object: &Bound<'_, PyAny>, requirement: &str) -> PyErr {
    if let Err(error) = reject_class(object) {
        return error;
    }
    let type_name =
        object.get_type().name().map_or_else(|_| "object".into(), |name| name.to_string());
    PyTypeError::new_err(format!("of the type {type_name}, but must be {requirement}"))
}

/// Error for a class in place of one of its objects.
pub(crate) fn reject_class(object: &Bound<'_, PyAny>) -> PyResult<()> {
    let Ok(class) = object.cast::<PyType>() else { return Ok(()) };
    let class_name = class.name()?;
    Err(input_error(format!(
        "the class {class_name} itself, but must be an object of it: {class_name}(…)"
    )))
}
