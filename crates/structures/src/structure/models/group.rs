//! Group of structures on one ground, coupled through the soil.

use std::mem::discriminant;
use std::ops::Range;

use crate::error::{Error, Result, finite, in_bounds, require, require_part};
use crate::geometry::{Edge, span};
use crate::structure::detached::dof_list_text;
use crate::structure::nonlinear::check_nonlinear_force;
use crate::structure::probe::Probe;
use crate::structure::{
    Base, BaseNode, DofCombination, NonlinearForce, Structure, StructureDescription, Triplets,
};

/// A structure of the group, and its base in the group.
pub(super) struct Member {
    pub(super) structure: Box<dyn Structure>,
    /// Base in coordinates and degrees of freedom of the group.
    ///
    /// It has no lines for a structure above others.
    base: Base,
    /// Shift to the right and upwards, m.
    pub(super) offset: [f64; 2],
    /// Index of its first degree of freedom in the group.
    pub(super) first_dof: usize,
    /// Number of its degrees of freedom.
    pub(super) dof_count: usize,
}

/// Several structures on foundations of their own, coupled through the soil.
///
/// The simulation treats them as one structure with several foundations. The ground needs a strip under each
/// foundation, or a mat in space. `State::foundations` has forces and motions of each foundation.
///
/// ```
/// use basemat::bem::ElasticGround;
/// use basemat::interface::Coulomb;
/// use basemat::motion::el_centro_1940;
/// use basemat::structure::{RigidBlock, StructureGroup};
/// use basemat::{Simulation, Soil};
///
/// // A block 4 m wide with its middle at 0, and one 3 m wide with its middle at 6 m.
/// let group = StructureGroup::new()
///     .with(RigidBlock::new(4.0, 8.0, 1500.0)?, 0.0)?
///     .with(RigidBlock::new(3.0, 4.0, 1500.0)?, 6.0)?;
/// assert_eq!(group.row(1, RigidBlock::HORIZONTAL_DOF)?[..], [(3, 1.0)]);
/// // The first block has no fourth degree of freedom: degree of freedom 3 of the group belongs to the other block.
/// assert!(group.row(0, 3).is_err());
/// let mut simulation = Simulation::builder(0.005)
///     .ground(ElasticGround::under(Soil::new(40.0e6, 0.33, 1800.0)?, &group, 6)?)
///     .structure(group)
///     .interface(Coulomb::new(0.5)?)
///     .motion(el_centro_1940())
///     .build()?;
/// let run = simulation.run(400, |_| {})?;
/// let [tall_block, low_block] = &simulation.state().foundations[..] else { unreachable!() };
/// assert_eq!((tall_block.elements.clone(), low_block.elements.clone()), (0..6, 6..12));
/// assert!(run.energy_error < 1e-9 && tall_block.base_rotation != low_block.base_rotation);
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// Bodies in space may have any positions with at least one empty cell of the ground between them:
/// ```
/// use basemat::bem::SpringGround;
/// use basemat::structure::{Base, RigidBody, Structure, StructureGroup};
///
/// let tank = RigidBody::cylinder(4.0, 6.0, 1000.0)?;
/// let pump = RigidBody::cuboid([3.0, 2.0, 2.0], 2400.0)?.centered_at([2.0, 7.0])?;
/// let group = StructureGroup::new().with(tank, 0.0)?.with(pump, 0.0)?;
/// assert_eq!(group.dofs(), 12);
/// assert!(matches!(group.base(), Base::Faces(faces) if faces.len() == 2));
/// let ground = SpringGround::under(&group, 12, 4e7, 3e7)?;
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Default)]
pub struct StructureGroup {
    pub(super) members: Vec<Member>,
}

short_debug! { StructureGroup; self; structures: self.len(), dofs: self.dofs() }

