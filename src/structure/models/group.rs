//! Several structures on one ground.

use crate::error::{CheckpointError, Error, Result, finite};
use crate::structure::detached::numbers;
use crate::structure::nonlinear::{is_nonlinear, restore_variables, save_variables};
use crate::structure::probe::Probe;
use crate::structure::{
    ContactNode, DofCombination, InternalEnergy, NonlinearForce, Structure, Triplets,
};

/// A structure of the group and where it stands.
struct Member {
    structure: Box<dyn Structure>,
    /// Added to the coordinates of its contact nodes, m.
    shift: f64,
    first_dof: usize,
    dofs: usize,
    /// Coordinates of its contact nodes in the group, left and right, and their number.
    span: [f64; 2],
    nodes: usize,
}

/// Structures side by side, each on foundations of its own, that feel each other through the soil.
///
/// To the simulation they are one structure with several foundations; the ground needs a strip
/// under each. [`State::foundations`](crate::coupled::State::foundations) has forces and motions of
/// each by itself.
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
/// assert_eq!(group.row(1, RigidBlock::HORIZONTAL)?[..], [(3, 1.0)]);
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

    /// Adds `structure`, moved to the right by `shift` (m), to the right of all members so far.
    ///
    /// # Errors
    /// [`Error::Input`] for a shift that is not finite, or a base that begins to the left of where the
    /// one before ends; [`Error::Size`] for a structure without contact nodes, [`Error::Scene`] for one
    /// with faces.
    pub fn with(mut self, structure: impl Structure + 'static, shift: f64) -> Result<Self> {
        finite("shift of a structure", shift)?;
        if !structure.contact_faces().is_empty() {
            let needed = "must have a base of contact nodes in the plane, not of faces in plan";
            return Err(Error::Scene { quantity: "structure of a group", needed });
        }
        let nodes = structure.contact_nodes();
        let (Some(left), Some(right)) = (nodes.first(), nodes.last()) else {
            let quantity = "list of contact nodes";
            return Err(Error::Size { quantity, found: 0, needed: 2 });
        };
        let span = [left.x + shift, right.x + shift];
        let end = self.members.last().map_or(f64::NEG_INFINITY, |before| before.span[1]);
        if span[0].partial_cmp(&end) != Some(std::cmp::Ordering::Greater) {
            return Err(Error::Input {
                quantity: "left end of the base of a structure",
                value: span[0],
                needed: "to the right of the structure before it",
            });
        }
        self.members.push(Member {
            shift,
            first_dof: self.dofs(),
            dofs: structure.dofs(),
            span,
            nodes: nodes.len(),
            structure: Box::new(structure),
        });
        Ok(self)
    }

    /// Number of structures.
    pub(crate) fn len(&self) -> usize {
        self.members.len()
    }

    /// A weighted sum of the degrees of freedom of structure `member` (0: the leftmost) in those of the group.
    ///
    /// # Errors
    /// [`Error::Index`] for a structure that is not there, or a degree of freedom that it does not have;
    /// [`Error::Input`] for a weight that is not finite.
    pub fn row(&self, member: usize, row: impl Into<DofCombination>) -> Result<DofCombination> {
        let (bound, row) = (self.members.len(), row.into());
        let quantity = "structure of the group";
        let own = self.members.get(member);
        let own = own.ok_or(Error::Index { quantity, index: member, bound })?;
        row.check("degree of freedom of a structure of the group", own.dofs)?;
        Ok(row.map_dofs(|index| own.first_dof.saturating_add(index)))
    }

    /// A probe of structure `member` as one of the group, with its name and unit; section resultants
    /// too.
    ///
    /// # Errors
    /// [`Error::Probe`] with the reason of [`StructureGroup::row`].
    pub fn probe(&self, member: usize, probe: Probe) -> Result<Probe> {
        probe.try_map_rows(|row| self.row(member, row))
    }

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

    /// The nonlinear forces, each with its member.
    fn forces(&self) -> impl Iterator<Item = (&Member, &dyn NonlinearForce)> {
        self.members.iter().filter_map(|member| Some((member, member.structure.nonlinear()?)))
    }
}

