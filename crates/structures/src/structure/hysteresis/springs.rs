//! Hysteretic springs on the degrees of freedom of a structure.

use super::Hysteresis;
use super::biaxial::BiaxialSpring;
use super::pendulum_bearing::PendulumBearing;
use super::spring::HystereticSpring;
use crate::error::{CheckpointError, Result};
use crate::structure::nonlinear::{check_nonlinear_force, restore_variables, save_variables};
use crate::structure::{DofCombination, InternalEnergy, NonlinearForce, Structure, Triplets};

/// Hysteretic springs of a structure, as its nonlinear force.
#[derive(Clone, Default)]
pub(crate) struct HystereticSprings(Vec<HystereticSpring>);

impl HystereticSprings {
    /// Adds a spring with one deformation to a structure with `dof_count` degrees of freedom.
    pub(crate) fn add_uniaxial(
        &mut self,
        deformation: DofCombination,
        law: Box<dyn Hysteresis>,
        dof_count: usize,
    ) -> Result<()> {
        self.attach(HystereticSpring::Uniaxial(deformation, law), dof_count)
    }

    /// Adds a spring with two deformations.
    pub(crate) fn add_biaxial(
        &mut self,
        deformations: [DofCombination; 2],
        spring: BiaxialSpring,
        dof_count: usize,
    ) -> Result<()> {
        self.attach(HystereticSpring::Biaxial(deformations, spring), dof_count)
    }

    /// Adds a bearing with three deformations.
    pub(crate) fn add_pendulum(
        &mut self,
        deformations: [DofCombination; 3],
        bearing: PendulumBearing,
        dof_count: usize,
    ) -> Result<()> {
        self.attach(HystereticSpring::Pendulum(deformations, bearing), dof_count)
    }

    /// Adds a spring after a check of its degrees of freedom.
    fn attach(&mut self, spring: HystereticSpring, dof_count: usize) -> Result<()> {
        for deformation in spring.deformations() {
            deformation.check("degree of freedom of a spring", dof_count)?;
        }
        self.0.push(spring);
        Ok(())
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    pub(crate) fn nonlinear(&self) -> Option<&dyn NonlinearForce> {
        (!self.is_empty()).then_some(self)
    }

    pub(crate) fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce> {
        (!self.is_empty()).then_some(self)
    }

    /// Number of internal variables.
    fn variable_count(&self) -> usize {
        self.0.iter().map(|spring| spring.save().len()).sum()
    }

    /// Internal variables of all springs.
    fn internal_variables(&self) -> Vec<f64> {
        self.0.iter().flat_map(HystereticSpring::save).collect()
    }

    /// Work of the springs inside a step that is neither stored nor dissipated.
    ///
    /// It is f(midstep)·(end − start), less the changes of the stored and of the dissipated energy.
    ///
    /// An empty `start` is zero displacement.
    fn total_remainder(&self, start: &[f64], midstep: &[f64], end: &[f64]) -> f64 {
        self.0.iter().map(|spring| spring.remainder(start, midstep, end)).sum()
    }

    /// Restores the springs in order; stops at the first error.
    fn try_restore(&mut self, values: &[f64]) -> Result<()> {
        let mut remaining_values = values;
        for spring in &mut self.0 {
            let variable_count = spring.save().len().min(remaining_values.len());
            spring.restore(&remaining_values[..variable_count])?;
            remaining_values = &remaining_values[variable_count..];
        }
        Ok(())
    }
}

impl NonlinearForce for HystereticSprings {
    fn force(&self, displacement: &[f64], force: &mut [f64]) -> Result<()> {
        self.0.iter().for_each(|spring| spring.add_force(displacement, force));
        Ok(())
    }

    fn tangent(&self, displacement: &[f64], matrix: &mut Triplets) -> Result<()> {
        self.0.iter().for_each(|spring| spring.add_tangent(displacement, matrix));
        Ok(())
    }

    fn energy(&self, displacement: &[f64]) -> Option<InternalEnergy> {
        let energies = self.0.iter().map(|spring| spring.energy(displacement));
        Some(energies.fold(InternalEnergy::default(), |sum, energy| sum + energy))
    }

    fn commit(&mut self, displacement: &[f64]) {
        self.0.iter_mut().for_each(|spring| spring.commit(displacement));
    }

    fn save(&self) -> Result<Vec<f64>> {
        Ok(self.internal_variables())
    }

