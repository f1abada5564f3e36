//! Runs under a Ricker pulse, and samples of their time series.

use basemat::bem::{ElasticGround, Grading, Ground, Strip};
use basemat::coupled::State;
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::RickerDisplacement;
use basemat::results::Run;
use basemat::structure::{RigidBlock, Structure};
use basemat::{Result, Simulation, Soil};

use super::series::{RelativeError, TabledSeries, nearest_integer};
use super::table;

/// The scene of the tables `td_*`: bonded and weightless under a Ricker pulse.
pub fn under_pulse(
    structure: impl Structure + 'static,
    ground: impl Ground + 'static,
    time_step: f64,
) -> Simulation {
    Simulation::builder(time_step)
        .structure(structure)
        .ground(ground)
        .interface(Bonded)
        .gravity(0.0)
        .motion(RickerDisplacement::new(1.0, 1.0, 5.0).unwrap())
        .build()
        .unwrap()
}

/// Base displacement, rotation, and base shear (its mean over a sample).
pub type SampledSeries = [Vec<f64>; 3];

/// Time series of a run of `steps` steps, with a sample every `interval` steps.
pub fn sample(
    simulation: &mut Simulation,
    steps: usize,
    interval: usize,
) -> Result<(SampledSeries, Run)> {
    let mut samples = [const { Vec::new() }; 3];
    let mut shear = 0.0;
    let run = simulation.run(steps, |state| {
        shear += state.base_shear / interval as f64;
        if state.step % interval == 0 {
            samples[0].push(state.absolute_displacement()[0]);
            samples[1].push(state.absolute_displacement()[2]);
            samples[2].push(shear);
            shear = 0.0;
        }
    })?;
    Ok((samples, run))
}

/// Relative distance of `computed` from `expected`, component by component.
pub fn distance(computed: &SampledSeries, expected: &SampledSeries) -> [f64; 3] {
    std::array::from_fn(|k| {
        let mut error = RelativeError::default();
        computed[k].iter().zip(&expected[k]).for_each(|(a, b)| error.add(*a, *b));
        error.relative()
    })
}

/// Interval between samples of a [`PulsedBlock`], s: all time steps divide it.
pub const SAMPLING_INTERVAL: f64 = 0.2;

/// A block of width 2 and mass 4 under a Ricker pulse of peak 1 that ends before `duration`.
///
/// It is bonded if it has no `friction`.
#[derive(Debug, Clone, Copy)]
pub struct PulsedBlock {
    pub height: f64,
    pub gravity: f64,
    pub sigma: f64,
    pub friction: Option<f64>,
    pub duration: f64,
}

impl PulsedBlock {
    /// The bonded block of the reference table.
    pub const BONDED_BLOCK: Self =
        Self { height: 2.0, gravity: 0.0, sigma: 1.0, friction: None, duration: 20.0 };
    /// A slender block under a slow pulse.
    pub const SLENDER_BLOCK: Self =
        Self { height: 6.0, gravity: 0.15, sigma: 2.0, friction: None, duration: 25.0 };
    /// A block that slides and lifts.
    pub const SLIDING_BLOCK: Self =
        Self { height: 4.0, gravity: 0.1, sigma: 1.0, friction: Some(2.0), duration: 20.0 };

    /// Time series of the block on a strip of `elements` elements.
    pub fn run(
        self,
        (grading, elements): (Grading, usize),
        time_step: f64,
    ) -> Result<(SampledSeries, Run)> {
        let soil = Soil::new(1.0, 1.0 / 3.0, 1.0)?;
        let strip = Strip::new(-1.0..1.0, elements, grading)?;
        let builder = Simulation::builder(time_step)
            .structure(RigidBlock::new(2.0, self.height, 2.0 / self.height)?)
            .ground(ElasticGround::new(soil, strip)?)
            .motion(RickerDisplacement::new(1.0, self.sigma, 5.0 * self.sigma)?)
            .gravity(self.gravity);
        let builder = match self.friction {
            Some(friction) => builder.interface(Coulomb::new(friction)?),
            None => builder.interface(Bonded),
        };
        let interval = nearest_integer(SAMPLING_INTERVAL / time_step);
        sample(&mut builder.build()?, nearest_integer(self.duration / time_step), interval)
    }

    /// Sampled reference of the bonded block, from its table.
    pub fn table_series() -> SampledSeries {
        let table = table("td_block_SV_nu0333_h2_rho1.csv");
        let base = TabledSeries::new(&table, "u_base");
        let rotation = TabledSeries::new(&table, "theta");
        let shear = TabledSeries::new(&table, "V");
        let samples = nearest_integer(Self::BONDED_BLOCK.duration / SAMPLING_INTERVAL);
        let times: Vec<f64> = (1..=samples).map(|n| n as f64 * SAMPLING_INTERVAL).collect();
        [
            times.iter().map(|time| base.at(*time)).collect(),
            times.iter().map(|time| -rotation.at(*time)).collect(),
            times.iter().map(|time| sample_mean(&shear, *time)).collect(),
        ]
    }
}

/// Mean over the sample that ends at a time, from means over its eighths.
fn sample_mean(series: &TabledSeries, time: f64) -> f64 {
    let eighth = SAMPLING_INTERVAL / 8.0;
    (0..8).map(|k| series.mean(time - f64::from(k) * eighth, eighth)).sum::<f64>() / 8.0
}

/// Horizontal displacement of a block's base.
pub fn base_motion(state: &State) -> f64 {
    state.absolute_displacement()[0]
}

/// Rotation of a block's base as the tables count it, clockwise.
pub fn rotation(state: &State) -> f64 {
    -state.absolute_displacement()[2]
}

/// Horizontal force of a block on the soil.
pub fn shear(state: &State) -> f64 {
    state.base_shear
}

/// Moment of a block on the soil as the tables count it, clockwise.
pub fn moment(state: &State) -> f64 {
    -state.base_moment
}
