//! Weighted sums of degrees of freedom.

use basemat::structure::{DofCombination, SectionRows};
use numpy::{PyArray1, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyInt};

use crate::array::{Numbers, whole};
use crate::error::{OrRaise, refuse};
use crate::structure;

/// A weighted sum of a structure's degrees of freedom: where a probe reads and a load acts.
///
/// ``terms``: a degree of freedom's number (from 0), a dict ``{dof: weight}``, a list of pairs
/// ``(dof, weight)``, an array of all n weights, or another row. All of these will do wherever a row
/// is asked for. Rows add, subtract and scale.
#[pyclass(name = "DofCombination", module = "basemat", frozen, eq)]
#[derive(Clone)]
pub(crate) struct PyDofCombination(pub(crate) DofCombination, pub(crate) Order);

impl PartialEq for PyDofCombination {
    fn eq(&self, other: &Self) -> bool {
        self.0 == other.0
    }
}

impl From<DofCombination> for PyDofCombination {
    fn from(row: DofCombination) -> Self {
        Self(row, Order::default())
    }
}

/// A row in any of the forms that Python may give it.
pub(crate) struct RowLike(pub(crate) DofCombination, pub(crate) Order);

/// The number of degrees of freedom of the structure that a row is for, known if it was given all weights.
#[derive(Clone, Copy, Default)]
pub(crate) struct Order(Option<usize>);

impl Order {
    /// That of two rows for one structure.
    pub(crate) fn and(self, other: Self) -> PyResult<Self> {
        match (self.0, other.0) {
            (Some(one), Some(two)) if one != two => {
                Err(refuse(format!("rows of {one} and of {two} weights are for no one structure")))
            }
            _ => Ok(Self(self.0.or(other.0))),
        }
    }

    /// Refuses a row for another structure; `name` says whose it is.
    pub(crate) fn check(self, name: &str, dofs: usize) -> PyResult<()> {
        match self.0 {
            Some(weights) if weights != dofs => Err(refuse(format!(
                "{name} has an array of {weights} weights, but the structure has {dofs} degrees of freedom"
            ))),
            _ => Ok(()),
        }
    }
}

impl<'py> FromPyObject<'_, 'py> for RowLike {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(row) = object.cast::<PyDofCombination>() {
            let PyDofCombination(row, order) = row.get();
            return Ok(Self(row.clone(), *order));
        }
        if object.is_instance_of::<PyInt>() {
            return Ok(Self(whole::<usize>(&object)?.into(), Order::default()));
        }
        if let Ok(terms) = object.cast::<PyDict>() {
            let terms: Vec<(usize, f64)> = terms
                .iter()
                .map(|(k, w)| Ok((k.extract()?, w.extract()?)))
                .collect::<PyResult<_>>()?;
            return Ok(Self(terms.into(), Order::default()));
        }
        if object.cast::<PyUntypedArray>().is_ok_and(|array| array.ndim() == 1) {
            let Numbers(weights) = object.extract()?;
            let order = Order(Some(weights.len()));
            let terms = weights.into_iter().enumerate().filter(|(_, weight)| *weight != 0.0);
            return Ok(Self(terms.collect(), order));
        }
        if let Ok(unknown) = object.extract::<usize>() {
            // Integers of numpy.
            return Ok(Self(unknown.into(), Order::default()));
        }
        match object.extract::<Vec<(usize, f64)>>() {
            Ok(terms) => Ok(Self(terms.into(), Order::default())),
            Err(_) => Err(refuse(
                "a row must be a DofCombination, a degree of freedom's number, a dict {dof: weight}, a list of \
                 pairs (dof, weight) or an array of weights",
            )),
        }
    }
}

#[pymethods]
impl PyDofCombination {
    #[new]
    fn new(terms: RowLike) -> Self {
        Self(terms.0, terms.1)
    }

    /// List of pairs ``(dof, weight)``.
    #[getter]
    fn terms(&self) -> Vec<(usize, f64)> {
        self.0.terms().to_vec()
    }

    /// The sum for given degrees of freedom: ``dofs`` is an array of shape (n,); in their unit.
    fn value(&self, dofs: Numbers) -> PyResult<f64> {
        let Numbers(dofs) = dofs;
        self.1.check("the row", dofs.len())?;
        if let Some((index, _)) = self.0.iter().find(|(index, _)| *index >= dofs.len()) {
            return Err(refuse(format!("unknown {index} of a row, of {} given", dofs.len())));
        }
        Ok(self.0.value(&dofs))
    }

