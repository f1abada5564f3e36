//! Small problems against all their solutions, found by other means.

use super::newton::Newton;
use super::problem::{Bounds, Problem};
use super::status::{Normal, Status, Tangential};
use super::{proximal::Proximal, search::search, system::System};
use basemat_testkit::random::Random;

/// A random positive definite W for `count` elements, and q.
fn problem(random: &mut Random, count: usize, friction: f64) -> Problem {
    let size = 3 * count;
    let mut problem = Problem::new(count);
    let root: Vec<f64> = (0..size * size).map(|_| random.within(-1.0, 1.0)).collect();
    for i in 0..size {
        for j in 0..size {
            let sum: f64 = (0..size).map(|k| root[i * size + k] * root[j * size + k]).sum();
            problem.w[i * size + j] = sum + if i == j { 0.3 } else { 0.0 };
        }
        problem.q[i] = random.within(-1.0, 1.0);
    }
    for bounds in &mut problem.bounds {
        *bounds = Bounds { friction, ..Bounds::NONE };
        // Beside a bond, a lower friction replaces an infinite one.
        if random.chance(0.3) && friction < f64::INFINITY {
            bounds.strength = random.within(0.0, 0.3);
        }
        if random.chance(0.3) {
            bounds.interval[1] = random.within(0.1, 0.6);
        }
        if random.chance(0.3) {
            bounds.offset = random.within(-0.2, 0.2);
        }
    }
    problem.scale = 1e-3;
    problem.find_scales();
    problem
}

/// Number of angles at which a search for a direction starts.
const GRID: usize = 24;

/// Possible state of an element: open, closed or at its cap; sticking or sliding in a direction.
#[derive(Clone, Copy, PartialEq)]
enum NormalState {
    Open,
    Closed,
    Capped,
}

/// Solves rows · x = right by elimination; `None` if singular.
fn eliminate(mut rows: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let n = rows.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|a, b| rows[*a][k].abs().total_cmp(&rows[*b][k].abs()))?;
        rows.swap(k, pivot);
        if rows[k][k].abs() < 1e-12 {
            return None;
        }
        let own = rows[k].clone();
        for row in rows.iter_mut().skip(k + 1) {
            let factor = row[k] / own[k];
            row.iter_mut().zip(&own).skip(k).for_each(|(x, y)| *x -= factor * y);
        }
    }
    for k in (0..n).rev() {
        let sum: f64 = (k + 1..n).map(|j| rows[k][j] * rows[j][n]).sum();
        rows[k][n] = (rows[k][n] - sum) / rows[k][k];
    }
    Some(rows.iter().map(|row| row[n]).collect())
}

fn row_of(problem: &Problem, i: usize) -> &[f64] {
    &problem.w[i * problem.size()..][..problem.size()]
}

/// Forces for given kinds: a sliding element has its shear at an angle, other elements do not slip.
fn forces(problem: &Problem, kinds: &[(NormalState, bool)], angles: &[f64]) -> Option<Vec<f64>> {
    let size = problem.size();
    let mut rows = Vec::new();
    for i in 0..size {
        let (component, e) = (i / problem.count, i % problem.count);
        let bounds = &problem.bounds[e];
        let mut row = vec![0.0; size + 1];
        let mut moves = |target: f64| {
            row[..size].copy_from_slice(row_of(problem, i));
            row[size] = target - problem.q[i];
        };
        match (component, kinds[e]) {
            (0, (NormalState::Closed, _)) => moves(bounds.offset),
            (0, (NormalState::Capped, _)) => (row[i], row[size]) = (1.0, bounds.interval[1]),
            (0, _) => row[i] = 1.0,
            (_, (_, false)) => moves(0.0),
            // The limit of infinite friction: shear along the slip without pressure, in a closed gap.
            (1, (NormalState::Closed, true)) if bounds.is_endless() => row[e] = 1.0,
            (2, (NormalState::Closed, true)) if bounds.is_endless() => {
                (row[i - problem.count], row[i]) = (-angles[e].sin(), angles[e].cos());
            }
            (_, (kind, true)) => {
                let d = if component == 1 { angles[e].cos() } else { angles[e].sin() };
                // An open element keeps the strength until its bond breaks.
                let friction = if kind == NormalState::Open { 0.0 } else { bounds.taken() };
                row[i] = 1.0;
                row[e] -= friction * d;
                row[size] = bounds.strength * d;
            }
        }
        rows.push(row);
    }
    eliminate(rows)
}

