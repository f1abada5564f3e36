//! Reduction of a large structure to its contact nodes and a few modes.
//!
//! | symbol | meaning |
//! |---|---|
//! | b, i | kept (boundary) and interior degrees of freedom |
//! | Ψ | static responses of the interior to unit displacements of kept degrees of freedom, −K_ii⁻¹ K_ib |
//! | Φ | modes of the interior with the kept degrees of freedom fixed, Φᵀ M_ii Φ = 1 |
//! | T | u = T q, q = (u_b, modal coordinates) |

use std::sync::{Arc, Mutex, PoisonError};

use super::Recovery;
use super::dof_partition::DofPartition;
use super::recovery::Basis;
use crate::error::{Result, damping_ratio, require_part, same_length};
use crate::linalg::{SparseMatrix, dot};
use crate::structure::detached::{check_attached, dof_list_text};
use crate::structure::matrix_checks::{MASSLESS_FRACTION, check_mirrored};
use crate::structure::nonlinear::check_nonlinear_force;
use crate::structure::{Base, Structure, StructureDescription, Triplets};

/// Reduction to contact nodes, kept degrees of freedom and fixed-interface modes (Craig & Bampton 1968).
///
/// The modes belong to the interior degrees of freedom with the kept degrees of freedom fixed. Rigid motions, weight
/// and slow loads at the kept degrees of freedom are exact. Motion above the frequency of the highest mode
/// ([`ReducedModel::frequencies`]) is filtered out. A usual choice is modes up to twice the highest frequency of
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
    /// Number of modes.
    mode_count: usize,
    /// Degrees of freedom to keep beside the contact nodes.
    kept_dofs: Vec<usize>,
}

/// A structure after [`CraigBampton::reduce`].
///
/// Its degrees of freedom are the kept ones, in ascending order, then the coordinates of the modes.
/// [`recovery`](ReducedModel::recovery) computes the degrees of freedom of the full model.
pub struct ReducedModel {
    basis: Arc<Basis>,
    base: Base,
    /// Reduced matrices, row-major.
    mass: Vec<f64>,
    damping: Vec<f64>,
    stiffness: Vec<f64>,
    /// Whether `damping` may feed energy in.
    has_active_damping: bool,
    /// Circular frequencies of the modes, rad/s.
    circular_frequencies: Vec<f64>,
    /// Full model, whose loads are reduced in every step.
    full_model: Mutex<FullModel>,
}

/// Full model, and scratch for its load.
struct FullModel {
    structure: Box<dyn Structure>,
    load: Vec<f64>,
}

short_debug! {
    ReducedModel; self; dofs: self.basis.order(), frequencies: self.frequencies()
}

impl CraigBampton {
    /// Reduction to the contact nodes and to `mode_count` lowest modes.
    pub fn new(mode_count: usize) -> Self {
        Self { mode_count, kept_dofs: Vec::new() }
    }

    /// Also keeps these `dofs` unreduced.
    ///
    /// For example, springs on the reduced model ([`WithSprings`](crate::structure::WithSprings)) need them.
    #[must_use]
    pub fn keep(mut self, dofs: &[usize]) -> Self {
        self.kept_dofs.extend_from_slice(dofs);
        self
    }

