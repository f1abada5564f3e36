//! A law written in Python.

use basemat::Result;
use basemat::interface::{
    Condition, ContactScene, ContactState, InterfaceLaw, Limits, Mode, PreviousContact, Tolerance,
};
use pyo3::call::PyCallArgs;
use pyo3::prelude::*;

use super::object::{UserObject, call_unless_raised};
use super::{PyContactState, PyLimits, PyPreviousContact};
use crate::array::{Count, Numbers};
use crate::error::{extract_returned, has_stored_exception, input_error};
use crate::names::{mode_name, parse_mode};

/// One linear condition on an element at the end of a step:
/// ``gap`` · g + ``slip`` · s + ``pressure`` · p + ``shear`` · τ = ``value``, with its gap g and slip s (m),
/// pressure p and shear traction τ (Pa). Each coefficient is 0 by default.
#[pyclass(name = "Condition", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyCondition(pub(crate) Condition);

#[pymethods]
impl PyCondition {
    #[pyo3(signature = (*, gap=0.0, slip=0.0, pressure=0.0, shear=0.0, value=0.0))]
    #[new]
    fn new(gap: f64, slip: f64, pressure: f64, shear: f64, value: f64) -> Self {
        Self(Condition { gap, slip, pressure, shear, value })
    }

    /// The gap is ``value``, m.
    #[staticmethod]
    fn gap_is(value: f64) -> Self {
        Self(Condition::gap_is(value))
    }

    /// The slip is ``value``, m.
    #[staticmethod]
    fn slip_is(value: f64) -> Self {
        Self(Condition::slip_is(value))
    }

    /// The pressure is ``value``, Pa.
    #[staticmethod]
    fn pressure_is(value: f64) -> Self {
        Self(Condition::pressure_is(value))
    }

    /// The shear traction is ``value``, Pa.
    #[staticmethod]
    fn shear_is(value: f64) -> Self {
        Self(Condition::shear_is(value))
    }

    /// Coefficient of the gap.
    #[getter]
    fn gap(&self) -> f64 {
        self.0.gap
    }

    /// Coefficient of the slip.
    #[getter]
    fn slip(&self) -> f64 {
        self.0.slip
    }

    /// Coefficient of the pressure.
    #[getter]
    fn pressure(&self) -> f64 {
        self.0.pressure
    }

    /// Coefficient of the shear traction.
    #[getter]
    fn shear(&self) -> f64 {
        self.0.shear
    }

    /// Right-hand side; in m or Pa if the coefficients have no unit.
    #[getter]
    fn value(&self) -> f64 {
        self.0.value
    }
}

/// Differences below which a law treats numbers as equal: ``length`` for gaps and slips (m), ``traction`` for pressure
/// and shear (Pa).
#[pyclass(name = "Tolerance", module = "basemat", frozen)]
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct PyTolerance(pub(crate) Tolerance);

#[pymethods]
impl PyTolerance {
    #[new]
    fn new(length: f64, traction: f64) -> Self {
        Self(Tolerance::new(length, traction))
    }

    /// Difference of gaps and slips, m.
    #[getter]
    fn length(&self) -> f64 {
        self.0.length
    }

    /// Difference of tractions, Pa.
    #[getter]
    fn traction(&self) -> f64 {
        self.0.traction
    }
}

/// A Python object with `limits(start)`.
///
/// In the plane modes and conditions follow from the limits, unless the object has `modes`, `conditions(mode, start)` and
/// `next_mode(mode, start, trial, tolerance)`. Optional are `compliance(mode, start)`, `state_variables`,
/// `initial_state_variables(start)`, `commit(start, end, mode)`, `friction_coefficient` and `check(gravity, time_step)`.
///
/// After an exception the methods return NaN, which ends the step.
#[derive(Clone)]
pub(crate) struct UserLaw {
    object: UserObject,
    modes: Vec<Mode>,
    state_variables: usize,
    friction_coefficient: Option<f64>,
}

/// A law that has only the limits and the compliance of a user's law: its modes and conditions in the plane follow from
/// the limits, by the defaults of the trait.
struct LimitLaw<'a>(&'a UserLaw);

impl InterfaceLaw for LimitLaw<'_> {
    fn limits(&self, start: &PreviousContact<'_>) -> Result<Limits> {
        self.0.limits(start)
    }

    fn compliance(&self, mode: Mode, start: &PreviousContact<'_>) -> [f64; 2] {
        self.0.compliance(mode, start)
    }
}

/// Methods that a law may lack.
const OPTIONAL_METHODS: [&str; 6] =
    ["conditions", "limits", "compliance", "initial_state_variables", "commit", "check"];

/// A condition that ends the step.
const UNDEFINED_CONDITION: Condition = Condition {
    gap: f64::NAN,
    slip: f64::NAN,
    pressure: f64::NAN,
    shear: f64::NAN,
    value: f64::NAN,
};

impl UserLaw {
    pub(crate) fn new(law: &Bound<'_, PyAny>) -> PyResult<Self> {
        let object = UserObject::new(law, "interface law", &OPTIONAL_METHODS)?;
        let state_variables = match attribute(law, "state_variables")? {
            Some(count) => {
                extract_returned::<Count>("state_variables of the interface law", &count)?.0
            }
            None => 0,
        };
        let friction_coefficient = match attribute(law, "friction_coefficient")? {
            Some(value) => {
                Some(extract_returned("friction_coefficient of the interface law", &value)?)
            }
            None => None,
        };
        for method in ["initial_state_variables", "commit"] {
            if state_variables == 0 && object.has(method) {
                let text = "but no `state_variables`, the number of values that it returns";
                return Err(input_error(format!("the law has `{method}`, {text}")));
            }
        }
        let mut user_law =
            Self { object, modes: Vec::new(), state_variables, friction_coefficient };
        user_law.modes = if user_law.object.has("conditions") {
            let names =
                law.getattr_opt("modes")?.ok_or_else(|| input_error("the law has no `modes`"))?;
            let names: Vec<String> = extract_returned("modes of the interface law", &names)?;
            names.iter().map(|name| parse_mode(name)).collect::<PyResult<_>>()?
        } else {
            LimitLaw(&user_law).modes().to_vec()
        };
        Ok(user_law)
    }

