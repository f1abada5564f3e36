//! Signals (Ctrl-C), progress and cancellation during a run.

use std::cell::RefCell;
use std::time::{Duration, Instant};

use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

use crate::error::warn;

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
        warn(py, text.into())?;
    }
    Ok(())
}

/// Looks at Python every 50 ms.
pub(super) struct Ticker {
    last: Instant,
    /// Whether it has looked for somebody who hears Ctrl-C.
    asked: bool,
    /// Called with the steps made and the steps in all.
    progress: Option<Py<PyAny>>,
    steps: usize,
}

impl Ticker {
    pub(super) fn new(progress: Option<Py<PyAny>>, steps: usize) -> Self {
        Self { last: Instant::now(), asked: false, progress, steps }
    }

    /// After a step, `done` of them in all; to be called without the GIL.
    pub(super) fn tick(&mut self, done: usize) -> PyResult<()> {
        if self.last.elapsed() < INTERVAL {
            return Ok(());
        }
        let result = Python::attach(|py| {
            if !std::mem::replace(&mut self.asked, true) {
                check_interrupt(py)?;
            }
            self.look(py, done)
        });
        self.last = Instant::now();
        result
    }

    /// Signals, cancellation and progress.
    pub(super) fn look(&self, py: Python<'_>, done: usize) -> PyResult<()> {
        py.check_signals()?;
        let event = CANCELLED.with_borrow(|event| event.as_ref().map(|event| event.clone_ref(py)));
        if let Some(event) = event
            && event.call_method0(py, "is_set")?.is_truthy(py)?
        {
            return Err(PyKeyboardInterrupt::new_err("cancelled"));
        }
        if let Some(progress) = &self.progress {
            progress.call1(py, (done, self.steps))?;
        }
        Ok(())
    }
}
