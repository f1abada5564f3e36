//! Results of a run: peaks, warnings, energies.

use std::fmt;
use std::time::{Duration, Instant};

use super::ledger::Ledger;
use super::peak::{Extremes, Peak, ProbePeak, probe_index};
use super::probe::Probe;
use super::resolution::Resolution;
use super::state::State;
use super::warning::Warning;
use crate::bem::{ContactElement, Ground};
use crate::contact::SearchMethod;
use crate::error::Result;
use crate::motion::FreeField;
use crate::results::unit::{number, printed};

/// Steps whose contact modes the first search did not find, see
/// [`SearchMethod`](super::SearchMethod).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Fallbacks {
    /// Steps that Gauss–Seidel over the elements solved.
    pub gauss_seidel: usize,
    /// Steps that needed a path of solutions to be followed.
    pub path: usize,
}

impl Fallbacks {
    /// Steps that needed either.
    pub fn total(&self) -> usize {
        self.gauss_seidel + self.path
    }
}

/// Summary of a run; forces per metre of thickness, on the soil.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Run {
    /// Steps of this run.
    pub steps: usize,
    /// Time at its end, s.
    pub time: f64,
    /// Largest base shear, N/m.
    pub base_shear: Peak,
    /// Largest change of base moment against the static state, N·m/m.
    pub base_moment_change: Peak,
    /// Smallest and largest normal force, N/m.
    pub normal_force: Extremes,
    /// Largest uplifted fraction of the base.
    pub uplifted_fraction: Peak,
    /// Largest slip of any element, m; tangential motion while it is open counts.
    pub largest_slip: Peak,
    /// Mean slip at the end, m.
    pub residual_slip: f64,
    /// Largest base rotation, rad.
    pub base_rotation: Peak,
    /// Largest values of the probes, in the order they were given to the builder.
    pub probes: Vec<ProbePeak>,
    /// Changes of contact mode; each is in [`State::transitions`] of its step.
    pub mode_changes: usize,
    /// Those by which an element opened.
    pub debondings: usize,
    /// Those by which one closed again.
    pub rebondings: usize,
    /// The ledger at the end.
    pub ledger: Ledger,
    /// Largest ledger residual of the run; NaN if no ledger is kept.
    pub ledger_residual: f64,
    /// Linear solves of the mode search, in all.
    pub trials: usize,
    /// Steps that the first search for contact modes did not solve.
    pub fallbacks: Fallbacks,
    /// Warnings.
    pub warnings: Vec<Warning>,
    /// Wall time, observers included; zero where there is no clock (WebAssembly).
    pub wall: Duration,
    shortest: f64,
    static_moment: f64,
    resolution: Resolution,
    start: f64,
    begin: Option<Instant>,
}

impl Run {
    pub(super) fn new(
        probes: &[Probe],
        elements: &[ContactElement],
        start: &State,
        resolution: Resolution,
    ) -> Self {
        Self {
            steps: 0,
            time: start.time,
            base_shear: Peak::default(),
            base_moment_change: Peak::default(),
            normal_force: Extremes::of(start.normal_force, start.time),
            uplifted_fraction: Peak { value: start.uplifted_fraction, time: start.time },
            largest_slip: Peak::default(),
            residual_slip: start.mean_slip,
            base_rotation: Peak::default(),
            probes: probes
                .iter()
                .map(|probe| ProbePeak {
                    name: probe.name.clone(),
                    unit: probe.unit.clone(),
                    peak: Peak::default(),
                })
                .collect(),
            mode_changes: 0,
            debondings: 0,
            rebondings: 0,
            ledger: start.ledger,
            ledger_residual: start.ledger.residual(),
            trials: 0,
            fallbacks: Fallbacks::default(),
            warnings: Vec::new(),
            wall: Duration::ZERO,
            shortest: elements.iter().map(ContactElement::length).fold(f64::INFINITY, f64::min),
            static_moment: start.base_moment,
            resolution,
            start: start.time,
            // There is no clock in bare WebAssembly.
            begin: (!cfg!(target_family = "wasm")).then(Instant::now),
        }
    }