    /// All weights as an array of shape (n,) for a number n of degrees of freedom, ``dofs``.
    fn weights<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = whole)] dofs: usize,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.1.check("the row", dofs)?;
        let mut weights = Vec::new();
        weights.try_reserve_exact(dofs).map_err(|_| {
            PyMemoryError::new_err(format!("an array of {dofs} weights does not fit"))
        })?;
        weights.resize(dofs, 0.0);
        for &(index, weight) in &self.0 {
            *weights
                .get_mut(index)
                .ok_or_else(|| refuse(format!("unknown {index} of a row, of {dofs}")))? += weight;
        }
        Ok(PyArray1::from_vec(py, weights))
    }

    /// This displacement to the right less that of the middle of the base of the ``structure``.
    fn relative_to_base(&self, structure: Bound<'_, PyAny>) -> PyResult<Self> {
        let structure = structure::recipe(&structure)?().or_raise()?;
        self.1.check("the row", structure.dofs())?;
        Ok(Self(self.0.relative_to_base(structure.as_ref()).or_raise()?, self.1))
    }

    /// This displacement to the right less that of the base of the ``structure``, its rotation included,
    /// which moves what is ``height`` (m) above it: the lateral deformation.
    fn total_drift(&self, structure: Bound<'_, PyAny>, height: f64) -> PyResult<Self> {
        let structure = structure::recipe(&structure)?().or_raise()?;
        self.1.check("the row", structure.dofs())?;
        Ok(Self(self.0.total_drift(structure.as_ref(), height).or_raise()?, self.1))
    }

    fn __add__(&self, other: RowLike) -> PyResult<Self> {
        Ok(Self(self.0.clone() + other.0, self.1.and(other.1)?))
    }

    fn __sub__(&self, other: RowLike) -> PyResult<Self> {
        Ok(Self(self.0.clone() - other.0, self.1.and(other.1)?))
    }

    fn __neg__(&self) -> Self {
        Self(-self.0.clone(), self.1)
    }

    fn __mul__(&self, factor: f64) -> Self {
        Self(factor * self.0.clone(), self.1)
    }

    fn __rmul__(&self, factor: f64) -> Self {
        self.__mul__(factor)
    }

    fn __truediv__(&self, divisor: f64) -> Self {
        self.__mul__(1.0 / divisor)
    }

    fn __repr__(&self) -> String {
        format!("DofCombination({:?})", self.0.terms())
    }

    fn __getnewargs__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>,)> {
        match self.1.0 {
            Some(dofs) => Ok((self.weights(py, dofs)?.into_any(),)),
            None => Ok((self.terms().into_pyobject(py)?,)),
        }
    }
}

/// A section's resultant: rows of ``displacement``, ``velocity`` and ``acceleration`` whose sum is a
/// force (N/m) or a moment (N·m/m). ``unit``: "N/m" (the default) or "N·m/m". For
/// :meth:`Probe.section`.
#[pyclass(name = "SectionRows", module = "basemat", frozen)]
pub(crate) struct PySectionRows(pub(crate) SectionRows, pub(crate) Order);

impl From<SectionRows> for PySectionRows {
    fn from(rows: SectionRows) -> Self {
        Self(rows, Order::default())
    }
}

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
        let order = displacement.1.and(velocity.1)?.and(acceleration.1)?;
        let (displacement, velocity, acceleration) = (displacement.0, velocity.0, acceleration.0);
        Ok(Self(SectionRows { unit, displacement, velocity, acceleration }, order))
    }

    fn __getnewargs_ex__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<((PyDofCombination, PyDofCombination, PyDofCombination), Bound<'py, PyDict>)>
    {
        let unit = PyDict::new(py);
        unit.set_item("unit", self.0.unit)?;
        Ok(((self.displacement(), self.velocity(), self.acceleration()), unit))
    }

    /// SI unit of the resultant: "N/m" or "N·m/m".
    #[getter]
    fn unit(&self) -> &'static str {
        self.0.unit
    }

    /// The :class:`DofCombination` of displacements.
    #[getter]
    fn displacement(&self) -> PyDofCombination {
        PyDofCombination(self.0.displacement.clone(), self.1)
    }

    /// The :class:`DofCombination` of velocities.
    #[getter]
    fn velocity(&self) -> PyDofCombination {
        PyDofCombination(self.0.velocity.clone(), self.1)
    }

    /// The :class:`DofCombination` of accelerations.
    #[getter]
    fn acceleration(&self) -> PyDofCombination {
        PyDofCombination(self.0.acceleration.clone(), self.1)
    }
}
