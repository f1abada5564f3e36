//! The base, foundations and limits of service after a run.

use basemat::results::{ServiceCheck, Summary};
use pyo3::prelude::*;

use super::{PyExtremes, PyPeak};
use crate::error::OrRaise;

/// The whole base or one foundation over a run: largest values with their times, uplift and sliding.
///
/// Forces are those of the structure on the soil, per metre of thickness.
#[pyclass(name = "Summary", module = "basemat", frozen, subclass)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PySummary(pub(super) Summary);

members! {
    PySummary, own;
    /// x of the foundation's two ends, m.
    ends: [f64; 2] = own.0.ends;
    /// In plan: y of its front and its back, m; zeros in the plane.
    depth: [f64; 2] = own.0.depth;
    /// Total pressure at the start, N/m.
    static_normal_force: f64 = own.0.static_normal_force;
    /// Horizontal force on the soil, positive to the right, N/m: its :class:`Extremes`.
    base_shear: PyExtremes = PyExtremes(own.0.base_shear);
    /// Moment on the soil, counter-clockwise, N·m/m, of a foundation about its middle; in plan about y by the right-hand rule: its :class:`Extremes`.
    base_moment: PyExtremes = PyExtremes(own.0.base_moment);
    /// Total pressure on the soil, N/m: its :class:`Extremes`.
    normal_force: PyExtremes = PyExtremes(own.0.normal_force);
    /// Rotation, counter-clockwise, rad, in plan about y by the right-hand rule: its :class:`Extremes`.
    base_rotation: PyExtremes = PyExtremes(own.0.base_rotation);
    /// Largest ratio of the open length to the length: its :class:`Peak`.
    uplifted_fraction: PyPeak = PyPeak(own.0.uplifted_fraction.highest);
    /// Time with uplift, s.
    uplift_duration: f64 = own.0.uplift.duration;
    /// Slip averaged over the foundation, m: its :class:`Extremes`.
    mean_slip: PyExtremes = PyExtremes(own.0.mean_slip);
    /// Slip averaged over the foundation at the end, m.
    residual_slip: f64 = own.0.residual_slip;
    /// In plan: slip along y averaged over the foundation at the end, m.
    residual_slip_across: f64 = own.0.residual_slip_across;
    /// Largest slip of any element, m: its :class:`Peak`.
    largest_slip: PyPeak = PyPeak(own.0.largest_slip.highest);
    /// Slip events: list of tuples (start in s, end in s, slip in m).
    slip_events: Vec<(f64, f64, f64)> = own.0.sliding.events.iter().map(|event| (event.start, event.end, event.slip)).collect();
    /// Sliding distance: |slip| of it summed over time, m.
    slip_path: f64 = own.0.sliding.path;
    /// Least factor of safety against sliding, a :class:`Peak`; None without a friction coefficient.
    least_sliding_safety: Option<PyPeak> = {
        let least = own.0.sliding_safety.lowest;
        (!least.value.is_nan()).then_some(PyPeak(least))
    };
    /// Least factor of safety against overturning, a :class:`Peak`; in plan the lesser of "overturning_safety", over the
    /// left or the right edge, and "overturning_safety_across", over the front or the back one.
    least_overturning_safety: PyPeak = {
        let [along, across] = [own.0.overturning_safety, own.0.overturning_safety_across];
        PyPeak(if across.lowest.value < along.lowest.value { across.lowest } else { along.lowest })
    };
}

#[pymethods]
impl PySummary {
    /// The :class:`Extremes` of a ``quantity``, in its unit: the name of a scalar time series such as
    /// "base_shear" or "free_field_horizontal", in plan also "shear_across", "torque", "uplifted_area" and so on.
    fn extremes(&self, quantity: &str) -> PyResult<PyExtremes> {
        Ok(PyExtremes(self.0.extremes(quantity.parse().or_raise()?)))
    }
}

/// A limit of service, held against a run.
#[pyclass(name = "ServiceCheck", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyServiceCheck(pub(super) ServiceCheck);

members! {
    PyServiceCheck, own;
    /// The limited response: "slip", "gap", "uplifted fraction" or "rotation".
    criterion: &'static str = own.0.criterion.name();
    /// Limit of the response, in SI units.
    limit: f64 = own.0.limit;
    /// The run's value furthest from zero, a :class:`Peak` in SI units.
    largest: PyPeak = PyPeak(own.0.largest);
    /// End of the first step beyond the limit, s; None if there was none.
    first_excess: Option<f64> = own.0.first_excess;
    /// Whether the limit was kept.
    is_met: bool = own.0.is_met();
    /// Unused fraction of the limit; below zero where it is exceeded.
    margin: f64 = own.0.margin();
}

#[pymethods]
impl PyServiceCheck {
    fn __str__(&self) -> String {
        self.0.to_string()
    }
}
