//! Damping given mode by mode.

use super::rigid_motions::rigid_momenta;
use crate::error::{Error, Result, damping_ratio};
use crate::linalg::{SparseMatrix, dot, generalised_modes};
use crate::structure::matrix_checks::SYMMETRIC;
use crate::structure::{ContactNode, NonlinearForce, Structure, Triplets};

/// Damping ratios of a structure's own modes: C = M Φ diag(2 ζ ω) Φᵀ M.
///
/// The modes are those of the structure by itself, without ground; its rigid motions have no
/// frequency and are not damped. They stay the modes of the damped structure, so that it can be
/// stepped in them ([`Coordinates::Modes`](crate::coupled::Coordinates::Modes)).
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
    ratios: Vec<f64>,
}

validated! {
    ModalDamping as ModalDampingForm { ratios: Vec<f64> }
    => ModalDamping::new(&ratios)
}

/// A structure with the damping of [`ModalDamping`] beside its own.
pub struct WithModalDamping {
    structure: Box<dyn Structure>,
    /// C, row-major.
    damping: Vec<f64>,
    /// ω/2π of the modes that are not rigid, ascending.
    frequencies: Vec<f64>,
}

short_debug! {
    WithModalDamping; self; dofs: self.structure.dofs(), frequencies: self.frequencies
}

/// Most degrees of freedom: C is a full matrix.
const MOST: usize = 3000;
/// A mode with more of its momentum in rigid motions is one. Their eigenvalues do not tell: rounding
/// leaves them anything small, and in fine meshes the lowest modes that are not rigid are 10⁻¹² of
/// the highest.
const RIGID: f64 = 0.5;

impl ModalDamping {
    /// Damping with the ratio ζ of each mode that is not rigid, from the lowest; the last ratio is
    /// that of all further ones.
    ///
    /// # Errors
    /// [`Error::Size`] without ratios, [`Error::Input`] unless all are from 0 to below 1.
    pub fn new(ratios: &[f64]) -> Result<Self> {
        if ratios.is_empty() {
            return Err(Error::Size { quantity: "list of damping ratios", found: 0, needed: 1 });
        }
        for ratio in ratios {
            damping_ratio("damping ratio", *ratio)?;
        }
        Ok(Self { ratios: ratios.to_vec() })
    }

    /// Gives this damping to a structure. A nonlinear one is taken with its first tangent.
    ///
    /// # Errors
    /// [`Error::Input`] for more than 3000 degrees of freedom, of which a
    /// [`CraigBampton`](crate::structure::CraigBampton) reduction leaves fewer; [`Error::Scene`] when the matrices
    /// are not symmetric, the mass is not positive definite or a motion that is not rigid meets no
    /// stiffness or a negative one; [`Error::Singular`] when contact nodes at rest do not hold the
    /// structure; and what is wrong with the entries.
    pub fn on(&self, structure: impl Structure + 'static) -> Result<WithModalDamping> {
        let n = structure.dofs();
        if n > MOST {
            let (quantity, value) = ("number of degrees of freedom with modal damping", n as f64);
            return Err(Error::Input { quantity, value, needed: "3000 or fewer: reduce it first" });
        }
        let mass = SparseMatrix::assembled("mass matrix", n, &|matrix| structure.mass(matrix))?;
        let stiffness = SparseMatrix::assembled("stiffness matrix", n, &|matrix| {
            structure.stiffness(matrix)?;
            structure.nonlinear().map_or(Ok(()), |force| force.tangent(&vec![0.0; n], matrix))
        })?;
        let scene = Error::Scene {
            quantity: "structure with modal damping",
            needed: "must have symmetric matrices and a positive definite mass",
        };
        if mass.asymmetry().max(stiffness.asymmetry()) > SYMMETRIC {
            return Err(scene);
        }
        let (values, vectors) = generalised_modes(&stiffness, &mass).ok_or(scene)?;
        let momenta = rigid_momenta(&structure.contact_nodes(), &stiffness, &mass)?;
        let mut damping = vec![0.0; n * n];
        let mut frequencies = Vec::new();
        let (mut mode, mut momentum) = (vec![0.0; n], vec![0.0; n]);
        for (j, value) in values.iter().enumerate() {
            for (i, entry) in mode.iter_mut().enumerate() {
                *entry = vectors[i * n + j];
            }
            if momenta.iter().map(|momentum| dot(momentum, &mode).powi(2)).sum::<f64>() > RIGID {
                continue;
            }
            if *value <= 0.0 {
                let needed = "must resist every motion that is not rigid";
                return Err(Error::Scene { quantity: "structure with modal damping", needed });
            }
            let last = self.ratios.len() - 1;
            let ratio = self.ratios[frequencies.len().min(last)];
            let circular = value.sqrt();
            frequencies.push(circular / std::f64::consts::TAU);
            momentum.fill(0.0);
            mass.multiply_add(1.0, &mode, &mut momentum);
            for (row, a) in damping.chunks_exact_mut(n).zip(&momentum) {
                let factor = 2.0 * ratio * circular * a;
                row.iter_mut().zip(&momentum).for_each(|(entry, b)| *entry += factor * b);
            }
        }
        Ok(WithModalDamping { structure: Box::new(structure), damping, frequencies })
    }
}

impl WithModalDamping {
    /// Frequencies of the modes that are not rigid, Hz, ascending.
    pub fn frequencies(&self) -> &[f64] {
        &self.frequencies
    }
}

impl Structure for WithModalDamping {
    forward! {
        self.structure;
        fn dofs(&self) -> usize;
        fn contact_nodes(&self) -> Vec<ContactNode>;
        fn foundation_ends(&self) -> Vec<usize>;
        fn mass(&self, matrix: &mut Triplets) -> Result<()>;
        fn stiffness(&self, matrix: &mut Triplets) -> Result<()>;
        fn has_active_damping(&self) -> bool;
        fn describe(&self, dofs: &[usize]) -> Option<String>;
        fn load(&self, time: f64, load: &mut [f64]) -> Result<()>;
        fn nonlinear(&self) -> Option<&dyn NonlinearForce>;
        fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce>;
    }

    fn damping(&self, matrix: &mut Triplets) -> Result<()> {
        self.structure.damping(matrix)?;
        let n = self.structure.dofs().max(1);
        for (place, &value) in self.damping.iter().enumerate() {
            // a b and b a round alike: the matrix stays symmetric to the last bit.
            matrix.add(
                place / n,
                place % n,
                0.5 * (value + self.damping[place % n * n + place / n]),
            );
        }
        Ok(())
    }
}
