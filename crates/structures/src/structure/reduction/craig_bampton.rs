//! Reduction of a large structure to its contact nodes and a few modes.
//!
//! | symbol | meaning |
//! |---|---|
//! | b, i | kept (boundary) and interior degrees of freedom |
//! | Ψ | static responses of the interior to unit kept degrees of freedom, −K_ii⁻¹ K_ib |
//! | Φ | modes of the interior with the kept degrees of freedom held, Φᵀ M_ii Φ = 1 |
//! | T | u = T q, q = (u_b, modal coordinates) |

use std::sync::{Arc, Mutex, PoisonError};

use super::Recovery;
use super::recovery::Basis;
use crate::error::{
    Error, Result, at_least, damping_ratio, in_bounds, memory, require_part, same_length,
};
use crate::linalg::{Eigenpairs, SparseFactor, SparseMatrix, dot, lowest_modes};
use crate::structure::detached::{check_attached, numbers, restricted};
use crate::structure::matrix_checks::{MASSLESS_FRACTION, check_mirrored};
use crate::structure::nonlinear::is_nonlinear;
use crate::structure::{Base, BaseNode, DofCombination, Structure, StructureDescription, Triplets};

/// Reduction to contact nodes, kept degrees of freedom and fixed-interface modes (Craig & Bampton 1968).
///
/// The modes belong to the other degrees of freedom with the kept ones held. Rigid motions, weight and slow loads
/// at the kept degrees of freedom pass exactly. Motion faster than the highest mode
/// ([`ReducedModel::frequencies`]) is cut off. A usual choice is modes up to twice the highest frequency of
/// interest.
///
/// ```
/// use basemat::fem::{Direction, Layer, Material, Mesh};
/// use basemat::structure::{CraigBampton, FemModel, Structure};
///
/// let material = Material::new(3.0e9, 0.2, 2400.0)?;
/// let mesh = Mesh::layered_block(-5.0..5.0, 8, &[Layer::new(20.0, 16, material)])?;
/// let model = FemModel::on_base(mesh)?;
/// let roof = model.row(model.mesh().node_at(0.0, 20.0)?, Direction::X)?;
/// assert_eq!(model.dofs(), 306);
///
/// let reduced = CraigBampton::new(12).reduce(model)?;
/// assert_eq!(reduced.dofs(), 2 * 9 + 12);
/// // A probe on a degree of freedom that the reduction has removed:
/// let row = reduced.recovery().row(roof)?;
/// assert_eq!(row.len(), 30);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CraigBampton {
    modes: usize,
    kept: Vec<usize>,
}

/// A structure after [`CraigBampton::reduce`].
///
/// Its degrees of freedom are the kept ones, in ascending order, then the coordinates of the modes.
/// [`recovery`](ReducedModel::recovery) computes the degrees of freedom of the full model.
pub struct ReducedModel {
    basis: Arc<Basis>,
    base: Base,
    /// Row-major, of the order of the reduced model.
    mass: Vec<f64>,
    damping: Vec<f64>,
    stiffness: Vec<f64>,
    /// Whether `damping` may feed energy in.
    active: bool,
    /// Circular frequencies of the modes, rad/s.
    frequencies: Vec<f64>,
    load: Mutex<FullLoad>,
}

/// Full model, which computes its loads, and scratch for them.
struct FullLoad {
    structure: Box<dyn Structure>,
    values: Vec<f64>,
}

short_debug! {
    ReducedModel; self; dofs: self.basis.order(), frequencies: self.frequencies()
}

impl CraigBampton {
    /// Reduction to contact nodes and the lowest `modes` modes.
    pub fn new(modes: usize) -> Self {
        Self { modes, kept: Vec::new() }
    }

    /// Also keeps these `dofs` unreduced.
    ///
    /// Springs on the reduced model need them, for example ([`WithSprings`](crate::structure::WithSprings)).
    #[must_use]
    pub fn keep(mut self, dofs: &[usize]) -> Self {
        self.kept.extend_from_slice(dofs);
        self
    }

