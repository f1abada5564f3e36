//! Time series of a run, and its motion and contact frames, which an observer stores.

use std::collections::TryReserveError;
use std::ops::Range;

use super::foundation_series::FoundationSeries;
use super::frames::{ContactFrame, ContactFrames, MotionFrame, MotionFrames, reserve};
use super::joint_series::JointSeries;
use super::{Quantity, Recorder};
use crate::Simulation;
use crate::bem::ContactElement;
use crate::coupled::state::sequence::StateSequence;
use crate::coupled::{EnergyBalance, Probe, State};
#[cfg(feature = "embedded")]
use crate::coupled::{Face, FaceForces};
use crate::error::{MemoryError, Result, memory_limit, require};
use crate::geometry::ContactLayout;
use crate::structure::probe_index;

/// Time series and snapshots of a run.
///
/// [`Recorder::start`] creates it; pass [`TimeSeries::record`] to [`Simulation::run`] as observer. The first entry
/// of every series is the initial state. See the [module](super) for an example. Time series read from a file
/// ignore further steps.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "TimeSeriesForm"))]
pub struct TimeSeries {
    pub(super) recorder: Recorder,
    pub(super) elements: Vec<ContactElement>,
    /// Distances of the resultant pressure below the middle of each element, m; empty where it is the middle.
    #[cfg_attr(not(feature = "embedded"), allow(dead_code, reason = "for faces of walls"))]
    pressure_depths: Vec<f64>,
    pub(super) probes: Vec<Probe>,
    pub(super) time_step: f64,
    #[cfg_attr(
        feature = "serde",
        serde(rename = "end", serialize_with = "StateSequence::write_end")
    )]
    pub(super) sequence: StateSequence,
    steps: usize,
    dofs: usize,
    times: Vec<f64>,
    #[cfg_attr(feature = "serde", serde(with = "crate::text::forms::lists"))]
    scalars: Vec<Vec<f64>>,
    pub(super) foundations: FoundationSeries,
    pub(super) joints: JointSeries,
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
        #[serde(default)]
        pressure_depths: Vec<f64>,
        probes: Vec<Probe>,
        time_step: f64,
        end: f64,
        steps: usize,
        dofs: usize,
        times: Vec<f64>,
        #[serde(with = "crate::text::forms::lists")]
        scalars: Vec<Vec<f64>>,
        #[serde(default)]
        foundations: FoundationSeries,
        #[serde(default)]
        joints: JointSeries,
        #[serde(with = "crate::text::forms::lists")]
        probe_values: Vec<Vec<f64>>,
        energy_balances: Vec<EnergyBalance>,
        contact: Option<ContactFrames>,
        motion: Option<MotionFrames>,
    } => {
        let step_count = times.len();
        let is_plan = ContactLayout::for_elements(&elements).is_plan();
        let quantity_count = Quantity::recorded(is_plan).count();
        crate::error::same_length("list of scalars", scalars.len(), quantity_count)?;
        crate::error::same_length("list of probes", probe_values.len(), probes.len())?;
        crate::error::same_length("list of energy balances", energy_balances.len(), step_count)?;
        let lists = scalars.iter().chain(&probe_values).chain(foundations.lists.all_lists());
        for values in lists.chain(joints.lists.all_lists()) {
            crate::error::same_length("time series", values.len(), step_count)?;
        }
        foundations.check(quantity_count)?;
        joints.check()?;
        let element_count = elements.len() + joints.element_count();
        let are_whole = contact.as_ref().is_none_or(|frames| frames.is_whole(element_count))
            && motion.as_ref().is_none_or(|frames| frames.is_whole(dofs));
        crate::error::same_length("list of whole frames", usize::from(are_whole), 1)?;
        crate::error::same_length("list of times", usize::from(step_count > 0), 1)?;
        let sequence = StateSequence::closed_at(end);
        Ok(Self {
            recorder, elements, pressure_depths, probes, time_step, sequence, steps, dofs, times,
            scalars, foundations, joints, probe_values, energy_balances, contact, motion,
        })
    }
}

/// Largest number of steps for which memory is reserved at once.
///
/// A longer run allocates again when this memory is used up.
const MAX_RESERVED_STEPS: usize = 1_000_000;

/// Remedy if the limit of memory is reached.
const LIMIT_REMEDY: &str = "a recorder of fewer steps takes less";

/// Remedy if the system has no more memory.
const SYSTEM_MEMORY_REMEDY: &str = "the system gives no more; a recorder of fewer steps takes less";

