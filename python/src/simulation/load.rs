//! External loads on a structure.

use std::sync::Arc;

use basemat::coupled::Load;
use pyo3::prelude::*;

use crate::array::{Numbers, real_number};
use crate::error::{OrRaise, call_user_code, input_error};
use crate::motion::PyRecord;
use crate::recipe::Factory;
use crate::row::{RowLike, WeightCount};

/// A force that acts on a structure from outside.
///
/// ``row``: where it acts, a `DofCombination` or its ``terms``. ``value``: a function of time (s) that returns the
/// force (N/m; on a rotation a moment, N·m/m); it may raise an exception. In plan forces are in N and moments in N·m.
/// Its value at t = 0 belongs to the static state: it is applied slowly after the weight, while the interface law acts.
#[pyclass(name = "Load", module = "basemat", frozen, dict)]
pub(crate) struct PyLoad {
    pub(super) make: Factory<Load>,
    pub(super) weight_count: WeightCount,
}

impl PyLoad {
    /// A load that `make` builds for each simulation.
    fn from_recipe(
        weight_count: WeightCount,
        make: impl Fn() -> basemat::Result<Load> + Send + Sync + 'static,
    ) -> Self {
        Self { make: Arc::new(make), weight_count }
    }
}

#[pymethods]
impl PyLoad {
    #[new]
    fn new(row: RowLike, value: Bound<'_, PyAny>) -> PyResult<Self> {
        if !value.is_callable() {
            return Err(input_error("the value of a load must be a function of time"));
        }
        let RowLike(row, weight_count) = row;
        let function = Arc::new(value.unbind());
        Ok(Self::from_recipe(weight_count, move || {
            let function = Arc::clone(&function);
            Ok(Load::new(row.clone(), move |time| {
                call_user_code(f64::NAN, |py| {
                    real_number(
                        "the value of a load's function",
                        function.call1(py, (time,))?.bind(py),
                    )
                })
            }))
        }))
    }

    /// Constant ``force`` (N/m) on the ``row`` at any time, the static state included.
    #[staticmethod]
    fn constant(row: RowLike, force: f64) -> Self {
        Self::from_recipe(row.1, move || Ok(Load::constant(row.0.clone(), force)))
    }

    /// Constant ``force`` (N/m) on the ``row`` that is applied together with the weight, according to ``gravity_stage``
    /// of `InitialConditions`: a dead load whose mass is not in the structure.
    #[staticmethod]
    fn weight(row: RowLike, force: f64) -> Self {
        Self::from_recipe(row.1, move || Ok(Load::weight(row.0.clone(), force)))
    }

    /// A ``force`` (N/m) on the ``row`` in the static state that is removed at the first step (snap-back).
    #[staticmethod]
    fn released(row: RowLike, force: f64) -> Self {
        Self::from_recipe(row.1, move || Ok(Load::released(row.0.clone(), force)))
    }

    /// ``force`` (N/m) on the ``row`` multiplied by the accelerations of a ``record`` as numbers without unit, linear
    /// between its samples and zero beyond its ends.
    #[staticmethod]
    fn record(row: RowLike, record: &PyRecord, force: f64) -> Self {
        let RowLike(row, weight_count) = row;
        let record = Arc::clone(&record.0);
        Self::from_recipe(weight_count, move || Ok(Load::record(row.clone(), &record, force)))
    }

    /// Forces on the ``row`` from a table: ``forces`` (array of shape (m,), N/m) at ``times`` (array of shape (m,), s,
    /// ascending), linear between these times, zero before the first and after the last.
    #[staticmethod]
    fn table(row: RowLike, times: Numbers, forces: Numbers) -> PyResult<Self> {
        Load::table(row.0.clone(), &times.0, &forces.0).or_raise()?;
        Ok(Self::from_recipe(row.1, move || Load::table(row.0.clone(), &times.0, &forces.0)))
    }
}
