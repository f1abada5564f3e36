//! Blocks against W itself.

use super::super::newton::Newton;
use super::super::problem::{Bounds, Problem};
use super::super::{proximal::Proximal, search::search};
use super::*;
use basemat_problems::random::Random;

/// Elements along a side of the mat.
const SIDE: usize = 10;
const COUNT: usize = SIDE * SIDE;

/// Compliance between two elements of a lattice, without the structure.
fn soil(row: usize, column: usize) -> f64 {
    let place = |i: usize| [i % COUNT % SIDE, i % COUNT / SIDE].map(|k| k as f64);
    let ([x, y], [a, b]) = (place(row), place(column));
    let (along, across) = (a - x, b - y);
    let far = along.hypot(across);
    match (row / COUNT, column / COUNT) {
        (i, j) if i == j => (-3.0 * far).exp() * if i == 0 { 0.8 } else { 1.0 },
        (0, 1) => 0.1 * along * (-4.0 * far).exp(),
        (1, 0) => -0.1 * along * (-4.0 * far).exp(),
        _ => 0.0,
    }
}

/// A rigid body on the lattice that partly lifts off and slides, and its W.
fn problem(random: &mut Random, friction: f64) -> Problem {
    let size = 3 * COUNT;
    let mut problem = Problem::new(COUNT);
    let arm = |e: usize| [e % SIDE, e / SIDE].map(|k| k as f64 - 0.5 * (SIDE - 1) as f64);
    let modes: Vec<[f64; 4]> = (0..size)
        .map(|i| {
            let [x, y] = arm(i % COUNT);
            [[0.1, 0.0, 0.02 * x, 0.02 * y], [0.0, 0.1, 0.0, 0.05], [0.0, 0.0, 0.05, 0.0]]
                [i / COUNT]
        })
        .collect();
    for i in 0..size {
        for j in 0..size {
            let rigid: f64 = modes[i].iter().zip(&modes[j]).map(|(a, b)| a * b).sum();
            problem.w[i * size + j] = soil(i, j) + rigid;
        }
        let [x, y] = arm(i % COUNT);
        problem.anchor[i] = if i < COUNT { 1.0 } else { 0.0 };
        problem.q[i] = 0.1 * random.within(-1.0, 1.0)
            + [0.25 * x - 0.1 * y, 0.5, 0.3][i / COUNT] * random.within(0.9, 1.1);
    }
    problem.bounds.fill(Bounds { friction, ..Bounds::NONE });
    problem.scale = 1.0;
    problem.find_scales();
    problem
}

#[test]
fn blocks_are_w() {
    let mut random = Random(3);
    let mut problem = problem(&mut random, 0.5);
    let blocks = Blocks::new(&problem.w, &problem.rho, soil).unwrap();
    assert!(blocks.rank == 4 && blocks.kinds.len() < 500, "{}", blocks.kinds.len());
    assert!(blocks.near.iter().zip(&blocks.starts).all(|(near, start)| near - start < 20));
    problem.change.iter_mut().for_each(|change| *change = random.within(-1.0, 1.0));
    problem.change[7] = 0.0;
    problem.respond();
    let wanted = problem.y.clone();
    problem.blocks = Some(blocks);
    problem.respond();
    for (a, b) in problem.y.iter().zip(&wanted) {
        assert!((a - b).abs() < 1e-13, "{a} {b}");
    }
    // A known product has the bits of the same product anew.
    let known = problem.y.clone();
    let change = problem.change.clone();
    problem.change.iter_mut().for_each(|change| *change *= 0.3);
    problem.respond();
    problem.change.copy_from_slice(&change);
    problem.respond();
    assert_eq!(known, problem.y);
    problem.respond();
    assert_eq!(known, problem.y);
    // With a number on the diagonal.
    problem.added = 0.1;
    problem.respond();
    for ((a, b), change) in problem.y.iter().zip(&wanted).zip(&problem.change) {
        assert!((a - b - 0.1 * change).abs() < 1e-13, "{a} {b}");
    }
    // The rest is not positive.
    assert!(Blocks::new(&problem.w, &problem.rho, |i, j| 1.1 * soil(i, j)).is_none());
    // Every block is another one, or the rest has many modes.
    assert!(
        Blocks::new(&problem.w, &problem.rho, |i, j| soil(i, j) * (1 + i + j) as f64).is_none()
    );
    assert!(Blocks::new(&problem.w, &problem.rho, |_, _| 0.0).is_none());
}

#[test]
fn sweeps_of_blocks_find_the_same_forces() {
    let mut random = Random(5);
    let (mut open, mut slide) = (0, 0);
    for friction in [0.2, 0.6, 1.5] {
        let mut problem = problem(&mut random, friction);
        let mut solve = |with: bool| {
            problem.blocks = with.then(|| Blocks::new(&problem.w, &problem.rho, soil).unwrap());
            problem.change.fill(0.0);
            let (mut newton, mut proximal) = (Newton::new(COUNT), Proximal::new(COUNT));
            let [mut start, mut limited] = [(); 2].map(|()| vec![0.0; 3 * COUNT]);
            let scratch = [&mut start[..], &mut limited[..]];
            assert!(search(&mut problem, &mut newton, &mut proximal, scratch, true).1.is_some());
            assert!(problem.is_solved());
            // The proximal point method alone, too.
            let found: Vec<f64> = (0..3 * COUNT).map(|i| problem.force(i)).collect();
            problem.change.fill(0.0);
            let sweep = |problem: &mut Problem| problem.sweep(200).1;
            assert!(proximal.solve(&mut problem, sweep));
            for (i, wanted) in found.iter().enumerate() {
                assert!((problem.force(i) - wanted).abs() < 1e-9, "{friction}, {i}");
            }
            found
        };
        let [plain, blocks] = [solve(false), solve(true)];
        for (i, (a, b)) in plain.iter().zip(&blocks).enumerate() {
            assert!((a - b).abs() < 1e-10, "{friction}, {i}: {a} {b}");
        }
        let slips = |e: &usize| plain[*e] > 0.0 && problem.y[COUNT + e].abs() > 1e-6;
        open += plain[..COUNT].iter().filter(|p| **p == 0.0).count();
        slide += (0..COUNT).filter(slips).count();
    }
    assert!(open > 10 && slide > 10, "{open} {slide}");
}
