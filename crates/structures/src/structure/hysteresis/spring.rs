//! A spring on the degrees of freedom of a structure.

use super::Hysteresis;
use super::biaxial::BiaxialSpring;
use super::pendulum_bearing::PendulumBearing;
use crate::error::Result;
use crate::structure::{DofCombination, InternalEnergy, Triplets};

/// A law, and the rows l of its deformations l·u.
#[derive(Clone)]
pub(super) enum HystereticSpring {
    Uniaxial(DofCombination, Box<dyn Hysteresis>),
    Biaxial([DofCombination; 2], BiaxialSpring),
    Pendulum([DofCombination; 3], PendulumBearing),
}

impl HystereticSpring {
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
                add_scaled(row, law.response(row.value(displacement)).force, force);
            }
            Self::Biaxial(rows, law) => {
                let response = law.response(values(rows, displacement));
                for (row, value) in rows.iter().zip(response.force) {
                    add_scaled(row, value, force);
                }
            }
            Self::Pendulum(rows, law) => {
                for (row, value) in rows.iter().zip(law.force(values(rows, displacement))) {
                    add_scaled(row, value, force);
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
                add_slopes(rows, &law.response(values(rows, displacement)).tangent, matrix);
            }
            Self::Pendulum(rows, law) => {
                add_slopes(rows, &law.tangent(values(rows, displacement)), matrix);
            }
        }
    }

    pub(super) fn energy(&self, displacement: &[f64]) -> InternalEnergy {
        match self {
            Self::Uniaxial(row, law) => law.energy(row.value(displacement)),
            Self::Biaxial(rows, law) => law.energy(values(rows, displacement)),
            Self::Pendulum(rows, law) => law.energy(values(rows, displacement)),
        }
    }

    pub(super) fn commit(&mut self, displacement: &[f64]) {
        match self {
            Self::Uniaxial(row, law) => law.commit(row.value(displacement)),
            Self::Biaxial(rows, law) => law.commit(values(rows, displacement)),
            Self::Pendulum(rows, law) => law.commit(values(rows, displacement)),
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

fn values<const N: usize>(rows: &[DofCombination; N], displacement: &[f64]) -> [f64; N] {
    rows.each_ref().map(|row| row.value(displacement))
}

/// Adds the slopes of forces along rows over deformations along the same rows.
fn add_slopes<const N: usize>(
    rows: &[DofCombination; N],
    tangent: &[[f64; N]; N],
    matrix: &mut Triplets,
) {
    for (first, slopes) in rows.iter().zip(tangent) {
        for (second, slope) in rows.iter().zip(slopes) {
            for &(i, a) in first {
                second.iter().for_each(|&(j, b)| matrix.add(i, j, slope * a * b));
            }
        }
    }
}

/// Adds `factor` times a row; degrees of freedom beyond the end of `sum` do not count.
fn add_scaled(row: &DofCombination, factor: f64, sum: &mut [f64]) {
    for &(i, weight) in row {
        if let Some(sum) = sum.get_mut(i) {
            *sum += weight * factor;
        }
    }
}
