//! W of low rank against the same W, entry by entry.

use super::super::newton::Newton;
use super::super::problem::Bounds;
use super::super::system::System;
use super::super::{compliance::ComplianceForm, proximal::Proximal, search::find_forces};
use super::*;
use crate::contact::cone::status::Normal;
use crate::contact::{OnBed, StructurePart};
use crate::linalg::{dense_multiply_add, dot};
use basemat_testkit::random::Random;

/// The same random problem with W of low rank, and with all entries of W.
fn problems(
    random: &mut Random,
    count: usize,
    mode_count: usize,
    friction: f64,
) -> [ConeProblem; 2] {
    let size = 3 * count;
    let mut low_rank = ConeProblem::on_bed(count);
    let mut dense = ConeProblem::new(count);
    let soil: Vec<f64> = (0..size).map(|_| random.log_within(0.3, 1.0)).collect();
    let areas: Vec<f64> = (0..count).map(|_| random.within(0.5, 2.0)).collect();
    let component_areas: Vec<f64> = (0..size).map(|i| areas[i % count]).collect();
    let modes: Vec<f64> = (0..size * mode_count).map(|_| random.within(-0.5, 0.5)).collect();
    let row = |i: usize| &modes[i * mode_count..][..mode_count];
    let structure_entries: Vec<f64> = (0..size * size)
        .map(|k| component_areas[k % size] * dot(row(k / size), row(k % size)))
        .collect();
    let structure = StructurePart {
        diagonal: |i: usize| structure_entries[i * (size + 1)],
        column: |j, column: &mut [f64]| {
            (0..size).for_each(|i| column[i] = structure_entries[i * size + j]);
        },
        product: |x: &[f64], product: &mut [f64]| {
            dense_multiply_add(&structure_entries, 1.0, x, product);
        },
    };
    let on_bed = OnBed::new(&soil, component_areas.clone(), mode_count, structure).unwrap();
    let layer = |i: usize| [0.1, 0.2][(i / count).min(1)];
    let ComplianceForm::LowRank(operator) = &mut low_rank.form else {
        unreachable!()
    };
    operator.assemble(&on_bed, &areas, layer);
    for (k, value) in dense.w.iter_mut().enumerate() {
        *value = structure_entries[k] / component_areas[k % size];
        if k.is_multiple_of(size + 1) {
            let i = k / size;
            *value += soil[i] / areas[i % count] + layer(i);
        }
    }
    for e in 0..count {
        let mut bounds = Bounds { friction, ..Bounds::WITHOUT_FRICTION };
        if random.chance(0.2) && friction < f64::INFINITY {
            bounds.shear_strength = random.within(0.0, 0.3);
        }
        if random.chance(0.2) {
            bounds.interval[1] = random.within(0.1, 0.6);
            bounds.hardening = if bounds.interval[1] < 0.35 { 2.0 } else { 0.0 };
        }
        if random.chance(0.2) {
            bounds.closed_gap = random.within(-0.2, 0.2);
        }
        bounds.is_bonded = random.chance(0.1);
        low_rank.bounds[e] = bounds;
        dense.bounds[e] = bounds;
    }
    for i in 0..size {
        let q = random.within(-1.0, 1.0);
        let static_force = random.within(-1.0, 1.0);
        for problem in [&mut low_rank, &mut dense] {
            problem.q[i] = q;
            problem.static_force[i] = static_force;
        }
    }
    for problem in [&mut low_rank, &mut dense] {
        problem.min_force_scale = 1e-3;
        problem.update_scales();
    }
    [low_rank, dense]
}

/// Newton's method for the form of the problem's W.
fn newton(problem: &ConeProblem) -> Newton {
    let count = problem.element_count;
    let Some(low_rank) = problem.form.low_rank() else { return Newton::new(count) };
    let mut newton = Newton::on_bed(count);
    newton.reserve(low_rank.mode_count());
    newton
}

/// Largest difference of the forces, relative to the largest force.
fn force_difference([low_rank, dense]: &[ConeProblem; 2]) -> f64 {
    let pairs = low_rank.force_change.iter().zip(&dense.force_change);
    pairs.fold(0.0, |max: f64, (a, b)| max.max((a - b).abs())) / dense.largest_force()
}

#[test]
fn blocks_and_displacements_are_those_of_all_entries() {
    let mut random = Random(31);
    for case in 0..50 {
        let mut both = problems(&mut random, 3 + case % 9, case % 7, 0.5);
        let force: Vec<f64> =
            both[0].force_change.iter().map(|_| random.within(-1.0, 1.0)).collect();
        for problem in &mut both {
            problem.force_change.copy_from_slice(&force);
            problem.added_diagonal = 0.7;
            if problem.form.low_rank().is_none() {
                let size = problem.component_count();
                problem.w.iter_mut().step_by(size + 1).for_each(|entry| *entry += 0.7);
            }
            problem.update_scales();
            problem.update_displacements();
        }
        let [low_rank, dense] = &both;
        let blocks = low_rank.element_blocks.as_flattened().as_flattened();
        let expected_blocks = dense.element_blocks.as_flattened().as_flattened();
        let rho = low_rank.rho.as_flattened();
        for (computed, expected) in [
            (low_rank.y.as_slice(), dense.y.as_slice()),
            (blocks, expected_blocks),
            (rho, dense.rho.as_flattened()),
        ] {
            for (a, b) in computed.iter().zip(expected) {
                assert!((a - b).abs() < 1e-13 * (1.0 + b.abs()), "case {case}: {a} {b}");
            }
        }
    }
}

