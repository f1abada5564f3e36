//! Arrays and matrices from and to Python; the memory limit.

use basemat::structure::Triplets;
use numpy::ndarray::{Ix1, Ix2, Ix3};
use numpy::{Complex64, Element, PyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray};
use pyo3::exceptions::PyDeprecationWarning;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict, PyFloat};

use crate::error::input_error;

/// Array of real numbers that numpy makes from an object; an error unless it has as many axes as `shape`.
///
/// Complex numbers, texts and None, which numpy would convert, are errors.
fn real_array<'py, D: numpy::ndarray::Dimension>(
    object: &Bound<'py, PyAny>,
    shape: &str,
) -> PyResult<PyReadonlyArray<'py, f64, D>> {
    if let Ok(array) = object.cast::<PyArray<f64, D>>() {
        return readonly(array);
    }
    let numpy = object.py().import("numpy")?;
    let array = numpy.call_method1("asarray", (object,)).map_err(|error| {
        input_error(format!("no array of numbers, but must be one of shape {shape} ({error})"))
    })?;
    let dtype_kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
    let array = match dtype_kind.as_str() {
        "f" | "i" | "u" | "b" => array,
        "O" => {
            let values = array.call_method0("ravel")?.call_method0("tolist")?;
            let numbers = values.try_iter()?.map(|value| real_number("an entry", &value?));
            let values = numbers.collect::<PyResult<Vec<f64>>>()?;
            let flat_array = numpy.call_method1("array", (values,))?;
            flat_array.call_method1("reshape", (array.getattr("shape")?,))?
        }
        _ => {
            let dtype = array.getattr("dtype")?;
            return Err(input_error(format!("an array of {dtype}, but must be of real numbers")));
        }
    };
    let array = array.call_method1("astype", ("float64",))?;
    if let Ok(array) = array.cast::<PyArray<f64, D>>() {
        return readonly(array);
    }
    let array_shape = array.getattr("shape")?;
    Err(input_error(format!("an array of shape {array_shape}, but must be of shape {shape}")))
}

/// The array for reading; an error while it is being written.
fn readonly<'py, T: Element, D: numpy::ndarray::Dimension>(
    array: &Bound<'py, PyArray<T, D>>,
) -> PyResult<PyReadonlyArray<'py, T, D>> {
    Ok(array.try_readonly()?)
}

/// The real number of an object; an error for complex numbers, whose imaginary part numpy drops, and for texts.
pub(crate) fn real_number(name: &str, value: &Bound<'_, PyAny>) -> PyResult<f64> {
    if let Ok(number) = value.cast::<PyFloat>() {
        return Ok(number.value());
    }
    let numpy = value.py().import("numpy")?;
    let is_complex = numpy.call_method1("iscomplexobj", (value,))?.is_truthy()?;
    let number = if is_complex { None } else { value.extract::<f64>().ok() };
    match number {
        Some(number) => Ok(number),
        None => Err(input_error(format!("{name} is {}, but must be a real number", value.repr()?))),
    }
}

/// Extracts whole numbers of 0 or more: one number, or a list of numbers.
pub(crate) fn whole_numbers<'py, T>(object: &Bound<'py, PyAny>) -> PyResult<T>
where
    T: for<'a> FromPyObject<'a, 'py>,
{
    if let Ok(numbers) = object.extract() {
        return Ok(numbers);
    }
    let object_text = object.repr()?;
    Err(input_error(format!("{object_text}, but must be whole numbers of 0 or more")))
}

/// New array of numpy with these `values`; a `MemoryError` if it does not fit.
pub(crate) fn filled_array<T: Element>(
    py: Python<'_>,
    shape: [usize; 2],
    values: impl Iterator<Item = T>,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let numpy = py.import("numpy")?;
    let array = numpy.call_method1("empty", (shape, numpy::dtype::<T>(py)))?;
    let array = array.cast_into::<PyArray2<T>>()?;
    let mut view = array.try_readwrite()?;
    for (entry, value) in view.as_slice_mut()?.iter_mut().zip(values) {
        *entry = value;
    }
    drop(view);
    Ok(array)
}

