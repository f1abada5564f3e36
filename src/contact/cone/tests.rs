//! Small problems against all their solutions, found by other means.

mod systems;

use super::newton::Newton;
use super::problem::{Bounds, ConeProblem};
use super::{proximal::Proximal, search::search};
use basemat_testkit::random::Random;

/// A random positive definite W for `count` elements, and q.
fn problem(random: &mut Random, count: usize, friction: f64) -> ConeProblem {
    let size = 3 * count;
    let mut problem = ConeProblem::new(count);
    let root: Vec<f64> = (0..size * size).map(|_| random.within(-1.0, 1.0)).collect();
    for i in 0..size {
        for j in 0..size {
            let sum: f64 = (0..size).map(|k| root[i * size + k] * root[j * size + k]).sum();
            problem.w[i * size + j] = sum + if i == j { 0.3 } else { 0.0 };
        }
        problem.q[i] = random.within(-1.0, 1.0);
    }
    for bounds in &mut problem.bounds {
        *bounds = Bounds { friction, ..Bounds::WITHOUT_FRICTION };
        // Beside a bond, a lower friction replaces an infinite one.
        if random.chance(0.3) && friction < f64::INFINITY {
            bounds.strength = random.within(0.0, 0.3);
        }
        if random.chance(0.3) {
            bounds.interval[1] = random.within(0.1, 0.6);
            bounds.hardening = if bounds.interval[1] < 0.35 { 2.0 } else { 0.0 };
        }
        if random.chance(0.3) {
            bounds.offset = random.within(-0.2, 0.2);
        }
    }
    problem.min_force_scale = 1e-3;
    problem.update_scales();
    problem
}

/// Number of angles at which a search for a direction starts.
const ANGLE_COUNT: usize = 24;

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
        let pivot_row = rows[k].clone();
        for row in rows.iter_mut().skip(k + 1) {
            let factor = row[k] / pivot_row[k];
            row.iter_mut().zip(&pivot_row).skip(k).for_each(|(x, y)| *x -= factor * y);
        }
    }
    for k in (0..n).rev() {
        let sum: f64 = (k + 1..n).map(|j| rows[k][j] * rows[j][n]).sum();
        rows[k][n] = (rows[k][n] - sum) / rows[k][k];
    }
    Some(rows.iter().map(|row| row[n]).collect())
}

fn row_of(problem: &ConeProblem, i: usize) -> &[f64] {
    &problem.w[i * problem.size()..][..problem.size()]
}

/// Forces for given kinds: a sliding element has its shear at an angle, other elements do not slip.
fn forces(
    problem: &ConeProblem,
    kinds: &[(NormalState, bool)],
    angles: &[f64],
) -> Option<Vec<f64>> {
    let size = problem.size();
    let mut rows = Vec::new();
    for i in 0..size {
        let component = i / problem.count;
        let e = i % problem.count;
        let bounds = &problem.bounds[e];
        let mut row = vec![0.0; size + 1];
        let mut moves = |target: f64| {
            row[..size].copy_from_slice(row_of(problem, i));
            row[size] = target - problem.q[i];
        };
        match (component, kinds[e]) {
            (0, (NormalState::Closed, _)) => moves(bounds.offset),
            (0, (NormalState::Capped, _)) => {
                // p = cap + hardening (offset − y).
                moves(bounds.offset);
                for entry in &mut row {
                    *entry *= bounds.hardening;
                }
                row[i] += 1.0;
                row[size] += bounds.interval[1];
            }
            (0, _) => row[i] = 1.0,
            (_, (_, false)) => moves(0.0),
            // The limit of infinite friction: shear along the slip without pressure, in a closed gap.
            (1, (NormalState::Closed, true)) if bounds.has_infinite_friction() => row[e] = 1.0,
            (2, (NormalState::Closed, true)) if bounds.has_infinite_friction() => {
                (row[i - problem.count], row[i]) = (-angles[e].sin(), angles[e].cos());
            }
            (_, (kind, true)) => {
                let d = if component == 1 { angles[e].cos() } else { angles[e].sin() };
                // An open element keeps the strength until its bond breaks.
                let friction =
                    if kind == NormalState::Open { 0.0 } else { bounds.effective_friction() };
                row[i] = 1.0;
                row[e] -= friction * d;
                row[size] = bounds.strength * d;
            }
        }
        rows.push(row);
    }
    eliminate(rows)
}

