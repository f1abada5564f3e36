//! Arrays and matrices that come from Python, and the memory that they may take.

use basemat::structure::Triplets;
use numpy::ndarray::{Ix1, Ix2, Ix3};
use numpy::{Complex64, Element, PyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict, PyFloat};

use crate::error::refuse;

/// Anything that numpy takes for an array of real numbers, of as many axes as `shape` names.
///
/// Numpy by itself would cut the imaginary part off complex numbers, read texts as numbers and take
/// None for NaN.
fn reals<'py, D: numpy::ndarray::Dimension>(
    object: &Bound<'py, PyAny>,
    shape: &str,
) -> PyResult<PyReadonlyArray<'py, f64, D>> {
    if let Ok(array) = object.cast::<PyArray<f64, D>>() {
        return readonly(array);
    }
    let numpy = object.py().import("numpy")?;
    let array = numpy.call_method1("asarray", (object,)).map_err(|error| {
        refuse(format!("no array of numbers, but must be one of shape {shape} ({error})"))
    })?;
    let kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
    let array = match kind.as_str() {
        "f" | "i" | "u" | "b" => array,
        "O" => {
            let values = array.call_method0("ravel")?.call_method0("tolist")?;
            let each = values.try_iter()?.map(|value| real("an entry", &value?));
            let values = each.collect::<PyResult<Vec<f64>>>()?;
            let list = numpy.call_method1("array", (values,))?;
            list.call_method1("reshape", (array.getattr("shape")?,))?
        }
        _ => {
            let found = array.getattr("dtype")?;
            return Err(refuse(format!("an array of {found}, but must be of real numbers")));
        }
    };
    let array = array.call_method1("astype", ("float64",))?;
    if let Ok(array) = array.cast::<PyArray<f64, D>>() {
        return readonly(array);
    }
    let found = array.getattr("shape")?;
    Err(refuse(format!("an array of shape {found}, but must be of shape {shape}")))
}

fn readonly<'py, T: Element, D: numpy::ndarray::Dimension>(
    array: &Bound<'py, PyArray<T, D>>,
) -> PyResult<PyReadonlyArray<'py, T, D>> {
    Ok(array.try_readonly()?)
}

/// A real number: not complex, whose imaginary part numpy's scalars drop, and no text.
pub(crate) fn real(name: &str, value: &Bound<'_, PyAny>) -> PyResult<f64> {
    if let Ok(number) = value.cast::<PyFloat>() {
        return Ok(number.value());
    }
    let numpy = value.py().import("numpy")?;
    let complex = numpy.call_method1("iscomplexobj", (value,))?.is_truthy()?;
    let number = if complex { None } else { value.extract::<f64>().ok() };
    match number {
        Some(number) => Ok(number),
        None => Err(refuse(format!("{name} is {}, but must be a real number", value.repr()?))),
    }
}

/// Whole numbers from 0 on: a count, an index, or a list of them.
pub(crate) fn whole<'py, T>(object: &Bound<'py, PyAny>) -> PyResult<T>
where
    T: for<'a> FromPyObject<'a, 'py>,
{
    if let Ok(found) = object.extract() {
        return Ok(found);
    }
    let found = object.repr()?;
    Err(refuse(format!("{found}, but only whole numbers from 0 on will do")))
}

/// An array of this shape of `values`, in a memory that numpy allocates: it raises a `MemoryError` if there is too little.
pub(crate) fn filled<T: Element>(
    py: Python<'_>,
    shape: [usize; 2],
    values: impl Iterator<Item = T>,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let numpy = py.import("numpy")?;
    let array = numpy.call_method1("empty", (shape, numpy::dtype::<T>(py)))?;
    let array = array.cast_into::<PyArray2<T>>()?;
    array.try_readwrite()?.as_slice_mut()?.iter_mut().zip(values).for_each(|(to, own)| *to = own);
    Ok(array)
}

/// As many whole numbers from 0 on as a base has directions.
pub(crate) fn wholes<const N: usize>(object: &Bound<'_, PyAny>) -> PyResult<[usize; N]> {
    let found: Vec<usize> = whole(object)?;
    let count = found.len();
    found.try_into().map_err(|_| refuse(format!("{count} numbers, but must be {N}")))
}