/// All solutions, up to directions that a scan of angles does not distinguish.
fn all_solutions(problem: &Problem) -> Vec<Vec<f64>> {
    let count = problem.count;
    let mut found: Vec<Vec<f64>> = Vec::new();
    let choices = [NormalState::Open, NormalState::Closed, NormalState::Capped]
        .map(|kind| [(kind, false), (kind, true)]);
    let choices = choices.concat();
    let respond = |r: &[f64]| -> Vec<f64> {
        let dot = |i: usize| row_of(problem, i).iter().zip(r).map(|(w, r)| w * r).sum::<f64>();
        (0..r.len()).map(|i| problem.q[i] + dot(i)).collect()
    };
    for set in 0..(0..count).fold(1, |all, _| all * choices.len()) {
        let mut rest = set;
        let mut next = || {
            let kind = choices[rest % choices.len()];
            rest /= choices.len();
            kind
        };
        let kinds: Vec<_> = (0..count).map(|_| next()).collect();
        let sliding: Vec<_> = (0..count).filter(|e| kinds[*e].1).collect();
        let capless = |e: usize| problem.bounds[e].interval[1] == f64::INFINITY;
        let none = |e: usize| match kinds[e] {
            (NormalState::Capped, slides) => capless(e) || slides && problem.bounds[e].is_endless(),
            (NormalState::Open, false) => problem.bounds[e].is_endless(),
            _ => false,
        };
        if (0..count).any(none) {
            continue;
        }
        // Slip across the direction of the shear; zero at a solution.
        let across = |angles: &[f64]| -> Option<(Vec<f64>, Vec<f64>)> {
            let r = forces(problem, &kinds, angles)?;
            let y = respond(&r);
            let miss = sliding.iter().map(|&e| {
                let (s, c) = angles[e].sin_cos();
                c * y[2 * count + e] - s * y[count + e]
            });
            Some((miss.collect(), r))
        };
        // Newton's method with finite differences, from a grid of angles.
        for start in 0..sliding.iter().fold(1, |all, _| all * GRID) {
            let mut angles = vec![0.0; count];
            let mut rest = start;
            for &e in &sliding {
                angles[e] = (rest % GRID) as f64 * std::f64::consts::TAU / GRID as f64;
                rest /= GRID;
            }
            let mut solution = None;
            for _ in 0..30 {
                let Some((miss, r)) = across(&angles) else { break };
                if miss.iter().all(|m| m.abs() < 1e-12) {
                    solution = Some(r);
                    break;
                }
                let mut rows: Vec<Vec<f64>> = miss.iter().map(|m| vec![-m]).collect();
                for (k, &e) in sliding.iter().enumerate() {
                    let mut turned = angles.clone();
                    turned[e] += 1e-7;
                    let Some((other, _)) = across(&turned) else { break };
                    for (row, (a, b)) in rows.iter_mut().zip(other.iter().zip(&miss)) {
                        row.insert(k, (a - b) / 1e-7);
                    }
                }
                if rows.iter().any(|row| row.len() != sliding.len() + 1) {
                    break;
                }
                let Some(turns) = eliminate(rows) else { break };
                for (&e, turn) in sliding.iter().zip(turns) {
                    angles[e] += turn.clamp(-0.3, 0.3);
                }
            }
            let Some(r) = solution else { continue };
            let y = respond(&r);
            let admissible = (0..count).all(|e| {
                let (bounds, [n, i, j]) = (&problem.bounds[e], problem.places(e));
                let radius = match kinds[e] {
                    (NormalState::Closed, true) if bounds.is_endless() => r[i].hypot(r[j]),
                    (NormalState::Open, _) if bounds.is_endless() => 0.0,
                    _ => bounds.radius(r[n]),
                };
                let gap = y[n] - bounds.offset;
                let normal = match kinds[e].0 {
                    NormalState::Open => gap >= -1e-9,
                    NormalState::Closed => r[n] >= -1e-9 && r[n] <= bounds.interval[1] + 1e-9,
                    NormalState::Capped => gap <= 1e-9,
                };
                let shear = r[i].hypot(r[j]);
                let along = r[i] * y[i] + r[j] * y[j];
                let slides = (shear - radius).abs() < 1e-9 && along <= 1e-9;
                normal && if kinds[e].1 { slides } else { shear <= radius + 1e-9 }
            });
            let near = |a: &Vec<f64>| a.iter().zip(&r).all(|(a, b)| (a - b).abs() < 1e-7);
            if admissible && !found.iter().any(near) {
                found.push(r);
            }
        }
    }
    found
}

