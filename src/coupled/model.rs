//! The structure's matrices, assembled once, in the coordinates in which they are stepped.

use std::sync::Arc;

use super::base::Base;
use super::coordinates::Modes;
use super::ride;
use crate::error::{Error, Result, same_length};
use crate::linalg::{SparseFactor, SparseMatrix, indefinite_row, largest};
use crate::matrix::Matrix;
use crate::structure::{
    InternalEnergy, Structure, Triplets, check_attached, check_damping, check_mass,
};

/// Times in nanoseconds that choose the coordinates, as measured by `benches/step.rs`.
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
/// What assembly and factors leave of a zero, relative to the diagonal and to the largest stiffness.
const ROUNDING: f64 = 1e-12;

/// Assembled matrices of a structure, and how it rides with the ground.
pub(crate) struct Model {
    pub(crate) structure: Box<dyn Structure>,
    pub(crate) unknowns: usize,
    pub(crate) mass: Matrix,
    pub(crate) damping: Matrix,
    pub(crate) stiffness: Matrix,
    pub(crate) linear: bool,
    /// Coordinates when base and structure ride 1 m to the right and 1 m up.
    pub(crate) ride: [Vec<f64>; 2],
    /// The modes, if they are the coordinates.
    pub(crate) modes: Option<Arc<Modes>>,
    /// Whether K must be spared the displacement of the ride: see [`Model::spare`].
    rides_freely: bool,
    tangent: Triplets,
}

