//! The observer: histories of a run.

use std::io::{self, Write};
use std::path::Path;

use super::envelope::{self, ElementEnvelope};
use super::foundation::{self, FootingTally};
use super::frames::{ContactFrame, ContactFrames, MotionFrame, MotionFrames};
use super::table::csv_cell;
use super::unit::labelled;
use super::{Extremes, Quantity, Recorder, Sliding, Uplift};
use crate::bem::ContactElement;
use crate::coupled::{
    Ledger, Origin, Peak, Probe, Resolution, Run, Simulation, State, probe_index,
};
use crate::error::{Error, Result, write_file};

/// Histories of a run, its peaks and envelopes: made by [`Recorder::start`], fed by
/// [`Histories::record`].
///
/// The first entry of every history is the state it started from. See the [module](super) for an
/// example.
#[derive(Debug, Clone)]
pub struct Histories {
    pub(super) recorder: Recorder,
    pub(super) elements: Vec<ContactElement>,
    pub(super) probes: Vec<Probe>,
    pub(super) time_step: f64,
    origin: Origin,
    unknowns: usize,
    times: Vec<f64>,
    scalars: Vec<Vec<f64>>,
    pub(super) probe_values: Vec<Vec<f64>>,
    ledgers: Vec<Ledger>,
    contact: Option<ContactFrames>,
    motion: Option<MotionFrames>,
    pub(super) tally: Tally,
}

/// Most steps that memory is reserved for.
const MOST_RESERVED: usize = 1_000_000;

/// What is followed at every step, whatever is kept.
#[derive(Debug, Clone)]
pub(super) struct Tally {
    pub(super) steps: usize,
    pub(super) start: f64,
    pub(super) end: f64,
    pub(super) static_normal_force: f64,
    /// One for each [`Quantity`].
    pub(super) scalars: Vec<Extremes>,
    pub(super) probes: Vec<Extremes>,
    pub(super) envelopes: Vec<ElementEnvelope>,
    pub(super) uplift: Uplift,
    pub(super) sliding: Sliding,
    pub(super) foundations: Vec<FootingTally>,
    pub(super) input: Peak,
    pub(super) ledger: Ledger,
    pub(super) ledger_residual: f64,
    pub(super) mode_changes: usize,
    pub(super) resolution: Resolution,
}

impl Recorder {
    /// Makes up to `steps` steps of `simulation` and returns what was kept of them. To keep what was
    /// recorded before a step that failed, see [`Recorder::start`] and [`Histories::run`].
    ///
    /// # Errors
    /// As for [`Recorder::start`], and those of [`Simulation::run`].
    pub fn run(self, simulation: &mut Simulation, steps: usize) -> Result<Histories> {
        let mut histories = self.start(simulation)?;
        histories.run(simulation, steps)?;
        Ok(histories)
    }

    /// Starts with the simulation as it stands.
    ///
    /// # Errors
    /// [`Error::Input`] for a negative friction coefficient (infinity is one), the laws' included,
    /// or an interval of zero steps; [`Error::Size`] unless there is one friction coefficient for all elements or one each.
    pub fn start(mut self, simulation: &Simulation) -> Result<Histories> {
        let count = simulation.elements().len();
        if self.friction.is_empty() {
            self.friction = simulation.friction();
        }
        if self.friction.len() > 1 && self.friction.len() != count {
            return Err(Error::Size {
                quantity: "list of friction coefficients",
                found: self.friction.len(),
                needed: count,
            });
        }
        if let Some(&value) = self.friction.iter().find(|value| value.is_nan() || **value < 0.0) {
            let (quantity, needed) = ("friction coefficient", "zero or more");
            return Err(Error::Input { quantity, value, needed });
        }
        let intervals = [Some(self.every), self.contact, self.motion];
        if intervals.contains(&Some(0)) {
            let (quantity, needed) = ("steps between what is kept", "one or more");
            return Err(Error::Input { quantity, value: 0.0, needed });
        }
        Ok(Histories::new(self, simulation))
    }
}

