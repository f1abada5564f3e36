//! Signals (Ctrl-C), progress and cancellation during a long call.

use std::cell::RefCell;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use basemat::{Observer, Progress};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

use crate::error::{OrRaise, issue_warning, take_exception};

/// Time between two calls of Python for signals, cancellation and progress.
const REPORT_INTERVAL: Duration = Duration::from_millis(50);

thread_local! {
    /// An event (`is_set`) that ends the runs of this thread.
    static CANCELLED: RefCell<Option<Py<PyAny>>> = const { RefCell::new(None) };
}

/// Runs of this thread end with ``KeyboardInterrupt`` once ``event.is_set()``; None for no event.
#[pyfunction(name = "_cancel_when")]
#[pyo3(signature = (event=None))]
pub(crate) fn cancel_when(event: Option<Py<PyAny>>) {
    let before = CANCELLED.replace(event);
    drop(before);
}

/// Warns where Python ignores Ctrl-C.
fn warn_of_ignored_interrupt(py: Python<'_>) -> PyResult<()> {
    let signal = py.import("signal")?;
    let handler = signal.call_method1("getsignal", (signal.getattr("SIGINT")?,))?;
    if handler.eq(signal.getattr("SIG_IGN")?)? {
        let text = "Ctrl-C does not end this run: the process ignores SIGINT, as one does that a script \
                    starts in the background; signal.signal(signal.SIGINT, \
                    signal.default_int_handler) before it changes that";
        issue_warning(py, text.into())?;
    }
    Ok(())
}

/// Calls Python every 50 ms during a long calculation: for signals, cancellation and progress.
pub(crate) struct Ticker {
    last_call: Instant,
    /// Whether the handling of Ctrl-C has been checked.
    interrupt_checked: bool,
    /// Function of the number of parts done and of the number of all parts.
    progress: Option<Py<PyAny>>,
    /// Parts done at the last call of `progress`.
    last_reported: Option<usize>,
}

impl Ticker {
    pub(crate) fn new(progress: Option<Py<PyAny>>) -> Self {
        Self {
            last_call: Instant::now(),
            interrupt_checked: false,
            progress,
            last_reported: None,
        }
    }

    /// Reports `done` of `total` parts if the interval has passed; called without the GIL.
    pub(crate) fn tick(&mut self, done: usize, total: usize) -> PyResult<()> {
        if self.last_call.elapsed() < REPORT_INTERVAL {
            return Ok(());
        }
        let result = Python::attach(|py| {
            if !std::mem::replace(&mut self.interrupt_checked, true) {
                warn_of_ignored_interrupt(py)?;
            }
            self.call_python(py, done, total)
        });
        self.last_call = Instant::now();
        result
    }

    /// Handles signals and cancellation, and calls the progress function.
    pub(crate) fn call_python(
        &mut self,
        py: Python<'_>,
        done: usize,
        total: usize,
    ) -> PyResult<()> {
        py.check_signals()?;
        let event = CANCELLED.with_borrow(|event| event.as_ref().map(|event| event.clone_ref(py)));
        if let Some(event) = event
            && event.call_method0(py, "is_set")?.is_truthy(py)?
        {
            return Err(PyKeyboardInterrupt::new_err("cancelled"));
        }
        if let Some(progress) = &self.progress {
            self.last_reported = Some(done);
            progress.call1(py, (done, total))?;
        }
        Ok(())
    }
}

/// The function that reports progress: for True one that writes a line on stderr, for False none.
pub(crate) fn progress_function(
    progress: Option<&Bound<'_, PyAny>>,
    items: &str,
) -> PyResult<Option<Py<PyAny>>> {
    match progress {
        Some(function) if function.is_callable() => Ok(Some(function.clone().unbind())),
        Some(flag) if flag.is_truthy()? => {
            let line = flag.py().import("basemat._progress")?.call_method1("Line", (items,))?;
            Ok(Some(line.unbind()))
        }
        _ => Ok(None),
    }
}

/// Observer of a long call of the core; used without the GIL.
pub(crate) struct ProgressObserver {
    ticker: Ticker,
    /// The exception that stopped the call.
    exception: Option<PyErr>,
    last_progress: Option<Progress>,
}

impl ProgressObserver {
    pub(crate) fn new(progress: Option<Py<PyAny>>) -> Self {
        Self { ticker: Ticker::new(progress), exception: None, last_progress: None }
    }

    pub(crate) fn update(&mut self, progress: Progress) -> ControlFlow<()> {
        self.last_progress = Some(progress);
        match self.ticker.tick(progress.done, progress.total) {
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => {
                self.exception = Some(error);
                ControlFlow::Break(())
            }
        }
    }

    /// Result of the call, or the exception that ended it.
    pub(crate) fn end<T>(&mut self, result: basemat::Result<T>) -> PyResult<T> {
        if let Some(exception) = take_exception().or(self.exception.take()) {
            return Err(exception);
        }
        let value = result.or_raise()?;
        // Completes a progress line that has begun.
        if let Some(Progress { total, .. }) = self.last_progress
            && self.ticker.last_reported.is_some_and(|done| done < total)
        {
            Python::attach(|py| self.ticker.call_python(py, total, total))?;
        }
        Ok(value)
    }
}

/// Result of a long call of the core that Ctrl-C, cancellation or an exception may stop; called without the GIL.
pub(crate) fn with_progress<T>(
    progress: Option<Py<PyAny>>,
    call: impl FnOnce(&mut Observer<'_>) -> basemat::Result<T>,
) -> PyResult<T> {
    let mut observer = ProgressObserver::new(progress);
    let result = call(&mut |progress| observer.update(progress));
    observer.end(result)
}
