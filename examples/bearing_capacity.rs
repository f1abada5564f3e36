//! A rocking block on soil that yields: settlement and rounding of the ground for several bearing pressures.
//!
//! ```text
//! cargo run --release --example bearing_capacity
//! ```
//!
//! The soil beneath an element settles permanently where the pressure reaches q; the half-plane below stays
//! elastic. A lower q makes the edges settle more, the block shake less, and the block lean more.

use basemat::Result;
use basemat::interface::Yielding;
use basemat::prelude::*;

fn main() -> Result<()> {
    let soil = Soil::from_shear_wave_speed(180.0, 0.33, 1900.0)?;
    let mean = 8.0 * 2000.0 * STANDARD_GRAVITY;
    println!("El Centro × 1.3 on a block of 4 m × 8 m, mean pressure {:.0} kPa\n", 1e-3 * mean);
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
            builder.interface(Yielding::new(factor * mean, 0.6)?).build()?
        } else {
            builder.interface(Coulomb::new(0.6)?).build()?
        };
        let run = simulation.run(7000, |_| {})?;
        let state = simulation.state();
        let sunk = |element| 1e3 * state.state_variables(element).first().copied().unwrap_or(0.0);
        println!(
            "{factor:8.1}{:17.3}{:22.2}{:17.1}{:9.1}{:9.0e}",
            run.whole.base_shear.magnitude() / run.whole.static_normal_force,
            1e3 * state.base_rotation,
            sunk(0).max(sunk(11)),
            sunk(6),
            run.energy_error
        );
    }
    Ok(())
}
