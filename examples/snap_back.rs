//! A snap-back test: a cable pulls the roof of a building and is cut.
//!
//! ```text
//! cargo run --release --example snap_back
//! ```
//!
//! The pull belongs to the static state, and is removed at the first step. The building then vibrates in its
//! lowest mode on the soil. Its period is longer than on a fixed base, and its damping is radiation damping
//! alone.

use basemat::Result;
use basemat::coupled::Load;
use basemat::prelude::*;

const TIME_STEP: f64 = 0.002;

/// A peak of the free vibration: its step, and its height above the position at rest, m.
struct Peak {
    step: usize,
    height: f64,
}

fn main() -> Result<()> {
    let building = ShearBuilding::new(8.0, 40.0e3, 4.0e5, &[Storey::new(3.0, 20.0e3, 40.0e6); 4])?;
    let roof = building.roof();
    println!("Fixed base: {:.3} s\n", 1.0 / building.fixed_base_frequency());
    println!("c_S, m/s   pulled, mm   period, s   damping, %   energy balance");
    for speed in [800.0, 400.0, 200.0, 100.0] {
        let soil = Soil::from_shear_wave_speed(speed, 0.33, 1900.0)?;
        let mut simulation = Simulation::builder(TIME_STEP)
            .ground(ElasticGround::under(soil, &building, 12)?)
            .structure(building.clone())
            .interface(Coulomb::new(0.7)?)
            .load(Load::released(roof, 100.0e3))
            .probe(Probe::displacement("roof", roof))
            .build()?;
        let initial_displacement = simulation.static_displacement()[roof];
        let mut sway = Vec::new();
        let run = simulation.run(2000, |state| sway.push(state.probes[0]))?;
        // Peaks on the side of the pull, relative to the position at rest.
        let rest = sway[sway.len() - 1];
        let peaks: Vec<Peak> = (1..sway.len() - 1)
            .filter(|&k| sway[k] > sway[k - 1] && sway[k] >= sway[k + 1] && sway[k] > rest)
            .map(|k| Peak { step: k, height: sway[k] - rest })
            .collect();
        // The first peak still contains higher modes.
        let last = peaks.len().min(5) - 1;
        let cycles = (last - 1) as f64;
        let period = (peaks[last].step - peaks[1].step) as f64 * TIME_STEP / cycles;
        let damping =
            (peaks[1].height / peaks[last].height).ln() / (std::f64::consts::TAU * cycles);
        println!(
            "{speed:8.0}{:13.2}{period:12.3}{:13.2}{:9.0e}",
            1e3 * initial_displacement,
            1e2 * damping,
            run.energy_error
        );
    }
    Ok(())
}
