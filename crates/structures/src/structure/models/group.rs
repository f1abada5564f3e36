//! Group of structures on one ground, coupled through the soil.

use std::mem::discriminant;
use std::ops::Range;

use crate::error::{CheckpointError, Error, Result, finite, in_bounds, require};
use crate::geometry::{Edge, span};
use crate::structure::detached::numbers;
use crate::structure::nonlinear::{is_nonlinear, restore_variables, save_variables};
use crate::structure::probe::Probe;
use crate::structure::{
    Base, BaseNode, DofCombination, InternalEnergy, NonlinearForce, Structure,
    StructureDescription, Triplets,
};

/// A structure of the group and where it stands.
struct Member {
    structure: Box<dyn Structure>,
    /// Base in coordinates and degrees of freedom of the group.
    base: Base,
    first_dof: usize,
    dofs: usize,
}

/// Several structures on foundations of their own, coupled through the soil.
///
/// The simulation treats them as one structure with several foundations; the ground needs a strip under each, or
/// in plan a mat. `State::foundations` has forces and motions of each
/// foundation.
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
/// // The first block has no fourth degree of freedom: that is one of the other block.
/// assert!(group.row(0, 3).is_err());
/// let mut simulation = Simulation::builder(0.005)
///     .ground(ElasticGround::under(Soil::new(40.0e6, 0.33, 1800.0)?, &group, 6)?)
///     .structure(group)
///     .interface(Coulomb::new(0.5)?)
///     .motion(el_centro_1940())
///     .build()?;
/// let run = simulation.run(400, |_| {})?;
/// let [high, low] = &simulation.state().foundations[..] else { unreachable!() };
/// assert_eq!((high.elements.clone(), low.elements.clone()), (0..6, 6..12));
/// assert!(run.energy_error < 1e-9 && high.base_rotation != low.base_rotation);
/// # Ok::<(), basemat::Error>(())
/// ```
///
/// In plan bodies stand anywhere, with an empty cell of the ground between them at least:
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
    members: Vec<Member>,
}

short_debug! { StructureGroup; self; structures: self.len(), dofs: self.dofs() }

impl StructureGroup {
    /// Group without members.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds `structure`, moved to the right by `shift` (m).
    ///
    /// In the plane its base must lie to the right of all members so far. In plan it may stand anywhere beside
    /// them; its place along y is set by the structure, see
    /// [`RigidBody::centered_at`](crate::structure::RigidBody::centered_at).
    ///
    /// # Errors
    /// [`Error::Input`] for a shift that is not finite, or a base that begins to the left of the end of the
    /// previous base; [`Error::Size`] for a base without nodes; [`Error::Scene`] for a mixture of structures in
    /// the plane and in plan, and for a base that touches another in plan.
    pub fn with(mut self, structure: impl Structure + 'static, shift: f64) -> Result<Self> {
        finite("shift of a structure", shift)?;
        let mut member = Member {
            base: structure.base(),
            first_dof: self.dofs(),
            dofs: structure.dofs(),
            structure: Box::new(structure),
        };
        let member_dofs = member.range();
        for node in member.base.nodes_mut() {
            node.x += shift;
            node.map_rows(|row| moved(row, &member_dofs));
        }
        self.check_place(&member.base)?;
        self.members.push(member);
        Ok(self)
    }

    /// Error for a base without nodes, a base of another kind than all others, or a place taken by another base.
    fn check_place(&self, base: &Base) -> Result<()> {
        let Some(left) = base.nodes().next() else {
            let quantity = "list of contact nodes";
            return Err(Error::Size { quantity, found: 0, needed: 2 });
        };
        let others = self.members.iter().map(|member| &member.base);
        match base {
            _ if others.clone().any(|other| discriminant(other) != discriminant(base)) => {
                let needed = "must be one in the plane as the others are, or in plan as they are";
                Err(Error::Scene { quantity: "structure of a group", needed })
            }
            Base::Lines(_) => {
                let end =
                    others.flat_map(Base::nodes).last().map_or(f64::NEG_INFINITY, |last| last.x);
                let needed = "to the right of the structure before it";
                require("left end of the base of a structure", left.x, left.x > end, needed)
                    .map(drop)
            }
            Base::Faces(faces) => {
                let touches =
                    |other: &Vec<BaseNode>| faces.iter().any(|face| !are_apart(face, other));
                if others.flat_map(Base::parts).any(touches) {
                    let needed =
                        "must have a base apart from those before it: these touch or overlap";
                    return Err(Error::Scene { quantity: "structure of a group", needed });
                }
                Ok(())
            }
        }
    }

