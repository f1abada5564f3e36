//! The observer: time series of a run, and the frames of motion and contact that it keeps.

use super::{Quantity, Recorder};
use crate::Simulation;
use crate::bem::ContactElement;
use crate::coupled::{EnergyBalance, Probe, Sequence, State, probe_index};
use crate::error::{Result, require};
use crate::interface::{ContactState, Mode};

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
    depths: Vec<[f64; 2]>,
    pub(super) probes: Vec<Probe>,
    pub(super) time_step: f64,
    #[cfg_attr(feature = "serde", serde(rename = "end", serialize_with = "Sequence::write_end"))]
    pub(super) sequence: Sequence,
    steps: usize,
    dofs: usize,
    times: Vec<f64>,
    #[cfg_attr(feature = "serde", serde(with = "crate::text::words::lists"))]
    scalars: Vec<Vec<f64>>,
    #[cfg_attr(feature = "serde", serde(with = "crate::text::words::lists"))]
    pub(super) probe_values: Vec<Vec<f64>>,
    energy_balances: Vec<EnergyBalance>,
    contact: Option<ContactFrames>,
    motion: Option<MotionFrames>,
}

validated! {
    TimeSeries as TimeSeriesForm {
        recorder: Recorder,
        elements: Vec<ContactElement>,
        #[serde(default)]
        depths: Vec<[f64; 2]>,
        probes: Vec<Probe>,
        time_step: f64,
        end: f64,
        steps: usize,
        dofs: usize,
        times: Vec<f64>,
        #[serde(with = "crate::text::words::lists")]
        scalars: Vec<Vec<f64>>,
        #[serde(with = "crate::text::words::lists")]
        probe_values: Vec<Vec<f64>>,
        energy_balances: Vec<EnergyBalance>,
        contact: Option<ContactFrames>,
        motion: Option<MotionFrames>,
    } => {
        let kept = times.len();
        let lengths = scalars.iter().chain(&probe_values).map(Vec::len);
        let in_plan = !depths.is_empty();
        if in_plan {
            crate::error::same_length("list of depths", depths.len(), elements.len())?;
        }
        crate::error::same_length("list of scalars", scalars.len(), Quantity::of(in_plan).count())?;
        crate::error::same_length("list of probes", probe_values.len(), probes.len())?;
        crate::error::same_length("list of energy balances", energy_balances.len(), kept)?;
        lengths.into_iter().try_for_each(|length| crate::error::same_length("time series", length, kept))?;
        let frames = contact.as_ref().is_none_or(|own| own.is_whole(elements.len()))
            && motion.as_ref().is_none_or(|own| own.is_whole(dofs));
        crate::error::same_length("list of whole frames", usize::from(frames), 1)?;
        crate::error::same_length("list of times", usize::from(kept > 0), 1)?;
        let sequence = Sequence::ended(end);
        Ok(Self {
            recorder, elements, depths, probes, time_step, sequence, steps, dofs, times, scalars,
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
    /// [`Error::Input`](crate::Error::Input) for an interval of zero steps.
    pub fn start(self, simulation: &Simulation) -> Result<TimeSeries> {
        let intervals = [Some(self.every), self.contact, self.motion];
        require("steps between what is kept", 0.0, !intervals.contains(&Some(0)), "one or more")?;
        let state = simulation.state();
        let elements = simulation.elements();
        let in_plan = elements.is_plan();
        let mut series = TimeSeries {
            elements: elements.to_vec(),
            depths: if in_plan { elements.depths().to_vec() } else { Vec::new() },
            probes: simulation.probes().to_vec(),
            time_step: simulation.time_step(),
            sequence: Sequence::new(state),
            steps: 0,
            dofs: self.motion.map_or(0, |_| state.displacement().len()),
            times: Vec::new(),
            scalars: vec![Vec::new(); Quantity::of(in_plan).count()],
            probe_values: vec![Vec::new(); state.probes.len()],
            energy_balances: Vec::new(),
            contact: self.contact.map(ContactFrames::new),
            motion: self.motion.map(MotionFrames::new),
            recorder: self,
        };
        series.keep(state);
        Ok(series)
    }
}

impl TimeSeries {
    /// Reserves memory for `steps` more steps, at most a million: recording them then allocates nothing (but for frames
    /// of motion of a structure that is stepped in its modes, whose degrees of freedom the state then makes).
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
        self.keep(state);
    }

    fn keep(&mut self, state: &State) {
        let due = |every: usize| self.steps.is_multiple_of(every);
        if due(self.recorder.every) {
            self.times.push(state.time);
            self.energy_balances.push(state.energy_balance);
            state.append_values(&mut self.scalars);
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

    /// Time series of a quantity at [`TimeSeries::times`]; empty in the plane for those of three directions.
    pub fn series(&self, quantity: Quantity) -> &[f64] {
        self.scalars.get(quantity as usize).map_or(&[], Vec::as_slice)
    }

    /// Time series of the probe called `name`, zero at the start of a run.
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

    /// Front and back end of each contact element along y on a ground in plan, m; empty in the plane.
    pub fn depths(&self) -> &[[f64; 2]] {
        &self.depths
    }

    /// Whether the time series are of a ground in plan.
    pub(crate) fn in_plan(&self) -> bool {
        !self.depths.is_empty()
    }

    /// Snapshots of the base; none unless asked for with [`Recorder::contact`].
    pub fn contact_frames(&self) -> impl Iterator<Item = ContactFrame<'_>> {
        self.contact.iter().flat_map(|frames| frames.frames(self.elements.len()))
    }

    /// Snapshots of the structure; none unless asked for with [`Recorder::motion`].
    pub fn motion_frames(&self) -> impl Iterator<Item = MotionFrame<'_>> {
        self.motion.iter().flat_map(|frames| frames.frames(self.dofs))
    }

    /// Memory that time series and frames take up now.
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

// Snapshots of the base and of the structure, every so many steps.

/// The base at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ContactFrame<'a> {
    /// Time, s.
    pub time: f64,
    /// Opening and total traction of each element.
    pub states: &'a [ContactState],
    /// Mode of each element.
    pub modes: &'a [Mode],
}

/// The structure at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct MotionFrame<'a> {
    /// Time, s.
    pub time: f64,
    /// Degrees of freedom as changes against the static state, relative to the free field's translation, m
    /// and rad.
    pub displacement: &'a [f64],
    /// Total velocities of the degrees of freedom, m/s and rad/s.
    pub velocity: &'a [f64],
    /// Mean displacement [horizontal, up] of the free field under the base, m.
    pub free_field: [f64; 2],
    /// In plan: mean displacement of the free field along y, m; zero in the plane.
    pub free_field_across: f64,
}

/// Frames of the base, end to end.
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub(super) struct ContactFrames {
    pub(super) every: usize,
    times: Vec<f64>,
    states: Vec<ContactState>,
    modes: Vec<Mode>,
}

impl ContactFrames {
    pub(super) fn new(every: usize) -> Self {
        Self { every, ..Self::default() }
    }

    pub(super) fn keep(&mut self, state: &State) {
        self.times.push(state.time);
        self.states.extend_from_slice(&state.contact);
        self.modes.extend_from_slice(&state.modes);
    }

    /// Reserves memory for `steps` more steps of `count` elements each.
    pub(super) fn reserve(&mut self, steps: usize, count: usize) {
        let frames = steps / self.every + 1;
        self.times.reserve(frames);
        let _ = self.states.try_reserve(frames.saturating_mul(count));
        let _ = self.modes.try_reserve(frames.saturating_mul(count));
    }

    /// Whether these are frames of `count` elements each.
    #[cfg(feature = "serde")]
    pub(super) fn is_whole(&self, count: usize) -> bool {
        let needed = self.times.len().checked_mul(count);
        self.every > 0 && [self.states.len(), self.modes.len()].map(Some) == [needed; 2]
    }

    /// Frames of `count` elements each.
    pub(super) fn frames(&self, count: usize) -> impl ExactSizeIterator<Item = ContactFrame<'_>> {
        self.times.iter().enumerate().map(move |(k, &time)| {
            let range = k * count..(k + 1) * count;
            ContactFrame { time, states: &self.states[range.clone()], modes: &self.modes[range] }
        })
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.times[..]) + size_of_val(&self.states[..]) + size_of_val(&self.modes[..])
    }
}