impl StructureGroup {
    /// Group without members.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds `structure`, shifted to the right by `shift` (m).
    ///
    /// In the plane its base must lie to the right of all present members. In space its base may have any position that
    /// does not touch them; the structure determines its position along y, see
    /// [`RigidBody::centered_at`](crate::structure::RigidBody::centered_at).
    ///
    /// # Errors
    /// [`Error::Input`] for a shift that is not finite, or a base that begins to the left of the end of the
    /// previous base; [`Error::Size`] for a base without nodes; [`Error::Scene`] for a mixture of structures in
    /// the plane and in space, and for a base that touches another one in space.
    pub fn with(mut self, structure: impl Structure + 'static, shift: f64) -> Result<Self> {
        finite("shift of a structure", shift)?;
        let mut member = Member {
            base: structure.base(),
            offset: [shift, 0.0],
            first_dof: self.dofs(),
            dof_count: structure.dofs(),
            structure: Box::new(structure),
        };
        let member_dofs = member.dof_range();
        for node in member.base.nodes_mut() {
            node.x += shift;
            node.map_rows(|row| group_row(row, &member_dofs));
        }
        self.check_new_base(&member.base)?;
        self.members.push(member);
        Ok(self)
    }

    /// Returns an error for a base that the group cannot have.
    ///
    /// Such a base has no nodes, is of another kind, or touches another one.
    fn check_new_base(&self, base: &Base) -> Result<()> {
        let Some(left_node) = base.nodes().next() else {
            let quantity = "list of contact nodes";
            return Err(Error::Size { quantity, found: 0, needed: 2 });
        };
        let mut other_bases = self.members.iter().map(|member| &member.base);
        if other_bases.clone().any(|other| discriminant(other) != discriminant(base)) {
            let needed = "must be one in the plane as the others, or one in space as the others";
            return Err(Error::Scene { quantity: "structure of a group", needed });
        }
        match base {
            Base::Lines(_) => {
                let right_end = other_bases
                    .flat_map(Base::nodes)
                    .last()
                    .map_or(f64::NEG_INFINITY, |node| node.x);
                let quantity = "left end of the base of a structure";
                let needed = "to the right of the previous structure";
                require(quantity, left_node.x, left_node.x > right_end, needed).map(drop)
            }
            Base::Faces(faces) => {
                let touches_face =
                    |other: &Vec<BaseNode>| faces.iter().any(|face| !are_apart(face, other));
                let needed =
                    "must have a base apart from the other bases: two of them touch or overlap";
                if other_bases.any(|other| other.parts().iter().any(touches_face)) {
                    return Err(Error::Scene { quantity: "structure of a group", needed });
                }
                Ok(())
            }
        }
    }

    /// Adds a `structure` that stands on other members and touches no ground.
    ///
    /// `offset`: shift to the right and upwards, m. Joints (`basemat::coupled::Joint`) connect the structure to the other
    /// members; [`contact_nodes`](StructureGroup::contact_nodes) converts their nodes. Its own base is not part of the
    /// group's base.
    ///
    /// # Errors
    /// [`Error::Input`] for an offset that is not finite, [`Error::Scene`] for a structure in space.
    pub fn with_above(
        mut self,
        structure: impl Structure + 'static,
        offset: [f64; 2],
    ) -> Result<Self> {
        finite("shift of a structure", offset[0])?;
        finite("height of a structure above the ground", offset[1])?;
        let is_in_plane = matches!(structure.base(), Base::Lines(_));
        let needed = "must be in the plane to stand on others";
        require_part("structure of a group", is_in_plane, needed)?;
        self.members.push(Member {
            base: Base::Lines(Vec::new()),
            offset,
            first_dof: self.dofs(),
            dof_count: structure.dofs(),
            structure: Box::new(structure),
        });
        Ok(self)
    }

