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

/// Stores an exception of user code until the core returns; a stored one stays.
pub(crate) fn store_exception(error: PyErr) {
    STORED_EXCEPTION.with_borrow_mut(|stored| {
        stored.get_or_insert(error);
    });
}

/// Whether an exception of user code is stored on this thread.
pub(crate) fn has_stored_exception() -> bool {
    STORED_EXCEPTION.with_borrow(Option::is_some)
}

/// Result of user code; if it raises, the exception is stored and the result is `fallback`, which ends the step.
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

/// The result of a call of user code whose exceptions are not stored.
pub(crate) fn discard_exceptions<T>(
    call: impl FnOnce() -> basemat::Result<T>,
) -> basemat::Result<T> {
    let outer = take_exception();
    let found = call();
    STORED_EXCEPTION.set(outer);
    found
}

/// The result of a call that may run user code, or the exception that this code raised. One that was
/// there before belongs to a run around this call and stays for it.
pub(crate) fn raise_user_exceptions<T>(call: impl FnOnce() -> PyResult<T>) -> PyResult<T> {
    let outer = has_stored_exception();
    let found = call();
    match if outer { None } else { take_exception() } {
        Some(raised) => Err(raised),
        None => found,
    }
}

/// Stores an exception of user code, and returns an error of the core in its place.
pub(crate) fn user_code_error(part: &'static str, error: PyErr) -> basemat::Error {
    let text = error.to_string();
    store_exception(error);
    basemat::Error::part(part, text)
}

/// An `InputError` with this text.
pub(crate) fn input_error(text: impl Into<String>) -> PyErr {
    classes::InputError::new_err(text.into())
}

/// Value returned by a function of the user's, extracted as a `T`; `name` is the function's name.
pub(crate) fn extract_returned<'py, T>(name: &str, value: &Bound<'py, PyAny>) -> PyResult<T>
where
    T: for<'a> FromPyObject<'a, 'py>,
{
    value.extract::<T>().map_err(Into::into).map_err(|reason: PyErr| {
        input_error(format!("{name} returned what will not do: {}", reason.value(value.py())))
    })
}

/// A warning of the package, at the line of Python that is being run; in a case of a sweep, for its table.
pub(crate) fn warn(py: Python<'_>, text: String) -> PyResult<()> {
    let mut text = Some(text);
    COLLECTED_WARNINGS.with_borrow_mut(|texts| {
        if let Some(texts) = texts {
            texts.extend(text.take());
        }
    });
    text.map_or(Ok(()), |text| issue_warning(py, text))
}

/// Collects the warnings of this thread from now on, or shows them again; returns those that it has collected.
#[pyfunction(name = "_collect_warnings")]
pub(crate) fn collect_warnings(collect: bool) -> Vec<String> {
    COLLECTED_WARNINGS.replace(collect.then(Vec::new)).unwrap_or_default()
}

/// Issues a `BasematWarning`, also in a case of a sweep.
pub(crate) fn issue_warning(py: Python<'_>, text: String) -> PyResult<()> {
    let text = CString::new(text)?;
    PyErr::warn(py, &py.get_type::<classes::BasematWarning>(), &text, 1)
}

/// An `Error` that says why a simulation cannot be used.
pub(crate) fn lock_error<T>(reason: TryLockError<T>) -> PyErr {
    classes::Error::new_err(match reason {
        TryLockError::WouldBlock => {
            "the simulation is running (in another thread, or around this call)"
        }
        TryLockError::Poisoned(_) => {
            "the simulation cannot be used any more: an earlier call ended in a panic"
        }
    })
}

/// A message of the core, with Python's names in place of the core's functions.
pub(crate) fn in_python_words(mut text: String) -> String {
    for (core, python) in [
        (
            "`analyses::largest_convergent_step` finds a time step that converges",
            "a shorter step may converge",
        ),
        ("GeneralizedMaxwell::constant_q", "DampingLaw.constant_q"),
        ("`Midpoint`", "`TimeScheme.midpoint()`"),
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
        ("site::SoilColumn", "SoilColumn"),
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
        text = text.replace(core, python);
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
                // An exception whose attributes cannot be set is raised without them.
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
    fn or_raise(self) -> PyResult<T>;
}

impl<T> OrRaise<T> for basemat::Result<T> {
    fn or_raise(self) -> PyResult<T> {
        self.map_err(to_exception)
    }
}

/// A builder of the core, whose methods are called for optional arguments that are there.
pub(crate) trait WithOption<B>: Sized {
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
