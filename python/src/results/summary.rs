//! The base, foundations and limits of service after a run.

use basemat::results::{Quantity, ServiceCheck, Summary};
use pyo3::prelude::*;

use super::{PyExtremes, PyPeak};
use crate::error::{OrRaise, input_error};

/// The whole base or one foundation over a run: largest values with their times, uplift and sliding.
///
/// Forces act from the structure on the soil, per metre of thickness in the plane, of the whole body in plan (N and
/// N·m).
#[pyclass(name = "Summary", module = "basemat", frozen, subclass)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PySummary(pub(super) Summary);

#[pymethods]
impl PySummary {
    /// x of the foundation's two ends, m.
    #[getter]
    fn ends(&self) -> [f64; 2] {
        self.0.ends
    }

    /// In plan: y of its front and its back, m; zeros in the plane.
    #[getter]
    fn depth(&self) -> [f64; 2] {
        self.0.depth
    }

    /// Total pressure at the start, N/m.
    #[getter]
    fn static_normal_force(&self) -> f64 {
        self.0.static_normal_force
    }

    /// Horizontal force on the soil, positive to the right, N/m: its `Extremes`.
    #[getter]
    fn base_shear(&self) -> PyExtremes {
        PyExtremes(self.0.base_shear)
    }

    /// Moment on the soil, counter-clockwise, N·m/m, of a foundation about its middle; in plan about y by the right-hand rule: its `Extremes`.
    #[getter]
    fn base_moment(&self) -> PyExtremes {
        PyExtremes(self.0.base_moment)
    }

    /// Total pressure on the soil, N/m: its `Extremes`.
    #[getter]
    fn normal_force(&self) -> PyExtremes {
        PyExtremes(self.0.normal_force)
    }

    /// Rotation, counter-clockwise, rad, in plan about y by the right-hand rule: its `Extremes`.
    #[getter]
    fn base_rotation(&self) -> PyExtremes {
        PyExtremes(self.0.base_rotation)
    }

    /// Rotation at the end, rad, in plan about y.
    #[getter]
    fn residual_rotation(&self) -> f64 {
        self.0.residual_rotation
    }

    /// In plan: rotation about x at the end, rad.
    #[getter]
    fn residual_rotation_across(&self) -> f64 {
        self.0.residual_rotation_across
    }

    /// Settlement of the centre since the static state, positive downwards, m; for several foundations the largest
    /// settlement: its `Extremes`.
    #[getter]
    fn settlement(&self) -> PyExtremes {
        PyExtremes(self.0.settlement)
    }

    /// Settlement at the end, m.
    #[getter]
    fn residual_settlement(&self) -> f64 {
        self.0.residual_settlement
    }

    /// Work of the moment on the soil, ∫M dθ, J/m, in plan about y: its `Extremes`.
    #[getter]
    fn rocking_work(&self) -> PyExtremes {
        PyExtremes(self.0.rocking_work)
    }

    /// Largest ratio of the open length to the length, in plan of the open area to the area: its `Peak`.
    #[getter]
    fn uplifted_fraction(&self) -> PyPeak {
        PyPeak(self.0.uplifted_fraction.highest)
    }

    /// Duration of uplift, s.
    #[getter]
    fn uplift_duration(&self) -> f64 {
        self.0.uplift.duration
    }

    /// Slip averaged over the foundation, m: its `Extremes`.
    #[getter]
    fn mean_slip(&self) -> PyExtremes {
        PyExtremes(self.0.mean_slip)
    }

    /// Slip averaged over the foundation at the end, m.
    #[getter]
    fn residual_slip(&self) -> f64 {
        self.0.residual_slip
    }

    /// In plan: slip along y averaged over the foundation at the end, m.
    #[getter]
    fn residual_slip_across(&self) -> f64 {
        self.0.residual_slip_across
    }

    /// Largest slip of any element, m: its `Peak`.
    #[getter]
    fn largest_slip(&self) -> PyPeak {
        PyPeak(self.0.largest_slip.highest)
    }

    /// Slip events: list of tuples (start in s, end in s, slip in m).
    #[getter]
    fn slip_events(&self) -> Vec<(f64, f64, f64)> {
        self.0
            .sliding
            .events
            .iter()
            .map(|event| (event.start, event.end, event.slip))
            .collect()
    }

    /// Sliding distance: sum of the |slip| increments over time, m.
    #[getter]
    fn slip_path(&self) -> f64 {
        self.0.sliding.path
    }

    /// Lowest factor of safety against sliding, a `Peak`; None without a friction coefficient.
    #[getter]
    fn least_sliding_safety(&self) -> Option<PyPeak> {
        let lowest_safety = self.0.sliding_safety.lowest;
        (!lowest_safety.value.is_nan()).then_some(PyPeak(lowest_safety))
    }

    /// Lowest factor of safety against overturning, a `Peak`; in plan the lower of "overturning_safety", over the left
    /// or the right edge, and "overturning_safety_across", over the front or the back edge. Pressure acts in the middle
    /// of elements: a base of few elements therefore tips about its edge at a factor above 1. The report of a run
    /// states this factor.
    #[getter]
    fn least_overturning_safety(&self) -> PyPeak {
        let safety_along_x = self.0.overturning_safety.lowest;
        let safety_along_y = self.0.overturning_safety_across.lowest;
        let has_lower_y = safety_along_y.value < safety_along_x.value;
        PyPeak(if has_lower_y { safety_along_y } else { safety_along_x })
    }

    /// The `Extremes` of a ``quantity``, in its unit: the name of a scalar time series such as
    /// "base_shear" or "free_field_horizontal", in plan also "shear_across", "torque", "uplifted_area" and so on.
    fn extremes(&self, quantity: &str) -> PyResult<PyExtremes> {
        let in_plan = self.0.depth != [0.0; 2];
        let quantity_names: Vec<_> =
            Quantity::recorded(in_plan).map(|quantity| quantity.to_string()).collect();
        if !quantity_names.iter().any(|name| name == quantity) {
            let names = quantity_names.join(", ");
            return Err(input_error(format!(
                "there is no quantity '{quantity}' in this run, only {names}"
            )));
        }
        Ok(PyExtremes(self.0.extremes(quantity.parse().or_raise()?)))
    }
}

/// Comparison of a run with a limit of service.
#[pyclass(name = "ServiceCheck", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyServiceCheck(pub(super) ServiceCheck);

#[pymethods]
impl PyServiceCheck {
    /// The limited response: "slip", "gap", "uplifted_fraction", "rotation" or "settlement".
    #[getter]
    fn criterion(&self) -> String {
        self.0.criterion.to_string()
    }

    /// Limit of the response, in SI units.
    #[getter]
    fn limit(&self) -> f64 {
        self.0.limit
    }

    /// The run's value furthest from zero, a `Peak` in SI units.
    #[getter]
    fn largest(&self) -> PyPeak {
        PyPeak(self.0.largest)
    }

    /// End of the first step beyond the limit, s; None if there was none.
    #[getter]
    fn first_excess(&self) -> Option<f64> {
        self.0.first_excess
    }

    /// Whether the run stays within the limit.
    #[getter]
    fn is_met(&self) -> bool {
        self.0.is_met()
    }

    /// Unused fraction of the limit; below zero where it is exceeded.
    #[getter]
    fn margin(&self) -> f64 {
        self.0.margin()
    }

    fn __str__(&self) -> String {
        self.0.to_string()
    }
}
