//! The linear systems of statuses, for unknown forces and for unknown displacements.

use super::random_problem;
use crate::contact::cone::problem::ConeProblem;
use crate::contact::cone::status::{Normal, Status, Tangential};
use crate::contact::cone::system::System;
use basemat_testkit::random::Random;

/// Number of elements of each problem.
const ELEMENT_COUNT: usize = 6;

/// Random statuses with fewer unknown displacements than forces; every tenth case sticks everywhere.
fn random_statuses(random: &mut Random, case: usize) -> Vec<Status> {
    let status = |e: usize| {
        let bound = [Normal::Open, Normal::Capped, Normal::Hardening(0.7)][case % 3];
        let normal = if e > 3 { bound } else { Normal::Closed };
        let angle: f64 = random.within(0.0, 6.0);
        let radius_ratio = random.within(0.0, 1.0);
        let radius_slope = random.pick(&[0.0, 0.4, 3.0, 1e4]);
        let direction = [angle.cos(), angle.sin()];
        let tangential = match (e, case % 4) {
            (0, _) | (4, 2 | 3) => Tangential::Slip { direction, radius_ratio, radius_slope },
            (4 | 5, _) => Tangential::Free,
            _ => Tangential::Stick,
        };
        Status { normal, tangential }
    };
    let mut statuses: Vec<Status> = (0..ELEMENT_COUNT).map(status).collect();
    if case % 10 == 9 {
        statuses.fill(Status::CLOSED_STICKING);
    }
    statuses
}

/// Residuals of the conditions of an element's status, normal and tangential.
fn condition_residuals(problem: &ConeProblem, e: usize, status: &Status) -> [f64; 3] {
    let bounds = &problem.bounds[e];
    let indices = problem.component_indices(e);
    let [p, tx, ty] = indices.map(|i| problem.force(i));
    let [gap, x, y] = indices.map(|i| problem.y[i]);
    let normal = match status.normal {
        Normal::Open => p - bounds.interval[0],
        Normal::Closed => gap - bounds.closed_gap,
        Normal::Capped => p - bounds.interval[1],
        Normal::Hardening(k) => p - bounds.interval[1] - k * (bounds.closed_gap - gap),
    };
    let [shear_x, shear_y] = match status.tangential {
        Tangential::Free => [tx, ty],
        Tangential::Stick => [x, y],
        Tangential::Slip { direction: [c, s], radius_ratio, radius_slope } => [
            c * tx + s * ty - radius_slope * (p + bounds.attraction) - bounds.shear_strength,
            (1.0 - radius_ratio) * (c * ty - s * tx)
                + radius_ratio * problem.rho[e][1] * (c * y - s * x),
        ],
    };
    [normal, shear_x, shear_y]
}

/// Both systems meet the conditions of the statuses.
///
/// A step has the same bits whatever was solved before.
#[test]
fn unknown_forces_or_displacements_meet_the_conditions_of_statuses() {
    let mut random = Random(3);
    let mut other_bits_count = 0;
    for case in 0..100 {
        let mut problem = random_problem(&mut random, ELEMENT_COUNT, 0.5);
        problem.static_force.iter_mut().for_each(|force| *force = random.within(-1.0, 1.0));
        let statuses = random_statuses(&mut random, case);
        for bounds in &mut problem.bounds {
            bounds.interval = [-0.2, 0.7];
            bounds.attraction = 0.3;
        }
        let mut system = System::new(ELEMENT_COUNT);
        let mut first_change = Vec::new();
        let mut other_statuses = statuses.clone();
        other_statuses[1] = Status::OPEN_FREE;
        for trial in 0..40 {
            let is_constant = trial >= 20;
            if trial % 20 == 0 {
                system.invalidate(is_constant);
            }
            // Arbitrary earlier solutions.
            for _ in 0..trial * usize::from(trial % 20 > 0) {
                problem.reset_forces();
                let earlier_statuses = [&other_statuses, &statuses][trial % 2];
                system.solve(&mut problem, earlier_statuses, trial % 3 == 0, 0.0);
            }
            system.begin_step(problem.has_hardening());
            problem.reset_forces();
            assert!(system.solve(&mut problem, &statuses, false, 0.0), "case {case}");
            problem.update_displacements();
            if trial % 20 == 0 {
                let has_other_bits = is_constant && first_change != problem.force_change;
                other_bits_count += usize::from(has_other_bits);
                first_change.clone_from(&problem.force_change);
            }
            assert_eq!(first_change, problem.force_change, "case {case}, {trial}");
            let tolerance = 1e-9 * problem.largest_force();
            for (e, status) in statuses.iter().enumerate() {
                for residual in condition_residuals(&problem, e, status) {
                    assert!(residual.abs() < tolerance, "{case}, {trial}, {e}: {residual:e}");
                }
            }
        }
    }
    // Both systems were solved.
    assert!(other_bits_count > 80, "{other_bits_count}");
}

/// Iterations reach their tolerance, are the same whatever was solved before, and end in factors where they do not converge.
#[test]
fn iterations_on_hardening_soil_meet_the_conditions_to_their_tolerance() {
    let mut random = Random(4);
    let count = 24;
    let mut problem = random_problem(&mut random, count, 0.5);
    let size = problem.component_count();
    let mut different_count = 0;
    for case in 0..40 {
        // Elements that move each other little, as on soil, or much.
        let coupling = [1e-3, 1e-2, 0.3][case % 3];
        for (k, entry) in problem.w.iter_mut().enumerate() {
            let row = k / size;
            let column = k % size;
            let phase = (1 + row.min(column)) as f64 * (1 + row.max(column)) as f64;
            *entry = if row == column { 1.0 } else { coupling * phase.sin() };
        }
        problem.update_scales();
        problem.q.iter_mut().for_each(|value| *value = random.within(-1.0, 1.0));
        for bounds in &mut problem.bounds {
            bounds.interval = [-0.2, 0.7];
            bounds.hardening = 0.7;
        }
        let angle: f64 = random.within(0.0, 6.0);
        let statuses: Vec<Status> = (0..count)
            .map(|e| Status {
                normal: [Normal::Closed, Normal::Hardening(0.7), Normal::Open][e % 3],
                tangential: [
                    Tangential::Stick,
                    Tangential::Slip {
                        direction: [angle.cos(), angle.sin()],
                        radius_ratio: 0.6,
                        radius_slope: 0.5,
                    },
                ][e / 3 % 2],
            })
            .collect();
        let mut system = System::new(count);
        let mut changes = Vec::new();
        for linear_tolerance in [1e-3, 1e-3, 1e-5, 0.0] {
            problem.reset_forces();
            let largest_before = problem.q.iter().fold(0.0_f64, |max, value| max.max(value.abs()));
            system.begin_step(problem.has_hardening());
            assert!(system.solve(&mut problem, &statuses, false, linear_tolerance));
            problem.update_displacements();
            let tolerance = 30.0 * linear_tolerance.max(1e-13) * largest_before;
            for (e, status) in statuses.iter().enumerate() {
                for residual in condition_residuals(&problem, e, status) {
                    assert!(residual.abs() < tolerance, "{case}, {e}: {residual:e}, {tolerance:e}");
                }
            }
            changes.push(problem.force_change.clone());
        }
        assert_eq!(changes[0], changes[1]);
        // One iteration may reach both tolerances if the elements move each other little.
        different_count += usize::from(changes[1] != changes[2]);
    }
    assert!(different_count > 20, "iterations end at their tolerance: {different_count}");
}
