//! Elements with internal variables on the degrees of freedom of another structure.

use super::inelastic_elements::InelasticElements;
use crate::error::{Error, Result, at_least, in_bounds};
use crate::fem::{
    BeamSectionState, Direction, Element, HingeState, MassKind, Mesh, ReadStates, SolidPoint,
    read_hinge, read_points, read_sections,
};
use crate::structure::{
    Base, DofCombination, NonlinearForce, Structure, StructureDescription, Triplets,
};

/// Linear structure with elements that yield, such as beams of fibres.
///
/// The elements are those of a mesh. Each degree of freedom of a node of the mesh is a sum of degrees of freedom of the structure,
/// which may come from another program as a [`MatrixModel`](crate::structure::MatrixModel). The elements add their forces, masses
/// and dampers; their stiffness must not be in the matrix of the structure. Rayleigh damping by their stiffness is not
/// added.
///
/// ```
/// use basemat::fem::{BeamQuadrature, BilinearSteel, Direction, FiberBeam, FiberSection, Mesh};
/// use basemat::structure::{BaseNode, MatrixModel, Structure, Triplets, WithElements};
///
/// // A rigid base [u_x, u_y, θ] and a mass [u_x, u_y, θ], connected by a column of steel.
/// let masses = [2.0e4, 2.0e4, 6.0e4, 3.0e4, 3.0e4, 1.0e3];
/// let mass = Triplets::from_entries(6, masses.into_iter().enumerate().map(|(k, m)| (k, k, m)));
/// let base = BaseNode::rigid_base(-3.0, 3.0, [0, 1, 2]);
/// let linear = MatrixModel::new(mass, Triplets::new(6), base)?;
/// let steel = BilinearSteel::new(355.0e6, 210.0e9, 0.01)?;
/// let section = FiberSection::new().with_rectangle([[-0.2, -0.1], [0.2, 0.1]], [20, 1], steel)?;
/// let mut mesh = Mesh::new();
/// let nodes = [mesh.add_node(0.0, 0.0)?, mesh.add_node(0.0, 5.0)?];
/// mesh.add(FiberBeam::new(nodes, &section, BeamQuadrature::Lobatto(5), 0.0)?)?;
/// let tower = WithElements::new(linear, mesh, |node, direction| {
///     let first = 3 * node;
///     Ok(match direction {
///         Direction::X => first.into(),
///         Direction::Y => (first + 1).into(),
///         _ => (first + 2).into(),
///     })
/// })?;
/// let mut force = [0.0; 6];
/// tower.nonlinear().unwrap().force(&[0.0, 0.0, 0.0, 0.0, -1e-3, 0.0], &mut force)?;
/// // E A/L = 210 GPa · 0.08 m²/5 m.
/// assert!((force[1] - 3.36e6).abs() < 1.0 && (force[4] + 3.36e6).abs() < 1.0);
/// assert_eq!(tower.beam_sections(0)?.len(), 5);
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct WithElements {
    structure: Box<dyn Structure>,
    mesh: Mesh,
    /// Degrees of freedom of each element, in the order of its matrices, as sums of those of the structure.
    rows: Vec<Vec<DofCombination>>,
    elements: InelasticElements,
}

short_debug! {
    WithElements; self; dofs: self.structure.dofs(), elements: self.mesh.elements().len()
}

impl WithElements {
    /// Adds all elements of a `mesh` to a linear `structure`.
    ///
    /// `row`: displacement of a node of the mesh in a direction, as a sum of degrees of freedom of the structure.
    ///
    /// # Errors
    /// [`Error::Scene`] for a structure that is not linear ([`WithSprings`](crate::structure::WithSprings) may be around the
    /// elements, not inside); [`Error::Size`] without elements; [`Error::Part`] for an element without internal
    /// variables, whose matrices belong to the structure; [`Error::Index`] and [`Error::Input`] for terms that the structure
    /// does not have or that are not finite; errors of `row` and of the elements in their undeformed state.
    pub fn new(
        structure: impl Structure + 'static,
        mesh: Mesh,
        row: impl Fn(usize, Direction) -> Result<DofCombination>,
    ) -> Result<Self> {
        let needed = "must be linear: springs may be around the elements, not inside";
        if structure.nonlinear().is_some() {
            return Err(Error::Scene { quantity: "structure inside elements", needed });
        }
        at_least("elements on a structure", mesh.elements().len(), 1)?;
        let dof_count = structure.dofs();
        let checked_row = |node, direction| {
            let combination = row(node, direction)?;
            combination.check("degree of freedom of an element", dof_count)?;
            Ok(combination)
        };
        let mut rows = Vec::new();
        for (index, element) in mesh.elements().enumerate() {
            if element.inelastic().is_none() {
                let reason = "it is linear: add its matrices to those of the structure";
                return Err(Error::part(format!("element {index}"), reason));
            }
            let mut element_rows = Vec::with_capacity(element.order());
            for &node in element.nodes() {
                for &direction in element.directions() {
                    element_rows.push(checked_row(node, direction)?);
                }
            }
            rows.push(element_rows);
        }
        let elements = InelasticElements::new(&mesh, dof_count, checked_row)?;
        let needed = "must have elements with internal variables";
        let elements = elements.ok_or(Error::Scene { quantity: "mesh on a structure", needed })?;
        Ok(Self { structure: Box::new(structure), mesh, rows, elements })
    }

