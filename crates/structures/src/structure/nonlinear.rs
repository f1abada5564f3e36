//! Nonlinear internal forces of structures.

use super::{Structure, Triplets};
use crate::error::{CheckpointError, Error, Result, same_length};
use crate::linalg::matrix::SparseMatrix;

/// Stored and dissipated energy of internal forces, J per metre of thickness.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct InternalEnergy {
    /// Energy that unloading recovers.
    pub stored: f64,
    /// Energy turned into heat since the structure was new; it never decreases.
    pub dissipated: f64,
}

impl std::ops::Add for InternalEnergy {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            stored: self.stored + other.stored,
            dissipated: self.dissipated + other.dissipated,
        }
    }
}

/// The nonlinear force f(u) of a structure, beyond K u.
///
/// Implement this for materials that yield, geometry that changes, parts that collide. A [`Structure`]
/// returns it by [`Structure::nonlinear`] and [`Structure::nonlinear_mut`]. Force, tangent and energy belong
/// to a trial `displacement` reached from the last **committed** displacement, and change nothing;
/// [`commit`](NonlinearForce::commit) accepts the end of a step. Force and tangent are evaluated where the
/// time scheme writes its equations (the midpoint rule: halfway through the step), at every iterate of
/// Newton's method.
///
/// ```
/// use basemat::structure::{Base, NonlinearForce, RigidBlock, Structure, Triplets};
/// use basemat::Result;
///
/// /// A block with a mass on top, on a spring that hardens: 1 MN/m and 10 GN/m³.
/// struct Tuned(RigidBlock);
///
/// impl Structure for Tuned {
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
/// impl NonlinearForce for Tuned {
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
/// let tuned = Tuned(RigidBlock::new(4.0, 6.0, 2000.0)?);
/// let mut force = [0.0; 4];
/// tuned.force(&[0.0, 0.0, 0.0, 0.01], &mut force)?;
/// assert!((force[3] - 1.0e4).abs() < 1.0e-8 && force[0] == -force[3]);
/// # Ok::<(), basemat::Error>(())
/// ```
pub trait NonlinearForce {
    /// Adds f(u) (n, N per metre of thickness) to `force`.
    ///
    /// # Errors
    /// Any error, [`Error::part`](crate::Error::part) for a reason of your own, ends the step with
    /// `StepError::Part`, and nothing of the step is committed. An error
    /// at an iterate ends the step even if Newton's method would have left that iterate again. To report that
    /// the structure has passed a limit, return an error from the observer of
    /// `Simulation::run`: it ends the run after the step.
    fn force(&self, displacement: &[f64], force: &mut [f64]) -> Result<()>;

    /// Adds the tangent ∂f/∂u (n × n) to `matrix`.
    ///
    /// Its entries are at the same places at every call, or at fewer.
    ///
    /// # Errors
    /// As for [`force`](NonlinearForce::force).
    fn tangent(&self, displacement: &[f64], matrix: &mut Triplets) -> Result<()>;

    /// Energies of f at `displacement`, where they are known. Default: unknown.
    ///
    /// Stored energy counts as strain energy of the energy balance, dissipated energy as
    /// `hysteresis`. If the energies are unknown, all work of f
    /// counts as strain energy.
    fn energy(&self, _displacement: &[f64]) -> Option<InternalEnergy> {
        None
    }

    /// Accepts a step that ended with `displacement`. Default: does nothing.
    ///
    /// Internal variables may change here only. Also called for the static state and an initial motion.
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
    /// All values are finite. On an error the force stays unchanged.
    ///
    /// # Errors
    /// [`CheckpointError::Corrupt`] for impossible values, or [`Error::part`](crate::Error::part) with a more
    /// precise reason. The default returns an error for any value.
    fn restore(&mut self, values: &[f64]) -> Result<()> {
        no_variables(values)
    }
}

