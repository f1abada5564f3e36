//! Computes a cell and its verdict.
//!
//! After the end of the shaking, no energy enters the scene. For the crate's scheme it is proved
//! that
//!
//! ```text
//! H = kinetic + strain + interface + static contact + soil
//! ```
//!
//! cannot rise, because dashpots, friction and impacts only dissipate. The work of a weight that acts as a load is
//! subtracted. The same is true of the dissipative midpoint rule with `algorithmic` in H. `rise` is the largest rise of
//! H relative to the largest energy of the run. This energy includes the motion of the structure with the ground.
//! `smallest_soil_work` is the smallest work done on the soil, relative in the same way: below zero, the soil returned
//! more than it had received.

use basemat::Error;
use basemat::bem::GroundError;
use basemat::contact::SearchMethod;
use basemat::coupled::StepError;
use basemat::coupled::{EnergyBalance, State};

use super::scene::{Assessments, StabilityLaw, StabilityScene, StabilityScheme};

/// Rise of energy, energy out of the soil, and energy error that count as rounding.
pub(crate) const ENERGY_ROUNDING: f64 = 1e-9;
/// Growth of energy from the first to the last quarter of the rest that counts as growth.
const GROWTH_LIMIT: f64 = 1.1;
const WINDOW_COUNT: usize = 4;

/// Verdict on a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// Energy does not grow, and the soil does not return more than it has received.
    Bounded,
    /// Energy did not grow in this run, but was created.
    Active,
    /// Energy grows without work from outside.
    Grows,
    /// The simulation could not be built.
    Refused,
    /// A step failed.
    Failed,
}

impl Verdict {
    pub(crate) const ALL_VERDICTS: [Self; 5] =
        [Self::Bounded, Self::Active, Self::Grows, Self::Refused, Self::Failed];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Bounded => "bounded",
            Self::Active => "active",
            Self::Grows => "grows",
            Self::Refused => "refused",
            Self::Failed => "failed",
        }
    }
}

/// Results of a cell.
#[derive(Debug, Clone)]
pub(crate) struct CellOutcome {
    pub(crate) verdict: Verdict,
    /// Energy error at the end, and the largest of the run.
    pub(crate) energy_balance: [f64; 2],
    /// Largest energy of the structure in the last quarter of the rest, over that in the first.
    pub(crate) growth: f64,
    /// Growth of amplitudes per step in growing cells; else 0.
    pub(crate) growth_per_step: f64,
    pub(crate) rise: f64,
    pub(crate) smallest_soil_work: f64,
    /// Largest energy that the time scheme has created, relative in the same way.
    pub(crate) created_energy: f64,
    /// Linear solves per step, mean and maximum.
    pub(crate) trials: [f64; 2],
    /// Steps by Gauss–Seidel, and by path following.
    pub(crate) fallbacks: [usize; 2],
    pub(crate) mode_changes: usize,
    pub(crate) largest_uplift: f64,
    /// Steps computed.
    pub(crate) steps: usize,
    /// Growth per step by the assessment of the boundary equation, base uplifted and bonded.
    pub(crate) assessed: Option<[f64; 2]>,
    pub(crate) error: Option<Error>,
}

impl CellOutcome {
    fn new() -> Self {
        Self {
            verdict: Verdict::Bounded,
            energy_balance: [0.0; 2],
            growth: 0.0,
            growth_per_step: 0.0,
            rise: 0.0,
            smallest_soil_work: 0.0,
            created_energy: 0.0,
            trials: [0.0; 2],
            fallbacks: [0; 2],
            mode_changes: 0,
            largest_uplift: 0.0,
            steps: 0,
            assessed: None,
            error: None,
        }
    }

    /// Whether the cell fulfils the guarantees of the crate's scheme.
    pub(crate) fn is_as_guaranteed(&self, allowed: &[Verdict]) -> bool {
        (self.verdict == Verdict::Bounded || allowed.contains(&self.verdict))
            && self.energy_balance[0] < ENERGY_ROUNDING
    }

