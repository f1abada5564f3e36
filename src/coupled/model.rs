//! The structure's matrices, assembled once.

use super::base::Base;
use crate::error::{Error, Result, same_length};
use crate::linalg::{SparseFactor, SparseMatrix};
use crate::structure::{Structure, Triplets};

/// Assembled matrices of a structure, and how it rides with the ground.
pub(crate) struct Model {
    pub(crate) structure: Box<dyn Structure>,
    pub(crate) unknowns: usize,
    pub(crate) mass: SparseMatrix,
    pub(crate) damping: SparseMatrix,
    pub(crate) stiffness: SparseMatrix,
    pub(crate) linear: bool,
    /// Unknowns when base and structure ride 1 m to the right and 1 m up.
    pub(crate) ride: [Vec<f64>; 2],
    tangent: Triplets,
}

impl Model {
    pub(crate) fn new(structure: Box<dyn Structure>, base: &Base) -> Result<Self> {
        let unknowns = structure.unknowns();
        if unknowns == 0 {
            return Err(Error::Size { quantity: "list of unknowns", found: 0, needed: 1 });
        }
        let assemble = |name, fill: &dyn Fn(&mut Triplets)| {
            let mut triplets = Triplets::new(unknowns);
            fill(&mut triplets);
            same_length(name, triplets.order(), unknowns)?;
            SparseMatrix::new(name, &triplets)
        };
        let mass = assemble("mass matrix", &|m| structure.mass(m))?;
        let damping = assemble("damping matrix", &|m| structure.damping(m))?;
        let stiffness = assemble("stiffness matrix", &|m| structure.stiffness(m))?;
        let linear = structure.is_linear();
        let mut model = Self {
            structure,
            unknowns,
            mass,
            damping,
            stiffness,
            linear,
            ride: [vec![0.0; unknowns], vec![0.0; unknowns]],
            tangent: Triplets::new(unknowns),
        };
        model.ride = model.rigid_ride(base)?;
        Ok(model)
    }

    /// K + ∂f/∂u at `u` with weights, for the caller to add to.
    pub(crate) fn tangent(&mut self, displacement: &[f64]) -> Result<SparseMatrix> {
        self.tangent.clear();
        if !self.linear {
            self.structure.nonlinear_tangent(displacement, &mut self.tangent);
            same_length("tangent of the nonlinear force", self.tangent.order(), self.unknowns)?;
        }
        SparseMatrix::new("tangent of the nonlinear force", &self.tangent)
    }

    /// A rigid ride leaves K u = 0 and moves the contact nodes by one: (K + γ NᵀN) r = γ Nᵀ 1 has
    /// it as its solution for every γ, with no knowledge of what each unknown means.
    fn rigid_ride(&mut self, base: &Base) -> Result<[Vec<f64>; 2]> {
        let n = self.unknowns;
        let at_rest = vec![0.0; n];
        let tangent = self.tangent(&at_rest)?;
        let mut matrix = SparseMatrix::combine(n, &[(1.0, &self.stiffness), (1.0, &tangent)]);
        let diagonal = |m: &Triplets| {
            m.entries().iter().filter(|(i, j, _)| i == j).fold(0.0_f64, |a, e| a.max(e.2.abs()))
        };
        let stiffness = diagonal(&matrix);
        let tie = if stiffness > 0.0 { stiffness } else { 1.0 };
        let [mut horizontal, mut vertical] = [vec![0.0; n], vec![0.0; n]];
        base.tie_nodes(tie, &mut matrix, [&mut horizontal, &mut vertical]);
        let name = "stiffness matrix with its base held";
        let mut factor = SparseFactor::new(name, &matrix)?;
        factor.solve(&mut horizontal);
        factor.solve(&mut vertical);
        if horizontal.iter().chain(&vertical).any(|r| !r.is_finite()) {
            return Err(Error::Singular { matrix: name, order: n });
        }
        Ok([horizontal, vertical])
    }
}
