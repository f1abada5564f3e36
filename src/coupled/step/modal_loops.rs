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

/// Computes Δu and u₁ with the tractions held at their static values.
pub(crate) fn free(
    scheme: &SchemeCoefficients,
    matrices: Diagonals<'_>,
    inverse: &[f64],
    kinematics: &Kinematics,
    forcing: &Forcing,
    increment: &mut Increment,
) {
    let [out, end] = [&mut increment.displacement, &mut increment.end].map(Vec::as_mut_slice);
    vectorized(Free { scheme, matrices, inverse, kinematics, forcing, out, end });
}

/// Subtracts the response to the tractions' `force` from Δu, and computes the motion at the end.
pub(crate) fn answer(
    scheme: &SchemeCoefficients,
    inverse: &[f64],
    force: &[f64],
    kinematics: &Kinematics,
    carried: &[f64],
    increment: &mut Increment,
) {
    vectorized(Answer { scheme, inverse, force, kinematics, carried, increment });
}

struct Free<'a> {
    scheme: &'a SchemeCoefficients,
    matrices: Diagonals<'a>,
    inverse: &'a [f64],
    kinematics: &'a Kinematics,
    forcing: &'a Forcing,
    out: &'a mut [f64],
    end: &'a mut [f64],
}

impl WithSimd for Free<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { scheme, matrices, inverse, kinematics, forcing, out, end } = self;
        balance(scheme, matrices, kinematics, forcing, out);
        release(inverse, &kinematics.displacement, out, end);
    }
}

/// Right-hand side of the equation of motion, as `LinearStep::predict` computes it in degrees of freedom.
#[inline(always)]
fn balance(
    scheme: &SchemeCoefficients,
    matrices: Diagonals<'_>,
    kinematics: &Kinematics,
    forcing: &Forcing,
    out: &mut [f64],
) {
    let n = out.len();
    let Diagonals { mass, damping, stiffness } = matrices;
    let (m, k) = (&mass[..n], &stiffness[..n]);
    let (u, v, a) =
        (&kinematics.displacement[..n], &kinematics.velocity[..n], &kinematics.acceleration[..n]);
    let (load, carried) = (&forcing.load[..n], &forcing.carried[..n]);
    for j in 0..n {
        let acceleration = SchemeCoefficients::apply(scheme.acceleration, carried[j], v[j], a[j]);
        let displacement = u[j] + SchemeCoefficients::apply(scheme.displacement, 0.0, v[j], a[j]);
        out[j] = load[j] - m[j] * acceleration - k[j] * displacement;
    }
    if let Some(d) = damping {
        let (d, dragged) = (&d[..n], &forcing.dragged[..n]);
        for j in 0..n {
            let velocity = SchemeCoefficients::apply(scheme.velocity, carried[j], v[j], a[j]);
            out[j] -= d[j] * (velocity - dragged[j]);
        }
    }
}

/// Computes Δu from the right-hand side, and u₁.
#[inline(always)]
fn release(inverse: &[f64], u: &[f64], out: &mut [f64], end: &mut [f64]) {
    let n = out.len();
    let (inverse, u, end) = (&inverse[..n], &u[..n], &mut end[..n]);
    for j in 0..n {
        out[j] *= inverse[j];
        end[j] = u[j] + out[j];
    }
}

struct Answer<'a> {
    scheme: &'a SchemeCoefficients,
    inverse: &'a [f64],
    force: &'a [f64],
    kinematics: &'a Kinematics,
    carried: &'a [f64],
    increment: &'a mut Increment,
}

impl WithSimd for Answer<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { scheme, inverse, force, kinematics, carried, increment } = self;
        let Increment { displacement, end, total, velocity, acceleration, .. } = increment;
        apply_force(inverse, force, displacement, end);
        follow(scheme, kinematics, carried, displacement, total, [velocity, acceleration]);
    }
}

/// Subtracts the response to the tractions' force from Δu and u₁.
#[inline(always)]
fn apply_force(inverse: &[f64], force: &[f64], out: &mut [f64], end: &mut [f64]) {
    let n = out.len();
    let (inverse, force, end) = (&inverse[..n], &force[..n], &mut end[..n]);
    for j in 0..n {
        let taken = inverse[j] * force[j];
        out[j] -= taken;
        end[j] -= taken;
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
    [velocity, acceleration]: [&mut [f64]; 2],
) {
    let n = out.len();
    let (v, a, carried) = (&kinematics.velocity[..n], &kinematics.acceleration[..n], &carried[..n]);
    let (total, velocity, acceleration) =
        (&mut total[..n], &mut velocity[..n], &mut acceleration[..n]);
    for j in 0..n {
        let du = out[j] + carried[j];
        total[j] = du;
        velocity[j] = SchemeCoefficients::apply(scheme.new_velocity, du, v[j], a[j]);
        acceleration[j] = SchemeCoefficients::apply(scheme.new_acceleration, du, v[j], a[j]);
    }
}