/// Numbers that Python gets as an array of shape (n,).
pub(crate) struct Array<T = f64>(Vec<T>);

impl<T> FromIterator<T> for Array<T> {
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Self {
        Self(values.into_iter().collect())
    }
}

impl<T: Copy> From<&[T]> for Array<T> {
    fn from(values: &[T]) -> Self {
        Self(values.to_vec())
    }
}

impl<T> From<Vec<T>> for Array<T> {
    fn from(values: Vec<T>) -> Self {
        Self(values)
    }
}

impl<'py, T: Element> IntoPyObject<'py> for Array<T> {
    type Target = PyArray1<T>;
    type Output = Bound<'py, Self::Target>;
    type Error = std::convert::Infallible;

    fn into_pyobject(self, py: Python<'py>) -> Result<Self::Output, Self::Error> {
        Ok(PyArray1::from_vec(py, self.0))
    }
}

/// A complex number as numpy has it.
pub(crate) fn complex(value: basemat::Complex) -> Complex64 {
    Complex64::new(value.re, value.im)
}

/// Rows that Python gets as an array of two axes.
pub(crate) struct Rows(pub(crate) Vec<Vec<f64>>);

impl<'py> IntoPyObject<'py> for Rows {
    type Target = PyArray2<f64>;
    type Output = Bound<'py, Self::Target>;
    type Error = PyErr;

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Self::Output> {
        Ok(PyArray2::from_vec2(py, &self.0)?)
    }
}

/// Pairs of keys and values that Python gets as a dict, in this order.
pub(crate) struct Named<K, V>(pub(crate) Vec<(K, V)>);

impl<K, V> FromIterator<(K, V)> for Named<K, V> {
    fn from_iter<I: IntoIterator<Item = (K, V)>>(pairs: I) -> Self {
        Self(pairs.into_iter().collect())
    }
}

impl<'py, K: IntoPyObject<'py>, V: IntoPyObject<'py>> IntoPyObject<'py> for Named<K, V> {
    type Target = PyDict;
    type Output = Bound<'py, PyDict>;
    type Error = PyErr;

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Self::Output> {
        self.0.into_py_dict(py)
    }
}

/// A number of a part, an index or a count.
#[derive(Clone, Copy)]
pub(crate) struct Count(pub(crate) usize);

extracts!(Count, object => Ok(Self(whole(&object)?)));

/// Numbers of anything that numpy takes for a list of them.
pub(crate) struct Numbers(pub(crate) Vec<f64>);

extracts!(Numbers, object => Ok(Self(reals::<Ix1>(&object, "(n,)")?.as_array().to_vec())));

/// Pairs of numbers: anything that numpy takes for an array of shape (n, 2).
pub(crate) struct Pairs(pub(crate) Vec<[f64; 2]>);

extracts!(Pairs, object => {
    let Table { columns, rows } = Table::read(&object, "(n, 2)")?;
    let pairs = rows.into_iter().map(<[f64; 2]>::try_from).collect::<Result<Vec<_>, _>>();
    Ok(Self(pairs.map_err(|row| {
        refuse(format!("an array of {columns} columns, but must be of shape (n, 2): {row:?}"))
    })?))
});

/// Points in the plane or in space: anything that numpy takes for an array of shape (n, 2) or (n, 3).
pub(crate) struct Points {
    columns: usize,
    rows: Vec<Vec<f64>>,
}

extracts!(Points, object => {
    let Table { columns, rows } = Table::read(&object, "(n, 3), or (n, 2) in the plane")?;
    if !(columns == 2 || columns == 3) {
        let needed = "must be of shape (n, 3), or (n, 2) in the plane";
        return Err(refuse(format!("an array of {columns} columns, but {needed}")));
    }
    Ok(Self { columns, rows })
});

impl Points {
    /// Places [x, y, z], with z = 0 for points in the plane.
    pub(crate) fn in_plane(self) -> Vec<[f64; 3]> {
        let z = |row: &Vec<f64>| row.get(2).copied().unwrap_or_default();
        self.rows.iter().map(|row| [row[0], row[1], z(row)]).collect()
    }

