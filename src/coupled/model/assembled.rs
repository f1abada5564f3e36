//! Matrices, base and influence vectors of a structure in its degrees of freedom, assembled once.
//!
//! | symbol | meaning |
//! |---|---|
//! | R | influence vectors: the degrees of freedom when a connected part translates rigidly by 1 m |
//! | N | displacements of the contact nodes |
//! | B | element means of the base displacement |

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::coupled::base::PlacedBase;
use crate::coupled::base::influence::Influence;
use crate::coupled::base::joint_line::JointLine;
use crate::coupled::model::mechanism::StructureAtRest;
use crate::coupled::model::signs::check_signs;
use crate::coupled::model::supports;
use crate::error::{Error, Result, at_least};
use crate::geometry::Patch;
use crate::linalg::matrix::dense_vector;
use crate::linalg::{Elimination, Partition, SparseFactor, SparseMatrix, dot};
use crate::structure::{
    BaseNode, SpringSupportedBase, Structure, StructureError, Tangent, Triplets, check_attached,
    check_damping, check_mass, check_stiffness, max_diagonal_stiffness, proportional_factors,
};

/// Number of passes of iterative refinement of the influence vectors.
const INFLUENCE_REFINEMENT_COUNT: usize = 3;
/// Largest ratio √(inertia/stiffness) (s) of the springs under the base.
///
/// It excludes a stiffness that is only rounding.
const MAX_BASE_SPRING_TIME: f64 = 0.1;

/// Matrices, base and influence vectors of a structure in its degrees of freedom.
pub(crate) struct Assembled {
    pub(crate) is_linear: bool,
    /// Whether the mass is positive definite.
    pub(crate) is_massive: bool,
    pub(crate) mass: Arc<SparseMatrix>,
    pub(crate) damping: Arc<SparseMatrix>,
    pub(crate) stiffness: Arc<SparseMatrix>,
    /// K with the tangent of the nonlinear force at rest.
    ///
    /// `None` for a linear structure.
    pub(super) tangent_stiffness: Option<SparseMatrix>,
    pub(crate) base: PlacedBase,
    pub(crate) influence: Arc<Influence>,
    /// Elimination order for the factors of these matrices.
    pub(crate) elimination: Elimination,
}

impl Assembled {
    /// Assembles a structure, and factors its stiffness at rest with a fixed base.
    ///
    /// Returns an error for matrices of wrong sign, parts without connection to the base, supports besides the ground, and
    /// mechanisms that cannot be factored.
    pub(crate) fn new(
        structure: &dyn Structure,
        elements: &Patch,
        joints: &[JointLine],
    ) -> Result<(Self, SparseFactor)> {
        let base = PlacedBase::of(structure, elements, joints)?;
        let dofs = structure.dofs();
        let is_linear = structure.nonlinear().is_none();
        at_least("list of degrees of freedom", dofs, 1)?;
        let mut triplets = Triplets::new(dofs);
        let mut assemble = |name, fill: &dyn Fn(&mut Triplets) -> Result<()>| {
            SparseMatrix::assembled(name, &mut triplets, fill)
        };
        let mass = assemble("mass matrix", &|m| structure.mass(m))?;
        let damping = assemble("damping matrix", &|m| structure.damping(m))?;
        let stiffness = assemble("stiffness matrix", &|m| structure.stiffness(m))?;
        drop(triplets);
        let tangent = Tangent::at(structure, &vec![0.0; dofs])?;
        let mut tangent_stiffness = None;
        if !is_linear {
            let terms = [(1.0, &stiffness), (1.0, &tangent.matrix)];
            tangent_stiffness = Some(SparseMatrix::sum("stiffness matrix", dofs, &terms)?);
        }
        // Masses and dampings may couple far fewer degrees of freedom. The stiffness therefore determines the order.
        let elimination = Elimination::for_matrix(tangent_stiffness.as_ref().unwrap_or(&stiffness));
        let is_massive = check_mass(&mass, &elimination)?;
        if !structure.has_active_stiffness() {
            check_stiffness(&stiffness, &mass)?;
        }
        let mut assembled = Self {
            is_linear,
            is_massive,
            mass: Arc::new(mass),
            damping: Arc::new(damping),
            stiffness: Arc::new(stiffness),
            tangent_stiffness,
            base,
            influence: Arc::default(),
            elimination,
        };
        let stiffness = assembled.stiffness_at_rest();
        check_attached(structure, stiffness, &assembled.mass, &assembled.base.dofs())?;
        // Which error a mechanism causes depends on rounding, but a mechanism never causes `Indefinite`.
        let (influence, fixed_factor) =
            assembled.compute_influence().map_err(|error| match error {
                Error::Indefinite { .. } => assembled.buckling(structure).unwrap_or(error),
                _ => assembled.structure_at_rest(structure).cause_of(error),
            })?;
        assembled.influence = Arc::new(influence);
        Ok((assembled, fixed_factor))
    }

