//! A snap-back test: a cable pulls the roof of a building and is cut.
//!
//! ```text
//! cargo run --release --example snap_back
//! ```
//!
//! The pull is part of the static state, and is removed at the first step. The building then vibrates in its lowest
//! mode on the soil. The period is longer than on a fixed base, and the only damping is radiation damping.

use basemat::Result;
use basemat::coupled::Load;
use basemat::prelude::*;

/// Time step, s.
const TIME_STEP: f64 = 0.002;
const STEP_COUNT: usize = 2000;

/// A peak of the free vibration.
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
        let mut roof_displacement = Vec::new();
        let run = simulation.run(STEP_COUNT, |state| roof_displacement.push(state.probes[0]))?;
        // Peaks on the side of the pull, relative to the displacement at the end of the run, when the roof is almost at
        // rest.
        let final_displacement = roof_displacement[roof_displacement.len() - 1];
        let peaks: Vec<Peak> = (1..roof_displacement.len() - 1)
            .filter(|&k| {
                roof_displacement[k] > roof_displacement[k - 1]
                    && roof_displacement[k] >= roof_displacement[k + 1]
                    && roof_displacement[k] > final_displacement
            })
            .map(|k| Peak { step: k, height: roof_displacement[k] - final_displacement })
            .collect();
        // The first peak is left out, since it still contains higher modes; five peaks are enough for period and
        // damping.
        let last_peak = peaks.len().min(5) - 1;
        let cycles = (last_peak - 1) as f64;
        let period = (peaks[last_peak].step - peaks[1].step) as f64 * TIME_STEP / cycles;
        let damping =
            (peaks[1].height / peaks[last_peak].height).ln() / (std::f64::consts::TAU * cycles);
        println!(
            "{speed:8.0}{:13.2}{period:12.3}{:13.2}{:9.0e}",
            1e3 * initial_displacement,
            1e2 * damping,
            run.energy_error
        );
    }
    Ok(())
}
