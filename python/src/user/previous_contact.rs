//! Arguments and results of laws written in Python: contact of an element, previous contact, limits of its tractions.

use basemat::interface::{ContactState, Limits, PreviousContact};
use pyo3::prelude::*;

use crate::array::Numbers;
use crate::names::mode_name;

/// Gap, slip and tractions of an element: ``gap`` (positive when open) and ``slip`` (m), ``pressure`` (positive in
/// compression) and ``shear`` (Pa); in plan also ``slip_across`` (m) and ``shear_across`` (Pa) along y. All are 0 by
/// default.
#[pyclass(name = "ContactState", module = "basemat", frozen, subclass)]
pub(crate) struct PyContactState(pub(crate) ContactState);

#[pymethods]
impl PyContactState {
    #[pyo3(signature = (*, gap=0.0, slip=0.0, pressure=0.0, shear=0.0, slip_across=0.0, shear_across=0.0))]
    #[new]
    fn new(
        gap: f64,
        slip: f64,
        pressure: f64,
        shear: f64,
        slip_across: f64,
        shear_across: f64,
    ) -> Self {
        Self(ContactState { gap, slip, pressure, shear, slip_across, shear_across })
    }

    /// Gap, m; positive when open.
    #[getter]
    fn gap(&self) -> f64 {
        self.0.gap
    }

    /// Slip since the static state, m; positive to the right.
    #[getter]
    fn slip(&self) -> f64 {
        self.0.slip
    }

    /// Pressure, Pa; positive in compression.
    #[getter]
    fn pressure(&self) -> f64 {
        self.0.pressure
    }

    /// Shear traction of the structure on the soil, Pa; positive to the right.
    #[getter]
    fn shear(&self) -> f64 {
        self.0.shear
    }

    /// Slip along y in plan, m; positive away.
    #[getter]
    fn slip_across(&self) -> f64 {
        self.0.slip_across
    }

    /// Shear traction of the structure on the soil along y in plan, Pa; positive away.
    #[getter]
    fn shear_across(&self) -> f64 {
        self.0.shear_across
    }
}

/// An element at the start of a step: its `ContactState` and its history.
///
/// To try a law without a simulation, create one from a ``state`` (`ContactState`), its ``mode``, the ``time_step``
/// (s), the ``slip_rate`` (m/s; 0 by default), the ``trial_settlement`` (m; 0 by default) and the law's
/// ``state_variables`` (array of shape (m,); none unless given).
#[pyclass(name = "PreviousContact", module = "basemat", frozen, extends = PyContactState)]
pub(crate) struct PyPreviousContact {
    /// Previous contact, without the law's state variables.
    previous: PreviousContact<'static>,
    state_variables: Vec<f64>,
}

impl PyPreviousContact {
    /// The object of Python for a previous contact of the core.
    pub(crate) fn from_core(py: Python<'_>, start: &PreviousContact<'_>) -> PyResult<Py<Self>> {
        let mut previous = PreviousContact::new(start.state, start.mode, start.time_step);
        previous.has_opened = start.has_opened;
        previous.slip_rate = start.slip_rate;
        previous.static_pressure = start.static_pressure;
        previous.trial_settlement = start.trial_settlement;
        let state_variables = start.state_variables.to_vec();
        let superclass = PyClassInitializer::from(PyContactState(start.state));
        Py::new(py, superclass.add_subclass(Self { previous, state_variables }))
    }

    /// Previous contact as an argument of a law of the core.
    pub(crate) fn core(&self) -> PreviousContact<'_> {
        let mut start = self.previous;
        start.state_variables = &self.state_variables;
        start
    }
}

#[pymethods]
impl PyPreviousContact {
    #[pyo3(signature = (state, mode, time_step, *, slip_rate=0.0, trial_settlement=0.0, state_variables=None))]
    #[new]
    fn new(
        state: &PyContactState,
        mode: &str,
        time_step: f64,
        slip_rate: f64,
        trial_settlement: f64,
        state_variables: Option<Numbers>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let mut previous =
            PreviousContact::new(state.0, crate::names::parse_mode(mode)?, time_step);
        previous.slip_rate = slip_rate;
        previous.trial_settlement = trial_settlement;
        let state_variables = state_variables.map_or_else(Vec::new, |numbers| numbers.0);
        let superclass = PyClassInitializer::from(PyContactState(state.0));
        Ok(superclass.add_subclass(Self { previous, state_variables }))
    }