    /// Reduces a linear structure.
    ///
    /// The damping matrix is reduced as the others; [`ReducedModel::with_damping_ratio`] replaces it. The reduction
    /// takes one sparse factorisation, and about two solves for each kept degree of freedom and mode. For each of these
    /// it stores one number for every degree of freedom of the full model.
    ///
    /// # Errors
    /// [`Error::Scene`](crate::Error::Scene) for a nonlinear structure,
    /// [`Error::Unsymmetric`](crate::Error::Unsymmetric) for matrices that are not symmetric,
    /// [`StructureError::Detached`](crate::structure::StructureError::Detached) for a part that no stiffness connects
    /// to a kept degree of freedom, [`Error::Index`](crate::Error::Index) for a kept degree of freedom that does not
    /// exist, [`Error::Size`](crate::Error::Size) for more modes than interior degrees of freedom,
    /// [`Error::Memory`](crate::Error::Memory) for a basis that does not fit into memory,
    /// [`Error::Singular`](crate::Error::Singular) when the interior is a mechanism with the kept degrees of freedom
    /// fixed, or its stiffness is not positive definite.
    pub fn reduce(&self, mut structure: impl Structure + 'static) -> Result<ReducedModel> {
        let n = structure.dofs();
        let needed = "must be linear: add springs to the reduced model, and do not reduce elements with internal variables";
        check_nonlinear_force(&mut structure)?;
        require_part("structure to be reduced", structure.nonlinear().is_none(), needed)?;
        let mut triplets = Triplets::new(n);
        let mass = symmetric_matrix("mass matrix", &mut triplets, &|m| structure.mass(m))?;
        let stiffness =
            symmetric_matrix("stiffness matrix", &mut triplets, &|m| structure.stiffness(m))?;
        let damping = symmetric_matrix("damping matrix", &mut triplets, &|m| structure.damping(m))?;
        drop(triplets);

        let mut base = structure.base();
        let partition = DofPartition::new(n, &base, &self.kept_dofs)?;
        check_attached(&structure, &stiffness, &mass, &partition.kept_dofs)?;
        let interior_count = partition.interior.len();
        same_length(
            "list of fixed-interface modes",
            self.mode_count,
            self.mode_count.min(interior_count),
        )?;
        let (basis_rows, squared_frequencies) =
            partition.basis(&stiffness, &mass, self.mode_count)?;
        let basis = Basis::new(partition.kept_dofs.clone(), basis_rows, n);
        let order = basis.order();
        let kept_count = partition.kept_dofs.len();
        for node in base.nodes_mut() {
            node.map_rows(|row| partition.renumbered(row));
        }
        let mut model = ReducedModel {
            mass: basis.congruence(&mass),
            damping: without_rounding(basis.congruence(&damping), &basis, &damping),
            stiffness: basis.congruence(&stiffness),
            base,
            circular_frequencies: squared_frequencies
                .iter()
                .map(|squared_frequency| squared_frequency.sqrt())
                .collect(),
            has_active_damping: structure.has_active_damping(),
            full_model: Mutex::new(FullModel {
                load: vec![0.0; n],
                structure: Box::new(structure),
            }),
            basis: Arc::new(basis),
        };
        // Modes and static responses are K-orthogonal: entries between them are rounding.
        for (mode, squared_frequency) in squared_frequencies.iter().enumerate() {
            for j in 0..order {
                model.stiffness[(kept_count + mode) * order + j] = 0.0;
                model.stiffness[j * order + kept_count + mode] = 0.0;
            }
            model.stiffness[(kept_count + mode) * (order + 1)] = *squared_frequency;
        }
        Ok(model)
    }
}

/// Assembles a matrix; returns an error unless it is symmetric.
fn symmetric_matrix(
    name: &'static str,
    triplets: &mut Triplets,
    fill: &dyn Fn(&mut Triplets) -> Result<()>,
) -> Result<SparseMatrix> {
    let matrix = SparseMatrix::assembled(name, triplets, fill)?;
    check_mirrored(name, &matrix)?;
    Ok(matrix)
}

impl ReducedModel {
    /// Frequencies of the modes with the kept degrees of freedom fixed, Hz, ascending.
    ///
    /// There are fewer modes than requested by [`CraigBampton::new`] only if fewer degrees of freedom have mass.
    pub fn frequencies(&self) -> Vec<f64> {
        self.circular_frequencies
            .iter()
            .map(|circular| circular / std::f64::consts::TAU)
            .collect()
    }

    /// Recovery of the full model's degrees of freedom.
    ///
    /// A clone remains usable after the model moves into a simulation.
    pub fn recovery(&self) -> Recovery {
        Recovery::new(Arc::clone(&self.basis))
    }

    /// Replaces the damping by this damping ratio in every mode.
    ///
    /// The kept degrees of freedom are fixed in the modes. Their static responses are not damped.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) unless it is from 0 to below 1.
    pub fn with_damping_ratio(mut self, ratio: f64) -> Result<Self> {
        damping_ratio("damping ratio", ratio)?;
        self.damping.fill(0.0);
        self.has_active_damping = false;
        let order = self.basis.order();
        let kept_count = order - self.circular_frequencies.len();
        for (mode, circular_frequency) in self.circular_frequencies.iter().enumerate() {
            self.damping[(kept_count + mode) * (order + 1)] = 2.0 * ratio * circular_frequency;
        }
        Ok(self)
    }
}

