//! Sweeps over groups of elements, with a far-field correction after several sweeps.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of its caller")]

use super::compliance::ComplianceForm;
use super::group::{Group, LANE_COUNT};
use super::near_field::NearFieldBlocks;
use super::problem::{
    ConeProblem, MIN_SWEEPS_FOR_RATE, SWEEP_TOLERANCE_FACTOR, SolveOutcome, is_too_slow, max_or_nan,
};
use crate::linalg::{Simd, WithSimd, vectorized};

/// Largest change in a sweep after which a far-field correction follows.
///
/// It is relative to the change in the first sweep since the last correction. Further sweeps would converge to forces
/// that the correction changes.
const FAR_FIELD_UPDATE_FRACTION: f64 = 3e-2;
/// Largest number of sweeps between far-field corrections.
const FAR_FIELD_UPDATE_INTERVAL: usize = 12;
/// Largest change between the last two far-field corrections, relative to the change at which sweeps end.
const FAR_FIELD_TOLERANCE_FACTOR: f64 = 10.0;

impl ConeProblem {
    /// Sweeps over groups up to `max_sweep_count` times, as [`ConeProblem::sweep`].
    ///
    /// Each sweep updates the displacements of near elements; a correction after several sweeps updates all others.
    pub(super) fn sweep_near_field(&mut self, max_sweep_count: usize) -> SolveOutcome {
        self.update_displacements();
        self.read_groups();
        let mut previous_far_change = f64::INFINITY;
        // Sweeps since the last far-field correction, and the changes in the first and the last of them.
        let mut sweep_count = 0;
        let mut first_change = 0.0;
        let mut last_change = f64::INFINITY;
        let tolerance = SWEEP_TOLERANCE_FACTOR * self.tolerance();
        for sweep in 1..=max_sweep_count {
            let largest_change = self.form.near_field_mut().map_or(f64::NAN, |near_field| {
                let added_diagonal = self.added_diagonal;
                vectorized(NearFieldSweep { near_field, added_diagonal })
            });
            if largest_change.is_nan() {
                self.write_groups();
                return SolveOutcome::new(sweep, false);
            }
            sweep_count += 1;
            if sweep_count == 1 {
                first_change = largest_change;
            }
            if largest_change > tolerance.max(FAR_FIELD_UPDATE_FRACTION * first_change)
                && sweep_count < FAR_FIELD_UPDATE_INTERVAL
            {
                if sweep_count > MIN_SWEEPS_FOR_RATE && largest_change >= last_change {
                    self.write_groups();
                    return SolveOutcome::new(sweep, self.is_solved());
                }
                last_change = largest_change;
                continue;
            }
            let far_change = self.add_far_field();
            if largest_change <= tolerance
                && far_change <= FAR_FIELD_TOLERANCE_FACTOR * tolerance
                && self.near_field_is_solved()
            {
                return SolveOutcome::new(sweep, true);
            }
            // Factor by which these sweeps reduce the change.
            let rate = far_change / previous_far_change;
            let remaining_sweeps = (tolerance / far_change).ln() / rate.ln() * sweep_count as f64;
            if is_too_slow(rate, remaining_sweeps, sweep, max_sweep_count) {
                return SolveOutcome::new(sweep, self.near_field_is_solved());
            }
            previous_far_change = far_change;
            last_change = f64::INFINITY;
            sweep_count = 0;
        }
        self.write_groups();
        SolveOutcome::new(max_sweep_count, self.is_solved())
    }

    /// Copies the data of all elements to their groups.
    fn read_groups(&mut self) {
        let mut form = std::mem::take(&mut self.form);
        if let Some(near_field) = form.near_field_mut() {
            near_field.applied_change.copy_from_slice(&self.force_change);
            for (group, elements) in near_field.group_data.iter_mut().zip(&near_field.groups) {
                *group = self.group(*elements);
            }
        }
        self.form = form;
    }

    /// Data of a group of elements, one in each lane.
    fn group(&self, elements: [usize; LANE_COUNT]) -> Group {
        let mut group = Group::default();
        for (lane, e) in elements.into_iter().enumerate().filter(|(_, e)| *e < self.element_count) {
            let bounds = &self.bounds[e];
            for (k, i) in self.component_indices(e).into_iter().enumerate() {
                group.q[k][lane] = self.q[i];
                group.static_force[k][lane] = self.static_force[i];
                group.force_change[k][lane] = self.force_change[i];
            }
            let block = &self.element_blocks[e];
            (0..2).for_each(|k| group.tangential_coupling[k][lane] = block[k + 1][0]);
            (0..2).for_each(|k| group.rho[k][lane] = self.rho[e][k]);
            let unbounded = [f64::NEG_INFINITY, f64::INFINITY];
            let interval = if bounds.is_bonded { unbounded } else { bounds.interval };
            (0..2).for_each(|k| group.interval[k][lane] = interval[k]);
            if bounds.hardening > 0.0 && !bounds.is_bonded {
                group.hardening_fraction[lane] = bounds.hardening_fraction(self.rho[e][0]);
                group.hardens = true;
            }
            group.closed_gap[lane] = bounds.closed_gap;
            group.attraction[lane] = bounds.attraction;
            if bounds.is_bonded {
                group.shear_strength[lane] = f64::INFINITY;
            } else {
                group.friction[lane] = bounds.effective_friction();
                group.shear_strength[lane] = bounds.shear_strength;
            }
        }
        group
    }

    /// Copies the forces of all groups to their elements.
    fn write_groups(&mut self) {
        let Self { form, force_change, element_count, .. } = self;
        let Some(near_field) = form.near_field() else { return };
        for (elements, group) in near_field.groups.iter().zip(&near_field.group_data) {
            for (lane, e) in elements.iter().enumerate().filter(|(_, e)| **e < *element_count) {
                (0..3).for_each(|k| {
                    force_change[k * *element_count + e] = group.force_change[k][lane];
                });
            }
        }
    }

    /// Far-field correction: adds the displacements due to changes of force on distant elements.
    ///
    /// Returns the largest change of force since the last correction, N.
    fn add_far_field(&mut self) -> f64 {
        self.write_groups();
        let Self { form: ComplianceForm::NearField(near_field), force_change, .. } = self else {
            return f64::NAN;
        };
        let mut increment = std::mem::take(&mut near_field.applied_change);
        let mut largest_change = 0.0_f64;
        for (increment, change) in increment.iter_mut().zip(&*force_change) {
            *increment = change - *increment;
            largest_change = largest_change.max(increment.abs());
        }
        near_field.add_far_displacements(&increment);
        increment.copy_from_slice(force_change);
        near_field.applied_change = increment;
        largest_change
    }
}

/// One sweep over all groups, which moves near elements, and all elements by the structure.
struct NearFieldSweep<'a> {
    near_field: &'a mut NearFieldBlocks,
    added_diagonal: f64,
}

impl WithSimd for NearFieldSweep<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let Self { near_field, added_diagonal } = self;
        let mut largest_change = 0.0;
        let mut increments = [[0.0; LANE_COUNT]; 3];
        for g in 0..near_field.groups.len() {
            let displacement = near_field.displacement(simd, g);
            let group = &mut near_field.group_data[g];
            let change = group.project(simd, &displacement, added_diagonal, &mut increments);
            near_field.add_group_forces(simd, g, &increments);
            largest_change = max_or_nan(largest_change, change);
        }
        largest_change
    }
}
