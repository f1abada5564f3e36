//! Marches a cell and judges it.
//!
//! After the shaking has stopped nothing feeds the scene. For the crate's own scheme it is proved
//! that then
//!
//! ```text
//! H = kinetic + strain + interface + static_contact + soil
//! ```
//!
//! cannot rise, but for the work of a weight that acts as a load, which is taken off: dashpots, friction and impacts
//! only take. The same holds for the dissipative midpoint rule with `algorithmic` in H. `rise` says by how much H rises
//! all the same, relative to the largest energy of the run, including the energy of the structure carried along by the
//! ground: a block that its ground leaves behind has only rounding. `least_soil` is the least work done on the soil,
//! relative in the same way: below zero, the soil returned more than it had received.

use basemat::Error;
use basemat::bem::GroundError;
use basemat::contact::SearchMethod;
use basemat::coupled::StepError;
use basemat::coupled::{EnergyBalance, State};

use super::scene::{Foretold, Law, Scene, Scheme};

/// Rise of energy, energy out of the soil, and energy error that pass for rounding.
pub(crate) const ROUNDING: f64 = 1e-9;
/// Growth of energy from the first to the last quarter of the rest that counts as growth.
const GROWTH: f64 = 1.1;
const WINDOWS: usize = 4;

/// Verdict on a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// Energy does not grow, and the soil gives nothing that it has not got.
    Bounded,
    /// Energy did not grow in this run, but came out of nothing.
    Active,
    /// Energy grows with nothing to feed it.
    Grows,
    /// No simulation could be made.
    Refused,
    /// A step failed.
    Failed,
}

impl Verdict {
    pub(crate) const ALL: [Self; 5] =
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
pub(crate) struct Outcome {
    pub(crate) verdict: Verdict,
    /// Energy error at the end, and the largest of the run.
    pub(crate) energy_balance: [f64; 2],
    /// Largest energy of the structure in the last quarter of the rest, over that in the first.
    pub(crate) growth: f64,
    /// Growth of amplitudes per step in growing cells; else 0.
    pub(crate) growth_per_step: f64,
    pub(crate) rise: f64,
    pub(crate) least_soil: f64,
    /// Most energy that the time scheme has made, relative in the same way.
    pub(crate) made: f64,
    /// Linear solves per step, mean and most.
    pub(crate) trials: [f64; 2],
    /// Steps that needed Gauss–Seidel, and a path.
    pub(crate) fallbacks: [usize; 2],
    pub(crate) mode_changes: usize,
    pub(crate) largest_uplift: f64,
    /// Steps made.
    pub(crate) steps: usize,
    /// Growth per step that was foretold, base uplifted and bonded, where it was assessed.
    pub(crate) assessed: Option<[f64; 2]>,
    pub(crate) error: Option<Error>,
}

impl Outcome {
    fn new() -> Self {
        Self {
            verdict: Verdict::Bounded,
            energy_balance: [0.0; 2],
            growth: 0.0,
            growth_per_step: 0.0,
            rise: 0.0,
            least_soil: 0.0,
            made: 0.0,
            trials: [0.0; 2],
            fallbacks: [0; 2],
            mode_changes: 0,
            largest_uplift: 0.0,
            steps: 0,
            assessed: None,
            error: None,
        }
    }

    /// Whether the cell is as it must be in the crate's own scheme.
    pub(crate) fn is_as_guaranteed(&self, allowed: &[Verdict]) -> bool {
        (self.verdict == Verdict::Bounded || allowed.contains(&self.verdict))
            && self.energy_balance[0] < ROUNDING
    }

