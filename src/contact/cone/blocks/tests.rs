//! NearFieldBlocks and tables against W itself.

use super::super::newton::Newton;
use super::super::problem::{Bounds, ConeProblem};
use super::super::wide::DenseLattice;
use super::super::{proximal::Proximal, search::search};
use super::*;
use basemat_testkit::random::Random;

/// Elements along a side of the mat.
const SIDE_COUNT: usize = 10;
const ELEMENT_COUNT: usize = SIDE_COUNT * SIDE_COUNT;

/// Compliance between two elements of a lattice, without the structure.
fn soil(row: usize, column: usize) -> f64 {
    let place = |i: usize| {
        [i % ELEMENT_COUNT % SIDE_COUNT, i % ELEMENT_COUNT / SIDE_COUNT].map(|k| k as f64)
    };
    let ([x, y], [a, b]) = (place(row), place(column));
    let along = a - x;
    let across = b - y;
    let far = along.hypot(across);
    match (row / ELEMENT_COUNT, column / ELEMENT_COUNT) {
        (i, j) if i == j => (-3.0 * far).exp() * if i == 0 { 0.8 } else { 1.0 },
        (0, 1) => 0.1 * along * (-4.0 * far).exp(),
        (1, 0) => -0.1 * along * (-4.0 * far).exp(),
        _ => 0.0,
    }
}

fn cells() -> Vec<[usize; 2]> {
    (0..ELEMENT_COUNT).map(|e| [e % SIDE_COUNT, e / SIDE_COUNT]).collect()
}

/// NearFieldBlocks of a problem with this part of the soil.
fn blocks(problem: &ConeProblem, soil: impl Fn(usize, usize) -> f64) -> Option<NearFieldBlocks> {
    NearFieldBlocks::new(&problem.w, &problem.rho, &cells(), soil, |_| 0.0)
}

/// A rigid body on the lattice that partly lifts off and slides, and its W.
fn problem(random: &mut Random, friction: f64) -> ConeProblem {
    let size = 3 * ELEMENT_COUNT;
    let mut problem = ConeProblem::new(ELEMENT_COUNT);
    let arm = |e: usize| {
        [e % SIDE_COUNT, e / SIDE_COUNT].map(|k| k as f64 - 0.5 * (SIDE_COUNT - 1) as f64)
    };
    let modes: Vec<[f64; 4]> = (0..size)
        .map(|i| {
            let arm = arm(i % ELEMENT_COUNT);
            let pressing = [0.1, 0.0, 0.02 * arm[0], 0.02 * arm[1]];
            [pressing, [0.0, 0.1, 0.0, 0.05], [0.0, 0.0, 0.05, 0.0]][i / ELEMENT_COUNT]
        })
        .collect();
    for i in 0..size {
        for j in 0..size {
            let rigid: f64 = modes[i].iter().zip(&modes[j]).map(|(a, b)| a * b).sum();
            problem.w[i * size + j] = soil(i, j) + rigid;
        }
        let arm = arm(i % ELEMENT_COUNT);
        problem.anchor[i] = if i < ELEMENT_COUNT { 1.0 } else { 0.0 };
        problem.q[i] = 0.1 * random.within(-1.0, 1.0)
            + [0.25 * arm[0] - 0.1 * arm[1], 0.5, 0.3][i / ELEMENT_COUNT] * random.within(0.9, 1.1);
    }
    problem.bounds.fill(Bounds { friction, ..Bounds::WITHOUT_FRICTION });
    for bounds in problem.bounds.iter_mut().step_by(3) {
        (bounds.interval[1], bounds.hardening) = (1.2, 0.8);
    }
    problem.min_force_scale = 1.0;
    problem.update_scales();
    problem
}