    /// Takes in the next step; [`Simulation::run`](crate::Simulation::run) does it for every step.
    pub fn record(&mut self, state: &State) {
        let time = state.time;
        self.steps += 1;
        self.resolution.see(state);
        self.base_shear.see(state.base_shear, time);
        self.base_moment_change.see(state.base_moment - self.static_moment, time);
        self.normal_force.see(state.normal_force, time);
        self.uplifted_fraction.see(state.uplifted_fraction, time);
        for contact in &state.contact {
            self.largest_slip.see(contact.slip, time);
        }
        self.base_rotation.see(state.base_rotation, time);
        for (probe, value) in self.probes.iter_mut().zip(&state.probes) {
            probe.peak.see(*value, time);
        }
        self.mode_changes += state.transitions.len();
        self.debondings += state.transitions.iter().filter(|t| t.is_debonding()).count();
        self.rebondings += state.transitions.iter().filter(|t| t.is_rebonding()).count();
        let residual = state.ledger.residual();
        if residual.is_nan() || residual > self.ledger_residual {
            self.ledger_residual = residual;
        }
        self.trials += state.trials;
        match state.method {
            SearchMethod::ActiveSet => {}
            SearchMethod::GaussSeidel => self.fallbacks.gauss_seidel += 1,
            SearchMethod::Path => self.fallbacks.path += 1,
        }
    }

    /// Closes the run at `state`; the ground is sampled where steps may have missed something.
    pub(super) fn finish(&mut self, state: &State, ground: &dyn Ground, motion: &dyn FreeField) {
        self.time = state.time;
        self.residual_slip = state.mean_slip;
        self.ledger = state.ledger;
        self.wall = self.begin.map_or(Duration::ZERO, |begin| begin.elapsed());
        self.resolution.resolve_ground(ground, motion, self.start..self.time);
        self.warnings = Warning::all(
            self.largest_slip.value,
            self.shortest,
            self.base_rotation.value,
            &state.ledger,
        );
        self.resolution.warn(&mut self.warnings);
    }

    /// What it asked of time step and elements.
    pub(crate) fn resolution(&self) -> &Resolution {
        &self.resolution
    }

    /// Error bound of the ledger's `soil` by an approximate history, J/m since the start; zero for
    /// exact histories, NaN if no ledger is kept. See [`Ledger::soil_error_bound`].
    pub fn history_error_bound(&self) -> f64 {
        self.ledger.soil_error_bound
    }

    /// Largest value of the probe called `name`.
    ///
    /// # Errors
    /// [`Error::Name`](crate::Error::Name) if there is none.
    pub fn probe(&self, name: &str) -> Result<Peak> {
        probe_index(&self.probes, name, |probe| &probe.name).map(|k| self.probes[k].peak)
    }
}

/// Numbers in kN, mm, mrad and per cent; probes in their unit.
impl fmt::Display for Run {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let steps = self.steps.max(1) as f64;
        let wall = self.wall.as_secs_f64();
        writeln!(
            f,
            "{} steps to t = {:.3} s in {wall:.2} s ({:.1} µs per step, {:.2} solves per step, \
             fallbacks {}/{})",
            self.steps,
            self.time,
            wall / steps * 1e6,
            self.trials as f64 / steps,
            self.fallbacks.gauss_seidel,
            self.fallbacks.path,
        )?;
        let names = self.probes.iter().map(|probe| probe.name.chars().count());
        let width = names.fold(22, usize::max);
        let mut line = |name: &str, peak: Peak, (factor, unit): (f64, &str)| {
            let value = number(factor * peak.value);
            writeln!(f, "  {name:<width$}{value:>12} {unit:<6} at {:.3} s", peak.time)
        };
        line("base shear", self.base_shear, printed("N/m"))?;
        line("base moment, change", self.base_moment_change, printed("N·m/m"))?;
        line("normal force, least", self.normal_force.lowest, printed("N/m"))?;
        line("normal force, largest", self.normal_force.highest, printed("N/m"))?;
        line("uplifted part", self.uplifted_fraction, (100.0, "%"))?;
        line("largest slip", self.largest_slip, printed("m"))?;
        line("base rotation", self.base_rotation, printed("rad"))?;
        for probe in &self.probes {
            line(&probe.name, probe.peak, printed(&probe.unit))?;
        }
        let residual = number(1e3 * self.residual_slip);
        writeln!(f, "  {:<width$}{residual:>12} mm", "mean slip at the end")?;
        writeln!(
            f,
            "  {} mode changes ({} debondings, {} rebondings)",
            self.mode_changes, self.debondings, self.rebondings
        )?;
        write!(f, "{}", self.ledger)?;
        for warning in &self.warnings {
            write!(f, "\nwarning: {warning}")?;
        }
        Ok(())
    }
}