    /// Reduces a linear structure.
    ///
    /// Damping is reduced as it is; [`ReducedModel::with_damping_ratio`] replaces it. The reduction takes one
    /// sparse factorisation and about two solves for each kept degree of freedom and mode. For each of them it
    /// stores a number per degree of freedom of the full model.
    ///
    /// # Errors
    /// [`Error::Scene`] for a nonlinear structure, [`Error::Unsymmetric`] for matrices that are not symmetric,
    /// [`StructureError::Detached`](crate::structure::StructureError::Detached) for a part that no stiffness joins to a kept degree of freedom, [`Error::Index`] for a
    /// kept degree of freedom that does not exist, [`Error::Size`] for more modes than degrees of freedom are
    /// left, [`Error::Singular`] when the kept degrees of freedom do not hold the rest or the stiffness of the
    /// rest is not positive.
    pub fn reduce(&self, mut structure: impl Structure + 'static) -> Result<ReducedModel> {
        let n = structure.dofs();
        let needed = "must be linear: put springs on the reduced model";
        require_part("structure to be reduced", !is_nonlinear(&mut structure)?, needed)?;
        let mut triplets = Triplets::new(n);
        let mass = mirrored_matrix("mass matrix", &mut triplets, &|m| structure.mass(m))?;
        let stiffness =
            mirrored_matrix("stiffness matrix", &mut triplets, &|m| structure.stiffness(m))?;
        let damping = mirrored_matrix("damping matrix", &mut triplets, &|m| structure.damping(m))?;
        drop(triplets);

        let mut base = structure.base();
        let parts = DofPartition::new(n, &base, &self.kept)?;
        check_attached(&structure, &stiffness, &mass, &parts.kept)?;
        let interior = parts.interior.len();
        same_length("list of fixed-interface modes", self.modes, self.modes.min(interior))?;
        let (basis_rows, squares) = parts.basis(&stiffness, &mass, self.modes)?;
        let basis = Basis::new(parts.kept.clone(), basis_rows, n);
        let order = basis.order();
        let kept = parts.kept.len();
        for node in base.nodes_mut() {
            node.map_rows(|row| parts.renumbered(row));
        }
        let mut model = ReducedModel {
            mass: basis.congruence(&mass),
            damping: without_rounding(basis.congruence(&damping), &basis, &damping),
            stiffness: basis.congruence(&stiffness),
            base,
            frequencies: squares.iter().map(|square| square.sqrt()).collect(),
            active: structure.has_active_damping(),
            load: Mutex::new(FullLoad { values: vec![0.0; n], structure: Box::new(structure) }),
            basis: Arc::new(basis),
        };
        // Modes and static responses are K-orthogonal: entries between them are rounding.
        for (k, square) in squares.iter().enumerate() {
            for j in 0..order {
                model.stiffness[(kept + k) * order + j] = 0.0;
                model.stiffness[j * order + kept + k] = 0.0;
            }
            model.stiffness[(kept + k) * (order + 1)] = *square;
        }
        Ok(model)
    }
}

/// Assembled matrix; an error unless it is symmetric.
fn mirrored_matrix(
    name: &'static str,
    triplets: &mut Triplets,
    fill: &dyn Fn(&mut Triplets) -> Result<()>,
) -> Result<SparseMatrix> {
    let matrix = SparseMatrix::assembled(name, triplets, fill)?;
    check_mirrored(name, &matrix)?;
    Ok(matrix)
}

/// Kept and interior degrees of freedom.
struct DofPartition {
    kept: Vec<usize>,
    interior: Vec<usize>,
    /// Place of each degree of freedom in its list.
    place: Vec<usize>,
    is_kept: Vec<bool>,
}

impl DofPartition {
    fn new(n: usize, base: &Base, more: &[usize]) -> Result<Self> {
        let of_base = base.nodes().flat_map(BaseNode::rows).flatten();
        let mut is_kept = vec![false; n];
        for index in of_base.map(|&(index, _)| index).chain(more.iter().copied()) {
            is_kept[in_bounds("degree of freedom to be kept", index, n)?] = true;
        }
        let mut kept = Vec::new();
        let mut interior = Vec::new();
        let mut place = Vec::with_capacity(n);
        for (dof, is_kept) in is_kept.iter().enumerate() {
            let list = if *is_kept { &mut kept } else { &mut interior };
            place.push(list.len());
            list.push(dof);
        }
        at_least("list of kept degrees of freedom", kept.len(), 1)?;
        Ok(Self { kept, interior, place, is_kept })
    }

