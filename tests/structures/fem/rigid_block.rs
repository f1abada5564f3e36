//! GOAL: mass, rows and P–Δ of the rigid block.
//! SCENE: single blocks, centred and not.
//! REFERENCE: the integral over the block, a true small rotation, the potential energy.

use basemat::structure::{RigidBlock, Structure};
use basemat_problems::dense::{mass, row_value, stiffness};

#[test]
fn mass_matrix_is_the_integral_over_the_block() {
    let width = 3.0;
    let height = 7.0;
    let density = 2.0;
    let center = 1.5;
    let block = RigidBlock::new(width, height, density).unwrap().centered_at(center).unwrap();
    let matrix = mass(&block);
    let mut expected = [[0.0; 3]; 3];
    // Two Gauss points in each direction: the integrand is quadratic.
    let place = 1.0 / 3.0_f64.sqrt();
    for s in [-place, place] {
        for t in [-place, place] {
            let x = center + 0.5 * width * s;
            let z = 0.5 * height * (1.0 + t);
            for row in [block.horizontal_at(z), block.vertical_at(x)] {
                for &(i, a) in &row {
                    for &(j, b) in &row {
                        expected[i][j] += 0.25 * width * height * density * a * b;
                    }
                }
            }
        }
    }
    for i in 0..3 {
        for j in 0..3 {
            assert!((matrix[i][j] - expected[i][j]).abs() < 1e-10, "({i}, {j})");
        }
    }
}

#[test]
fn point_rows_follow_a_true_small_rotation() {
    let block = RigidBlock::new(2.0, 4.0, 1.0).unwrap().centered_at(5.0).unwrap();
    let angle = 1e-6_f64;
    let dofs = [0.0, 0.0, angle];
    // The point (x, z) beside the middle goes to (x cos − z sin, x sin + z cos).
    let x = 0.8;
    let z = 3.0;
    let expected = [x * angle.cos() - z * angle.sin() - x, x * angle.sin() + z * angle.cos() - z];
    assert!((row_value(&block.horizontal_at(z), &dofs) - expected[0]).abs() < 1e-11);
    assert!((row_value(&block.vertical_at(5.0 + x), &dofs) - expected[1]).abs() < 1e-11);
    let base = block.base();
    let nodes: Vec<_> = base.nodes().collect();
    assert_eq!([nodes[0].x, nodes[1].x], [4.0, 6.0]);
    for node in nodes {
        assert!((row_value(&node.vertical, &dofs) - angle * (node.x - 5.0)).abs() < 1e-20);
    }
}

/// `V = m g h_c cos θ` about the middle of the base: its second derivative is the stiffness.
#[test]
fn p_delta_is_the_curvature_of_the_potential_energy() {
    let block = RigidBlock::from_mass(2.0, 900.0, 500.0, 4.0).unwrap();
    assert!(stiffness(&block).iter().flatten().all(|&value| value == 0.0));
    let block = block.with_p_delta(9.81).unwrap();
    let [above, at_rest, below] =
        [1e-3, 0.0, -1e-3_f64].map(|angle| 900.0 * 9.81 * 4.0 * angle.cos());
    let step = 1e-3;
    let curvature = (above - 2.0 * at_rest + below) / (step * step);
    let computed = stiffness(&block)[2][2];
    assert!(computed < 0.0);
    assert!((computed / curvature - 1.0).abs() < 1e-6);
}
