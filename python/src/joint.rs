//! Joints: contact between two lines of nodes of a structure.

use basemat::coupled::Joint;
use basemat::interface::InterfaceLaw;
use pyo3::prelude::*;

use crate::array::Count;
use crate::base_node::{PyBaseNode, structure_nodes};
use crate::error::{OrRaise, WithOption};
use crate::interface::law_recipes;
use crate::list_arguments::ListOf;
use crate::recipe::Recipe;

/// Contact between two lines of nodes of a structure in the plane: a joint in a wall, a column under a cap, towers side
/// by side. `between` creates it, and `Simulation` takes it in ``joints``.
///
/// The upper side presses on the lower side as a base presses on the ground: with the same laws, modes and results, in
/// the same search. A part of the structure that touches no ground may stand on another part by joints
/// (``above`` of `StructureGroup`); it then moves with the ground under that part.
///
/// Tractions act between the means of both sides over an element: a rigid body on n equal elements rocks about the middles
/// of the outer elements, at 1 − 1/n of its half width. Displacements are small: bodies stay opposite their elements, and
/// the weight of a body that tilts overturns it only with P–Δ (``p_delta`` and ``carried_weights`` of `RigidBlock`).
/// Impacts of hard contact follow from the time scheme: ``TimeScheme.theta(1.0)`` makes them inelastic, bodies bounce with
/// ``TimeScheme.midpoint()``.
#[pyclass(name = "Joint", module = "basemat", frozen, dict)]
pub(crate) struct PyJoint {
    /// Nodes of the upper and of the lower side.
    sides: [Vec<PyBaseNode>; 2],
    /// Number of equal elements; `None` for elements around the nodes of the lower side.
    element_count: Option<usize>,
    law_object: Option<Py<PyAny>>,
    /// Laws of the elements; none if the joint is bonded.
    laws: Vec<Recipe<dyn InterfaceLaw>>,
    /// Gap of the unloaded structure, m.
    gap: f64,
}

impl PyJoint {
    /// Joint with checked arguments.
    fn checked(
        sides: [&ListOf<'_, PyBaseNode>; 2],
        element_count: Option<usize>,
        law: Option<Bound<'_, PyAny>>,
        gap: f64,
    ) -> PyResult<Self> {
        let laws = law.as_ref().map(law_recipes).transpose()?.unwrap_or_default();
        let sides = sides.map(nodes_of);
        let joint = Self { sides, element_count, law_object: law.map(Bound::unbind), laws, gap };
        // The result is not needed: the call checks the arguments.
        joint.core(None)?;
        Ok(joint)
    }

    /// The joint for a structure with this number of degrees of freedom.
    pub(crate) fn core(&self, dof_count: Option<usize>) -> PyResult<Joint> {
        let [upper, lower] =
            structure_nodes(self.sides.to_vec(), dof_count)?.try_into().unwrap_or_default();
        let laws = self.laws.iter().map(|make| make());
        let laws: Vec<_> = laws.collect::<basemat::Result<_>>().or_raise()?;
        let joint = match self.element_count {
            Some(element_count) => Joint::between(upper, lower, element_count),
            None => Joint::around_nodes(upper, lower),
        };
        let joint = joint.and_then(|joint| joint.with_gap(self.gap));
        let laws = (!laws.is_empty()).then_some(laws);
        joint.with(laws, |joint, laws| Ok(joint.with_laws(laws))).or_raise()
    }
}

/// Nodes of a list of Python.
fn nodes_of(list: &ListOf<'_, PyBaseNode>) -> Vec<PyBaseNode> {
    list.iter().map(|node| node.get().clone()).collect()
}

#[pymethods]
impl PyJoint {
    /// Joint between the lines of nodes ``upper`` and ``lower``, lists of two or more `BaseNode`, with ``count`` equal
    /// contact elements over the length that both lines share.
    ///
    /// The nodes have their places and displacements in the structure of the simulation: ``contact_nodes`` of `RigidBlock`
    /// and `FemModel` make them, ``contact_nodes`` of `StructureGroup` converts those of a member. Both lines are straight and parallel,
    /// listed in the same sense; the lower side lies on the right-hand side of that sense: of a horizontal joint listed from
    /// left to right it is the side below, of a vertical joint listed upwards the side on the right. Positive slip is that
    /// of the upper side in the sense of the list.
    ///
    /// ``law``: an `InterfaceLaw` or an object with the methods of `UserLaw`, one for all elements or a list of one for
    /// each; `Bonded` unless given. ``gap`` (m): gap of the unloaded structure, as of an expansion joint; 0 by default.
    /// It needs a law that opens.
    #[staticmethod]
    #[pyo3(signature = (upper, lower, count, *, law=None, gap=0.0))]
    fn between(
        upper: ListOf<'_, PyBaseNode>,
        lower: ListOf<'_, PyBaseNode>,
        count: Count,
        law: Option<Bound<'_, PyAny>>,
        gap: f64,
    ) -> PyResult<Self> {
        Self::checked([&upper, &lower], Some(count.0), law, gap)
    }

    /// Joint between the lines of nodes ``upper`` and ``lower``, lists of `BaseNode`, with a contact element around each node
    /// of the lower side: for a lower side whose nodes are dense where pressures are large, as below the ends of a foundation on
    /// a box of soil (`NearField`). ``law`` and ``gap`` are as in `between`, and have its defaults unless given.
    #[staticmethod]
    #[pyo3(signature = (upper, lower, *, law=None, gap=0.0))]
    fn around_nodes(
        upper: ListOf<'_, PyBaseNode>,
        lower: ListOf<'_, PyBaseNode>,
        law: Option<Bound<'_, PyAny>>,
        gap: f64,
    ) -> PyResult<Self> {
        Self::checked([&upper, &lower], None, law, gap)
    }

    /// Nodes of the upper side: list of `BaseNode`.
    #[getter]
    fn upper(&self) -> Vec<PyBaseNode> {
        self.sides[0].clone()
    }

    /// Nodes of the lower side: list of `BaseNode`.
    #[getter]
    fn lower(&self) -> Vec<PyBaseNode> {
        self.sides[1].clone()
    }

    /// Number of equal contact elements; None for elements around the nodes of the lower side.
    #[getter]
    fn count(&self) -> Option<usize> {
        self.element_count
    }

    /// The argument ``law``; None for a bonded joint.
    #[getter]
    fn law(&self) -> Option<&Py<PyAny>> {
        self.law_object.as_ref()
    }

    /// Gap of the unloaded structure, m.
    #[getter]
    fn gap(&self) -> f64 {
        self.gap
    }
}
