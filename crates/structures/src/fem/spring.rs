//! Springs and dashpots.

use super::element::{Element, MassKind};
use super::element_matrix::add_matrix;
use super::line::ElementLine;
use crate::error::{Result, positive};
use crate::geometry::{Direction, PLANE_TRANSLATIONS, SPACE_DIRECTIONS};

/// Linear spring between two nodes.
///
/// It acts along the line between its nodes, or in a fixed direction. For a fixed direction the nodes should coincide
/// or lie on a line in that direction. Otherwise the two forces form a couple, and a rigid rotation of both nodes
/// causes a force.
///
/// ```
/// use basemat::fem::{Direction, Element, Spring};
///
/// let spring = Spring::new([0, 1], Direction::X, 5.0)?;
/// let mut matrix = vec![0.0; 4];
/// spring.stiffness(&[[0.0; 3]; 2], &mut matrix);
/// assert_eq!(matrix, [5.0, -5.0, -5.0, 5.0]);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Spring(NodePair);

impl Spring {
    /// Spring against the relative motion of two nodes in one `direction`.
    ///
    /// `coefficient` in N/m (N m/rad for rotations), in the plane per metre of thickness.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless `coefficient` is positive.
    pub fn new(nodes: [usize; 2], direction: Direction, coefficient: f64) -> Result<Self> {
        positive("coefficient of the spring", coefficient)?;
        Ok(Self(NodePair {
            nodes,
            line_of_action: LineOfAction::Direction(direction),
            coefficient,
        }))
    }

    /// Spring against the change of distance between two nodes.
    ///
    /// `coefficient` in N/m per metre of thickness.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless `coefficient` is positive.
    pub fn axial(nodes: [usize; 2], coefficient: f64) -> Result<Self> {
        positive("coefficient of the spring", coefficient)?;
        Ok(Self(NodePair {
            nodes,
            line_of_action: LineOfAction::BetweenNodes(PLANE_TRANSLATIONS),
            coefficient,
        }))
    }

    /// Spring of a mesh in space, against the change of distance between two nodes.
    ///
    /// `coefficient` in N/m.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless `coefficient` is positive.
    pub fn axial_in_space(nodes: [usize; 2], coefficient: f64) -> Result<Self> {
        positive("coefficient of the spring", coefficient)?;
        Ok(Self(NodePair {
            nodes,
            line_of_action: LineOfAction::BetweenNodes(&SPACE_DIRECTIONS[..3]),
            coefficient,
        }))
    }
}

impl Element for Spring {
    fn nodes(&self) -> &[usize] {
        &self.0.nodes
    }

    fn with_nodes(&self, nodes: &[usize]) -> Option<Box<dyn Element>> {
        let nodes = nodes.try_into().ok()?;
        Some(Box::new(Self(NodePair { nodes, ..self.0.clone() })))
    }

    fn directions(&self) -> &[Direction] {
        self.0.directions()
    }

    fn stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        self.0.add_to(coordinates, matrix);
    }

    /// Adds nothing.
    fn mass(&self, _coordinates: &[[f64; 3]], _kind: MassKind, _matrix: &mut [f64]) {}

    /// [`Error::Input`](crate::Error::Input) when the nodes of an axial spring coincide.
    fn check(&self, coordinates: &[[f64; 3]]) -> Result<()> {
        self.0.check("length of the axial spring", coordinates)
    }
}

/// Line along which the force of a pair of nodes acts.
#[derive(Debug, Clone, Copy, PartialEq)]
enum LineOfAction {
    /// A line in one direction.
    Direction(Direction),
    /// The line between the nodes, which have displacements in these directions.
    BetweenNodes(&'static [Direction]),
}

/// Two nodes, and the coefficient of the spring or dashpot between them.
#[derive(Debug, Clone, PartialEq)]
struct NodePair {
    nodes: [usize; 2],
    line_of_action: LineOfAction,
    coefficient: f64,
}

impl NodePair {
    fn directions(&self) -> &[Direction] {
        match &self.line_of_action {
            LineOfAction::Direction(direction) => std::slice::from_ref(direction),
            LineOfAction::BetweenNodes(directions) => directions,
        }
    }

