//! P–Δ of finite-element models: axial forces from the weight, and the buckling factor.

use crate::error::{Error, Result, StructureError, not_negative};
use crate::fem::{MatrixKind, set_static_state};
use crate::linalg::{SparseFactor, SparseMatrix, largest};
use crate::structure::detached::restricted;
use crate::structure::{FemModel, Structure, Triplets};

const MATRIX_NAME: &str = "stiffness matrix with the contact nodes held";
/// Residual forces of a solution, relative to the weight, above which the structure is a mechanism.
const EQUILIBRIUM_TOLERANCE: f64 = 1e-6;
/// Largest multiple of the axial forces in the search for buckling.
const MAX_BUCKLING_FACTOR: f64 = 1e6;
/// Relative accuracy of a buckling factor.
const BUCKLING_FACTOR_TOLERANCE: f64 = 1e-9;

impl FemModel {
    /// Adds the P–Δ effect of the structure's own weight.
    ///
    /// The elements get the geometric stiffness of the forces that they carry at rest. The forces
    /// follow from first-order statics under `gravity` (m/s², downwards) with the contact nodes held, and do not
    /// change in the shaking. Every degree of freedom that moves a contact node is held: a rigid basemat is clamped, a
    /// column that ends on a contact node is hinged there, as on the ground. Walls in a trench are free.
    ///
    /// * All forces at the nodes of an element turn with it: shear forces and moments of beams, forces of shells, solids
    ///   and springs between two nodes. A solid or shell has no curvature between its nodes; take several along a
    ///   member that may buckle.
    /// * The axial forces of beams and trusses act on the curvature between their ends too. In a beam the force grows
    ///   downwards with the beam's own weight; a truss has the mean.
    ///   [`Element::compression`](crate::fem::Element::compression) returns the force.
    /// * Reactions of the ground that are not vertical, such as the thrust of a portal, turn with the base.
    /// * A force given by [`Beam::with_compression`](crate::fem::Beam::with_compression) stays as it is. Given forces are
    ///   not in equilibrium with the weights, so the last rule and the next paragraph do not hold with them.
    ///
    /// The present kind of mass matrix counts: call [`with_mass`](FemModel::with_mass) before. Rigid links may
    /// follow; the forces are then computed anew.
    ///
    /// Translations and a rotation about the vertical meet no force, so the structure still moves freely. In a rocking
    /// rotation ψ it meets the overturning moment −W h ψ of its weight W at the height h above the base.
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
    /// [`Error::Input`] unless `gravity` is finite and not negative, [`Error::Singular`] when the contact nodes do
    /// not hold the structure, [`StructureError::Buckling`] when it buckles on them, under forces given by hand too; and
    /// errors of its matrices.
    pub fn with_p_delta(mut self, gravity: f64) -> Result<Self> {
        not_negative("acceleration of gravity", gravity)?;
        // They belong to the links of an earlier call.
        self.base_reactions = Vec::new();
        let displacement = self.under_weight(gravity)?;
        let elements = self.mesh.elements();
        let displacements: Vec<_> = elements
            .map(|element| self.element_displacements(element, &displacement))
            .collect::<Result<_>>()?;
        let has_given_force =
            set_static_state(&mut self.mesh, &displacements, gravity, self.mass_kind)?;
        let mut entries = self.rotation_of_links(&displacement, gravity)?;
        // Forces given by hand are not in equilibrium with the weights.
        if !has_given_force {
            self.add_base_reactions(&displacement, gravity, &mut entries)?;
        }
        self.base_reactions = entries;
        self.p_delta = Some(gravity);
        let held = HeldStructure::new(&self)?;
        if held.stands(1.0)? {
            Ok(self)
        } else {
            Err(StructureError::Buckling { factor: held.buckling_factor(1.0)? }.into())
        }
    }

    /// Factor on the axial forces of the elements at which the structure buckles.
    ///
    /// The structure is held at its contact nodes; the forces come from [`with_p_delta`](FemModel::with_p_delta)
    /// or were given by hand. Infinite if a million times the forces does not buckle it. For the given mesh the
    /// factor has nine digits; it takes some forty sparse factorisations.
    ///
    /// # Errors
    /// [`Error::Singular`] when the contact nodes do not hold the structure.
    pub fn buckling_factor(&self) -> Result<f64> {
        let held = HeldStructure::new(self)?;
        let mut high = 1.0;
        while held.stands(high)? {
            high *= 2.0;
            if high > MAX_BUCKLING_FACTOR {
                return Ok(f64::INFINITY);
            }
        }
        held.buckling_factor(high)
    }