    /// Restores the variables of all springs; on an error no spring changes.
    fn restore(&mut self, values: &[f64]) -> Result<()> {
        let previous_variables = self.internal_variables();
        if values.len() != previous_variables.len() {
            return Err(CheckpointError::Corrupt { quantity: "state of the springs" }.into());
        }
        let result = self.try_restore(values);
        if result.is_err() {
            self.try_restore(&previous_variables)?;
        }
        result
    }
}

/// Any structure with hysteretic springs between its degrees of freedom.
///
/// The deformation of each spring is a weighted sum of degrees of freedom; its force follows its [`Hysteresis`] law.
/// The force adds to the other forces of the structure: a storey or a bearing that consists of the spring alone must
/// have no other stiffness. The damping of the structure does not change; stiffness-proportional damping does not
/// include the springs. For storeys of a shear building use
/// [`ShearBuilding::with_law`](crate::structure::ShearBuilding::with_law).
///
/// Degrees of freedom are absolute. A spring on a single degree of freedom would connect the structure to a fixed point
/// instead of the moving ground, and `build` returns an error. A deformation must be zero in a translation of the whole
/// structure.
///
/// A bearing with two horizontal displacements is one [`biaxial_spring`](WithSprings::biaxial_spring). Two springs
/// along x and y act independently: along the diagonal, two sliders have √2 times the friction of one.
///
/// ```
/// use basemat::structure::{Bilinear, NonlinearForce, ShearBuilding, Storey, WithSprings};
///
/// // A building with a yielding damper beside its lowest columns.
/// let storeys = [Storey::new(3.0, 20.0e3, 40.0e6); 3];
/// let building = ShearBuilding::new(10.0, 50.0e3, 4.0e5, &storeys)?;
/// let drift = building.drift(0)?;
/// let damped = WithSprings::new(building).spring(drift, Bilinear::new(5.0e6, 2.0e4, 0.0)?)?;
/// let mut force = [0.0; 6];
/// // At 10 mm of drift the damper yields. Its moment on the base has the lever arm of 3 m.
/// damped.force(&[0.0, 0.0, 0.0, 0.01, 0.01, 0.01], &mut force)?;
/// assert_eq!(force, [-2.0e4, 0.0, 6.0e4, 2.0e4, 0.0, 0.0]);
/// # Ok::<(), basemat::Error>(())
/// ```
pub struct WithSprings {
    structure: Box<dyn Structure>,
    springs: HystereticSprings,
    /// Displacement at the end of the last step, m and rad.
    ///
    /// Empty before the first step, and for a structure whose force has no remainder.
    committed_displacement: Vec<f64>,
}

short_debug! {
    WithSprings; self; dofs: self.structure.dofs(), springs: self.springs.len()
}

impl WithSprings {
    /// Prepares `structure` for springs, which are added by the other methods.
    pub fn new(structure: impl Structure + 'static) -> Self {
        Self {
            structure: Box::new(structure),
            springs: HystereticSprings::default(),
            committed_displacement: Vec::new(),
        }
    }

    /// The structure between whose degrees of freedom the springs act, with its present internal variables.
    ///
    /// A downcast of it to its type gives access to its results, such as
    /// [`FemModel::solid_points`](crate::structure::FemModel::solid_points).
    pub fn structure(&self) -> &dyn Structure {
        self.structure.as_ref()
    }

    /// Adds a spring with one `deformation`.
    ///
    /// # Errors
    /// [`Error::Index`](crate::Error::Index) for a degree of freedom that the structure does not have,
    /// [`Error::Input`](crate::Error::Input) for a weight that is not finite.
    pub fn spring(
        mut self,
        deformation: impl Into<DofCombination>,
        law: impl Hysteresis + 'static,
    ) -> Result<Self> {
        self.springs.add_uniaxial(deformation.into(), Box::new(law), self.structure.dofs())?;
        Ok(self)
    }

    /// Adds a spring with two `deformations` at a right angle.
    ///
    /// # Errors
    /// As for [`spring`](WithSprings::spring).
    pub fn biaxial_spring(
        mut self,
        deformations: [impl Into<DofCombination>; 2],
        spring: BiaxialSpring,
    ) -> Result<Self> {
        self.springs
            .add_biaxial(deformations.map(Into::into), spring, self.structure.dofs())?;
        Ok(self)
    }

