//! GOAL: a free field of a user moves a structure.
//! SCENE: a wave that passes under a block.
//! REFERENCE: the rotation of the base.

use basemat::Simulation;
use basemat::interface::Coulomb;
use basemat::motion::FreeField;

use super::scene::{CompletedRun, TIME_STEP, complete_run};
use basemat_problems::block_on_springs::{bed, block};

/// A wave that runs along the surface and moves the elements one after the other.
pub(crate) struct PassingWave {
    pub(crate) speed: f64,
}

impl PassingWave {
    /// Time since the wave has arrived, s.
    fn time_since_arrival(&self, x: f64, time: f64) -> f64 {
        time - (x + 10.0) / self.speed
    }
}

impl FreeField for PassingWave {
    fn displacement(&self, x: f64, time: f64) -> [f64; 2] {
        let time_since_arrival = self.time_since_arrival(x, time);
        if time_since_arrival > 0.0 {
            let angle = 6.0 * time_since_arrival;
            [0.01 * (1.0 - angle.cos()), 0.004 * (angle - angle.sin())]
        } else {
            [0.0; 2]
        }
    }

    fn velocity(&self, x: f64, time: f64) -> [f64; 2] {
        let time_since_arrival = self.time_since_arrival(x, time);
        if time_since_arrival > 0.0 {
            let angle = 6.0 * time_since_arrival;
            [0.06 * angle.sin(), 0.024 * (1.0 - angle.cos())]
        } else {
            [0.0; 2]
        }
    }
}

#[test]
fn a_wave_of_a_user_turns_the_base() {
    let scene = Simulation::builder(TIME_STEP).gravity(9.81).motion(PassingWave { speed: 100.0 });
    let law = Coulomb::new(0.4).unwrap();
    let CompletedRun { run, .. } =
        complete_run(scene.structure(block()).ground(bed(8)).interface(law));
    assert!(run.whole.base_rotation.largest().value != 0.0, "a wave that passes turns the base");
}
