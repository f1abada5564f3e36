//! Structure made of finite elements.

use super::dof_names::describe;
use super::feet::{self, Foot};
use super::inelastic_elements::InelasticElements;
use super::rigid_links::RigidLinks;
use crate::error::{Error, Result, in_bounds};
use crate::fem::{Direction, MassKind, MatrixKind, Mesh, Numbering, assemble};
use crate::structure::{
    Base, BaseNode, DofCombination, NonlinearForce, RayleighDamping, Structure,
    StructureDescription, Triplets,
};

/// Finite-element structure on a flat base, in the plane or in space.
///
/// Degrees of freedom are numbered node by node, and at a node in the order of
/// [`Mesh::directions`](crate::fem::Mesh::directions). A node has those directions that one of its elements has;
/// [`row`](FemModel::row) returns the degree of freedom of a node. Default: consistent mass, no Rayleigh damping.
///
/// The forces of elements with internal variables, such as soil that yields, are the model's [`NonlinearForce`];
/// [`solid_points`](FemModel::solid_points) returns their stresses and plastic strains.
///
/// Elements act on each other through common nodes. A part without a common node with the part on the ground must be
/// connected to it by rigid links or [springs](crate::structure::WithSprings). Otherwise `build` returns
/// [`StructureError::Detached`](crate::structure::StructureError::Detached), which names the nodes, and coincident
/// nodes that were not merged.
///
/// ```
/// use basemat::fem::{Direction, Layer, Material, Mesh};
/// use basemat::structure::{FemModel, Structure};
///
/// let concrete = Material::new(30.0e9, 0.2, 2400.0)?;
/// let mesh = Mesh::layered_block(-5.0..5.0, 8, &[Layer::new(20.0, 16, concrete)])?;
/// let model = FemModel::on_base(mesh)?;
/// assert_eq!(model.dofs(), 2 * 9 * 17);
/// assert_eq!(model.base().nodes().count(), 9);
/// let roof = model.mesh().node_at(0.0, 20.0)?;
/// assert_eq!(model.row(roof, Direction::X)?[..], [(2 * (16 * 9 + 4), 1.0)]);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct FemModel {
    pub(super) mesh: Mesh,
    pub(super) numbering: Numbering,
    pub(super) links: Option<RigidLinks>,
    /// Points in contact with the ground, line by line or face by face.
    pub(super) feet: Vec<Vec<Foot>>,
    base: Base,
    pub(super) mass_kind: MassKind,
    pub(super) damping: RayleighDamping,
    has_active_damping: bool,
    has_active_stiffness: bool,
    /// Acceleration of gravity for the static forces of P–Δ, m/s²; `None` without P–Δ.
    pub(super) p_delta_gravity: Option<f64>,
    /// Entries (row, column, value) of the geometric stiffness due to rigid links and to reactions at the base.
    pub(super) link_and_base_stiffness: Vec<(usize, usize, f64)>,
    /// Elements with internal variables; `None` if all are linear.
    pub(super) inelastic: Option<InelasticElements>,
}

impl FemModel {
    /// Structure on the ground with the contact nodes `contact`, from left to right.
    ///
    /// # Errors
    /// [`Error::Size`] for fewer than two contact nodes, [`Error::Index`] for a node that does not exist,
    /// [`Error::Input`] unless the nodes are listed from left to right at one height, [`Error::Scene`] for a node
    /// without horizontal and vertical degrees of freedom, or for a mesh in space.
    pub fn new(mesh: Mesh, contact: &[usize]) -> Result<Self> {
        let feet = feet::line_feet(&mesh, &[contact])?;
        Self::on_feet(mesh, feet)
    }

    /// Structure on feet, which are listed line by line or face by face.
    pub(super) fn on_feet(mesh: Mesh, feet: Vec<Vec<Foot>>) -> Result<Self> {
        let model = Self {
            numbering: Numbering::new(&mesh),
            mesh,
            links: None,
            feet,
            base: Base::Lines(Vec::new()),
            mass_kind: MassKind::default(),
            damping: RayleighDamping::default(),
            has_active_damping: false,
            has_active_stiffness: false,
            p_delta_gravity: None,
            link_and_base_stiffness: Vec::new(),
            inelastic: None,
        };
        Ok(Self {
            base: model.foot_base()?,
            inelastic: model.undeformed_inelastic_elements()?,
            ..model
        })
    }

