//! A structure's matrices, base and influence vectors, assembled once, in its own degrees of freedom.
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
use crate::coupled::model::mechanism::StructureAtRest;
use crate::coupled::model::signs::check_signs;
use crate::coupled::model::supports;
use crate::error::{Error, Result, at_least};
use crate::geometry::Patch;
use crate::linalg::matrix::spread;
use crate::linalg::{Elimination, Partition, SparseFactor, SparseMatrix, dot};
use crate::structure::{
    BaseNode, HeldBase, Structure, StructureError, Tangent, Triplets, check_attached,
    check_damping, check_mass, check_stiffness, proportional_factors, stiffest,
};

/// Number of passes that refine the influence vectors.
const INFLUENCE_REFINEMENT_COUNT: usize = 3;
/// Longest time (s) in which springs under the base move its inertia; it excludes stiffnesses that are rounding.
const MAX_SWAY_TIME: f64 = 0.1;

/// Matrices, base and influence vectors of a structure in its own degrees of freedom.
pub(crate) struct Assembled {
    pub(crate) linear: bool,
    /// Whether the mass is positive definite.
    pub(crate) is_massive: bool,
    pub(crate) mass: Arc<SparseMatrix>,
    pub(crate) damping: Arc<SparseMatrix>,
    pub(crate) stiffness: Arc<SparseMatrix>,
    /// K with the tangent of the nonlinear force at rest; `None` for a linear structure.
    pub(super) at_rest: Option<SparseMatrix>,
    pub(crate) base: PlacedBase,
    pub(crate) influence: Arc<Influence>,
    /// Order in which the factors of these matrices are eliminated.
    pub(crate) elimination: Elimination,
}

impl Assembled {
    /// Assembles a structure over `elements`, and factors its stiffness at rest with the base held.
    ///
    /// Returns an error for wrong signs, parts that nothing holds, supports other than the ground, and mechanisms
    /// that cannot be factored.
    pub(crate) fn new(structure: &dyn Structure, elements: &Patch) -> Result<(Self, SparseFactor)> {
        let base = PlacedBase::of(structure, elements)?;
        let dofs = structure.dofs();
        let linear = structure.nonlinear().is_none();
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
        let mut at_rest = None;
        if !linear {
            let terms = [(1.0, &stiffness), (1.0, &tangent.matrix)];
            at_rest = Some(SparseMatrix::sum("stiffness matrix", dofs, &terms)?);
        }
        // Masses and dampings may couple far fewer degrees of freedom: the stiffness chooses the order.
        let elimination = Elimination::for_matrix(at_rest.as_ref().unwrap_or(&stiffness));
        let is_massive = check_mass(&mass, &elimination)?;
        if !structure.has_active_stiffness() {
            check_stiffness(&stiffness, &mass)?;
        }
        let mut assembled = Self {
            linear,
            is_massive,
            mass: Arc::new(mass),
            damping: Arc::new(damping),
            stiffness: Arc::new(stiffness),
            at_rest,
            base,
            influence: Arc::default(),
            elimination,
        };
        let stiffness = assembled.stiffness_at_rest();
        check_attached(structure, stiffness, &assembled.mass, &assembled.base.dofs())?;
        // Rounding decides how a mechanism fails, but it never fails by its sign.
        let (influence, fixed_factor) =
            assembled.find_influence().map_err(|error| match error {
                Error::Indefinite { .. } => assembled.buckling(structure).unwrap_or(error),
                _ => assembled.at_rest(structure).behind(error),
            })?;
        assembled.influence = Arc::new(influence);
        Ok((assembled, fixed_factor))
    }

    /// Error with the load factor at which the structure buckles with its base held; `None` if it does not.
    fn buckling(&self, structure: &dyn Structure) -> Option<Error> {
        let loaded = LoadedStiffness::new(structure, &self.stiffness)?;
        let factor = loaded.factor(1.0, |stiffness| {
            check_signs(&self.base, [&self.mass, &self.damping, stiffness]).is_ok()
        })?;
        Some(StructureError::Buckling { factor }.into())
    }

    /// β and α of a damping in proportion to the stiffness without P–Δ, and to the mass; `None` for any other.
    pub(crate) fn damping_without_p_delta(&self, structure: &dyn Structure) -> Option<[f64; 2]> {
        let elastic = LoadedStiffness::new(structure, &self.stiffness)?.at(0.0).ok()?;
        proportional_factors(&self.damping, [&elastic, &self.mass])
    }

    /// Error for a damping that is not positive semi-definite, unless it may be.
    ///
    /// `floating`: K + εM, if it is known to be positive definite. Proportional damping then needs no factor.
    pub(crate) fn check_damping(
        &self,
        structure: &dyn Structure,
        floating: Option<&SparseMatrix>,
    ) -> Result<()> {
        let is_proportional = floating.is_some_and(|matrix| {
            proportional_factors(&self.damping, [matrix, &self.mass]).is_some()
        });
        if structure.has_active_damping() || is_proportional {
            return Ok(());
        }
        check_damping(&self.damping, &self.elimination)
    }