    /// Converts contact nodes of structure `member` to coordinates and degrees of freedom of the group.
    ///
    /// Members count from 0, the first one added.
    ///
    /// ```
    /// use basemat::structure::{RigidBlock, StructureGroup};
    ///
    /// let block = RigidBlock::new(2.0, 1.0, 2000.0)?;
    /// let top = block.contact_nodes(&[[-1.0, 1.0], [1.0, 1.0]])?;
    /// let group = StructureGroup::new().with(block.clone(), 3.0)?.with_above(block, [3.0, 1.0])?;
    /// let nodes = group.contact_nodes(0, top)?;
    /// assert_eq!([nodes[0].x, nodes[0].z], [2.0, 1.0]);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Index`] for a structure or a degree of freedom that does not exist; [`Error::Input`] for a weight
    /// that is not finite.
    pub fn contact_nodes(&self, member: usize, mut nodes: Vec<BaseNode>) -> Result<Vec<BaseNode>> {
        let index = in_bounds("structure of the group", member, self.len())?;
        let [shift, height] = self.members[index].offset;
        for node in &mut nodes {
            node.horizontal = self.row(member, node.horizontal.clone())?;
            node.across = self.row(member, node.across.clone())?;
            node.vertical = self.row(member, node.vertical.clone())?;
            node.x += shift;
            node.z += height;
        }
        Ok(nodes)
    }

    /// Number of structures.
    pub(crate) fn len(&self) -> usize {
        self.members.len()
    }

    /// Structure `member` with its present internal variables, counted from 0, the first one added.
    ///
    /// A downcast of it to its type gives access to its results, such as
    /// [`FemModel::solid_points`](crate::structure::FemModel::solid_points).
    ///
    /// # Errors
    /// [`Error::Index`] for a structure that does not exist.
    pub fn structure(&self, member: usize) -> Result<&dyn Structure> {
        let index = in_bounds("structure of the group", member, self.len())?;
        Ok(self.members[index].structure.as_ref())
    }

    /// Converts a weighted sum of degrees of freedom of structure `member` to the group's.
    ///
    /// Members count from 0, the first one added.
    ///
    /// # Errors
    /// [`Error::Index`] for a structure or a degree of freedom that does not exist; [`Error::Input`] for a weight
    /// that is not finite.
    pub fn row(&self, member: usize, row: impl Into<DofCombination>) -> Result<DofCombination> {
        let member_row = row.into();
        let Member { first_dof, dof_count, .. } =
            self.members[in_bounds("structure of the group", member, self.len())?];
        member_row.check("degree of freedom of a structure of the group", dof_count)?;
        Ok(member_row.map_dofs(|dof| first_dof.saturating_add(dof)))
    }

    /// Converts a probe of structure `member` to a probe of the group.
    ///
    /// Name and unit stay. Section resultants are converted too.
    ///
    /// # Errors
    /// [`Error::Item`] with the reason of [`StructureGroup::row`].
    pub fn probe(&self, member: usize, probe: Probe) -> Result<Probe> {
        probe.try_map_rows(|row| self.row(member, row))
    }

    /// Adds a matrix of every member, by `add_member`, at its degrees of freedom.
    fn add_matrices(
        &self,
        matrix: &mut Triplets,
        add_member: impl Fn(&dyn Structure, &mut Triplets) -> Result<()>,
    ) -> Result<()> {
        self.members.iter().try_for_each(|member| {
            matrix.block(member.first_dof, member.dof_count, |block| {
                add_member(member.structure.as_ref(), block)
            })
        })
    }

    /// Members with a nonlinear force, and these forces.
    pub(super) fn nonlinear_members(&self) -> impl Iterator<Item = (&Member, &dyn NonlinearForce)> {
        self.members
            .iter()
            .filter_map(|member| Some((member, member.structure.nonlinear()?)))
    }
}

impl Member {
    /// Range of its degrees of freedom in the group.
    pub(super) fn dof_range(&self) -> Range<usize> {
        self.first_dof..self.first_dof.saturating_add(self.dof_count)
    }
}

/// Converts a sum of a member's degrees of freedom to degrees of freedom of the group.
///
/// `member_dofs`: degrees of freedom of the member in the group. An index out of their range is also out of the group's
/// range afterwards.
fn group_row(row: &DofCombination, member_dofs: &Range<usize>) -> DofCombination {
    row.map_dofs(|dof| {
        if dof < member_dofs.len() {
            member_dofs.start.saturating_add(dof)
        } else {
            usize::MAX
        }
    })
}

