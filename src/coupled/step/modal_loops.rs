//! The loops of a step in modes, where every matrix is diagonal: one before contact, one after.
//!
//! | symbol | meaning |
//! |---|---|
//! | m, d, k | modal mass, damping and stiffness |
//! | 1/k_eff | reciprocals of the effective stiffness |
//! | u, v, a | coordinates at the beginning of the step |
//! | Δu, u₁, v₁, a₁ | increment, and coordinates at the end |
//! | R Δy, R ẏ | part of the free field's translation |
//!
//! The loops are separate functions: for an argument, unlike a field, the compiler can assume that no other
//! reference points to the written memory.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use crate::coupled::model::kinematics::Kinematics;
use crate::coupled::scheme::SchemeCoefficients;
use crate::coupled::step::forcing::Forcing;
use crate::coupled::step::increment::Increment;
use crate::linalg::matrix::Diagonals;
use crate::linalg::{Simd, WithSimd, vectorized};

/// Computes Δu and u₁ with the tractions fixed at their static values.
pub(crate) fn free_increment(
    scheme: &SchemeCoefficients,
    matrices: Diagonals<'_>,
    inverse: &[f64],
    kinematics: &Kinematics,
    forcing: &Forcing,
    increment: &mut Increment,
) {
    let out = increment.displacement.as_mut_slice();
    let end = increment.end.as_mut_slice();
    vectorized(FreeIncrement { scheme, matrices, inverse, kinematics, forcing, out, end });
}

/// Subtracts the response to the tractions' `force` from Δu, and computes the motion at the end.
pub(crate) fn apply_tractions(
    scheme: &SchemeCoefficients,
    inverse: &[f64],
    force: &[f64],
    kinematics: &Kinematics,
    carried: &[f64],
    increment: &mut Increment,
) {
    vectorized(ApplyTractions { scheme, inverse, force, kinematics, carried, increment });
}

struct FreeIncrement<'a> {
    scheme: &'a SchemeCoefficients,
    matrices: Diagonals<'a>,
    inverse: &'a [f64],
    kinematics: &'a Kinematics,
    forcing: &'a Forcing,
    out: &'a mut [f64],
    end: &'a mut [f64],
}

impl WithSimd for FreeIncrement<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { scheme, matrices, inverse, kinematics, forcing, out, end } = self;
        right_hand_side(scheme, matrices, kinematics, forcing, out);
        divide_by_stiffness(inverse, &kinematics.displacement, out, end);
    }
}

/// Right-hand side of the equation of motion, as `LinearStep::predict` computes it in degrees of freedom.
#[inline(always)]
fn right_hand_side(
    scheme: &SchemeCoefficients,
    matrices: Diagonals<'_>,
    kinematics: &Kinematics,
    forcing: &Forcing,
    out: &mut [f64],
) {
    let n = out.len();
    let Diagonals { mass, damping, stiffness } = matrices;
    let m = &mass[..n];
    let k = &stiffness[..n];
    let u = &kinematics.displacement[..n];
    let v = &kinematics.velocity[..n];
    let a = &kinematics.acceleration[..n];
    let load = &forcing.load[..n];
    let carried = &forcing.carried[..n];
    for j in 0..n {
        let acceleration = SchemeCoefficients::apply(scheme.acceleration, carried[j], v[j], a[j]);
        let displacement = u[j] + SchemeCoefficients::apply(scheme.displacement, 0.0, v[j], a[j]);
        out[j] = load[j] - m[j] * acceleration - k[j] * displacement;
    }
    if let Some(d) = damping {
        let d = &d[..n];
        let dragged = &forcing.dragged[..n];
        for j in 0..n {
            let velocity = SchemeCoefficients::apply(scheme.velocity, carried[j], v[j], a[j]);
            out[j] -= d[j] * (velocity - dragged[j]);
        }
    }
}

/// Computes Δu from the right-hand side, and u₁.
#[inline(always)]
fn divide_by_stiffness(inverse: &[f64], u: &[f64], out: &mut [f64], end: &mut [f64]) {
    let n = out.len();
    let inverse = &inverse[..n];
    let u = &u[..n];
    let end = &mut end[..n];
    for j in 0..n {
        out[j] *= inverse[j];
        end[j] = u[j] + out[j];
    }
}

struct ApplyTractions<'a> {
    scheme: &'a SchemeCoefficients,
    inverse: &'a [f64],
    force: &'a [f64],
    kinematics: &'a Kinematics,
    carried: &'a [f64],
    increment: &'a mut Increment,
}

impl WithSimd for ApplyTractions<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { scheme, inverse, force, kinematics, carried, increment } = self;
        let Increment { displacement, end, total, velocity, acceleration, .. } = increment;
        apply_force(inverse, force, displacement, end);
        follow(scheme, kinematics, carried, displacement, total, velocity, acceleration);
    }
}

/// Subtracts the response to the tractions' force from Δu and u₁.
#[inline(always)]
fn apply_force(inverse: &[f64], force: &[f64], out: &mut [f64], end: &mut [f64]) {
    let n = out.len();
    let inverse = &inverse[..n];
    let force = &force[..n];
    let end = &mut end[..n];
    for j in 0..n {
        let response = inverse[j] * force[j];
        out[j] -= response;
        end[j] -= response;
    }
}

/// Total increment, and velocity and acceleration at the end, as `Increment::follow` computes them.
#[inline(always)]
fn follow(
    scheme: &SchemeCoefficients,
    kinematics: &Kinematics,
    carried: &[f64],
    out: &[f64],
    total: &mut [f64],
    velocity: &mut [f64],
    acceleration: &mut [f64],
) {
    let n = out.len();
    let v = &kinematics.velocity[..n];
    let a = &kinematics.acceleration[..n];
    let carried = &carried[..n];
    let total = &mut total[..n];
    let velocity = &mut velocity[..n];
    let acceleration = &mut acceleration[..n];
    for j in 0..n {
        let du = out[j] + carried[j];
        total[j] = du;
        velocity[j] = SchemeCoefficients::apply(scheme.new_velocity, du, v[j], a[j]);
        acceleration[j] = SchemeCoefficients::apply(scheme.new_acceleration, du, v[j], a[j]);
    }
}
