//! Joints: contact between two lines of nodes of a structure.

use crate::coupled::base::joint_line::JointLine;
use crate::error::{Error, Result, not_negative, require};
use crate::interface::{Bonded, ContactScene, InterfaceLaw, Mode, SharedLaw, check_list};
use crate::structure::BaseNode;

/// Contact between two lines of nodes of a structure.
///
/// Examples are a joint in a wall, a column under a cap, and towers side by side.
///
/// The upper side presses on the lower side as a base presses on the ground: with the same laws, modes and results, in the
/// same search. The nodes are those of the structure's own degrees of freedom, so that any
/// [`Structure`](crate::structure::Structure) can have joints. A part of the structure that touches no ground may stand on
/// another part by joints; it then moves with the ground under that part.
///
/// Both sides are straight and parallel lines, listed in the same sense. The lower side lies on the right-hand side of that
/// sense: below a horizontal joint that is listed from left to right, to the right of a vertical joint that is listed
/// upwards. The elements are parts of the length that both sides share. Positive slip is that of the upper side
/// in the sense of the list.
///
/// * Tractions act between the means of both sides over an element. A rigid body on n equal elements rocks about the
///   middles of the outer elements, at 1 − 1/n of its half width.
/// * The lines have no thickness, and displacements are small: a sliding or rocking body stays opposite its elements. Where
///   weight acts on a body that tilts, the body needs P–Δ
///   ([`RigidBlock::with_carried_weight`](crate::structure::RigidBlock::with_carried_weight)).
/// * Impacts of hard contact follow from the time scheme. [`Midpoint`](crate::coupled::Midpoint) conserves the energy of
///   bodies that strike each other, [`Theta`](crate::coupled::Theta) with θ = 1 makes impacts inelastic, and
///   [`DissipativeMidpoint`](crate::coupled::DissipativeMidpoint) lies between.
///
/// A block slides on another one, which is bonded to the ground:
/// ```
/// use basemat::Simulation;
/// use basemat::bem::SpringGround;
/// use basemat::coupled::{Joint, Theta};
/// use basemat::interface::{Bonded, Coulomb};
/// use basemat::motion::el_centro_1940;
/// use basemat::structure::{RigidBlock, StructureGroup};
///
/// let lower = RigidBlock::new(6.0, 1.0, 2400.0)?;
/// let upper = RigidBlock::new(2.0, 1.0, 2400.0)?;
/// let top = lower.contact_nodes(&[[-3.0, 1.0], [3.0, 1.0]])?;
/// let bottom = upper.contact_nodes(&[[-1.0, 0.0], [1.0, 0.0]])?;
/// let group = StructureGroup::new().with(lower, 0.0)?.with_above(upper, [0.0, 1.0])?;
/// let joint = Joint::between(group.contact_nodes(1, bottom)?, group.contact_nodes(0, top)?, 8)?;
/// let mut simulation = Simulation::builder(0.002)
///     .ground(SpringGround::under(&group, 6, 4e9, 4e9)?)
///     .structure(group)
///     .interface(Bonded)
///     .joint(joint.with_law(Coulomb::new(0.2)?))
///     .motion(el_centro_1940())
///     .scheme(Theta::new(1.0)?)
///     .build()?;
/// let run = simulation.run(2000, |_| {})?;
/// let [joint] = &simulation.state().joints[..] else { unreachable!() };
/// assert!((joint.normal_force - 2.0 * 2400.0 * basemat::motion::STANDARD_GRAVITY).abs() < 1.0);
/// assert!(joint.mean_slip.abs() > 1e-3 && joint.contact_energy > 0.0);
/// assert!(run.energy_error < 1e-9);
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct Joint {
    line: JointLine,
    laws: Vec<Box<dyn InterfaceLaw>>,
}

short_debug! { Joint; self; elements: self.line.elements().len(), laws: self.laws.len(), gap: self.line.gap }

impl Joint {
    /// Bonded joint between two lines of nodes, with equal contact elements.
    ///
    /// `upper` and `lower` list two or more nodes each, with their displacements in the structure's degrees of freedom. A
    /// line that bends needs at least one element for each segment between its nodes.
    ///
    /// # Errors
    /// [`Error::Size`] for fewer than two nodes or no elements; [`Error::Input`] for coordinates that are not finite, and
    /// for lines that are not straight, not parallel, not listed in one sense, or nowhere opposite each other.
    pub fn between(
        upper: Vec<BaseNode>,
        lower: Vec<BaseNode>,
        element_count: usize,
    ) -> Result<Self> {
        let line = JointLine::new(upper, lower, element_count)?;
        Ok(Self { line, laws: vec![Box::new(Bonded)] })
    }

    /// Bonded joint between two lines of nodes, with a contact element around each node of `lower`.
    ///
    /// For a lower side that bends and whose nodes are dense where pressures are large, as below the ends of a foundation on
    /// a box of soil. Elements end in the middle between two nodes. Under quadratic elements, pressures of single elements
    /// alternate as the forces of their nodes do; sums over an edge of an element do not.
    ///
    /// # Errors
    /// As for [`between`](Self::between); [`Error::Memory`] for too many nodes.
    pub fn around_nodes(upper: Vec<BaseNode>, lower: Vec<BaseNode>) -> Result<Self> {
        let line = JointLine::around_lower_nodes(upper, lower)?;
        Ok(Self { line, laws: vec![Box::new(Bonded)] })
    }

    /// Sets one interface law for all elements; default [`Bonded`].
    #[must_use]
    pub fn with_law(self, law: impl InterfaceLaw + 'static) -> Self {
        Self { laws: vec![Box::new(law)], ..self }
    }

    /// Sets an interface law for each element, in the order of the nodes.
    #[must_use]
    pub fn with_laws(self, laws: Vec<Box<dyn InterfaceLaw>>) -> Self {
        Self { laws, ..self }
    }

    /// Sets the gap of the unloaded structure, m: an expansion joint; default zero.
    ///
    /// It needs a law that opens, such as [`Coulomb`](crate::interface::Coulomb).
    ///
    /// # Errors
    /// [`Error::Input`] unless it is finite and not negative.
    pub fn with_gap(mut self, gap: f64) -> Result<Self> {
        self.line.gap = not_negative("gap of a joint", gap)?;
        Ok(self)
    }

    /// The line of the joint.
    pub(crate) fn line(&self) -> &JointLine {
        &self.line
    }

    /// Checks the laws in a scene, and returns one for each element.
    pub(crate) fn element_laws(self, scene: &ContactScene) -> Result<Vec<SharedLaw>> {
        let element_count = self.line.elements().len();
        if self.laws.is_empty() {
            let needed = "one for all elements, or one for each";
            return Err(Error::Scene { quantity: "interface law of a joint", needed });
        }
        check_list(&self.laws, element_count)?;
        // A law that never opens would pull both sides together.
        let can_open = self.laws.iter().all(|law| law.modes().contains(&Mode::Open));
        let is_closed = can_open || self.line.gap == 0.0;
        let needed = "zero with a law that cannot open: `with_law` sets another one";
        require("gap of a joint", self.line.gap, is_closed, needed)?;
        self.laws.iter().try_for_each(|law| law.check(scene))?;
        Ok(SharedLaw::for_each(self.laws, element_count))
    }
}