/// Whether there is a gap between two convex polygons.
///
/// There is a gap if, along the normal of some edge, one polygon ends before the other begins.
fn are_apart(first: &[BaseNode], second: &[BaseNode]) -> bool {
    let first_corners: Vec<[f64; 2]> = first.iter().map(BaseNode::place).collect();
    let second_corners: Vec<[f64; 2]> = second.iter().map(BaseNode::place).collect();
    Edge::all(&first_corners).chain(Edge::all(&second_corners)).any(|edge| {
        let first_range = span(first_corners.iter().map(|corner| edge.outward(*corner)));
        let second_range = span(second_corners.iter().map(|corner| edge.outward(*corner)));
        first_range[1] < second_range[0] || second_range[1] < first_range[0]
    })
}

impl Structure for StructureGroup {
    fn dofs(&self) -> usize {
        self.members.last().map_or(0, |last| last.dof_range().end)
    }

    fn base(&self) -> Base {
        let parts = self.members.iter().flat_map(|member| member.base.parts()).cloned().collect();
        match self.members.first().map(|member| &member.base) {
            Some(Base::Faces(_)) => Base::Faces(parts),
            Some(Base::Lines(_)) | None => Base::Lines(parts),
        }
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        self.add_matrices(matrix, Structure::mass)
    }

    fn mass_at_rest(&self) -> Result<Option<Vec<f64>>> {
        self.mass_of_soil_at_rest()
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.add_matrices(matrix, Structure::stiffness)
    }

    fn geometric_stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.add_matrices(matrix, Structure::geometric_stiffness)
    }

    fn damping(&self, matrix: &mut Triplets) -> Result<()> {
        self.add_matrices(matrix, Structure::damping)
    }

    /// Texts of all members with such degrees of freedom, joined.
    ///
    /// Degrees of freedom without a text of their member appear with their indices in the group.
    fn describe(&self, dofs: &[usize]) -> Option<String> {
        let mut texts = Vec::new();
        for (index, member) in self.members.iter().enumerate() {
            let range = member.dof_range();
            let group_dofs: Vec<usize> =
                dofs.iter().copied().filter(|dof| range.contains(dof)).collect();
            if !group_dofs.is_empty() {
                let member_dofs: Vec<usize> =
                    group_dofs.iter().map(|dof| dof - range.start).collect();
                let description = member.structure.describe(&member_dofs);
                let text = description.unwrap_or_else(|| dof_list_text(&group_dofs));
                texts.push(format!("structure {index}: {text}"));
            }
        }
        (!texts.is_empty()).then(|| texts.join("; "))
    }

    /// Whether the damping of a member is active.
    fn has_active_damping(&self) -> bool {
        self.members.iter().any(|member| member.structure.has_active_damping())
    }

    /// Whether the stiffness of a member is active.
    fn has_active_stiffness(&self) -> bool {
        self.members.iter().any(|member| member.structure.has_active_stiffness())
    }

    fn description(&self) -> StructureDescription {
        let descriptions = self
            .members
            .iter()
            .map(|member| member.structure.description().shifted(member.offset[0]));
        descriptions.reduce(StructureDescription::combined).unwrap_or_default()
    }

    fn load(&self, time: f64, load: &mut [f64]) -> Result<()> {
        for member in &self.members {
            if let Some(member_load) = load.get_mut(member.dof_range()) {
                member.structure.load(time, member_load)?;
            }
        }
        Ok(())
    }

    fn nonlinear(&self) -> Option<&dyn NonlinearForce> {
        self.nonlinear_members().next().is_some().then_some(self)
    }

    fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce> {
        let has_force = self.nonlinear().is_some();
        // If a member returns its force by only one of the two methods, so does the group.
        let is_consistent =
            self.members.iter_mut().all(|m| check_nonlinear_force(m.structure.as_mut()).is_ok());
        (has_force == is_consistent).then_some(self)
    }
}
