//! GOAL: a single element keeps the invariants of its theory, warped or not.
//! SCENE: the elements of the tables, moved, turned, listed otherwise, thin and thick.
//! REFERENCE: rigid motions, numbers of zero eigenvalues, permuted matrices, the mass of a rigid body.

use super::tabled;
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
    nodes.iter().flat_map(|&node| supported::rigid(motion, node)).collect()
}

#[test]
fn rigid_motions_cause_no_force_and_nothing_else_does() {
    for (name, shell, nodes) in tabled() {
        let matrix = stiffness(&shell, &nodes);
        let scale = matrix.iter().map(|row| largest(row)).fold(0.0, f64::max);
        for motion in 0..6 {
            let force = largest(&multiply(&matrix, &rigid(motion, &nodes)));
            assert!(force < 1e-13 * scale, "{name}: {force:e}");
        }
        let order = shell.order();
        let (found, _) = eigenpairs(&matrix);
        let most = found[order - 1];
        assert!(found[..6].iter().all(|value| value.abs() < 1e-14 * most), "{name}: {found:?}");
        assert!(found[6] > 1e-6 * most, "{name}: {found:?}");
    }
}

#[test]
fn matrices_do_not_depend_on_the_list_of_nodes() {
    for (name, shell, nodes) in tabled() {
        let count = nodes.len();
        let wanted = stiffness(&shell, &nodes);
        let scale = wanted.iter().map(|row| largest(row)).fold(0.0, f64::max);
        for start in 0..count {
            for clockwise in [false, true] {
                let turn = |k: usize| (start + if clockwise { count - k } else { k }) % count;
                let order: Vec<usize> = (0..count).map(turn).collect();
                let moved: Vec<[f64; 3]> = order.iter().map(|&node| nodes[node]).collect();
                let found = stiffness(&shell, &moved);
                for i in 0..6 * count {
                    for j in 0..6 * count {
                        let place = |k: usize| 6 * order[k / 6] + k % 6;
                        let error = (found[i][j] - wanted[place(i)][place(j)]).abs();
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
    for (name, shell, nodes) in tabled() {
        let factor = 1000.0;
        let larger = Shell::new(
            shell.nodes(),
            super::material(30.0e9, 0.2, 1.0),
            factor * shell.thickness(),
        );
        let own = Shell::new(shell.nodes(), super::material(30.0e9, 0.2, 1.0), shell.thickness());
        let far: Vec<[f64; 3]> = nodes.iter().map(|node| node.map(|x| factor * x)).collect();
        let [small, large] = [stiffness(&own.unwrap(), &nodes), stiffness(&larger.unwrap(), &far)];
        let part = |k: usize| if k % 6 < 3 { 1.0 } else { factor };
        let scale = small.iter().map(|row| largest(row)).fold(0.0, f64::max);
        for i in 0..small.len() {
            for j in 0..small.len() {
                let scaled = large[i][j] / (factor * part(i) * part(j));
                assert!((scaled - small[i][j]).abs() < 1e-12 * scale, "{name}");
            }
        }
    }
}

/// A flat shell turns like a rigid plate: ρ∫(t r² + t³/12) dA about an axis, r the distance of the middle surface.
#[test]
fn rotations_have_mass() {
    for (name, shell, nodes) in tabled().into_iter().filter(|(name, ..)| *name != "shell4_3") {
        let order = shell.order();
        let area: f64 = shell.areas(&nodes).unwrap().iter().sum();
        let mut matrix = vec![0.0; order * order];
        shell.mass(&nodes, MassKind::Consistent, &mut matrix);
        let mass: Vec<Vec<f64>> = matrix.chunks(order).map(<[f64]>::to_vec).collect();
        let density = if name == "shell3_3" { 7850.0 } else { 2500.0 };
        let t = shell.thickness();
        let energy = |motion: usize| {
            let motion = rigid(motion, &nodes);
            dot(&motion, &multiply(&mass, &motion))
        };
        let whole = density * area * t;
        assert!((energy(2) / whole - 1.0).abs() < 1e-12, "{name}");
        // The sum about three axes is 2∫|x|² and does not depend on the plane of the shell.
        let squares = |points: &[[f64; 3]], area: f64| {
            // Exact for quadratic polynomials on a triangle: the middles of its sides.
            let middle = |i: usize, j: usize| -> f64 {
                (0..3).map(|k| (0.5 * (points[i][k] + points[j][k])).powi(2)).sum()
            };
            area / 3.0 * (middle(0, 1) + middle(1, 2) + middle(2, 0))
        };
        let triangle = |points: &[[f64; 3]]| {
            let list: Vec<usize> = (0..3).collect();
            let own = Shell::new(list, super::material(1.0, 0.0, 1.0), 1.0).unwrap();
            squares(points, own.areas(points).unwrap().iter().sum())
        };
        let mut second = triangle(&nodes[..3]);
        if nodes.len() == 4 {
            second += triangle(&[nodes[2], nodes[3], nodes[0]]);
        }
        let wanted = density * t * (2.0 * second + 3.0 * area * t * t / 12.0);
        let found = energy(3) + energy(4) + energy(5);
        // The corners of the second quadrilateral are written with seven digits: it is flat to 1e-6.
        assert!((found / wanted - 1.0).abs() < 1e-5, "{name}: {found} {wanted}");
    }
}