    /// Number of structures.
    pub(crate) fn len(&self) -> usize {
        self.members.len()
    }

    /// Expresses a weighted sum of degrees of freedom of structure `member` in the group's.
    ///
    /// Members count from 0, the first one added.
    ///
    /// # Errors
    /// [`Error::Index`] for a structure or a degree of freedom that does not exist; [`Error::Input`] for a weight
    /// that is not finite.
    pub fn row(&self, member: usize, row: impl Into<DofCombination>) -> Result<DofCombination> {
        let row = row.into();
        let member = &self.members[in_bounds("structure of the group", member, self.len())?];
        row.check("degree of freedom of a structure of the group", member.dofs)?;
        Ok(row.map_dofs(|index| member.first_dof.saturating_add(index)))
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

    /// Adds a matrix of every member at its degrees of freedom.
    fn write(
        &self,
        matrix: &mut Triplets,
        write: impl Fn(&dyn Structure, &mut Triplets) -> Result<()>,
    ) -> Result<()> {
        self.members.iter().try_for_each(|member| {
            matrix.block(member.first_dof, member.dofs, |block| {
                write(member.structure.as_ref(), block)
            })
        })
    }

    /// The nonlinear forces of the members that have one, each with its member.
    fn forces(&self) -> impl Iterator<Item = (&Member, &dyn NonlinearForce)> {
        self.members
            .iter()
            .filter_map(|member| Some((member, member.structure.nonlinear()?)))
    }
}

impl Member {
    fn range(&self) -> Range<usize> {
        self.first_dof..self.first_dof.saturating_add(self.dofs)
    }
}

/// A row of a member in degrees of freedom of the group, of which the member has `member_dofs`.
///
/// An index that is not a degree of freedom of the member becomes an index beyond all degrees of freedom of the
/// group.
fn moved(row: &DofCombination, member_dofs: &Range<usize>) -> DofCombination {
    row.map_dofs(|k| {
        if k < member_dofs.len() { member_dofs.start.saturating_add(k) } else { usize::MAX }
    })
}

/// Coordinate to the right of the first node of a base, m.
fn first_place(base: &Base) -> f64 {
    base.nodes().next().map_or(0.0, |node| node.x)
}

/// Whether there is a gap between two convex polygons.
///
/// There is one if in the direction of some edge's normal one polygon ends before the other begins.
fn are_apart(one: &[BaseNode], other: &[BaseNode]) -> bool {
    let one: Vec<[f64; 2]> = one.iter().map(BaseNode::place).collect();
    let other: Vec<[f64; 2]> = other.iter().map(BaseNode::place).collect();
    Edge::all(&one).chain(Edge::all(&other)).any(|edge| {
        let one_range = span(one.iter().map(|corner| edge.outward(*corner)));
        let other_range = span(other.iter().map(|corner| edge.outward(*corner)));
        one_range[1] < other_range[0] || other_range[1] < one_range[0]
    })
}

impl Structure for StructureGroup {
    fn dofs(&self) -> usize {
        self.members.last().map_or(0, |last| last.range().end)
    }

    fn base(&self) -> Base {
        let parts = self.members.iter().flat_map(|member| member.base.parts()).cloned().collect();
        match self.members.first().map(|member| &member.base) {
            Some(Base::Faces(_)) => Base::Faces(parts),
            Some(Base::Lines(_)) | None => Base::Lines(parts),
        }
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        self.write(matrix, Structure::mass)
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.write(matrix, Structure::stiffness)
    }

    fn geometric_stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.write(matrix, Structure::geometric_stiffness)
    }

    fn damping(&self, matrix: &mut Triplets) -> Result<()> {
        self.write(matrix, Structure::damping)
    }

