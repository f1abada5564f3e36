//! A rocking block on soil that yields at several bearing pressures.
//!
//! ```text
//! cargo run --release --example bearing_capacity
//! ```
//!
//! The soil beneath a contact element settles permanently where the pressure reaches q; the half-plane below stays
//! elastic. The settlement rounds the ground under the edges of the block. With a lower q, the edges settle more, the
//! base shear is smaller, and the block is left with a larger tilt.

use basemat::Result;
use basemat::interface::Yielding;
use basemat::prelude::*;

/// Number of steps of 5 ms.
const STEP_COUNT: usize = 7000;

/// Permanent settlement of the soil under an element, mm; zero for a law without state variables.
fn settlement(state: &State, element: usize) -> f64 {
    1e3 * state.state_variables(element).first().copied().unwrap_or(0.0)
}

fn main() -> Result<()> {
    let soil = Soil::from_shear_wave_speed(180.0, 0.33, 1900.0)?;
    let mean_pressure = 8.0 * 2000.0 * STANDARD_GRAVITY;
    println!(
        "El Centro × 1.3 on a block of 4 m × 8 m, mean pressure {:.0} kPa\n",
        1e-3 * mean_pressure
    );
    println!(
        "q / mean   shear / weight   rotation left, mrad   sunk, mm: edge   middle   energy balance"
    );
    for factor in [f64::INFINITY, 8.0, 5.0, 3.5, 2.5] {
        let block = RigidBlock::new(4.0, 8.0, 2000.0)?;
        let builder = Simulation::builder(0.005)
            .ground(ElasticGround::under(soil, &block, 12)?)
            .structure(block)
            .motion(el_centro_1940().scaled(1.3)?);
        let mut simulation = if factor.is_finite() {
            builder.interface(Yielding::new(factor * mean_pressure, 0.6)?).build()?
        } else {
            builder.interface(Coulomb::new(0.6)?).build()?
        };
        let run = simulation.run(STEP_COUNT, |_| {})?;
        let state = simulation.state();
        println!(
            "{factor:8.1}{:17.3}{:22.2}{:17.1}{:9.1}{:9.0e}",
            run.whole.base_shear.magnitude() / run.whole.static_normal_force,
            1e3 * state.base_rotation,
            settlement(state, 0).max(settlement(state, 11)),
            settlement(state, 6),
            run.energy_error
        );
    }
    Ok(())
}
