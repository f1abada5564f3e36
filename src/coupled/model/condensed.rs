//! A large linear structure condensed on the degrees of freedom of its base (Guyan 1965): exact for static states.
//!
//! | symbol | meaning |
//! |---|---|
//! | K | stiffness; b: degrees of freedom of the base, i: all others |
//! | S | K_bb − K_bi K_ii⁻¹ K_ib |
//! | N, γ | displacements of the contact nodes, stiffness of the springs that hold them |
//! | ε, m | stiffness of soft springs per mass, mass at the contact nodes |
//!
//! The factor of K + γ NᵀN contains S + γ NᵀN, if the base is eliminated last. With the factor of S + εm in its place, it
//! is the factor of K + εm.

use std::sync::Arc;

use crate::coupled::base::PlacedBase;
use crate::coupled::base::influence::UPWARD_DIRECTION;
use crate::coupled::model::assembled::Assembled;
use crate::error::Result;
use crate::linalg::{Elimination, SparseFactor, SparseMatrix, dense_multiply_add};
use crate::structure::{BaseNode, Triplets};

/// A structure condensed on the degrees of freedom of its base.
pub(crate) struct Condensed {
    /// The structure; its mass, equal at all contact nodes, serves as springs in the search for a static state.
    pub(crate) assembled: Assembled,
    /// Weight and loads at t = 0; empty without a static state.
    pub(crate) loads: [Vec<f64>; 2],
    /// Degrees of freedom of the base, ascending.
    dofs: Vec<usize>,
    /// Factored K + γ NᵀN.
    fixed_factor: SparseFactor,
}

impl Condensed {
    /// Condenses a structure and its loads at t = 0.
    ///
    /// `held`: factored K + γ NᵀN. `None` unless it eliminates the base last, and for an error of `loads`, which the static
    /// state returns again.
    pub(crate) fn new(
        whole: &Assembled,
        fixed_factor: SparseFactor,
        loads: impl FnOnce() -> Result<[Vec<f64>; 2]>,
    ) -> Result<Option<Self>> {
        let dofs = whole.base.dofs();
        let Some(mut stiffness) = fixed_factor.condensed(&dofs) else {
            return Ok(None);
        };
        let Ok(loads) = loads() else { return Ok(None) };
        let order = dofs.len();
        let n = whole.dofs();
        let spring = whole.spring();
        let mut solved = loads.concat();
        fixed_factor.solve_many(&mut solved);
        let mut responses = solved.chunks_exact(n);
        let loads = std::array::from_fn(|_| {
            let mut load = vec![0.0; order];
            if let Some(response) = responses.next() {
                let on_base: Vec<f64> = dofs.iter().map(|dof| response[*dof]).collect();
                dense_multiply_add(&stiffness, 1.0, &on_base, &mut load);
            }
            load
        });

        let base = renumbered(&dofs, &whole.base);
        let mut mass = Triplets::new(order);
        let up = whole.influence.of(UPWARD_DIRECTION, n);
        let nodal_mass = whole.mass.form(&up, &up) / base.nodes().len() as f64;
        for row in base.nodes().iter().flat_map(BaseNode::rows) {
            mass.add_outer(row, nodal_mass);
            for (i, j) in row.iter().flat_map(|i| row.iter().map(move |j| (i, j))) {
                stiffness[i.0 * order + j.0] -= spring * i.1 * j.1;
            }
        }
        let assembled = Assembled {
            linear: true,
            is_massive: false,
            mass: Arc::new(SparseMatrix::new("mass at the base", &mass)?),
            damping: Arc::new(SparseMatrix::new("damping at the base", &Triplets::new(order))?),
            stiffness: Arc::new(SparseMatrix::from_dense(order, stiffness)),
            at_rest: None,
            influence: Arc::new(whole.influence.converted(|vector| {
                let place = |&(dof, r): &(usize, f64)| Some((dofs.binary_search(&dof).ok()?, r));
                vector.iter().filter_map(place).collect()
            })),
            base,
            elimination: Elimination::default(),
        };
        Ok(Some(Self { assembled, loads, dofs, fixed_factor }))
    }

    /// A base of the whole structure in the condensed degrees of freedom.
    pub(crate) fn base(&self, whole: &PlacedBase) -> PlacedBase {
        renumbered(&self.dofs, whole)
    }

    /// Displacements of the whole structure, at the base.
    pub(crate) fn on_base(&self, whole: &[f64]) -> Vec<f64> {
        self.dofs.iter().map(|dof| whole[*dof]).collect()
    }

    /// Displacements of the whole structure with these on its base, under `force`.
    ///
    /// A part that K does not move to equilibrium at the base, such as rounding, remains.
    pub(crate) fn expanded(&self, whole: &Assembled, on_base: &[f64], force: &[f64]) -> Vec<f64> {
        let mut displacement = vec![0.0; force.len()];
        self.dofs.iter().zip(on_base).for_each(|(dof, u)| displacement[*dof] = *u);
        // The springs have no force: the second pass removes rounding.
        for _ in 0..2 {
            let mut correction = force.to_vec();
            whole.stiffness.multiply_add(-1.0, &displacement, &mut correction);
            self.fixed_factor.solve_many(&mut correction);
            displacement.iter_mut().zip(&correction).for_each(|(u, d)| *u += d);
        }
        displacement
    }

    /// Factored K + εm, from S + εm; `None` unless it is positive definite.
    pub(crate) fn on_springs(self, on_base: &SparseMatrix) -> Option<SparseFactor> {
        let order = on_base.order();
        let mut dense = vec![0.0; order * order];
        on_base
            .entries()
            .for_each(|(row, column, value)| dense[row * order + column] = value);
        self.fixed_factor.with_condensed(&self.dofs, &dense)
    }
}

/// A base in the degrees of freedom `dofs`.
fn renumbered(dofs: &[usize], whole: &PlacedBase) -> PlacedBase {
    whole.renumbered(|dof| dofs.binary_search(&dof).unwrap_or_default())
}