    fn renumbered(&self, row: &DofCombination) -> DofCombination {
        row.map_dofs(|index| self.place[index])
    }

    /// A_ii.
    fn inner(&self, name: &'static str, matrix: &SparseMatrix) -> Result<SparseMatrix> {
        restricted(name, matrix, self.interior.len(), |dof| {
            (!self.is_kept[dof]).then_some(self.place[dof])
        })
    }

    /// The rows of Tᵀ, and the squared circular frequencies of the modes.
    fn basis(
        &self,
        stiffness: &SparseMatrix,
        mass: &SparseMatrix,
        modes: usize,
    ) -> Result<(Vec<f64>, Vec<f64>)> {
        const MATRIX_NAME: &str = "stiffness matrix with the kept degrees of freedom held";
        let n = self.place.len();
        let ni = self.interior.len();
        let nb = self.kept.len();
        let kept = (nb + modes.min(ni)) as f64;
        memory::check(
            "degrees of freedom and modes of the reduction",
            kept,
            24.0 * kept * n as f64,
        )?;
        let mut rows = vec![0.0; nb * n];
        for (k, &dof) in self.kept.iter().enumerate() {
            rows[k * n + dof] = 1.0;
        }
        if ni == 0 {
            return Ok((rows, Vec::new()));
        }
        let interior_stiffness = self.inner(MATRIX_NAME, stiffness)?;
        let factor = SparseFactor::positive_definite(MATRIX_NAME, &interior_stiffness)?;
        let mut static_responses = vec![0.0; nb * ni];
        for (row, column, value) in stiffness.entries() {
            if !self.is_kept[row] && self.is_kept[column] {
                static_responses[self.place[column] * ni + self.place[row]] -= value;
            }
        }
        factor.solve_many(&mut static_responses);
        let interior_mass =
            self.inner("mass matrix with the kept degrees of freedom held", mass)?;
        let Eigenpairs { values: squares, vectors: shapes } =
            lowest_modes(&factor, &interior_mass, modes, None)
                .ok_or(Error::Singular { matrix: MATRIX_NAME, order: ni })?;
        rows.resize((nb + squares.len()) * n, 0.0);
        let inner = static_responses.chunks_exact(ni).chain(shapes.chunks_exact(ni));
        for (row, values) in rows.chunks_exact_mut(n).zip(inner) {
            for (&dof, value) in self.interior.iter().zip(values) {
                row[dof] = *value;
            }
        }
        if rows.iter().all(|value| value.is_finite()) {
            Ok((rows, squares))
        } else {
            Err(Error::Singular { matrix: MATRIX_NAME, order: ni })
        }
    }
}

impl ReducedModel {
    /// Frequencies of the modes with the kept degrees of freedom held, Hz, ascending.
    ///
    /// There are fewer modes than given to [`CraigBampton::new`] only if fewer degrees of freedom have mass.
    pub fn frequencies(&self) -> Vec<f64> {
        self.frequencies.iter().map(|frequency| frequency / std::f64::consts::TAU).collect()
    }

    /// Recovery of the full model's degrees of freedom.
    ///
    /// It can be cloned, and kept when a simulation owns the model.
    pub fn recovery(&self) -> Recovery {
        Recovery::new(Arc::clone(&self.basis))
    }

    /// Replaces the damping by this damping ratio in every mode.
    ///
    /// The kept degrees of freedom are held in the modes. Motions of the kept degrees of freedom alone are not
    /// damped.
    ///
    /// # Errors
    /// [`Error::Input`] unless it is from 0 to below 1.
    pub fn with_damping_ratio(mut self, ratio: f64) -> Result<Self> {
        damping_ratio("damping ratio", ratio)?;
        self.damping.fill(0.0);
        self.active = false;
        let order = self.basis.order();
        let kept = order - self.frequencies.len();
        for (k, frequency) in self.frequencies.iter().enumerate() {
            self.damping[(kept + k) * (order + 1)] = 2.0 * ratio * frequency;
        }
        Ok(self)
    }
}

