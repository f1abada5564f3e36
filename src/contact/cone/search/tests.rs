//! Many elements, each of which moves most others.

use super::super::problem::Bounds;
use super::*;
use basemat_testkit::random::Random;

/// Columns and rows of the lattice.
const LATTICE_COUNTS: [usize; 2] = [9, 8];
const ELEMENT_COUNT: usize = LATTICE_COUNTS[0] * LATTICE_COUNTS[1];

/// A tilted rigid body that lands and slides on a half-space, with its centre of gravity at `height`.
fn landing(random: &mut Random, friction: f64, height: f64) -> ConeProblem {
    let mut problem = ConeProblem::new(ELEMENT_COUNT);
    let position =
        |e: usize| [(e % LATTICE_COUNTS[0]) as f64 - 4.0, (e / LATTICE_COUNTS[0]) as f64 - 3.5];
    // Displacements of a component due to the six displacements and rotations of the body.
    let modes = |i: usize| {
        let [x, y] = position(i % ELEMENT_COUNT);
        match i / ELEMENT_COUNT {
            0 => [1.0, 0.0, 0.0, x, y, 0.0],
            1 => [0.0, 1.0, 0.0, -height, 0.0, -y],
            _ => [0.0, 0.0, 1.0, 0.0, -height, x],
        }
    };
    let body_compliance = [0.02, 0.02, 0.02, 1e-3, 1e-3, 1e-3];
    for i in 0..3 * ELEMENT_COUNT {
        for j in 0..3 * ELEMENT_COUNT {
            let receiver = position(i % ELEMENT_COUNT);
            let source = position(j % ELEMENT_COUNT);
            let distance = (receiver[0] - source[0]).hypot(receiver[1] - source[1]);
            let soil = if i / ELEMENT_COUNT != j / ELEMENT_COUNT {
                0.0
            } else if distance == 0.0 {
                3.5
            } else {
                1.0 / distance
            };
            let body: f64 = (0..6).map(|k| body_compliance[k] * modes(i)[k] * modes(j)[k]).sum();
            problem.w[i * 3 * ELEMENT_COUNT + j] = soil + body;
        }
    }
    let body_displacement: [f64; 6] = std::array::from_fn(|k| match k {
        0 => -random.within(0.2, 1.0),
        1 | 2 => random.within(-2.0, 2.0),
        _ => random.within(-0.3, 0.3),
    });
    for i in 0..3 * ELEMENT_COUNT {
        problem.q[i] = (0..6).map(|k| body_displacement[k] * modes(i)[k]).sum();
    }
    problem.bounds.fill(Bounds { friction, ..Bounds::WITHOUT_FRICTION });
    problem.min_force_scale = 1e-3;
    problem.update_scales();
    problem.prepare_acceleration();
    problem
}

/// Iterations that end early or reuse factors find the forces of complete iterations.
#[test]
fn sweeps_and_brief_iterations_find_the_forces_of_other_methods() {
    let mut random = Random(23);
    let mut comparison_count = 0;
    for case in 0..12 {
        let mut problem = landing(&mut random, 0.2, [1.0, 6.0][case % 2]);
        let mut newton = Newton::new(ELEMENT_COUNT);
        let mut proximal = Proximal::new(ELEMENT_COUNT);
        assert!(problem.acceleration.is_some());
        let outcome = alternate_sweeps_and_newton(&mut problem, &mut newton);
        assert!(outcome.method.is_some(), "case {case}");
        let computed = problem.force_change.clone();
        let largest_force = problem.largest_force();
        problem.force_change.fill(0.0);
        let is_solved = proximal.solve(&mut problem, |problem| {
            newton.invalidate(false);
            problem.sweep(60).is_solved || newton.solve(problem, false).is_solved
        });
        if is_solved {
            comparison_count += 1;
            for (i, (computed, expected)) in computed.iter().zip(&problem.force_change).enumerate()
            {
                assert!(
                    (computed - expected).abs() < 1e-7 * largest_force,
                    "case {case}, {i}: {computed} {expected}"
                );
            }
        }
    }
    assert!(comparison_count > 6, "{comparison_count}");
}

