//! Nonlinear internal forces of structures.

use super::{Structure, Triplets};
use crate::error::{CheckpointError, Error, Result, same_length};
use crate::fem::internal_energy::InternalEnergy;
use crate::linalg::matrix::SparseMatrix;

/// The nonlinear force f(u) of a structure, beyond K u.
///
/// Implement this trait for yielding materials, nonlinear geometry or impacts. A [`Structure`] returns it by
/// [`Structure::nonlinear`] and [`Structure::nonlinear_mut`]. Force, tangent and energy belong to a trial
/// `displacement` on a path from the last **committed** displacement; these methods change no state.
/// [`commit`](NonlinearForce::commit) accepts the end of a step. Force and tangent are evaluated at the time at which
/// the time scheme enforces equilibrium (midpoint rule: the middle of the step), at every iterate of Newton's method.
///
/// ```
/// use basemat::structure::{Base, NonlinearForce, RigidBlock, Structure, Triplets};
/// use basemat::Result;
///
/// /// A block that carries a mass on a hardening spring: 1 MN/m and 10 GN/m³.
/// struct TunedMass(RigidBlock);
///
/// impl Structure for TunedMass {
///     fn dofs(&self) -> usize {
///         self.0.dofs() + 1
///     }
///     fn base(&self) -> Base {
///         self.0.base()
///     }
///     fn mass(&self, matrix: &mut Triplets) -> Result<()> {
///         matrix.add(3, 3, 2.0e3);
///         self.0.mass(matrix)
///     }
///     fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
///         matrix.add_outer(&[(0, -1.0), (3, 1.0)], 1.0e6);
///         Ok(())
///     }
///     fn nonlinear(&self) -> Option<&dyn NonlinearForce> {
///         Some(self)
///     }
///     fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce> {
///         Some(self)
///     }
/// }
///
/// impl NonlinearForce for TunedMass {
///     fn force(&self, u: &[f64], force: &mut [f64]) -> Result<()> {
///         let hardening = 1.0e10 * (u[3] - u[0]).powi(3);
///         force[3] += hardening;
///         force[0] -= hardening;
///         Ok(())
///     }
///     fn tangent(&self, u: &[f64], matrix: &mut Triplets) -> Result<()> {
///         matrix.add_outer(&[(0, -1.0), (3, 1.0)], 3.0e10 * (u[3] - u[0]).powi(2));
///         Ok(())
///     }
///     // Elastic, without internal variables.
///     fn save(&self) -> Result<Vec<f64>> {
///         Ok(Vec::new())
///     }
/// }
///
/// let tuned = TunedMass(RigidBlock::new(4.0, 6.0, 2000.0)?);
/// let mut force = [0.0; 4];
/// tuned.force(&[0.0, 0.0, 0.0, 0.01], &mut force)?;
/// assert!((force[3] - 1.0e4).abs() < 1.0e-8 && force[0] == -force[3]);
/// # Ok::<(), basemat::Error>(())
/// ```
pub trait NonlinearForce {
    /// Adds f(u) (n values, N per metre of thickness) to `force`.
    ///
    /// # Errors
    /// Any error ends the step with `StepError::Part`, and nothing of the step is committed;
    /// [`Error::part`](crate::Error::part) makes one with your reason. An error at an intermediate iterate of Newton's
    /// method also ends the step. To end a run because the structure exceeds a limit, return an error from the observer
    /// of `Simulation::run`: the run then ends after the step.
    fn force(&self, displacement: &[f64], force: &mut [f64]) -> Result<()>;

    /// Adds the tangent ∂f/∂u (n × n) to `matrix`.
    ///
    /// Write at every call all entries that can ever be nonzero, also those that are zero now: when the sparsity
    /// pattern grows, memory is allocated and the order of elimination is computed again. The call is fastest with the
    /// entries in the same order every time. The tangent need not be symmetric: the time integration then factors by LU
    /// instead of Cholesky, which takes longer.
    ///
    /// # Errors
    /// As for [`force`](NonlinearForce::force).
    fn tangent(&self, displacement: &[f64], matrix: &mut Triplets) -> Result<()>;

