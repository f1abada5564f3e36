//! Viscous dashpot between two nodes.

use super::element::{Element, MassKind};
use super::line::Line;
use super::spring::pair;
use crate::error::{Result, positive};
use crate::geometry::Direction;

/// Linear viscous dashpot between two nodes.
///
/// Along the line between its nodes, or in one given direction. In the latter case the nodes
/// should lie on that direction's line or at the same place: otherwise a rigid rotation of both
/// meets a force, or the pair of forces leaves a moment.
///
/// ```
/// use basemat::fem::{Direction, Element, Dashpot};
///
/// let dashpot = Dashpot::new([0, 1], Direction::X, 5.0)?;
/// let mut matrix = vec![0.0; 4];
/// dashpot.damping(&[[0.0, 0.0], [0.0, 0.0]], &mut matrix);
/// assert_eq!(matrix, [5.0, -5.0, -5.0, 5.0]);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Dashpot {
    nodes: [usize; 2],
    directions: Vec<Direction>,
    coefficient: f64,
}

impl Dashpot {
    /// Dashpot that sees the relative motion of two nodes in one `direction`; `coefficient` in N s/m (N m s/rad for rotations) per metre of thickness.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless `coefficient` is positive.
    pub fn new(nodes: [usize; 2], direction: Direction, coefficient: f64) -> Result<Self> {
        let coefficient = positive("coefficient of the dashpot", coefficient)?;
        Ok(Self { nodes, directions: vec![direction], coefficient })
    }

    /// Dashpot that sees the change of distance between two nodes; `coefficient` in N s/m (N m s/rad for rotations) per metre of thickness.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless `coefficient` is positive.
    pub fn axial(nodes: [usize; 2], coefficient: f64) -> Result<Self> {
        let coefficient = positive("coefficient of the dashpot", coefficient)?;
        Ok(Self { nodes, directions: vec![Direction::X, Direction::Y], coefficient })
    }
}

impl Element for Dashpot {
    fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    fn directions(&self) -> &[Direction] {
        &self.directions
    }

    /// None.
    fn stiffness(&self, _coordinates: &[[f64; 2]], _matrix: &mut [f64]) {}

    /// None.
    fn mass(&self, _coordinates: &[[f64; 2]], _kind: MassKind, _matrix: &mut [f64]) {}

    fn damping(&self, coordinates: &[[f64; 2]], matrix: &mut [f64]) {
        pair(&self.directions, self.coefficient, coordinates, matrix);
    }

    /// [`Error::Input`](crate::Error::Input) when the nodes of an axial dashpot coincide.
    fn check(&self, coordinates: &[[f64; 2]]) -> Result<()> {
        if self.directions.len() == 1 {
            return Ok(());
        }
        Line::check("length of the axial dashpot", coordinates)
    }
}
