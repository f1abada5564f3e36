//! Structure made of finite elements.

use super::rayleigh::RayleighDamping;
use super::section::{Section, SectionRows};
use super::{ContactNode, Structure, Triplets};
use crate::error::{Error, Result, finite, positive};
use crate::fem::{
    Direction, MassKind, Mesh, Numbering, Quantity, assemble, assemble_damping, assemble_mass,
    assemble_stiffness,
};

/// Finite-element structure on a flat base.
///
/// Unknowns: those of [`Numbering`], node by node. Mass consistent, no Rayleigh damping, unless
/// set otherwise.
///
/// ```
/// use basemat::fem::{Direction, Layer, Material, Mesh};
/// use basemat::structure::{FemModel, Structure};
///
/// let concrete = Material::new(30.0e9, 0.2, 2400.0)?;
/// let mesh = Mesh::layered_block(-5.0..5.0, 8, &[Layer::new(20.0, 16, concrete)])?;
/// let model = FemModel::on_base(mesh)?;
/// assert_eq!(model.unknowns(), 2 * 9 * 17);
/// assert_eq!(model.contact_nodes().len(), 9);
/// let roof = model.nearest_node(0.0, 20.0);
/// assert_eq!(model.unknown(roof, Direction::X), Some(2 * (16 * 9 + 4)));
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug)]
pub struct FemModel {
    mesh: Mesh,
    numbering: Numbering,
    contact: Vec<ContactNode>,
    mass_kind: MassKind,
    damping: RayleighDamping,
}

impl FemModel {
    /// Structure that touches the ground with the nodes `contact`, from left to right.
    ///
    /// # Errors
    /// [`Error::Size`] for fewer than two contact nodes, [`Error::Index`] for one that does not
    /// exist, [`Error::Input`] when they do not run to the right at one height, [`Error::Scene`]
    /// when one belongs to no element that displaces it.
    pub fn new(mesh: Mesh, contact: &[usize]) -> Result<Self> {
        if contact.len() < 2 {
            let (found, needed) = (contact.len(), 2);
            return Err(Error::Size { quantity: "contact nodes", found, needed });
        }
        let numbering = Numbering::new(&mesh);
        let mut nodes: Vec<ContactNode> = Vec::with_capacity(contact.len());
        let mut height = None;
        for &index in contact {
            let bound = mesh.nodes().len();
            let &[x, y] = mesh.nodes().get(index).ok_or(Error::Index {
                quantity: "contact node",
                index,
                bound,
            })?;
            if (y - *height.get_or_insert(y)).abs() > mesh.tolerance() {
                let needed = "the height of the others";
                return Err(Error::Input { quantity: "y of a contact node", value: y, needed });
            }
            if let Some(left) = nodes.last() {
                positive("distance between contact nodes", x - left.x)?;
            }
            let unknown = |direction| {
                numbering.unknown(index, direction).ok_or(Error::Scene {
                    quantity: "contact node",
                    needed: "must have horizontal and vertical unknowns from some element",
                })
            };
            nodes.push(ContactNode::free(x, unknown(Direction::X)?, unknown(Direction::Y)?));
        }
        Ok(Self {
            mesh,
            numbering,
            contact: nodes,
            mass_kind: MassKind::default(),
            damping: RayleighDamping::default(),
        })
    }

    /// Structure that touches the ground with all its lowest nodes.
    ///
    /// # Errors
    /// As for [`FemModel::new`].
    pub fn on_base(mesh: Mesh) -> Result<Self> {
        let contact = mesh.nodes_at_height(mesh.lowest(), mesh.tolerance())?;
        Self::new(mesh, &contact)
    }

    /// The same structure with another kind of mass matrix.
    #[must_use]
    pub fn with_mass(self, mass_kind: MassKind) -> Self {
        Self { mass_kind, ..self }
    }

    /// The same structure with Rayleigh damping, beside that of its elements.
    #[must_use]
    pub fn with_damping(self, damping: RayleighDamping) -> Self {
        Self { damping, ..self }
    }

    /// The nodes and elements.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Index of the unknown of `node` in `direction`, if there is one.
    pub fn unknown(&self, node: usize, direction: Direction) -> Option<usize> {
        self.numbering.unknown(node, direction)
    }

    /// Node nearest to (`x`, `y`), m; the first one when several are.
    pub fn nearest_node(&self, x: f64, y: f64) -> usize {
        self.mesh.nearest_node(x, y).unwrap_or(0)
    }

    /// Unknowns of a unit rigid motion: 1 m in x or y, or a small rotation of 1 rad about `point`.
    pub fn rigid_motion(&self, direction: Direction, point: [f64; 2]) -> Vec<f64> {
        let mut motion = vec![0.0; self.numbering.unknowns()];
        for (node, [x, y]) in self.mesh.nodes().iter().enumerate() {
            let values = match direction {
                Direction::X => [1.0, 0.0, 0.0],
                Direction::Y => [0.0, 1.0, 0.0],
                Direction::Rotation => [point[1] - y, x - point[0], 1.0],
            };
            for (own, value) in ALL_DIRECTIONS.into_iter().zip(values) {
                if let Some(unknown) = self.numbering.unknown(node, own) {
                    motion[unknown] = value;
                }
            }
        }
        motion
    }