    /// The linear structure without the elements.
    pub fn structure(&self) -> &dyn Structure {
        self.structure.as_ref()
    }

    /// Nodes and elements that the structure moves.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// States at the integration points of a solid, as [`FemModel::solid_points`](crate::structure::FemModel::solid_points).
    ///
    /// # Errors
    /// [`Error::Index`] when there is no such element, and errors of its material.
    pub fn solid_points(&self, element: usize) -> Result<Vec<SolidPoint>> {
        self.element_states(element, read_points)
    }

    /// States of sections, as [`FemModel::beam_sections`](crate::structure::FemModel::beam_sections).
    ///
    /// # Errors
    /// As for [`solid_points`](WithElements::solid_points).
    pub fn beam_sections(&self, element: usize) -> Result<Vec<BeamSectionState>> {
        self.element_states(element, read_sections)
    }

    /// State of a hinge, as [`FemModel::hinge_state`](crate::structure::FemModel::hinge_state).
    ///
    /// # Errors
    /// As for [`solid_points`](WithElements::solid_points); [`Error::Part`] for an element that is no hinge.
    pub fn hinge_state(&self, element: usize) -> Result<HingeState> {
        let states = self.element_states(element, read_hinge)?;
        let not_a_hinge = || Error::part(format!("element {element}"), "it is no hinge");
        states.first().copied().ok_or_else(not_a_hinge)
    }

    /// States in an element at the end of the last step.
    fn element_states<T>(&self, element: usize, read: ReadStates<T>) -> Result<Vec<T>> {
        in_bounds("element", element, self.rows.len())?;
        self.elements.states(element, read).unwrap_or_else(|| Ok(Vec::new()))
    }

    /// Adds the matrices of all elements that `fill` adds to zeros.
    fn add_matrices(&self, fill: fn(&dyn Element, &[[f64; 3]], &mut [f64]), matrix: &mut Triplets) {
        for (element, rows) in self.mesh.elements().zip(&self.rows) {
            let coordinates = self.mesh.coordinates(element.nodes());
            let mut element_matrix = vec![0.0; rows.len() * rows.len()];
            fill(element, &coordinates, &mut element_matrix);
            for (values, row) in element_matrix.chunks_exact(rows.len()).zip(rows) {
                for (value, column) in values.iter().zip(rows).filter(|(value, _)| **value != 0.0) {
                    add_product(*value, row, column, matrix);
                }
            }
        }
    }
}

/// Adds `factor` times the product of two sums of degrees of freedom.
fn add_product(factor: f64, row: &DofCombination, column: &DofCombination, matrix: &mut Triplets) {
    for &(i, row_weight) in row {
        for &(j, column_weight) in column {
            matrix.add(i, j, row_weight * column_weight * factor);
        }
    }
}

impl Structure for WithElements {
    forward! {
        self.structure;
        fn dofs(&self) -> usize;
        fn base(&self) -> Base;
        fn mass_at_rest(&self) -> Result<Option<Vec<f64>>>;
        fn has_active_damping(&self) -> bool;
        fn has_active_stiffness(&self) -> bool;
        fn description(&self) -> StructureDescription;
        fn describe(&self, dofs: &[usize]) -> Option<String>;
        fn load(&self, time: f64, load: &mut [f64]) -> Result<()>;
    }

    /// Mass of the structure, and the consistent masses of the elements.
    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        self.structure.mass(matrix)?;
        let mass = |element: &dyn Element, coordinates: &[[f64; 3]], element_matrix: &mut [f64]| {
            element.mass(coordinates, MassKind::Consistent, element_matrix);
        };
        self.add_matrices(mass, matrix);
        Ok(())
    }

    /// Stiffness of the structure; the forces of the elements are the nonlinear force.
    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.structure.stiffness(matrix)?;
        self.add_matrices(<dyn Element>::geometric_stiffness, matrix);
        Ok(())
    }

    fn geometric_stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        self.structure.geometric_stiffness(matrix)?;
        self.add_matrices(<dyn Element>::geometric_stiffness, matrix);
        Ok(())
    }

    fn damping(&self, matrix: &mut Triplets) -> Result<()> {
        self.structure.damping(matrix)?;
        self.add_matrices(<dyn Element>::damping, matrix);
        Ok(())
    }

    fn nonlinear(&self) -> Option<&dyn NonlinearForce> {
        Some(&self.elements)
    }

    fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce> {
        Some(&mut self.elements)
    }
}
