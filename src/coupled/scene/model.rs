//! The structure's matrices, assembled once, in the coordinates in which they are stepped.

use std::sync::Arc;

use super::base::Base;
use super::influence::Influence;
use super::mechanism::{AtRest, unresisted};
use super::modal_basis::ModalBasis;
use crate::error::{Error, Result, StandingError, same_length};
use crate::linalg::matrix::{Diagonals, Matrix};
use crate::linalg::{SparseMatrix, indefinite_row};
use crate::structure::{
    InternalEnergy, Structure, Triplets, check_attached, check_damping, check_mass,
};

/// Times in nanoseconds that choose the coordinates, as measured by `benches/studies/benches/step.rs`.
mod cost {
    /// Per entry of a sparse factor or matrix and use.
    pub(super) const SPARSE_ENTRY: f64 = 1.0;
    /// Per mode and step, more than an unknown costs.
    pub(super) const MODE: f64 = 1.0;
    /// Per mode, contact component and step, more than unknowns cost.
    pub(super) const MODE_AND_CONTACT: f64 = 0.2;
    /// Per cubed number of modes, once.
    pub(super) const MODES: f64 = 3.0;
}

/// Springs that hold the base and constraints where they must not give way, relative to the largest
/// stiffness.
const HELD: f64 = 1e6;
/// Remainder of a zero after assembly and factors, relative to the diagonal and to the largest stiffness.
const ROUNDING: f64 = 1e-12;

/// Assembled matrices of a structure and its influence vectors.
pub(crate) struct Model {
    /// Unknowns of the structure, and the number of coordinates that are stepped.
    pub(crate) unknowns: usize,
    pub(crate) coordinates: usize,
    pub(crate) mass: Matrix,
    pub(crate) damping: Matrix,
    pub(crate) stiffness: Matrix,
    pub(crate) linear: bool,
    /// Whether any damping coefficient is not zero.
    pub(crate) damped: bool,
    /// Influence vectors in the coordinates that are stepped.
    pub(crate) influence: Arc<Influence>,
    /// The modes, if they are the coordinates.
    pub(crate) modes: Option<Arc<ModalBasis>>,
    /// A motion of a linear structure that nothing resists while its base is at rest.
    free_motion: Option<Box<StandingError>>,
}

impl Model {
    pub(crate) fn new(structure: &dyn Structure, linear: bool, base: &Base) -> Result<Self> {
        let unknowns = structure.unknowns();
        if unknowns == 0 {
            return Err(Error::Size { quantity: "list of unknowns", found: 0, needed: 1 });
        }
        let assemble = |name, fill: &dyn Fn(&mut Triplets) -> Result<()>| {
            SparseMatrix::assembled(name, unknowns, fill)
        };
        let mass = assemble("mass matrix", &|m| structure.mass(m))?;
        check_mass(&mass)?;
        let damping = assemble("damping matrix", &|m| structure.damping(m))?;
        if !structure.has_active_damping() {
            check_damping(&damping)?;
        }
        let stiffness = assemble("stiffness matrix", &|m| structure.stiffness(m))?;
        let mut model = Self {
            unknowns,
            coordinates: unknowns,
            mass: Matrix::Sparse(mass),
            damping: Matrix::Sparse(damping),
            stiffness: Matrix::Sparse(stiffness),
            linear,
            damped: false,
            influence: Arc::default(),
            modes: None,
            free_motion: None,
        };
        model.damped = !model.damping.is_empty();
        let mut tangent = Tangent::new(unknowns);
        tangent.refill(structure, &vec![0.0; unknowns])?;
        let mut at_rest = Triplets::new(unknowns);
        model.stiffness.add_to(1.0, &mut at_rest);
        tangent.matrix.add_to(1.0, &mut at_rest);
        let at_rest = SparseMatrix::new("stiffness matrix", &at_rest)?;
        if let Some([mass, damping, _]) = model.sparse() {
            check_attached(structure, &at_rest, mass, &base.unknowns())?;
            let check_sign = |tie| if linear { model.check_stiffness(base, tie) } else { Ok(()) };
            let influence = Influence::new(base, &at_rest, [mass, damping], &check_sign);
            let held = AtRest { structure, stiffness: &at_rest, mass: &model.mass, base };
            // A mechanism fails in one way or another, as rounding has it, but never by its sign.
            let influence = influence.map_err(|error| match error {
                Error::Indefinite { .. } => error,
                _ => held.mechanism().map_or(error, |cause| Error::Standing(Box::new(cause))),
            })?;
            let free = if linear { held.free_motion() } else { None };
            model.free_motion = free.map(Box::new);
            model.influence = Arc::new(influence);
        }
        Ok(model)
    }

