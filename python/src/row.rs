//! Weighted sums of unknowns.

use basemat::structure::{Row, SectionRows};
use numpy::{PyArray1, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyInt};

use crate::array::Numbers;
use crate::error::{OrRaise, refuse};
use crate::structure;

/// A weighted sum of a structure's unknowns, ``Σ weight · unknown``: where a probe reads and a load
/// acts.
///
/// Rows add, subtract and scale. Wherever a row is asked for, an unknown's number, a dict
/// ``{unknown: weight}``, a list of pairs ``(unknown, weight)`` or an array of all n weights will do.
#[pyclass(name = "Row", module = "basemat", frozen, eq)]
#[derive(Clone, PartialEq)]
pub(crate) struct PyRow(pub(crate) Row);

/// A row in any of the forms that Python may give it.
pub(crate) struct RowLike(pub(crate) Row);

impl<'py> FromPyObject<'_, 'py> for RowLike {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(row) = object.cast::<PyRow>() {
            return Ok(Self(row.get().0.clone()));
        }
        if object.is_instance_of::<PyInt>() {
            return Ok(Self(object.extract::<usize>()?.into()));
        }
        if let Ok(terms) = object.cast::<PyDict>() {
            let terms: Vec<(usize, f64)> = terms
                .iter()
                .map(|(k, w)| Ok((k.extract()?, w.extract()?)))
                .collect::<PyResult<_>>()?;
            return Ok(Self(terms.into()));
        }
        if object.cast::<PyUntypedArray>().is_ok_and(|array| array.ndim() == 1) {
            let Numbers(weights) = object.extract()?;
            let terms = weights.into_iter().enumerate().filter(|(_, weight)| *weight != 0.0);
            return Ok(Self(terms.collect()));
        }
        if let Ok(unknown) = object.extract::<usize>() {
            // Integers of numpy.
            return Ok(Self(unknown.into()));
        }
        match object.extract::<Vec<(usize, f64)>>() {
            Ok(terms) => Ok(Self(terms.into())),
            Err(_) => Err(refuse(
                "a row must be a Row, an unknown's number, a dict {unknown: weight}, a list of \
                 pairs (unknown, weight) or an array of weights",
            )),
        }
    }
}

#[pymethods]
impl PyRow {
    #[new]
    fn new(terms: RowLike) -> Self {
        Self(terms.0)
    }

    /// Pairs ``(unknown, weight)``.
    #[getter]
    fn terms(&self) -> Vec<(usize, f64)> {
        self.0.terms().to_vec()
    }

    /// The sum for given unknowns (array of shape (n,)).
    fn value(&self, unknowns: Numbers) -> PyResult<f64> {
        let Numbers(unknowns) = unknowns;
        if let Some((index, _)) = self.0.iter().find(|(index, _)| *index >= unknowns.len()) {
            return Err(refuse(format!("unknown {index} of a row, of {} given", unknowns.len())));
        }
        Ok(self.0.value(&unknowns))
    }

    /// All n weights as an array of shape (n,).
    fn weights<'py>(
        &self,
        py: Python<'py>,
        unknowns: usize,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let mut weights = Vec::new();
        weights.try_reserve_exact(unknowns).map_err(|_| {
            PyMemoryError::new_err(format!("an array of {unknowns} weights does not fit"))
        })?;
        weights.resize(unknowns, 0.0);
        for &(index, weight) in &self.0 {
            *weights
                .get_mut(index)
                .ok_or_else(|| refuse(format!("unknown {index} of a row, of {unknowns}")))? +=
                weight;
        }
        Ok(PyArray1::from_vec(py, weights))
    }

    /// This displacement to the right less that of the middle of the structure's base.
    fn relative_to_base(&self, structure: Bound<'_, PyAny>) -> PyResult<Self> {
        let structure = structure::recipe(&structure)?().or_raise()?;
        Ok(Self(self.0.relative_to_base(structure.as_ref()).or_raise()?))
    }

    /// The same less what the base's rotation makes of it at ``height`` (m): the sway.
    fn sway(&self, structure: Bound<'_, PyAny>, height: f64) -> PyResult<Self> {
        let structure = structure::recipe(&structure)?().or_raise()?;
        Ok(Self(self.0.sway(structure.as_ref(), height).or_raise()?))
    }

    fn __add__(&self, other: RowLike) -> Self {
        Self(self.0.clone() + other.0)
    }

    fn __sub__(&self, other: RowLike) -> Self {
        Self(self.0.clone() - other.0)
    }

    fn __neg__(&self) -> Self {
        Self(-self.0.clone())
    }

    fn __mul__(&self, factor: f64) -> Self {
        Self(factor * self.0.clone())
    }

    fn __rmul__(&self, factor: f64) -> Self {
        self.__mul__(factor)
    }

    fn __truediv__(&self, divisor: f64) -> Self {
        self.__mul__(1.0 / divisor)
    }

    fn __repr__(&self) -> String {
        format!("Row({:?})", self.0.terms())
    }

    fn __getnewargs__(&self) -> (Vec<(usize, f64)>,) {
        (self.terms(),)
    }
}

/// A section's resultant: weighted sums of displacements, velocities and accelerations that give a
/// force (N/m) or a moment (N·m/m). For :meth:`Probe.section`.
#[pyclass(name = "SectionRows", module = "basemat", frozen)]
pub(crate) struct PySectionRows(pub(crate) SectionRows);

#[pymethods]
impl PySectionRows {
    #[new]
    #[pyo3(signature = (displacement, velocity, acceleration, *, unit="N/m"))]
    fn new(
        displacement: RowLike,
        velocity: RowLike,
        acceleration: RowLike,
        unit: &str,
    ) -> PyResult<Self> {
        let unit = match unit {
            "N/m" => "N/m",
            "N·m/m" => "N·m/m",
            _ => return Err(refuse(format!("unit is '{unit}', but must be 'N/m' or 'N·m/m'"))),
        };
        let (displacement, velocity, acceleration) = (displacement.0, velocity.0, acceleration.0);
        Ok(Self(SectionRows { unit, displacement, velocity, acceleration }))
    }

    fn __getnewargs_ex__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<((PyRow, PyRow, PyRow), Bound<'py, PyDict>)> {
        let unit = PyDict::new(py);
        unit.set_item("unit", self.0.unit)?;
        Ok(((self.displacement(), self.velocity(), self.acceleration()), unit))
    }

    /// SI unit of the resultant.
    #[getter]
    fn unit(&self) -> &'static str {
        self.0.unit
    }

    /// Weights of the displacements.
    #[getter]
    fn displacement(&self) -> PyRow {
        PyRow(self.0.displacement.clone())
    }

    /// Weights of the velocities.
    #[getter]
    fn velocity(&self) -> PyRow {
        PyRow(self.0.velocity.clone())
    }

    /// Weights of the accelerations.
    #[getter]
    fn acceleration(&self) -> PyRow {
        PyRow(self.0.acceleration.clone())
    }
}
