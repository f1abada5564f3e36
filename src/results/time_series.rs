//! The observer: histories of a run.

use super::frames::{ContactFrame, ContactFrames, MotionFrame, MotionFrames};
use super::{Quantity, Recorder};
use crate::bem::ContactElement;
use crate::coupled::run::sequence::Sequence;
use crate::coupled::{EnergyBalance, Probe, Simulation, State, probe_index};
#[cfg(feature = "serde")]
use crate::error::same_length;
use crate::error::{Error, Result};

/// Time series of a run and snapshots: made by [`Recorder::start`], fed by [`TimeSeries::record`], the
/// observer of [`Simulation::run`].
///
/// The first entry of every history is the state it started from. See the [module](super) for an
/// example. One that was read from a file takes no more steps.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "TimeSeriesForm"))]
pub struct TimeSeries {
    pub(super) recorder: Recorder,
    pub(super) elements: Vec<ContactElement>,
    pub(super) probes: Vec<Probe>,
    pub(super) time_step: f64,
    #[cfg_attr(feature = "serde", serde(rename = "end", serialize_with = "Sequence::write_end"))]
    pub(super) sequence: Sequence,
    steps: usize,
    dofs: usize,
    times: Vec<f64>,
    #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::lists"))]
    scalars: Vec<Vec<f64>>,
    #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::lists"))]
    pub(super) probe_values: Vec<Vec<f64>>,
    energy_balances: Vec<EnergyBalance>,
    contact: Option<ContactFrames>,
    motion: Option<MotionFrames>,
}

validated! {
    TimeSeries as TimeSeriesForm {
        recorder: Recorder,
        elements: Vec<ContactElement>,
        probes: Vec<Probe>,
        time_step: f64,
        end: f64,
        steps: usize,
        dofs: usize,
        times: Vec<f64>,
        #[serde(with = "crate::text::forms::lists")]
        scalars: Vec<Vec<f64>>,
        #[serde(with = "crate::text::forms::lists")]
        probe_values: Vec<Vec<f64>>,
        energy_balances: Vec<EnergyBalance>,
        contact: Option<ContactFrames>,
        motion: Option<MotionFrames>,
    } => {
        let kept = times.len();
        let mut lengths = scalars.iter().chain(&probe_values).map(Vec::len);
        same_length("list of scalars", scalars.len(), Quantity::ALL.len())?;
        same_length("list of probes", probe_values.len(), probes.len())?;
        same_length("list of energy balances", energy_balances.len(), kept)?;
        lengths.try_for_each(|length| same_length("time series", length, kept))?;
        let frames = contact.as_ref().is_none_or(|own| own.is_whole(elements.len()))
            && motion.as_ref().is_none_or(|own| own.is_whole(dofs));
        same_length("list of whole frames", usize::from(frames), 1)?;
        same_length("list of times", usize::from(kept > 0), 1)?;
        let sequence = Sequence::ended(end);
        Ok(Self {
            recorder, elements, probes, time_step, sequence, steps, dofs, times, scalars,
            probe_values, energy_balances, contact, motion,
        })
    }
}

/// Most steps that memory is reserved for.
const MOST_RESERVED: usize = 1_000_000;

impl Recorder {
    /// Starts with the simulation as it stands.
    ///
    /// # Errors
    /// [`Error::Input`] for an interval of zero steps.
    pub fn start(self, simulation: &Simulation) -> Result<TimeSeries> {
        let intervals = [Some(self.every), self.contact, self.motion];
        if intervals.contains(&Some(0)) {
            let (quantity, needed) = ("steps between what is kept", "one or more");
            return Err(Error::Input { quantity, value: 0.0, needed });
        }
        Ok(TimeSeries::new(self, simulation))
    }
}

impl TimeSeries {
    fn new(recorder: Recorder, simulation: &Simulation) -> Self {
        let state = simulation.state();
        let mut histories = Self {
            elements: simulation.elements().to_vec(),
            probes: simulation.probes().to_vec(),
            time_step: simulation.time_step(),
            sequence: Sequence::new(state),
            steps: 0,
            dofs: recorder.motion.map_or(0, |_| state.displacement().len()),
            times: Vec::new(),
            scalars: vec![Vec::new(); Quantity::ALL.len()],
            probe_values: vec![Vec::new(); state.probes.len()],
            energy_balances: Vec::new(),
            contact: recorder.contact.map(ContactFrames::new),
            motion: recorder.motion.map(MotionFrames::new),
            recorder,
        };
        let values = state.values();
        histories.keep(state, &values);
        histories
    }

