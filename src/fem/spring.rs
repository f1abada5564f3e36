//! Springs, dashpots and lumped masses.

use super::element::{Element, MassKind, add_square};
use super::line::Line;
use crate::error::{Result, not_negative, positive};
use crate::geometry::{Direction, FRAME, TRANSLATIONS};

/// Linear spring between two nodes.
///
/// It acts along the line between its nodes, or in one given direction. In the latter case the nodes should
/// lie on a line in that direction or at the same place. Otherwise a rigid rotation of both nodes causes a
/// force, or the pair of forces leaves a moment.
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
pub struct Spring(Pair);

impl Spring {
    /// Spring against the relative motion of two nodes in one `direction`.
    ///
    /// `coefficient` in N/m (N m/rad for rotations) per metre of thickness.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless `coefficient` is positive.
    pub fn new(nodes: [usize; 2], direction: Direction, coefficient: f64) -> Result<Self> {
        positive("coefficient of the spring", coefficient)?;
        Ok(Self(Pair { nodes, direction: Some(direction), coefficient }))
    }

    /// Spring against the change of distance between two nodes.
    ///
    /// `coefficient` in N/m per metre of thickness.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless `coefficient` is positive.
    pub fn axial(nodes: [usize; 2], coefficient: f64) -> Result<Self> {
        positive("coefficient of the spring", coefficient)?;
        Ok(Self(Pair { nodes, direction: None, coefficient }))
    }
}

impl Element for Spring {
    fn nodes(&self) -> &[usize] {
        &self.0.nodes
    }

    fn directions(&self) -> &[Direction] {
        self.0.directions()
    }

    fn stiffness(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        self.0.add(coordinates, matrix);
    }

    /// Adds nothing.
    fn mass(&self, _coordinates: &[[f64; 3]], _kind: MassKind, _matrix: &mut [f64]) {}

    /// [`Error::Input`](crate::Error::Input) when the nodes of an axial spring coincide.
    fn check(&self, coordinates: &[[f64; 3]]) -> Result<()> {
        self.0.check("length of the axial spring", coordinates)
    }
}

/// Two nodes, and the coefficient of the spring or dashpot between them.
#[derive(Debug, Clone, PartialEq)]
struct Pair {
    nodes: [usize; 2],
    /// Direction of the force; `None`: along the line between the nodes.
    direction: Option<Direction>,
    coefficient: f64,
}

impl Pair {
    fn directions(&self) -> &[Direction] {
        self.direction.as_ref().map_or(TRANSLATIONS, std::slice::from_ref)
    }

    /// Adds the 2 × 2 or 4 × 4 matrix of the pair to `matrix`.
    fn add(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        let c = self.coefficient;
        if self.direction.is_some() {
            add_square(matrix, &[[c, -c], [-c, c]]);
        } else if let Some(line) = Line::between(coordinates) {
            line.add_axial(c, matrix);
        }
    }

    /// Error if an axial pair has both nodes at one place.
    fn check(&self, length: &'static str, coordinates: &[[f64; 3]]) -> Result<()> {
        self.direction.map_or_else(|| Line::check(length, coordinates), |_| Ok(()))
    }
}

/// Linear viscous dashpot between two nodes.
///
/// It acts along the line between its nodes, or in one given direction. In the latter case the nodes should
/// lie on a line in that direction or at the same place. Otherwise a rigid rotation of both nodes causes a
/// force, or the pair of forces leaves a moment.
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
pub struct Dashpot(Pair);

impl Dashpot {
    /// Dashpot against the relative velocity of two nodes in one `direction`.
    ///
    /// `coefficient` in N s/m (N m s/rad for rotations) per metre of thickness.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless `coefficient` is positive.
    pub fn new(nodes: [usize; 2], direction: Direction, coefficient: f64) -> Result<Self> {
        positive("coefficient of the dashpot", coefficient)?;
        Ok(Self(Pair { nodes, direction: Some(direction), coefficient }))
    }

    /// Dashpot against the rate of the distance between two nodes.
    ///
    /// `coefficient` in N s/m per metre of thickness.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless `coefficient` is positive.
    pub fn axial(nodes: [usize; 2], coefficient: f64) -> Result<Self> {
        positive("coefficient of the dashpot", coefficient)?;
        Ok(Self(Pair { nodes, direction: None, coefficient }))
    }
}

impl Element for Dashpot {
    fn nodes(&self) -> &[usize] {
        &self.0.nodes
    }

    fn directions(&self) -> &[Direction] {
        self.0.directions()
    }

    /// Adds nothing.
    fn stiffness(&self, _coordinates: &[[f64; 3]], _matrix: &mut [f64]) {}

    /// Adds nothing.
    fn mass(&self, _coordinates: &[[f64; 3]], _kind: MassKind, _matrix: &mut [f64]) {}

    fn damping(&self, coordinates: &[[f64; 3]], matrix: &mut [f64]) {
        self.0.add(coordinates, matrix);
    }

    /// [`Error::Input`](crate::Error::Input) when the nodes of an axial dashpot coincide.
    fn check(&self, coordinates: &[[f64; 3]]) -> Result<()> {
        self.0.check("length of the axial dashpot", coordinates)
    }
}

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
    node: [usize; 1],
    mass: f64,
    rotary_inertia: f64,
}

impl LumpedMass {
    /// Point mass at `node`, kg per metre of thickness; adds no rotation degree of freedom.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless the mass is positive.
    pub fn new(node: usize, mass: f64) -> Result<Self> {
        Ok(Self { node: [node], mass: positive("lumped mass", mass)?, rotary_inertia: 0.0 })
    }

    /// Adds rotary inertia about the node, kg m² per metre of thickness.
    ///
    /// If the rotary inertia is above zero, the node gets a rotation degree of freedom. Other elements should
    /// restrain it.
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

    /// Adds nothing.
    fn stiffness(&self, _coordinates: &[[f64; 3]], _matrix: &mut [f64]) {}

    fn mass(&self, _coordinates: &[[f64; 3]], _kind: MassKind, matrix: &mut [f64]) {
        let diagonal = [self.mass, self.mass, self.rotary_inertia];
        let next = self.order() + 1;
        for (entry, value) in matrix.iter_mut().step_by(next).zip(diagonal) {
            *entry += value;
        }
    }
}