/// Solves the problem by all methods.
fn solve(problem: &mut Problem) -> bool {
    let count = problem.count;
    let (mut newton, mut proximal) = (Newton::new(count), Proximal::new(count));
    let [mut start, mut limited] = [(); 2].map(|()| vec![0.0; 3 * count]);
    let scratch = [&mut start[..], &mut limited[..]];
    search(problem, &mut newton, &mut proximal, scratch, true).1.is_some()
}

fn is_among(problem: &Problem, solutions: &[Vec<f64>]) -> bool {
    let near =
        |r: &Vec<f64>| r.iter().enumerate().all(|(i, r)| (r - problem.force(i)).abs() < 1e-7);
    solutions.iter().any(near)
}

/// Fraction of this many random problems: a fifth, or all of them if `HEAVY_TESTS` is set.
fn cases(all: usize) -> usize {
    if basemat_testkit::heavy() { all } else { all / 5 }
}

#[test]
fn each_method_finds_one_of_all_solutions() {
    let mut random = Random(11);
    let (mut sliding, mut swept, mut nearing, mut endless) = (0, 0, 0, 0);
    for case in 0..cases(300) {
        let count = if case % 8 == 0 { 2 } else { 1 };
        let friction = [0.2, 0.6, 1.5, 5.0, f64::INFINITY][case % 5];
        let mut problem = problem(&mut random, count, friction);
        let solutions = all_solutions(&problem);
        let (found, grip) = (solve(&mut problem), problem.bounds[0].grip);
        // Infinite friction without a solution is limited.
        let limited = found && friction == f64::INFINITY && grip < friction;
        assert!(found != solutions.is_empty() || limited, "case {case}: {}", solutions.len());
        if limited || solutions.is_empty() {
            assert!(!limited || grip >= 3.0 && problem.is_solved(), "case {case}: {grip}");
            continue;
        }
        assert!(is_among(&problem, &solutions), "case {case}: {} solutions", solutions.len());
        let slip = |e: usize| problem.y[count + e].hypot(problem.y[2 * count + e]) > 1e-6;
        sliding += usize::from((0..count).any(|e| slip(e) && problem.force(e) > 1e-6));
        // Each method alone, from zero forces; discs are not empty.
        problem.change.fill(0.0);
        if Newton::new(count).solve(&mut problem, case % 2 == 0).1 {
            assert!(is_among(&problem, &solutions), "case {case}, Newton");
        }
        if friction == f64::INFINITY {
            endless += 1;
            continue;
        }
        problem.change.fill(0.0);
        if problem.sweep(2000).1 {
            swept += 1;
            assert!(is_among(&problem, &solutions), "case {case}, sweeps");
        }
        problem.change.fill(0.0);
        let sweep = |problem: &mut Problem| problem.sweep(200).1;
        if Proximal::new(count).solve(&mut problem, sweep) {
            nearing += 1;
            assert!(is_among(&problem, &solutions), "case {case}, proximal");
        }
    }
    assert!(
        endless > cases(40) && sliding > cases(40) && swept > cases(150) && nearing > cases(150),
        "{sliding} {swept} {nearing}"
    );
}

/// Infinite friction without a solution, or without one found, is limited as little as possible.
#[test]
fn endless_friction_is_limited_where_it_must_be() {
    let (mut random, mut limited, mut failed) = (Random(17), 0, 0);
    for case in 0..cases(300) {
        let size = 3 * [1, 2, 3, 4, 20, 40][case % 6];
        let mut problem = problem(&mut random, size / 3, f64::INFINITY);
        problem.w.iter_mut().step_by(size + 1).for_each(|own| *own -= 0.29);
        problem.find_scales();
        failed += usize::from(!solve(&mut problem));
        limited += usize::from(problem.bounds[0].grip < f64::INFINITY);
        assert!(problem.bounds[0].grip >= 3.0, "case {case}");
    }
    assert!(
        limited > 0 && 50 * failed < cases(300),
        "{limited} limited, {failed} without a solution"
    );
}

