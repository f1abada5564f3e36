//! GOAL: a free field of one's own.
//! SCENE: a wave that passes under a block.
//! REFERENCE: the rotation of the base.

use basemat::Simulation;
use basemat::interface::Coulomb;
use basemat::motion::FreeField;

use super::scene::{STEP, run};
use basemat_problems::block_on_springs::{bed, block};

/// A wave that runs along the surface, so that the elements do not move alike.
pub(crate) struct Passing {
    pub(crate) speed: f64,
}

impl FreeField for Passing {
    fn displacement(&self, x: f64, time: f64) -> [f64; 2] {
        let late = time - (x + 10.0) / self.speed;
        if late > 0.0 {
            let angle = 6.0 * late;
            [0.01 * (1.0 - angle.cos()), 0.004 * (angle - angle.sin())]
        } else {
            [0.0; 2]
        }
    }

    fn velocity(&self, x: f64, time: f64) -> [f64; 2] {
        let late = time - (x + 10.0) / self.speed;
        if late > 0.0 {
            let angle = 6.0 * late;
            [0.06 * angle.sin(), 0.024 * (1.0 - angle.cos())]
        } else {
            [0.0; 2]
        }
    }
}

#[test]
fn own_free_field() {
    let scene = Simulation::builder(STEP).gravity(9.81).motion(Passing { speed: 100.0 });
    let law = Coulomb::new(0.4).unwrap();
    let (run, _) = run(scene.structure(block()).ground(bed(8)).interface(law));
    assert!(run.whole.base_rotation.largest().value != 0.0, "a wave that passes turns the base");
}
