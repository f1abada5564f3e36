//! The march of one scheme on one row.

use std::ops::ControlFlow::{Break, Continue};
use std::time::Duration;

use basemat::Error;
use basemat::Simulation;
use basemat::coupled::State;
use basemat::coupled::StepError;
use cpu_time::ProcessTime;

use super::scheme::ComparedScheme;

/// Cause of the end of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum MarchEnd {
    /// End of the record.
    Record,
    /// Base shear beyond the limit of [`march`].
    Grew,
    /// The flow chart did not converge.
    NoModes,
}

/// Results of a run.
#[derive(Debug, Clone)]
pub(crate) struct MarchOutcome {
    /// Base shear at every step, N/m.
    pub(crate) shear: Vec<f64>,
    pub(crate) time_step: f64,
    pub(crate) end: MarchEnd,
    /// Processor time of set-up and march.
    pub(crate) processor: Duration,
}

/// Marches until `steps` steps are made, or the base shear is beyond `limit` (N/m).
pub(crate) fn march(
    build: impl FnOnce() -> basemat::Result<Simulation>,
    steps: usize,
    limit: f64,
) -> basemat::Result<MarchOutcome> {
    let start_time = ProcessTime::now();
    let mut simulation = build()?;
    let mut shear = Vec::with_capacity(steps);
    let result = simulation.run(steps, |state: &State| {
        shear.push(state.probes[0]);
        if state.probes[0].abs() > limit { Break(()) } else { Continue(()) }
    });
    let end = match result {
        Ok(_) if shear.len() < steps => MarchEnd::Grew,
        Ok(_) => MarchEnd::Record,
        Err(Error::Step { source: StepError::Contact { .. }, .. }) => MarchEnd::NoModes,
        Err(error) => return Err(error),
    };
    let time_step = simulation.time_step();
    Ok(MarchOutcome { shear, time_step, end, processor: start_time.elapsed() })
}

impl MarchOutcome {
    /// Time at the end of the run, s.
    pub(crate) fn time(&self) -> f64 {
        self.shear.len() as f64 * self.time_step
    }

    /// Largest base shear of the first `steps` steps, N/m.
    pub(crate) fn peak(&self, steps: usize) -> f64 {
        self.shear.iter().take(steps).fold(0.0, |peak, shear| shear.abs().max(peak))
    }

    /// Steps until the base shear differs from that of `reference` by this fraction of its peak.
    pub(crate) fn steps_until_difference(&self, reference: &Self, fraction: f64) -> Option<usize> {
        let limit = fraction * reference.peak(usize::MAX);
        self.shear.iter().zip(&reference.shear).position(|(a, b)| (a - b).abs() > limit)
    }

    /// Root mean square difference of the base shear from `reference` over the first `steps` steps.
    ///
    /// Relative to the root mean square of `reference`.
    pub(crate) fn difference(&self, reference: &Self, steps: usize) -> f64 {
        let pairs = self.shear.iter().zip(&reference.shear).take(steps);
        let difference: f64 = pairs.clone().map(|(a, b)| (a - b).powi(2)).sum();
        let scale: f64 = pairs.map(|(_, b)| b.powi(2)).sum();
        (difference / scale).sqrt()
    }

    /// Growth per step of the difference from `reference` beyond the peak of `reference`, if it grew tenfold or more.
    ///
    /// It is a factor minus one.
    pub(crate) fn growth(&self, reference: &Self) -> Option<f64> {
        let begin = self.steps_until_difference(reference, 1.0)?;
        let differences = self.shear.iter().zip(&reference.shear).map(|(a, b)| (a - b).abs());
        let (end, largest) = differences.enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let factor = largest / reference.peak(usize::MAX);
        (factor > 10.0).then(|| factor.powf(1.0 / (end - begin) as f64) - 1.0)
    }
}

/// A row of Table 1 by all schemes.
pub(crate) struct SchemeRow {
    pub(crate) name: &'static str,
    /// The paper's peak, lb/ft.
    pub(crate) paper_peak: f64,
    pub(crate) outcomes: Vec<(ComparedScheme, MarchOutcome)>,
}

impl SchemeRow {
    pub(crate) fn outcome(&self, scheme: ComparedScheme) -> Option<&MarchOutcome> {
        self.outcomes.iter().find(|(other, _)| *other == scheme).map(|(_, outcome)| outcome)
    }
}