/// All statuses, also of the limit of infinite friction.
#[test]
fn corrections_are_those_of_all_entries() {
    let mut random = Random(32);
    let mut pressureless_count = 0;
    for case in 0..400 {
        let count = 6 + case % 5;
        let mode_count = 3 + case % 4;
        let mut both = problems(&mut random, count, mode_count, 0.5);
        let mut status = |e: usize| {
            let normal = random.pick(&[
                Normal::Open,
                Normal::Closed,
                Normal::Closed,
                Normal::Capped,
                Normal::Hardening(0.7),
            ]);
            let angle: f64 = random.within(0.0, 6.0);
            let direction = [angle.cos(), angle.sin()];
            let radius_ratio = random.within(0.0, 1.0);
            let radius_slope = random.pick(&[0.0, 0.4, 3.0, 1e4]);
            // Fewer elements slide without pressure than there are modes.
            if e < 2 && random.chance(0.5) {
                pressureless_count += 1;
                let radius_slope = f64::INFINITY;
                let tangential = Tangential::Slip { direction, radius_ratio, radius_slope };
                return Status { normal: Normal::Closed, tangential };
            }
            let slip = Tangential::Slip { direction, radius_ratio, radius_slope };
            let tangential = random.pick(&[slip, slip, Tangential::Free, Tangential::Stick]);
            Status { normal, tangential }
        };
        let mut statuses: Vec<Status> = (0..count).map(&mut status).collect();
        if case % 10 == 9 {
            statuses.fill(Status::CLOSED_STICKING);
        }
        let mut low_rank_system = LowRankSystem::new(count);
        let mut system = System::new(count);
        low_rank_system.reserve(mode_count);
        for problem in &mut both {
            for bounds in &mut problem.bounds {
                bounds.interval = [-0.2, 0.7];
                bounds.attraction = 0.3;
            }
            for i in 0..problem.component_count() {
                problem.force_change[i] = (i as f64).cos();
            }
            problem.update_displacements();
        }
        assert!(low_rank_system.solve(&mut both[0], &statuses), "case {case}");
        assert!(system.solve(&mut both[1], &statuses, false, 0.0), "case {case}");
        let difference = force_difference(&both);
        assert!(difference < 1e-8, "case {case}: {difference:e}");
    }
    assert!(pressureless_count > 100, "{pressureless_count}");
}

/// With little friction a problem has one solution (Acary et al. 2011), which all methods find.
#[test]
fn searches_find_the_same_forces() {
    let mut random = Random(33);
    let mut sweep_count = 0;
    let mut proximal_count = 0;
    let mut failure_count = 0;
    for case in 0..60 {
        let count = 8 + case % 30;
        let mode_count = case % 7;
        let friction = [0.0, 0.05, 0.1, 0.8, f64::INFINITY][case % 5];
        let mut both = problems(&mut random, count, mode_count, friction);
        for problem in &mut both {
            let mut newton = newton(problem);
            let mut scratch = [(); 2].map(|()| vec![0.0; 3 * count]);
            let [initial, limited] = &mut scratch;
            let mut proximal = Proximal::new(count);
            let outcome = find_forces(problem, &mut newton, &mut proximal, initial, limited, true);
            let is_solved = outcome.method.is_some() && problem.is_solved();
            failure_count += usize::from(!is_solved);
            // Much friction may leave no solution.
            assert!(is_solved || friction > 0.5, "case {case}");
        }
        if friction > 0.5 {
            continue;
        }
        let reference = both[1].force_change.clone();
        let difference = force_difference(&both);
        assert!(difference < 1e-8, "case {case}: {difference:e}");
        // Each method alone.
        let sweep = |problem: &mut ConeProblem| problem.sweep(500).is_solved;
        both[0].force_change.fill(0.0);
        if sweep(&mut both[0]) {
            sweep_count += 1;
            let difference = force_difference(&both);
            assert!(difference < 1e-8, "case {case}, sweeps: {difference:e}");
        }
        both[0].force_change.fill(0.0);
        if Proximal::new(count).solve(&mut both[0], sweep) {
            proximal_count += 1;
            let difference = force_difference(&both);
            assert!(difference < 1e-8, "case {case}, proximal: {difference:e}");
        }
        assert_eq!(reference, both[1].force_change);
    }
    assert!(
        sweep_count > 25 && proximal_count > 25 && failure_count < 6,
        "{sweep_count} {proximal_count} {failure_count}"
    );
}
