//! A ground without memory, with any compliance matrix, whose motion in the next step is given.

use std::sync::{Arc, Mutex};

use basemat::bem::{ContactElement, Ground};
use basemat::{Observer, Result};

/// A ground without memory: its answer to tractions is a matrix, and its motion in the next step is given. Both have normal
/// components (down) first, then components along x, in plan also along y.
pub struct Prescribed {
    elements: Vec<ContactElement>,
    matrix: Vec<f64>,
    motion: Arc<Mutex<Vec<f64>>>,
}

impl Prescribed {
    /// A ground at rest, and its motion in the next step, to be set.
    pub fn new(elements: Vec<ContactElement>, matrix: Vec<f64>) -> (Self, Arc<Mutex<Vec<f64>>>) {
        let motion = Arc::new(Mutex::new(vec![0.0; matrix.len().isqrt()]));
        (Self { elements, matrix, motion: Arc::clone(&motion) }, motion)
    }
}

impl Ground for Prescribed {
    fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    fn prepare(&mut self, _: f64, _: Option<usize>, _: &mut Observer<'_>) -> Result<()> {
        Ok(())
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        matrix.copy_from_slice(&self.matrix);
        Ok(())
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        displacement.copy_from_slice(&self.motion.lock().unwrap());
        Ok(())
    }

    fn commit(&mut self, _: &[f64]) {}

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.step_compliance(matrix)
    }
}
