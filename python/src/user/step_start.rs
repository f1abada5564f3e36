//! The start of a step, as laws written in Python see it.

use basemat::interface::{ContactState, Mode, StepStart};
use pyo3::prelude::*;

use crate::names::mode_name;

/// An element at the start of a step.
#[pyclass(name = "StepStart", module = "basemat", frozen)]
pub(crate) struct PyStepStart {
    state: ContactState,
    mode: Mode,
    has_opened: bool,
    slip_rate: f64,
    static_pressure: f64,
    time_step: f64,
    memory: Vec<f64>,
}

impl PyStepStart {
    pub(crate) fn of(start: &StepStart<'_>) -> Self {
        let StepStart { state, mode, has_opened, slip_rate, static_pressure, time_step, .. } =
            *start;
        let memory = start.memory.to_vec();
        Self { state, mode, has_opened, slip_rate, static_pressure, time_step, memory }
    }
}

#[pymethods]
impl PyStepStart {
    /// Gap, m; positive when open.
    #[getter]
    fn gap(&self) -> f64 {
        self.state.gap
    }

    /// Slip since the static state, m; positive to the right.
    #[getter]
    fn slip(&self) -> f64 {
        self.state.slip
    }

    /// Pressure, Pa; positive in compression.
    #[getter]
    fn pressure(&self) -> f64 {
        self.state.pressure
    }

    /// Shear traction of the structure on the soil, Pa; positive to the right.
    #[getter]
    fn shear(&self) -> f64 {
        self.state.shear
    }

    /// Mode of the step before, as in :data:`basemat.MODES`.
    #[getter]
    fn mode(&self) -> &'static str {
        mode_name(self.mode)
    }

    /// Whether the element has been open.
    #[getter]
    fn has_opened(&self) -> bool {
        self.has_opened
    }

    /// Slip rate of the step before, m/s.
    #[getter]
    fn slip_rate(&self) -> f64 {
        self.slip_rate
    }

    /// Pressure of the static state, Pa.
    #[getter]
    fn static_pressure(&self) -> f64 {
        self.static_pressure
    }

    /// Time step, s.
    #[getter]
    fn time_step(&self) -> f64 {
        self.time_step
    }

    /// Numbers that the law remembers of the element.
    #[getter]
    fn memory(&self) -> Vec<f64> {
        self.memory.clone()
    }
}
