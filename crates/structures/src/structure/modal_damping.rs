//! Damping ratios for each mode of a structure.

use std::f64::consts::TAU;

use super::rigid_motions::{check_rows, rigid_momenta};
use crate::error::{Error, Result, at_least, damping_ratio, require};
use crate::linalg::{Eigenpairs, SparseMatrix, dot, generalised_modes};
use crate::structure::matrix_checks::SYMMETRY_TOLERANCE;
use crate::structure::{
    MassAndStiffness, NonlinearForce, SpringSupportedBase, Structure, Triplets, mass_and_stiffness,
    max_diagonal_stiffness,
};

/// Damping ratios of a structure's modes; its rigid motions are not damped.
///
/// * [`on_fixed_base`](ModalDamping::on_fixed_base): modes on a fixed base, to which codes and tests refer. On a
///   compliant ground the structure contributes less damping to the first mode, since part of the deformation is in the
///   ground.
/// * [`on`](ModalDamping::on): modes of the structure alone, without ground: C = M Φ diag(2 ζ ω) Φᵀ M. They
///   are also modes of the damped structure, so that the structure can be stepped in modal coordinates
///   (`Coordinates::Modes`). Their frequencies are far above the
///   frequencies on a base, where the first mode gets much less than its ratio: 0.9 % instead of 5 % for five
///   storeys.
///
/// ```
/// use basemat::structure::{ModalDamping, ShearBuilding, Storey};
///
/// let storeys = [Storey::new(3.0, 20.0e3, 40.0e6); 5];
/// let building = ShearBuilding::new(10.0, 50.0e3, 4.0e5, &storeys)?;
/// // 5 % in the lowest mode, 3 % in the next and 2 % in all others
/// let damped = ModalDamping::new(&[0.05, 0.03, 0.02])?.on(building)?;
/// assert_eq!(damped.frequencies().len(), 5);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "ModalDampingForm"))]
pub struct ModalDamping {
    /// Damping ratios of the modes, ascending in frequency; all further modes have the last one.
    ratios: Vec<f64>,
}

validated! {
    ModalDamping as ModalDampingForm { ratios: Vec<f64> }
    => ModalDamping::new(&ratios)
}

/// A structure with [`ModalDamping`] in addition to its other damping.
pub struct WithModalDamping {
    structure: Box<dyn Structure>,
    /// Modal damping matrix C, row-major.
    damping: Vec<f64>,
    /// Frequencies ω/2π of the modes that are not rigid, Hz, ascending.
    frequencies: Vec<f64>,
}

short_debug! {
    WithModalDamping; self; dofs: self.structure.dofs(), frequencies: self.frequencies
}

/// Largest number of degrees of freedom: C is a full matrix.
const MAX_DAMPED_DOFS: usize = 3000;
/// A mode is rigid if rigid motions contain more than this fraction of its kinetic energy.
///
/// Eigenvalues do not distinguish rigid modes: their rounded values are small but arbitrary, and in fine meshes the
/// lowest modes that are not rigid have 10⁻¹² of the highest eigenvalue.
const MAX_RIGID_ENERGY_FRACTION: f64 = 0.5;
/// Stiffness of the springs under a fixed base, relative to the largest stiffness of the structure.
///
/// Frequencies on these springs differ by about a millionth from those on a rigid support.
const FIXED_BASE_STIFFNESS_RATIO: f64 = 1e6;
/// Values of 1/ω² below this fraction of the largest value are rounding.
///
/// They belong to modes of massless degrees of freedom.
const MASSLESS_EIGENVALUE_RATIO: f64 = 1e-13;
/// Fraction of a mode's elastic energy in the structure above which the mode deforms the structure.
///
/// In other modes the base moves on its springs.
const MIN_STRUCTURE_ENERGY: f64 = 0.5;
const UNSUITABLE_MATRICES: Error = Error::Scene {
    quantity: "structure with modal damping",
    needed: "must have symmetric matrices and mass at every degree of freedom (elements with density give mass to \
             rotations; damping on a fixed base needs none)",
};
const UNRESISTED_MOTION: Error = Error::Scene {
    quantity: "structure with modal damping",
    needed: "must resist every motion that is not rigid",
};

