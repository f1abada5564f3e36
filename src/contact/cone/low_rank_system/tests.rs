//! W of low rank against the same W, entry by entry.

use super::super::newton::Newton;
use super::super::problem::Bounds;
use super::super::system::System;
use super::super::{proximal::Proximal, search::search};
use super::*;
use crate::contact::cone::status::Normal;
use crate::contact::{OnBed, StructurePart};
use crate::linalg::{dense_multiply_add, dot};
use basemat_testkit::random::Random;

/// The same random problem with W of low rank, and with all entries of W.
fn problems(random: &mut Random, count: usize, rank: usize, friction: f64) -> [ConeProblem; 2] {
    let size = 3 * count;
    let mut low = ConeProblem::on_bed(count);
    let mut whole = ConeProblem::new(count);
    let soil: Vec<f64> = (0..size).map(|_| random.log_within(0.3, 1.0)).collect();
    let areas: Vec<f64> = (0..count).map(|_| random.within(0.5, 2.0)).collect();
    let of_components: Vec<f64> = (0..size).map(|i| areas[i % count]).collect();
    let root: Vec<f64> = (0..size * rank).map(|_| random.within(-0.5, 0.5)).collect();
    let row = |i: usize| &root[i * rank..][..rank];
    let part: Vec<f64> = (0..size * size)
        .map(|k| of_components[k % size] * dot(row(k / size), row(k % size)))
        .collect();
    let structure = StructurePart {
        diagonal: (0..size).map(|i| part[i * (size + 1)]).collect(),
        column: |j, out: &mut [f64]| (0..size).for_each(|i| out[i] = part[i * size + j]),
        product: |x: &[f64], out: &mut [f64]| dense_multiply_add(&part, 1.0, x, out),
    };
    let on_bed = OnBed::new(&soil, of_components.clone(), rank, structure).unwrap();
    let layer = |i: usize| [0.1, 0.2][(i / count).min(1)];
    low.low_rank.as_mut().unwrap().set(&on_bed, &areas, layer);
    for (k, value) in whole.w.iter_mut().enumerate() {
        *value = part[k] / of_components[k % size];
        if k.is_multiple_of(size + 1) {
            let i = k / size;
            *value += soil[i] / areas[i % count] + layer(i);
        }
    }
    for e in 0..count {
        let mut bounds = Bounds { friction, ..Bounds::WITHOUT_FRICTION };
        if random.chance(0.2) && friction < f64::INFINITY {
            bounds.strength = random.within(0.0, 0.3);
        }
        if random.chance(0.2) {
            bounds.interval[1] = random.within(0.1, 0.6);
            bounds.hardening = if bounds.interval[1] < 0.35 { 2.0 } else { 0.0 };
        }
        if random.chance(0.2) {
            bounds.offset = random.within(-0.2, 0.2);
        }
        bounds.bonded = random.chance(0.1);
        (low.bounds[e], whole.bounds[e]) = (bounds, bounds);
    }
    for i in 0..size {
        let q = random.within(-1.0, 1.0);
        let anchor = random.within(-1.0, 1.0);
        for problem in [&mut low, &mut whole] {
            (problem.q[i], problem.anchor[i]) = (q, anchor);
        }
    }
    for problem in [&mut low, &mut whole] {
        problem.min_force_scale = 1e-3;
        problem.update_scales();
    }
    [low, whole]
}

fn newton(problem: &ConeProblem) -> Newton {
    let count = problem.count;
    let Some(low_rank) = &problem.low_rank else { return Newton::new(count) };
    let mut newton = Newton::on_bed(count);
    newton.reserve(low_rank.rank());
    newton
}

/// Largest difference of the forces, relative to the largest force.
fn apart([low, whole]: &[ConeProblem; 2]) -> f64 {
    let pairs = low.change.iter().zip(&whole.change);
    pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs())) / whole.largest_force()
}

