//! A hysteretic spring on the degrees of freedom of a structure.

use super::Hysteresis;
use super::biaxial::BiaxialSpring;
use super::pendulum_bearing::PendulumBearing;
use crate::error::Result;
use crate::structure::{DofCombination, InternalEnergy, Triplets};

/// A force law, and its deformations as weighted sums of degrees of freedom.
#[derive(Clone)]
pub(super) enum HystereticSpring {
    Uniaxial(DofCombination, Box<dyn Hysteresis>),
    Biaxial([DofCombination; 2], BiaxialSpring),
    Pendulum([DofCombination; 3], PendulumBearing),
}

impl HystereticSpring {
    /// Deformations of the spring.
    pub(super) fn deformations(&self) -> &[DofCombination] {
        match self {
            Self::Uniaxial(deformation, _) => std::slice::from_ref(deformation),
            Self::Biaxial(deformations, _) => deformations,
            Self::Pendulum(deformations, _) => deformations,
        }
    }

    /// Adds the force at a displacement to `force`.
    pub(super) fn add_force(&self, displacement: &[f64], force: &mut [f64]) {
        match self {
            Self::Uniaxial(deformation, law) => {
                add_spring_force(
                    deformation,
                    law.response(deformation.value(displacement)).force,
                    force,
                );
            }
            Self::Biaxial(deformations, law) => {
                let response = law.response(deformation_values(deformations, displacement));
                for (deformation, value) in deformations.iter().zip(response.force) {
                    add_spring_force(deformation, value, force);
                }
            }
            Self::Pendulum(deformations, law) => {
                for (deformation, value) in deformations
                    .iter()
                    .zip(law.force(deformation_values(deformations, displacement)))
                {
                    add_spring_force(deformation, value, force);
                }
            }
        }
    }

    /// Adds the tangent at a displacement to `matrix`.
    pub(super) fn add_tangent(&self, displacement: &[f64], matrix: &mut Triplets) {
        match self {
            Self::Uniaxial(deformation, law) => {
                matrix
                    .add_outer(deformation, law.response(deformation.value(displacement)).tangent);
            }
            Self::Biaxial(deformations, law) => {
                add_tangent_matrix(
                    deformations,
                    &law.response(deformation_values(deformations, displacement)).tangent,
                    matrix,
                );
            }
            Self::Pendulum(deformations, law) => {
                add_tangent_matrix(
                    deformations,
                    &law.tangent(deformation_values(deformations, displacement)),
                    matrix,
                );
            }
        }
    }

    pub(super) fn energy(&self, displacement: &[f64]) -> InternalEnergy {
        match self {
            Self::Uniaxial(deformation, law) => law.energy(deformation.value(displacement)),
            Self::Biaxial(deformations, law) => {
                law.energy(deformation_values(deformations, displacement))
            }
            Self::Pendulum(deformations, law) => {
                law.energy(deformation_values(deformations, displacement))
            }
        }
    }

    /// Work of the force at `midstep` on the way from `start` to `end`, without the change of the energies.
    pub(super) fn remainder(&self, start: &[f64], midstep: &[f64], end: &[f64]) -> f64 {
        let work_along = |deformations: &[DofCombination], force: &[f64]| -> f64 {
            let forces = deformations.iter().zip(force);
            forces.map(|(d, force)| force * (d.value(end) - d.value(start))).sum()
        };
        let work = match self {
            Self::Uniaxial(deformation, law) => {
                let force = law.response(deformation.value(midstep)).force;
                work_along(std::slice::from_ref(deformation), &[force])
            }
            Self::Biaxial(deformations, law) => {
                let response = law.response(deformation_values(deformations, midstep));
                work_along(deformations, &response.force)
            }
            Self::Pendulum(deformations, law) => {
                let force = law.force(deformation_values(deformations, midstep));
                work_along(deformations, &force)
            }
        };
        let start_energy = self.energy(start);
        let end_energy = self.energy(end);
        let stored_change = end_energy.stored - start_energy.stored;
        let dissipated_change = end_energy.dissipated - start_energy.dissipated;
        work - stored_change - dissipated_change
    }

    pub(super) fn commit(&mut self, displacement: &[f64]) {
        match self {
            Self::Uniaxial(deformation, law) => law.commit(deformation.value(displacement)),
            Self::Biaxial(deformations, law) => {
                law.commit(deformation_values(deformations, displacement));
            }
            Self::Pendulum(deformations, law) => {
                law.commit(deformation_values(deformations, displacement));
            }
        }
    }

    pub(super) fn save(&self) -> Vec<f64> {
        match self {
            Self::Uniaxial(_, law) => law.save(),
            Self::Biaxial(_, law) => law.save(),
            Self::Pendulum(_, law) => law.save(),
        }
    }

    pub(super) fn restore(&mut self, values: &[f64]) -> Result<()> {
        match self {
            Self::Uniaxial(_, law) => law.restore(values),
            Self::Biaxial(_, law) => law.restore(values),
            Self::Pendulum(_, law) => law.restore(values),
        }
    }
}

/// Values of the deformations at a displacement of the structure.
fn deformation_values<const N: usize>(
    deformations: &[DofCombination; N],
    displacement: &[f64],
) -> [f64; N] {
    deformations.each_ref().map(|deformation| deformation.value(displacement))
}

/// Adds the tangent matrix of a spring with these deformations to `matrix`.
fn add_tangent_matrix<const N: usize>(
    deformations: &[DofCombination; N],
    tangent: &[[f64; N]; N],
    matrix: &mut Triplets,
) {
    for (force_row, tangent_row) in deformations.iter().zip(tangent) {
        for (deformation_row, derivative) in deformations.iter().zip(tangent_row) {
            for &(i, a) in force_row {
                deformation_row.iter().for_each(|&(j, b)| matrix.add(i, j, derivative * a * b));
            }
        }
    }
}

/// Adds a spring force on a `deformation` to the nodal `forces`.
///
/// Degrees of freedom beyond the end of `forces` do not count.
fn add_spring_force(deformation: &DofCombination, spring_force: f64, forces: &mut [f64]) {
    for &(dof, weight) in deformation {
        if let Some(force) = forces.get_mut(dof) {
            *force += weight * spring_force;
        }
    }
}
