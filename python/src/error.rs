//! Errors of the core as Python's exceptions, and exceptions that user code raised inside a step.

use std::cell::RefCell;
use std::ffi::CString;
use std::sync::TryLockError;

use pyo3::prelude::*;

/// The exception classes, defined in Python.
mod classes {
    pyo3::import_exception!(basemat._errors, BasematWarning);
    pyo3::import_exception!(basemat._errors, CheckpointError);
    pyo3::import_exception!(basemat._errors, Error);
    pyo3::import_exception!(basemat._errors, FileError);
    pyo3::import_exception!(basemat._errors, InputError);
    pyo3::import_exception!(basemat._errors, StepError);
}

thread_local! {
    /// Warnings for the table of a sweep, while one of its cases runs on this thread.
    static COLLECTED_WARNINGS: RefCell<Option<Vec<String>>> = const { RefCell::new(None) };

    /// The first exception that a user's structure, law or function has raised on this thread
    /// while the core was running.
    static STORED_EXCEPTION: RefCell<Option<PyErr>> = const { RefCell::new(None) };
}

/// Stores an exception of user code until the core returns; an earlier exception stays stored instead.
pub(crate) fn store_exception(error: PyErr) {
    STORED_EXCEPTION.with_borrow_mut(|stored| {
        stored.get_or_insert(error);
    });
}

/// Whether an exception of user code is stored on this thread.
pub(crate) fn has_stored_exception() -> bool {
    STORED_EXCEPTION.with_borrow(Option::is_some)
}

/// Result of user code, or `fallback`, which ends the step, if the code raises an exception.
///
/// The exception is stored until the core returns.
pub(crate) fn call_user_code<T>(fallback: T, call: impl FnOnce(Python<'_>) -> PyResult<T>) -> T {
    Python::attach(call).unwrap_or_else(|error| {
        store_exception(error);
        fallback
    })
}

/// Takes the stored exception of user code, if there is one.
pub(crate) fn take_exception() -> Option<PyErr> {
    STORED_EXCEPTION.take()
}

/// Result of a call of user code whose exceptions are dropped.
pub(crate) fn discard_exceptions<T>(
    call: impl FnOnce() -> basemat::Result<T>,
) -> basemat::Result<T> {
    let outer_exception = take_exception();
    let result = call();
    STORED_EXCEPTION.set(outer_exception);
    result
}

/// Result of a call that may run user code, or the exception that this code raised.
///
/// An exception that was stored before belongs to an outer run and stays stored.
pub(crate) fn raise_user_exceptions<T>(call: impl FnOnce() -> PyResult<T>) -> PyResult<T> {
    let has_outer_exception = has_stored_exception();
    let result = call();
    match if has_outer_exception { None } else { take_exception() } {
        Some(raised) => Err(raised),
        None => result,
    }
}

/// Error of the core in place of an exception of user code, which is stored.
pub(crate) fn user_code_error(part: &'static str, error: PyErr) -> basemat::Error {
    let text = error.to_string();
    store_exception(error);
    basemat::Error::part(part, text)
}

/// An `InputError` with this text.
pub(crate) fn input_error(text: impl Into<String>) -> PyErr {
    classes::InputError::new_err(text.into())
}

/// Value that the function `name` of the user returned, as a `T`.
pub(crate) fn extract_returned<'py, T>(name: &str, value: &Bound<'py, PyAny>) -> PyResult<T>
where
    T: for<'a> FromPyObject<'a, 'py>,
{
    value.extract::<T>().map_err(Into::into).map_err(|reason: PyErr| {
        input_error(format!("{name} returned an invalid value: {}", reason.value(value.py())))
    })
}

/// Issues a warning of the package; while a case of a sweep runs, the warning is collected for the table of the sweep
/// instead.
pub(crate) fn warn(py: Python<'_>, text: String) -> PyResult<()> {
    let mut text = Some(text);
    COLLECTED_WARNINGS.with_borrow_mut(|texts| {
        if let Some(texts) = texts {
            texts.extend(text.take());
        }
    });
    text.map_or(Ok(()), |text| issue_warning(py, text))
}

/// Starts to ``collect`` the warnings of this thread, or shows warnings again; returns the warnings collected so far.
#[pyfunction(name = "_collect_warnings")]
pub(crate) fn collect_warnings(collect: bool) -> Vec<String> {
    COLLECTED_WARNINGS.replace(collect.then(Vec::new)).unwrap_or_default()
}

/// Issues a `BasematWarning`, also in a case of a sweep.
pub(crate) fn issue_warning(py: Python<'_>, text: String) -> PyResult<()> {
    let text = CString::new(text)?;
    PyErr::warn(py, &py.get_type::<classes::BasematWarning>(), &text, 1)
}

