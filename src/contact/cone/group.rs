//! Elements of a group, one in each lane, solved together with the forces of all others fixed.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of its caller")]

use crate::linalg::Simd;

/// Number of elements of a group.
pub(super) const LANE_COUNT: usize = 8;

/// A number for each element of a group.
pub(super) type Lane = [f64; LANE_COUNT];

/// Numbers of a group's elements; forces and bounds of a lane without an element are zero.
#[derive(Debug, Clone, Copy)]
pub(super) struct Group {
    pub(super) q: [Lane; 3],
    pub(super) anchor: [Lane; 3],
    pub(super) change: [Lane; 3],
    /// ρ, normal and tangential.
    pub(super) rho: [Lane; 2],
    /// Motion along x and y by a p of the same element.
    pub(super) turned: [Lane; 2],
    /// Smallest and largest p, and the gap when closed.
    pub(super) interval: [Lane; 2],
    pub(super) offset: Lane,
    /// Part of a trial's excess over the largest p that hardening soil bears, and whether any is above zero.
    pub(super) hardening_fraction: Lane,
    pub(super) hardens: bool,
    /// Friction, and forces that add to p and to the radius.
    pub(super) friction: Lane,
    pub(super) attraction: Lane,
    pub(super) strength: Lane,
}

impl Group {
    /// Group without elements.
    pub(super) const WITHOUT_ELEMENTS: Self = {
        let zero = [0.0; LANE_COUNT];
        Self {
            q: [zero; 3],
            anchor: [zero; 3],
            change: [zero; 3],
            rho: [zero; 2],
            turned: [zero; 2],
            interval: [zero; 2],
            offset: zero,
            hardening_fraction: zero,
            hardens: false,
            friction: zero,
            attraction: zero,
            strength: zero,
        }
    };

    /// Projects the elements once, p first, and writes the changes of force to `moved`.
    ///
    /// `motion`: their motions by W, without q; `added`: a number on W's diagonal.
    /// Returns the largest sum of the changes of an element, N, or NaN.
    #[inline(always)]
    pub(super) fn solve<S: Simd>(
        &mut self,
        simd: S,
        motion: &[Lane; 3],
        added: f64,
        moved: &mut [Lane; 3],
    ) -> f64 {
        let mut largest = simd.splat_f64s(0.0);
        let mut sum = largest;
        for part in 0..LANE_COUNT / S::F64_LANES {
            let size = self.solve_part(simd, motion, added, moved, part);
            largest = simd.max_f64s(largest, size);
            sum = simd.add_f64s(sum, size);
        }
        let sum = simd.reduce_sum_f64s(sum);
        if sum.is_nan() { sum } else { simd.reduce_max_f64s(largest) }
    }

    /// Solves the elements of one vector register; returns the sums of their changes.
    #[inline(always)]
    fn solve_part<S: Simd>(
        &mut self,
        simd: S,
        motion: &[Lane; 3],
        added: f64,
        moved: &mut [Lane; 3],
        part: usize,
    ) -> S::f64s {
        let added = simd.splat_f64s(added);
        let zero = simd.splat_f64s(0.0);
        let mut start = [zero; 3];
        let mut y = [zero; 3];
        for k in 0..3 {
            let change = read::<S>(&self.change[k], part);
            start[k] = simd.add_f64s(read::<S>(&self.anchor[k], part), change);
            let by_added = simd.mul_add_e_f64s(added, change, read::<S>(&self.q[k], part));
            y[k] = simd.add_f64s(read::<S>(&motion[k], part), by_added);
        }
        let gap = simd.sub_f64s(y[0], read::<S>(&self.offset, part));
        let trial = simd.sub_f64s(start[0], simd.mul_f64s(read::<S>(&self.rho[0], part), gap));
        let p = simd.max_f64s(trial, read::<S>(&self.interval[0], part));
        let cap = read::<S>(&self.interval[1], part);
        let mut r = [simd.min_f64s(p, cap), zero, zero];
        if self.hardens {
            let excess = simd.max_f64s(simd.sub_f64s(p, cap), zero);
            r[0] = simd.mul_add_e_f64s(read::<S>(&self.hardening_fraction, part), excess, r[0]);
        }
        let pressed = simd.sub_f64s(r[0], start[0]);
        let rho = read::<S>(&self.rho[1], part);
        for k in 1..3 {
            let y = simd.mul_add_e_f64s(read::<S>(&self.turned[k - 1], part), pressed, y[k]);
            r[k] = simd.sub_f64s(start[k], simd.mul_f64s(rho, y));
        }
        let size = simd.mul_add_e_f64s(r[1], r[1], simd.mul_f64s(r[2], r[2]));
        let size = simd.max_f64s(simd.sqrt_f64s(size), simd.splat_f64s(f64::MIN_POSITIVE));
        let pressing = simd.add_f64s(r[0], read::<S>(&self.attraction, part));
        let pressing =
            simd.mul_f64s(read::<S>(&self.friction, part), simd.max_f64s(pressing, zero));
        let radius = simd.add_f64s(pressing, read::<S>(&self.strength, part));
        let ratio = simd.min_f64s(simd.div_f64s(radius, size), simd.splat_f64s(1.0));
        let mut sum = zero;
        for k in 0..3 {
            if k > 0 {
                r[k] = simd.mul_f64s(ratio, r[k]);
            }
            let change = simd.sub_f64s(r[k], start[k]);
            sum = simd.add_f64s(sum, simd.max_f64s(change, simd.sub_f64s(zero, change)));
            write::<S>(&mut moved[k], part, change);
            let anchor = read::<S>(&self.anchor[k], part);
            write::<S>(&mut self.change[k], part, simd.sub_f64s(r[k], anchor));
        }
        sum
    }
}

/// Numbers that an instruction takes.
#[inline(always)]
pub(super) fn read<S: Simd>(lane: &Lane, part: usize) -> S::f64s {
    S::as_simd_f64s(lane).0[part]
}

/// Writes numbers that an instruction returns.
#[inline(always)]
pub(super) fn write<S: Simd>(lane: &mut Lane, part: usize, values: S::f64s) {
    S::as_mut_simd_f64s(lane).0[part] = values;
}
