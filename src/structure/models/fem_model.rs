//! Structure made of finite elements.

use super::dof_names::describe;
use super::rigid_links::RigidLinks;
use crate::error::{Error, Result, at_least, in_bounds, positive, require, require_part};
use crate::fem::{Direction, MassKind, MatrixKind, Mesh, Numbering, assemble};
use crate::structure::{Base, BaseNode, DofCombination, RayleighDamping, Structure, Triplets};

/// Finite-element structure on a flat base.
///
/// Degrees of freedom are numbered node by node, within a node x, y, rotation, as far as an element there has
/// them; [`row`](FemModel::row) returns the degree of freedom of a node. Default: consistent mass, no Rayleigh
/// damping.
///
/// Elements act on each other through common nodes. A part without a node in common with the part on the ground
/// must be tied to it by rigid links or [springs](crate::structure::WithSprings). Otherwise `build` returns
/// [`StructureError::Detached`](crate::structure::StructureError::Detached), which names the nodes, and nodes at the same place that were not merged.
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
/// // There is nothing 200 m up.
/// assert!(model.mesh().node_at(0.0, 200.0).is_err());
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct FemModel {
    pub(super) mesh: Mesh,
    pub(super) numbering: Numbering,
    pub(super) links: Option<RigidLinks>,
    /// Nodes of the mesh that touch the ground, in the order of the nodes of `base`.
    feet: Vec<usize>,
    base: Base,
    pub(super) mass_kind: MassKind,
    pub(super) damping: RayleighDamping,
    active_damping: bool,
    active_stiffness: bool,
    /// Acceleration of gravity for the axial forces of P–Δ.
    pub(super) p_delta: Option<f64>,
}

impl FemModel {
    /// Structure that touches the ground with the nodes `contact`, from left to right.
    ///
    /// # Errors
    /// [`Error::Size`] for fewer than two contact nodes, [`Error::Index`] for a node that does not exist,
    /// [`Error::Input`] when the nodes do not run to the right at one height, [`Error::Scene`] when no element
    /// displaces one of them, or for a mesh in space.
    pub fn new(mesh: Mesh, contact: &[usize]) -> Result<Self> {
        require_part("line of contact nodes", !mesh.has_depth(), "a mesh in the plane")?;
        at_least("contact nodes", contact.len(), 2)?;
        let numbering = Numbering::new(&mesh);
        let mut nodes: Vec<BaseNode> = Vec::with_capacity(contact.len());
        let mut height = None;
        for &index in contact {
            let [x, y, _] = mesh.nodes()[in_bounds("contact node", index, mesh.nodes().len())?];
            let quantity = "y of a contact node";
            let needed = "the height of the others";
            require(quantity, y, (y - *height.get_or_insert(y)).abs() <= mesh.tolerance(), needed)?;
            if let Some(left) = nodes.last() {
                positive("distance between contact nodes", x - left.x)?;
            }
            let dof = |direction| {
                numbering.dof(index, direction).ok_or(Error::Scene {
                    quantity: "contact node",
                    needed: "must have horizontal and vertical degrees of freedom from some element",
                })
            };
            nodes.push(BaseNode::free(x, dof(Direction::X)?, dof(Direction::Y)?));
        }
        Ok(Self {
            mesh,
            numbering,
            links: None,
            feet: contact.to_vec(),
            base: nodes.into(),
            mass_kind: MassKind::default(),
            damping: RayleighDamping::default(),
            active_damping: false,
            active_stiffness: false,
            p_delta: None,
        })
    }

    /// Structure on separate foundations.
    ///
    /// Each foundation touches the ground with the nodes of one line, from left to right. Between two lines there
    /// is no base.
    ///
    /// ```
    /// use basemat::fem::{Beam, Mesh};
    /// use basemat::structure::{Base, FemModel, Structure};
    ///
    /// // A portal frame on two strips 2 m wide (the example `portal_frame` shakes one).
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
    /// As for [`FemModel::new`], for each line and for all lines in a row; [`Error::Size`] without lines.
    pub fn on_foundations(mesh: Mesh, lines: &[Vec<usize>]) -> Result<Self> {
        for line in lines {
            at_least("contact nodes of a foundation", line.len(), 2)?;
        }
        let whole = Self::new(mesh, &lines.concat())?;
        let mut nodes = whole.base.into_nodes().into_iter();
        let own = lines.iter().map(|line| nodes.by_ref().take(line.len()).collect()).collect();
        Ok(Self { base: Base::Lines(own), ..whole })
    }