    /// Replaces the state variables by the numbers that a method returns, which must be as many.
    fn update_state_variables<A: for<'py> PyCallArgs<'py>>(
        &self,
        method: &str,
        arguments: impl FnOnce(Python<'_>) -> PyResult<A>,
        state_variables: &mut [f64],
    ) {
        let variable_count = state_variables.len();
        let returned_values = call_unless_raised(None, |py| {
            let Numbers(values) = self.object.call(py, method, arguments(py)?)?;
            if values.len() == variable_count {
                return Ok(Some(values));
            }
            let value_count = values.len();
            Err(input_error(format!(
                "the law has {variable_count} state variables, but returned {value_count} numbers"
            )))
        });
        match returned_values {
            Some(values) => state_variables.copy_from_slice(&values),
            None => state_variables.fill(f64::NAN),
        }
    }
}

/// An attribute of an object, unless it is missing or None.
fn attribute<'py>(object: &Bound<'py, PyAny>, name: &str) -> PyResult<Option<Bound<'py, PyAny>>> {
    Ok(object.getattr_opt(name)?.filter(|value| !value.is_none()))
}

impl InterfaceLaw for UserLaw {
    fn modes(&self) -> &[Mode] {
        &self.modes
    }

    fn conditions(&self, mode: Mode, start: &PreviousContact<'_>) -> [Condition; 2] {
        if !self.object.has("conditions") {
            return LimitLaw(self).conditions(mode, start);
        }
        call_unless_raised([UNDEFINED_CONDITION; 2], |py| {
            let arguments = (mode_name(mode), PyPreviousContact::from_core(py, start)?);
            let conditions: [Bound<'_, PyCondition>; 2] =
                self.object.call(py, "conditions", arguments)?;
            Ok(conditions.map(|condition| condition.get().0))
        })
    }

    fn next_mode(
        &self,
        mode: Mode,
        start: &PreviousContact<'_>,
        trial: &ContactState,
        tolerance: Tolerance,
    ) -> Mode {
        if !self.object.has("conditions") {
            return LimitLaw(self).next_mode(mode, start, trial, tolerance);
        }
        call_unless_raised(mode, |py| {
            let start = PyPreviousContact::from_core(py, start)?;
            let arguments =
                (mode_name(mode), start, PyContactState(*trial), PyTolerance(tolerance));
            let next_name: String = self.object.call(py, "next_mode", arguments)?;
            parse_mode(&next_name)
        })
    }

    fn check_start(&self, start: &PreviousContact<'_>) -> Result<()> {
        if self.object.has("conditions") {
            Ok(())
        } else {
            LimitLaw(self).check_start(start)
        }
    }

    /// The core calls this before it accepts a step, so that a stored exception of `next_mode` ends the step.
    fn compliance(&self, mode: Mode, start: &PreviousContact<'_>) -> [f64; 2] {
        if !self.object.has("compliance") {
            return if has_stored_exception() { [f64::NAN; 2] } else { [0.0; 2] };
        }
        call_unless_raised([f64::NAN; 2], |py| {
            let arguments = (mode_name(mode), PyPreviousContact::from_core(py, start)?);
            self.object.call(py, "compliance", arguments)
        })
    }

    fn state_variables(&self) -> usize {
        self.state_variables
    }

    fn initial_state_variables(&self, start: &PreviousContact<'_>, state_variables: &mut [f64]) {
        if self.object.has("initial_state_variables") {
            self.update_state_variables(
                "initial_state_variables",
                |py| Ok((PyPreviousContact::from_core(py, start)?,)),
                state_variables,
            );
        }
    }

    fn commit(
        &self,
        start: &PreviousContact<'_>,
        end: &ContactState,
        mode: Mode,
        state_variables: &mut [f64],
    ) {
        if self.object.has("commit") {
            self.update_state_variables(
                "commit",
                |py| {
                    let start = PyPreviousContact::from_core(py, start)?;
                    Ok((start, PyContactState(*end), mode_name(mode)))
                },
                state_variables,
            );
        }
    }

    fn limits(&self, start: &PreviousContact<'_>) -> Result<Limits> {
        if !self.object.has("limits") {
            // This stores no exception: the core also calls it for laws of the plane, which need no `limits`.
            let name = Python::attach(|py| {
                let name = self.object.bind(py).get_type().name();
                name.map_or_else(|_| "interface law".into(), |name| name.to_string())
            });
            let reason = "it has no method `limits`, which a ground in plan needs";
            return Err(basemat::Error::part(name, reason));
        }
        self.object.try_call(|py| {
            let start = (PyPreviousContact::from_core(py, start)?,);
            let limits: Bound<'_, PyLimits> = self.object.call(py, "limits", start)?;
            Ok(limits.get().0)
        })
    }

    fn friction_coefficient(&self) -> Option<f64> {
        self.friction_coefficient
    }

    fn check(&self, scene: &ContactScene) -> Result<()> {
        if !self.object.has("check") {
            return Ok(());
        }
        let arguments = (scene.gravity, scene.time_step);
        self.object
            .try_call(|py| self.object.bind(py).call_method1("check", arguments).map(|_| ()))
    }
}