    /// Base in terms of the present degrees of freedom.
    fn foot_base(&self) -> Result<Base> {
        let parts = self
            .feet
            .iter()
            .map(|feet| feet.iter().map(|foot| self.base_node(*foot)).collect())
            .collect::<Result<Vec<Vec<_>>>>()?;
        Ok(if self.mesh.has_depth() { Base::Faces(parts) } else { Base::Lines(parts) })
    }

    /// Node of the base at a foot.
    fn base_node(&self, foot: Foot) -> Result<BaseNode> {
        let is_in_space = self.mesh.has_depth();
        let missing_dofs = Error::Scene {
            quantity: "contact node",
            needed: if is_in_space {
                "must have three displacements, and rotations on a shell, from some element"
            } else {
                "must have horizontal and vertical degrees of freedom from some element"
            },
        };
        let row = |direction| self.foot_row(foot, direction).map_err(|_| missing_dofs.clone());
        let coordinates = self.mesh.nodes()[foot.node];
        let mut node = BaseNode {
            x: coordinates[0],
            z: foot.height,
            horizontal: row(Direction::X)?,
            vertical: row(self.mesh.up_direction())?,
            ..BaseNode::default()
        };
        if is_in_space {
            node.y = coordinates[1];
            node.z = 0.0;
            node.across = row(Direction::Y)?;
        }
        Ok(node)
    }

    /// Displacement in `direction` of a foot, which is rigidly connected to its node.
    fn foot_row(&self, foot: Foot, direction: Direction) -> Result<DofCombination> {
        let mut row = self.row(foot.node, direction)?;
        for &motion in self.mesh.directions().iter().filter(|motion| motion.is_rotation()) {
            let weight = direction.in_rigid_motion(motion, [0.0, 0.0, -foot.depth]);
            if weight != 0.0 {
                row += weight * self.row(foot.node, motion)?;
            }
        }
        Ok(row)
    }

    /// Structure on separate foundations.
    ///
    /// `lines`: contact nodes of each foundation, from left to right. Between two lines there is no base.
    ///
    /// ```
    /// use basemat::fem::{Beam, Mesh};
    /// use basemat::structure::{Base, FemModel, Structure};
    ///
    /// // A portal frame on two strips 2 m wide (as in the example `portal_frame`).
    /// let mut mesh = Mesh::new();
    /// let mut lines = Vec::new();
    /// let mut tops = Vec::new();
    /// for x in [-4.0, 4.0] {
    ///     let line = [x - 1.0, x, x + 1.0].map(|x| mesh.add_node(x, 0.0));
    ///     let line = line.into_iter().collect::<Result<Vec<_>, _>>()?;
    ///     let top = mesh.add_node(x, 5.0)?;
    ///     for ends in [[line[0], line[1]], [line[1], line[2]], [line[1], top]] {
    ///         mesh.add(Beam::new(ends, 30.0e9, 0.5, 0.01, 2400.0)?)?;
    ///     }
    ///     lines.push(line);
    ///     tops.push(top);
    /// }
    /// mesh.add(Beam::new([tops[0], tops[1]], 30.0e9, 0.5, 0.01, 2400.0)?)?;
    /// let frame = FemModel::on_foundations(mesh, &lines)?;
    /// assert!(matches!(frame.base(), Base::Lines(lines) if lines.len() == 2));
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// As for [`FemModel::new`], for each line and for all lines together; [`Error::Size`] without lines.
    pub fn on_foundations(mesh: Mesh, lines: &[Vec<usize>]) -> Result<Self> {
        let lines: Vec<&[usize]> = lines.iter().map(Vec::as_slice).collect();
        let feet = feet::line_feet(&mesh, &lines)?;
        Self::on_feet(mesh, feet)
    }