    /// Structure that touches the ground with all its lowest nodes.
    ///
    /// # Errors
    /// As for [`FemModel::new`].
    pub fn on_base(mesh: Mesh) -> Result<Self> {
        let contact = mesh.nodes_at_height(mesh.lowest(), mesh.tolerance())?;
        Self::new(mesh, &contact)
    }

    /// Replaces the kind of mass matrix.
    #[must_use]
    pub fn with_mass(self, mass_kind: MassKind) -> Self {
        Self { mass_kind, ..self }
    }

    /// Replaces the Rayleigh damping, which adds to the elements' own damping.
    ///
    /// The geometric stiffness of P–Δ does not contribute to it.
    #[must_use]
    pub fn with_rayleigh(self, damping: RayleighDamping) -> Self {
        Self { damping, ..self }
    }

    /// Allows elements whose damping matrices are unsymmetric or feed energy in
    /// ([`Structure::has_active_damping`]).
    ///
    /// Otherwise `build` returns an error for such an element.
    #[must_use]
    pub fn with_active_damping(self) -> Self {
        Self { active_damping: true, ..self }
    }

    /// Allows elements whose stiffness matrices are unsymmetric ([`Structure::has_active_stiffness`]).
    ///
    /// Otherwise `build` returns an error for such an element.
    #[must_use]
    pub fn with_active_stiffness(self) -> Self {
        Self { active_stiffness: true, ..self }
    }

    /// Connects the nodes `followers` with `leader` so that they move as one rigid body.
    ///
    /// For stiff joints, offsets of beams, a rigid slab or basemat. Followers lose their degrees of freedom, and
    /// the remaining ones are renumbered, node by node: for a follower [`dof`](FemModel::dof) returns `None` and
    /// [`row`](FemModel::row) its motion by the leader's degrees of freedom. Masses and stiffnesses of followers
    /// stay where they are. Contact nodes may follow. The axial forces of [`with_p_delta`](FemModel::with_p_delta)
    /// are computed anew.
    ///
    /// ```
    /// use basemat::fem::{Beam, Direction, Mesh};
    /// use basemat::structure::{FemModel, Structure};
    ///
    /// // A column on the middle of a rigid basemat 4 m wide.
    /// let mut mesh = Mesh::new();
    /// let [left, foot, right] =
    ///     [mesh.add_node(-2.0, 0.0)?, mesh.add_node(0.0, 0.0)?, mesh.add_node(2.0, 0.0)?];
    /// let top = mesh.add_node(0.0, 6.0)?;
    /// for ends in [[left, foot], [foot, right], [foot, top]] {
    ///     mesh.add(Beam::new(ends, 30.0e9, 0.5, 0.01, 2400.0)?)?;
    /// }
    /// let model = FemModel::on_base(mesh)?.with_rigid_link(foot, &[left, right])?;
    /// assert_eq!(model.dofs(), 6);
    /// assert_eq!(model.dof(top, Direction::X), Some(3));
    /// // The right end rises with the foot and by 2 m times its rotation.
    /// assert_eq!(model.row(right, Direction::Y)?[..], [(1, 1.0), (2, 2.0)]);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Index`] for a node that does not exist, [`Error::Scene`] when the leader lacks one of the three
    /// degrees of freedom or follows another node, or a follower leads or follows already; after
    /// [`with_p_delta`](FemModel::with_p_delta) also its errors.
    pub fn with_rigid_link(mut self, leader: usize, followers: &[usize]) -> Result<Self> {
        let links = self.links.take();
        let mut links = links.unwrap_or_else(|| RigidLinks::new(&self.mesh, &self.numbering));
        links.link(&self.mesh, &self.numbering, leader, followers)?;
        let mut linked = Self { links: Some(links), ..self };
        let mut base = linked.base.clone();
        for (node, foot) in base.nodes_mut().zip(&linked.feet) {
            node.horizontal = linked.row(*foot, Direction::X)?;
            node.vertical = linked.row(*foot, Direction::Y)?;
        }
        linked.base = base;
        match linked.p_delta {
            Some(gravity) => linked.with_p_delta(gravity),
            None => Ok(linked),
        }
    }

