//! GOAL: a ground of one's own.
//! SCENE: independent springs under a block that slides.
//! REFERENCE: `SpringGround`.

use basemat::bem::{ContactElement, Ground, SpringGround, Strip};
use basemat::interface::Coulomb;
use basemat::{Observer, Result};

use super::scene::{assert_same_motion, run, shaken};
use basemat_problems::block_on_springs::block;

/// Springs that know nothing of the crate's own bed.
pub(crate) struct Bed {
    pub(crate) elements: Vec<ContactElement>,
    pub(crate) stiffness: [f64; 2],
    pub(crate) displacement: Vec<f64>,
}

impl Bed {
    /// Midpoint rule of traction = k s: ½k (s₀ + s₁) = traction.
    fn stiffness(&self, i: usize) -> f64 {
        self.stiffness[usize::from(i >= self.elements.len())]
    }

    fn diagonal(&self, matrix: &mut [f64], factor: f64) {
        let size = self.displacement.len();
        matrix.fill(0.0);
        for i in 0..size {
            matrix[i * size + i] = factor / self.stiffness(i);
        }
    }
}

impl Ground for Bed {
    fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    fn prepare(&mut self, _: f64, _: Option<usize>, _: &mut Observer<'_>) -> Result<()> {
        self.displacement.fill(0.0);
        Ok(())
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.diagonal(matrix, 2.0);
        Ok(())
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        for (out, s) in displacement.iter_mut().zip(&self.displacement) {
            *out = -s;
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
        self.diagonal(matrix, 1.0);
        Ok(())
    }
}

#[test]
fn own_ground() {
    let elements = Strip::uniform(-2.0..2.0, 4).unwrap().elements();
    let own = Bed { elements, stiffness: [4.0e7, 2.0e7], displacement: vec![0.0; 8] };
    let scene = || shaken().structure(block()).interface(Coulomb::new(0.4).unwrap());
    let (_, own) = run(scene().ground(own));
    let (_, crate_bed) =
        run(scene().ground(SpringGround::new(-2.0..2.0, 4, 4.0e7, 2.0e7).unwrap()));
    assert_same_motion(&own, &crate_bed, 1e-7);
}