#[test]
fn blocks_are_w() {
    let mut random = Random(3);
    let mut problem = problem(&mut random, 0.5);
    let near_field = blocks(&problem, soil).unwrap();
    assert!(
        near_field.rank == 4 && near_field.near.kinds.len() < 20,
        "{} {}",
        near_field.rank,
        near_field.near.kinds.len()
    );
    // Each element is in one group, without elements near it.
    let mut met = [false; ELEMENT_COUNT];
    for group in &near_field.groups {
        let elements = group.iter().filter(|e| **e < ELEMENT_COUNT);
        elements.clone().for_each(|e| assert!(!std::mem::replace(&mut met[*e], true)));
        for e in elements.clone() {
            let near = near_field.near.of(*e);
            let is_own = |link: &&Link| group.contains(&(link.element as usize));
            assert!(near.len() < 20 && near.iter().filter(is_own).count() == 1);
        }
    }
    assert!(met.iter().all(|met| *met) && near_field.groups.len() < 30);
    problem.change.iter_mut().for_each(|change| *change = random.within(-1.0, 1.0));
    problem.change[7] = 0.0;
    problem.update_motions();
    let wanted = problem.y.clone();
    problem.set_near_field(Some(near_field));
    problem.update_motions();
    for (a, b) in problem.y.iter().zip(&wanted) {
        assert!((a - b).abs() < 1e-13, "{a} {b}");
    }
    // A known product has the bits of the same product anew.
    let known = problem.y.clone();
    let change = problem.change.clone();
    problem.change.iter_mut().for_each(|change| *change *= 0.3);
    problem.update_motions();
    problem.change.copy_from_slice(&change);
    problem.update_motions();
    assert_eq!(known, problem.y);
    problem.update_motions();
    assert_eq!(known, problem.y);
    // With a number on the diagonal.
    problem.added = 0.1;
    problem.update_motions();
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
    let layers: Vec<f64> = (0..3 * ELEMENT_COUNT).map(|_| random.within(0.0, 0.3)).collect();
    for (i, layer) in layers.iter().enumerate() {
        problem.w[i * (3 * ELEMENT_COUNT + 1)] += layer;
    }
    problem.added = 0.1;
    problem.update_motions();
    let wanted: Vec<f64> =
        problem.y.iter().zip(&problem.change).map(|(y, change)| y + 0.1 * change).collect();
    let wide = |soil: &dyn Fn(usize, usize) -> f64| {
        DenseLattice::new(&problem.w, &cells(), soil, |i| layers[i])
    };
    assert!(wide(&|i, j| soil(i, j) * (1 + i + j) as f64).is_none());
    assert!(wide(&|i, j| 1.1 * soil(i, j)).is_none());
    problem.dense_lattice = wide(&soil);
    assert!(problem.dense_lattice.is_some());
    problem.update_motions();
    for (a, b) in problem.y.iter().zip(&wanted) {
        assert!((a - b).abs() < 1e-13, "{a} {b}");
    }
    // Motions that sweeps have added are products with W.
    for _ in 0..3 {
        assert!(problem.relax_all(1e-12) > 1e-3);
    }
    let moved: Vec<_> = (0..ELEMENT_COUNT)
        .map(|e| {
            let change = problem.places(e).map(|i| problem.change[i]);
            problem.dense_lattice.as_ref().unwrap().motion(e, change)
        })
        .collect();
    problem.update_motions();
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
    let mut open = 0;
    let mut slide = 0;
    for friction in [0.2, 0.6, 1.5] {
        let mut problem = problem(&mut random, friction);
        let mut solve = |with: Option<bool>| {
            let near_field = with.filter(|wide| !wide).map(|_| blocks(&problem, soil).unwrap());
            problem.set_near_field(near_field);
            let tables = || DenseLattice::new(&problem.w, &cells(), soil, |_| 0.0).unwrap();
            problem.dense_lattice = with.filter(|wide| *wide).map(|_| tables());
            problem.change.fill(0.0);
            let mut newton = Newton::new(ELEMENT_COUNT);
            let mut proximal = Proximal::new(ELEMENT_COUNT);
            let mut start = vec![0.0; 3 * ELEMENT_COUNT];
            let mut limited = start.clone();
            assert!(
                search(&mut problem, &mut newton, &mut proximal, &mut start, &mut limited, true)
                    .method
                    .is_some()
            );
            assert!(problem.is_solved());
            // The proximal point method alone, too.
            let found: Vec<f64> = (0..3 * ELEMENT_COUNT).map(|i| problem.force(i)).collect();
            problem.change.fill(0.0);
            let sweep = |problem: &mut ConeProblem| problem.sweep(200).is_solved;
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
        let slips = |e: &usize| plain[*e] > 0.0 && problem.y[ELEMENT_COUNT + e].abs() > 1e-6;
        open += plain[..ELEMENT_COUNT].iter().filter(|p| **p == 0.0).count();
        slide += (0..ELEMENT_COUNT).filter(slips).count();
    }
    assert!(open > 10 && slide > 10, "{open} {slide}");
}