    /// Structure in space on the ground with these faces, each of which lists its corner nodes.
    ///
    /// Faces lie at one height and do not overlap, as [`Base::Faces`]. The underside of a shell is in contact with the
    /// ground: a face with the corners of a shell ([`ElementFace::thickness`](crate::fem::ElementFace::thickness))
    /// moves with the points at half the thickness below its nodes. For a face over several shells the thickest one
    /// counts. Other faces move with their nodes, such as the outline of nodes that a rigid link connects.
    ///
    /// # Errors
    /// [`Error::Scene`] for a mesh in the plane, or for a corner without three displacements;
    /// [`Error::Size`] without faces or for fewer than three corners; [`Error::Index`] for a node that does not
    /// exist; [`Error::Input`] for corners at different heights.
    pub fn on_faces(mesh: Mesh, faces: &[Vec<usize>]) -> Result<Self> {
        let feet = feet::face_feet(&mesh, faces)?;
        Self::on_feet(mesh, feet)
    }

    /// Structure on the ground with all its lowest nodes or faces.
    ///
    /// It has contact nodes in the plane, and faces in space. The faces are horizontal shells and sides of solids
    /// ([`Element::faces`](crate::fem::Element::faces)), as for [`FemModel::on_faces`].
    ///
    /// # Errors
    /// As for [`FemModel::new`] and [`FemModel::on_faces`]; [`Error::Scene`] for a mesh in space without a face at its
    /// lowest height.
    pub fn on_base(mesh: Mesh) -> Result<Self> {
        if mesh.has_depth() {
            let feet = feet::lowest_face_feet(&mesh)?;
            return Self::on_feet(mesh, feet);
        }
        let contact = mesh.nodes_at_height(mesh.lowest_height(), mesh.height_tolerance())?;
        Self::new(mesh, &contact)
    }

    /// Replaces the kind of mass matrix.
    #[must_use]
    pub fn with_mass(self, mass_kind: MassKind) -> Self {
        Self { mass_kind, ..self }
    }

    /// Replaces the Rayleigh damping, which adds to the elements' own damping.
    ///
    /// The geometric stiffness of P–Δ does not contribute to it, nor do hinges. Other elements with internal variables
    /// contribute their stiffness of small displacements.
    #[must_use]
    pub fn with_rayleigh(self, damping: RayleighDamping) -> Self {
        Self { damping, ..self }
    }

    /// Allows elements whose damping matrices are unsymmetric or feed energy in ([`Structure::has_active_damping`]).
    ///
    /// Otherwise `build` returns an error for such an element.
    #[must_use]
    pub fn with_active_damping(self) -> Self {
        Self { has_active_damping: true, ..self }
    }

    /// Allows elements whose stiffness matrices are unsymmetric ([`Structure::has_active_stiffness`]).
    ///
    /// Otherwise `build` returns an error for such an element.
    #[must_use]
    pub fn with_active_stiffness(self) -> Self {
        Self { has_active_stiffness: true, ..self }
    }

    /// Nodes and elements of the model.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Height of the surface in the mesh, m.
    #[doc(hidden)]
    pub fn surface_height(&self) -> f64 {
        let foot = self.feet.iter().flatten().next();
        foot.map_or(0.0, |foot| self.mesh.nodes()[foot.node][self.mesh.up_axis()] - foot.height)
    }

    /// The model with other links; its base and the static forces of P–Δ are computed again.
    pub(super) fn with_links(self, links: RigidLinks) -> Result<Self> {
        let linked = Self { links: Some(links), ..self };
        let inelastic = linked.undeformed_inelastic_elements()?;
        let linked = Self { base: linked.foot_base()?, inelastic, ..linked };
        match linked.p_delta_gravity {
            Some(gravity) => linked.with_p_delta(gravity),
            None => Ok(linked),
        }
    }

    /// Index of the degree of freedom of `node` in `direction`.
    ///
    /// `None` for a node without a degree of freedom, such as a follower of a rigid link. Use the node's
    /// [`row`](FemModel::row) for probes and springs.
    pub fn dof(&self, node: usize, direction: Direction) -> Option<usize> {
        let dof = self.numbering.dof(node, direction)?;
        self.links
            .as_ref()
            .map_or(Some(dof), |links| links.remaining_dof(node, direction, dof))
    }