    /// Whether the assessment finds growth, for which the crate returns [`GroundError::Unstable`].
    pub(crate) fn is_unstable(&self) -> bool {
        self.assessed.is_some_and(|growth| growth[0] > 0.0 || growth[1] > 0.0)
    }

    /// A letter for the error.
    pub(crate) fn letter(&self) -> &'static str {
        match &self.error {
            Some(Error::Step { source: StepError::Contact { .. }, .. }) => "C",
            Some(Error::Step { source: StepError::NotFinite { .. }, .. }) => "N",
            Some(Error::Step { .. }) => "S",
            Some(Error::Preload { .. }) => "P",
            Some(Error::Ground(GroundError::Unstable { .. })) => "U",
            Some(Error::Singular { .. }) => "M",
            Some(Error::IllConditioned { .. }) => "I",
            Some(_) => "E",
            None => "",
        }
    }
}

/// Energies over a run.
struct EnergyTracker {
    shaking_steps: usize,
    rest_steps: usize,
    /// Largest energy of the structure in each window of the rest.
    windows: [f64; WINDOW_COUNT],
    /// Largest energy of the structure in the first and second half of the shaking.
    halves: [f64; 2],
    /// Energy H at the end of the shaking, from which growth is measured.
    stored: f64,
    /// Work of loads and ground at the end of the shaking.
    input: f64,
    /// Whether the structure may sink, so that its weight moves it.
    sinks: bool,
    smallest_total: f64,
    rise: f64,
    smallest_soil_work: f64,
    smallest_algorithmic: f64,
    scale: f64,
}

impl EnergyTracker {
    fn update(&mut self, step: usize, energy_balance: &EnergyBalance) {
        let structure_energy = energy_balance.kinetic
            + energy_balance.strain
            + energy_balance.interface
            + energy_balance.static_contact;
        self.scale = self.scale.max(energy_balance.largest);
        self.smallest_soil_work = self.smallest_soil_work.min(energy_balance.soil);
        self.smallest_algorithmic = self.smallest_algorithmic.min(energy_balance.algorithmic);
        if step <= self.shaking_steps {
            let half = usize::from(2 * step > self.shaking_steps);
            self.halves[half] = self.halves[half].max(structure_energy.abs());
            self.stored = structure_energy + energy_balance.soil;
            self.input = energy_balance.input;
            return;
        }
        let window = (WINDOW_COUNT * (step - self.shaking_steps - 1) / self.rest_steps)
            .min(WINDOW_COUNT - 1);
        self.windows[window] = self.windows[window].max(structure_energy.abs());
        let total = structure_energy + energy_balance.soil + energy_balance.algorithmic.max(0.0)
            - (energy_balance.input - self.input);
        self.rise = self.rise.max(total - self.smallest_total);
        self.smallest_total = self.smallest_total.min(total);
    }
}

/// Computes the cell; `progress` receives the completed fraction from time to time.
pub(crate) fn march(
    scene: &StabilityScene,
    assessments: &Assessments,
    progress: &dyn Fn(f64),
) -> CellOutcome {
    let mut outcome = CellOutcome::new();
    outcome.assessed = scene.assess(assessments);
    let mut simulation = match scene.build() {
        Ok(simulation) => simulation,
        Err(error) => {
            outcome.verdict = Verdict::Refused;
            outcome.error = Some(error);
            return outcome;
        }
    };
    let shaking = scene.steps;
    let rest = scene.rest();
    let mut tracker = EnergyTracker {
        shaking_steps: shaking,
        rest_steps: rest,
        windows: [0.0; WINDOW_COUNT],
        halves: [0.0; 2],
        stored: 0.0,
        input: 0.0,
        sinks: scene.tilt != 0.0 || matches!(scene.law, StabilityLaw::Yielding(_)),
        smallest_total: f64::INFINITY,
        rise: 0.0,
        smallest_soil_work: 0.0,
        smallest_algorithmic: 0.0,
        scale: 0.0,
    };
    let mut trials = 0;
    for step in 1..=shaking + rest {
        match simulation.step() {
            Ok(state) => {
                trials += state.trials;
                outcome.count(state);
                tracker.update(step, &state.energy_balance);
            }
            Err(error) => {
                outcome.error = Some(error);
                break;
            }
        }
        outcome.steps = step;
        if step % 10_000 == 0 {
            progress(step as f64 / (shaking + rest) as f64);
        }
    }
    outcome.trials[0] = trials as f64 / outcome.steps.max(1) as f64;
    outcome.energy_balance[0] = simulation.state().energy_balance.residual();
    outcome.judge(scene.scheme, &tracker);
    outcome
}