    /// Error for a structure that buckles on a fixed base.
    ///
    /// `None` if it does not.
    ///
    /// The error contains the load factor.
    fn buckling(&self, structure: &dyn Structure) -> Option<Error> {
        let loaded_stiffness = LoadedStiffness::new(structure, &self.stiffness)?;
        let factor = loaded_stiffness.critical_factor(1.0, |stiffness| {
            check_signs(&self.base, [&self.mass, &self.damping, stiffness]).is_ok()
        })?;
        Some(StructureError::Buckling { factor }.into())
    }

    /// Coefficients β and α of a damping β (K − P–Δ) + α M, if the damping is of this form.
    pub(crate) fn damping_without_p_delta(&self, structure: &dyn Structure) -> Option<[f64; 2]> {
        let elastic = LoadedStiffness::new(structure, &self.stiffness)?.at_factor(0.0).ok()?;
        proportional_factors(&self.damping, [&elastic, &self.mass])
    }

    /// Returns an error for a damping that is not positive semi-definite.
    ///
    /// A structure may declare active damping, which is not checked. `shifted_stiffness` is K + εM if this
    /// matrix is positive definite. Damping in proportion to it and to the mass then needs no factorization.
    pub(crate) fn check_damping(
        &self,
        structure: &dyn Structure,
        shifted_stiffness: Option<&SparseMatrix>,
    ) -> Result<()> {
        let is_proportional = shifted_stiffness.is_some_and(|matrix| {
            proportional_factors(&self.damping, [matrix, &self.mass]).is_some()
        });
        if structure.has_active_damping() || is_proportional {
            return Ok(());
        }
        check_damping(&self.damping, &self.elimination)
    }

    /// The same structure on the elements of another base.
    pub(crate) fn with_base(&self, base: PlacedBase) -> Self {
        Self {
            is_linear: self.is_linear,
            is_massive: self.is_massive,
            mass: Arc::clone(&self.mass),
            damping: Arc::clone(&self.damping),
            stiffness: Arc::clone(&self.stiffness),
            tangent_stiffness: self.tangent_stiffness.clone(),
            base,
            influence: Arc::clone(&self.influence),
            elimination: self.elimination.clone(),
        }
    }

    /// The same structure with another linear stiffness.
    pub(crate) fn with_stiffness(&self, stiffness: SparseMatrix) -> Self {
        Self {
            stiffness: Arc::new(stiffness),
            tangent_stiffness: None,
            ..self.with_base(self.base.clone())
        }
    }

    /// Number of degrees of freedom.
    pub(crate) fn dofs(&self) -> usize {
        self.mass.order()
    }

    /// Mass, damping and stiffness as shared pointers.
    pub(crate) fn shared_matrices(&self) -> [Arc<SparseMatrix>; 3] {
        [&self.mass, &self.damping, &self.stiffness].map(Arc::clone)
    }

    /// Mass, damping and stiffness.
    pub(crate) fn matrices(&self) -> [&SparseMatrix; 3] {
        [&self.mass, &self.damping, &self.stiffness]
    }

    /// Period on a fixed base, s; NaN for a structure without mass.
    ///
    /// It follows from Rayleigh's quotient of the deflection under a horizontal weight along x. In plan it is the longer
    /// period of x and y. `fixed_factor` is the factored stiffness with springs at the base. The work of the weight on the
    /// springs is neglected (an error of 1 %).
    pub(crate) fn period_on_fixed_base(&self, fixed_factor: &mut SparseFactor) -> f64 {
        // Direction 0 is to the right; in plan direction 2 is horizontally along y.
        let directions = self.base.layout().axes().map(|axis| 2 * axis);
        directions
            .map(|direction| self.period_along(direction, fixed_factor))
            .fold(f64::NAN, f64::max)
    }

