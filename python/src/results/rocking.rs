//! Series of one foundation, its rocking as arrays, and the equivalent damping of a cycle.

use basemat::results::{Quantity, Rocking};
use pyo3::prelude::*;

use super::PyRun;
use crate::array::{Array, Numbers, OrderedDict, whole_numbers};
use crate::error::OrRaise;

impl PyRun {
    /// Rocking of a foundation; in plan about y, or about x if `across`.
    fn rocking_of(&self, foundation: usize, across: bool) -> PyResult<Rocking<'_>> {
        let time_series = self.recorded()?;
        if across {
            time_series.rocking_across(foundation).or_raise()
        } else {
            time_series.rocking(foundation).or_raise()
        }
    }
}

#[pymethods]
impl PyRun {
    /// Time series of the scalars of a ``foundation`` (from 0): dict of arrays of shape (steps + 1,), "time" first.
    /// Moments are about the middle of the foundation. Several foundations need ``foundations=True`` of
    /// `Simulation.run`.
    fn foundation_series(
        &self,
        #[pyo3(from_py_with = whole_numbers)] foundation: usize,
    ) -> PyResult<OrderedDict<String, Array>> {
        let time_series = self.recorded()?;
        let mut columns = vec![("time".to_owned(), Array::from(time_series.times()))];
        for quantity in Quantity::recorded(time_series.in_plan()) {
            let values = time_series.foundation_series(foundation, quantity).or_raise()?;
            columns.push((quantity.to_string(), Array::from(values)));
        }
        Ok(OrderedDict(columns))
    }

    /// Rocking of a ``foundation`` (0, the first, by default), counter-clockwise, in plan about y or with ``across``
    /// about x: dict of arrays of shape (steps + 1,): "time" (s), "rotation" (rad), "moment" on the soil about its
    /// middle (N·m/m, in plan N·m), "settlement" (m, positive downwards) and "work" of the moment on the soil (∫M dθ,
    /// J/m, in plan J).
    #[pyo3(signature = (foundation=0, *, across=false))]
    fn rocking(
        &self,
        #[pyo3(from_py_with = whole_numbers)] foundation: usize,
        across: bool,
    ) -> PyResult<OrderedDict<&'static str, Array>> {
        let rocking = self.rocking_of(foundation, across)?;
        Ok(OrderedDict(vec![
            ("time", Array::from(rocking.times)),
            ("rotation", Array::from(rocking.rotation)),
            ("moment", Array::from(rocking.moment)),
            ("settlement", Array::from(rocking.settlement)),
            ("work", Array::from(rocking.work)),
        ]))
    }

    /// Equivalent viscous damping ratio E/(2π M θ) of the one cycle of rocking between the times ``start`` and ``end`` (s).
    ///
    /// E is the work of the moment, M and θ are half the ranges of moment and rotation (Gajan and Kutter 2008). An
    /// `InputError` is raised if the steps are not one closed cycle. ``foundation`` and ``across`` as for `rocking`.
    #[pyo3(signature = (start, end, foundation=0, *, across=false))]
    fn equivalent_damping(
        &self,
        start: f64,
        end: f64,
        #[pyo3(from_py_with = whole_numbers)] foundation: usize,
        across: bool,
    ) -> PyResult<f64> {
        let cycle = self.rocking_of(foundation, across)?.between(start..end).or_raise()?;
        cycle.equivalent_damping().or_raise()
    }
}

/// Equivalent viscous damping ratio E/(2π M θ) of one measured cycle of moments over rotations.
///
/// E is the area of the polygon of the measured points, M and θ are half the ranges (Gajan and Kutter 2008). An
/// `InputError` is raised if the points are not one closed cycle. `Run.equivalent_damping` computes the ratio from a
/// run.
///
/// Args:
///     rotation: rotations, array of shape (m,), rad.
///     moment: moments in any unit, array of shape (m,).
#[pyfunction]
pub(crate) fn equivalent_damping(rotation: Numbers, moment: Numbers) -> PyResult<f64> {
    basemat::results::equivalent_damping(&rotation.0, &moment.0).or_raise()
}
