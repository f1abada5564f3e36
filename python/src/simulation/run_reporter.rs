//! Work after each step of a run: time series, progress and the observer of the user.

use std::ops::ControlFlow;

use basemat::Simulation;
use basemat::coupled::State;
use basemat::results::{Run, TimeSeries};
use pyo3::prelude::*;

use super::PyState;
use crate::error::{OrRaise, extract_returned, has_stored_exception, take_exception, to_exception};
use crate::names::DofNames;
use crate::results::PyRun;
use crate::ticker::{Ticker, with_progress};

/// Records the steps of a run, reports its progress and calls the user's observer.
pub(super) struct RunReporter {
    ticker: Ticker,
    step_count: usize,
    observe: Option<Py<PyAny>>,
    observe_every: usize,
    time_series: Option<TimeSeries>,
    steps_done: usize,
    /// The exception that stopped the run.
    exception: Option<PyErr>,
}

impl RunReporter {
    pub(super) fn new(
        report_progress: Option<Py<PyAny>>,
        step_count: usize,
        observe: Option<Py<PyAny>>,
        observe_every: usize,
        time_series: Option<TimeSeries>,
    ) -> Self {
        let ticker = Ticker::new(report_progress);
        Self {
            ticker,
            step_count,
            observe,
            observe_every,
            time_series,
            steps_done: 0,
            exception: None,
        }
    }

    /// Records and reports the state at the end of a step; `Break` ends the run.
    pub(super) fn update(&mut self, state: &State) -> ControlFlow<()> {
        self.steps_done += 1;
        let recording_result =
            self.time_series.as_mut().map_or(Ok(()), |series| series.record(state).or_raise());
        match recording_result.and_then(|()| self.call_observer(state)) {
            Ok(flow) => flow,
            Err(error) => {
                self.exception = Some(error);
                ControlFlow::Break(())
            }
        }
    }

    /// Calls the ticker and the observer, unless user code has raised an exception while the step was committed.
    fn call_observer(&mut self, state: &State) -> PyResult<ControlFlow<()>> {
        if has_stored_exception() {
            return Ok(ControlFlow::Break(()));
        }
        self.ticker.tick(self.steps_done, self.step_count)?;
        let is_due = self.steps_done.is_multiple_of(self.observe_every);
        let Some(observe) = self.observe.as_ref().filter(|_| is_due) else {
            return Ok(ControlFlow::Continue(()));
        };
        let ends_run = Python::attach(|py| {
            let returned_value = observe.call1(py, (PyState(state.clone()),))?;
            extract_returned::<Option<bool>>("observe", returned_value.bind(py))
        })?;
        Ok(if ends_run == Some(true) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        })
    }

    /// The run, or the exception that ended it.
    pub(super) fn end(
        mut self,
        result: basemat::Result<Run>,
        dof_names: Option<&DofNames>,
    ) -> PyResult<PyRun> {
        let exception = take_exception().or(self.exception.take());
        let last_report =
            Python::attach(|py| self.ticker.call_python(py, self.steps_done, self.step_count));
        if let Some(exception) = exception {
            return Err(exception);
        }
        let run = result.map_err(to_exception)?;
        last_report?;
        Ok(PyRun::new(run, self.time_series, dof_names.map(DofNames::to_vec)))
    }
}

/// Prepares the convolution weights of the ground if the number of steps made is a power of two; Ctrl-C may interrupt
/// this.
pub(super) fn prepare_next_step(simulation: &mut Simulation) -> PyResult<()> {
    let steps_made = simulation.state().step;
    if !steps_made.is_power_of_two() {
        return Ok(());
    }
    with_progress(None, |observer| match simulation.prepare(1, observer) {
        // The step itself raises the error if it does not fit into the memory.
        Err(basemat::Error::Memory(_)) => Ok(()),
        outcome => outcome,
    })
}

/// Result of a call of the core, or the exception that user code raised in it.
pub(super) fn step_result<T>(result: basemat::Result<T>) -> PyResult<T> {
    match take_exception() {
        Some(exception) => Err(exception),
        None => result.or_raise(),
    }
}
