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