    /// What to say of `error`, that the effective stiffness has no factors.
    pub(crate) fn cause(
        &self,
        structure: &dyn Structure,
        tangent: &SparseMatrix,
        error: Error,
    ) -> Error {
        let Some([_, _, stiffness]) = self.sparse() else { return error };
        let mut sum = Triplets::new(self.unknowns);
        stiffness.add_to(1.0, &mut sum);
        tangent.add_to(1.0, &mut sum);
        let sum = SparseMatrix::new("stiffness matrix", &sum).ok();
        let found = sum.and_then(|sum| unresisted(structure, &sum, [&self.damping, &self.mass]));
        found.map_or(error, |cause| Error::Standing(Box::new(cause)))
    }

    /// Refuses a mechanism. Call it after the check of conditioning: stiffnesses too far apart for double
    /// precision look like one.
    pub(crate) fn refuse_mechanism(&self) -> Result<()> {
        self.free_motion.clone().map_or(Ok(()), |cause| Err(Error::Standing(cause)))
    }

    /// The three matrices, while they are sparse: mass, damping, stiffness.
    pub(crate) fn sparse(&self) -> Option<[&SparseMatrix; 3]> {
        match (&self.mass, &self.damping, &self.stiffness) {
            (Matrix::Sparse(mass), Matrix::Sparse(damping), Matrix::Sparse(stiffness)) => {
                Some([mass, damping, stiffness])
            }
            _ => None,
        }
    }

    /// The three matrices, once they are diagonal.
    pub(crate) fn diagonals(&self) -> Option<Diagonals<'_>> {
        match (&self.mass, &self.damping, &self.stiffness) {
            (Matrix::Diagonal(mass), Matrix::Diagonal(damping), Matrix::Diagonal(stiffness)) => {
                let damping = self.damped.then_some(damping.as_slice());
                Some(Diagonals { mass, damping, stiffness })
            }
            _ => None,
        }
    }

    /// Whether stepping in modes takes less time, their computation included. `factor` is the
    /// number of entries of the sparse factor, `contact` that of contact components.
    pub(crate) fn modes_save_time(&self, factor: usize, contact: usize, steps: usize) -> bool {
        let Some([mass, damping, stiffness]) = self.sparse() else { return false };
        let n = self.unknowns as f64;
        let matrices = 2 * (mass.stored() + damping.stored() + stiffness.stored());
        let sparse = cost::SPARSE_ENTRY * (2 * factor + matrices) as f64;
        let modal = cost::MODE * n + cost::MODE_AND_CONTACT * n * contact as f64;
        self.linear && modal * steps as f64 + cost::MODES * n.powi(3) < sparse * steps as f64
    }

    /// Goes over to modal coordinates.
    pub(crate) fn decouple(&mut self, modes: Arc<ModalBasis>) {
        let mut influence = Influence::clone(&self.influence);
        if let Some([mass, _, _]) = self.sparse() {
            influence.map(|vector| modes.coordinates(vector, mass));
        }
        self.influence = Arc::new(influence);
        self.mass = Matrix::Diagonal(vec![1.0; modes.count()]);
        self.coordinates = modes.count();
        self.damping = Matrix::Diagonal(modes.damping.clone());
        self.damped = !self.damping.is_empty();
        self.stiffness = Matrix::Diagonal(modes.stiffness.clone());
        self.modes = Some(modes);
    }

    /// Adds the external load at `time`, weight excepted, minus `at_start`, to `load`, and returns
    /// whether there is any; `scratch` has an entry for every unknown. An error is the structure's.
    pub(crate) fn load(
        &self,
        structure: &dyn Structure,
        time: f64,
        at_start: &[f64],
        scratch: &mut [f64],
        load: &mut [f64],
    ) -> Result<bool> {
        scratch.fill(0.0);
        structure.load(time, scratch)?;
        let mut differs = false;
        for (now, at_start) in scratch.iter_mut().zip(at_start) {
            *now -= at_start;
            // Without a branch, for the vector units; NaN differs.
            differs |= *now != 0.0;
        }
        if !differs {
            return Ok(false);
        }
        match &self.modes {
            Some(modes) => modes.project(scratch, load),
            None => load.iter_mut().zip(scratch).for_each(|(load, now)| *load += *now),
        }
        Ok(true)
    }

    /// f and its energies at a displacement; zero and unknown for a linear structure.
    pub(crate) fn nonlinear_state(
        &self,
        structure: &dyn Structure,
        displacement: &[f64],
    ) -> Result<(Vec<f64>, Option<InternalEnergy>)> {
        let mut force = vec![0.0; self.unknowns];
        let Some(own) = structure.nonlinear() else { return Ok((force, None)) };
        own.force(displacement, &mut force)?;
        Ok((force, own.energy(displacement)))
    }

    /// Refuses a symmetric K that is not positive semi-definite where the base is held.
    fn check_stiffness(&self, base: &Base, tie: f64) -> Result<()> {
        const NAME: &str = "stiffness matrix with its base held";
        let Some([_, _, stiffness]) = self.sparse() else { return Ok(()) };
        let matrix = SparseMatrix::new(NAME, &base.held(stiffness, HELD * tie).0)?;
        if matrix.asymmetry() > ROUNDING {
            return Ok(());
        }
        let multipliers = self.multipliers(&matrix);
        let constrained = constrain(NAME, &matrix, &multipliers, HELD * tie)?;
        match indefinite_row(&constrained, ROUNDING, ROUNDING * tie) {
            Some(row) => {
                let diagonal = self.stiffness.diagonal()[row];
                Err(Error::Indefinite { matrix: NAME, row, diagonal })
            }
            None => Ok(()),
        }
    }

    /// Which unknowns are Lagrange multipliers: forces that enter others' equations and whose own
    /// equation is a constraint. Zeros are exact: a multiplier with the least mass m, on a coupling
    /// c with a mass M, grows at the rate √(c / √(m M)).
    fn multipliers(&self, stiffness: &SparseMatrix) -> Vec<bool> {
        let mut multipliers: Vec<bool> = stiffness.diagonal().iter().map(|k| *k == 0.0).collect();
        for matrix in self.sparse().iter().flat_map(|[mass, damping, _]| [mass, damping]) {
            for (row, column, value) in matrix.entries() {
                if value != 0.0 {
                    multipliers[row] = false;
                    multipliers[column] = false;
                }
            }
        }
        multipliers
    }
}