    /// Whether the tangent is symmetric at every displacement. Default: yes.
    ///
    /// Sand whose dilation angle is below its friction angle has an unsymmetric tangent. In three dimensions, with
    /// contact in plan, `build` returns an error for it, since that contact needs a symmetric compliance of the
    /// structure.
    fn has_symmetric_tangent(&self) -> bool {
        true
    }

    /// Energies of f at `displacement`. Default: `None`.
    ///
    /// In the energy balance, stored energy counts as strain energy and dissipated energy as `hysteresis`. With `None`
    /// all work of f counts as strain energy.
    fn energy(&self, _displacement: &[f64]) -> Option<InternalEnergy> {
        None
    }

    /// Work of f inside a step that is neither stored nor dissipated. Default: `None`.
    ///
    /// The step leads from the committed displacement to `end`, with f evaluated at `midstep`. The work is
    /// f(midstep)·(end − start) less the changes of [`energy`](NonlinearForce::energy); compute it by an independent
    /// formula. In the energy balance it counts as `midstep_remainder`, so that the residual checks force and energies.
    /// With `None` the run computes this difference from the energies, and the work counts as algorithmic dissipation.
    fn remainder(&self, _midstep: &[f64], _end: &[f64]) -> Option<f64> {
        None
    }

    /// Text of the place where f is out of balance, and of its state. Default: `None`.
    ///
    /// It is for the error of a step that does not converge.
    ///
    /// `dofs` are the degrees of freedom with the largest out-of-balance force, the largest first. The text names the
    /// element and its state, such as "element 12 on nodes [3, 4, 9, 8]: plastic strain 0.021, 98 % of its strength".
    fn describe_state(&self, _displacement: &[f64], _dofs: &[usize]) -> Option<String> {
        None
    }

    /// Accepts a step that ended with `displacement`. Default: does nothing.
    ///
    /// Internal variables may change here only. The method is also called for the static state and an initial motion.
    fn commit(&mut self, _displacement: &[f64]) {}

    /// The internal variables that [`commit`](NonlinearForce::commit) changes, for a checkpoint.
    ///
    /// A force without internal variables returns `Ok(Vec::new())`.
    ///
    /// # Errors
    /// [`CheckpointError::Unsupported`] unless implemented.
    fn save(&self) -> Result<Vec<f64>> {
        Err(CheckpointError::Unsupported { part: "structure" }.into())
    }

    /// Restores the variables that [`save`](NonlinearForce::save) returned.
    ///
    /// The caller passes finite values only. On an error the internal variables must not change.
    ///
    /// # Errors
    /// [`CheckpointError::Corrupt`] for impossible values, or [`Error::part`](crate::Error::part) with a more
    /// precise reason. The default returns an error for any value.
    fn restore(&mut self, values: &[f64]) -> Result<()> {
        check_no_variables(values)
    }
}

/// Internal variables of a structure, for a checkpoint; empty for a linear structure.
///
/// # Errors
/// Errors of the structure's methods.
pub fn save_variables(structure: &dyn Structure) -> Result<Vec<f64>> {
    structure.nonlinear().map_or_else(|| Ok(Vec::new()), NonlinearForce::save)
}

/// Restores internal variables; on an error the structure does not change.
///
/// # Errors
/// Errors of the structure's methods.
pub fn restore_variables(structure: &mut dyn Structure, values: &[f64]) -> Result<()> {
    match structure.nonlinear_mut() {
        Some(force) => force.restore(values),
        None => check_no_variables(values),
    }
}

/// Returns an error unless there are no internal variables.
fn check_no_variables(values: &[f64]) -> Result<()> {
    if values.is_empty() {
        Ok(())
    } else {
        Err(CheckpointError::Corrupt { quantity: "state of the structure" }.into())
    }
}

