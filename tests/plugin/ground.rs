//! GOAL: a ground of a user works as one of the crate.
//! SCENE: independent springs under a block that slides.
//! REFERENCE: `SpringGround`.

use basemat::bem::{ContactElement, Ground, SpringGround, Strip};
use basemat::interface::Coulomb;
use basemat::{Observer, Result, Simulation};

use super::scene::{assert_same_motion, complete_run, shaken};
use basemat_problems::block_on_springs::block;

/// Independent springs by the midpoint rule of traction = k s: ½k (s₀ + s₁) = traction.
pub(crate) struct IndependentSprings {
    elements: Vec<ContactElement>,
    /// Normal and tangential stiffness, Pa/m.
    stiffness: [f64; 2],
    displacement: Vec<f64>,
}

impl IndependentSprings {
    pub(crate) fn new(elements: Vec<ContactElement>, stiffness: [f64; 2]) -> Self {
        let displacement = vec![0.0; 2 * elements.len()];
        Self { elements, stiffness, displacement }
    }

    fn stiffness(&self, component: usize) -> f64 {
        self.stiffness[usize::from(component >= self.elements.len())]
    }

    fn fill_diagonal(&self, matrix: &mut [f64], factor: f64) {
        let size = self.displacement.len();
        matrix.fill(0.0);
        for i in 0..size {
            matrix[i * size + i] = factor / self.stiffness(i);
        }
    }
}

impl Ground for IndependentSprings {
    fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    fn prepare(&mut self, _: f64, _: Option<usize>, _: &mut Observer<'_>) -> Result<()> {
        self.displacement.fill(0.0);
        Ok(())
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.fill_diagonal(matrix, 2.0);
        Ok(())
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        for (history, previous) in displacement.iter_mut().zip(&self.displacement) {
            *history = -previous;
        }
        Ok(())
    }

    fn commit(&mut self, traction: &[f64]) {
        assert_eq!(traction.len(), 2 * self.elements.len());
        for (i, traction) in traction.iter().enumerate() {
            self.displacement[i] = 2.0 * traction / self.stiffness(i) - self.displacement[i];
        }
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.fill_diagonal(matrix, 1.0);
        Ok(())
    }
}

/// Motion of a sliding block on this ground.
fn block_on(ground: impl Ground + 'static) -> Simulation {
    let builder = shaken().structure(block()).interface(Coulomb::new(0.4).unwrap());
    complete_run(builder.ground(ground)).simulation
}

#[test]
fn springs_of_a_user_move_as_the_spring_ground() {
    let elements = Strip::uniform(-2.0..2.0, 4).unwrap().elements();
    let computed = block_on(IndependentSprings::new(elements, [4.0e7, 2.0e7]));
    let expected = block_on(SpringGround::new(-2.0..2.0, 4, 4.0e7, 2.0e7).unwrap());
    assert_same_motion(&computed, &expected, 1e-7);
}