/// Motions of all components by the forces r.
fn motions_of(problem: &ConeProblem, r: &[f64]) -> Vec<f64> {
    let products =
        (0..r.len()).map(|i| row_of(problem, i).iter().zip(r).map(|(w, r)| w * r).sum::<f64>());
    problem.q.iter().zip(products).map(|(q, product)| q + product).collect()
}

/// Whether an element with these bounds cannot have this state, or has it only as a limit of another one.
fn is_impossible(bounds: &Bounds, kind: (NormalState, bool)) -> bool {
    match kind {
        (NormalState::Capped, slides) => {
            bounds.interval[1] == f64::INFINITY || slides && bounds.has_infinite_friction()
        }
        (NormalState::Open, false) => bounds.has_infinite_friction(),
        _ => false,
    }
}

/// All solutions, up to directions that a scan of angles does not distinguish.
fn all_solutions(problem: &ConeProblem) -> Vec<Vec<f64>> {
    let count = problem.count;
    let mut found: Vec<Vec<f64>> = Vec::new();
    let choices = [NormalState::Open, NormalState::Closed, NormalState::Capped]
        .map(|kind| [(kind, false), (kind, true)]);
    let choices = choices.concat();
    for set in 0..(0..count).fold(1, |all, _| all * choices.len()) {
        let mut rest = set;
        let mut kinds = Vec::with_capacity(count);
        for _ in 0..count {
            kinds.push(choices[rest % choices.len()]);
            rest /= choices.len();
        }
        let sliding: Vec<_> = (0..count).filter(|e| kinds[*e].1).collect();
        if (0..count).any(|e| is_impossible(&problem.bounds[e], kinds[e])) {
            continue;
        }
        // Slip across the direction of the shear; zero at a solution.
        let across = |angles: &[f64]| -> Option<(Vec<f64>, Vec<f64>)> {
            let r = forces(problem, &kinds, angles)?;
            let y = motions_of(problem, &r);
            let residuals = sliding
                .iter()
                .map(|&e| angles[e].cos() * y[2 * count + e] - angles[e].sin() * y[count + e]);
            Some((residuals.collect(), r))
        };
        // Newton's method with finite differences, from a grid of angles.
        for start in 0..sliding.iter().fold(1, |all, _| all * ANGLE_COUNT) {
            let mut angles = vec![0.0; count];
            let mut rest = start;
            for &e in &sliding {
                angles[e] =
                    (rest % ANGLE_COUNT) as f64 * std::f64::consts::TAU / ANGLE_COUNT as f64;
                rest /= ANGLE_COUNT;
            }
            let mut solution = None;
            for _ in 0..30 {
                let Some((residuals, r)) = across(&angles) else { break };
                if residuals.iter().all(|m| m.abs() < 1e-12) {
                    solution = Some(r);
                    break;
                }
                let mut rows: Vec<Vec<f64>> = residuals.iter().map(|m| vec![-m]).collect();
                for (k, &e) in sliding.iter().enumerate() {
                    let mut turned = angles.clone();
                    turned[e] += 1e-7;
                    let Some((other, _)) = across(&turned) else { break };
                    for (row, (a, b)) in rows.iter_mut().zip(other.iter().zip(&residuals)) {
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
            let y = motions_of(problem, &r);
            let admissible = (0..count).all(|e| {
                let bounds = &problem.bounds[e];
                let force = problem.places(e).map(|place| r[place]);
                let motion = problem.places(e).map(|place| y[place]);
                let shear = force[1].hypot(force[2]);
                let radius = match kinds[e] {
                    (NormalState::Closed, true) if bounds.has_infinite_friction() => shear,
                    (NormalState::Open, _) if bounds.has_infinite_friction() => 0.0,
                    _ => bounds.radius(force[0]),
                };
                let gap = motion[0] - bounds.offset;
                let normal = match kinds[e].0 {
                    NormalState::Open => gap >= -1e-9,
                    NormalState::Closed => {
                        force[0] >= -1e-9 && force[0] <= bounds.interval[1] + 1e-9
                    }
                    NormalState::Capped => gap <= 1e-9,
                };
                let along = force[1] * motion[1] + force[2] * motion[2];
                let slides = (shear - radius).abs() < 1e-9 && along <= 1e-9;
                normal && if kinds[e].1 { slides } else { shear <= radius + 1e-9 }
            });
            let is_known = found
                .iter()
                .any(|known| known.iter().zip(&r).all(|(known, r)| (known - r).abs() < 1e-7));
            if admissible && !is_known {
                found.push(r);
            }
        }
    }
    found
}

/// Solves the problem by all methods.
fn solve(problem: &mut ConeProblem) -> bool {
    let count = problem.count;
    let mut newton = Newton::new(count);
    let mut proximal = Proximal::new(count);
    let mut start = vec![0.0; 3 * count];
    let mut limited = start.clone();
    search(problem, &mut newton, &mut proximal, &mut start, &mut limited, true)
        .method
        .is_some()
}

fn is_among(problem: &ConeProblem, solutions: &[Vec<f64>]) -> bool {
    solutions.iter().any(|solution| {
        solution.iter().enumerate().all(|(i, force)| (force - problem.force(i)).abs() < 1e-7)
    })
}

/// Fraction of this many random problems: a fifth, or all of them if `HEAVY_TESTS` is set.
fn cases(all: usize) -> usize {
    if basemat_testkit::heavy() { all } else { all / 5 }
}

#[test]
fn each_method_finds_one_of_all_solutions() {
    let mut random = Random(11);
    let mut sliding = 0;
    let mut swept = 0;
    let mut nearing = 0;
    let mut endless = 0;
    for case in 0..cases(300) {
        let count = if case % 8 == 0 { 2 } else { 1 };
        let friction = [0.2, 0.6, 1.5, 5.0, f64::INFINITY][case % 5];
        let mut problem = problem(&mut random, count, friction);
        let solutions = all_solutions(&problem);
        let found = solve(&mut problem);
        let friction_limit = problem.bounds[0].friction_limit;
        // Infinite friction without a solution is limited.
        let limited = found && friction == f64::INFINITY && friction_limit < friction;
        assert!(found != solutions.is_empty() || limited, "case {case}: {}", solutions.len());
        if limited || solutions.is_empty() {
            assert!(
                !limited || friction_limit >= 3.0 && problem.is_solved(),
                "case {case}: {friction_limit}"
            );
            continue;
        }
        assert!(is_among(&problem, &solutions), "case {case}: {} solutions", solutions.len());
        let slip = |e: usize| problem.y[count + e].hypot(problem.y[2 * count + e]) > 1e-6;
        sliding += usize::from((0..count).any(|e| slip(e) && problem.force(e) > 1e-6));
        // Each method alone, from zero forces; discs are not empty.
        problem.change.fill(0.0);
        if Newton::new(count).solve(&mut problem, case % 2 == 0).is_solved {
            assert!(is_among(&problem, &solutions), "case {case}, Newton");
        }
        if friction == f64::INFINITY {
            endless += 1;
            continue;
        }
        problem.change.fill(0.0);
        if problem.sweep(2000).is_solved {
            swept += 1;
            assert!(is_among(&problem, &solutions), "case {case}, sweeps");
        }
        problem.change.fill(0.0);
        let sweep = |problem: &mut ConeProblem| problem.sweep(200).is_solved;
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
    let mut random = Random(17);
    let mut limited = 0;
    let mut failed = 0;
    for case in 0..cases(300) {
        let size = 3 * [1, 2, 3, 4, 20, 40][case % 6];
        let mut problem = problem(&mut random, size / 3, f64::INFINITY);
        problem.w.iter_mut().step_by(size + 1).for_each(|entry| *entry -= 0.29);
        problem.update_scales();
        failed += usize::from(!solve(&mut problem));
        limited += usize::from(problem.bounds[0].friction_limit < f64::INFINITY);
        assert!(problem.bounds[0].friction_limit >= 3.0, "case {case}");
    }
    assert!(
        limited > 0 && 50 * failed < cases(300),
        "{limited} limited, {failed} without a solution"
    );
}

/// Friction work is computed from the shear and the slip of one solution, and is never negative.
#[test]
fn friction_takes_energy_only() {
    let mut random = Random(5);
    let mut failed = 0;
    for case in 0..300 {
        let count = 1 + case % 9;
        let friction = random.log_within(0.05, 20.0);
        let mut problem = problem(&mut random, count, friction);
        if !solve(&mut problem) {
            failed += 1;
            continue;
        }
        problem.update_motions();
        for e in 0..count {
            let places = problem.places(e);
            let force = places.map(|place| problem.force(place));
            let slip = places.map(|place| problem.y[place]);
            let work = -(force[1] * slip[1] + force[2] * slip[2]);
            assert!(work > -1e-9, "case {case}: {work:e}");
            let bounds = &problem.bounds[e];
            let shear = force[1].hypot(force[2]);
            assert!(shear <= bounds.radius(force[0]) * (1.0 + 1e-9) + 1e-9, "case {case}");
        }
    }
    assert!(failed < 12, "{failed} without a solution");
}
