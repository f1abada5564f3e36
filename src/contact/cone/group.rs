//! Groups of elements that are projected together, one in each lane.
//!
//! The forces of all other elements stay fixed. The table of [`problem`](super::problem) explains the symbols.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of its caller")]

use crate::linalg::Simd;

/// Number of elements of a group.
pub(super) const LANE_COUNT: usize = 8;

/// A number for each element of a group, one in each lane.
pub(super) type GroupValues = [f64; LANE_COUNT];

/// Data of a group's elements; forces and bounds of a lane without an element are zero.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Group {
    /// q: displacement without changes of force.
    pub(super) q: [GroupValues; 3],
    /// r₀.
    pub(super) static_force: [GroupValues; 3],
    /// r − r₀.
    pub(super) force_change: [GroupValues; 3],
    /// ρ, normal and tangential.
    pub(super) rho: [GroupValues; 2],
    /// Displacements along x and y due to a unit p of the same element.
    pub(super) tangential_coupling: [GroupValues; 2],
    /// Smallest and largest p.
    pub(super) interval: [GroupValues; 2],
    pub(super) closed_gap: GroupValues,
    /// Fraction of a trial's excess over the largest p that hardening soil bears.
    pub(super) hardening_fraction: GroupValues,
    /// Whether any hardening fraction is above zero.
    pub(super) hardens: bool,
    pub(super) friction: GroupValues,
    /// Force that adds to p in friction.
    pub(super) attraction: GroupValues,
    /// Shear force that adds to friction.
    pub(super) shear_strength: GroupValues,
}

impl Group {
    /// Projects the trial forces of all elements once, p first.
    ///
    /// `displacement`: W (r − r₀) of the elements, without q. `added_diagonal`: number added to W's diagonal. Writes
    /// the changes of force to `increments`. Returns the largest sum of an element's changes, N, or NaN.
    #[inline(always)]
    pub(super) fn project<S: Simd>(
        &mut self,
        simd: S,
        displacement: &[GroupValues; 3],
        added_diagonal: f64,
        increments: &mut [GroupValues; 3],
    ) -> f64 {
        let mut largest = simd.splat_f64s(0.0);
        let mut total = largest;
        for register in 0..LANE_COUNT / S::F64_LANES {
            let sums =
                self.project_register(simd, displacement, added_diagonal, increments, register);
            largest = simd.max_f64s(largest, sums);
            total = simd.add_f64s(total, sums);
        }
        let total = simd.reduce_sum_f64s(total);
        if total.is_nan() { total } else { simd.reduce_max_f64s(largest) }
    }

    /// Projects the elements of one vector register; returns the sums of their changes.
    ///
    /// `register`: its index among those of the group.
    #[inline(always)]
    fn project_register<S: Simd>(
        &mut self,
        simd: S,
        displacement: &[GroupValues; 3],
        added_diagonal: f64,
        increments: &mut [GroupValues; 3],
        register: usize,
    ) -> S::f64s {
        let added_diagonal = simd.splat_f64s(added_diagonal);
        let zero = simd.splat_f64s(0.0);
        let mut start = [zero; 3];
        let mut y = [zero; 3];
        for k in 0..3 {
            let change = read::<S>(&self.force_change[k], register);
            start[k] = simd.add_f64s(read::<S>(&self.static_force[k], register), change);
            let q = simd.mul_add_e_f64s(added_diagonal, change, read::<S>(&self.q[k], register));
            y[k] = simd.add_f64s(read::<S>(&displacement[k], register), q);
        }
        let gap = simd.sub_f64s(y[0], read::<S>(&self.closed_gap, register));
        let trial = simd.sub_f64s(start[0], simd.mul_f64s(read::<S>(&self.rho[0], register), gap));
        let p = simd.max_f64s(trial, read::<S>(&self.interval[0], register));
        let cap = read::<S>(&self.interval[1], register);
        let mut r = [simd.min_f64s(p, cap), zero, zero];
        if self.hardens {
            let excess = simd.max_f64s(simd.sub_f64s(p, cap), zero);
            r[0] = simd.mul_add_e_f64s(read::<S>(&self.hardening_fraction, register), excess, r[0]);
        }
        let p_change = simd.sub_f64s(r[0], start[0]);
        let rho = read::<S>(&self.rho[1], register);
        for k in 1..3 {
            let coupling = read::<S>(&self.tangential_coupling[k - 1], register);
            let y = simd.mul_add_e_f64s(coupling, p_change, y[k]);
            r[k] = simd.sub_f64s(start[k], simd.mul_f64s(rho, y));
        }
        let square = simd.mul_add_e_f64s(r[1], r[1], simd.mul_f64s(r[2], r[2]));
        let shear = simd.max_f64s(simd.sqrt_f64s(square), simd.splat_f64s(f64::MIN_POSITIVE));
        let normal =
            simd.max_f64s(simd.add_f64s(r[0], read::<S>(&self.attraction, register)), zero);
        let friction_force = simd.mul_f64s(read::<S>(&self.friction, register), normal);
        let radius = simd.add_f64s(friction_force, read::<S>(&self.shear_strength, register));
        let radius_ratio = simd.min_f64s(simd.div_f64s(radius, shear), simd.splat_f64s(1.0));
        let mut sum = zero;
        for k in 0..3 {
            if k > 0 {
                r[k] = simd.mul_f64s(radius_ratio, r[k]);
            }
            let increment = simd.sub_f64s(r[k], start[k]);
            sum = simd.add_f64s(sum, simd.max_f64s(increment, simd.sub_f64s(zero, increment)));
            write::<S>(&mut increments[k], register, increment);
            let static_force = read::<S>(&self.static_force[k], register);
            write::<S>(&mut self.force_change[k], register, simd.sub_f64s(r[k], static_force));
        }
        sum
    }
}

/// Values of a group in one vector register.
#[inline(always)]
pub(super) fn read<S: Simd>(group_values: &GroupValues, register: usize) -> S::f64s {
    S::as_simd_f64s(group_values).0[register]
}

/// Writes the values of one vector register to those of a group.
#[inline(always)]
pub(super) fn write<S: Simd>(group_values: &mut GroupValues, register: usize, values: S::f64s) {
    S::as_mut_simd_f64s(group_values).0[register] = values;
}
