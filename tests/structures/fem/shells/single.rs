//! GOAL: a single element keeps the invariants of its theory, warped or not.
//! SCENE: the elements of the tables, moved, turned, listed otherwise, thin and thick.
//! REFERENCE: rigid motions, numbers of zero eigenvalues, permuted matrices, the mass of a rigid body.

use super::{TabledShell, tabled_shells, turned_list};
use basemat::fem::{Element, MassKind, Shell};
use basemat_problems::dense::{dot, eigenpairs, largest, multiply};
use basemat_problems::supported;

fn stiffness(shell: &Shell, nodes: &[[f64; 3]]) -> Vec<Vec<f64>> {
    let order = shell.order();
    let mut matrix = vec![0.0; order * order];
    shell.stiffness(nodes, &mut matrix);
    matrix.chunks(order).map(<[f64]>::to_vec).collect()
}

/// Displacements in a unit motion of a rigid body.
fn rigid(motion: usize, nodes: &[[f64; 3]]) -> Vec<f64> {
    nodes.iter().flat_map(|&node| supported::rigid_motion(motion, node)).collect()
}

#[test]
fn rigid_motions_cause_no_force_and_nothing_else_does() {
    for TabledShell { name, shell, nodes } in tabled_shells() {
        let matrix = stiffness(&shell, &nodes);
        let scale = matrix.iter().map(|row| largest(row)).fold(0.0, f64::max);
        for motion in 0..6 {
            let force = largest(&multiply(&matrix, &rigid(motion, &nodes)));
            assert!(force < 1e-13 * scale, "{name}: {force:e}");
        }
        let order = shell.order();
        let computed = eigenpairs(&matrix).0;
        let highest_eigenvalue = computed[order - 1];
        assert!(
            computed[..6].iter().all(|value| value.abs() < 1e-14 * highest_eigenvalue),
            "{name}: {computed:?}"
        );
        assert!(computed[6] > 1e-6 * highest_eigenvalue, "{name}: {computed:?}");
    }
}

#[test]
fn matrices_do_not_depend_on_the_list_of_nodes() {
    for TabledShell { name, shell, nodes } in tabled_shells() {
        let count = nodes.len();
        let expected = stiffness(&shell, &nodes);
        let scale = expected.iter().map(|row| largest(row)).fold(0.0, f64::max);
        for start in 0..count {
            for clockwise in [false, true] {
                let order = turned_list(count, start, clockwise);
                let listed_nodes: Vec<[f64; 3]> = order.iter().map(|&node| nodes[node]).collect();
                let computed = stiffness(&shell, &listed_nodes);
                let dofs: Vec<usize> = (0..6 * count).map(|k| 6 * order[k / 6] + k % 6).collect();
                for i in 0..6 * count {
                    for j in 0..6 * count {
                        let error = (computed[i][j] - expected[dofs[i]][dofs[j]]).abs();
                        assert!(error < 1e-13 * scale, "{name} {order:?}: {error:e}");
                    }
                }
            }
        }
    }
}

/// Nodes in another unit of length: forces by displacements grow with it, moments by rotations with its cube.
#[test]
fn stiffness_scales_with_the_unit_of_length() {
    for TabledShell { name, shell, nodes } in tabled_shells() {
        let factor = 1000.0;
        let concrete = super::material(30.0e9, 0.2, 1.0);
        let larger_shell = Shell::new(shell.nodes(), concrete, factor * shell.thickness()).unwrap();
        let original = Shell::new(shell.nodes(), concrete, shell.thickness()).unwrap();
        let scaled_nodes: Vec<[f64; 3]> =
            nodes.iter().map(|node| node.map(|x| factor * x)).collect();
        let stiffness_before = stiffness(&original, &nodes);
        let scaled_stiffness = stiffness(&larger_shell, &scaled_nodes);
        // Displacements, then rotations.
        let units = [1.0, 1.0, 1.0, factor, factor, factor];
        let scale = stiffness_before.iter().map(|row| largest(row)).fold(0.0, f64::max);
        for i in 0..stiffness_before.len() {
            for j in 0..stiffness_before.len() {
                let rescaled_entry =
                    scaled_stiffness[i][j] / (factor * units[i % 6] * units[j % 6]);
                assert!((rescaled_entry - stiffness_before[i][j]).abs() < 1e-12 * scale, "{name}");
            }
        }
    }
}

/// ∫|x|² dA over a triangle, by the middles of its sides, which is exact for quadratic polynomials.
fn triangle_second_moment(points: &[[f64; 3]]) -> f64 {
    let material = super::material(1.0, 0.0, 1.0);
    let areas = Shell::new([0, 1, 2], material, 1.0).unwrap().areas(points).unwrap();
    let squares = [[0, 1], [1, 2], [2, 0]].map(|[i, j]| -> f64 {
        (0..3).map(|k| (0.5 * (points[i][k] + points[j][k])).powi(2)).sum()
    });
    areas.iter().sum::<f64>() / 3.0 * (squares[0] + squares[1] + squares[2])
}

/// φᵀ M φ of a rigid motion.
fn rigid_inertia(motion: usize, mass: &Vec<Vec<f64>>, nodes: &[[f64; 3]]) -> f64 {
    let motion = rigid(motion, nodes);
    dot(&motion, &multiply(mass, &motion))
}

/// A flat shell turns like a rigid plate: ρ∫(t r² + t³/12) dA about an axis, r the distance of the middle surface.
#[test]
fn rotations_have_mass() {
    for TabledShell { name, shell, nodes } in tabled_shells() {
        if name == "shell4_3" {
            continue;
        }
        let order = shell.order();
        let area: f64 = shell.areas(&nodes).unwrap().iter().sum();
        let mut matrix = vec![0.0; order * order];
        shell.mass(&nodes, MassKind::Consistent, &mut matrix);
        let mass: Vec<Vec<f64>> = matrix.chunks(order).map(<[f64]>::to_vec).collect();
        let density = if name == "shell3_3" { 7850.0 } else { 2500.0 };
        let t = shell.thickness();
        let mass_per_area = density * area * t;
        assert!((rigid_inertia(2, &mass, &nodes) / mass_per_area - 1.0).abs() < 1e-12, "{name}");
        // The sum about three axes is 2∫|x|² and does not depend on the plane of the shell.
        let mut second = triangle_second_moment(&nodes[..3]);
        if nodes.len() == 4 {
            second += triangle_second_moment(&[nodes[2], nodes[3], nodes[0]]);
        }
        let expected = density * t * (2.0 * second + 3.0 * area * t * t / 12.0);
        let computed = rigid_inertia(3, &mass, &nodes)
            + rigid_inertia(4, &mass, &nodes)
            + rigid_inertia(5, &mass, &nodes);
        // The corners of the second quadrilateral are written with seven digits: it is flat to 1e-6.
        assert!((computed / expected - 1.0).abs() < 1e-5, "{name}: {computed} {expected}");
    }
}
