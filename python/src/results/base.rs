//! Foundations and limits of service after a run.

use basemat::results::Extremes;
use basemat::results::{ServiceCheck, SlipEvent, Summary};
use pyo3::prelude::*;

use super::{PyExtremes, PyPeak};

use crate::saved::{Reduced, reduced};

/// A foundation over a run, with the numbers of a :class:`Run`; forces are those of the structure on the
/// soil, per metre of thickness.
#[pyclass(name = "FoundationSummary", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyFoundationSummary(pub(super) Summary);

/// A text as HTML, in its lines.
pub(crate) fn preformatted(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    format!("<pre style=\"line-height: 1.2\">{text}</pre>")
}

/// Slip events as tuples (start in s, end in s, slip in m).
pub(super) fn events(list: &[SlipEvent]) -> Vec<(f64, f64, f64)> {
    list.iter().map(|event| (event.start, event.end, event.slip)).collect()
}

/// The least value, if there is one.
pub(super) fn known(extremes: Extremes) -> Option<PyPeak> {
    (!extremes.lowest.value.is_nan()).then_some(PyPeak(extremes.lowest))
}

#[pymethods]
impl PyFoundationSummary {
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(slf)
    }

    /// x of its two ends, m.
    #[getter]
    fn ends(&self) -> [f64; 2] {
        self.0.ends
    }

    /// Total pressure at the start, N/m.
    #[getter]
    fn static_normal_force(&self) -> f64 {
        self.0.static_normal_force
    }

    /// Horizontal force on the soil, positive to the right, N/m: its :class:`Extremes`.
    #[getter]
    fn base_shear(&self) -> PyExtremes {
        PyExtremes(self.0.base_shear)
    }

    /// Moment about its middle, counter-clockwise, N·m/m: its :class:`Extremes`.
    #[getter]
    fn base_moment(&self) -> PyExtremes {
        PyExtremes(self.0.base_moment)
    }

    /// Total pressure, N/m: its :class:`Extremes`.
    #[getter]
    fn normal_force(&self) -> PyExtremes {
        PyExtremes(self.0.normal_force)
    }

    /// Rotation, counter-clockwise, rad: its :class:`Extremes`.
    #[getter]
    fn base_rotation(&self) -> PyExtremes {
        PyExtremes(self.0.base_rotation)
    }

    /// Largest ratio of its open length to its length: its :class:`Peak`.
    #[getter]
    fn uplifted_fraction(&self) -> PyPeak {
        PyPeak(self.0.uplifted_fraction.highest)
    }

    /// Slip averaged over it, m: its :class:`Extremes`.
    #[getter]
    fn mean_slip(&self) -> PyExtremes {
        PyExtremes(self.0.mean_slip)
    }

    /// Slip averaged over it at the end, m.
    #[getter]
    fn residual_slip(&self) -> f64 {
        self.0.residual_slip
    }

    /// Slip events: list of tuples (start in s, end in s, slip in m).
    #[getter]
    fn slip_events(&self) -> Vec<(f64, f64, f64)> {
        events(&self.0.sliding.events)
    }

    /// Least factor of safety against sliding, a :class:`Peak`; None without a friction coefficient.
    #[getter]
    fn least_sliding_safety(&self) -> Option<PyPeak> {
        known(self.0.sliding_safety)
    }

    /// Least factor of safety against overturning, a :class:`Peak`.
    #[getter]
    fn least_overturning_safety(&self) -> PyPeak {
        PyPeak(self.0.overturning_safety.lowest)
    }
}

/// A limit of service, held against a run.
#[pyclass(name = "ServiceCheck", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyServiceCheck(pub(super) ServiceCheck);

#[pymethods]
impl PyServiceCheck {
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(slf)
    }

    /// The limited response: "slip", "gap", "uplifted fraction" or "rotation".
    #[getter]
    fn criterion(&self) -> &'static str {
        self.0.criterion.name()
    }

    /// Its limit, in SI units.
    #[getter]
    fn limit(&self) -> f64 {
        self.0.limit
    }

    /// The run's value furthest from zero, a :class:`Peak` in SI units.
    #[getter]
    fn largest(&self) -> PyPeak {
        PyPeak(self.0.largest)
    }

    /// End of the first step beyond the limit, s; None if there was none.
    #[getter]
    fn first_excess(&self) -> Option<f64> {
        self.0.first_excess
    }

    /// Whether the limit was kept.
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

    fn __repr__(&self) -> String {
        format!("ServiceCheck({})", self.0)
    }
}
