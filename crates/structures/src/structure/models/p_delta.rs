//! P–Δ effect of finite-element models: static forces due to the weight, and the buckling factor.

use super::inelastic_elements::InelasticElements;
use crate::error::{Error, Result, StructureError, not_negative, require_part};
use crate::fem::{Element, MatrixKind, set_static_state};
use crate::linalg::{SparseFactor, SparseMatrix, largest};
use crate::structure::detached::submatrix;
use crate::structure::{FemModel, Structure, Triplets};

/// Name of the stiffness matrix in errors.
const MATRIX_NAME: &str = "stiffness matrix with the contact nodes fixed";
/// Largest residual force of a solution, relative to the weight.
///
/// With a larger one the structure counts as a mechanism. Rounding leaves far less, unless the stiffness is nearly
/// singular.
const EQUILIBRIUM_TOLERANCE: f64 = 1e-6;
/// Largest factor on the axial forces in the search for buckling.
///
/// Larger factors have no practical meaning.
const MAX_BUCKLING_FACTOR: f64 = 1e6;
/// Relative accuracy of a buckling factor.
const BUCKLING_FACTOR_TOLERANCE: f64 = 1e-9;

impl FemModel {
    /// Adds the P–Δ effect of the structure's own weight.
    ///
    /// The elements get the geometric stiffness of their static forces. These forces follow from first-order statics
    /// under `gravity` (m/s², downwards) with fixed contact nodes, and do not change during the motion. Every degree of
    /// freedom that moves a contact node is fixed: a rigid basemat is clamped, and a column that ends on a contact node
    /// is hinged there, as on the ground. Walls in a trench are free.
    ///
    /// * All forces at the nodes of an element rotate with it: shear forces and moments of beams, forces of shells,
    ///   solids and springs between two nodes. A solid or shell has no curvature between its nodes; use several along a
    ///   member that may buckle.
    /// * The axial forces of beams and trusses also act on the lateral displacement between their ends. In a beam the
    ///   force increases downwards by the weight of the beam; a truss has the mean force.
    ///   [`Element::compression`](crate::fem::Element::compression) returns the force.
    /// * Reactions of the ground that are not vertical, such as the thrust of a portal, rotate with the base.
    /// * Elements with internal variables have the static forces of small displacements, as if they did not yield.
    /// * A force prescribed by [`Beam::with_compression`](crate::fem::Beam::with_compression) does not change.
    ///   Prescribed forces are not in equilibrium with the weights, so the previous rule and the last paragraph do not
    ///   hold with them.
    ///
    /// Call [`with_mass`](FemModel::with_mass) before this method, which uses the present kind of mass matrix. Rigid
    /// links may be added later; the forces are then computed again.
    ///
    /// Translations and a rotation about the vertical cause no force, so the structure can still move freely. A rocking
    /// rotation ψ causes the overturning moment −W h ψ of the weight W at the height h above the base.
    ///
    /// ```
    /// use basemat::fem::{Beam, LumpedMass, Mesh};
    /// use basemat::structure::FemModel;
    ///
    /// // A light column with 40 t on its top, on a rigid basemat 4 m wide.
    /// let mut mesh = Mesh::new();
    /// let [left, foot, right] =
    ///     [mesh.add_node(-2.0, 0.0)?, mesh.add_node(0.0, 0.0)?, mesh.add_node(2.0, 0.0)?];
    /// let top = mesh.add_node(0.0, 6.0)?;
    /// for ends in [[left, foot], [foot, right], [foot, top]] {
    ///     mesh.add(Beam::new(ends, 30.0e9, 0.1, 1.0e-3, 0.0)?)?;
    /// }
    /// mesh.add(LumpedMass::new(top, 40.0e3)?)?;
    /// let model = FemModel::on_base(mesh)?.with_rigid_link(foot, &[left, right])?;
    /// let model = model.with_p_delta(9.81)?;
    /// let column = model.mesh().elements().nth(2).and_then(|beam| beam.compression()).unwrap();
    /// assert!((column - 40.0e3 * 9.81).abs() < 1e-6);
    /// // Euler's π²EI/(4L²), 0.75 % above it with one beam.
    /// let euler = std::f64::consts::PI.powi(2) * 30.0e9 * 1.0e-3 / (4.0 * 36.0);
    /// assert!((model.buckling_factor()? * column / euler - 1.0075).abs() < 1e-4);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`] unless `gravity` is finite and not negative, [`Error::Singular`] when the structure is a
    /// mechanism on fixed contact nodes, [`StructureError::Buckling`] when it buckles there, also under prescribed
    /// forces; [`Error::Scene`] for elements with an initial stress or at rest; and errors of its matrices.
    pub fn with_p_delta(mut self, gravity: f64) -> Result<Self> {
        not_negative("acceleration of gravity", gravity)?;
        require_part(
            "model with P–Δ",
            !self.inelastic.as_ref().is_some_and(InelasticElements::has_initial_stress),
            "its elements must have no initial stress: their static forces do not follow from the weight",
        )?;
        require_part(
            "model with P–Δ",
            !self.mesh.elements().any(Element::is_at_rest),
            "it must have no soil at rest: put the structure and the soil into two models of a group",
        )?;
        // The present entries belong to the links of an earlier call.
        self.link_and_base_stiffness = Vec::new();
        let displacement = self.static_displacement(gravity)?;
        let elements = self.mesh.elements();
        let displacements: Vec<_> = elements
            .map(|element| self.element_displacements(element, &displacement))
            .collect::<Result<_>>()?;
        let has_prescribed_force =
            set_static_state(&mut self.mesh, &displacements, gravity, self.mass_kind)?;
        let mut link_entries = self.link_stiffness(&displacement, gravity)?;
        // Prescribed forces are not in equilibrium with the weights.
        if !has_prescribed_force {
            self.add_base_stiffness(&displacement, gravity, &mut link_entries)?;
        }
        self.link_and_base_stiffness = link_entries;
        self.inelastic = self.undeformed_inelastic_elements()?;
        self.p_delta_gravity = Some(gravity);
        let fixed_base = FixedBaseModel::new(&self)?;
        if fixed_base.is_stable_at(1.0)? {
            Ok(self)
        } else {
            Err(StructureError::Buckling { factor: fixed_base.buckling_factor(1.0)? }.into())
        }
    }

