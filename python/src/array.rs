//! Arrays and matrices that come from Python.

use basemat::structure::Triplets;
use numpy::{AllowTypeChange, PyArrayLike1, PyArrayLike2, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::error::refuse;

/// Numbers of anything that numpy takes for a list of them.
pub(crate) struct Numbers(pub(crate) Vec<f64>);

impl<'py> FromPyObject<'_, 'py> for Numbers {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let array: PyArrayLike1<'py, f64, AllowTypeChange> = object.extract()?;
        Ok(Self(array.as_array().to_vec()))
    }
}

/// Pairs of numbers: anything that numpy takes for an array of shape (n, 2).
pub(crate) struct Pairs(pub(crate) Vec<[f64; 2]>);

impl<'py> FromPyObject<'_, 'py> for Pairs {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let array: PyArrayLike2<'py, f64, AllowTypeChange> = object.extract()?;
        if array.shape()[1] != 2 {
            return Err(refuse(format!(
                "an array of shape (n, 2) is needed, not {:?}",
                array.shape()
            )));
        }
        Ok(Self(array.as_array().rows().into_iter().map(|row| [row[0], row[1]]).collect()))
    }
}

/// A square matrix: dense, or any of `scipy.sparse`. Entries of zero are left out.
pub(crate) struct Matrix(pub(crate) Triplets);

impl<'py> FromPyObject<'_, 'py> for Matrix {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if object.hasattr("tocoo")? { sparse(&object) } else { dense(&object) }
    }
}

fn square(shape: (usize, usize)) -> PyResult<Triplets> {
    if shape.0 == shape.1 {
        return Ok(Triplets::new(shape.0));
    }
    Err(refuse(format!(
        "a matrix has {} rows and {} columns, but must be square",
        shape.0, shape.1
    )))
}

fn sparse(object: &Bound<'_, PyAny>) -> PyResult<Matrix> {
    let list = object.call_method0("tocoo")?;
    let mut matrix = square(list.getattr("shape")?.extract()?)?;
    let indices = |name: &str| -> PyResult<Vec<i64>> {
        let array: PyArrayLike1<'_, i64, AllowTypeChange> = list.getattr(name)?.extract()?;
        Ok(array.as_array().to_vec())
    };
    let Numbers(values) = list.getattr("data")?.extract()?;
    for ((row, column), value) in indices("row")?.into_iter().zip(indices("col")?).zip(values) {
        let index = |value: i64| {
            usize::try_from(value).map_err(|_| refuse(format!("index {value} of a sparse matrix")))
        };
        matrix.add(index(row)?, index(column)?, value);
    }
    Ok(Matrix(matrix))
}

fn dense(object: &Bound<'_, PyAny>) -> PyResult<Matrix> {
    let array: PyArrayLike2<'_, f64, AllowTypeChange> = object.extract()?;
    let array = array.as_array();
    let mut matrix = square(array.dim())?;
    for ((row, column), &value) in array.indexed_iter() {
        if value != 0.0 {
            matrix.add(row, column, value);
        }
    }
    Ok(Matrix(matrix))
}