    /// Rayleigh period of the deflection under the weight in a direction, s.
    fn period_along(&self, direction: usize, fixed_factor: &mut SparseFactor) -> f64 {
        let translation = self.influence.whole_vector(direction, self.dofs());
        let mut weight = vec![0.0; self.dofs()];
        self.mass.multiply_add(1.0, &translation, &mut weight);
        let mut deflection = weight.clone();
        fixed_factor.solve(&mut deflection);
        let quadratic_form = |matrix: &SparseMatrix| matrix.form(&deflection, &deflection);
        let work = dot(&deflection, &weight);
        TAU * (quadratic_form(&self.mass) * quadratic_form(self.stiffness_at_rest())).sqrt() / work
    }

    /// K with the tangent of the nonlinear force at rest.
    pub(crate) fn stiffness_at_rest(&self) -> &SparseMatrix {
        self.tangent_stiffness.as_ref().unwrap_or(&self.stiffness)
    }

    /// The structure at rest, for a search for mechanisms.
    ///
    /// `structure` names its degrees of freedom.
    pub(crate) fn structure_at_rest<'a>(
        &'a self,
        structure: &'a dyn Structure,
    ) -> StructureAtRest<'a> {
        let stiffness = self.stiffness_at_rest();
        StructureAtRest { structure, stiffness, mass: &self.mass, base: &self.base }
    }

    /// Largest damping of a translation over the moving mass, 1/s.
    ///
    /// It is r·C r / r·M r for a translation r along the ground. It is the largest of all parts and horizontal directions.
    pub(crate) fn translation_damping_rate(&self) -> f64 {
        let parts = self.influence.parts().iter();
        let vectors = parts.flat_map(|part| [&part.vectors[0], &part.vectors[2]]);
        let rates = vectors.filter(|vector| !vector.is_empty()).map(|vector| {
            let translation = dense_vector(vector, self.dofs());
            let quadratic_form = |matrix: &SparseMatrix| matrix.form(&translation, &translation);
            quadratic_form(&self.damping) / quadratic_form(&self.mass)
        });
        rates.fold(0.0, f64::max)
    }

    /// Largest effective mass (kg) of a single contact node.
    fn base_inertia(&self) -> f64 {
        let masses = self.mass.diagonal();
        let rows = self.base.nodes().iter().flat_map(BaseNode::rows).filter(|row| !row.is_empty());
        let effective_masses = rows.map(|row| {
            let square: f64 = row.iter().map(|(_, weight)| weight * weight).sum();
            row.iter().map(|&(i, weight)| masses[i] * (weight / square).powi(2)).sum()
        });
        effective_masses.fold(0.0, f64::max)
    }

    /// Stiffness of the springs at the contact nodes that fix the base, N/m.
    pub(super) fn base_spring_stiffness(&self) -> f64 {
        max_diagonal_stiffness(self.stiffness_at_rest())
            .max(self.base_inertia() / (MAX_BASE_SPRING_TIME * MAX_BASE_SPRING_TIME))
    }

    /// Computes the influence vectors, and factors the stiffness with a fixed base.
    ///
    /// A rigid translation r has K r = 0 and moves the contact nodes by one. It is therefore the solution of
    /// (K + γ NᵀN) r = γ Nᵀ 1 for every γ, independent of the meaning of the degrees of freedom. Displacements are stepped
    /// relative to rigid translations. Therefore R must be exact at the base: N R, and with it B R, is 1 or 0 to rounding.
    fn compute_influence(&self) -> Result<(Influence, SparseFactor)> {
        let stiffness = self.stiffness_at_rest();
        let dofs = self.dofs();
        let max_stiffness = max_diagonal_stiffness(stiffness);
        let spring = self.base_spring_stiffness();
        let springs = SpringSupportedBase::new(self.base.nodes(), stiffness, spring);
        let matrix = SparseMatrix::new(SpringSupportedBase::STIFFNESS_NAME, &springs.matrix)?;
        let is_condensed = self.is_linear
            && self.base.is_flexible()
            && self.base.joints().is_empty()
            && !self.base.elements().has_walls();
        let elimination_ending_with_base =
            if is_condensed { self.elimination.ending_with(&self.base.dofs()) } else { None };
        let elimination = elimination_ending_with_base.as_ref().unwrap_or(&self.elimination);
        let factor = SparseFactor::with_elimination(
            SpringSupportedBase::STIFFNESS_NAME,
            &matrix,
            elimination,
        )?;
        if self.is_linear && !factor.is_positive_definite() {
            check_signs(&self.base, self.matrices())?;
        }
        let spring_forces = springs.translation_forces().concat();
        let mut solution = vec![0.0; spring_forces.len()];
        for _ in 0..=INFLUENCE_REFINEMENT_COUNT {
            let mut residual = matrix.times(&solution);
            residual.iter_mut().zip(&spring_forces).for_each(|(r, force)| *r = force - *r);
            factor.solve_many(&mut residual);
            solution.iter_mut().zip(&residual).for_each(|(r, d)| *r += d);
        }
        if solution.iter().any(|r| !r.is_finite()) {
            return Err(Error::Singular {
                matrix: SpringSupportedBase::STIFFNESS_NAME,
                order: dofs,
            });
        }
        let mut translations: Vec<_> = solution.chunks_exact(dofs).map(<[f64]>::to_vec).collect();
        let spring_ratio = spring / max_stiffness;
        supports::check(stiffness, &self.mass, spring_ratio, &self.base, &mut translations)?;
        let mut parts = Partition::new(dofs);
        for matrix in [stiffness, &*self.mass, &*self.damping] {
            parts.couple(matrix);
        }
        for (nodes, _) in self.base.foundations() {
            let mut node_dofs = nodes.iter().flat_map(BaseNode::dofs);
            if let Some(first_dof) = node_dofs.next() {
                node_dofs.for_each(|dof| parts.join(first_dof, dof));
            }
        }
        for node in self.base.joints().iter().flat_map(|joint| joint.line.sides()).flatten() {
            let mut node_dofs = node.dofs();
            if let Some(first_dof) = node_dofs.next() {
                node_dofs.for_each(|dof| parts.join(first_dof, dof));
            }
        }
        let part_labels: Vec<usize> = (0..dofs).map(|dof| parts.root(dof)).collect();
        let influence = Influence::split(&self.base, &translations, &part_labels)?;
        supports::check_parts(&influence, &self.base, dofs)?;
        Ok((influence, factor))
    }
}