    /// Factor on the axial forces of the elements at which the structure buckles.
    ///
    /// The contact nodes are fixed. The forces come from [`with_p_delta`](FemModel::with_p_delta), or are prescribed.
    /// The factor is infinite if the structure does not buckle under a million times the forces. For the present mesh
    /// it is accurate to nine digits; the search takes some forty sparse factorisations.
    ///
    /// # Errors
    /// [`Error::Singular`] when the structure is a mechanism on fixed contact nodes.
    pub fn buckling_factor(&self) -> Result<f64> {
        let fixed_base = FixedBaseModel::new(self)?;
        let mut upper_factor = 1.0;
        while fixed_base.is_stable_at(upper_factor)? {
            upper_factor *= 2.0;
            if upper_factor > MAX_BUCKLING_FACTOR {
                return Ok(f64::INFINITY);
            }
        }
        fixed_base.buckling_factor(upper_factor)
    }

    /// Static displacement under the structure's weight, with fixed contact nodes.
    fn static_displacement(&self, gravity: f64) -> Result<Vec<f64>> {
        let n = self.dofs();
        let mut mass_entries = Triplets::new(n);
        self.mass(&mut mass_entries)?;
        let mass = SparseMatrix::new("mass matrix", &mass_entries)?;
        let mut weight = vec![0.0; n];
        mass.multiply_add(
            -gravity,
            &self.rigid_motion(self.mesh.up_direction(), [0.0; 3]),
            &mut weight,
        );
        let fixed_base = FixedBaseModel::new(self)?;
        let load: Vec<f64> = fixed_base.free_dofs.iter().map(|&dof| weight[dof]).collect();
        let mut displacement = vec![0.0; n];
        for (&dof, value) in fixed_base.free_dofs.iter().zip(fixed_base.solve(load)?) {
            displacement[dof] = value;
        }
        Ok(displacement)
    }
}

