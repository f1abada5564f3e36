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
    pub(super) fn rows(&self) -> &[DofCombination] {
        match self {
            Self::Uniaxial(row, _) => std::slice::from_ref(row),
            Self::Biaxial(rows, _) => rows,
            Self::Pendulum(rows, _) => rows,
        }
    }

    /// Adds the force at a displacement to `force`.
    pub(super) fn add_force(&self, displacement: &[f64], force: &mut [f64]) {
        match self {
            Self::Uniaxial(row, law) => {
                add_spring_force(row, law.response(row.value(displacement)).force, force);
            }
            Self::Biaxial(rows, law) => {
                let response = law.response(deformations(rows, displacement));
                for (row, value) in rows.iter().zip(response.force) {
                    add_spring_force(row, value, force);
                }
            }
            Self::Pendulum(rows, law) => {
                for (row, value) in rows.iter().zip(law.force(deformations(rows, displacement))) {
                    add_spring_force(row, value, force);
                }
            }
        }
    }

    /// Adds the tangent at a displacement to `matrix`.
    pub(super) fn add_tangent(&self, displacement: &[f64], matrix: &mut Triplets) {
        match self {
            Self::Uniaxial(row, law) => {
                matrix.add_outer(row, law.response(row.value(displacement)).tangent);
            }
            Self::Biaxial(rows, law) => {
                add_tangent_matrix(
                    rows,
                    &law.response(deformations(rows, displacement)).tangent,
                    matrix,
                );
            }
            Self::Pendulum(rows, law) => {
                add_tangent_matrix(rows, &law.tangent(deformations(rows, displacement)), matrix);
            }
        }
    }

    pub(super) fn energy(&self, displacement: &[f64]) -> InternalEnergy {
        match self {
            Self::Uniaxial(row, law) => law.energy(row.value(displacement)),
            Self::Biaxial(rows, law) => law.energy(deformations(rows, displacement)),
            Self::Pendulum(rows, law) => law.energy(deformations(rows, displacement)),
        }
    }

    pub(super) fn commit(&mut self, displacement: &[f64]) {
        match self {
            Self::Uniaxial(row, law) => law.commit(row.value(displacement)),
            Self::Biaxial(rows, law) => law.commit(deformations(rows, displacement)),
            Self::Pendulum(rows, law) => law.commit(deformations(rows, displacement)),
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
fn deformations<const N: usize>(rows: &[DofCombination; N], displacement: &[f64]) -> [f64; N] {
    rows.each_ref().map(|row| row.value(displacement))
}

/// Adds the tangent matrix of a spring with these deformations to `matrix`.
fn add_tangent_matrix<const N: usize>(
    rows: &[DofCombination; N],
    tangent: &[[f64; N]; N],
    matrix: &mut Triplets,
) {
    for (force_row, tangent_row) in rows.iter().zip(tangent) {
        for (deformation_row, derivative) in rows.iter().zip(tangent_row) {
            for &(i, a) in force_row {
                deformation_row.iter().for_each(|&(j, b)| matrix.add(i, j, derivative * a * b));
            }
        }
    }
}

/// Adds a spring force on the deformation `row` to the nodal `forces`.
///
/// Degrees of freedom beyond the end of `forces` do not count.
fn add_spring_force(row: &DofCombination, spring_force: f64, forces: &mut [f64]) {
    for &(dof, weight) in row {
        if let Some(force) = forces.get_mut(dof) {
            *force += weight * spring_force;
        }
    }
}