/// `Error` with the reason why a simulation cannot be used.
pub(crate) fn lock_error<T>(reason: TryLockError<T>) -> PyErr {
    classes::Error::new_err(match reason {
        TryLockError::WouldBlock => {
            "the simulation is running (in another thread, or in a caller of this function)"
        }
        TryLockError::Poisoned(_) => "the simulation is unusable: an earlier call ended in a panic",
    })
}

/// Message of the core with Python's names in place of Rust's.
pub(crate) fn in_python_words(mut text: String) -> String {
    for (core_text, python_text) in [
        (
            "`analyses::largest_convergent_step` finds a time step that converges",
            "a shorter step may converge",
        ),
        ("GeneralizedMaxwell::constant_q", "DampingLaw.constant_q"),
        ("`Midpoint`", "`TimeScheme.midpoint()`"),
        ("`with_law` sets another one", "give another `law`"),
        ("`GravityStage::Unloaded`", "`gravity_stage=\"unloaded\"`"),
        ("`GravityStage::Frictional`", "`gravity_stage=\"frictional\"`"),
        ("`FemModel::in_trench`", "`FemModel(…, in_trench=True)`"),
        ("`HistoryOptions::memory`", "`history_memory`"),
        ("`bem::plan::impedances_in_plan`", "`Plan.impedances`"),
        ("GmshMesh::foundations", "GmshMesh.foundations"),
        ("TrenchGround::interfaces", "TrenchGround.interfaces"),
        (" (Element::with_nodes)", ""),
        ("DofCombination::of_base", "DofCombination.of_base"),
        ("LumpedMass::in_space", "`add_mass` with three numbers"),
        ("FiberSection::with_torsional_stiffness", "FiberSection.with_torsional_stiffness"),
        ("QuadFormulation::MeanDilatation", "\"mean_dilatation\""),
        ("site::SoilColumn", "SoilColumn"),
        ("`Mesh::merge_nodes`", "`Mesh.merge_nodes`"),
        ("`Ground::elements`", "`ground.elements`"),
        ("`Record::padded`", "`Record.padded`"),
        ("`Incoherence::clipped`", "`Incoherence(clipped=True)`"),
        ("`TrenchGround::with_water_table`", "`TrenchGround(water_table=…)`"),
        (
            "a recorder of fewer steps takes less",
            "larger `every`, `contact_every`, `motion_every` or `series=False` take less",
        ),
        (
            "the recorder must keep the contact (`Recorder::contact`)",
            "give `contact_every` to `run`",
        ),
        ("the recorder must keep the motion (`Recorder::motion`)", "give `motion_every` to `run`"),
    ] {
        text = text.replace(core_text, python_text);
    }
    text
}

/// The exception of user code that led to `error`, or an exception with the full text of the core.
pub(crate) fn to_exception(error: basemat::Error) -> PyErr {
    use basemat::Error as Core;
    use basemat::sweep::SweepError::{Missing, Unwritten};
    if let Some(exception) = take_exception() {
        return exception;
    }
    let text = in_python_words(error.to_string());
    match error {
        Core::Step { step, time, .. } => {
            let exception = classes::StepError::new_err(text);
            Python::attach(|py| {
                let value = exception.value(py);
                // If setting an attribute fails, the exception is raised without it.
                let _ = value.setattr("step", step).and_then(|()| value.setattr("time", time));
            });
            exception
        }
        Core::Checkpoint(_) => classes::CheckpointError::new_err(text),
        Core::File(_) | Core::Sweep(Missing { .. } | Unwritten { .. }) => {
            classes::FileError::new_err(text)
        }
        _ => classes::InputError::new_err(text),
    }
}

/// Results of the core as results of Python.
pub(crate) trait OrRaise<T> {
    /// The value, or the exception for the error.
    fn or_raise(self) -> PyResult<T>;
}

impl<T> OrRaise<T> for basemat::Result<T> {
    fn or_raise(self) -> PyResult<T> {
        self.map_err(to_exception)
    }
}

/// Calls methods of a builder for those optional arguments that are present.
pub(crate) trait WithOption<B>: Sized {
    /// The builder after its `method` with the argument, if there is one.
    fn with<T>(
        self,
        argument: Option<T>,
        method: impl FnOnce(B, T) -> basemat::Result<B>,
    ) -> basemat::Result<B>;
}

impl<B> WithOption<B> for basemat::Result<B> {
    fn with<T>(
        self,
        argument: Option<T>,
        method: impl FnOnce(B, T) -> basemat::Result<B>,
    ) -> basemat::Result<B> {
        match argument {
            Some(argument) => method(self?, argument),
            None => self,
        }
    }
}