impl CellOutcome {
    fn count(&mut self, state: &State) {
        self.trials[1] = self.trials[1].max(state.trials as f64);
        match state.method {
            SearchMethod::GaussSeidel => self.fallbacks[0] += 1,
            SearchMethod::Path => self.fallbacks[1] += 1,
            _ => {}
        }
        self.mode_changes += state.transitions.len();
        self.largest_uplift = self.largest_uplift.max(state.uplifted_fraction);
        self.energy_balance[1] = self.energy_balance[1].max(state.energy_balance.residual());
    }

    fn judge(&mut self, scheme: StabilityScheme, tracker: &EnergyTracker) {
        let relative_energy =
            |energy: f64| if tracker.scale > 0.0 { energy / tracker.scale } else { 0.0 };
        self.rise = relative_energy(tracker.rise);
        self.smallest_soil_work = relative_energy(tracker.smallest_soil_work);
        self.created_energy = relative_energy(tracker.smallest_algorithmic.abs());
        let first = tracker.windows[0];
        let last_window = tracker.windows[WINDOW_COUNT - 1];
        // Energy below the rounding of the largest energy does not count as motion.
        let floor = 1e-12 * tracker.scale;
        self.growth = if last_window > floor { last_window / first.max(floor) } else { 0.0 };
        let is_rising = tracker.windows.windows(2).all(|pair| pair[1] > pair[0]);
        // The trapezoidal rule changes energies at impacts, so that only the soil's work counts.
        let rises = scheme.is_passive() && self.rise > ENERGY_ROUNDING;
        let active = rises || self.smallest_soil_work < -ENERGY_ROUNDING;
        let all_steps = tracker.shaking_steps + tracker.rest_steps;
        let (ratio, steps) = if self.error.is_some() && self.steps < all_steps {
            let end =
                tracker.windows.iter().fold(tracker.halves[1], |end, window| end.max(*window));
            (end / tracker.halves[0].max(floor), 0.5 * self.steps as f64)
        } else {
            (self.growth, 0.75 * tracker.rest_steps as f64)
        };
        let grows = match &self.error {
            Some(Error::Step {
                source: StepError::NotFinite { .. } | StepError::Runaway { .. },
                ..
            }) => true,
            // A failed run whose soil has increased the energy counts as growth, not as failure.
            Some(_) => active && ratio > 1e3,
            // `rise` decides here.
            None if tracker.sinks => !last_window.is_finite(),
            // Soil and weight may return stored energy to the structure.
            None => {
                let exceeds_stored = last_window > GROWTH_LIMIT * tracker.stored.max(floor);
                !last_window.is_finite()
                    || (is_rising && self.growth > GROWTH_LIMIT && exceeds_stored)
            }
        };
        self.verdict = match (grows, &self.error, active) {
            (true, ..) => Verdict::Grows,
            (_, Some(_), _) => Verdict::Failed,
            (.., true) => Verdict::Active,
            _ => Verdict::Bounded,
        };
        if grows {
            self.growth_per_step = ratio.max(1.0).powf(0.5 / steps.max(1.0)) - 1.0;
        }
    }
}

/// One cell of a map.
pub(crate) struct MapCell {
    /// Number of the map.
    pub(crate) map: usize,
    pub(crate) scheme: StabilityScheme,
    /// Places on the axes.
    pub(crate) place: [usize; 2],
    pub(crate) outcome: CellOutcome,
}