impl Histories {
    fn new(recorder: Recorder, simulation: &Simulation) -> Self {
        let state = simulation.state();
        let elements = simulation.elements().to_vec();
        let foundations = foundation::start(state, &recorder.friction, &elements);
        let values = scalars(state, &foundations);
        let mut histories = Self {
            probes: simulation.probes().to_vec(),
            time_step: simulation.time_step(),
            origin: state.origin,
            unknowns: recorder.motion.map_or(0, |_| state.displacement().len()),
            times: Vec::new(),
            scalars: vec![Vec::new(); Quantity::ALL.len()],
            probe_values: vec![Vec::new(); state.probes.len()],
            ledgers: Vec::new(),
            contact: recorder.contact.map(ContactFrames::new),
            motion: recorder.motion.map(MotionFrames::new),
            tally: Tally {
                steps: 0,
                start: state.time,
                end: state.time,
                static_normal_force: state.normal_force,
                scalars: values.iter().map(|&value| Extremes::of(value, state.time)).collect(),
                probes: state.probes.iter().map(|&v| Extremes::of(v, state.time)).collect(),
                envelopes: envelope::start(&elements, state),
                uplift: Uplift::start(state.uplifted_fraction, state.time),
                sliding: Sliding::start(state),
                foundations,
                input: Peak { value: state.ledger.input, time: state.time },
                ledger: state.ledger,
                ledger_residual: state.ledger.residual(),
                mode_changes: 0,
                resolution: simulation.resolution(),
            },
            elements,
            recorder,
        };
        histories.keep(state, &values);
        histories
    }

    /// Makes up to `steps` steps of `simulation` and records them; memory is reserved beforehand.
    /// For an observer of your own beside it, call [`Histories::record`] from that.
    ///
    /// # Errors
    /// Those of [`Simulation::run`]; what was recorded before stays.
    pub fn run(&mut self, simulation: &mut Simulation, steps: usize) -> Result<Run> {
        // Longer runs are meant to be stopped on the way.
        if steps <= MOST_RESERVED {
            self.reserve(steps);
        }
        let run = simulation.run(steps, |state| self.record(state))?;
        self.tally.resolution.learn(run.resolution());
        Ok(run)
    }

    /// Reserves memory for so many more steps, at most a million: recording them allocates nothing then (unless there
    /// are more than a thousand slip events, or frames of motion of a structure that is stepped in
    /// its modes, whose unknowns the state then makes).
    pub fn reserve(&mut self, steps: usize) {
        let steps = steps.min(MOST_RESERVED);
        let count = steps / self.recorder.every + 1;
        let lists = self.scalars.iter_mut().chain(&mut self.probe_values);
        lists.chain([&mut self.times]).for_each(|list| list.reserve(count));
        self.ledgers.reserve(count);
        self.tally.sliding.events.reserve(steps.min(1000));
        if let Some(frames) = &mut self.contact {
            frames.reserve(steps, self.elements.len());
        }
        if let Some(frames) = &mut self.motion {
            frames.reserve(steps, self.unknowns);
        }
    }

    /// Takes in a step. States of another simulation and those that are not later than the last
    /// one are ignored.
    pub fn record(&mut self, state: &State) {
        let fits = state.contact.len() == self.elements.len()
            && state.modes.len() == self.elements.len()
            && foundation::fit(&self.tally.foundations, state)
            && state.probes.len() == self.probes.len()
            && state.time > self.tally.end
            && state.origin.is(self.origin);
        if !fits {
            return;
        }
        let footings = &mut self.tally.foundations;
        foundation::see(footings, state, &self.recorder.friction, &self.elements);
        let values = scalars(state, footings);
        self.tally.see(state, &values);
        self.keep(state, &values);
    }

    fn keep(&mut self, state: &State, values: &[f64]) {
        let due = |every: usize| self.tally.steps.is_multiple_of(every);
        if due(self.recorder.every) {
            self.times.push(state.time);
            self.ledgers.push(state.ledger);
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

    /// History of a scalar at [`Histories::times`].
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

    /// The energy ledger at [`Histories::times`].
    pub fn ledgers(&self) -> &[Ledger] {
        &self.ledgers
    }

    /// The contact elements.
    pub fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    /// Envelopes over all steps of pressure, shear, gap and slip, element by element.
    pub fn envelope(&self) -> &[ElementEnvelope] {
        &self.tally.envelopes
    }

    /// Smallest and largest value of a scalar over all steps.
    pub fn extremes(&self, quantity: Quantity) -> Extremes {
        self.tally.scalars[quantity as usize]
    }

    /// Snapshots of the base; none unless asked for with [`Recorder::contact`].
    pub fn contact_frames(&self) -> impl Iterator<Item = ContactFrame<'_>> {
        self.contact.iter().flat_map(|frames| frames.frames(self.elements.len()))
    }

    /// Snapshots of the structure; none unless asked for with [`Recorder::motion`].
    pub fn motion_frames(&self) -> impl Iterator<Item = MotionFrame<'_>> {
        self.motion.iter().flat_map(|frames| frames.frames(self.unknowns))
    }

