//! Condensation of a large linear structure on its base (Guyan 1965), exact for static states.
//!
//! | symbol | meaning |
//! |---|---|
//! | K | stiffness; b: degrees of freedom of the base, i: all others |
//! | S | K_bb − K_bi K_ii⁻¹ K_ib |
//! | N, γ | displacements of the contact nodes, stiffness of the springs that fix them |
//! | ε, m | stiffness of soft springs per mass, mass at the contact nodes |
//!
//! If the base is eliminated last, the factor of K + γ NᵀN contains S + γ NᵀN. With the factor of S + εm in place of
//! S + γ NᵀN, it becomes the factor of K + εm.

use std::sync::Arc;

use crate::coupled::base::PlacedBase;
use crate::coupled::base::influence::UPWARD_DIRECTION;
use crate::coupled::model::assembled::Assembled;
use crate::error::Result;
use crate::linalg::{Elimination, SparseFactor, SparseMatrix, dense_multiply_add};
use crate::structure::{BaseNode, Triplets};

/// A structure condensed on the degrees of freedom of its base.
pub(crate) struct Condensed {
    /// The condensed structure.
    ///
    /// Its mass, equal at all contact nodes, acts as springs in the search for a static state.
    pub(crate) assembled: Assembled,
    /// Weight; empty without a static state.
    pub(crate) weight: Vec<f64>,
    /// Other loads at t = 0; empty without a static state.
    pub(crate) load: Vec<f64>,
    /// Degrees of freedom of the base, ascending.
    dofs: Vec<usize>,
    /// Factored K + γ NᵀN.
    fixed_factor: SparseFactor,
}

impl Condensed {
    /// Condenses a structure and its loads at t = 0.
    ///
    /// `fixed_factor` is the factored K + γ NᵀN. The result is `None` unless it eliminates the base last, and for an error of
    /// `weight_and_load`, which the static state returns again.
    pub(crate) fn new(
        whole_structure: &Assembled,
        fixed_factor: SparseFactor,
        weight_and_load: impl FnOnce() -> Result<[Vec<f64>; 2]>,
    ) -> Result<Option<Self>> {
        let dofs = whole_structure.base.dofs();
        let Some(mut stiffness) = fixed_factor.condensed(&dofs) else {
            return Ok(None);
        };
        let Ok(whole_forces) = weight_and_load() else { return Ok(None) };
        let order = dofs.len();
        let whole_dofs = whole_structure.dofs();
        let spring = whole_structure.base_spring_stiffness();
        let mut solutions = whole_forces.concat();
        fixed_factor.solve_many(&mut solutions);
        let mut responses = solutions.chunks_exact(whole_dofs);
        let [weight, load] = std::array::from_fn(|_| {
            let mut condensed_force = vec![0.0; order];
            if let Some(response) = responses.next() {
                let base_response: Vec<f64> = dofs.iter().map(|dof| response[*dof]).collect();
                dense_multiply_add(&stiffness, 1.0, &base_response, &mut condensed_force);
            }
            condensed_force
        });

        let base = renumbered(&dofs, &whole_structure.base);
        let mut mass = Triplets::new(order);
        let up = whole_structure.influence.whole_vector(UPWARD_DIRECTION, whole_dofs);
        let nodal_mass = whole_structure.mass.form(&up, &up) / base.nodes().len() as f64;
        for row in base.nodes().iter().flat_map(BaseNode::rows) {
            mass.add_outer(row, nodal_mass);
            for &(i, row_weight) in row {
                for &(j, column_weight) in row {
                    stiffness[i * order + j] -= spring * row_weight * column_weight;
                }
            }
        }
        let assembled = Assembled {
            is_linear: true,
            is_massive: false,
            mass: Arc::new(SparseMatrix::new("mass at the base", &mass)?),
            damping: Arc::new(SparseMatrix::new("damping at the base", &Triplets::new(order))?),
            stiffness: Arc::new(SparseMatrix::from_dense(order, stiffness)),
            tangent_stiffness: None,
            influence: Arc::new(whole_structure.influence.converted(|vector| {
                let condensed_term =
                    |&(dof, r): &(usize, f64)| Some((dofs.binary_search(&dof).ok()?, r));
                vector.iter().filter_map(condensed_term).collect()
            })),
            base,
            elimination: Elimination::default(),
        };
        Ok(Some(Self { assembled, weight, load, dofs, fixed_factor }))
    }

    /// Converts a base of the whole structure to the condensed degrees of freedom.
    pub(crate) fn condensed_base(&self, whole_base: &PlacedBase) -> PlacedBase {
        renumbered(&self.dofs, whole_base)
    }

    /// Entries of a displacement of the whole structure at the base.
    pub(crate) fn base_displacement(&self, whole_displacement: &[f64]) -> Vec<f64> {
        self.dofs.iter().map(|dof| whole_displacement[*dof]).collect()
    }

    /// Displacement of the whole structure under `force`, from the displacement of its base.
    ///
    /// A residual force at the base, such as rounding, remains.
    pub(crate) fn expanded(
        &self,
        whole_structure: &Assembled,
        base_displacement: &[f64],
        force: &[f64],
    ) -> Vec<f64> {
        let mut displacement = vec![0.0; force.len()];
        self.dofs.iter().zip(base_displacement).for_each(|(dof, u)| displacement[*dof] = *u);
        // In equilibrium the springs have no force. The second pass removes rounding.
        for _ in 0..2 {
            let mut correction = force.to_vec();
            whole_structure.stiffness.multiply_add(-1.0, &displacement, &mut correction);
            self.fixed_factor.solve_many(&mut correction);
            displacement.iter_mut().zip(&correction).for_each(|(u, d)| *u += d);
        }
        displacement
    }

    /// Factored K + εm, from the condensed matrix S + εm.
    ///
    /// `None` unless it is positive definite.
    pub(crate) fn shifted_factor(self, condensed_stiffness: &SparseMatrix) -> Option<SparseFactor> {
        let order = condensed_stiffness.order();
        let mut dense_matrix = vec![0.0; order * order];
        for (row, column, value) in condensed_stiffness.entries() {
            dense_matrix[row * order + column] = value;
        }
        self.fixed_factor.with_condensed(&self.dofs, &dense_matrix)
    }
}

/// Renumbers the degrees of freedom of a base by their indices in `dofs`.
fn renumbered(dofs: &[usize], whole_base: &PlacedBase) -> PlacedBase {
    whole_base.renumbered(|dof| dofs.binary_search(&dof).unwrap_or_default())
}
