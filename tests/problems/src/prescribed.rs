//! A ground without history, with any compliance matrix, whose motion in the next step is prescribed.

use std::sync::{Arc, Mutex};

use basemat::bem::{ContactElement, Ground};
use basemat::{Observer, Result};

/// A ground whose step compliance and motion are prescribed.
///
/// Both have normal components (down) first, then components along x, in space also along y.
pub struct PrescribedGround {
    elements: Vec<ContactElement>,
    compliance: Vec<f64>,
    motion: Arc<Mutex<Vec<f64>>>,
}

impl PrescribedGround {
    /// A ground at rest, and its motion in the next step, to be set.
    pub fn new(
        elements: Vec<ContactElement>,
        compliance: Vec<f64>,
    ) -> (Self, Arc<Mutex<Vec<f64>>>) {
        let motion = Arc::new(Mutex::new(vec![0.0; compliance.len().isqrt()]));
        (Self { elements, compliance, motion: Arc::clone(&motion) }, motion)
    }
}

impl Ground for PrescribedGround {
    fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    fn prepare(&mut self, _: f64, _: Option<usize>, _: &mut Observer<'_>) -> Result<()> {
        Ok(())
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        matrix.copy_from_slice(&self.compliance);
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