    /// Adds a friction pendulum that supports the structure.
    ///
    /// `deformations`: along x, along y and up. The bearing has a vertical stiffness: the structure must have
    /// none there.
    ///
    /// # Errors
    /// As for [`spring`](WithSprings::spring).
    pub fn pendulum(
        mut self,
        deformations: [impl Into<DofCombination>; 3],
        bearing: PendulumBearing,
    ) -> Result<Self> {
        self.springs
            .add_pendulum(deformations.map(Into::into), bearing, self.structure.dofs())?;
        Ok(self)
    }
}

impl Structure for WithSprings {
    forward_structure! { self.structure }

    forward! {
        self.structure;
        fn stiffness(&self, matrix: &mut Triplets) -> Result<()>;
        fn damping(&self, matrix: &mut Triplets) -> Result<()>;
    }

    fn nonlinear(&self) -> Option<&dyn NonlinearForce> {
        if self.springs.is_empty() { self.structure.nonlinear() } else { Some(self) }
    }

    fn nonlinear_mut(&mut self) -> Option<&mut dyn NonlinearForce> {
        if self.springs.is_empty() {
            return self.structure.nonlinear_mut();
        }
        check_nonlinear_force(self.structure.as_mut()).is_ok().then_some(self)
    }
}

/// The springs, and the nonlinear force of the structure if it has one.
impl NonlinearForce for WithSprings {
    fn force(&self, displacement: &[f64], force: &mut [f64]) -> Result<()> {
        if let Some(structure_force) = self.structure.nonlinear() {
            structure_force.force(displacement, force)?;
        }
        self.springs.force(displacement, force)
    }

    fn tangent(&self, displacement: &[f64], matrix: &mut Triplets) -> Result<()> {
        if let Some(structure_force) = self.structure.nonlinear() {
            structure_force.tangent(displacement, matrix)?;
        }
        self.springs.tangent(displacement, matrix)
    }

    fn has_symmetric_tangent(&self) -> bool {
        let structure_force = self.structure.nonlinear();
        structure_force.is_none_or(NonlinearForce::has_symmetric_tangent)
    }

    fn energy(&self, displacement: &[f64]) -> Option<InternalEnergy> {
        let spring_energy = self.springs.energy(displacement)?;
        match self.structure.nonlinear() {
            Some(structure_force) => Some(structure_force.energy(displacement)? + spring_energy),
            None => Some(spring_energy),
        }
    }

    /// Remainders of the structure's force and of the springs.
    ///
    /// `None` if the structure has no nonlinear force with a remainder; that of the springs then counts as algorithmic.
    fn remainder(&self, midstep: &[f64], end: &[f64]) -> Option<f64> {
        let structure_remainder = self.structure.nonlinear()?.remainder(midstep, end)?;
        let start = &self.committed_displacement;
        Some(structure_remainder + self.springs.total_remainder(start, midstep, end))
    }

    /// State of the structure's force; the springs are not described.
    fn describe_state(&self, displacement: &[f64], dofs: &[usize]) -> Option<String> {
        self.structure.nonlinear()?.describe_state(displacement, dofs)
    }

    fn commit(&mut self, displacement: &[f64]) {
        if let Some(structure_force) = self.structure.nonlinear_mut() {
            let stores_displacement = !self.committed_displacement.is_empty()
                || structure_force.remainder(displacement, displacement).is_some();
            if stores_displacement {
                self.committed_displacement.clear();
                self.committed_displacement.extend_from_slice(displacement);
            }
            structure_force.commit(displacement);
        }
        self.springs.commit(displacement);
    }

    fn save(&self) -> Result<Vec<f64>> {
        let mut values = self.springs.internal_variables();
        values.extend(&self.committed_displacement);
        values.extend(save_variables(self.structure.as_ref())?);
        Ok(values)
    }

    fn restore(&mut self, values: &[f64]) -> Result<()> {
        let displacement_start = self.springs.variable_count().min(values.len());
        let displacement_end =
            (displacement_start + self.committed_displacement.len()).min(values.len());
        let displacement = &values[displacement_start..displacement_end];
        let previous_variables = self.springs.internal_variables();
        self.springs.restore(&values[..displacement_start])?;
        let result = restore_variables(self.structure.as_mut(), &values[displacement_end..]);
        match &result {
            Ok(()) => {
                self.committed_displacement.clear();
                self.committed_displacement.extend_from_slice(displacement);
            }
            Err(_) => self.springs.restore(&previous_variables)?,
        }
        result
    }
}
