//! Weighted sums of degrees of freedom.

use basemat::structure::{DofCombination, SectionRows, SpaceSection};
use numpy::{PyUntypedArray, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyInt};

use crate::array::{Numbers, whole_numbers};
use crate::error::input_error;
use crate::names::choice;

/// A weighted sum of a structure's degrees of freedom: where a probe reads and a load acts.
///
/// ``terms``: a degree of freedom's number (from 0), a dict ``{dof: weight}``, a list of pairs
/// ``(dof, weight)``, an array of all n weights, or another row. Arguments that are rows may have any of these forms.
/// Rows add, subtract and scale.
#[pyclass(name = "DofCombination", module = "basemat", frozen, eq)]
#[derive(Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct PyDofCombination(pub(crate) DofCombination, pub(crate) WeightCount);

impl PartialEq for PyDofCombination {
    fn eq(&self, other: &Self) -> bool {
        self.0 == other.0
    }
}

impl From<DofCombination> for PyDofCombination {
    fn from(row: DofCombination) -> Self {
        Self(row, WeightCount::default())
    }
}

/// Rows of the core in three directions as objects of Python.
pub(crate) fn python_rows(rows: [DofCombination; 3]) -> [PyDofCombination; 3] {
    rows.map(PyDofCombination::from)
}

/// An argument that is a row, in any of its forms.
pub(crate) struct RowLike(pub(crate) DofCombination, pub(crate) WeightCount);

/// Number of degrees of freedom of the structure that a row belongs to; `None` unless the row was made of all weights.
#[derive(Clone, Copy, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct WeightCount(pub(crate) Option<usize>);

impl WeightCount {
    /// Number of weights of two rows of one structure; an error if the numbers differ.
    pub(crate) fn common_with(self, other: Self) -> PyResult<Self> {
        match (self.0, other.0) {
            (Some(weight_count), Some(other_count)) if weight_count != other_count => {
                Err(input_error(format!(
                    "rows of {weight_count} and of {other_count} weights cannot belong to one structure"
                )))
            }
            _ => Ok(Self(self.0.or(other.0))),
        }
    }

    /// Error unless the row, called `name`, can belong to a structure with so many degrees of freedom.
    pub(crate) fn check(self, name: &str, dof_count: usize) -> PyResult<()> {
        match self.0 {
            Some(weight_count) if weight_count != dof_count => Err(input_error(format!(
                "{name} has an array of {weight_count} weights, but the structure has {dof_count} degrees of freedom"
            ))),
            _ => Ok(()),
        }
    }
}

impl<'py> FromPyObject<'_, 'py> for RowLike {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(row) = object.cast::<PyDofCombination>() {
            let PyDofCombination(row, weight_count) = row.get();
            return Ok(Self(row.clone(), *weight_count));
        }
        if object.is_instance_of::<PyInt>() {
            return Ok(Self(whole_numbers::<usize>(&object)?.into(), WeightCount::default()));
        }
        if let Ok(weights_by_dof) = object.cast::<PyDict>() {
            let terms: Vec<(usize, f64)> = weights_by_dof
                .iter()
                .map(|(dof, weight)| Ok((dof.extract()?, weight.extract()?)))
                .collect::<PyResult<_>>()?;
            return Ok(Self(terms.into(), WeightCount::default()));
        }
        if object.cast::<PyUntypedArray>().is_ok_and(|array| array.ndim() == 1) {
            let Numbers(weights) = object.extract()?;
            let weight_count = WeightCount(Some(weights.len()));
            let terms = weights.into_iter().enumerate().filter(|(_, weight)| *weight != 0.0);
            return Ok(Self(terms.collect(), weight_count));
        }
        if let Ok(dof) = object.extract::<usize>() {
            // An integer of numpy.
            return Ok(Self(dof.into(), WeightCount::default()));
        }
        if let Ok(name) = object.extract::<String>() {
            return Err(input_error(format!(
                "a row is the text '{name}', but must be a number: structure.dof('{name}') returns the row of this name"
            )));
        }
        match object.extract::<Vec<(usize, f64)>>() {
            Ok(terms) => Ok(Self(terms.into(), WeightCount::default())),
            Err(_) => Err(input_error(
                "a row must be a DofCombination, a degree of freedom's number, a dict {dof: weight}, a list of \
                 pairs (dof, weight) or an array of weights",
            )),
        }
    }
}

/// A section's resultant: rows of ``displacement``, ``velocity`` and ``acceleration`` whose sum is a force or a moment.
/// ``unit``: "N/m" (the default) or "N·m/m", in plan "N" or "N·m". `Probe.section` records the sum.
#[pyclass(name = "SectionRows", module = "basemat", frozen)]
pub(crate) struct PySectionRows(pub(crate) SectionRows, pub(crate) WeightCount);

impl From<SectionRows> for PySectionRows {
    fn from(rows: SectionRows) -> Self {
        Self(rows, WeightCount::default())
    }
}

/// Rows of the six resultants of a cut in space.
pub(crate) fn space_sections(section: SpaceSection) -> [PySectionRows; 6] {
    let SpaceSection {
        shear: [shear_x, shear_y],
        compression,
        moments: [moment_x, moment_y],
        torque,
        ..
    } = section;
    [shear_x, shear_y, compression, moment_x, moment_y, torque].map(PySectionRows::from)
}

/// Units of a resultant: a force and a moment per metre of thickness, then a force and a moment of the whole body.
const RESULTANT_UNITS: [&str; 4] = ["N/m", "N·m/m", "N", "N·m"];

#[pymethods]
impl PySectionRows {
    #[pyo3(signature = (displacement, velocity, acceleration, *, unit="N/m"))]
    #[new]
    fn new(
        displacement: RowLike,
        velocity: RowLike,
        acceleration: RowLike,
        unit: &str,
    ) -> PyResult<Self> {
        let unit = choice("unit", unit, &RESULTANT_UNITS.map(|unit| (unit, unit)))?;
        let weight_count = displacement.1.common_with(velocity.1)?.common_with(acceleration.1)?;
        let rows = SectionRows {
            unit,
            displacement: displacement.0,
            velocity: velocity.0,
            acceleration: acceleration.0,
        };
        Ok(Self(rows, weight_count))
    }

    /// SI unit of the resultant: "N/m" or "N·m/m", in plan "N" or "N·m".
    #[getter]
    fn unit(&self) -> &'static str {
        self.0.unit
    }

    /// The `DofCombination` of displacements.
    #[getter]
    fn displacement(&self) -> PyDofCombination {
        PyDofCombination(self.0.displacement.clone(), self.1)
    }

    /// The `DofCombination` of velocities.
    #[getter]
    fn velocity(&self) -> PyDofCombination {
        PyDofCombination(self.0.velocity.clone(), self.1)
    }

    /// The `DofCombination` of accelerations.
    #[getter]
    fn acceleration(&self) -> PyDofCombination {
        PyDofCombination(self.0.acceleration.clone(), self.1)
    }

    fn __getnewargs_ex__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<((PyDofCombination, PyDofCombination, PyDofCombination), Bound<'py, PyDict>)>
    {
        let keywords = PyDict::new(py);
        keywords.set_item("unit", self.0.unit)?;
        Ok(((self.displacement(), self.velocity(), self.acceleration()), keywords))
    }
}