    /// Mode of the step before, as in `basemat.MODES`.
    #[getter]
    fn mode(&self) -> &'static str {
        mode_name(self.previous.mode)
    }

    /// Whether the element was open at any time before.
    #[getter]
    fn has_opened(&self) -> bool {
        self.previous.has_opened
    }

    /// Slip rate of the step before, m/s; its magnitude in plan.
    #[getter]
    fn slip_rate(&self) -> f64 {
        self.previous.slip_rate
    }

    /// Pressure of the static state, Pa.
    #[getter]
    fn static_pressure(&self) -> f64 {
        self.previous.static_pressure
    }

    /// Time step, s.
    #[getter]
    fn time_step(&self) -> f64 {
        self.previous.time_step
    }

    /// Settlement of the yielding soil in the present trial of the step, m; 0 in its first trial.
    ///
    /// A law whose pressure is a curve over the settlement returns the tangent of the curve at this settlement, as
    /// ``pressure_cap`` and ``hardening`` of its `Limits`; the step is solved again until the pressure is on the curve.
    #[getter]
    fn trial_settlement(&self) -> f64 {
        self.previous.trial_settlement
    }

    /// State variables of the law: list of numbers.
    #[getter]
    fn state_variables(&self) -> Vec<f64> {
        self.state_variables.clone()
    }
}

/// Limits of an element's tractions in the step that begins with a `PreviousContact`: what `UserPlanLaw.limits`
/// returns.
///
/// The pressure p (Pa) is between −``tension`` (0 by default) and ``pressure_cap`` (``math.inf`` by default: no bound),
/// which grows by ``hardening`` (Pa/m; 0 by default) with the settlement of yielding soil in the step. The shear
/// traction is at most ``friction`` (0 by default; ``math.inf`` where nothing slides) · max(p + ``attraction``, 0) +
/// ``shear_strength`` (Pa, both 0 by default), and slip is in its direction. ``gap_offset`` (m; 0 by default): gap of a
/// closed element, ``-math.inf`` for an element that cannot close in this step. ``bonded`` (False by default): whether
/// base and soil neither separate nor slide. An element that has opened with a tension, an attraction or a shear
/// strength loses them in that step.
#[pyclass(name = "Limits", module = "basemat", frozen, eq)]
#[derive(PartialEq, serde::Serialize, serde::Deserialize)]
pub(crate) struct PyLimits(pub(crate) Limits);

#[pymethods]
impl PyLimits {
    #[pyo3(
        signature = (friction=0.0, *, attraction=0.0, shear_strength=0.0, tension=0.0, pressure_cap=f64::INFINITY, hardening=0.0, gap_offset=0.0, bonded=false),
        text_signature = "(friction=0.0, *, attraction=0.0, shear_strength=0.0, tension=0.0, pressure_cap=1e999, hardening=0.0, gap_offset=0.0, bonded=False)"
    )]
    #[new]
    fn new(
        friction: f64,
        attraction: f64,
        shear_strength: f64,
        tension: f64,
        pressure_cap: f64,
        hardening: f64,
        gap_offset: f64,
        bonded: bool,
    ) -> Self {
        Self(Limits {
            friction,
            attraction,
            shear_strength,
            tension,
            pressure_cap,
            hardening,
            gap_offset,
            bonded,
        })
    }

    /// Friction coefficient; infinite where nothing slides.
    #[getter]
    fn friction(&self) -> f64 {
        self.0.friction
    }

    /// Pressure that friction acts on in addition to the contact pressure, Pa.
    #[getter]
    fn attraction(&self) -> f64 {
        self.0.attraction
    }

    /// Shear strength in addition to friction, Pa.
    #[getter]
    fn shear_strength(&self) -> f64 {
        self.0.shear_strength
    }

    /// Tensile strength, Pa.
    #[getter]
    fn tension(&self) -> f64 {
        self.0.tension
    }

    /// Largest pressure of soil that does not settle in the step, Pa.
    #[getter]
    fn pressure_cap(&self) -> f64 {
        self.0.pressure_cap
    }

    /// Growth of the largest pressure with the settlement in the step, Pa/m.
    #[getter]
    fn hardening(&self) -> f64 {
        self.0.hardening
    }

    /// Gap of a closed element, m.
    #[getter]
    fn gap_offset(&self) -> f64 {
        self.0.gap_offset
    }

    /// Whether base and soil neither separate nor slide.
    #[getter]
    fn bonded(&self) -> bool {
        self.0.bonded
    }
}