/// Friction work is computed from the shear and the slip of one solution, and is never negative.
#[test]
fn friction_takes_energy_only() {
    let (mut random, mut failed) = (Random(5), 0);
    for case in 0..300 {
        let count = 1 + case % 9;
        let friction = random.log_within(0.05, 20.0);
        let mut problem = problem(&mut random, count, friction);
        if !solve(&mut problem) {
            failed += 1;
            continue;
        }
        problem.respond();
        for e in 0..count {
            let [n, x, y] = problem.places(e);
            let work = -(problem.force(x) * problem.y[x] + problem.force(y) * problem.y[y]);
            assert!(work > -1e-9, "case {case}: {work:e}");
            let bounds = &problem.bounds[e];
            let shear = problem.force(x).hypot(problem.force(y));
            assert!(shear <= bounds.radius(problem.force(n)) * (1.0 + 1e-9) + 1e-9, "case {case}");
        }
    }
    assert!(failed < 12, "{failed} without a solution");
}

/// Both systems meet the conditions of statuses with fewer unknown motions than forces, and a step has the same
/// bits whatever was solved before.
#[test]
fn forces_or_motions_meet_the_conditions_of_statuses() {
    let (mut random, count, mut turned) = (Random(3), 6, 0);
    for case in 0..100 {
        let mut problem = problem(&mut random, count, 0.5);
        problem.anchor.iter_mut().for_each(|force| *force = random.within(-1.0, 1.0));
        let mut status = |e: usize| {
            let normal =
                if e > 3 { [Normal::Open, Normal::Capped][case % 2] } else { Normal::Closed };
            let (s, c) = random.within(0.0, 6.0).sin_cos();
            let (turn, slope) = (random.within(0.0, 1.0), random.pick(&[0.0, 0.4, 3.0, 1e4]));
            let slip = Tangential::Slip { direction: [c, s], turn, slope };
            let tangential = match (e, case % 4) {
                (0, _) | (4, 2 | 3) => slip,
                (4 | 5, _) => Tangential::Free,
                _ => Tangential::Stick,
            };
            Status { normal, tangential }
        };
        let mut statuses: Vec<Status> = (0..count).map(&mut status).collect();
        if case % 10 == 9 {
            statuses.fill(Status::STICK);
        }
        for bounds in &mut problem.bounds {
            bounds.interval = [-0.2, 0.7];
            bounds.attraction = 0.3;
        }
        let (mut system, mut first) = (System::new(count), Vec::new());
        let mut other = statuses.clone();
        other[1] = Status::OPEN;
        for trial in 0..40 {
            let lasts = trial >= 20;
            if trial % 20 == 0 {
                system.forget(lasts);
            }
            // Earlier solutions are arbitrary.
            for _ in 0..trial * usize::from(trial % 20 > 0) {
                problem.rest();
                system.solve(&mut problem, [&other, &statuses][trial % 2], trial % 3 == 0);
            }
            system.begin_step();
            problem.rest();
            assert!(system.solve(&mut problem, &statuses, false), "case {case}");
            problem.respond();
            if trial % 20 == 0 {
                turned += usize::from(lasts && first != problem.change);
                first.clone_from(&problem.change);
            }
            assert_eq!(first, problem.change, "case {case}, {trial}");
            for (e, status) in statuses.iter().enumerate() {
                let (bounds, places) = (&problem.bounds[e], problem.places(e));
                let ([p, tx, ty], [gap, x, y]) =
                    (places.map(|i| problem.force(i)), places.map(|i| problem.y[i]));
                let normal = match status.normal {
                    Normal::Open => p - bounds.interval[0],
                    Normal::Closed => gap - bounds.offset,
                    Normal::Capped => p - bounds.interval[1],
                };
                let shear = match status.tangential {
                    Tangential::Free => [tx, ty],
                    Tangential::Stick => [x, y],
                    Tangential::Slip { direction: [c, s], turn, slope } => [
                        c * tx + s * ty - slope * (p + bounds.attraction) - bounds.strength,
                        (1.0 - turn) * (c * ty - s * tx)
                            + turn * problem.rho[e][1] * (c * y - s * x),
                    ],
                };
                let largest = problem.largest();
                for miss in [normal, shear[0], shear[1]] {
                    assert!(miss.abs() < 1e-9 * largest, "{case}, {trial}, {e}: {miss:e}");
                }
            }
        }
    }
    assert!(turned > 80, "{turned}");
}