/// The reduced damping matrix with exact zeros for undamped motions, which are usually rigid.
///
/// For these motions, cancellation leaves entries of either sign. They may be larger than the damping of modes, which
/// has another unit.
fn without_rounding(
    mut reduced_damping: Vec<f64>,
    basis: &Basis,
    full_damping: &SparseMatrix,
) -> Vec<f64> {
    let order = basis.order();
    for (i, motion) in basis.rows().enumerate() {
        let terms = full_damping
            .entries()
            .map(|(row, column, c)| (motion[row] * c * motion[column]).abs());
        if reduced_damping[i * (order + 1)] <= MASSLESS_FRACTION * terms.sum::<f64>() {
            for j in 0..order {
                reduced_damping[i * order + j] = 0.0;
                reduced_damping[j * order + i] = 0.0;
            }
        }
    }
    reduced_damping
}

/// Adds the nonzero entries of a dense row-major matrix to `matrix`.
fn add_dense(entries: &[f64], order: usize, matrix: &mut Triplets) {
    for (index, &value) in entries.iter().enumerate() {
        if value != 0.0 {
            matrix.add(index / order, index % order, value);
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
        add_dense(&self.mass, self.dofs(), matrix);
        Ok(())
    }

    fn mass_at_rest(&self) -> Result<Option<Vec<f64>>> {
        let full_model = self.full_model.lock().unwrap_or_else(PoisonError::into_inner);
        let full_masses = full_model.structure.mass_at_rest()?;
        Ok(full_masses.map(|masses| self.basis.rows().map(|row| dot(row, &masses)).collect()))
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        add_dense(&self.stiffness, self.dofs(), matrix);
        Ok(())
    }

    fn damping(&self, matrix: &mut Triplets) -> Result<()> {
        add_dense(&self.damping, self.dofs(), matrix);
        Ok(())
    }

    fn geometric_stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        let full_model = self.full_model.lock().unwrap_or_else(PoisonError::into_inner);
        let mut triplets = Triplets::new(full_model.structure.dofs());
        full_model.structure.geometric_stiffness(&mut triplets)?;
        if !triplets.entries().is_empty() {
            let geometric_stiffness = SparseMatrix::new("geometric stiffness matrix", &triplets)?;
            add_dense(&self.basis.congruence(&geometric_stiffness), self.dofs(), matrix);
        }
        Ok(())
    }

    fn has_active_damping(&self) -> bool {
        self.has_active_damping
    }

    fn has_active_stiffness(&self) -> bool {
        let full_model = self.full_model.lock().unwrap_or_else(PoisonError::into_inner);
        full_model.structure.has_active_stiffness()
    }

    fn description(&self) -> StructureDescription {
        let full_model = self.full_model.lock().unwrap_or_else(PoisonError::into_inner);
        full_model.structure.description()
    }

    /// Text of the full model for kept degrees of freedom.
    ///
    /// The first mode is named by its index.
    fn describe(&self, dofs: &[usize]) -> Option<String> {
        let full_model = self.full_model.lock().unwrap_or_else(PoisonError::into_inner);
        let kept_dofs = self.basis.kept_dofs();
        let full_dofs: Vec<usize> =
            dofs.iter().filter_map(|dof| kept_dofs.get(*dof).copied()).collect();
        let mut texts = Vec::new();
        if !full_dofs.is_empty() {
            let description = full_model.structure.describe(&full_dofs);
            texts.push(description.unwrap_or_else(|| dof_list_text(&full_dofs)));
        }
        if let Some(dof) = dofs.iter().find(|&&dof| dof >= kept_dofs.len()) {
            texts.push(format!("mode {} of the reduction", dof - kept_dofs.len()));
        }
        (!texts.is_empty()).then(|| texts.join("; "))
    }

    /// Adds the load of the full model on the reduced degrees of freedom.
    fn load(&self, time: f64, load: &mut [f64]) -> Result<()> {
        let mut full_model = self.full_model.lock().unwrap_or_else(PoisonError::into_inner);
        let FullModel { structure, load: full_load } = &mut *full_model;
        full_load.fill(0.0);
        structure.load(time, full_load)?;
        if full_load.iter().any(|force| *force != 0.0) {
            for (reduced_force, row) in load.iter_mut().zip(self.basis.rows()) {
                *reduced_force += dot(row, full_load);
            }
        }
        Ok(())
    }
}
