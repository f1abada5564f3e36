//! Mass at a node.

use super::element::{Element, MassKind};
use crate::error::{Result, not_negative, positive};
use crate::geometry::{Direction, FRAME, TRANSLATIONS};

/// Mass at a node, with or without rotary inertia.
///
/// ```
/// use basemat::fem::{Element, LumpedMass, MassKind};
///
/// let floor = LumpedMass::new(0, 100.0)?.with_rotary_inertia(40.0)?;
/// let mut mass = vec![0.0; 9];
/// floor.mass(&[[0.0, 3.0]], MassKind::Consistent, &mut mass);
/// assert_eq!(mass, [100.0, 0.0, 0.0, 0.0, 100.0, 0.0, 0.0, 0.0, 40.0]);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct LumpedMass {
    node: [usize; 1],
    mass: f64,
    rotary_inertia: f64,
}

impl LumpedMass {
    /// Point mass (kg per metre of thickness) at `node`; it makes no rotation unknown.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the mass is positive.
    pub fn new(node: usize, mass: f64) -> Result<Self> {
        Ok(Self { node: [node], mass: positive("lumped mass", mass)?, rotary_inertia: 0.0 })
    }

    /// The same mass with rotary inertia about the node, kg m² per metre of thickness. Above
    /// zero, the node gets a rotation unknown, which other elements should hold.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless it is finite and not negative.
    pub fn with_rotary_inertia(self, rotary_inertia: f64) -> Result<Self> {
        let rotary_inertia = not_negative("rotary inertia of the lumped mass", rotary_inertia)?;
        Ok(Self { rotary_inertia, ..self })
    }
}

impl Element for LumpedMass {
    fn nodes(&self) -> &[usize] {
        &self.node
    }

    fn directions(&self) -> &[Direction] {
        if self.rotary_inertia > 0.0 { FRAME } else { TRANSLATIONS }
    }

    /// None.
    fn stiffness(&self, _coordinates: &[[f64; 2]], _matrix: &mut [f64]) {}

    fn mass(&self, _coordinates: &[[f64; 2]], _kind: MassKind, matrix: &mut [f64]) {
        let diagonal = [self.mass, self.mass, self.rotary_inertia];
        let next = self.order() + 1;
        for (entry, value) in matrix.iter_mut().step_by(next).zip(diagonal) {
            *entry += value;
        }
    }
}
