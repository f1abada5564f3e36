//! A slender block that is tilted and released.
//!
//! ```text
//! cargo run --release --example tilted_block
//! ```
//!
//! For rigid ground, Housner's formulas (1963) give the time until the block is upright and its largest tilt to the
//! other side. Soil deforms under the edge, and less energy is lost at an impact.

use basemat::Result;
use basemat::coupled::GravityStage;
use basemat::prelude::*;
use basemat::reference::RockingBlock;

/// Width of the block, m.
const BLOCK_WIDTH: f64 = 1.0;
/// Height of the block, m.
const BLOCK_HEIGHT: f64 = 4.0;
/// Time step, s.
const TIME_STEP: f64 = 5.0e-4;

fn main() -> Result<()> {
    let rigid_ground_block =
        RockingBlock::new(0.5 * BLOCK_WIDTH, 0.5 * BLOCK_HEIGHT, STANDARD_GRAVITY)?;
    let tilt = 0.3 * rigid_ground_block.slenderness_angle();
    let quarter_period = 0.25 * rigid_ground_block.period(tilt)?;
    println!("c_S, m/s   upright after, s   other side, % of the tilt   energy balance");
    println!(
        "   rigid{quarter_period:19.4}{:28.1}",
        100.0 * rigid_ground_block.next_peak(tilt)? / tilt
    );
    for speed in [800.0, 400.0, 200.0, 100.0] {
        let block =
            RigidBlock::new(BLOCK_WIDTH, BLOCK_HEIGHT, 2500.0)?.with_p_delta(STANDARD_GRAVITY)?;
        let soil = Soil::from_shear_wave_speed(speed, 0.3, 2000.0)?;
        let mut simulation = Simulation::builder(TIME_STEP)
            .ground(ElasticGround::under(soil, &block, 24)?)
            .structure(block)
            .interface(Coulomb::new(1.0)?)
            // At t = 0 the block is tilted on its left edge, and the contact pressure is zero.
            .gravity_stage(GravityStage::Unloaded)
            .initial_displacement([0.0, 0.5 * BLOCK_WIDTH * tilt, tilt])
            .build()?;
        let mut upright_time = None;
        let steps = simulation.steps_for(2.6 * quarter_period);
        let run = simulation.run(steps, |state| {
            if state.base_rotation <= 0.0 {
                upright_time.get_or_insert(state.time);
            }
        })?;
        let opposite_tilt = -run.whole.base_rotation.lowest.value / tilt;
        println!(
            "{speed:8.0}{:19.4}{:28.1}{:9.0e}",
            upright_time.unwrap_or(f64::NAN),
            100.0 * opposite_tilt,
            run.energy_error
        );
    }
    Ok(())
}