#[test]
fn blocks_and_motions_are_those_of_all_entries() {
    let mut random = Random(31);
    for case in 0..50 {
        let mut both = problems(&mut random, 3 + case % 9, case % 7, 0.5);
        let force: Vec<f64> = both[0].change.iter().map(|_| random.within(-1.0, 1.0)).collect();
        for problem in &mut both {
            problem.change.copy_from_slice(&force);
            problem.added = 0.7;
            if problem.low_rank.is_none() {
                let size = problem.size();
                problem.w.iter_mut().step_by(size + 1).for_each(|entry| *entry += 0.7);
            }
            problem.update_scales();
            problem.update_motions();
        }
        let [low, whole] = &both;
        let near = |a: f64, b: f64| (a - b).abs() < 1e-13 * (1.0 + b.abs());
        assert!(low.y.iter().zip(&whole.y).all(|(a, b)| near(*a, *b)), "case {case}");
        let blocks = low.element_blocks.as_flattened().as_flattened();
        let mut pairs = blocks.iter().zip(whole.element_blocks.as_flattened().as_flattened());
        assert!(pairs.all(|(a, b)| near(*a, *b)), "case {case}");
        assert!(
            low.rho
                .as_flattened()
                .iter()
                .zip(whole.rho.as_flattened())
                .all(|(a, b)| near(*a, *b))
        );
    }
}

/// All statuses, also of the limit of infinite friction.
#[test]
fn corrections_are_those_of_all_entries() {
    let mut random = Random(32);
    let mut unpressed = 0;
    for case in 0..400 {
        let count = 6 + case % 5;
        let rank = 3 + case % 4;
        let mut both = problems(&mut random, count, rank, 0.5);
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
            let turn = random.within(0.0, 1.0);
            let slope = random.pick(&[0.0, 0.4, 3.0, 1e4]);
            // Fewer of these than modes.
            if e < 2 && random.chance(0.5) {
                unpressed += 1;
                let slope = f64::INFINITY;
                let tangential = Tangential::Slip { direction, turn, slope };
                return Status { normal: Normal::Closed, tangential };
            }
            let slip = Tangential::Slip { direction, turn, slope };
            let tangential = random.pick(&[slip, slip, Tangential::Free, Tangential::Stick]);
            Status { normal, tangential }
        };
        let mut statuses: Vec<Status> = (0..count).map(&mut status).collect();
        if case % 10 == 9 {
            statuses.fill(Status::CLOSED_STICKING);
        }
        let mut low_rank_system = LowRankSystem::new(count);
        let mut system = System::new(count);
        low_rank_system.reserve(rank);
        for problem in &mut both {
            for bounds in &mut problem.bounds {
                (bounds.interval, bounds.attraction) = ([-0.2, 0.7], 0.3);
            }
            for i in 0..problem.size() {
                problem.change[i] = (i as f64).cos();
            }
            problem.update_motions();
        }
        assert!(low_rank_system.solve(&mut both[0], &statuses), "case {case}");
        assert!(system.solve(&mut both[1], &statuses, false), "case {case}");
        let apart = apart(&both);
        assert!(apart < 1e-8, "case {case}: {apart:e}");
    }
    assert!(unpressed > 100, "{unpressed}");
}

/// With little friction a problem has one solution (Acary et al. 2011), which all methods find.
#[test]
fn searches_find_the_same_forces() {
    let mut random = Random(33);
    let mut swept = 0;
    let mut nearing = 0;
    let mut failed = 0;
    for case in 0..60 {
        let count = 8 + case % 30;
        let rank = case % 7;
        let friction = [0.0, 0.05, 0.1, 0.8, f64::INFINITY][case % 5];
        let mut both = problems(&mut random, count, rank, friction);
        for problem in &mut both {
            let mut newton = newton(problem);
            let mut start = vec![0.0; 3 * count];
            let mut limited = start.clone();
            let mut proximal = Proximal::new(count);
            let found =
                search(problem, &mut newton, &mut proximal, &mut start, &mut limited, true).method;
            let is_solved = found.is_some() && problem.is_solved();
            failed += usize::from(!is_solved);
            // Much friction may leave no solution.
            assert!(is_solved || friction > 0.5, "case {case}");
        }
        if friction > 0.5 {
            continue;
        }
        let reference = both[1].change.clone();
        assert!(apart(&both) < 1e-8, "case {case}: {:e}", apart(&both));
        // Each method alone.
        let sweep = |problem: &mut ConeProblem| problem.sweep(500).is_solved;
        both[0].change.fill(0.0);
        if sweep(&mut both[0]) {
            swept += 1;
            assert!(apart(&both) < 1e-8, "case {case}, sweeps: {:e}", apart(&both));
        }
        both[0].change.fill(0.0);
        if Proximal::new(count).solve(&mut both[0], sweep) {
            nearing += 1;
            assert!(apart(&both) < 1e-8, "case {case}, proximal: {:e}", apart(&both));
        }
        assert_eq!(reference, both[1].change);
    }
    assert!(swept > 25 && nearing > 25 && failed < 6, "{swept} {nearing} {failed}");
}
