//! Bar with two nodes and axial force only.

use super::element::{Element, MassKind, add_square};
use super::line::Line;
use crate::error::{Result, not_negative, positive};
use crate::geometry::{Direction, TRANSLATIONS};

/// Straight bar between two nodes, hinged at both.
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
    /// Axial force for P–Δ, N.
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
        Ok(Self { nodes, young_modulus, area, density, compression: 0.0 })
    }
}

impl Element for Truss {
    fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    fn directions(&self) -> &[Direction] {
        TRANSLATIONS
    }

    fn stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        if let Some(line) = Line::between(coordinates) {
            line.add_axial(self.young_modulus * self.area / line.length, matrix);
        }
    }

    fn geometric_stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        if let Some(line) = Line::between(coordinates).filter(|_| self.compression != 0.0) {
            line.add_sway(self.compression, matrix);
        }
    }

    fn in_static_state(
        &self,
        coordinates: &[[f64; 3]],
        displacement: &[f64],
        _gravity: f64,
    ) -> Option<Box<dyn Element>> {
        let (Some(line), &[x0, y0, x1, y1]) = (Line::between(coordinates), displacement) else {
            return None;
        };
        let lengthening = line.lengthening([x0, y0], [x1, y1]);
        let compression = -self.young_modulus * self.area / line.length * lengthening;
        Some(Box::new(Self { compression, ..self.clone() }))
    }

    fn compression(&self) -> Option<f64> {
        Some(self.compression)
    }

    fn mass(&self, coordinates: &[[f64; 3]], kind: MassKind, matrix: &mut [f64]) {
        let Some(line) = Line::between(coordinates) else { return };
        let mass = self.density * self.area * line.length;
        // Points of the bar move linearly between the ends, in both directions.
        let (own, other) = match kind {
            MassKind::Consistent => (mass / 3.0, mass / 6.0),
            MassKind::Lumped => (mass / 2.0, 0.0),
        };
        let block = [
            [own, 0.0, other, 0.0],
            [0.0, own, 0.0, other],
            [other, 0.0, own, 0.0],
            [0.0, other, 0.0, own],
        ];
        add_square(matrix, &block);
    }

    /// [`Error::Input`](crate::Error::Input) when the two nodes coincide.
    fn check(&self, coordinates: &[[f64; 3]]) -> Result<()> {
        Line::check("length of the truss", coordinates)
    }
}
