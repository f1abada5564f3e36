//! Runs under a Ricker pulse, and their sampled histories.

use basemat::bem::Ground;
use basemat::interface::Bonded;
use basemat::motion::RickerDisplacement;
use basemat::results::Run;
use basemat::structure::Structure;
use basemat::{Result, Simulation};

use super::series::Error;

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
pub type History = [Vec<f64>; 3];

/// The history of so many steps, a sample every `every` of them.
pub fn sample(simulation: &mut Simulation, steps: usize, every: usize) -> Result<(History, Run)> {
    let mut history = [const { Vec::new() }; 3];
    let mut shear = 0.0;
    let run = simulation.run(steps, |state| {
        shear += state.base_shear / every as f64;
        if state.step % every == 0 {
            history[0].push(state.absolute_displacement()[0]);
            history[1].push(state.absolute_displacement()[2]);
            history[2].push(shear);
            shear = 0.0;
        }
    })?;
    Ok((history, run))
}

/// Relative distance of `found` from `wanted`, component by component.
pub fn distance(found: &History, wanted: &History) -> [f64; 3] {
    std::array::from_fn(|k| {
        let mut error = Error::default();
        found[k].iter().zip(&wanted[k]).for_each(|(a, b)| error.add(*a, *b));
        error.relative()
    })
}