/// Internal variables of a structure, for a checkpoint; empty for a linear structure.
///
/// # Errors
/// Faults of the structure's own methods.
pub fn save_variables(structure: &dyn Structure) -> Result<Vec<f64>> {
    structure.nonlinear().map_or_else(|| Ok(Vec::new()), NonlinearForce::save)
}

/// Restores internal variables; on an error the structure stays unchanged.
///
/// # Errors
/// Faults of the structure's own methods.
pub fn restore_variables(structure: &mut dyn Structure, values: &[f64]) -> Result<()> {
    match structure.nonlinear_mut() {
        Some(force) => force.restore(values),
        None => no_variables(values),
    }
}

fn no_variables(values: &[f64]) -> Result<()> {
    if values.is_empty() {
        Ok(())
    } else {
        Err(CheckpointError::Corrupt { quantity: "state of the structure" }.into())
    }
}

/// Whether a structure has a nonlinear force.
///
/// # Errors
/// [`Error::Scene`] if only one of [`Structure::nonlinear`] and [`Structure::nonlinear_mut`] returns a force.
pub fn is_nonlinear(structure: &mut dyn Structure) -> Result<bool> {
    let shown = structure.nonlinear().is_some();
    if structure.nonlinear_mut().is_some() == shown {
        return Ok(shown);
    }
    let quantity = "nonlinear force of the structure";
    let needed = "`nonlinear` and `nonlinear_mut` must both give it, or neither";
    Err(Error::Scene { quantity, needed })
}

/// f and its energies at a displacement; zero and `None` for a linear structure.
///
/// # Errors
/// Faults of the structure's own methods.
pub fn nonlinear_state(
    structure: &dyn Structure,
    displacement: &[f64],
) -> Result<(Vec<f64>, Option<InternalEnergy>)> {
    let mut force = vec![0.0; displacement.len()];
    let Some(law) = structure.nonlinear() else { return Ok((force, None)) };
    law.force(displacement, &mut force)?;
    Ok((force, law.energy(displacement)))
}

/// Mass, and stiffness with the tangent of the nonlinear force at rest.
#[derive(Debug)]
pub struct MassAndStiffness {
    /// Mass matrix.
    pub mass: SparseMatrix,
    /// Stiffness matrix.
    pub stiffness: SparseMatrix,
}

/// Mass, and stiffness with the tangent of the nonlinear force at rest.
///
/// # Errors
/// Faults of the structure's own methods.
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

/// The tangent ∂f/∂u of the nonlinear force; empty for a linear structure.
#[allow(missing_debug_implementations, reason = "a helper of basemat")]
pub struct Tangent {
    #[doc(hidden)]
    pub matrix: SparseMatrix,
    entries: Triplets,
}

impl Tangent {
    #[doc(hidden)]
    pub fn new(dofs: usize) -> Self {
        Self { matrix: SparseMatrix::default(), entries: Triplets::new(dofs) }
    }

    /// The tangent at a displacement.
    #[doc(hidden)]
    pub fn at(structure: &dyn Structure, displacement: &[f64]) -> Result<Self> {
        let mut tangent = Self::new(displacement.len());
        tangent.refill(structure, displacement)?;
        Ok(tangent)
    }

    /// Computes the tangent at a displacement; allocates only for entries at new places.
    #[doc(hidden)]
    pub fn refill(&mut self, structure: &dyn Structure, displacement: &[f64]) -> Result<()> {
        const TANGENT_NAME: &str = "tangent of the nonlinear force";
        self.entries.clear();
        if let Some(law) = structure.nonlinear() {
            law.tangent(displacement, &mut self.entries)?;
            same_length(TANGENT_NAME, self.entries.order(), displacement.len())?;
        }
        if self.matrix.order() != displacement.len() || !self.matrix.refill(&self.entries) {
            self.matrix = SparseMatrix::new(TANGENT_NAME, &self.entries)?;
        }
        Ok(())
    }
}
