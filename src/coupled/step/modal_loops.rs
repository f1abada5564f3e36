//! Loops of a step in modal coordinates, before and after the solution of the contact problem.
//!
//! Every matrix is diagonal in modal coordinates.
//!
//! | symbol | meaning |
//! |---|---|
//! | m, d, k | modal mass, damping and stiffness |
//! | 1/k_eff | reciprocals of the effective stiffness |
//! | u, v, a | motion at the start of the step |
//! | Δu, u₁, v₁, a₁ | increment, and motion at the end |
//! | R Δy, R ẏ | increment and velocity of the free field's translation |
//!
//! Each loop is a function with slices as arguments. For an argument, unlike a field, the compiler can assume that no other
//! reference points to the memory that the loop writes.

#![allow(
    clippy::inline_always,
    reason = "the functions must be compiled for the vector instructions of their caller"
)]

use crate::coupled::model::kinematics::Kinematics;
use crate::coupled::scheme::SchemeCoefficients;
use crate::coupled::step::forcing::Forcing;
use crate::coupled::step::increment::Increment;
use crate::linalg::matrix::Diagonals;
use crate::linalg::{Simd, WithSimd, vectorized};

/// Computes Δu and u₁ without a change of traction.
pub(crate) fn free_increment(
    scheme: &SchemeCoefficients,
    matrices: Diagonals<'_>,
    inverse_diagonal: &[f64],
    kinematics: &Kinematics,
    forcing: &Forcing,
    increment: &mut Increment,
) {
    vectorized(FreeIncrement {
        scheme,
        matrices,
        inverse_diagonal,
        kinematics,
        forcing,
        displacement_increment: increment.displacement.as_mut_slice(),
        end_displacement: increment.end_displacement.as_mut_slice(),
    });
}

/// Subtracts the response to the tractions' `force` from Δu, and computes the motion at the end.
pub(crate) fn apply_tractions(
    scheme: &SchemeCoefficients,
    inverse_diagonal: &[f64],
    force: &[f64],
    kinematics: &Kinematics,
    translation_increment: &[f64],
    increment: &mut Increment,
) {
    vectorized(ApplyTractions {
        scheme,
        inverse_diagonal,
        force,
        kinematics,
        translation_increment,
        increment,
    });
}

/// Arguments of [`free_increment`].
struct FreeIncrement<'a> {
    scheme: &'a SchemeCoefficients,
    matrices: Diagonals<'a>,
    inverse_diagonal: &'a [f64],
    kinematics: &'a Kinematics,
    forcing: &'a Forcing,
    displacement_increment: &'a mut [f64],
    end_displacement: &'a mut [f64],
}

impl WithSimd for FreeIncrement<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { displacement_increment, end_displacement, .. } = self;
        let Self { scheme, matrices, inverse_diagonal, kinematics, forcing, .. } = self;
        right_hand_side(scheme, matrices, kinematics, forcing, displacement_increment);
        let u = &kinematics.displacement;
        divide_by_stiffness(inverse_diagonal, u, displacement_increment, end_displacement);
    }
}

/// Right-hand side of the equation of motion, as `LinearStep::predict` computes it in degrees of freedom.
#[inline(always)]
fn right_hand_side(
    scheme: &SchemeCoefficients,
    matrices: Diagonals<'_>,
    kinematics: &Kinematics,
    forcing: &Forcing,
    rhs: &mut [f64],
) {
    let n = rhs.len();
    let Diagonals { mass, damping, stiffness } = matrices;
    let m = &mass[..n];
    let k = &stiffness[..n];
    let u = &kinematics.displacement[..n];
    let v = &kinematics.velocity[..n];
    let a = &kinematics.acceleration[..n];
    let load = &forcing.load[..n];
    // R Δy.
    let dy = &forcing.translation_increment[..n];
    for j in 0..n {
        let acceleration = SchemeCoefficients::apply(scheme.acceleration, dy[j], v[j], a[j]);
        let displacement = u[j] + SchemeCoefficients::apply(scheme.displacement, 0.0, v[j], a[j]);
        rhs[j] = load[j] - m[j] * acceleration - k[j] * displacement;
    }
    if let Some(d) = damping {
        let d = &d[..n];
        let translation_velocity = &forcing.translation_velocity[..n];
        for j in 0..n {
            let velocity = SchemeCoefficients::apply(scheme.velocity, dy[j], v[j], a[j]);
            rhs[j] -= d[j] * (velocity - translation_velocity[j]);
        }
    }
}

/// Replaces the right-hand side by Δu, and computes u₁.
#[inline(always)]
fn divide_by_stiffness(inverse_diagonal: &[f64], u: &[f64], rhs: &mut [f64], end: &mut [f64]) {
    let n = rhs.len();
    let inverse_diagonal = &inverse_diagonal[..n];
    let u = &u[..n];
    let end = &mut end[..n];
    for j in 0..n {
        rhs[j] *= inverse_diagonal[j];
        end[j] = u[j] + rhs[j];
    }
}

/// Arguments of [`apply_tractions`].
struct ApplyTractions<'a> {
    scheme: &'a SchemeCoefficients,
    inverse_diagonal: &'a [f64],
    force: &'a [f64],
    kinematics: &'a Kinematics,
    translation_increment: &'a [f64],
    increment: &'a mut Increment,
}

impl WithSimd for ApplyTractions<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { scheme, inverse_diagonal, force, kinematics, translation_increment, increment } =
            self;
        subtract_response(
            inverse_diagonal,
            force,
            &mut increment.displacement,
            &mut increment.end_displacement,
        );
        set_end_motion(
            scheme,
            kinematics,
            translation_increment,
            &increment.displacement,
            &mut increment.total_displacement,
            &mut increment.end_velocity,
            &mut increment.end_acceleration,
        );
    }
}

/// Subtracts the response to the tractions' force from Δu and u₁.
#[inline(always)]
fn subtract_response(inverse_diagonal: &[f64], force: &[f64], du: &mut [f64], end: &mut [f64]) {
    let n = du.len();
    let inverse_diagonal = &inverse_diagonal[..n];
    let force = &force[..n];
    let end = &mut end[..n];
    for j in 0..n {
        let response = inverse_diagonal[j] * force[j];
        du[j] -= response;
        end[j] -= response;
    }
}

/// Total increment, and velocity and acceleration at the end, as `Increment::set_end_motion` computes them.
#[inline(always)]
fn set_end_motion(
    scheme: &SchemeCoefficients,
    kinematics: &Kinematics,
    translation_increment: &[f64],
    du: &[f64],
    total_displacement: &mut [f64],
    end_velocity: &mut [f64],
    end_acceleration: &mut [f64],
) {
    let n = du.len();
    let v = &kinematics.velocity[..n];
    let a = &kinematics.acceleration[..n];
    let dy = &translation_increment[..n];
    let total_displacement = &mut total_displacement[..n];
    let end_velocity = &mut end_velocity[..n];
    let end_acceleration = &mut end_acceleration[..n];
    for j in 0..n {
        let total = du[j] + dy[j];
        total_displacement[j] = total;
        end_velocity[j] = SchemeCoefficients::apply(scheme.new_velocity, total, v[j], a[j]);
        end_acceleration[j] = SchemeCoefficients::apply(scheme.new_acceleration, total, v[j], a[j]);
    }
}