    /// Descriptions by the members.
    ///
    /// Degrees of freedom that a member does not describe appear with their numbers in the group.
    fn describe(&self, dofs: &[usize]) -> Option<String> {
        let mut texts = Vec::new();
        for (k, member) in self.members.iter().enumerate() {
            let range = member.range();
            let all: Vec<usize> = dofs.iter().copied().filter(|u| range.contains(u)).collect();
            if !all.is_empty() {
                let member_dofs: Vec<usize> = all.iter().map(|u| u - range.start).collect();
                let text = member.structure.describe(&member_dofs);
                let text = text.unwrap_or_else(|| numbers(&all));
                texts.push(format!("structure {k}: {text}"));
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
        let descriptions = self.members.iter().map(|member| {
            let shift = first_place(&member.base) - first_place(&member.structure.base());
            member.structure.description().moved(shift)
        });
        descriptions.reduce(StructureDescription::joined).unwrap_or_default()
    }

    fn load(&self, time: f64, load: &mut [f64]) -> Result<()> {
        for member in &self.members {
            if let Some(load) = load.get_mut(member.range()) {
                member.structure.load(time, load)?;
            }
        }
        Ok(())
    }

    fn nonlinear(&self) -> Option<&dyn NonlinearForce> {
        self.forces().next().is_some().then_some(self)
    }

    fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce> {
        let shown = self.nonlinear().is_some();
        // If a member returns its force by only one of the two methods, so does the group.
        let consistent =
            self.members.iter_mut().all(|m| is_nonlinear(m.structure.as_mut()).is_ok());
        (shown == consistent).then_some(self)
    }
}

impl NonlinearForce for StructureGroup {
    fn force(&self, displacement: &[f64], force: &mut [f64]) -> Result<()> {
        for (member, law) in self.forces() {
            let range = member.range();
            if let (Some(u), Some(f)) = (displacement.get(range.clone()), force.get_mut(range)) {
                law.force(u, f)?;
            }
        }
        Ok(())
    }

    fn tangent(&self, displacement: &[f64], matrix: &mut Triplets) -> Result<()> {
        for (member, law) in self.forces() {
            if let Some(u) = displacement.get(member.range()) {
                matrix.block(member.first_dof, member.dofs, |block| law.tangent(u, block))?;
            }
        }
        Ok(())
    }

    /// Energies of all members; `None` unless all nonlinear members return theirs.
    fn energy(&self, displacement: &[f64]) -> Option<InternalEnergy> {
        self.forces().try_fold(InternalEnergy::default(), |sum, (member, law)| {
            Some(sum + law.energy(displacement.get(member.range())?)?)
        })
    }

    fn commit(&mut self, displacement: &[f64]) {
        for member in &mut self.members {
            let u = displacement.get(member.range());
            if let (Some(u), Some(law)) = (u, member.structure.nonlinear_mut()) {
                law.commit(u);
            }
        }
    }

    fn save(&self) -> Result<Vec<f64>> {
        let mut all = Vec::new();
        for member in &self.members {
            let variables = save_variables(member.structure.as_ref())?;
            all.push(variables.len() as f64);
            all.extend(variables);
        }
        Ok(all)
    }

    fn restore(&mut self, values: &[f64]) -> Result<()> {
        let corrupt = || CheckpointError::Corrupt { quantity: "state of the structures" };
        let mut rest = values;
        let mut parts = Vec::with_capacity(self.members.len());
        for _ in &self.members {
            let (&count, after) = rest.split_first().ok_or_else(corrupt)?;
            let length = (0..=after.len()).find(|n| *n as f64 == count).ok_or_else(corrupt)?;
            parts.push(&after[..length]);
            rest = &after[length..];
        }
        if !rest.is_empty() {
            return Err(corrupt().into());
        }
        let before = self.members.iter().map(|member| save_variables(member.structure.as_ref()));
        let before = before.collect::<Result<Vec<_>>>()?;
        for k in 0..parts.len() {
            if let Err(error) = restore_variables(self.members[k].structure.as_mut(), parts[k]) {
                for (member, before) in self.members[..k].iter_mut().zip(&before) {
                    restore_variables(member.structure.as_mut(), before)?;
                }
                return Err(error);
            }
        }
        Ok(())
    }
}