/// Checks that both methods for a structure's nonlinear force return it, or neither.
///
/// # Errors
/// [`Error::Scene`] if only one of [`Structure::nonlinear`] and [`Structure::nonlinear_mut`] returns a force.
pub fn check_nonlinear_force(structure: &mut dyn Structure) -> Result<()> {
    let has_force = structure.nonlinear().is_some();
    if structure.nonlinear_mut().is_some() == has_force {
        return Ok(());
    }
    let quantity = "nonlinear force of the structure";
    let needed = "must be returned by both `nonlinear` and `nonlinear_mut`, or by neither";
    Err(Error::Scene { quantity, needed })
}

/// Nonlinear force and its energies at a displacement; zero and `None` for a linear structure.
///
/// # Errors
/// Errors of the structure's methods.
pub fn nonlinear_state(
    structure: &dyn Structure,
    displacement: &[f64],
) -> Result<(Vec<f64>, Option<InternalEnergy>)> {
    let mut force = vec![0.0; displacement.len()];
    let Some(nonlinear_force) = structure.nonlinear() else {
        return Ok((force, None));
    };
    nonlinear_force.force(displacement, &mut force)?;
    Ok((force, nonlinear_force.energy(displacement)))
}

/// Mass and initial stiffness of a structure.
#[derive(Debug)]
pub struct MassAndStiffness {
    /// Mass matrix.
    pub mass: SparseMatrix,
    /// Stiffness matrix, with the tangent of the nonlinear force at zero displacement.
    pub stiffness: SparseMatrix,
}

/// Mass and initial stiffness of a structure.
///
/// The stiffness contains the tangent of the nonlinear force at zero displacement.
///
/// # Errors
/// Errors of the structure's methods.
pub fn mass_and_stiffness(structure: &dyn Structure) -> Result<MassAndStiffness> {
    let n = structure.dofs();
    let mut triplets = Triplets::new(n);
    let mass = SparseMatrix::assembled("mass matrix", &mut triplets, &|m| structure.mass(m))?;
    let stiffness = SparseMatrix::assembled("stiffness matrix", &mut triplets, &|m| {
        structure.stiffness(m)?;
        structure.nonlinear().map_or(Ok(()), |force| force.tangent(&vec![0.0; n], m))
    })?;
    Ok(MassAndStiffness { mass, stiffness })
}

/// Tangent matrix ∂f/∂u of the nonlinear force; empty for a linear structure.
#[allow(missing_debug_implementations, reason = "a helper of basemat")]
pub struct Tangent {
    #[doc(hidden)]
    pub matrix: SparseMatrix,
    entries: Triplets,
    /// Index in the matrix of each of the entries.
    indices: Vec<usize>,
}

impl Tangent {
    /// Empty tangent for a number of degrees of freedom.
    #[doc(hidden)]
    pub fn new(dof_count: usize) -> Self {
        Self {
            matrix: SparseMatrix::default(),
            entries: Triplets::new(dof_count),
            indices: Vec::new(),
        }
    }

    /// Tangent at a displacement.
    #[doc(hidden)]
    pub fn at(structure: &dyn Structure, displacement: &[f64]) -> Result<Self> {
        let mut tangent = Self::new(displacement.len());
        tangent.refill(structure, displacement)?;
        Ok(tangent)
    }

    /// Overwrites the tangent by the one at a displacement; allocates only if the sparsity pattern grows.
    #[doc(hidden)]
    pub fn refill(&mut self, structure: &dyn Structure, displacement: &[f64]) -> Result<()> {
        const TANGENT_NAME: &str = "tangent of the nonlinear force";
        self.entries.clear();
        if let Some(nonlinear_force) = structure.nonlinear() {
            nonlinear_force.tangent(displacement, &mut self.entries)?;
            same_length(TANGENT_NAME, self.entries.order(), displacement.len())?;
        }
        let Self { matrix, entries, indices } = self;
        if matrix.order() != displacement.len() || !matrix.refill(entries, indices) {
            *matrix = SparseMatrix::new(TANGENT_NAME, entries)?;
        }
        Ok(())
    }
}