    /// Reserves memory for so many more steps, at most a million: recording them allocates nothing then
    /// (but for frames of motion of a structure that is stepped in its modes, whose degrees of freedom the
    /// state then makes).
    pub fn reserve(&mut self, steps: usize) {
        let steps = steps.min(MOST_RESERVED);
        let count = steps / self.recorder.every + 1;
        let lists = self.scalars.iter_mut().chain(&mut self.probe_values);
        lists.chain([&mut self.times]).for_each(|list| list.reserve(count));
        self.energy_balances.reserve(count);
        if let Some(frames) = &mut self.contact {
            frames.reserve(steps, self.elements.len());
        }
        if let Some(frames) = &mut self.motion {
            frames.reserve(steps, self.dofs);
        }
    }

    /// Takes in a step. States of another simulation and those that are not later than the last
    /// one are ignored.
    pub fn record(&mut self, state: &State) {
        if !self.sequence.takes(state) {
            return;
        }
        self.steps += 1;
        let values = state.values();
        self.keep(state, &values);
    }

    fn keep(&mut self, state: &State, values: &[f64]) {
        let due = |every: usize| self.steps.is_multiple_of(every);
        if due(self.recorder.every) {
            self.times.push(state.time);
            self.energy_balances.push(state.energy_balance);
            self.scalars.iter_mut().zip(values).for_each(|(list, &value)| list.push(value));
            let probes = self.probe_values.iter_mut().zip(&state.probes);
            probes.for_each(|(list, &value)| list.push(value));
        }
        if let Some(frames) = self.contact.as_mut().filter(|frames| due(frames.every)) {
            frames.keep(state);
        }
        if let Some(frames) = self.motion.as_mut().filter(|frames| due(frames.every)) {
            frames.keep(state);
        }
    }

    /// Times of the kept steps, s; the first is that of the start.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// History of a scalar at [`TimeSeries::times`].
    pub fn series(&self, quantity: Quantity) -> &[f64] {
        &self.scalars[quantity as usize]
    }

    /// History of the probe called `name`, zero at the start of a run.
    ///
    /// # Errors
    /// [`Error::Name`](crate::Error::Name) if there is none.
    pub fn probe(&self, name: &str) -> Result<&[f64]> {
        self.probe_index(name).map(|index| &self.probe_values[index][..])
    }

    /// The probes, in the order they were given to the builder.
    pub fn probes(&self) -> &[Probe] {
        &self.probes
    }

    pub(crate) fn probe_index(&self, name: &str) -> Result<usize> {
        probe_index(&self.probes, name, |probe| &probe.name)
    }

    /// The energy balance at [`TimeSeries::times`].
    pub fn energy_balances(&self) -> &[EnergyBalance] {
        &self.energy_balances
    }

    /// The contact elements.
    pub fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    /// Snapshots of the base; none unless asked for with [`Recorder::contact`].
    pub fn contact_frames(&self) -> impl Iterator<Item = ContactFrame<'_>> {
        self.contact.iter().flat_map(|frames| frames.frames(self.elements.len()))
    }

    /// Snapshots of the structure; none unless asked for with [`Recorder::motion`].
    pub fn motion_frames(&self) -> impl Iterator<Item = MotionFrame<'_>> {
        self.motion.iter().flat_map(|frames| frames.frames(self.dofs))
    }

    /// Memory that histories and frames take up now.
    pub fn bytes(&self) -> usize {
        let numbers: usize =
            self.scalars.iter().chain(&self.probe_values).map(Vec::len).sum::<usize>()
                + self.times.len();
        8 * numbers
            + size_of_val(&self.energy_balances[..])
            + self.contact.as_ref().map_or(0, ContactFrames::bytes)
            + self.motion.as_ref().map_or(0, MotionFrames::bytes)
    }
}