    /// Number of coordinates, two or three, and places [x, y, z].
    pub(crate) fn places(self) -> (usize, Vec<[f64; 3]>) {
        (self.columns, self.in_plane())
    }

    /// Places [x, y, z]; an error for points of two coordinates.
    pub(crate) fn in_space(self) -> PyResult<Vec<[f64; 3]>> {
        if self.columns == 3 {
            return Ok(self.in_plane());
        }
        Err(refuse("an array of 2 columns, but must have 3 in space: x, y and z"))
    }
}

/// Points in rows and columns: anything that numpy takes for an array of shape (rows, columns, 3).
pub(crate) struct Surface {
    /// Numbers of rows and columns.
    pub(crate) shape: [usize; 2],
    /// Row after row.
    pub(crate) points: Vec<[f64; 3]>,
}

extracts!(Surface, object => {
    let shape = "(rows, columns, 3)";
    let array = reals::<Ix3>(&object, shape)?;
    let (rows, columns, axes) = array.as_array().dim();
    if axes != 3 {
        let found = format!("({rows}, {columns}, {axes})");
        return Err(refuse(format!("an array of shape {found}, but must be of shape {shape}")));
    }
    let array = array.as_array();
    let points = array.rows().into_iter().map(|point| [point[0], point[1], point[2]]).collect();
    Ok(Self { shape: [rows, columns], points })
});

/// Rows of numbers: anything that numpy takes for an array of two axes.
pub(crate) struct Table {
    pub(crate) columns: usize,
    pub(crate) rows: Vec<Vec<f64>>,
}

impl Table {
    pub(crate) fn read(object: &Bound<'_, PyAny>, shape: &str) -> PyResult<Self> {
        let array = reals::<Ix2>(object, shape)?;
        let array = array.as_array();
        let rows = array.rows().into_iter().map(|row| row.to_vec()).collect();
        Ok(Self { columns: array.ncols(), rows })
    }
}

/// A square matrix: dense, or any of `scipy.sparse`. Entries of zero are left out.
pub(crate) struct Matrix(pub(crate) Triplets);

extracts!(Matrix, object => {
    if object.hasattr("tocoo")? { sparse(&object) } else { dense(&object) }
});

fn square(shape: (usize, usize)) -> PyResult<Triplets> {
    if shape.0 == shape.1 {
        return Ok(Triplets::new(shape.0));
    }
    Err(refuse(format!("a matrix of shape {shape:?}, but must be square")))
}

fn sparse(object: &Bound<'_, PyAny>) -> PyResult<Matrix> {
    let list = object.call_method0("tocoo")?;
    let mut matrix = square(list.getattr("shape")?.extract()?)?;
    let indices = |name: &str| -> PyResult<Vec<usize>> {
        let whole = list.getattr(name)?.call_method0("tolist")?;
        whole.extract().map_err(|error| refuse(format!("indices of a sparse matrix: {error}")))
    };
    let Numbers(values) = list.getattr("data")?.extract()?;
    for ((row, column), value) in indices("row")?.into_iter().zip(indices("col")?).zip(values) {
        matrix.add(row, column, value);
    }
    Ok(Matrix(matrix))
}

fn dense(object: &Bound<'_, PyAny>) -> PyResult<Matrix> {
    let array = reals::<Ix2>(object, "(n, n)")?;
    let array = array.as_array();
    let mut matrix = square(array.dim())?;
    for ((row, column), &value) in array.indexed_iter() {
        if value != 0.0 {
            matrix.add(row, column, value);
        }
    }
    Ok(Matrix(matrix))
}

/// Most memory (bytes) that the size of one mesh, matrix, ground, record or sweep may ask for;
/// 4 GiB unless `set_memory_limit` was called.
#[pyfunction]
pub(crate) fn memory_limit() -> u64 {
    basemat::memory_limit()
}

/// Sets the limit for this process to so many ``bytes``: what the machine has, less what else runs on it.
/// Sizes are held against it before anything is allocated, and raise an error that says what they would take.
#[pyfunction]
pub(crate) fn set_memory_limit(#[pyo3(from_py_with = whole)] bytes: u64) {
    basemat::set_memory_limit(bytes);
}