/// Relative accuracy of a load factor; messages print fewer digits.
const LOAD_FACTOR_ACCURACY: f64 = 1e-6;

/// A stiffness with P–Δ, and its geometric part from the forces at rest.
pub(crate) struct LoadedStiffness<'a> {
    stiffness: &'a SparseMatrix,
    geometric: SparseMatrix,
}

impl<'a> LoadedStiffness<'a> {
    /// Separates the geometric part of a structure's `stiffness`; `None` without P–Δ.
    pub(crate) fn new(structure: &dyn Structure, stiffness: &'a SparseMatrix) -> Option<Self> {
        let mut geometric = Triplets::new(structure.dofs());
        structure.geometric_stiffness(&mut geometric).ok()?;
        let geometric = SparseMatrix::new("geometric stiffness matrix", &geometric).ok()?;
        (!geometric.is_empty()).then_some(Self { stiffness, geometric })
    }

    /// Stiffness under `factor` times the forces at rest.
    pub(crate) fn at_factor(&self, factor: f64) -> Result<SparseMatrix> {
        let terms = [(1.0, self.stiffness), (factor - 1.0, &self.geometric)];
        SparseMatrix::sum("stiffness matrix", self.stiffness.order(), &terms)
    }

    /// Smallest factor of the forces at rest at which the structure is unstable.
    ///
    /// The factor is between 0 and `limit`. `is_stable` returns whether the structure is stable with a
    /// stiffness. The result is `None` if it is stable under `limit` times its forces at rest, or unstable without
    /// them.
    pub(crate) fn critical_factor(
        &self,
        limit: f64,
        is_stable: impl Fn(&SparseMatrix) -> bool,
    ) -> Option<f64> {
        let is_stable_at =
            |factor: f64| self.at_factor(factor).is_ok_and(|stiffness| is_stable(&stiffness));
        if !is_stable_at(0.0) || is_stable_at(limit) {
            return None;
        }
        let mut low = 0.0;
        let mut high = limit;
        while high - low > LOAD_FACTOR_ACCURACY * high && high > f64::MIN_POSITIVE {
            let middle = 0.5 * (low + high);
            if is_stable_at(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(0.5 * (low + high))
    }
}