impl ModalDamping {
    /// Damping with the ratio ζ of each mode that is not rigid, from the lowest.
    ///
    /// The last ratio holds for all further modes.
    ///
    /// # Errors
    /// [`Error::Size`] without ratios, [`Error::Input`] unless all are from 0 to below 1.
    pub fn new(ratios: &[f64]) -> Result<Self> {
        at_least("list of damping ratios", ratios.len(), 1)?;
        for ratio in ratios {
            damping_ratio("damping ratio", *ratio)?;
        }
        Ok(Self { ratios: ratios.to_vec() })
    }

    /// Adds this damping to the modes of a structure on its fixed base.
    ///
    /// Codes and tests state ratios of these modes. Displacements are relative to the base: u − R N u, with the
    /// displacements N u of the contact nodes, and the static displacements R that unit displacements of these nodes
    /// cause. A mode φ of circular frequency ω, scaled to φᵀ M φ = 1, exerts the forces K φ, which do no work on rigid
    /// motions: C = Σ (2 ζ/ω³) K φ (K φ)ᵀ. Degrees of freedom may be massless. The stiffness of a nonlinear structure
    /// is its initial tangent.
    ///
    /// ```
    /// use basemat::structure::{ModalDamping, ShearBuilding, Storey};
    /// let building = ShearBuilding::new(8.0, 60.0e3, 4.0e5, &[Storey::new(3.0, 30.0e3, 60.0e6); 5])?;
    /// let damped = ModalDamping::new(&[0.05])?.on_fixed_base(building)?;
    /// assert!((damped.frequencies()[0] - 2.026).abs() < 1e-3);
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// As for [`ModalDamping::on`], except for massless degrees of freedom.
    pub fn on_fixed_base(&self, structure: impl Structure + 'static) -> Result<WithModalDamping> {
        let matrices = matrices(&structure)?;
        let stiffness = &matrices.stiffness;
        let nodes = structure.base().into_nodes();
        check_rows(&nodes, matrices.mass.order())?;
        let spring_stiffness = FIXED_BASE_STIFFNESS_RATIO * max_diagonal_stiffness(stiffness);
        let supported_base = SpringSupportedBase::new(&nodes, stiffness, spring_stiffness);
        let supported_stiffness =
            SparseMatrix::new(SpringSupportedBase::STIFFNESS_NAME, &supported_base.matrix)?;
        let Eigenpairs { values: eigenvalues, vectors: eigenvectors } =
            generalised_modes(&matrices.mass, &supported_stiffness).ok_or(UNRESISTED_MOTION)?;
        let mut damped_structure = WithModalDamping::new(structure);
        let max_eigenvalue = eigenvalues.last().copied().unwrap_or(0.0);
        let mut mode = vec![0.0; eigenvalues.len()];
        let mut force = vec![0.0; eigenvalues.len()];
        // Values are 1/ω², ascending, and modes have φᵀ(K + γ NᵀN)φ = 1.
        for (mode_index, eigenvalue) in eigenvalues.iter().enumerate().rev() {
            if *eigenvalue <= MASSLESS_EIGENVALUE_RATIO * max_eigenvalue {
                break;
            }
            copy_column(&eigenvectors, mode_index, &mut mode);
            force.fill(0.0);
            stiffness.multiply_add(1.0, &mode, &mut force);
            if dot(&mode, &force) > MIN_STRUCTURE_ENERGY {
                let circular_frequency = eigenvalue.sqrt().recip();
                let ratio = self.ratio(damped_structure.frequencies.len());
                damped_structure.add_mode(
                    circular_frequency,
                    2.0 * ratio / circular_frequency,
                    &force,
                );
            }
        }
        Ok(damped_structure)
    }