impl Recorder {
    /// Starts recording with the present state of the simulation.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) for an interval of zero steps.
    pub fn start(self, simulation: &Simulation) -> Result<TimeSeries> {
        let intervals = [Some(self.every), self.contact, self.motion];
        require(
            "number of steps between kept results",
            0.0,
            !intervals.contains(&Some(0)),
            "one or more",
        )?;
        let state = simulation.state();
        let elements = simulation.elements();
        let quantity_count = Quantity::recorded(elements.is_plan()).count();
        let mut series = TimeSeries {
            elements: elements.to_vec(),
            pressure_depths: state.context.pressure_depths.clone(),
            probes: simulation.probes().to_vec(),
            time_step: simulation.time_step(),
            sequence: StateSequence::new(state),
            steps: 0,
            dofs: self.motion.map_or(0, |_| state.displacement().len()),
            times: Vec::new(),
            scalars: vec![Vec::new(); quantity_count],
            foundations: FoundationSeries::new(state, quantity_count, self.foundations),
            joints: JointSeries::new(state),
            probe_values: vec![Vec::new(); state.probes.len()],
            energy_balances: Vec::new(),
            contact: self.contact.map(ContactFrames::new),
            motion: self
                .motion
                .map(|every| MotionFrames::new(every, simulation.static_displacement())),
            recorder: self,
        };
        series.store(state);
        Ok(series)
    }
}

impl TimeSeries {
    /// Reserves memory for `steps` more steps, at most a million.
    ///
    /// Recording them then allocates nothing, except for motion frames of a structure in modal coordinates: the
    /// state allocates its degrees of freedom. Call it before a run to find out whether the run's time series and
    /// frames fit.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::Error::Memory) if time series and frames of all `steps` would exceed the
    /// [limit](crate::memory_limit), or the first million steps the memory of the system.
    pub fn reserve(&mut self, steps: usize) -> Result<()> {
        self.check_memory(steps)?;
        self.reserve_steps(steps.min(MAX_RESERVED_STEPS))
    }

    /// Records a step.
    ///
    /// States of another simulation, and states that are not later than the last one, are ignored.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::Error::Memory) if time series and frames would exceed the
    /// [limit](crate::memory_limit) or the memory of the system; they then end with the previous step. Returned by an
    /// observer, the error ends the run.
    pub fn record(&mut self, state: &State) -> Result<()> {
        if !self.sequence.is_next(state) {
            return Ok(());
        }
        self.check_memory(1)?;
        self.reserve_steps(1)?;
        self.sequence.accept(state);
        self.steps += 1;
        self.store(state);
        Ok(())
    }

    /// Lists of all scalars and probes.
    fn scalar_lists(&self) -> impl Iterator<Item = &Vec<f64>> {
        let scalars = self.scalars.iter().chain(self.foundations.lists.all_lists());
        scalars.chain(self.joints.lists.all_lists()).chain(&self.probe_values)
    }

    /// Number of elements in a contact frame, of the base and of joints.
    fn frame_element_count(&self) -> usize {
        self.elements.len() + self.joints.element_count()
    }

    /// Number of kept steps among the next `steps`, if every `interval`th is kept.
    fn kept_steps(&self, interval: usize, steps: usize) -> usize {
        self.steps.saturating_add(steps) / interval - self.steps / interval
    }

    /// Memory that `steps` more steps would take, bytes.
    fn needed_bytes(&self, steps: usize) -> f64 {
        let number_count = 1 + self.scalar_lists().count();
        let step_bytes = number_count * size_of::<f64>() + size_of::<EnergyBalance>();
        let mut bytes = self.kept_steps(self.recorder.every, steps) as f64 * step_bytes as f64;
        if let Some(frames) = &self.contact {
            let frame_bytes = ContactFrames::frame_bytes(self.frame_element_count());
            bytes += self.kept_steps(frames.every, steps) as f64 * frame_bytes as f64;
        }
        if let Some(frames) = &self.motion {
            let frame_bytes = MotionFrames::frame_bytes(self.dofs);
            bytes += self.kept_steps(frames.every, steps) as f64 * frame_bytes as f64;
        }
        bytes
    }

    /// Error if `steps` more steps would exceed the limit of memory.
    fn check_memory(&self, steps: usize) -> Result<()> {
        let needed_bytes = self.bytes() as f64 + self.needed_bytes(steps);
        let limit = memory_limit() as f64;
        if needed_bytes <= limit {
            Ok(())
        } else {
            Err(self.memory_error(steps, limit, LIMIT_REMEDY).into())
        }
    }

    fn memory_error(&self, steps: usize, limit: f64, remedy: &'static str) -> MemoryError {
        MemoryError {
            quantity: "steps with time series and snapshots",
            asked: self.steps as f64 + steps as f64,
            needed: self.bytes() as f64 + self.needed_bytes(steps),
            limit,
            remedy,
        }
    }

    /// Reserves memory for `steps` more steps.
    fn reserve_steps(&mut self, steps: usize) -> Result<()> {
        let reservation = self.try_reserve_steps(steps);
        let used_bytes = self.bytes() as f64;
        Ok(reservation.map_err(|_| self.memory_error(steps, used_bytes, SYSTEM_MEMORY_REMEDY))?)
    }

