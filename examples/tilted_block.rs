//! A slender block that is tilted and released.
//!
//! ```text
//! cargo run --release --example tilted_block
//! ```
//!
//! Housner's formulas (1963) give the time until the block is upright and its largest opposite tilt on rigid ground. Soil deforms under the edge, and less energy is lost
//! at an impact.

use basemat::Result;
use basemat::coupled::GravityStage;
use basemat::prelude::*;
use basemat::reference::RockingBlock;

const BLOCK_WIDTH: f64 = 1.0;
const BLOCK_HEIGHT: f64 = 4.0;
const TIME_STEP: f64 = 5.0e-4;

fn main() -> Result<()> {
    let rigid = RockingBlock::new(0.5 * BLOCK_WIDTH, 0.5 * BLOCK_HEIGHT, STANDARD_GRAVITY)?;
    let tilt = 0.3 * rigid.slenderness_angle();
    let quarter_period = 0.25 * rigid.period(tilt)?;
    println!("c_S, m/s   upright after, s   other side, % of the tilt   energy balance");
    println!("   rigid{quarter_period:19.4}{:28.1}", 100.0 * rigid.next_peak(tilt)? / tilt);
    for speed in [800.0, 400.0, 200.0, 100.0] {
        let block =
            RigidBlock::new(BLOCK_WIDTH, BLOCK_HEIGHT, 2500.0)?.with_p_delta(STANDARD_GRAVITY)?;
        let soil = Soil::from_shear_wave_speed(speed, 0.3, 2000.0)?;
        let mut simulation = Simulation::builder(TIME_STEP)
            .ground(ElasticGround::under(soil, &block, 24)?)
            .structure(block)
            .interface(Coulomb::new(1.0)?)
            // The contact pressure is zero at t = 0, when the block stands on its left edge.
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