    /// The nodes and elements.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Index of the degree of freedom of `node` in `direction`.
    ///
    /// `None` for a node without its own, such as a follower of a rigid link. Probes and springs take the node's
    /// [`row`](FemModel::row).
    pub fn dof(&self, node: usize, direction: Direction) -> Option<usize> {
        let dof = self.numbering.dof(node, direction)?;
        self.links.as_ref().map_or(Some(dof), |links| links.remaining(node, dof))
    }

    /// Motion of `node` in `direction` as a weighted sum of degrees of freedom.
    ///
    /// The degree of freedom itself, or for a follower of a rigid link a sum of its leader's degrees of freedom.
    ///
    /// # Errors
    /// [`Error::Index`] for a node that does not exist, [`Error::Part`] for a node that no element moves in this
    /// direction.
    pub fn row(&self, node: usize, direction: Direction) -> Result<DofCombination> {
        in_bounds("node", node, self.mesh.nodes().len())?;
        let dof = self.numbering.dof(node, direction);
        let dof = dof.ok_or_else(|| {
            let reason = format!(
                "it has no degree of freedom in direction {}: no element needs one there",
                direction.word()
            );
            Error::part(format!("node {node}"), reason)
        })?;
        let own = [(dof, 1.0)];
        Ok(self.links.as_ref().map_or(own.into(), |links| links.row(&own).into()))
    }

    /// Values of all degrees of freedom in a unit rigid motion.
    ///
    /// A displacement of 1 m, or a small rotation of 1 rad about `point` (z is zero in the plane). No motion for a
    /// direction that the mesh does not have.
    pub fn rigid_motion(&self, direction: Direction, point: [f64; 3]) -> Vec<f64> {
        let mut motion = vec![0.0; self.dofs()];
        self.fill_rigid_motion(direction, point, &mut motion, |node, own| self.dof(node, own));
        motion
    }

    /// Writes a rigid motion of the mesh, in any numbering of its degrees of freedom.
    pub(super) fn fill_rigid_motion(
        &self,
        direction: Direction,
        point: [f64; 3],
        motion: &mut [f64],
        number: impl Fn(usize, Direction) -> Option<usize>,
    ) {
        if !self.mesh.directions().contains(&direction) {
            return;
        }
        for (node, place) in self.mesh.nodes().iter().enumerate() {
            let arm = [0, 1, 2].map(|axis| place[axis] - point[axis]);
            for &own in self.mesh.directions() {
                if let Some(dof) = number(node, own) {
                    motion[dof] = own.in_rigid_motion(direction, arm);
                }
            }
        }
    }

    /// Adds matrices of all elements, each times its factor, for the remaining degrees of freedom.
    pub(super) fn add(&self, matrix: &mut Triplets, parts: &[(MatrixKind, f64)]) {
        let fill = |matrix: &mut Triplets| {
            for &(quantity, factor) in parts {
                assemble(&self.mesh, &self.numbering, quantity, factor, |_| true, matrix);
            }
        };
        match &self.links {
            None => fill(matrix),
            Some(links) => {
                let mut own = Triplets::new(self.numbering.dofs());
                fill(&mut own);
                links.add_condensed(&own, matrix);
            }
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
        self.add(matrix, &[(MatrixKind::Mass(self.mass_kind), 1.0)]);
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.add(matrix, &[(MatrixKind::Stiffness, 1.0), (MatrixKind::GeometricStiffness, 1.0)]);
        Ok(())
    }

    /// Nodes with their places, and a node at the same place that is not merged with one of them.
    fn describe(&self, dofs: &[usize]) -> Option<String> {
        describe(self.mesh(), &|node, direction| self.dof(node, direction), dofs)
    }

    fn has_active_damping(&self) -> bool {
        self.active_damping
    }

    fn has_active_stiffness(&self) -> bool {
        self.active_stiffness
    }

    fn damping(&self, matrix: &mut Triplets) -> Result<()> {
        let mut parts = vec![
            (MatrixKind::Mass(self.mass_kind), self.damping.mass()),
            (MatrixKind::Stiffness, self.damping.stiffness()),
            (MatrixKind::Damping, 1.0),
        ];
        parts.retain(|(_, factor)| *factor > 0.0);
        self.add(matrix, &parts);
        Ok(())
    }
}