/// The reduced damping matrix with exact zeros for motions that nothing damps.
///
/// Such motions are usually rigid. Cancellation leaves entries of either sign, which may be large beside the
/// damping of modes, since modes have another unit.
fn without_rounding(mut reduced: Vec<f64>, basis: &Basis, full: &SparseMatrix) -> Vec<f64> {
    let order = basis.order();
    for (i, motion) in basis.rows().enumerate() {
        let terms = full.entries().map(|(row, column, c)| (motion[row] * c * motion[column]).abs());
        if reduced[i * (order + 1)] <= MASSLESS_FRACTION * terms.sum::<f64>() {
            for j in 0..order {
                reduced[i * order + j] = 0.0;
                reduced[j * order + i] = 0.0;
            }
        }
    }
    reduced
}

/// Adds the nonzero entries of a dense row-major matrix.
fn add(values: &[f64], order: usize, matrix: &mut Triplets) {
    for (place, &value) in values.iter().enumerate() {
        if value != 0.0 {
            matrix.add(place / order, place % order, value);
        }
    }
}

impl Structure for ReducedModel {
    fn dofs(&self) -> usize {
        self.basis.order()
    }

    fn base(&self) -> Base {
        self.base.clone()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        add(&self.mass, self.dofs(), matrix);
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        add(&self.stiffness, self.dofs(), matrix);
        Ok(())
    }

    fn damping(&self, matrix: &mut Triplets) -> Result<()> {
        add(&self.damping, self.dofs(), matrix);
        Ok(())
    }

    fn geometric_stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        let full = self.load.lock().unwrap_or_else(PoisonError::into_inner);
        let mut triplets = Triplets::new(full.structure.dofs());
        full.structure.geometric_stiffness(&mut triplets)?;
        if !triplets.entries().is_empty() {
            let geometric = SparseMatrix::new("geometric stiffness matrix", &triplets)?;
            add(&self.basis.congruence(&geometric), self.dofs(), matrix);
        }
        Ok(())
    }

    fn has_active_damping(&self) -> bool {
        self.active
    }

    fn has_active_stiffness(&self) -> bool {
        let full = self.load.lock().unwrap_or_else(PoisonError::into_inner);
        full.structure.has_active_stiffness()
    }

    fn description(&self) -> StructureDescription {
        let full = self.load.lock().unwrap_or_else(PoisonError::into_inner);
        full.structure.description()
    }

    /// Kept degrees of freedom as the full model describes them, and modes by number.
    fn describe(&self, dofs: &[usize]) -> Option<String> {
        let full = self.load.lock().unwrap_or_else(PoisonError::into_inner);
        let kept = self.basis.kept();
        let full_dofs: Vec<usize> = dofs.iter().filter_map(|dof| kept.get(*dof).copied()).collect();
        let mut texts = Vec::new();
        if !full_dofs.is_empty() {
            let text = full.structure.describe(&full_dofs);
            texts.push(text.unwrap_or_else(|| numbers(&full_dofs)));
        }
        if let Some(dof) = dofs.iter().find(|&&dof| dof >= kept.len()) {
            texts.push(format!("mode {} of the reduction", dof - kept.len()));
        }
        (!texts.is_empty()).then(|| texts.join("; "))
    }

    /// The load of the full model on the reduced degrees of freedom.
    fn load(&self, time: f64, load: &mut [f64]) -> Result<()> {
        let mut full = self.load.lock().unwrap_or_else(PoisonError::into_inner);
        let FullLoad { structure, values } = &mut *full;
        values.fill(0.0);
        structure.load(time, values)?;
        if values.iter().any(|force| *force != 0.0) {
            for (sum, row) in load.iter_mut().zip(self.basis.rows()) {
                *sum += dot(row, values);
            }
        }
        Ok(())
    }
}
