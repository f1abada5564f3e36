//! A slender block is tilted and released: time until it is upright, and largest opposite tilt.
//!
//! ```text
//! cargo run --release --example tilted_block
//! ```
//!
//! On rigid ground Housner's formulas (1963) give both. Soil deforms under the edge, and less energy is lost
//! at an impact.

use basemat::Result;
use basemat::coupled::GravityStage;
use basemat::prelude::*;
use basemat::reference::RockingBlock;

fn main() -> Result<()> {
    let (width, height, step) = (1.0, 4.0, 5.0e-4);
    let rigid = RockingBlock::new(0.5 * width, 0.5 * height, STANDARD_GRAVITY)?;
    let tilt = 0.3 * rigid.slenderness_angle();
    let quarter = 0.25 * rigid.period(tilt)?;
    println!("c_S, m/s   upright after, s   other side, % of the tilt   energy balance");
    println!("   rigid{quarter:19.4}{:28.1}", 100.0 * rigid.next_peak(tilt)? / tilt);
    for speed in [800.0, 400.0, 200.0, 100.0] {
        let block = RigidBlock::new(width, height, 2500.0)?.with_p_delta(STANDARD_GRAVITY)?;
        let soil = Soil::from_shear_wave_speed(speed, 0.3, 2000.0)?;
        let mut simulation = Simulation::builder(step)
            .ground(ElasticGround::under(soil, &block, 24)?)
            .structure(block)
            .interface(Coulomb::new(1.0)?)
            // The contact pressure is zero at t = 0, when the block stands on its left edge.
            .gravity_stage(GravityStage::Unloaded)
            .initial_displacement([0.0, 0.5 * width * tilt, tilt])
            .build()?;
        let mut upright = None;
        let steps = simulation.steps_for(2.6 * quarter);
        let run = simulation.run(steps, |state| {
            if state.base_rotation <= 0.0 {
                upright.get_or_insert(state.time);
            }
        })?;
        let over = -run.whole.base_rotation.lowest.value / tilt;
        println!(
            "{speed:8.0}{:19.4}{:28.1}{:9.0e}",
            upright.unwrap_or(f64::NAN),
            100.0 * over,
            run.energy_error
        );
    }
    Ok(())
}