    /// Adds this damping to the modes of a structure without ground.
    ///
    /// The stiffness of a nonlinear structure is its initial tangent.
    ///
    /// # Errors
    /// [`Error::Input`] for more than 3000 degrees of freedom: reduce the structure by
    /// [`CraigBampton`](crate::structure::CraigBampton) first; [`Error::Scene`] when the matrices are not
    /// symmetric, the mass is not positive definite or a motion that is not rigid has no stiffness or a
    /// negative one; [`Error::Singular`] when the structure is a mechanism on fixed contact nodes; and errors
    /// of the matrix entries.
    pub fn on(&self, structure: impl Structure + 'static) -> Result<WithModalDamping> {
        let matrices = matrices(&structure)?;
        let Eigenpairs { values: eigenvalues, vectors: eigenvectors } =
            generalised_modes(&matrices.stiffness, &matrices.mass).ok_or(UNSUITABLE_MATRICES)?;
        let nodes = structure.base().into_nodes();
        let rigid_momenta = rigid_momenta(&nodes, &matrices.stiffness, &matrices.mass)?;
        let mut damped_structure = WithModalDamping::new(structure);
        let mut mode = vec![0.0; eigenvalues.len()];
        let mut momentum = vec![0.0; eigenvalues.len()];
        for (mode_index, eigenvalue) in eigenvalues.iter().enumerate() {
            copy_column(&eigenvectors, mode_index, &mut mode);
            let rigid_energies = rigid_momenta.iter().map(|rigid| dot(rigid, &mode).powi(2));
            if rigid_energies.sum::<f64>() > MAX_RIGID_ENERGY_FRACTION {
                continue;
            }
            if *eigenvalue <= 0.0 {
                return Err(UNRESISTED_MOTION);
            }
            let circular_frequency = eigenvalue.sqrt();
            momentum.fill(0.0);
            matrices.mass.multiply_add(1.0, &mode, &mut momentum);
            let ratio = self.ratio(damped_structure.frequencies.len());
            damped_structure.add_mode(
                circular_frequency,
                2.0 * ratio * circular_frequency,
                &momentum,
            );
        }
        Ok(damped_structure)
    }

    /// Damping ratio of a mode that is not rigid, counted from the lowest.
    fn ratio(&self, mode_index: usize) -> f64 {
        self.ratios[mode_index.min(self.ratios.len() - 1)]
    }
}

/// Mass and stiffness of a structure whose modes are to be damped.
///
/// Returns an error for too many degrees of freedom, or matrices that are not symmetric.
fn matrices(structure: &dyn Structure) -> Result<MassAndStiffness> {
    let n = structure.dofs();
    let is_small = n <= MAX_DAMPED_DOFS;
    let needed = "3000 or fewer: reduce it first";
    require("number of degrees of freedom with modal damping", n as f64, is_small, needed)?;
    let matrices = mass_and_stiffness(structure)?;
    if matrices.mass.asymmetry().max(matrices.stiffness.asymmetry()) > SYMMETRY_TOLERANCE {
        return Err(UNSUITABLE_MATRICES);
    }
    Ok(matrices)
}

/// Overwrites `vector` with column `j` of a square row-major matrix.
fn copy_column(matrix: &[f64], j: usize, vector: &mut [f64]) {
    let n = vector.len();
    vector.iter_mut().enumerate().for_each(|(i, entry)| *entry = matrix[i * n + j]);
}

impl WithModalDamping {
    fn new(structure: impl Structure + 'static) -> Self {
        let n = structure.dofs();
        Self {
            structure: Box::new(structure),
            damping: vec![0.0; n * n],
            frequencies: Vec::new(),
        }
    }

    /// Adds the damping factor × vector vectorᵀ of a mode; circular frequency in rad/s.
    fn add_mode(&mut self, circular_frequency: f64, factor: f64, vector: &[f64]) {
        self.frequencies.push(circular_frequency / TAU);
        for (row, a) in self.damping.chunks_exact_mut(vector.len()).zip(vector) {
            let row_factor = factor * a;
            row.iter_mut().zip(vector).for_each(|(entry, b)| *entry += row_factor * b);
        }
    }

    /// The structure without modal damping, with its present internal variables.
    ///
    /// A downcast of it to its type gives access to its results, such as
    /// [`FemModel::solid_points`](crate::structure::FemModel::solid_points).
    pub fn structure(&self) -> &dyn Structure {
        self.structure.as_ref()
    }

    /// Frequencies of the modes that are not rigid, Hz, ascending.
    pub fn frequencies(&self) -> &[f64] {
        &self.frequencies
    }
}

impl Structure for WithModalDamping {
    forward_structure! { self.structure }

    forward! {
        self.structure;
        fn stiffness(&self, matrix: &mut Triplets) -> Result<()>;
        fn nonlinear(&self) -> Option<&dyn NonlinearForce>;
        fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce>;
    }

    fn damping(&self, matrix: &mut Triplets) -> Result<()> {
        self.structure.damping(matrix)?;
        let n = self.structure.dofs().max(1);
        for (index, &value) in self.damping.iter().enumerate() {
            let row = index / n;
            let column = index % n;
            // The mean of mirrored entries makes the matrix symmetric to the last bit.
            matrix.add(row, column, 0.5 * (value + self.damping[column * n + row]));
        }
        Ok(())
    }
}