    /// Whether the crate's default refuses this boundary equation: [`GroundError::Unstable`].
    pub(crate) fn is_foretold(&self) -> bool {
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
struct Watch {
    /// Steps of shaking and of rest.
    phases: [usize; 2],
    /// Largest energy of the structure in each window of the rest.
    windows: [f64; WINDOWS],
    /// The same in the first and second half of the shaking.
    halves: [f64; 2],
    /// Energy H at the end of the shaking, from which growth is measured.
    stored: f64,
    /// Work of loads and ground when the shaking stops.
    fed: f64,
    /// Whether the structure may sink, so that its weight moves it.
    sinks: bool,
    least_total: f64,
    rise: f64,
    least_soil: f64,
    least_algorithmic: f64,
    scale: f64,
}

impl Watch {
    fn see(&mut self, step: usize, energy_balance: &EnergyBalance) {
        let own = energy_balance.kinetic
            + energy_balance.strain
            + energy_balance.interface
            + energy_balance.static_contact;
        self.scale = self.scale.max(energy_balance.largest);
        self.least_soil = self.least_soil.min(energy_balance.soil);
        self.least_algorithmic = self.least_algorithmic.min(energy_balance.algorithmic);
        let [shaking, rest] = self.phases;
        if step <= shaking {
            let half = usize::from(2 * step > shaking);
            self.halves[half] = self.halves[half].max(own.abs());
            self.stored = own + energy_balance.soil;
            self.fed = energy_balance.input;
            return;
        }
        let window = (WINDOWS * (step - shaking - 1) / rest).min(WINDOWS - 1);
        self.windows[window] = self.windows[window].max(own.abs());
        let total = own + energy_balance.soil + energy_balance.algorithmic.max(0.0)
            - (energy_balance.input - self.fed);
        self.rise = self.rise.max(total - self.least_total);
        self.least_total = self.least_total.min(total);
    }
}

/// Marches the cell; `progress` is called now and then with the fraction done.
pub(crate) fn march(scene: &Scene, foretold: &Foretold, progress: &dyn Fn(f64)) -> Outcome {
    let mut out = Outcome::new();
    out.assessed = scene.assess(foretold);
    let mut simulation = match scene.build() {
        Ok(simulation) => simulation,
        Err(error) => {
            (out.verdict, out.error) = (Verdict::Refused, Some(error));
            return out;
        }
    };
    let (shaking, rest) = (scene.steps, scene.rest());
    let mut watch = Watch {
        phases: [shaking, rest],
        windows: [0.0; WINDOWS],
        halves: [0.0; 2],
        stored: 0.0,
        fed: 0.0,
        sinks: scene.tilt != 0.0 || matches!(scene.law, Law::Yielding(_)),
        least_total: f64::INFINITY,
        rise: 0.0,
        least_soil: 0.0,
        least_algorithmic: 0.0,
        scale: 0.0,
    };
    let mut trials = 0;
    for step in 1..=shaking + rest {
        match simulation.step() {
            Ok(state) => {
                trials += state.trials;
                out.count(state);
                watch.see(step, &state.energy_balance);
            }
            Err(error) => {
                out.error = Some(error);
                break;
            }
        }
        out.steps = step;
        if step % 10_000 == 0 {
            progress(step as f64 / (shaking + rest) as f64);
        }
    }
    out.trials[0] = trials as f64 / out.steps.max(1) as f64;
    out.energy_balance[0] = simulation.state().energy_balance.residual();
    out.judge(scene.scheme, &watch);
    out
}

impl Outcome {
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

    fn judge(&mut self, scheme: Scheme, watch: &Watch) {
        let relative = |x: f64| if watch.scale > 0.0 { x / watch.scale } else { 0.0 };
        (self.rise, self.least_soil) = (relative(watch.rise), relative(watch.least_soil));
        self.made = relative(watch.least_algorithmic.abs());
        let [first, .., last] = watch.windows;
        // Energy below the rounding of the largest energy does not count as motion.
        let floor = 1e-12 * watch.scale;
        self.growth = if last > floor { last / first.max(floor) } else { 0.0 };
        let rising = watch.windows.windows(2).all(|w| w[1] > w[0]);
        // The trapezoidal rule moves energy to and fro at impacts; the soil's work tells.
        let rises = scheme.is_passive() && self.rise > ROUNDING;
        let active = rises || self.least_soil < -ROUNDING;
        let [shaking, rest] = watch.phases;
        let (ratio, steps) = if self.error.is_some() && self.steps < shaking + rest {
            let end = watch.windows.iter().fold(watch.halves[1], |m, w| m.max(*w));
            (end / watch.halves[0].max(floor), 0.5 * self.steps as f64)
        } else {
            (self.growth, 0.75 * rest as f64)
        };
        let grows = match &self.error {
            Some(Error::Step {
                source: StepError::NotFinite { .. } | StepError::Runaway { .. },
                ..
            }) => true,
            // A march that fails in what its soil has blown up has not failed by itself.
            Some(_) => active && ratio > 1e3,
            // Here `rise` tells.
            None if watch.sinks => !last.is_finite(),
            // Soil and weight may give back to the structure what they hold.
            None => {
                let more = last > GROWTH * watch.stored.max(floor);
                !last.is_finite() || (rising && self.growth > GROWTH && more)
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
pub(crate) struct Cell {
    /// Number of the map.
    pub(crate) map: usize,
    pub(crate) scheme: Scheme,
    /// Places on the axes.
    pub(crate) place: [usize; 2],
    pub(crate) outcome: Outcome,
}