impl Model {
    pub(crate) fn new(structure: Box<dyn Structure>, base: &Base) -> Result<Self> {
        let unknowns = structure.unknowns();
        if unknowns == 0 {
            return Err(Error::Size { quantity: "list of unknowns", found: 0, needed: 1 });
        }
        let assemble =
            |name, fill: &dyn Fn(&mut Triplets)| SparseMatrix::assembled(name, unknowns, fill);
        let mass = assemble("mass matrix", &|m| structure.mass(m))?;
        check_mass(&mass)?;
        let damping = assemble("damping matrix", &|m| structure.damping(m))?;
        if !structure.has_active_damping() {
            check_damping(&damping)?;
        }
        let stiffness = assemble("stiffness matrix", &|m| structure.stiffness(m))?;
        let linear = structure.is_linear();
        let mut model = Self {
            structure,
            unknowns,
            mass: Matrix::Sparse(mass),
            damping: Matrix::Sparse(damping),
            stiffness: Matrix::Sparse(stiffness),
            linear,
            ride: [vec![0.0; unknowns], vec![0.0; unknowns]],
            modes: None,
            rides_freely: false,
            tangent: Triplets::new(unknowns),
        };
        model.ride = model.rigid_ride(base)?;
        model.rides_freely = model.ride.iter().all(|ride| {
            let mut force = vec![0.0; unknowns];
            model.stiffness.multiply_add(1.0, ride, &mut force);
            largest(&force) <= 1e-9 * model.stiffness.largest() * largest(ride)
        });
        Ok(model)
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
    pub(crate) fn decouple(&mut self, modes: Arc<Modes>) {
        for ride in &mut self.ride {
            // u = Φ q and Φᵀ M Φ = 1: q = Φᵀ M u.
            let mut momentum = vec![0.0; self.unknowns];
            self.mass.multiply_add(1.0, ride, &mut momentum);
            ride.fill(0.0);
            modes.project(&momentum, ride);
        }
        self.mass = Matrix::Diagonal(vec![1.0; self.unknowns]);
        self.damping = Matrix::Diagonal(modes.damping.clone());
        self.stiffness = Matrix::Diagonal(modes.stiffness.clone());
        self.modes = Some(modes);
    }

    /// Whether [`Model::spare`] does anything.
    pub(crate) fn needs_sparing(&self) -> bool {
        self.rides_freely && self.modes.is_none()
    }

    /// Takes a ride off a displacement before K acts on it. A ride strains nothing, but in
    /// unknowns K would only find that out by cancellation, with an error that grows with the
    /// stiffness times the displacement. In modes it has no stiffness to begin with.
    pub(crate) fn spare(&self, displacement: &mut [f64], ride: [f64; 2]) {
        if self.needs_sparing() {
            let [horizontal, vertical] = &self.ride;
            for ((u, h), v) in displacement.iter_mut().zip(horizontal).zip(vertical) {
                *u -= h * ride[0] + v * ride[1];
            }
        }
    }

    /// Adds the external load at `time`, weight excepted, minus `at_start`, to `load`; `scratch`
    /// has an entry for every unknown.
    pub(crate) fn load(&self, time: f64, at_start: &[f64], scratch: &mut [f64], load: &mut [f64]) {
        scratch.fill(0.0);
        self.structure.load(time, scratch);
        for (now, at_start) in scratch.iter_mut().zip(at_start) {
            *now -= at_start;
        }
        match &self.modes {
            Some(modes) => modes.project(scratch, load),
            None => load.iter_mut().zip(scratch).for_each(|(load, now)| *load += *now),
        }
    }

    /// f and its energies at a displacement; zero and unknown for a linear structure.
    pub(crate) fn nonlinear_state(
        &self,
        displacement: &[f64],
    ) -> (Vec<f64>, Option<InternalEnergy>) {
        let mut force = vec![0.0; self.unknowns];
        if self.linear {
            return (force, None);
        }
        self.structure.nonlinear_force(displacement, &mut force);
        (force, self.structure.nonlinear_energy(displacement))
    }

    /// ∂f/∂u at a displacement.
    pub(crate) fn tangent(&mut self, displacement: &[f64]) -> Result<SparseMatrix> {
        let mut tangent = SparseMatrix::default();
        self.refill_tangent(displacement, &mut tangent)?;
        Ok(tangent)
    }

    /// Overwrites `tangent` with ∂f/∂u at a displacement; allocates only for entries at new places.
    pub(crate) fn refill_tangent(
        &mut self,
        displacement: &[f64],
        tangent: &mut SparseMatrix,
    ) -> Result<()> {
        const NAME: &str = "tangent of the nonlinear force";
        self.tangent.clear();
        if !self.linear {
            self.structure.nonlinear_tangent(displacement, &mut self.tangent);
            same_length(NAME, self.tangent.order(), self.unknowns)?;
        }
        if tangent.order() != self.unknowns || !tangent.refill(&self.tangent) {
            *tangent = SparseMatrix::new(NAME, &self.tangent)?;
        }
        Ok(())
    }

    /// A rigid ride leaves K u = 0 and moves the contact nodes by one: (K + γ NᵀN) r = γ Nᵀ 1 has
    /// it as its solution for every γ, with no knowledge of what each unknown means. Where K resists
    /// the ride, the nodes lag behind: such a ride would not weigh the structure.
    fn rigid_ride(&mut self, base: &Base) -> Result<[Vec<f64>; 2]> {
        let n = self.unknowns;
        let at_rest = vec![0.0; n];
        let tangent = self.tangent(&at_rest)?;
        let mut matrix = Triplets::new(n);
        self.stiffness.add_to(1.0, &mut matrix);
        tangent.add_to(1.0, &mut matrix);
        let untied = SparseMatrix::new("stiffness matrix", &matrix)?;
        if let Matrix::Sparse(mass) = &self.mass {
            check_attached(self.structure.as_ref(), &untied, mass, &base.unknowns())?;
        }
        let stiffest = largest(&untied.diagonal());
        let tie = if stiffest > 0.0 { stiffest } else { 1.0 };
        let [mut horizontal, mut vertical] = [vec![0.0; n], vec![0.0; n]];
        base.tie_nodes(tie, &mut matrix, [&mut horizontal, &mut vertical]);
        let name = "stiffness matrix with its base held";
        let mut factor = SparseFactor::new(name, &matrix)?;
        if self.linear && !factor.is_positive_definite() {
            self.check_stiffness(base, tie)?;
        }
        factor.solve(&mut horizontal);
        factor.solve(&mut vertical);
        if horizontal.iter().chain(&vertical).any(|r| !r.is_finite()) {
            return Err(Error::Singular { matrix: name, order: n });
        }
        let ride = [horizontal, vertical];
        ride::check(&untied, &ride, base.ride_error(&ride))?;
        Ok(ride)
    }

    /// Refuses a symmetric K that is not positive semi-definite where the base is held.
    fn check_stiffness(&self, base: &Base, tie: f64) -> Result<()> {
        const NAME: &str = "stiffness matrix with its base held";
        let mut matrix = Triplets::new(self.unknowns);
        self.stiffness.add_to(1.0, &mut matrix);
        let [mut horizontal, mut vertical] = [(); 2].map(|()| vec![0.0; self.unknowns]);
        base.tie_nodes(HELD * tie, &mut matrix, [&mut horizontal, &mut vertical]);
        let matrix = SparseMatrix::new(NAME, &matrix)?;
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