    /// The same structure on other elements.
    pub(crate) fn on(&self, base: PlacedBase) -> Self {
        Self {
            linear: self.linear,
            is_massive: self.is_massive,
            mass: Arc::clone(&self.mass),
            damping: Arc::clone(&self.damping),
            stiffness: Arc::clone(&self.stiffness),
            at_rest: self.at_rest.clone(),
            base,
            influence: Arc::clone(&self.influence),
            elimination: self.elimination.clone(),
        }
    }

    /// The same structure with another stiffness beside its nonlinear force.
    pub(crate) fn with_stiffness(&self, stiffness: SparseMatrix) -> Self {
        Self { stiffness: Arc::new(stiffness), at_rest: None, ..self.on(self.base.clone()) }
    }

    /// Number of degrees of freedom.
    pub(crate) fn dofs(&self) -> usize {
        self.mass.order()
    }

    /// Mass, damping, stiffness, to be kept.
    pub(crate) fn shared(&self) -> [Arc<SparseMatrix>; 3] {
        [&self.mass, &self.damping, &self.stiffness].map(Arc::clone)
    }

    /// Mass, damping, stiffness.
    pub(crate) fn matrices(&self) -> [&SparseMatrix; 3] {
        [&self.mass, &self.damping, &self.stiffness]
    }

    /// Period on a fixed base, s; NaN for a structure without mass.
    ///
    /// Rayleigh's quotient of the deflection under the weight along x, in plan the longer one of x and y. `held`:
    /// factored stiffness with springs at the base; their part in the work of the weight is neglected (an error of
    /// 1 %).
    pub(crate) fn period_on_fixed_base(&self, fixed_factor: &mut SparseFactor) -> f64 {
        // Directions to the right, and in plan away.
        let directions = self.base.layout().axes().map(|axis| 2 * axis);
        directions.map(|k| self.period(k, fixed_factor)).fold(f64::NAN, f64::max)
    }

    fn period(&self, direction: usize, fixed_factor: &mut SparseFactor) -> f64 {
        let to_the_side = self.influence.of(direction, self.dofs());
        let mut weight = vec![0.0; self.dofs()];
        self.mass.multiply_add(1.0, &to_the_side, &mut weight);
        let mut deflection = weight.clone();
        fixed_factor.solve(&mut deflection);
        let form = |matrix: &SparseMatrix| matrix.form(&deflection, &deflection);
        let work = dot(&deflection, &weight);
        TAU * (form(&self.mass) * form(self.stiffness_at_rest())).sqrt() / work
    }

    /// K with the tangent of the nonlinear force at rest.
    pub(crate) fn stiffness_at_rest(&self) -> &SparseMatrix {
        self.at_rest.as_ref().unwrap_or(&self.stiffness)
    }

    /// The structure at rest, for a search for mechanisms; `structure` names its degrees of freedom.
    pub(crate) fn at_rest<'a>(&'a self, structure: &'a dyn Structure) -> StructureAtRest<'a> {
        let stiffness = self.stiffness_at_rest();
        StructureAtRest { structure, stiffness, mass: &self.mass, base: &self.base }
    }

    /// Largest damping of a translation along the ground, divided by the mass that it moves, r·C r / r·M r, 1/s.
    ///
    /// Of all parts and directions.
    pub(crate) fn drag(&self) -> f64 {
        let parts = self.influence.parts().iter();
        let vectors = parts.flat_map(|part| [&part.vectors[0], &part.vectors[2]]);
        let drags = vectors.filter(|vector| !vector.is_empty()).map(|vector| {
            let translation = spread(vector, self.dofs());
            let form = |matrix: &SparseMatrix| matrix.form(&translation, &translation);
            form(&self.damping) / form(&self.mass)
        });
        drags.fold(0.0, f64::max)
    }

    /// Largest inertia (kg) against the displacement of a single contact node.
    fn base_inertia(&self) -> f64 {
        let masses = self.mass.diagonal();
        let rows = self.base.nodes().iter().flat_map(BaseNode::rows).filter(|row| !row.is_empty());
        let inertia = rows.map(|row| {
            let square: f64 = row.iter().map(|(_, weight)| weight * weight).sum();
            row.iter().map(|&(i, weight)| masses[i] * (weight / square).powi(2)).sum()
        });
        inertia.fold(0.0, f64::max)
    }

    /// Stiffness of the springs at the contact nodes that hold the base.
    pub(super) fn spring(&self) -> f64 {
        stiffest(self.stiffness_at_rest())
            .max(self.base_inertia() / (MAX_SWAY_TIME * MAX_SWAY_TIME))
    }