/// Stiffness of a model with fixed contact nodes.
struct FixedBaseModel {
    /// Degrees of freedom that are not fixed.
    free_dofs: Vec<usize>,
    /// Stiffness of the free degrees of freedom without P–Δ.
    elastic_stiffness: SparseMatrix,
    /// Geometric stiffness of the free degrees of freedom.
    geometric_stiffness: SparseMatrix,
}

impl FixedBaseModel {
    /// Assembles both matrices; returns an error for invalid entries.
    fn new(model: &FemModel) -> Result<Self> {
        let n = model.dofs();
        let is_fixed = model.is_base_dof();
        let free_dofs: Vec<usize> = (0..n).filter(|&dof| !is_fixed[dof]).collect();
        let mut free_index = vec![None; n];
        free_dofs.iter().enumerate().for_each(|(index, &dof)| free_index[dof] = Some(index));
        let free_matrix = |kind| {
            let mut entries = Triplets::new(n);
            model.add_matrices(&mut entries, &[(kind, 1.0)]);
            // The full matrix returns an error for indices out of range.
            let full_matrix = SparseMatrix::new(MATRIX_NAME, &entries)?;
            submatrix(MATRIX_NAME, &full_matrix, free_dofs.len(), |dof| free_index[dof])
        };
        let elastic_stiffness = free_matrix(MatrixKind::Stiffness)?;
        let geometric_stiffness = free_matrix(MatrixKind::GeometricStiffness)?;
        Ok(Self { free_dofs, elastic_stiffness, geometric_stiffness })
    }

    /// Elastic displacements under a load.
    fn solve(&self, load: Vec<f64>) -> Result<Vec<f64>> {
        if self.free_dofs.is_empty() {
            return Ok(load);
        }
        let mut displacement = load.clone();
        SparseFactor::positive_definite(MATRIX_NAME, &self.elastic_stiffness)?
            .solve(&mut displacement);
        let mut residual = load;
        let max_load = largest(&residual);
        self.elastic_stiffness.multiply_add(-1.0, &displacement, &mut residual);
        if residual.iter().all(|force| force.abs() <= EQUILIBRIUM_TOLERANCE * max_load) {
            Ok(displacement)
        } else {
            Err(Error::Singular { matrix: MATRIX_NAME, order: self.free_dofs.len() })
        }
    }

    /// Whether the stiffness is positive definite under `factor` times the static forces.
    fn is_stable_at(&self, factor: f64) -> Result<bool> {
        if self.free_dofs.is_empty() {
            return Ok(true);
        }
        let mut entries = Triplets::new(self.free_dofs.len());
        self.elastic_stiffness.add_to(1.0, &mut entries);
        self.geometric_stiffness.add_to(factor, &mut entries);
        let matrix = SparseMatrix::new(MATRIX_NAME, &entries)?;
        Ok(SparseFactor::positive_definite(MATRIX_NAME, &matrix).is_ok())
    }

    /// Factor on the static forces at which the structure buckles, by bisection.
    ///
    /// The structure must be unstable at `upper_factor`. Returns an error if it is unstable without static forces.
    fn buckling_factor(&self, mut upper_factor: f64) -> Result<f64> {
        if !self.is_stable_at(0.0)? {
            return Err(Error::Singular { matrix: MATRIX_NAME, order: self.free_dofs.len() });
        }
        let mut lower_factor = 0.0;
        while upper_factor - lower_factor > BUCKLING_FACTOR_TOLERANCE * upper_factor
            && upper_factor > f64::MIN_POSITIVE
        {
            let middle = 0.5 * (lower_factor + upper_factor);
            if self.is_stable_at(middle)? {
                lower_factor = middle;
            } else {
                upper_factor = middle;
            }
        }
        Ok(0.5 * (lower_factor + upper_factor))
    }
}
