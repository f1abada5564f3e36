//! Small problems against all their solutions, which an independent code finds.

mod systems;

use super::newton::Newton;
use super::problem::{Bounds, ConeProblem};
use super::{proximal::Proximal, search::find_forces};
use basemat_testkit::random::Random;

/// A random problem of `count` elements with a positive definite W.
fn random_problem(random: &mut Random, count: usize, friction: f64) -> ConeProblem {
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
        // Infinite friction with a bond would be replaced by a lower one.
        if random.chance(0.3) && friction < f64::INFINITY {
            bounds.shear_strength = random.within(0.0, 0.3);
        }
        if random.chance(0.3) {
            bounds.interval[1] = random.within(0.1, 0.6);
            bounds.hardening = if bounds.interval[1] < 0.35 { 2.0 } else { 0.0 };
        }
        if random.chance(0.3) {
            bounds.closed_gap = random.within(-0.2, 0.2);
        }
    }
    problem.min_force_scale = 1e-3;
    problem.update_scales();
    problem
}

/// Number of initial angles of a slip direction.
const ANGLE_COUNT: usize = 24;

/// Normal state of an element in a trial: open, closed or at its cap.
#[derive(Clone, Copy, PartialEq)]
enum NormalState {
    Open,
    Closed,
    Capped,
}