    /// Adds the matrix of the spring or dashpot to `matrix`.
    fn add_to(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        let c = self.coefficient;
        match self.line_of_action {
            LineOfAction::Direction(_) => add_matrix(matrix, &[[c, -c], [-c, c]]),
            LineOfAction::BetweenNodes(directions) => {
                if let Some(line) = ElementLine::between(coordinates) {
                    line.add_axial(c, directions.len(), matrix);
                }
            }
        }
    }

    /// Returns an error if the nodes of an axial pair coincide.
    ///
    /// `length_name`: name of the distance between the nodes in the error.
    fn check(&self, length_name: &'static str, coordinates: &[[f64; 3]]) -> Result<()> {
        match self.line_of_action {
            LineOfAction::Direction(_) => Ok(()),
            LineOfAction::BetweenNodes(_) => ElementLine::check_length(length_name, coordinates),
        }
    }
}

/// Linear viscous dashpot between two nodes.
///
/// It acts along the line between its nodes, or in a fixed direction. For a fixed direction the nodes should coincide
/// or lie on a line in that direction. Otherwise the two forces form a couple, and a rigid rotation of both nodes
/// causes a force.
///
/// ```
/// use basemat::fem::{Direction, Element, Dashpot};
///
/// let dashpot = Dashpot::new([0, 1], Direction::X, 5.0)?;
/// let mut matrix = vec![0.0; 4];
/// dashpot.damping(&[[0.0; 3]; 2], &mut matrix);
/// assert_eq!(matrix, [5.0, -5.0, -5.0, 5.0]);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Dashpot(NodePair);

impl Dashpot {
    /// Dashpot against the relative velocity of two nodes in one `direction`.
    ///
    /// `coefficient` in N s/m (N m s/rad for rotations), in the plane per metre of thickness.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless `coefficient` is positive.
    pub fn new(nodes: [usize; 2], direction: Direction, coefficient: f64) -> Result<Self> {
        positive("coefficient of the dashpot", coefficient)?;
        Ok(Self(NodePair {
            nodes,
            line_of_action: LineOfAction::Direction(direction),
            coefficient,
        }))
    }

    /// Dashpot against the rate of change of the distance between two nodes.
    ///
    /// `coefficient` in N s/m per metre of thickness.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless `coefficient` is positive.
    pub fn axial(nodes: [usize; 2], coefficient: f64) -> Result<Self> {
        positive("coefficient of the dashpot", coefficient)?;
        Ok(Self(NodePair {
            nodes,
            line_of_action: LineOfAction::BetweenNodes(PLANE_TRANSLATIONS),
            coefficient,
        }))
    }

    /// Dashpot of a mesh in space, against the rate of change of a distance.
    ///
    /// It is the distance between two nodes.
    ///
    /// `coefficient` in N s/m.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless `coefficient` is positive.
    pub fn axial_in_space(nodes: [usize; 2], coefficient: f64) -> Result<Self> {
        positive("coefficient of the dashpot", coefficient)?;
        Ok(Self(NodePair {
            nodes,
            line_of_action: LineOfAction::BetweenNodes(&SPACE_DIRECTIONS[..3]),
            coefficient,
        }))
    }
}

impl Element for Dashpot {
    fn nodes(&self) -> &[usize] {
        &self.0.nodes
    }

    fn with_nodes(&self, nodes: &[usize]) -> Option<Box<dyn Element>> {
        let nodes = nodes.try_into().ok()?;
        Some(Box::new(Self(NodePair { nodes, ..self.0.clone() })))
    }

    fn directions(&self) -> &[Direction] {
        self.0.directions()
    }

    /// Adds nothing.
    fn stiffness(&self, _coordinates: &[[f64; 3]], _matrix: &mut [f64]) {}

    /// Adds nothing.
    fn mass(&self, _coordinates: &[[f64; 3]], _kind: MassKind, _matrix: &mut [f64]) {}

    fn damping(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        self.0.add_to(coordinates, matrix);
    }

    /// [`Error::Input`](crate::Error::Input) when the nodes of an axial dashpot coincide.
    fn check(&self, coordinates: &[[f64; 3]]) -> Result<()> {
        self.0.check("length of the axial dashpot", coordinates)
    }
}
