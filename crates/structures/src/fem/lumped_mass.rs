//! Mass at a node.

use super::element::{Element, MassKind};
use crate::error::{Result, not_negative, positive, require_part};
use crate::geometry::{Direction, PLANE_DIRECTIONS, PLANE_TRANSLATIONS, SPACE_DIRECTIONS};

/// Mass at a node, with or without rotary inertia.
///
/// ```
/// use basemat::fem::{Element, LumpedMass, MassKind};
///
/// let floor = LumpedMass::new(0, 100.0)?.with_rotary_inertia(40.0)?;
/// let mut mass = vec![0.0; 9];
/// floor.mass(&[[0.0, 3.0, 0.0]], MassKind::Consistent, &mut mass);
/// assert_eq!(mass, [100.0, 0.0, 0.0, 0.0, 100.0, 0.0, 0.0, 0.0, 40.0]);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct LumpedMass {
    nodes: [usize; 1],
    mass: f64,
    directions: &'static [Direction],
    /// Rotary inertias about the rotation axes in `directions`, kg m²; zero for an axis without rotation.
    rotary_inertia: [f64; 3],
}

impl LumpedMass {
    /// Point mass at `node`, kg per metre of thickness; adds no rotation degree of freedom.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the mass is positive.
    pub fn new(node: usize, mass: f64) -> Result<Self> {
        let mass = positive("lumped mass", mass)?;
        Ok(Self { nodes: [node], mass, directions: PLANE_TRANSLATIONS, rotary_inertia: [0.0; 3] })
    }

    /// Point mass (kg) of a mesh in space, with three rotary inertias.
    ///
    /// `rotary_inertia`: about x, y and z, kg m².
    ///
    /// Without rotary inertia the mass adds no rotation degree of freedom. If any inertia is above zero, the node gets
    /// all three rotations; other elements should restrain the rotations without inertia.
    ///
    /// ```
    /// use basemat::fem::{Element, LumpedMass, MassKind};
    ///
    /// // A slab of 100 t, 6 m × 6 m.
    /// let slab = LumpedMass::in_space(0, 100.0e3, [300.0e3, 300.0e3, 600.0e3])?;
    /// let mut mass = vec![0.0; 36];
    /// slab.mass(&[[0.0, 0.0, 3.0]], MassKind::Consistent, &mut mass);
    /// assert_eq!([mass[14], mass[35]], [100.0e3, 600.0e3]); // u_z and the rotation about z
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the mass is positive and the inertias are finite and not negative.
    pub fn in_space(node: usize, mass: f64, rotary_inertia: [f64; 3]) -> Result<Self> {
        for inertia in rotary_inertia {
            not_negative("rotary inertia of the lumped mass", inertia)?;
        }
        let has_rotary_inertia = rotary_inertia.iter().any(|&inertia| inertia > 0.0);
        let directions = if has_rotary_inertia { SPACE_DIRECTIONS } else { &SPACE_DIRECTIONS[..3] };
        Ok(Self { directions, rotary_inertia, ..Self::new(node, mass)? })
    }

    /// Adds rotary inertia to a mass in the plane.
    ///
    /// `rotary_inertia`: about the node, kg m² per metre of thickness.
    ///
    /// If the rotary inertia is above zero, the node gets a rotation. Other elements should restrain this rotation.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the rotary inertia is finite and not negative.
    /// [`Error::Scene`](crate::Error::Scene) for a mass in space, which has three rotary inertias.
    pub fn with_rotary_inertia(self, rotary_inertia: f64) -> Result<Self> {
        not_negative("rotary inertia of the lumped mass", rotary_inertia)?;
        let requirement = "from LumpedMass::in_space for a mass in space, about three axes";
        let is_plane = !self.directions.contains(&Direction::Z);
        require_part("rotary inertia of the lumped mass", is_plane, requirement)?;
        let directions = if rotary_inertia > 0.0 { PLANE_DIRECTIONS } else { PLANE_TRANSLATIONS };
        Ok(Self { directions, rotary_inertia: [rotary_inertia, 0.0, 0.0], ..self })
    }
}

impl Element for LumpedMass {
    fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    fn with_nodes(&self, nodes: &[usize]) -> Option<Box<dyn Element>> {
        Some(Box::new(Self { nodes: nodes.try_into().ok()?, ..self.clone() }))
    }

    fn directions(&self) -> &[Direction] {
        self.directions
    }

    /// A lumped mass has no stiffness.
    fn stiffness(&self, _coordinates: &[[f64; 3]], _matrix: &mut [f64]) {}

    fn mass(&self, _coordinates: &[[f64; 3]], _kind: MassKind, matrix: &mut [f64]) {
        let translation_count = if self.directions.contains(&Direction::Z) { 3 } else { 2 };
        let diagonal_stride = self.order() + 1;
        let diagonal = std::iter::repeat_n(self.mass, translation_count).chain(self.rotary_inertia);
        for (entry, value) in matrix.iter_mut().step_by(diagonal_stride).zip(diagonal) {
            *entry += value;
        }
    }
}