    fn try_reserve_steps(&mut self, steps: usize) -> std::result::Result<(), TryReserveError> {
        let step_count = self.kept_steps(self.recorder.every, steps);
        let element_count = self.frame_element_count();
        let scalars = self.scalars.iter_mut().chain(self.foundations.lists.all_lists_mut());
        let scalars = scalars.chain(self.joints.lists.all_lists_mut());
        for list in scalars.chain(&mut self.probe_values).chain([&mut self.times]) {
            reserve(list, step_count)?;
        }
        reserve(&mut self.energy_balances, step_count)?;
        let frame_counts = [self.recorder.contact, self.recorder.motion]
            .map(|every| every.map_or(0, |every| self.kept_steps(every, steps)));
        if let Some(frames) = &mut self.contact {
            frames.reserve(frame_counts[0], element_count)?;
        }
        if let Some(frames) = &mut self.motion {
            frames.reserve(frame_counts[1], self.dofs)?;
        }
        Ok(())
    }

    /// Appends scalars, probes and frames that are kept at the present step.
    fn store(&mut self, state: &State) {
        let step = self.steps;
        if step.is_multiple_of(self.recorder.every) {
            self.times.push(state.time);
            self.energy_balances.push(state.energy_balance);
            state.append_values(None, &mut self.scalars);
            self.foundations.store(state);
            self.joints.store(state);
            for (values, &value) in self.probe_values.iter_mut().zip(&state.probes) {
                values.push(value);
            }
        }
        if let Some(frames) =
            self.contact.as_mut().filter(|frames| step.is_multiple_of(frames.every))
        {
            frames.store(state);
        }
        if let Some(frames) =
            self.motion.as_mut().filter(|frames| step.is_multiple_of(frames.every))
        {
            frames.store(state);
        }
    }

    /// Times of the kept steps, s; the first is the start.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Time series of a quantity at [`TimeSeries::times`].
    ///
    /// It is empty in the plane for quantities that exist only in plan.
    pub fn series(&self, quantity: Quantity) -> &[f64] {
        self.scalars.get(quantity as usize).map_or(&[], Vec::as_slice)
    }

    /// Time series of the probe called `name` at [`TimeSeries::times`].
    ///
    /// # Errors
    /// [`Error::Name`](crate::Error::Name) if no probe has this name.
    pub fn probe(&self, name: &str) -> Result<&[f64]> {
        self.probe_index(name).map(|index| &self.probe_values[index][..])
    }

    /// The probes, in the order of the builder.
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

    /// Whether the ground is one in plan.
    pub fn in_plan(&self) -> bool {
        ContactLayout::for_elements(&self.elements).is_plan()
    }

    /// Axis that points up: y (1) in the plane, z (2) on a ground in plan.
    #[cfg(any(feature = "io", feature = "plot"))]
    pub(crate) fn up(&self) -> usize {
        ContactLayout::for_elements(&self.elements).axes().end
    }

    /// Snapshots of the base; none unless [`Recorder::contact`] was set.
    pub fn contact_frames(&self) -> impl Iterator<Item = ContactFrame<'_>> {
        self.frames_of(0..self.elements.len())
    }

    /// Snapshots of some elements, numbered through the base and then the joints.
    pub(super) fn frames_of(
        &self,
        elements: Range<usize>,
    ) -> impl Iterator<Item = ContactFrame<'_>> {
        let frames = self.contact.iter();
        frames.flat_map(move |frames| frames.frames(elements.clone(), self.frame_element_count()))
    }

    /// Forces on a face at each snapshot of the base, as [`State::face`]; none unless [`Recorder::contact`] was set.
    #[cfg(feature = "embedded")]
    pub fn face(&self, face: Face) -> impl Iterator<Item = FaceForces> {
        self.contact_frames().map(move |frame| {
            FaceForces::on(face, &self.elements, &self.pressure_depths, frame.states, frame.modes)
        })
    }

    /// Snapshots of the structure; none unless [`Recorder::motion`] was set.
    pub fn motion_frames(&self) -> impl Iterator<Item = MotionFrame<'_>> {
        self.motion.iter().flat_map(|frames| frames.frames(self.dofs))
    }

    /// Static displacement of the degrees of freedom, m and rad, which the frames of motion do not contain.
    ///
    /// It is [`Simulation::static_displacement`], or empty unless [`Recorder::motion`] was set.
    pub fn static_displacement(&self) -> &[f64] {
        self.motion.as_ref().map_or(&[], |frames| &frames.static_displacement)
    }

    /// Memory that time series and frames use now, bytes.
    pub fn bytes(&self) -> usize {
        let number_count = self.scalar_lists().map(Vec::len).sum::<usize>() + self.times.len();
        size_of::<f64>() * number_count
            + size_of_val(&self.energy_balances[..])
            + self.contact.as_ref().map_or(0, ContactFrames::bytes)
            + self.motion.as_ref().map_or(0, MotionFrames::bytes)
    }
}
