//! One scheme on one row: how far it marches, and with what.

use std::ops::ControlFlow::{Break, Continue};
use std::time::Duration;

use basemat::Error;
use basemat::Simulation;
use basemat::coupled::State;
use basemat::coupled::StepError;
use cpu_time::ProcessTime;

use super::scheme::Scheme;

/// Why a run ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum End {
    /// With the record.
    Record,
    /// Base shear beyond what [`march`] was told.
    Grew,
    /// The flow chart did not settle.
    NoModes,
}

/// Results of a run.
#[derive(Debug, Clone)]
pub(crate) struct Outcome {
    /// Base shear at every step, N/m.
    pub(crate) shear: Vec<f64>,
    pub(crate) time_step: f64,
    pub(crate) end: End,
    /// Set-up and march.
    pub(crate) processor: Duration,
}

/// Marches until `steps` steps are made, or the base shear is beyond `limit` (N/m).
pub(crate) fn march(
    build: impl FnOnce() -> basemat::Result<Simulation>,
    steps: usize,
    limit: f64,
) -> basemat::Result<Outcome> {
    let begin = ProcessTime::now();
    let mut simulation = build()?;
    let mut shear = Vec::with_capacity(steps);
    let ran = simulation.run(steps, |state: &State| {
        shear.push(state.probes[0]);
        if state.probes[0].abs() > limit { Break(()) } else { Continue(()) }
    });
    let end = match ran {
        Ok(_) if shear.len() < steps => End::Grew,
        Ok(_) => End::Record,
        Err(Error::Step { source: StepError::Contact { .. }, .. }) => End::NoModes,
        Err(error) => return Err(error),
    };
    let time_step = simulation.time_step();
    Ok(Outcome { shear, time_step, end, processor: begin.elapsed() })
}

impl Outcome {
    /// When the run ended, s.
    pub(crate) fn time(&self) -> f64 {
        self.shear.len() as f64 * self.time_step
    }

    /// Largest base shear of the first `steps` steps, N/m.
    pub(crate) fn peak(&self, steps: usize) -> f64 {
        self.shear.iter().take(steps).fold(0.0, |m, v| v.abs().max(m))
    }

    /// Steps until the base shear is `share` of `other`'s peak away from `other`'s.
    pub(crate) fn parts_from(&self, other: &Self, share: f64) -> Option<usize> {
        let far = share * other.peak(usize::MAX);
        self.shear.iter().zip(&other.shear).position(|(a, b)| (a - b).abs() > far)
    }

    /// Difference of the base shear from `other`'s over the first `steps` steps: root mean square
    /// relative to the root mean square of `other`.
    pub(crate) fn difference(&self, other: &Self, steps: usize) -> f64 {
        let pairs = || self.shear.iter().zip(&other.shear).take(steps);
        let apart: f64 = pairs().map(|(a, b)| (a - b).powi(2)).sum();
        let size: f64 = pairs().map(|(_, b)| b.powi(2)).sum();
        (apart / size).sqrt()
    }

    /// Factor minus one per step by which the distance from `other` grew beyond `other`'s peak, if
    /// it grew tenfold or more.
    pub(crate) fn growth(&self, other: &Self) -> Option<f64> {
        let begin = self.parts_from(other, 1.0)?;
        let apart = self.shear.iter().zip(&other.shear).map(|(a, b)| (a - b).abs());
        let (end, largest) = apart.enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let factor = largest / other.peak(usize::MAX);
        (factor > 10.0).then(|| factor.powf(1.0 / (end - begin) as f64) - 1.0)
    }
}

/// A row of Table 1 by all schemes.
pub(crate) struct Row {
    pub(crate) name: &'static str,
    /// The paper's peak, lb/ft.
    pub(crate) printed: f64,
    pub(crate) outcomes: Vec<(Scheme, Outcome)>,
}

impl Row {
    pub(crate) fn outcome(&self, scheme: Scheme) -> Option<&Outcome> {
        self.outcomes.iter().find(|(other, _)| *other == scheme).map(|(_, outcome)| outcome)
    }
}