    /// Forces that the part above `height` (m) exerts on the part below, moments about
    /// (`reference`, `height`).
    ///
    /// The nodes at this height are the cut; elements that lie in it count as below. The rows are
    /// −K, −C and −M of the elements above, summed over the nodes of the cut.
    ///
    /// # Errors
    /// [`Error::Input`] when a number is not finite, no node lies at `height`, no element above
    /// it, or an element crosses it.
    pub fn section(&self, height: f64, reference: f64) -> Result<Section> {
        finite("height of the section", height)?;
        finite("reference point of the section", reference)?;
        let tolerance = self.mesh.tolerance();
        let cut = self.mesh.nodes_at_height(height, tolerance)?;
        let sides = |points: &[[f64; 2]]| {
            let above = points.iter().any(|point| point[1] > height + tolerance);
            let below = points.iter().any(|point| point[1] < height - tolerance);
            (above, below)
        };
        let is_above = |points: &[[f64; 2]]| sides(points) == (true, false);
        let fault =
            |needed| Error::Input { quantity: "height of the section", value: height, needed };
        let elements = self.mesh.elements().iter();
        let mut all = elements.map(|element| sides(&self.mesh.coordinates(element.nodes())));
        if all.clone().any(|side| side == (true, true)) {
            return Err(fault("a height that no element crosses"));
        }
        if cut.is_empty() || !all.any(|side| side == (true, false)) {
            return Err(fault("the height of a row of nodes with elements above it"));
        }
        let sum = |quantity, factor: f64| {
            let mut matrix = Triplets::new(self.numbering.unknowns());
            assemble(&self.mesh, &self.numbering, quantity, -factor, is_above, &mut matrix);
            matrix
        };
        let matrices = [
            vec![sum(Quantity::Stiffness, 1.0)],
            vec![sum(Quantity::Stiffness, self.damping.stiffness()), sum(Quantity::Damping, 1.0)],
            vec![sum(Quantity::Mass(self.mass_kind), 1.0)],
        ];
        let rows = |motion: Vec<f64>, sign: f64| {
            let mut weights = vec![0.0; motion.len()];
            for &node in &cut {
                for unknown in ALL_DIRECTIONS.iter().filter_map(|&d| self.unknown(node, d)) {
                    weights[unknown] = sign * motion[unknown];
                }
            }
            let [displacement, velocity, acceleration] =
                [0, 1, 2].map(|order| weighted_rows(&weights, &matrices[order]));
            SectionRows { displacement, velocity, acceleration }
        };
        // The work of the cut's forces on a rigid motion is their resultant.
        let point = [reference, height];
        Ok(Section {
            height,
            shear: rows(self.rigid_motion(Direction::X, point), 1.0),
            compression: rows(self.rigid_motion(Direction::Y, point), -1.0),
            moment: rows(self.rigid_motion(Direction::Rotation, point), 1.0),
        })
    }
}

const ALL_DIRECTIONS: [Direction; 3] = [Direction::X, Direction::Y, Direction::Rotation];

/// wᵀ A for the sum A of `matrices`, zeros left out.
fn weighted_rows(weights: &[f64], matrices: &[Triplets]) -> Vec<(usize, f64)> {
    let mut sums = vec![0.0; weights.len()];
    for &(row, column, value) in matrices.iter().flat_map(Triplets::entries) {
        if let (Some(weight), Some(sum)) = (weights.get(row), sums.get_mut(column)) {
            *sum += weight * value;
        }
    }
    sums.into_iter().enumerate().filter(|&(_, value)| value != 0.0).collect()
}

impl Structure for FemModel {
    fn unknowns(&self) -> usize {
        self.numbering.unknowns()
    }

    fn contact_nodes(&self) -> Vec<ContactNode> {
        self.contact.clone()
    }

    fn mass(&self, matrix: &mut Triplets) {
        assemble_mass(&self.mesh, &self.numbering, self.mass_kind, 1.0, matrix);
    }

    fn stiffness(&self, matrix: &mut Triplets) {
        assemble_stiffness(&self.mesh, &self.numbering, 1.0, matrix);
    }

    fn damping(&self, matrix: &mut Triplets) {
        let (mass, stiffness) = (self.damping.mass(), self.damping.stiffness());
        if mass > 0.0 {
            assemble_mass(&self.mesh, &self.numbering, self.mass_kind, mass, matrix);
        }
        if stiffness > 0.0 {
            assemble_stiffness(&self.mesh, &self.numbering, stiffness, matrix);
        }
        assemble_damping(&self.mesh, &self.numbering, 1.0, matrix);
    }
}
