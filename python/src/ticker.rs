//! Signals (Ctrl-C), progress and cancellation during a long call.

use std::cell::RefCell;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use basemat::{Observer, Progress};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

use crate::error::{OrRaise, show, take_raised};

/// Time between two looks at Python.
const INTERVAL: Duration = Duration::from_millis(50);

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

/// Warns where Ctrl-C does not come to Python's ears.
fn check_interrupt(py: Python<'_>) -> PyResult<()> {
    let signal = py.import("signal")?;
    let handler = signal.call_method1("getsignal", (signal.getattr("SIGINT")?,))?;
    if handler.eq(signal.getattr("SIG_IGN")?)? {
        let text = "Ctrl-C does not end this run: the process ignores SIGINT, as one does that a script \
                    starts in the background; signal.signal(signal.SIGINT, \
                    signal.default_int_handler) before it changes that";
        show(py, text.into())?;
    }
    Ok(())
}

/// Looks at Python every 50 ms.
pub(crate) struct Ticker {
    last: Instant,
    /// Whether the ticker has checked whether Ctrl-C is handled.
    asked: bool,
    /// Called with what is done and with all that there is to do.
    progress: Option<Py<PyAny>>,
    /// Parts done at the last call of `progress`.
    told: Option<usize>,
}

impl Ticker {
    pub(crate) fn new(progress: Option<Py<PyAny>>) -> Self {
        Self { last: Instant::now(), asked: false, progress, told: None }
    }

    /// Reports a part of the work, `done` of `total` in all; to be called without the GIL.
    pub(crate) fn tick(&mut self, done: usize, total: usize) -> PyResult<()> {
        if self.last.elapsed() < INTERVAL {
            return Ok(());
        }
        let result = Python::attach(|py| {
            if !std::mem::replace(&mut self.asked, true) {
                check_interrupt(py)?;
            }
            self.look(py, done, total)
        });
        self.last = Instant::now();
        result
    }

    /// Signals, cancellation and progress.
    pub(crate) fn look(&mut self, py: Python<'_>, done: usize, total: usize) -> PyResult<()> {
        py.check_signals()?;
        let event = CANCELLED.with_borrow(|event| event.as_ref().map(|event| event.clone_ref(py)));
        if let Some(event) = event
            && event.call_method0(py, "is_set")?.is_truthy(py)?
        {
            return Err(PyKeyboardInterrupt::new_err("cancelled"));
        }
        if let Some(progress) = &self.progress {
            self.told = Some(done);
            progress.call1(py, (done, total))?;
        }
        Ok(())
    }
}

/// Function to which progress is reported: a line of the package's own for True, none for False.
pub(crate) fn progress_function(
    given: Option<&Bound<'_, PyAny>>,
    items: &str,
) -> PyResult<Option<Py<PyAny>>> {
    match given {
        Some(function) if function.is_callable() => Ok(Some(function.clone().unbind())),
        Some(flag) if flag.is_truthy()? => {
            let line = flag.py().import("basemat._progress")?.call_method1("Line", (items,))?;
            Ok(Some(line.unbind()))
        }
        _ => Ok(None),
    }
}

/// Observer of a long call of the core; to be used without the GIL.
pub(crate) struct Watching {
    ticker: Ticker,
    stopped: Option<PyErr>,
    last: Option<Progress>,
}

impl Watching {
    pub(crate) fn new(progress: Option<Py<PyAny>>) -> Self {
        Self { ticker: Ticker::new(progress), stopped: None, last: None }
    }

    pub(crate) fn see(&mut self, progress: Progress) -> ControlFlow<()> {
        self.last = Some(progress);
        match self.ticker.tick(progress.done, progress.total) {
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => {
                self.stopped = Some(error);
                ControlFlow::Break(())
            }
        }
    }

    /// Result of the call, or the exception that ended it.
    pub(crate) fn end<T>(&mut self, result: basemat::Result<T>) -> PyResult<T> {
        if let Some(raised) = take_raised().or(self.stopped.take()) {
            return Err(raised);
        }
        let made = result.or_raise()?;
        // Ends a line that has begun.
        if let Some(Progress { total, .. }) = self.last
            && self.ticker.told.is_some_and(|told| told < total)
        {
            Python::attach(|py| self.ticker.look(py, total, total))?;
        }
        Ok(made)
    }
}

/// Makes a long call of the core; to be called without the GIL.
pub(crate) fn watched<T>(
    progress: Option<Py<PyAny>>,
    call: impl FnOnce(&mut Observer<'_>) -> basemat::Result<T>,
) -> PyResult<T> {
    let mut watching = Watching::new(progress);
    let result = call(&mut |progress| watching.see(progress));
    watching.end(result)
}
