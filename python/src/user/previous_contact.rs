//! An element's contact, its contact at the end of the step before, and limits of its tractions in plan, as laws written in
//! Python see them.

use basemat::interface::{ContactState, Limits, PreviousContact};
use pyo3::prelude::*;

use crate::array::Numbers;
use crate::names::mode_name;

/// Opening and total traction of an element: ``gap`` (positive when open) and ``slip`` (m), ``pressure``
/// (positive in compression) and ``shear`` (Pa), in plan along y too, ``slip_across`` (m) and ``shear_across`` (Pa); 0 by default.
#[pyclass(name = "ContactState", module = "basemat", frozen, subclass)]
pub(crate) struct PyContactState(pub(crate) ContactState);

members! {
    PyContactState, own;
    #[pyo3(signature = (*, gap=0.0, slip=0.0, pressure=0.0, shear=0.0, slip_across=0.0, shear_across=0.0))]
    new(
        gap: f64,
        slip: f64,
        pressure: f64,
        shear: f64,
        slip_across: f64,
        shear_across: f64,
    ) = Ok(Self(ContactState { gap, slip, pressure, shear, slip_across, shear_across }));
    /// Gap, m; positive when open.
    gap: f64 = own.0.gap;
    /// Slip since the static state, m; positive to the right.
    slip: f64 = own.0.slip;
    /// Pressure, Pa; positive in compression.
    pressure: f64 = own.0.pressure;
    /// Shear traction of the structure on the soil, Pa; positive to the right.
    shear: f64 = own.0.shear;
    /// Slip along y in plan, m; positive away.
    slip_across: f64 = own.0.slip_across;
    /// Shear traction of the structure on the soil along y in plan, Pa; positive away.
    shear_across: f64 = own.0.shear_across;
}

/// An element at the start of a step: its :class:`ContactState`, and the rest of its past.
///
/// A law can be tried without a simulation on one that is made of a ``state`` (:class:`ContactState`),
/// its ``mode``, the ``time_step`` (s), the ``slip_rate`` (m/s; 0 by default) and the law's
/// ``state_variables`` (array of shape (m,); none unless given).
#[pyclass(name = "PreviousContact", module = "basemat", frozen, extends = PyContactState)]
pub(crate) struct PyPreviousContact {
    /// Previous contact, without the law's state variables.
    own: PreviousContact<'static>,
    state_variables: Vec<f64>,
}

impl PyPreviousContact {
    pub(crate) fn of(py: Python<'_>, start: &PreviousContact<'_>) -> PyResult<Py<Self>> {
        let mut own = PreviousContact::new(start.state, start.mode, start.time_step);
        own.has_opened = start.has_opened;
        own.slip_rate = start.slip_rate;
        own.static_pressure = start.static_pressure;
        let base = PyClassInitializer::from(PyContactState(start.state));
        Py::new(
            py,
            base.add_subclass(Self { own, state_variables: start.state_variables.to_vec() }),
        )
    }

    /// Previous contact as a law of the core takes it.
    pub(crate) fn core(&self) -> PreviousContact<'_> {
        let mut start = self.own;
        start.state_variables = &self.state_variables;
        start
    }
}

members! {
    PyPreviousContact, own;
    #[pyo3(signature = (state, mode, time_step, *, slip_rate=0.0, state_variables=None))]
    new(
        state: &PyContactState,
        mode: &str,
        time_step: f64,
        slip_rate: f64,
        state_variables: Option<Numbers>,
    ) = {
        let mut own = PreviousContact::new(state.0, crate::names::mode(mode)?, time_step);
        own.slip_rate = slip_rate;
        let state_variables = state_variables.map_or_else(Vec::new, |numbers| numbers.0);
        let base = PyClassInitializer::from(PyContactState(state.0));
        Ok(base.add_subclass(Self { own, state_variables }))
    };
    /// Mode of the step before, as in :data:`basemat.MODES`.
    mode: &'static str = mode_name(own.own.mode);
    /// Whether the element has been open.
    has_opened: bool = own.own.has_opened;
    /// Slip rate of the step before, m/s; its magnitude in plan.
    slip_rate: f64 = own.own.slip_rate;
    /// Pressure of the static state, Pa.
    static_pressure: f64 = own.own.static_pressure;
    /// Time step, s.
    time_step: f64 = own.own.time_step;
    /// State variables of the law: list of numbers.
    state_variables: Vec<f64> = own.state_variables.clone();
}

/// Limits of an element's tractions on a ground in plan, in the step after a :class:`PreviousContact`: what
/// :meth:`UserPlanLaw.limits` returns.
///
/// Pressure p (Pa) is between −``tension`` (0 by default) and ``pressure_cap`` (``math.inf``, none, by default); the shear
/// traction is at most ``friction`` (0 by default; ``math.inf`` where nothing slides) · max(p + ``attraction``, 0) +
/// ``shear_strength`` (Pa, both 0 by default), and slip is along it. ``gap_offset`` (m; 0 by default): gap of a closed element,
/// ``-math.inf`` for one that cannot close in this step. ``bonded`` (False by default): neither separates nor slides. An
/// element that has opened with a tension, an attraction or a shear strength loses them in that step.
#[pyclass(name = "Limits", module = "basemat", frozen, eq)]
#[derive(PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct PyLimits(pub(crate) Limits);

members! {
    PyLimits, own;
    #[pyo3(
        signature = (friction=0.0, *, attraction=0.0, shear_strength=0.0, tension=0.0, pressure_cap=f64::INFINITY, gap_offset=0.0, bonded=false),
        text_signature = "(friction=0.0, *, attraction=0.0, shear_strength=0.0, tension=0.0, pressure_cap=1e999, gap_offset=0.0, bonded=False)"
    )]
    new(
        friction: f64,
        attraction: f64,
        shear_strength: f64,
        tension: f64,
        pressure_cap: f64,
        gap_offset: f64,
        bonded: bool,
    ) = {
        let mut own = Limits { friction, attraction, shear_strength, ..Limits::default() };
        (own.tension, own.pressure_cap, own.gap_offset) = (tension, pressure_cap, gap_offset);
        Ok(Self(Limits { bonded, ..own }))
    };
    /// Friction coefficient; infinite where nothing slides.
    friction: f64 = own.0.friction;
    /// Pressure that friction acts on beside that of the contact, Pa.
    attraction: f64 = own.0.attraction;
    /// Shear traction that is borne beside friction, Pa.
    shear_strength: f64 = own.0.shear_strength;
    /// Tensile strength, Pa.
    tension: f64 = own.0.tension;
    /// Greatest pressure, Pa.
    pressure_cap: f64 = own.0.pressure_cap;
    /// Gap of a closed element, m.
    gap_offset: f64 = own.0.gap_offset;
    /// Whether base and soil neither separate nor slide.
    bonded: bool = own.0.bonded;
}
