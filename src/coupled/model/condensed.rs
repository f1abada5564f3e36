//! A large linear structure condensed on the degrees of freedom of its base (Guyan 1965): exact for static states.
//!
//! | symbol | meaning |
//! |---|---|
//! | K | stiffness; b: degrees of freedom of the base, i: all others |
//! | S | K_bb − K_bi K_ii⁻¹ K_ib |
//! | N, γ | displacements of the contact nodes, stiffness of the springs that hold them |
//!
//! The factor of K + γ NᵀN contains S + γ NᵀN, if the base is eliminated last.

use std::sync::Arc;

use crate::coupled::base::PlacedBase;
use crate::coupled::base::influence::UP;
use crate::coupled::model::assembled::Assembled;
use crate::error::Result;
use crate::linalg::{Elimination, SparseFactor, SparseMatrix, dense_multiply_add};
use crate::structure::{BaseNode, Triplets};

/// A structure condensed on the degrees of freedom of its base.
pub(crate) struct Condensed {
    /// The structure; its mass, equal at all contact nodes, serves as springs in the search for a static state.
    pub(crate) assembled: Assembled,
    /// Degrees of freedom of the base, ascending.
    dofs: Vec<usize>,
}

impl Condensed {
    /// Condenses a structure and the forces `loads`, of which it returns these on the base.
    ///
    /// `held`: factored K + γ NᵀN. `None` unless it eliminates the base last.
    pub(crate) fn new(
        whole: &Assembled,
        held: &SparseFactor,
        loads: &[Vec<f64>; 2],
    ) -> Result<Option<(Self, [Vec<f64>; 2])>> {
        let dofs = whole.base.dofs();
        let Some(mut stiffness) = held.condensed(&dofs) else { return Ok(None) };
        let (order, n, spring) = (dofs.len(), whole.dofs(), whole.spring());
        let mut solved = loads.concat();
        held.solve_many(&mut solved);
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
        let up = whole.influence.of(UP, n);
        let share = whole.mass.form(&up, &up) / base.nodes().len() as f64;
        for row in base.nodes().iter().flat_map(BaseNode::rows) {
            mass.add_outer(row, share);
            for (i, j) in row.iter().flat_map(|i| row.iter().map(move |j| (i, j))) {
                stiffness[i.0 * order + j.0] -= spring * i.1 * j.1;
            }
        }
        let assembled = Assembled {
            linear: true,
            is_massive: false,
            mass: Arc::new(SparseMatrix::new("mass at the base", &mass)?),
            damping: Arc::new(SparseMatrix::new("damping at the base", &Triplets::new(order))?),
            stiffness: Arc::new(SparseMatrix::full(order, stiffness)),
            at_rest: None,
            influence: Arc::new(whole.influence.converted(|vector| {
                let place = |&(dof, r): &(usize, f64)| Some((dofs.binary_search(&dof).ok()?, r));
                vector.iter().filter_map(place).collect()
            })),
            base,
            elimination: Elimination::default(),
        };
        Ok(Some((Self { assembled, dofs }, loads)))
    }

    /// A base of the whole structure in the condensed degrees of freedom.
    pub(crate) fn base(&self, whole: &PlacedBase) -> PlacedBase {
        renumbered(&self.dofs, whole)
    }

    /// Displacements of the whole structure, at the base.
    pub(crate) fn on_base(&self, whole: &[f64]) -> Vec<f64> {
        self.dofs.iter().map(|dof| whole[*dof]).collect()
    }
}

/// A base in the degrees of freedom `dofs`.
fn renumbered(dofs: &[usize], whole: &PlacedBase) -> PlacedBase {
    whole.renumbered(|dof| dofs.binary_search(&dof).unwrap_or_default())
}
