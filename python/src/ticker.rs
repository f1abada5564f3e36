//! Signals (Ctrl-C), progress and cancellation during a long call.

use std::cell::RefCell;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use basemat::{Observer, Progress};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

use crate::error::{OrRaise, issue_warning, take_exception};

/// Time between two calls of Python: short for a reader, and long compared with the duration of a call.
const REPORT_INTERVAL: Duration = Duration::from_millis(50);

thread_local! {
    /// An event (`is_set`) that ends the runs of this thread.
    static CANCELLATION_EVENT: RefCell<Option<Py<PyAny>>> = const { RefCell::new(None) };
}

/// Runs of this thread end with ``KeyboardInterrupt`` once ``event.is_set()``; None for no event.
#[pyfunction(name = "_cancel_when")]
#[pyo3(signature = (event=None))]
pub(crate) fn cancel_when(event: Option<Py<PyAny>>) {
    let previous_event = CANCELLATION_EVENT.replace(event);
    drop(previous_event);
}

/// Warns if the process ignores Ctrl-C.
fn warn_of_ignored_interrupt(py: Python<'_>) -> PyResult<()> {
    let signal = py.import("signal")?;
    let handler = signal.call_method1("getsignal", (signal.getattr("SIGINT")?,))?;
    if handler.eq(signal.getattr("SIG_IGN")?)? {
        let text = "Ctrl-C does not end this run: the process ignores SIGINT, as processes that a script \
                    starts in the background do. To enable Ctrl-C, call signal.signal(signal.SIGINT, \
                    signal.default_int_handler) before the run";
        issue_warning(py, text.into())?;
    }
    Ok(())
}

/// Calls Python every 50 ms during a long calculation: for signals, cancellation and progress.
pub(crate) struct Ticker {
    last_call_time: Instant,
    /// Whether the handling of Ctrl-C has been checked.
    is_interrupt_checked: bool,
    /// Function of the number of parts done and of the number of all parts.
    report_progress: Option<Py<PyAny>>,
    /// Parts done at the last call of `report_progress`.
    last_reported_part: Option<usize>,
}

impl Ticker {
    pub(crate) fn new(report_progress: Option<Py<PyAny>>) -> Self {
        Self {
            last_call_time: Instant::now(),
            is_interrupt_checked: false,
            report_progress,
            last_reported_part: None,
        }
    }

    /// Reports progress if the interval has passed; called without the GIL.
    pub(crate) fn tick(&mut self, parts_done: usize, part_count: usize) -> PyResult<()> {
        if self.last_call_time.elapsed() < REPORT_INTERVAL {
            return Ok(());
        }
        let result = Python::attach(|py| {
            if !std::mem::replace(&mut self.is_interrupt_checked, true) {
                warn_of_ignored_interrupt(py)?;
            }
            self.call_python(py, parts_done, part_count)
        });
        self.last_call_time = Instant::now();
        result
    }

    /// Handles signals and cancellation, and calls the progress function.
    pub(crate) fn call_python(
        &mut self,
        py: Python<'_>,
        parts_done: usize,
        part_count: usize,
    ) -> PyResult<()> {
        py.check_signals()?;
        let event =
            CANCELLATION_EVENT.with_borrow(|event| event.as_ref().map(|event| event.clone_ref(py)));
        if let Some(event) = event
            && event.call_method0(py, "is_set")?.is_truthy(py)?
        {
            return Err(PyKeyboardInterrupt::new_err("cancelled"));
        }
        if let Some(report_progress) = &self.report_progress {
            self.last_reported_part = Some(parts_done);
            report_progress.call1(py, (parts_done, part_count))?;
        }
        Ok(())
    }
}

/// Function that reports progress on items of this name.
///
/// For True it writes a line on stderr; for False or None there is no function.
pub(crate) fn progress_function(
    progress: Option<&Bound<'_, PyAny>>,
    item_name: &str,
) -> PyResult<Option<Py<PyAny>>> {
    match progress {
        Some(function) if function.is_callable() => Ok(Some(function.clone().unbind())),
        Some(flag) if flag.is_truthy()? => {
            let progress_line =
                flag.py().import("basemat._progress")?.call_method1("Line", (item_name,))?;
            Ok(Some(progress_line.unbind()))
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
    pub(crate) fn new(report_progress: Option<Py<PyAny>>) -> Self {
        Self { ticker: Ticker::new(report_progress), exception: None, last_progress: None }
    }

    /// Stores the progress and reports it; `Break` ends the call.
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
        // A progress line that has begun ends at 100 %.
        if let Some(Progress { total: part_count, .. }) = self.last_progress
            && self.ticker.last_reported_part.is_some_and(|parts_done| parts_done < part_count)
        {
            Python::attach(|py| self.ticker.call_python(py, part_count, part_count))?;
        }
        Ok(value)
    }
}

/// Result of a long call of the core that Ctrl-C, cancellation or an exception may stop; called without the GIL.
pub(crate) fn with_progress<T>(
    report_progress: Option<Py<PyAny>>,
    call: impl FnOnce(&mut Observer<'_>) -> basemat::Result<T>,
) -> PyResult<T> {
    let mut observer = ProgressObserver::new(report_progress);
    let result = call(&mut |progress| observer.update(progress));
    observer.end(result)
}
