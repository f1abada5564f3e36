//! Blocks and tables against W itself.

use super::super::newton::Newton;
use super::super::problem::{Bounds, Problem};
use super::super::wide::Wide;
use super::super::{proximal::Proximal, search::search};
use super::*;
use basemat_testkit::random::Random;

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

fn cells() -> Vec<[usize; 2]> {
    (0..COUNT).map(|e| [e % SIDE, e / SIDE]).collect()
}

/// Blocks of a problem with this part of the soil.
fn blocks(problem: &Problem, soil: impl Fn(usize, usize) -> f64) -> Option<Blocks> {
    Blocks::new(&problem.w, &problem.rho, &cells(), soil, |_| 0.0)
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
    let own = blocks(&problem, soil).unwrap();
    assert!(own.rank == 4 && own.near.kinds.len() < 20, "{} {}", own.rank, own.near.kinds.len());
    // Each element is in one group, without elements near it.
    let mut met = [false; COUNT];
    for group in &own.groups {
        let elements = group.iter().filter(|e| **e < COUNT);
        elements.clone().for_each(|e| assert!(!std::mem::replace(&mut met[*e], true)));
        for e in elements.clone() {
            let near = own.near.of(*e);
            let is_own = |link: &&Link| group.contains(&(link.element as usize));
            assert!(near.len() < 20 && near.iter().filter(is_own).count() == 1);
        }
    }
    assert!(met.iter().all(|met| *met) && own.groups.len() < 30);
    problem.change.iter_mut().for_each(|change| *change = random.within(-1.0, 1.0));
    problem.change[7] = 0.0;
    problem.respond();
    let wanted = problem.y.clone();
    problem.take_blocks(Some(own));
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
    assert!(blocks(&problem, |i, j| 1.1 * soil(i, j)).is_none());
    // Every block is another one, or the rest has many modes.
    assert!(blocks(&problem, |i, j| soil(i, j) * (1 + i + j) as f64).is_none());
    assert!(blocks(&problem, |_, _| 0.0).is_none());
}

#[test]
fn tables_are_w() {
    let mut random = Random(7);
    let mut problem = problem(&mut random, 0.5);
    problem.change.iter_mut().for_each(|change| *change = random.within(-1.0, 1.0));
    // A layer of its own under each element.
    let layers: Vec<f64> = (0..3 * COUNT).map(|_| random.within(0.0, 0.3)).collect();
    for (i, layer) in layers.iter().enumerate() {
        problem.w[i * (3 * COUNT + 1)] += layer;
    }
    problem.added = 0.1;
    problem.respond();
    let wanted: Vec<f64> =
        problem.y.iter().zip(&problem.change).map(|(y, change)| y + 0.1 * change).collect();
    let wide =
        |soil: &dyn Fn(usize, usize) -> f64| Wide::new(&problem.w, &cells(), soil, |i| layers[i]);
    assert!(wide(&|i, j| soil(i, j) * (1 + i + j) as f64).is_none());
    assert!(wide(&|i, j| 1.1 * soil(i, j)).is_none());
    problem.wide = wide(&soil);
    assert!(problem.wide.is_some());
    problem.respond();
    for (a, b) in problem.y.iter().zip(&wanted) {
        assert!((a - b).abs() < 1e-13, "{a} {b}");
    }
    // Motions that sweeps have added are products with W.
    for _ in 0..3 {
        assert!(problem.relax_all(1e-12) > 1e-3);
    }
    let moved: Vec<_> = (0..COUNT)
        .map(|e| {
            let change = problem.places(e).map(|i| problem.change[i]);
            problem.wide.as_ref().unwrap().motion(e, change)
        })
        .collect();
    problem.respond();
    for (e, motion) in moved.iter().enumerate() {
        for (k, i) in problem.places(e).into_iter().enumerate() {
            let wanted = problem.y[i] - problem.q[i] - 0.1 * problem.change[i];
            assert!((motion[k] - wanted).abs() < 1e-12, "{e}, {k}: {} {wanted}", motion[k]);
        }
    }
}

#[test]
fn sweeps_of_blocks_and_tables_find_the_same_forces() {
    let mut random = Random(5);
    let (mut open, mut slide) = (0, 0);
    for friction in [0.2, 0.6, 1.5] {
        let mut problem = problem(&mut random, friction);
        let mut solve = |with: Option<bool>| {
            let own = with.filter(|wide| !wide).map(|_| blocks(&problem, soil).unwrap());
            problem.take_blocks(own);
            let tables = || Wide::new(&problem.w, &cells(), soil, |_| 0.0).unwrap();
            problem.wide = with.filter(|wide| *wide).map(|_| tables());
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
        let [plain, blocks, tables] = [None, Some(false), Some(true)].map(&mut solve);
        for (i, (a, b)) in plain.iter().zip(&blocks).chain(plain.iter().zip(&tables)).enumerate() {
            assert!((a - b).abs() < 1e-10, "{friction}, {i}: {a} {b}");
        }
        let slips = |e: &usize| plain[*e] > 0.0 && problem.y[COUNT + e].abs() > 1e-6;
        open += plain[..COUNT].iter().filter(|p| **p == 0.0).count();
        slide += (0..COUNT).filter(slips).count();
    }
    assert!(open > 10 && slide > 10, "{open} {slide}");
}