    /// Displacements under the structure's weight.
    fn under_weight(&self, gravity: f64) -> Result<Vec<f64>> {
        let n = self.dofs();
        let mut mass = Triplets::new(n);
        self.mass(&mut mass)?;
        let mass = SparseMatrix::new("mass matrix", &mass)?;
        let mut weight = vec![0.0; n];
        mass.multiply_add(-gravity, &self.rigid_motion(self.mesh.upwards(), [0.0; 3]), &mut weight);
        let held = HeldStructure::new(self)?;
        let load: Vec<f64> = held.free.iter().map(|&dof| weight[dof]).collect();
        let mut displacement = vec![0.0; n];
        for (&dof, value) in held.free.iter().zip(held.solve(load)?) {
            displacement[dof] = value;
        }
        Ok(displacement)
    }
}

/// A structure whose contact nodes are held.
struct HeldStructure {
    /// The degrees of freedom that are not held.
    free: Vec<usize>,
    /// Stiffness without axial forces, and the geometric stiffness of the axial forces, in the free degrees of
    /// freedom.
    elastic: SparseMatrix,
    geometric: SparseMatrix,
}

impl HeldStructure {
    /// Assembles both stiffnesses; returns an error for invalid entries.
    fn new(model: &FemModel) -> Result<Self> {
        let n = model.dofs();
        let is_held = model.is_held();
        let free: Vec<usize> = (0..n).filter(|&dof| !is_held[dof]).collect();
        let mut place = vec![None; n];
        free.iter().enumerate().for_each(|(k, &dof)| place[dof] = Some(k));
        let free_matrix = |kind| {
            let mut all = Triplets::new(n);
            model.add(&mut all, &[(kind, 1.0)]);
            // Through the full matrix, which returns an error for indices out of range.
            let all = SparseMatrix::new(MATRIX_NAME, &all)?;
            restricted(MATRIX_NAME, &all, free.len(), |dof| place[dof])
        };
        let elastic = free_matrix(MatrixKind::Stiffness)?;
        let geometric = free_matrix(MatrixKind::GeometricStiffness)?;
        Ok(Self { free, elastic, geometric })
    }

    /// Elastic displacements under a load.
    fn solve(&self, load: Vec<f64>) -> Result<Vec<f64>> {
        if self.free.is_empty() {
            return Ok(load);
        }
        let mut displacement = load.clone();
        SparseFactor::positive_definite(MATRIX_NAME, &self.elastic)?.solve(&mut displacement);
        let mut rest = load;
        let weight = largest(&rest);
        self.elastic.multiply_add(-1.0, &displacement, &mut rest);
        if rest.iter().all(|force| force.abs() <= EQUILIBRIUM_TOLERANCE * weight) {
            Ok(displacement)
        } else {
            Err(Error::Singular { matrix: MATRIX_NAME, order: self.free.len() })
        }
    }

    /// Whether the structure stands under `factor` times its axial forces: its stiffness is positive definite.
    fn stands(&self, factor: f64) -> Result<bool> {
        if self.free.is_empty() {
            return Ok(true);
        }
        let mut matrix = Triplets::new(self.free.len());
        self.elastic.add_to(1.0, &mut matrix);
        self.geometric.add_to(factor, &mut matrix);
        let matrix = SparseMatrix::new(MATRIX_NAME, &matrix)?;
        Ok(SparseFactor::positive_definite(MATRIX_NAME, &matrix).is_ok())
    }

    /// Factor on the axial forces at which the structure buckles, by bisection.
    ///
    /// The structure must not stand under `high` times the forces; an error unless it stands without axial forces.
    fn buckling_factor(&self, mut high: f64) -> Result<f64> {
        if !self.stands(0.0)? {
            return Err(Error::Singular { matrix: MATRIX_NAME, order: self.free.len() });
        }
        let mut low = 0.0;
        while high - low > BUCKLING_FACTOR_TOLERANCE * high && high > f64::MIN_POSITIVE {
            let middle = 0.5 * (low + high);
            if self.stands(middle)? {
                low = middle;
            } else {
                high = middle;
            }
        }
        Ok(0.5 * (low + high))
    }
}
