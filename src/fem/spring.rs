//! Spring between two nodes.

use super::element::{Element, MassKind, add_square};
use super::line::Line;
use crate::error::{Result, positive};
use crate::geometry::Direction;

/// Linear spring between two nodes.
///
/// Along the line between its nodes, or in one given direction. In the latter case the nodes
/// should lie on that direction's line or at the same place: otherwise a rigid rotation of both
/// meets a force, or the pair of forces leaves a moment.
///
/// ```
/// use basemat::fem::{Direction, Element, Spring};
///
/// let spring = Spring::new([0, 1], Direction::X, 5.0)?;
/// let mut matrix = vec![0.0; 4];
/// spring.stiffness(&[[0.0, 0.0], [0.0, 0.0]], &mut matrix);
/// assert_eq!(matrix, [5.0, -5.0, -5.0, 5.0]);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Spring {
    nodes: [usize; 2],
    directions: Vec<Direction>,
    coefficient: f64,
}

impl Spring {
    /// Spring that sees the relative motion of two nodes in one `direction`; `coefficient` in N/m (N m/rad for rotations) per metre of thickness.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless `coefficient` is positive.
    pub fn new(nodes: [usize; 2], direction: Direction, coefficient: f64) -> Result<Self> {
        let coefficient = positive("coefficient of the spring", coefficient)?;
        Ok(Self { nodes, directions: vec![direction], coefficient })
    }

    /// Spring that sees the change of distance between two nodes; `coefficient` in N/m (N m/rad for rotations) per metre of thickness.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless `coefficient` is positive.
    pub fn axial(nodes: [usize; 2], coefficient: f64) -> Result<Self> {
        let coefficient = positive("coefficient of the spring", coefficient)?;
        Ok(Self { nodes, directions: vec![Direction::X, Direction::Y], coefficient })
    }
}

impl Element for Spring {
    fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    fn directions(&self) -> &[Direction] {
        &self.directions
    }

    fn stiffness(&self, coordinates: &[[f64; 2]], matrix: &mut [f64]) {
        pair(&self.directions, self.coefficient, coordinates, matrix);
    }

    /// None.
    fn mass(&self, _coordinates: &[[f64; 2]], _kind: MassKind, _matrix: &mut [f64]) {}

    /// [`Error::Input`](crate::Error::Input) when the nodes of an axial spring coincide.
    fn check(&self, coordinates: &[[f64; 2]]) -> Result<()> {
        if self.directions.len() == 1 {
            return Ok(());
        }
        Line::check("length of the axial spring", coordinates)
    }
}

/// Adds the matrix of a spring or dashpot: one direction, or along the line when there are two.
pub(super) fn pair(
    directions: &[Direction],
    coefficient: f64,
    coordinates: &[[f64; 2]],
    matrix: &mut [f64],
) {
    if directions.len() == 1 {
        add_square(matrix, &[[coefficient, -coefficient], [-coefficient, coefficient]]);
    } else if let Some(line) = Line::between(coordinates) {
        line.add_axial(coefficient, matrix);
    }
}