impl Member {
    fn range(&self) -> std::ops::Range<usize> {
        self.first_dof..self.first_dof.saturating_add(self.dofs)
    }
}

impl Structure for StructureGroup {
    fn dofs(&self) -> usize {
        self.members.last().map_or(0, |last| last.range().end)
    }

    fn contact_nodes(&self) -> Vec<ContactNode> {
        let mut all = Vec::new();
        for member in &self.members {
            for mut node in member.structure.contact_nodes() {
                node.x += member.shift;
                // An index that is no degree of freedom of the member must not be one of the group.
                let place = |index: usize| {
                    let own = index < member.dofs;
                    if own { index.saturating_add(member.first_dof) } else { usize::MAX }
                };
                node.horizontal = node.horizontal.map_dofs(place);
                node.vertical = node.vertical.map_dofs(place);
                all.push(node);
            }
        }
        all
    }

    fn foundation_ends(&self) -> Vec<usize> {
        let (mut ends, mut nodes) = (Vec::new(), 0);
        for member in &self.members {
            let own = member.structure.foundation_ends();
            ends.extend(own.iter().map(|end| end.saturating_add(nodes)));
            nodes += member.nodes;
            ends.push(nodes - 1);
        }
        ends.pop();
        ends
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        self.write(matrix, Structure::mass)
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.write(matrix, Structure::stiffness)
    }

    fn damping(&self, matrix: &mut Triplets) -> Result<()> {
        self.write(matrix, Structure::damping)
    }

    /// Those that none of the members describes by numbers of the group.
    fn describe(&self, dofs: &[usize]) -> Option<String> {
        let mut texts = Vec::new();
        for (k, member) in self.members.iter().enumerate() {
            let range = member.range();
            let all: Vec<usize> = dofs.iter().copied().filter(|u| range.contains(u)).collect();
            if !all.is_empty() {
                let own: Vec<usize> = all.iter().map(|u| u - range.start).collect();
                let text = member.structure.describe(&own).unwrap_or_else(|| numbers(&all));
                texts.push(format!("structure {k}: {text}"));
            }
        }
        (!texts.is_empty()).then(|| texts.join("; "))
    }

    /// If that of a member is.
    fn has_active_damping(&self) -> bool {
        self.members.iter().any(|member| member.structure.has_active_damping())
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
        // A member that shows its force by one of the two methods only: so does the group.
        let consistent =
            self.members.iter_mut().all(|m| is_nonlinear(m.structure.as_mut()).is_ok());
        (shown == consistent).then_some(self)
    }
}

impl NonlinearForce for StructureGroup {
    fn force(&self, displacement: &[f64], force: &mut [f64]) -> Result<()> {
        for (member, own) in self.forces() {
            let range = member.range();
            if let (Some(u), Some(f)) = (displacement.get(range.clone()), force.get_mut(range)) {
                own.force(u, f)?;
            }
        }
        Ok(())
    }

    fn tangent(&self, displacement: &[f64], matrix: &mut Triplets) -> Result<()> {
        for (member, own) in self.forces() {
            if let Some(u) = displacement.get(member.range()) {
                matrix.block(member.first_dof, member.dofs, |block| own.tangent(u, block))?;
            }
        }
        Ok(())
    }

    /// Known if all nonlinear members know theirs.
    fn energy(&self, displacement: &[f64]) -> Option<InternalEnergy> {
        self.forces().try_fold(InternalEnergy::default(), |sum, (member, own)| {
            Some(sum + own.energy(displacement.get(member.range())?)?)
        })
    }

    fn commit(&mut self, displacement: &[f64]) {
        for member in &mut self.members {
            let own = displacement.get(member.range());
            if let (Some(u), Some(force)) = (own, member.structure.nonlinear_mut()) {
                force.commit(u);
            }
        }
    }

    fn save(&self) -> Result<Vec<f64>> {
        let mut all = Vec::new();
        for member in &self.members {
            let own = save_variables(member.structure.as_ref())?;
            all.push(own.len() as f64);
            all.extend(own);
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
            let (own, after) = after.split_at(length);
            parts.push(own);
            rest = after;
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