    /// Motion of `node` in `direction` as a weighted sum of degrees of freedom.
    ///
    /// It is the degree of freedom itself, or a sum of the leader's degrees of freedom for a follower of a rigid link.
    ///
    /// # Errors
    /// [`Error::Index`] for a node that does not exist, [`Error::Part`] for a node without a degree of freedom in
    /// this direction.
    pub fn row(&self, node: usize, direction: Direction) -> Result<DofCombination> {
        in_bounds("node", node, self.mesh.nodes().len())?;
        let dof = self.numbering.dof(node, direction).ok_or_else(|| {
            let reason = format!(
                "it has no degree of freedom in direction {direction}: no element needs one there"
            );
            Error::part(format!("node {node}"), reason)
        })?;
        Ok(self.remaining_row(vec![(dof, 1.0)]))
    }

    /// A weighted sum of the mesh's degrees of freedom as a sum of the remaining ones.
    pub(super) fn remaining_row(&self, terms: Vec<(usize, f64)>) -> DofCombination {
        match &self.links {
            Some(links) => links.remaining_terms(&terms).into(),
            None => terms.into(),
        }
    }

    /// Adds matrices of all elements, times their factors, for the remaining degrees of freedom.
    pub(super) fn add_matrices(&self, matrix: &mut Triplets, weighted_kinds: &[(MatrixKind, f64)]) {
        match &self.links {
            None => self.add_elements(matrix, weighted_kinds),
            Some(links) => {
                let mut mesh_matrix = Triplets::new(self.numbering.dofs());
                self.add_elements(&mut mesh_matrix, weighted_kinds);
                links.add_condensed(&mesh_matrix, matrix);
            }
        }
        for (kind, factor) in weighted_kinds {
            if matches!(kind, MatrixKind::GeometricStiffness) {
                let entries = self.link_and_base_stiffness.iter();
                matrix.extend(entries.map(|&(row, column, value)| (row, column, factor * value)));
            }
        }
    }

    /// Adds matrices of all elements, times their factors, for the degrees of freedom of the mesh.
    fn add_elements(&self, matrix: &mut Triplets, weighted_kinds: &[(MatrixKind, f64)]) {
        for &(kind, factor) in weighted_kinds {
            assemble(&self.mesh, &self.numbering, kind, factor, |_| true, matrix);
        }
    }
}

impl Structure for FemModel {
    fn dofs(&self) -> usize {
        self.links.as_ref().map_or(self.numbering.dofs(), RigidLinks::dofs)
    }

    fn base(&self) -> Base {
        self.base.clone()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        self.add_matrices(matrix, &[(MatrixKind::Mass(self.mass_kind), 1.0)]);
        Ok(())
    }

    fn mass_at_rest(&self) -> Result<Option<Vec<f64>>> {
        self.mass_of_soil_at_rest()
    }

    /// Stiffness of the linear elements; the forces of the other elements are the nonlinear force.
    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.add_matrices(
            matrix,
            &[(MatrixKind::LinearStiffness, 1.0), (MatrixKind::GeometricStiffness, 1.0)],
        );
        Ok(())
    }

    fn geometric_stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.add_matrices(matrix, &[(MatrixKind::GeometricStiffness, 1.0)]);
        Ok(())
    }

    /// Text with the nodes, their coordinates, and a coincident node that is not merged.
    fn describe(&self, dofs: &[usize]) -> Option<String> {
        describe(self.mesh(), &|node, direction| self.dof(node, direction), dofs)
    }

    fn has_active_damping(&self) -> bool {
        self.has_active_damping
    }

    fn has_active_stiffness(&self) -> bool {
        self.has_active_stiffness
    }

    fn description(&self) -> StructureDescription {
        let faces_off_ground = feet::uncovered_faces(&self.mesh, &self.feet);
        StructureDescription::for_mesh(&self.mesh, faces_off_ground)
    }

    fn damping(&self, matrix: &mut Triplets) -> Result<()> {
        let mut weighted_kinds = vec![
            (MatrixKind::Mass(self.mass_kind), self.damping.mass()),
            (MatrixKind::DampedStiffness, self.damping.stiffness()),
            (MatrixKind::Damping, 1.0),
        ];
        weighted_kinds.retain(|(_, factor)| *factor > 0.0);
        self.add_matrices(matrix, &weighted_kinds);
        Ok(())
    }

    fn nonlinear(&self) -> Option<&dyn NonlinearForce> {
        self.inelastic.as_ref().map(|force| force as &dyn NonlinearForce)
    }

    fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce> {
        self.inelastic.as_mut().map(|force| force as &mut dyn NonlinearForce)
    }
}
