//! GOAL: areas and pressures belong to the true middle surface.
//! SCENE: the elements of the tables; the surface of a box of quadrilaterals and triangles, some of them warped.
//! REFERENCE: fine facets; closed surfaces under pressure are in equilibrium.

use super::{Assembly, TabledShell, material, tabled_shells};
use basemat::fem::{Element, MassKind};
use basemat_problems::table::assert_close;

/// Interpolates between the vector from node 0 and the vector between the opposite nodes.
fn tangent(first: [[f64; 3]; 2], opposite: [[f64; 3]; 2], at: f64) -> [f64; 3] {
    std::array::from_fn(|k| {
        (1.0 - at) * (first[1][k] - first[0][k]) + at * (opposite[1][k] - opposite[0][k])
    })
}

/// Area of the bilinear surface through four nodes, by the midpoint rule on n × n cells.
fn area(nodes: &[[f64; 3]], n: usize) -> f64 {
    let mut sum = 0.0;
    for i in 0..n {
        for j in 0..n {
            let x = (i as f64 + 0.5) / n as f64;
            let y = (j as f64 + 0.5) / n as f64;
            let a = tangent([nodes[0], nodes[1]], [nodes[3], nodes[2]], y);
            let b = tangent([nodes[0], nodes[3]], [nodes[1], nodes[2]], x);
            let cross =
                [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
            sum += cross.iter().map(|part| part * part).sum::<f64>().sqrt();
        }
    }
    sum / (n * n) as f64
}

#[test]
fn areas_are_areas_of_the_surface() {
    for TabledShell { name, shell, nodes } in tabled_shells() {
        let areas = shell.areas(&nodes).unwrap();
        let computed: f64 = areas.iter().sum();
        if nodes.len() == 4 {
            // Richardson's limit of the midpoint rule.
            let expected = (4.0 * area(&nodes, 200) - area(&nodes, 100)) / 3.0;
            assert_close(name, computed, expected, 0.0, 1e-6);
        }
        // The lumped mass lies on the same areas.
        let order = shell.order();
        let mut mass = vec![0.0; order * order];
        shell.mass(&nodes, MassKind::Lumped, &mut mass);
        let density = if name == "shell3_3" { 7850.0 } else { 2500.0 };
        for (node, area) in areas.iter().enumerate() {
            let lumped = mass[6 * node * (order + 1)];
            assert_close(name, lumped, density * shell.thickness() * area, 0.0, 1e-13);
        }
    }
}

/// A crooked tank: each side with its nodes counter-clockwise from outside.
#[test]
fn pressure_on_a_closed_surface_is_in_equilibrium() {
    let mut tank = Assembly::new();
    for point in [
        [0.0, 0.0, 0.0],
        [2.0, 0.1, 0.2],
        [2.1, 1.9, -0.1],
        [-0.2, 2.0, 0.1],
        [0.1, 0.2, 2.0],
        [2.2, -0.1, 1.8],
        [1.9, 2.2, 2.3],
        [0.0, 1.8, 2.1],
    ] {
        tank.node(point);
    }
    for side in [
        &[3, 2, 1, 0][..],
        &[4, 5, 6, 7],
        &[0, 1, 5, 4],
        &[1, 2, 6, 5],
        &[2, 3, 7],
        &[2, 7, 6],
        &[3, 0, 4, 7],
    ] {
        tank.shell(side, material(1.0, 0.0, 1.0), 0.1);
    }

    let mut force = [0.0; 3];
    let mut moment = [0.0; 3];
    for shell in &tank.shells {
        let points = tank.points(shell.nodes());
        for (point, f) in points.iter().zip(shell.pressure_forces(&points, 3.0).unwrap()) {
            let arm = [
                point[1] * f[2] - point[2] * f[1],
                point[2] * f[0] - point[0] * f[2],
                point[0] * f[1] - point[1] * f[0],
            ];
            for k in 0..3 {
                force[k] += f[k];
                moment[k] += arm[k];
            }
        }
    }
    for k in 0..3 {
        assert!(force[k].abs() < 1e-13 && moment[k].abs() < 1e-12, "{force:?} {moment:?}");
    }
    // On the top of the tank the pressure pushes upwards, with its projected area.
    let points = tank.points(&[4, 5, 6, 7]);
    let up: f64 = tank.shells[1].pressure_forces(&points, 3.0).unwrap().iter().map(|f| f[2]).sum();
    let shoelace: f64 = (0..4)
        .map(|k| {
            let a = points[k];
            let b = points[(k + 1) % 4];
            0.5 * (a[0] * b[1] - a[1] * b[0])
        })
        .sum();
    assert_close("force on the top", up, 3.0 * shoelace, 0.0, 1e-13);
    assert_eq!(tank.shells[1].nodes(), [4, 5, 6, 7]);
}