/// Frames of the structure, end to end.
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub(super) struct MotionFrames {
    pub(super) every: usize,
    times: Vec<f64>,
    displacement: Vec<f64>,
    velocity: Vec<f64>,
    free_field: Vec<[f64; 2]>,
    /// Mean displacement of the free field along y, m, one for each frame; none if the file that was read has none.
    #[cfg_attr(feature = "serde", serde(default))]
    free_field_across: Vec<f64>,
}

impl MotionFrames {
    pub(super) fn new(every: usize) -> Self {
        Self { every, ..Self::default() }
    }

    pub(super) fn keep(&mut self, state: &State) {
        self.times.push(state.time);
        self.displacement.extend_from_slice(state.displacement());
        self.velocity.extend_from_slice(state.velocity());
        self.free_field.push(state.free_field);
        self.free_field_across.push(state.free_field_across);
    }

    /// Reserves memory for `steps` more steps of `count` degrees of freedom each.
    pub(super) fn reserve(&mut self, steps: usize, count: usize) {
        let frames = steps / self.every + 1;
        self.times.reserve(frames);
        // What does not fit now may never be needed.
        let _ = self.displacement.try_reserve(frames.saturating_mul(count));
        let _ = self.velocity.try_reserve(frames.saturating_mul(count));
        self.free_field.reserve(frames);
        self.free_field_across.reserve(frames);
    }

    /// Whether these are frames of `count` degrees of freedom each.
    #[cfg(feature = "serde")]
    pub(super) fn is_whole(&self, count: usize) -> bool {
        let needed = self.times.len().checked_mul(count);
        self.every > 0
            && self.free_field.len() == self.times.len()
            && [0, self.times.len()].contains(&self.free_field_across.len())
            && [self.displacement.len(), self.velocity.len()].map(Some) == [needed; 2]
    }

    /// Frames of `count` degrees of freedom each.
    pub(super) fn frames(&self, count: usize) -> impl ExactSizeIterator<Item = MotionFrame<'_>> {
        self.times.iter().enumerate().map(move |(k, &time)| {
            let range = k * count..(k + 1) * count;
            let displacement = &self.displacement[range.clone()];
            let (velocity, free_field) = (&self.velocity[range], self.free_field[k]);
            // Files of before have none.
            let free_field_across = self.free_field_across.get(k).copied().unwrap_or(0.0);
            MotionFrame { time, displacement, velocity, free_field, free_field_across }
        })
    }

    pub(super) fn bytes(&self) -> usize {
        8 * (4 * self.times.len() + self.displacement.len() + self.velocity.len())
    }
}