/// Solves a linear system by elimination; `None` if singular. Each row ends with its right-hand side.
fn eliminate(mut rows: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let n = rows.len();
    for k in 0..n {
        let pivot_index = (k..n).max_by(|a, b| rows[*a][k].abs().total_cmp(&rows[*b][k].abs()))?;
        rows.swap(k, pivot_index);
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

/// Row of W of a component.
fn w_row(problem: &ConeProblem, i: usize) -> &[f64] {
    &problem.w[i * problem.component_count()..][..problem.component_count()]
}

/// Forces of elements in these states.
///
/// A state is the normal state, and whether the element slides with its shear at its angle.
fn forces(
    problem: &ConeProblem,
    states: &[(NormalState, bool)],
    angles: &[f64],
) -> Option<Vec<f64>> {
    let size = problem.component_count();
    let mut rows = Vec::new();
    for i in 0..size {
        let component = i / problem.element_count;
        let e = i % problem.element_count;
        let bounds = &problem.bounds[e];
        let mut row = vec![0.0; size + 1];
        let mut set_displacement = |displacement: f64| {
            row[..size].copy_from_slice(w_row(problem, i));
            row[size] = displacement - problem.q[i];
        };
        match (component, states[e]) {
            (0, (NormalState::Closed, _)) => set_displacement(bounds.closed_gap),
            (0, (NormalState::Capped, _)) => {
                // p = cap + hardening (closed gap − y).
                set_displacement(bounds.closed_gap);
                for entry in &mut row {
                    *entry *= bounds.hardening;
                }
                row[i] += 1.0;
                row[size] += bounds.interval[1];
            }
            (0, _) => row[i] = 1.0,
            (_, (_, false)) => set_displacement(0.0),
            // The limit of infinite friction: shear along the slip without pressure, in a closed gap.
            (1, (NormalState::Closed, true)) if bounds.has_infinite_friction() => row[e] = 1.0,
            (2, (NormalState::Closed, true)) if bounds.has_infinite_friction() => {
                (row[i - problem.element_count], row[i]) = (-angles[e].sin(), angles[e].cos());
            }
            (_, (normal_state, true)) => {
                let d = if component == 1 { angles[e].cos() } else { angles[e].sin() };
                // An open element has its shear strength until its bond breaks.
                let is_open = normal_state == NormalState::Open;
                let friction = if is_open { 0.0 } else { bounds.effective_friction() };
                row[i] = 1.0;
                row[e] -= friction * d;
                row[size] = bounds.shear_strength * d;
            }
        }
        rows.push(row);
    }
    eliminate(rows)
}

/// Displacements of all components due to the forces r.
fn displacements(problem: &ConeProblem, r: &[f64]) -> Vec<f64> {
    let products =
        (0..r.len()).map(|i| w_row(problem, i).iter().zip(r).map(|(w, r)| w * r).sum::<f64>());
    problem.q.iter().zip(products).map(|(q, product)| q + product).collect()
}

/// Whether an element with these bounds cannot have this state.
///
/// Limits of other states count as impossible, too.
fn is_impossible(bounds: &Bounds, state: (NormalState, bool)) -> bool {
    match state {
        (NormalState::Capped, slides) => {
            bounds.interval[1] == f64::INFINITY || slides && bounds.has_infinite_friction()
        }
        (NormalState::Open, false) => bounds.has_infinite_friction(),
        _ => false,
    }
}

/// All solutions that Newton's method finds from a grid of slip directions, for all sets of states.
fn all_solutions(problem: &ConeProblem) -> Vec<Vec<f64>> {
    let count = problem.element_count;
    let mut solutions: Vec<Vec<f64>> = Vec::new();
    let choices = [NormalState::Open, NormalState::Closed, NormalState::Capped]
        .map(|normal_state| [(normal_state, false), (normal_state, true)])
        .concat();
    for set in 0..(0..count).fold(1, |product, _| product * choices.len()) {
        let mut quotient = set;
        let mut states = Vec::with_capacity(count);
        for _ in 0..count {
            states.push(choices[quotient % choices.len()]);
            quotient /= choices.len();
        }
        let sliding: Vec<_> = (0..count).filter(|e| states[*e].1).collect();
        if (0..count).any(|e| is_impossible(&problem.bounds[e], states[e])) {
            continue;
        }
        // Slip across the direction of the shear, which is zero at a solution; and the forces.
        let cross_slip = |angles: &[f64]| -> Option<(Vec<f64>, Vec<f64>)> {
            let r = forces(problem, &states, angles)?;
            let y = displacements(problem, &r);
            let residuals = sliding
                .iter()
                .map(|&e| angles[e].cos() * y[2 * count + e] - angles[e].sin() * y[count + e]);
            Some((residuals.collect(), r))
        };
        // Newton's method with finite differences, from a grid of angles.
        for start in 0..sliding.iter().fold(1, |product, _| product * ANGLE_COUNT) {
            let mut angles = vec![0.0; count];
            let mut quotient = start;
            for &e in &sliding {
                let angle_index = quotient % ANGLE_COUNT;
                angles[e] = angle_index as f64 * std::f64::consts::TAU / ANGLE_COUNT as f64;
                quotient /= ANGLE_COUNT;
            }
            let mut solution = None;
            for _ in 0..30 {
                let Some((residuals, r)) = cross_slip(&angles) else { break };
                if residuals.iter().all(|residual| residual.abs() < 1e-12) {
                    solution = Some(r);
                    break;
                }
                let mut rows: Vec<Vec<f64>> =
                    residuals.iter().map(|residual| vec![-residual]).collect();
                for (k, &e) in sliding.iter().enumerate() {
                    let mut turned_angles = angles.clone();
                    turned_angles[e] += 1e-7;
                    let Some((turned_residuals, _)) = cross_slip(&turned_angles) else { break };
                    let pairs = turned_residuals.iter().zip(&residuals);
                    for (row, (turned_residual, residual)) in rows.iter_mut().zip(pairs) {
                        row.insert(k, (turned_residual - residual) / 1e-7);
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
            let y = displacements(problem, &r);
            let is_admissible = (0..count).all(|e| {
                let bounds = &problem.bounds[e];
                let force = problem.component_indices(e).map(|i| r[i]);
                let displacement = problem.component_indices(e).map(|i| y[i]);
                let shear = force[1].hypot(force[2]);
                let radius = match states[e] {
                    (NormalState::Closed, true) if bounds.has_infinite_friction() => shear,
                    (NormalState::Open, _) if bounds.has_infinite_friction() => 0.0,
                    _ => bounds.radius(force[0]),
                };
                let gap = displacement[0] - bounds.closed_gap;
                let is_normal_admissible = match states[e].0 {
                    NormalState::Open => gap >= -1e-9,
                    NormalState::Closed => {
                        force[0] >= -1e-9 && force[0] <= bounds.interval[1] + 1e-9
                    }
                    NormalState::Capped => gap <= 1e-9,
                };
                let slip_work = force[1] * displacement[1] + force[2] * displacement[2];
                let slides = (shear - radius).abs() < 1e-9 && slip_work <= 1e-9;
                is_normal_admissible && if states[e].1 { slides } else { shear <= radius + 1e-9 }
            });
            let is_new = solutions
                .iter()
                .all(|solution| solution.iter().zip(&r).any(|(a, b)| (a - b).abs() >= 1e-7));
            if is_admissible && is_new {
                solutions.push(r);
            }
        }
    }
    solutions
}

/// Solves the problem by all methods; returns whether they succeed.
fn solve(problem: &mut ConeProblem) -> bool {
    let count = problem.element_count;
    let mut newton = Newton::new(count);
    let mut proximal = Proximal::new(count);
    let mut scratch = [(); 2].map(|()| vec![0.0; 3 * count]);
    let [initial, limited] = &mut scratch;
    find_forces(problem, &mut newton, &mut proximal, initial, limited, true)
        .method
        .is_some()
}

/// Whether the present forces are one of the solutions.
fn is_among(problem: &ConeProblem, solutions: &[Vec<f64>]) -> bool {
    solutions.iter().any(|solution| {
        solution.iter().enumerate().all(|(i, force)| (force - problem.force(i)).abs() < 1e-7)
    })
}

/// Number of random problems of a run.
///
/// A fifth of all, or all of them if `HEAVY_TESTS` is set.
fn case_count(all: usize) -> usize {
    if basemat_testkit::heavy() { all } else { all / 5 }
}

#[test]
fn each_method_finds_one_of_all_solutions() {
    let mut random = Random(11);
    let mut sliding_count = 0;
    let mut sweep_count = 0;
    let mut proximal_count = 0;
    let mut infinite_friction_count = 0;
    for case in 0..case_count(300) {
        let count = if case % 8 == 0 { 2 } else { 1 };
        let friction = [0.2, 0.6, 1.5, 5.0, f64::INFINITY][case % 5];
        let mut problem = random_problem(&mut random, count, friction);
        let solutions = all_solutions(&problem);
        let is_solved = solve(&mut problem);
        let friction_limit = problem.bounds[0].friction_limit;
        // Infinite friction without a solution is limited.
        let is_limited = is_solved && friction == f64::INFINITY && friction_limit < friction;
        let has_solution = !solutions.is_empty();
        assert!(is_solved == has_solution || is_limited, "case {case}: {}", solutions.len());
        if is_limited || !has_solution {
            assert!(
                !is_limited || friction_limit >= 3.0 && problem.is_solved(),
                "case {case}: {friction_limit}"
            );
            continue;
        }
        assert!(is_among(&problem, &solutions), "case {case}: {} solutions", solutions.len());
        let has_sliding_element = (0..count).any(|e| {
            let slip = problem.y[count + e].hypot(problem.y[2 * count + e]);
            slip > 1e-6 && problem.force(e) > 1e-6
        });
        sliding_count += usize::from(has_sliding_element);
        // Each method alone, from zero forces.
        problem.force_change.fill(0.0);
        if Newton::new(count).solve(&mut problem, case % 2 == 0).is_solved {
            assert!(is_among(&problem, &solutions), "case {case}, Newton");
        }
        if friction == f64::INFINITY {
            infinite_friction_count += 1;
            continue;
        }
        problem.force_change.fill(0.0);
        if problem.sweep(2000).is_solved {
            sweep_count += 1;
            assert!(is_among(&problem, &solutions), "case {case}, sweeps");
        }
        problem.force_change.fill(0.0);
        let sweep = |problem: &mut ConeProblem| problem.sweep(200).is_solved;
        if Proximal::new(count).solve(&mut problem, sweep) {
            proximal_count += 1;
            assert!(is_among(&problem, &solutions), "case {case}, proximal");
        }
    }
    assert!(
        infinite_friction_count > case_count(40)
            && sliding_count > case_count(40)
            && sweep_count > case_count(150)
            && proximal_count > case_count(150),
        "{infinite_friction_count} {sliding_count} {sweep_count} {proximal_count}"
    );
}

/// Infinite friction is limited, as little as possible, where the search finds no solution.
#[test]
fn infinite_friction_is_limited_where_the_search_finds_no_solution() {
    let mut random = Random(17);
    let mut limited_count = 0;
    let mut failure_count = 0;
    for case in 0..case_count(300) {
        let size = 3 * [1, 2, 3, 4, 20, 40][case % 6];
        let mut problem = random_problem(&mut random, size / 3, f64::INFINITY);
        problem.w.iter_mut().step_by(size + 1).for_each(|entry| *entry -= 0.29);
        problem.update_scales();
        failure_count += usize::from(!solve(&mut problem));
        limited_count += usize::from(problem.bounds[0].friction_limit < f64::INFINITY);
        assert!(problem.bounds[0].friction_limit >= 3.0, "case {case}");
    }
    assert!(
        limited_count > 0 && 50 * failure_count < case_count(300),
        "{limited_count} limited, {failure_count} without a solution"
    );
}

/// The shear and the slip of a solution give its friction work.
#[test]
fn friction_only_dissipates_energy() {
    let mut random = Random(5);
    let mut failure_count = 0;
    for case in 0..300 {
        let count = 1 + case % 9;
        let friction = random.log_within(0.05, 20.0);
        let mut problem = random_problem(&mut random, count, friction);
        if !solve(&mut problem) {
            failure_count += 1;
            continue;
        }
        problem.update_displacements();
        for e in 0..count {
            let indices = problem.component_indices(e);
            let force = indices.map(|i| problem.force(i));
            let y = indices.map(|i| problem.y[i]);
            let work = -(force[1] * y[1] + force[2] * y[2]);
            assert!(work > -1e-9, "case {case}: {work:e}");
            let bounds = &problem.bounds[e];
            let shear = force[1].hypot(force[2]);
            assert!(shear <= bounds.radius(force[0]) * (1.0 + 1e-9) + 1e-9, "case {case}");
        }
    }
    assert!(failure_count < 12, "{failure_count} without a solution");
}
