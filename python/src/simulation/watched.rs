//! Run and its observers.

use std::ops::ControlFlow;

use basemat::Simulation;
use basemat::coupled::State;
use basemat::results::Run;
use basemat::results::TimeSeries;
use pyo3::prelude::*;

use super::PyState;
use crate::dof_names::DofNames;
use crate::error::{OrRaise, has_raised, raise, returned, take_raised};
use crate::results::PyRun;
use crate::ticker::{Ticker, watched};

/// Run and its observers.
pub(super) struct Watched {
    ticker: Ticker,
    steps: usize,
    observe: Option<Py<PyAny>>,
    observe_every: usize,
    time_series: Option<TimeSeries>,
    done: usize,
    stopped: Option<PyErr>,
}

impl Watched {
    pub(super) fn new(
        progress: Option<Py<PyAny>>,
        steps: usize,
        observe: Option<Py<PyAny>>,
        observe_every: usize,
        time_series: Option<TimeSeries>,
    ) -> Self {
        let ticker = Ticker::new(progress);
        Self { ticker, steps, observe, observe_every, time_series, done: 0, stopped: None }
    }

    pub(super) fn see(&mut self, state: &State) -> ControlFlow<()> {
        self.done += 1;
        let recorded = self.time_series.as_mut().map_or(Ok(()), |own| own.record(state).or_raise());
        match recorded.and_then(|()| self.ask(state)) {
            Ok(flow) => flow,
            Err(error) => {
                self.stopped = Some(error);
                ControlFlow::Break(())
            }
        }
    }

    /// The observer, the ticker, and what user code has raised while the step was committed.
    fn ask(&mut self, state: &State) -> PyResult<ControlFlow<()>> {
        if has_raised() {
            return Ok(ControlFlow::Break(()));
        }
        self.ticker.tick(self.done, self.steps)?;
        let Some(observe) =
            self.observe.as_ref().filter(|_| self.done.is_multiple_of(self.observe_every))
        else {
            return Ok(ControlFlow::Continue(()));
        };
        let ends = Python::attach(|py| {
            let found = observe.call1(py, (PyState(state.clone()),))?;
            returned::<Option<bool>>("observe", found.bind(py))
        })?;
        Ok(if ends == Some(true) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    }

    /// The run, or what ended it.
    pub(super) fn end(
        mut self,
        result: basemat::Result<Run>,
        names: Option<&DofNames>,
    ) -> PyResult<PyRun> {
        let raised = take_raised().or(self.stopped.take());
        let last = Python::attach(|py| self.ticker.look(py, self.done, self.steps));
        if let Some(raised) = raised {
            return Err(raised);
        }
        let run = result.map_err(raise)?;
        last?;
        Ok(PyRun::new(run, self.time_series, names.map(DofNames::to_vec)))
    }
}

/// Lets the ground compute what the next step takes, by powers of two of steps, with an ear for Ctrl-C.
pub(super) fn prepared(simulation: &mut Simulation) -> PyResult<()> {
    let done = simulation.state().step;
    if !done.is_power_of_two() {
        return Ok(());
    }
    watched(None, |observer| match simulation.prepare(1, observer) {
        // A step that does not fit into the memory says so itself.
        Err(basemat::Error::Memory(_)) => Ok(()),
        outcome => outcome,
    })
}

/// Result of a step, after the core has returned.
pub(super) fn settled<T>(result: basemat::Result<T>) -> PyResult<T> {
    match take_raised() {
        Some(raised) => Err(raised),
        None => result.or_raise(),
    }
}
