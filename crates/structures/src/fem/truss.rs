//! Bar with two nodes and axial force only.

use super::element::{Element, MassKind};
use super::line::ElementLine;
use crate::error::{Result, not_negative, positive};
use crate::geometry::{Direction, PLANE_TRANSLATIONS, SPACE_DIRECTIONS};

/// Straight bar between two nodes, hinged at both, in the plane or [in space](Truss::in_space).
///
/// The P–Δ effect of its axial force is included only if
/// [`FemModel::with_p_delta`](crate::structure::FemModel::with_p_delta) computes the force.
///
/// ```
/// use basemat::fem::{Element, Truss};
///
/// let bar = Truss::new([0, 1], 200.0e9, 1.0e-3, 7800.0)?;
/// let mut stiffness = vec![0.0; 16];
/// bar.stiffness(&[[0.0; 3], [0.0, 2.0, 0.0]], &mut stiffness);
/// assert_eq!(stiffness[5], 1.0e8); // EA/L on the first node's y
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Truss {
    nodes: [usize; 2],
    young_modulus: f64,
    area: f64,
    density: f64,
    directions: &'static [Direction],
    /// Compressive axial force for P–Δ, N.
    compression: f64,
}

impl Truss {
    /// Bar with Young's modulus (Pa), cross-section (m² per metre of thickness) and density
    /// (kg/m³).
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless modulus and area are positive and the density
    /// is not negative.
    pub fn new(nodes: [usize; 2], young_modulus: f64, area: f64, density: f64) -> Result<Self> {
        positive("Young's modulus of the truss", young_modulus)?;
        positive("area of the truss", area)?;
        not_negative("density of the truss", density)?;
        positive("axial stiffness of the truss", young_modulus * area)?;
        let directions = PLANE_TRANSLATIONS;
        Ok(Self { nodes, young_modulus, area, density, directions, compression: 0.0 })
    }

    /// Bar of a mesh in space; as [`Truss::new`], with the whole cross-section (m²).
    ///
    /// # Errors
    /// As for [`Truss::new`].
    pub fn in_space(
        nodes: [usize; 2],
        young_modulus: f64,
        area: f64,
        density: f64,
    ) -> Result<Self> {
        let directions = &SPACE_DIRECTIONS[..3];
        Ok(Self { directions, ..Self::new(nodes, young_modulus, area, density)? })
    }
}

impl Element for Truss {
    fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    fn with_nodes(&self, nodes: &[usize]) -> Option<Box<dyn Element>> {
        Some(Box::new(Self { nodes: nodes.try_into().ok()?, ..self.clone() }))
    }

    fn directions(&self) -> &[Direction] {
        self.directions
    }

    fn stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        if let Some(line) = ElementLine::between(coordinates) {
            let stiffness = self.young_modulus * self.area / line.length;
            line.add_axial(stiffness, self.directions.len(), matrix);
        }
    }

    fn geometric_stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        if let Some(line) = ElementLine::between(coordinates).filter(|_| self.compression != 0.0) {
            line.add_geometric_stiffness(self.compression, self.directions.len(), matrix);
        }
    }

    fn in_static_state(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        _gravity: f64,
    ) -> Option<Box<dyn Element>> {
        let line = ElementLine::between(coordinates)?;
        let (first_end, second_end) = displacement.split_at_checked(self.directions.len())?;
        let elongation = line.elongation(first_end, second_end);
        let compression = -self.young_modulus * self.area / line.length * elongation;
        Some(Box::new(Self { compression, ..self.clone() }))
    }

    fn compression(&self) -> Option<f64> {
        Some(self.compression)
    }

    fn mass(&self, coordinates: &[[f64; 3]], kind: MassKind, matrix: &mut [f64]) {
        let Some(line) = ElementLine::between(coordinates) else {
            return;
        };
        let mass = self.density * self.area * line.length;
        // The displacement varies linearly along the bar, in every direction.
        let is_lumped = kind == MassKind::Lumped;
        let diagonal = if is_lumped { mass / 2.0 } else { mass / 3.0 };
        let coupling = if is_lumped { 0.0 } else { mass / 6.0 };
        let axis_count = self.directions.len();
        let order = 2 * axis_count;
        for (index, entry) in matrix.iter_mut().take(order * order).enumerate() {
            let row = index / order;
            let column = index % order;
            if row == column {
                *entry += diagonal;
            } else if row % axis_count == column % axis_count {
                *entry += coupling;
            }
        }
    }

    /// [`Error::Input`](crate::Error::Input) when the two nodes coincide.
    fn check(&self, coordinates: &[[f64; 3]]) -> Result<()> {
        ElementLine::check_length("length of the truss", coordinates)
    }
}