/// Extracts `N` whole numbers of 0 or more.
pub(crate) fn whole_array<const N: usize>(object: &Bound<'_, PyAny>) -> PyResult<[usize; N]> {
    let numbers: Vec<usize> = whole_numbers(object)?;
    let number_count = numbers.len();
    numbers
        .try_into()
        .map_err(|_| input_error(format!("{number_count} numbers, but must be {N}")))
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

/// A complex number as a number of numpy.
pub(crate) fn numpy_complex(value: basemat::Complex) -> Complex64 {
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
pub(crate) struct OrderedDict<K, V>(pub(crate) Vec<(K, V)>);

impl<K, V> FromIterator<(K, V)> for OrderedDict<K, V> {
    fn from_iter<I: IntoIterator<Item = (K, V)>>(pairs: I) -> Self {
        Self(pairs.into_iter().collect())
    }
}

impl<'py, K: IntoPyObject<'py>, V: IntoPyObject<'py>> IntoPyObject<'py> for OrderedDict<K, V> {
    type Target = PyDict;
    type Output = Bound<'py, PyDict>;
    type Error = PyErr;

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Self::Output> {
        self.0.into_py_dict(py)
    }
}

/// An index or a count: a whole number of 0 or more.
#[derive(Clone, Copy)]
pub(crate) struct Count(pub(crate) usize);

extracts!(Count, object => Ok(Self(whole_numbers(&object)?)));

/// Numbers: anything that numpy converts to an array of shape (n,).
pub(crate) struct Numbers(pub(crate) Vec<f64>);

extracts!(Numbers, object => Ok(Self(real_array::<Ix1>(&object, "(n,)")?.as_array().to_vec())));

/// Pairs of numbers: anything that numpy converts to an array of shape (n, 2).
pub(crate) struct Pairs(pub(crate) Vec<[f64; 2]>);

extracts!(Pairs, object => {
    let Table { column_count, rows } = Table::read(&object, "(n, 2)")?;
    let pairs = rows.into_iter().map(<[f64; 2]>::try_from).collect::<Result<Vec<_>, _>>();
    Ok(Self(pairs.map_err(|row| {
        input_error(format!("an array of {column_count} columns, but must be of shape (n, 2): {row:?}"))
    })?))
});

/// Points in the plane or in space: anything that numpy converts to an array of shape (n, 2) or (n, 3).
pub(crate) struct Points {
    /// Number of coordinates of a point, two or three.
    axis_count: usize,
    rows: Vec<Vec<f64>>,
}

extracts!(Points, object => {
    let Table { column_count, rows } = Table::read(&object, "(n, 3), or (n, 2) in the plane")?;
    if !(column_count == 2 || column_count == 3) {
        let requirement = "must be of shape (n, 3), or (n, 2) in the plane";
        return Err(input_error(format!("an array of {column_count} columns, but {requirement}")));
    }
    Ok(Self { axis_count: column_count, rows })
});

impl Points {
    /// Coordinates [x, y, z], with z = 0 for points in the plane.
    pub(crate) fn coordinates(self) -> Vec<[f64; 3]> {
        let rows = self.rows.iter();
        rows.map(|row| [row[0], row[1], row.get(2).copied().unwrap_or_default()]).collect()
    }

    /// Number of coordinates of a point, two or three.
    pub(crate) fn axis_count(&self) -> usize {
        self.axis_count
    }

    /// Coordinates [x, y, z]; an error for points of two coordinates.
    pub(crate) fn in_space(self) -> PyResult<Vec<[f64; 3]>> {
        if self.axis_count == 3 {
            return Ok(self.coordinates());
        }
        Err(input_error("an array of 2 columns, but must have 3 in space: x, y and z"))
    }
}

/// Points in rows and columns: anything that numpy converts to an array of shape (rows, columns, 3).
pub(crate) struct PointGrid {
    /// Numbers of rows and columns.
    pub(crate) shape: [usize; 2],
    /// Row after row.
    pub(crate) points: Vec<[f64; 3]>,
}

extracts!(PointGrid, object => {
    let shape = "(rows, columns, 3)";
    let array = real_array::<Ix3>(&object, shape)?;
    let array = array.as_array();
    let (row_count, column_count, axis_count) = array.dim();
    if axis_count != 3 {
        let array_shape = array.dim();
        return Err(input_error(format!("an array of shape {array_shape:?}, but must be of shape {shape}")));
    }
    let points = array.rows().into_iter().map(|point| [point[0], point[1], point[2]]).collect();
    Ok(Self { shape: [row_count, column_count], points })
});

/// Rows of numbers: anything that numpy converts to an array of two axes.
pub(crate) struct Table {
    pub(crate) column_count: usize,
    pub(crate) rows: Vec<Vec<f64>>,
}

impl Table {
    pub(crate) fn read(object: &Bound<'_, PyAny>, shape: &str) -> PyResult<Self> {
        let array = real_array::<Ix2>(object, shape)?;
        let array = array.as_array();
        let rows = array.rows().into_iter().map(|row| row.to_vec()).collect();
        Ok(Self { column_count: array.ncols(), rows })
    }
}

/// A square matrix: dense, or any of `scipy.sparse`. Zeros of a dense matrix are dropped.
pub(crate) struct Matrix(pub(crate) Triplets);

extracts!(Matrix, object => {
    if object.hasattr("tocoo")? { sparse_matrix(&object) } else { dense_matrix(&object) }
});

/// An empty matrix of this shape, which must be square.
fn empty_square(shape: (usize, usize)) -> PyResult<Triplets> {
    if shape.0 == shape.1 {
        return Ok(Triplets::new(shape.0));
    }
    Err(input_error(format!("a matrix of shape {shape:?}, but must be square")))
}

fn sparse_matrix(object: &Bound<'_, PyAny>) -> PyResult<Matrix> {
    let entries = object.call_method0("tocoo")?;
    let mut matrix = empty_square(entries.getattr("shape")?.extract()?)?;
    let rows = sparse_indices(&entries, "row")?;
    let columns = sparse_indices(&entries, "col")?;
    let Numbers(values) = entries.getattr("data")?.extract()?;
    for ((row, column), value) in rows.into_iter().zip(columns).zip(values) {
        matrix.add(row, column, value);
    }
    Ok(Matrix(matrix))
}

/// Indices of rows or columns of the entries of a sparse matrix.
fn sparse_indices(entries: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<usize>> {
    let indices = entries.getattr(name)?.call_method0("tolist")?;
    indices
        .extract()
        .map_err(|error| input_error(format!("indices of a sparse matrix: {error}")))
}

fn dense_matrix(object: &Bound<'_, PyAny>) -> PyResult<Matrix> {
    let array = real_array::<Ix2>(object, "(n, n)")?;
    let array = array.as_array();
    let mut matrix = empty_square(array.dim())?;
    for ((row, column), &value) in array.indexed_iter() {
        if value != 0.0 {
            matrix.add(row, column, value);
        }
    }
    Ok(Matrix(matrix))
}

/// Largest memory of one mesh, matrix, ground, record or sweep, bytes: 8 GiB. The needed memory is compared with this
/// limit before it is allocated; the error states the needed memory.
#[pyfunction]
pub(crate) fn memory_limit() -> u64 {
    basemat::memory_limit()
}

/// Deprecated: warns and has no effect, since the `memory_limit` is fixed. ``bytes`` is ignored.
#[pyfunction]
pub(crate) fn set_memory_limit(
    py: Python<'_>,
    #[pyo3(from_py_with = whole_numbers)] bytes: u64,
) -> PyResult<()> {
    let _ = bytes;
    let category = py.get_type::<PyDeprecationWarning>();
    PyErr::warn(py, &category, c"set_memory_limit does nothing: the limit of one part is fixed", 1)
}
