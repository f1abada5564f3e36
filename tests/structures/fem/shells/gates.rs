//! GOAL: published benchmarks of shells, at coarse meshes.
//! SCENE: `MacNeal` & Harder's cantilevers, Scordelis & Lo's roof, pinched hemispheres, NAFEMS's Z-section.
//! REFERENCE: their targets; the same formulation in Python, six digits.

use super::{ALL_DIRECTIONS, Assembly, CellPattern, RX, RY, RZ, X, Y, Z, dof, material};
use basemat::fem::{Direction, Element};
use basemat_problems::table::assert_close;
use std::f64::consts::PI;

/// Half of the difference of six printed digits, relative, with some rounding.
const PRINTED_TOLERANCE: f64 = 1e-5;

/// Spreads a force over nodes in a row: half a part for the ends.
fn spread(model: &mut Assembly, nodes: &[usize], direction: Direction, force: f64) {
    let spans = (nodes.len() - 1) as f64;
    for (index, &node) in nodes.iter().enumerate() {
        let end = index == 0 || index + 1 == nodes.len();
        model.load[dof(node, direction)] += force / spans * if end { 0.5 } else { 1.0 };
    }
}

/// Extension, shear in the plane and across, and twist of the straight cantilever 6 × 0.2 × 0.1, six cells.
#[test]
fn straight_cantilever() {
    let rectangles = [3.003_69e-5, 0.107_327, 0.423_486, 0.030_178_9];
    let parallelograms = [3.006_01e-5, 0.105_486, 0.422_572, 0.027_239_2];
    let trapezoids = [3.005_03e-5, 0.095_884_8, 0.416_205, 0.028_365_1];
    let triangles = [2.978_85e-5, 0.113_684, 0.419_732, 0.022_215_6];
    let slanted = [2.980_92e-5, 0.044_048_2, 0.419_402, 0.023_637_8];
    for (shape, pattern, expected) in [
        (0, CellPattern::Quads, rectangles),
        (1, CellPattern::Quads, parallelograms),
        (2, CellPattern::Quads, trapezoids),
        (0, CellPattern::Rising, triangles),
        (1, CellPattern::Rising, slanted),
    ] {
        let mut strip = Assembly::new();
        let steel = (material(1.0e7, 0.3, 0.0), 0.1);
        let nodes = strip.grid([6, 1], pattern, steel, |along, across| {
            let column = (6.0 * along).round();
            let slope = match shape {
                0 => 0.0,
                2 if column % 2.0 == 0.0 => -0.1,
                _ => 0.1,
            };
            let is_inner = column > 0.0 && column < 6.0;
            let shift = if is_inner { slope * (1.0 - 2.0 * across) } else { 0.0 };
            [6.0 * along + shift, 0.2 * across, 0.0]
        });
        strip.fix(nodes[0][0], &ALL_DIRECTIONS);
        strip.fix(nodes[0][1], &ALL_DIRECTIONS);
        let low = nodes[6][0];
        let high = nodes[6][1];
        for (case, &expected) in expected.iter().enumerate() {
            strip.load.fill(0.0);
            let direction = [X, Y, Z, Z][case];
            let twist = case == 3;
            strip.load[dof(low, direction)] = if twist { -5.0 } else { 0.5 };
            strip.load[dof(high, direction)] = if twist { 5.0 } else { 0.5 };
            let u = strip.solve();
            let a = u[dof(low, direction)];
            let b = u[dof(high, direction)];
            let computed = if twist { (b - a) / 0.2 } else { 0.5 * (a + b) };
            assert_close(
                &format!("{pattern:?} {shape} {direction:?}"),
                computed,
                expected,
                0.0,
                PRINTED_TOLERANCE,
            );
        }
    }
    // Beam theory: 0.1081 and 0.4321.
    assert!((rectangles[1] / 0.1081 - 0.993).abs() < 1e-3);
    assert!((rectangles[2] / 0.4321 - 0.980).abs() < 1e-3);
}

/// A strip 12 × 1.1 × 0.32, turned by 90°: forces along the width of the tip and across it.
#[test]
fn twisted_cantilever() {
    for (pattern, expected) in [
        (CellPattern::Quads, [5.405_25e-3, 1.755_37e-3]),
        (CellPattern::Rising, [5.390_07e-3, 1.754_81e-3]),
    ] {
        let mut strip = Assembly::new();
        let nodes =
            strip.grid([12, 2], pattern, (material(2.9e7, 0.22, 0.0), 0.32), |along, across| {
                let (sine, cosine) = (0.5 * PI * along).sin_cos();
                let place = 1.1 * (across - 0.5);
                [12.0 * along, place * cosine, place * sine]
            });
        for &node in &nodes[0] {
            strip.fix(node, &ALL_DIRECTIONS);
        }
        for (direction, expected, target) in
            [(Z, expected[0], 5.424e-3), (Y, expected[1], 1.754e-3)]
        {
            strip.load.fill(0.0);
            spread(&mut strip, &nodes[12], direction, 1.0);
            let computed = strip.solve()[dof(nodes[12][1], direction)];
            assert_close("tip of the twisted strip", computed, expected, 0.0, PRINTED_TOLERANCE);
            assert_close("tip of the twisted strip", computed, target, 0.0, 0.01);
        }
    }
}