    /// The influence vectors, and the factored stiffness with its base held.
    ///
    /// A rigid translation leaves K u = 0 and moves the contact nodes by one. It is therefore the solution r of
    /// (K + γ NᵀN) r = γ Nᵀ 1 for every γ, whatever the degrees of freedom mean. Displacements are stepped relative
    /// to rigid translations, so R must be exact at the base: N R is 1 or 0 to rounding, and then so is B R.
    fn find_influence(&self) -> Result<(Influence, SparseFactor)> {
        let stiffness = self.stiffness_at_rest();
        let n = self.dofs();
        let stiffest = stiffest(stiffness);
        let spring = self.spring();
        let springs = HeldBase::new(self.base.nodes(), stiffness, spring);
        let matrix = SparseMatrix::new(HeldBase::STIFFNESS_NAME, &springs.matrix)?;
        let is_condensed =
            self.linear && self.base.is_flexible() && !self.base.elements().has_walls();
        let ending =
            if is_condensed { self.elimination.ending_with(&self.base.dofs()) } else { None };
        let elimination = ending.as_ref().unwrap_or(&self.elimination);
        let factor =
            SparseFactor::with_elimination(HeldBase::STIFFNESS_NAME, &matrix, elimination)?;
        if self.linear && !factor.is_positive_definite() {
            check_signs(&self.base, self.matrices())?;
        }
        let pulls = springs.pulls().concat();
        let mut solution = vec![0.0; pulls.len()];
        for _ in 0..=INFLUENCE_REFINEMENT_COUNT {
            let mut residual = matrix.times(&solution);
            residual.iter_mut().zip(&pulls).for_each(|(r, pull)| *r = pull - *r);
            factor.solve_many(&mut residual);
            solution.iter_mut().zip(&residual).for_each(|(r, d)| *r += d);
        }
        if solution.iter().any(|r| !r.is_finite()) {
            return Err(Error::Singular { matrix: HeldBase::STIFFNESS_NAME, order: n });
        }
        let mut translations: Vec<_> = solution.chunks_exact(n).map(<[f64]>::to_vec).collect();
        let firmer = spring / stiffest;
        supports::check(stiffness, &self.mass, firmer, &self.base, &mut translations)?;
        let mut parts = Partition::new(n);
        for matrix in [stiffness, &*self.mass, &*self.damping] {
            parts.couple(matrix);
        }
        for (nodes, _) in self.base.foundations() {
            let mut dofs = nodes.iter().flat_map(BaseNode::dofs);
            if let Some(first) = dofs.next() {
                dofs.for_each(|dof| parts.join(first, dof));
            }
        }
        let roots: Vec<usize> = (0..n).map(|dof| parts.root(dof)).collect();
        let influence = Influence::split(&self.base, &translations, &roots);
        supports::check_parts(&influence, &self.base, n)?;
        Ok((influence, factor))
    }
}

/// Relative accuracy of a load factor.
const LOAD_FACTOR_ACCURACY: f64 = 1e-6;

/// A stiffness and the part of it that comes from the forces at rest.
pub(crate) struct LoadedStiffness<'a> {
    stiffness: &'a SparseMatrix,
    geometric: SparseMatrix,
}

impl<'a> LoadedStiffness<'a> {
    /// Parts of a structure's `stiffness`; `None` without P–Δ.
    pub(crate) fn new(structure: &dyn Structure, stiffness: &'a SparseMatrix) -> Option<Self> {
        let mut geometric = Triplets::new(structure.dofs());
        structure.geometric_stiffness(&mut geometric).ok()?;
        let geometric = SparseMatrix::new("geometric stiffness matrix", &geometric).ok()?;
        (!geometric.is_empty()).then_some(Self { stiffness, geometric })
    }

    /// Stiffness under `factor` times the forces at rest.
    pub(crate) fn at(&self, factor: f64) -> Result<SparseMatrix> {
        let terms = [(1.0, self.stiffness), (factor - 1.0, &self.geometric)];
        SparseMatrix::sum("stiffness matrix", self.stiffness.order(), &terms)
    }

    /// Smallest factor at which the structure does not stand, between 0 and `limit`.
    ///
    /// `stands` tells whether it does with a stiffness. `None` if it stands under `limit` times its forces at rest, or not
    /// even without them.
    pub(crate) fn factor(&self, limit: f64, stands: impl Fn(&SparseMatrix) -> bool) -> Option<f64> {
        let stands_at = |factor: f64| self.at(factor).is_ok_and(|stiffness| stands(&stiffness));
        if !stands_at(0.0) || stands_at(limit) {
            return None;
        }
        let mut low = 0.0;
        let mut high = limit;
        while high - low > LOAD_FACTOR_ACCURACY * high && high > f64::MIN_POSITIVE {
            let middle = 0.5 * (low + high);
            if stands_at(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(0.5 * (low + high))
    }
}