/// Friction and largest force of an element in the test below.
const CAPPED_FRICTION: f64 = 0.6;
const FORCE_CAP: f64 = 2.0;

/// A landing body so light that it moves all elements by `compliance`, far more than the soil does.
///
/// Its weight is half of the largest force of all elements; a moment about y brings one side to the cap.
fn light_body(random: &mut Random, compliance: f64) -> ConeProblem {
    let mut problem = landing(random, CAPPED_FRICTION, 4.0);
    let size = problem.component_count();
    let moment = random.within(1.5, 2.2) * ELEMENT_COUNT as f64;
    let position = |e: usize| (e % LATTICE_COUNTS[0]) as f64 - 4.0;
    for i in 0..ELEMENT_COUNT {
        for j in 0..ELEMENT_COUNT {
            problem.w[i * size + j] += compliance * (1.0 + 0.2 * position(i) * position(j));
        }
        problem.q[i] = -compliance * (ELEMENT_COUNT as f64 + 0.2 * moment * position(i));
    }
    problem.bounds.iter_mut().for_each(|bounds| bounds.interval[1] = FORCE_CAP);
    problem.update_scales();
    problem
}

/// Largest violation of Signorini's law with a cap and of Coulomb's law: a gap, a slip, or a force.
fn violation(problem: &ConeProblem) -> f64 {
    let size = problem.component_count();
    let displacement = |i: usize| {
        let row = problem.w[i * size..][..size].iter();
        problem.q[i] + row.zip(&problem.force_change).map(|(w, r)| w * r).sum::<f64>()
    };
    (0..ELEMENT_COUNT).fold(0.0, |largest: f64, e| {
        let [n, x, y] = problem.component_indices(e);
        let pressure = problem.force_change[n];
        let gap = displacement(n);
        let gap_violation = if pressure <= 0.0 {
            -gap
        } else if pressure >= FORCE_CAP {
            gap
        } else {
            gap.abs()
        };
        let range_violation = (-pressure).max(pressure - FORCE_CAP);
        let shear = [x, y].map(|i| problem.force_change[i]);
        let slip = [x, y].map(displacement);
        let reserve = CAPPED_FRICTION * pressure - shear[0].hypot(shear[1]);
        // Slip opposes the shear of an element without reserve.
        let slip_violation = if reserve > 1e-6 {
            slip[0].hypot(slip[1])
        } else {
            let power = shear[0] * slip[0] + shear[1] * slip[1];
            power + shear[0].hypot(shear[1]) * slip[0].hypot(slip[1])
        };
        largest.max(gap_violation).max(range_violation).max(-reserve).max(slip_violation)
    })
}

/// Sweeps and Newton's method with the ρ of each element alone do not find these forces.
#[test]
fn elements_that_a_light_body_moves_together_are_solved_at_a_cap() {
    let mut random = Random(41);
    for case in 0..5 {
        let compliance = 1e4 * 10.0_f64.powi(case);
        let mut problem = light_body(&mut random, compliance);
        let mut newton = Newton::new(ELEMENT_COUNT);
        assert!(alternate_sweeps_and_newton(&mut problem, &mut newton).method.is_none());
        let outcome = solve_collectively(&mut problem, &mut newton);
        assert!(outcome.is_solved, "case {case}: residual {:e}", problem.residual());
        let violation = violation(&problem);
        // The accepted residual, 1e-11 of the cap, over the smallest ρ: 4.2 times the compliance at the edges.
        assert!(violation < 4.2e-11 * FORCE_CAP * compliance, "case {case}: {violation:e}");
        // The forces balance the weight, up to what the soil adds.
        let force: f64 = (0..ELEMENT_COUNT).map(|e| problem.force(e)).sum();
        assert!((force - ELEMENT_COUNT as f64).abs() < 0.01 * force, "case {case}: {force}");
    }
}