/// The tangent ∂f/∂u of the nonlinear force; empty for a linear structure.
pub(crate) struct Tangent {
    pub(crate) matrix: SparseMatrix,
    entries: Triplets,
}

impl Tangent {
    pub(crate) fn new(unknowns: usize) -> Self {
        Self { matrix: SparseMatrix::default(), entries: Triplets::new(unknowns) }
    }

    /// Goes to the tangent at a displacement; allocates only for entries at new places.
    pub(crate) fn refill(&mut self, structure: &dyn Structure, displacement: &[f64]) -> Result<()> {
        const NAME: &str = "tangent of the nonlinear force";
        self.entries.clear();
        if let Some(own) = structure.nonlinear() {
            own.tangent(displacement, &mut self.entries)?;
            same_length(NAME, self.entries.order(), displacement.len())?;
        }
        if self.matrix.order() != displacement.len() || !self.matrix.refill(&self.entries) {
            self.matrix = SparseMatrix::new(NAME, &self.entries)?;
        }
        Ok(())
    }
}

/// A symmetric matrix with a spring of stiffness `penalty` in place of each Lagrange multiplier, on
/// the sum of unknowns that this keeps at zero.
fn constrain(
    name: &'static str,
    matrix: &SparseMatrix,
    multipliers: &[bool],
    penalty: f64,
) -> Result<SparseMatrix> {
    let mut constrained = Triplets::new(matrix.order());
    let mut constraints = vec![Vec::new(); matrix.order()];
    for (row, column, value) in matrix.entries() {
        match (multipliers[row], multipliers[column]) {
            (false, false) => constrained.add(row, column, value),
            (true, false) => constraints[row].push((column, value)),
            _ => {}
        }
    }
    for mut constraint in constraints {
        let largest = constraint.iter().fold(0.0, |m: f64, (_, c)| m.max(c.abs()));
        if largest > 0.0 {
            for (_, c) in &mut constraint {
                *c /= largest;
            }
            constrained.add_outer(&constraint, penalty);
        }
    }
    SparseMatrix::new(name, &constrained)
}