    /// Memory that histories and frames take up now.
    pub fn bytes(&self) -> usize {
        let numbers: usize =
            self.scalars.iter().chain(&self.probe_values).map(Vec::len).sum::<usize>()
                + self.times.len();
        8 * numbers
            + size_of_val(&self.ledgers[..])
            + self.contact.as_ref().map_or(0, ContactFrames::bytes)
            + self.motion.as_ref().map_or(0, MotionFrames::bytes)
    }

    /// Writes the CSV of [`Histories::write_csv`] to a file; its folder is made if it is not there.
    ///
    /// # Errors
    /// [`Error::Write`](crate::Error::Write) if that fails.
    pub fn save_csv(&self, path: impl AsRef<Path>) -> Result<()> {
        let mut text = Vec::new();
        // Writing to memory cannot fail.
        let _ = self.write_csv(&mut text);
        write_file(path.as_ref(), text)
    }

    /// Writes times, scalars, probes and the ledger's input as CSV: a heading and a line for every
    /// kept step, as RFC 4180 has it. Names of probes have their unit in brackets.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        write!(out, "time_s")?;
        for quantity in Quantity::ALL {
            write!(out, ",{}", quantity.heading())?;
        }
        for probe in &self.probes {
            let heading = labelled(&probe.name, &probe.unit);
            write!(out, ",{}", csv_cell(&heading))?;
        }
        writeln!(out, ",input_energy_j_per_m")?;
        for (k, time) in self.times.iter().enumerate() {
            write!(out, "{time}")?;
            for list in self.scalars.iter().chain(&self.probe_values) {
                write!(out, ",{:e}", list[k])?;
            }
            writeln!(out, ",{:e}", self.ledgers[k].input)?;
        }
        Ok(())
    }
}

impl Tally {
    fn see(&mut self, state: &State, values: &[f64]) {
        let (begin, time) = (self.end, state.time);
        let step = time - begin;
        self.steps += 1;
        self.end = time;
        let kept = self.scalars.iter_mut().zip(values);
        kept.for_each(|(extremes, &value)| extremes.see(value, time));
        let kept = self.probes.iter_mut().zip(&state.probes);
        kept.for_each(|(extremes, &value)| extremes.see(value, time));
        envelope::see(&mut self.envelopes, state, step);
        let closed = state.modes.iter().any(|mode| mode.is_closed());
        self.uplift.see(state.uplifted_fraction, time, step, closed);
        self.sliding.see(state, begin);
        self.input.see(state.ledger.input, time);
        self.ledger = state.ledger;
        let residual = state.ledger.residual();
        if residual.is_nan() || residual > self.ledger_residual {
            self.ledger_residual = residual;
        }
        self.mode_changes += state.transitions.len();
        self.resolution.see(state);
    }
}

/// One value for each [`Quantity`], in the order of [`Quantity::ALL`].
fn scalars(state: &State, foundations: &[FootingTally]) -> [f64; Quantity::ALL.len()] {
    let [sliding, overturning] = foundation::least(foundations);
    Quantity::ALL.map(|quantity| match quantity {
        Quantity::BaseShear => state.base_shear,
        Quantity::BaseMoment => state.base_moment,
        Quantity::NormalForce => state.normal_force,
        Quantity::UpliftedFraction => state.uplifted_fraction,
        Quantity::MeanSlip => state.mean_slip,
        Quantity::LargestSlip => state.largest_slip(),
        Quantity::BaseRotation => state.base_rotation,
        Quantity::FreeFieldHorizontal => state.free_field[0],
        Quantity::FreeFieldVertical => state.free_field[1],
        Quantity::SlidingSafety => sliding,
        Quantity::OverturningSafety => overturning,
    })
}
