//! An element's contact, and its contact at the end of the step before, as laws written in Python see them.

use basemat::interface::{ContactState, Mode, PreviousContact};
use pyo3::prelude::*;

use crate::array::Numbers;
use crate::names::mode_name;

/// Opening and total traction of an element: ``gap`` (positive when open) and ``slip`` (m), ``pressure``
/// (positive in compression) and ``shear`` (Pa), in plan along y too, ``slip_across`` (m) and ``shear_across`` (Pa); 0 by default.
#[pyclass(name = "ContactState", module = "basemat", frozen, get_all)]
pub(crate) struct PyContactState {
    /// Gap, m; positive when open.
    gap: f64,
    /// Slip since the static state, m; positive to the right.
    slip: f64,
    /// Pressure, Pa; positive in compression.
    pressure: f64,
    /// Shear traction of the structure on the soil, Pa; positive to the right.
    shear: f64,
    /// Slip along y in plan, m; positive away.
    slip_across: f64,
    /// Shear traction of the structure on the soil along y in plan, Pa; positive away.
    shear_across: f64,
}

impl PyContactState {
    pub(super) fn of(state: &ContactState) -> Self {
        let ContactState { gap, slip, pressure, shear, slip_across, shear_across } = *state;
        Self { gap, slip, pressure, shear, slip_across, shear_across }
    }

    pub(crate) fn core(&self) -> ContactState {
        let Self { gap, slip, pressure, shear, slip_across, shear_across } = *self;
        ContactState { gap, slip, pressure, shear, slip_across, shear_across }
    }
}

#[pymethods]
impl PyContactState {
    #[new]
    #[pyo3(signature = (*, gap=0.0, slip=0.0, pressure=0.0, shear=0.0, slip_across=0.0, shear_across=0.0))]
    fn new(
        gap: f64,
        slip: f64,
        pressure: f64,
        shear: f64,
        slip_across: f64,
        shear_across: f64,
    ) -> Self {
        Self { gap, slip, pressure, shear, slip_across, shear_across }
    }
}

/// An element at the start of a step: what a law knows of it.
///
/// A law can be tried without a simulation on one that is made of a ``state`` (:class:`ContactState`),
/// its ``mode``, the ``time_step`` (s), the ``slip_rate`` (m/s; 0 by default) and the law's state
/// variables ``memory`` (array of shape (m,); none unless given).
#[pyclass(name = "PreviousContact", module = "basemat", frozen)]
pub(crate) struct PyPreviousContact {
    state: ContactState,
    mode: Mode,
    has_opened: bool,
    slip_rate: f64,
    static_pressure: f64,
    time_step: f64,
    memory: Vec<f64>,
}

impl PyPreviousContact {
    pub(crate) fn of(start: &PreviousContact<'_>) -> Self {
        let PreviousContact {
            state, mode, has_opened, slip_rate, static_pressure, time_step, ..
        } = *start;
        let memory = start.memory.to_vec();
        Self { state, mode, has_opened, slip_rate, static_pressure, time_step, memory }
    }

    /// The same for a law of the core.
    pub(crate) fn core(&self) -> PreviousContact<'_> {
        let mut start = PreviousContact::new(self.state, self.mode, self.time_step);
        start.has_opened = self.has_opened;
        start.slip_rate = self.slip_rate;
        start.static_pressure = self.static_pressure;
        start.memory = &self.memory;
        start
    }
}

getters! {
    PyPreviousContact, own;
    /// Gap, m; positive when open.
    gap: f64 = own.state.gap;
    /// Slip since the static state, m; positive to the right.
    slip: f64 = own.state.slip;
    /// Pressure, Pa; positive in compression.
    pressure: f64 = own.state.pressure;
    /// Shear traction of the structure on the soil, Pa; positive to the right.
    shear: f64 = own.state.shear;
    /// Mode of the step before, as in :data:`basemat.MODES`.
    mode: PyResult<&'static str> = mode_name(own.mode);
    /// Whether the element has been open.
    has_opened: bool = own.has_opened;
    /// Slip rate of the step before, m/s.
    slip_rate: f64 = own.slip_rate;
    /// Pressure of the static state, Pa.
    static_pressure: f64 = own.static_pressure;
    /// Time step, s.
    time_step: f64 = own.time_step;
    /// State variables of the law: list of numbers.
    memory: Vec<f64> = own.memory.clone();
}

#[pymethods]
impl PyPreviousContact {
    #[new]
    #[pyo3(signature = (state, mode, time_step, *, slip_rate=0.0, memory=None))]
    fn new(
        state: &PyContactState,
        mode: &str,
        time_step: f64,
        slip_rate: f64,
        memory: Option<Numbers>,
    ) -> PyResult<Self> {
        let memory = memory.map_or_else(Vec::new, |numbers| numbers.0);
        let start = PreviousContact::new(state.core(), crate::names::mode(mode)?, time_step);
        Ok(Self { slip_rate, memory, ..Self::of(&start) })
    }
}