/// A quarter of the roof under its weight: the middle of the free edge.
#[test]
fn scordelis_lo_roof() {
    for (pattern, expected) in
        [(CellPattern::Quads, -0.304_065), (CellPattern::Falling, -0.306_568)]
    {
        let mut roof = Assembly::new();
        let grid = [8, 8];
        let nodes =
            roof.grid(grid, pattern, (material(4.32e8, 0.0, 0.0), 0.25), |along, around| {
                let (sine, cosine) = (40.0 * around).to_radians().sin_cos();
                [25.0 * along, 25.0 * sine, 25.0 * cosine]
            });
        for k in 0..=8 {
            roof.fix(nodes[0][k], &[X, RY, RZ]);
            roof.fix(nodes[k][0], &[Y, RX, RZ]);
            roof.fix(nodes[8][k], &[Y, Z]);
        }
        for shell in &roof.shells {
            let areas = shell.areas(&roof.points(shell.nodes())).unwrap();
            for (&node, area) in shell.nodes().iter().zip(areas) {
                roof.load[dof(node, Z)] -= 90.0 * area;
            }
        }
        let computed = roof.solve()[dof(nodes[0][8], Z)];
        assert_close("edge of the roof", computed, expected, 0.0, PRINTED_TOLERANCE);
        assert_close(
            "edge of the roof",
            computed,
            -0.3024,
            0.0,
            if pattern == CellPattern::Quads { 0.01 } else { 0.02 },
        );
    }
}

/// A quarter of the hemisphere with a hole of 18°, pulled and pushed by unit forces.
#[test]
fn pinched_hemisphere() {
    // Triangles lock here: their sides are 3 √(Rt).
    for (pattern, expected) in
        [(CellPattern::Quads, 0.086_104_4), (CellPattern::Rising, 0.046_263_7)]
    {
        let mut dome = Assembly::new();
        let steel = (material(6.825e7, 0.3, 0.0), 0.04);
        let nodes = dome.grid([8, 8], pattern, steel, |around, up| {
            let east = 0.5 * PI * around;
            let north = (72.0 * up).to_radians();
            [10.0 * east.cos() * north.cos(), 10.0 * east.sin() * north.cos(), 10.0 * north.sin()]
        });
        for k in 0..=8 {
            dome.fix(nodes[0][k], &[Y, RX, RZ]);
            dome.fix(nodes[8][k], &[X, RY, RZ]);
        }
        dome.fix(nodes[0][0], &[Z]);
        dome.load[dof(nodes[0][0], X)] = 1.0;
        dome.load[dof(nodes[8][0], Y)] = -1.0;
        assert_close(
            "pinched hemisphere",
            dome.solve()[dof(nodes[0][0], X)],
            expected,
            0.0,
            PRINTED_TOLERANCE,
        );
    }
}

/// An eighth of a cylinder with diaphragms, pinched in its middle.
#[test]
fn pinched_cylinder() {
    for (pattern, expected) in
        [(CellPattern::Quads, -1.360_18e-5), (CellPattern::Falling, -1.352_18e-5)]
    {
        let mut pipe = Assembly::new();
        let nodes =
            pipe.grid([8, 8], pattern, (material(3.0e6, 0.3, 0.0), 3.0), |along, around| {
                let (sine, cosine) = (0.5 * PI * around).sin_cos();
                [300.0 * along, 300.0 * sine, 300.0 * cosine]
            });
        for k in 0..=8 {
            pipe.fix(nodes[0][k], &[X, RY, RZ]);
            pipe.fix(nodes[k][0], &[Y, RX, RZ]);
            pipe.fix(nodes[k][8], &[Z, RX, RY]);
            pipe.fix(nodes[8][k], &[Y, Z]);
        }
        pipe.load[dof(nodes[0][0], Z)] = -0.25;
        assert_close(
            "pinched cylinder",
            pipe.solve()[dof(nodes[0][0], Z)],
            expected,
            0.0,
            PRINTED_TOLERANCE,
        );
    }
}

/// NAFEMS LE5: the membrane stress at a flange's tip, a quarter of the length from the clamped end.
#[test]
fn z_section_in_torsion() {
    for (pattern, expected) in [(CellPattern::Quads, -110.074), (CellPattern::Falling, -83.433_6)] {
        let mut beam = Assembly::new();
        let steel = (material(210.0e9, 0.3, 0.0), 0.1);
        let nodes = beam.grid([8, 4], pattern, steel, |along, around| {
            let place = 4.0 * around;
            let [y, z] = if place <= 1.0 {
                [1.0 - place, 1.0]
            } else if place <= 3.0 {
                [0.0, 2.0 - place]
            } else {
                [3.0 - place, -1.0]
            };
            [10.0 * along, y, z]
        });
        for &node in &nodes[0] {
            beam.fix(node, &ALL_DIRECTIONS);
        }
        spread(&mut beam, &nodes[8][..2], Y, 0.6e6);
        spread(&mut beam, &nodes[8][3..], Y, -0.6e6);
        let u = beam.solve();
        let tip = nodes[2][0];
        let mut stresses = Vec::new();
        for shell in &beam.shells {
            if let Some(corner) = shell.nodes().iter().position(|&node| node == tip) {
                let points = beam.points(shell.nodes());
                let displacements = Assembly::node_displacements(shell, &u);
                let resultants = shell.resultants(&points, &displacements).unwrap();
                let resultants =
                    resultants[corner].in_axes([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]).unwrap();
                stresses.push(1e-6 * resultants.membrane[0] / 0.1);
            }
        }
        let mean = stresses.iter().sum::<f64>() / stresses.len() as f64;
        assert_close("stress at the tip of the flange", mean, expected, 0.0, PRINTED_TOLERANCE);
    }
}
