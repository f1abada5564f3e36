//! Mats and walls of shells: stiff ones against the rigid body, soft ones that lift off and slide; triangles of domes.

use std::f64::consts::PI;

use basemat::Simulation;
use basemat::bem::SpringGround;
use basemat::bem::plan::Plan;
use basemat::coupled::Warning;
use basemat::fem::{Material, Mesh, Shell};
use basemat::interface::Bonded;
use basemat::structure::{FemModel, RigidBody, Structure, StructureGroup};

use super::finite_elements::{assert_lifts_off_and_slides, assert_moves_rigidly};

/// Sides of the mat, m, and its thickness.
const SIDES: [f64; 2] = [6.0, 4.0];
const MAT: f64 = 1.0;
/// Thickness and height of a wall across the mat at x = 1, m.
const WALL: [f64; 2] = [0.5, 6.0];
const DENSITY: f64 = 2400.0;

/// A mat of quadrilaterals listed both ways and of triangles, and a wall of quadrilaterals on it.
fn building(young_modulus: f64) -> FemModel {
    let concrete = Material::new(young_modulus, 0.2, DENSITY).unwrap();
    let mut mesh = Mesh::in_space();
    let mut node = |point| mesh.add_node_at(point).unwrap();
    let grid: Vec<[usize; 3]> = (0..4)
        .map(|i| [0, 1, 2].map(|j| node([2.0 * f64::from(i) - 3.0, 2.0 * f64::from(j) - 2.0, 7.0])))
        .collect();
    let mut rows = vec![grid[2]];
    for height in [3.0, WALL[1]] {
        rows.push([-2.0, 0.0, 2.0].map(|y| node([1.0, y, 7.0 + height])));
    }
    let mut shells = Vec::new();
    for i in 0..3 {
        for j in 0..2 {
            let [a, b] = [grid[i][j], grid[i + 1][j]];
            let [d, c] = [grid[i][j + 1], grid[i + 1][j + 1]];
            let cell = match (i, j) {
                (0, 0) => vec![vec![a, d, c, b]],
                (1, _) => vec![vec![a, b, c], vec![a, d, c]],
                _ => vec![vec![a, b, c, d]],
            };
            shells.extend(cell.into_iter().map(|nodes| Shell::new(nodes, concrete, MAT).unwrap()));
        }
    }
    for pair in rows.windows(2) {
        for j in 0..2 {
            let nodes = [pair[0][j], pair[0][j + 1], pair[1][j + 1], pair[1][j]];
            shells.push(Shell::new(nodes, concrete, WALL[0]).unwrap());
        }
    }
    Shell::match_sides(&mut shells);
    for shell in shells {
        mesh.add(shell).unwrap();
    }
    FemModel::on_base(mesh).unwrap()
}

/// The same mass on the same base, which is rigid. The wall begins in the middle of the mat.
fn rigid() -> RigidBody {
    let [mat, wall] =
        [SIDES[0] * SIDES[1] * MAT, SIDES[1] * WALL[0] * WALL[1]].map(|v| DENSITY * v);
    let mass = mat + wall;
    let height = (mat * 0.5 * MAT + wall * 0.5 * (MAT + WALL[1])) / mass;
    let inertia = [[mass, 0.0, 0.0], [0.0, mass, 0.0], [0.0, 0.0, mass]];
    let [x, y] = SIDES.map(|side| 0.5 * side);
    let outline = vec![[-x, -y], [x, -y], [x, y], [-x, y]];
    RigidBody::from_mass(outline, mass, inertia, [wall / mass, 0.0, height]).unwrap()
}

#[test]
fn a_stiff_building_of_shells_is_the_rigid_body() {
    for exact in assert_moves_rigidly(&building(1.0e16), rigid, SIDES) {
        assert!(exact[4].abs() > 1e-2 * exact[2].abs(), "{exact:?}");
    }
}

#[test]
fn a_soft_building_of_shells_lifts_off_and_slides() {
    assert_lifts_off_and_slides(&building(2.0e8), [1.0, 2.0, 13.0], SIDES, 1.0, 0.5);
}

/// A mat, a wall of 5 m and a dome on it, all of a radius of 10 m; quadrilaterals of the rows with `is_split` are two
/// triangles.
fn vessel(thickness: f64, rows: usize, is_split: impl Fn(usize) -> bool) -> FemModel {
    let concrete = Material::new(30.0e9, 0.2, DENSITY).unwrap();
    let mut meridian = vec![[0.0, 0.0], [5.0, 0.0], [10.0, 0.0], [10.0, 2.5]];
    meridian.extend((0..=rows).map(|k| {
        let (sine, cosine) = (0.5 * PI * k as f64 / rows as f64).sin_cos();
        [if k == rows { 0.0 } else { 10.0 * cosine }, 5.0 + 10.0 * sine]
    }));
    let mut mesh = Mesh::in_space();
    let surface = mesh.revolve([0.0; 2], &meridian, 4 * rows).unwrap();
    let mut shells = Vec::new();
    for (row, cell) in surface.cells() {
        let mut add = |nodes: &[usize]| {
            let thickness = if row < 2 { 1.0 } else { thickness };
            shells.push(Shell::new(nodes, concrete, thickness).unwrap());
        };
        match cell[..] {
            [a, b, c, d] if is_split(row) => [[a, b, c], [a, c, d]].iter().for_each(|own| add(own)),
            _ => add(&cell),
        }
    }
    Shell::match_sides(&mut shells);
    for shell in shells {
        mesh.add(shell).unwrap();
    }
    FemModel::on_base(mesh).unwrap()
}

/// Reference: √(R t).
#[test]
fn long_triangles_of_a_dome_warn() {
    // Triangles of the mat, of the wall and at the pole are right.
    assert_eq!(vessel(0.1, 4, |_| false).description().triangle_sides, None);
    let [side, longest] = vessel(0.1, 4, |row| row < 4).description().triangle_sides.unwrap();
    assert!(side < 1e-3 * longest, "{side} {longest}");
    let limit = |thickness: f64| {
        let [side, longest] =
            vessel(thickness, 6, |row| row > 3).description().triangle_sides.unwrap();
        // From 2.6 m along a meridian by 2.6 m at its foot and 0.7 m at the top, and diagonals.
        assert!((2.2..2.8).contains(&side), "{side}");
        longest
    };
    for thickness in [0.1, 0.9] {
        let found = limit(thickness) / (10.0 * thickness).sqrt();
        assert!((found - 1.0).abs() < 0.03, "{found}");
    }
    let warned = |structure: StructureGroup| {
        let plan = Plan::under(&structure, 4).unwrap();
        let mut simulation = Simulation::builder(0.01)
            .structure(structure)
            .ground(SpringGround::in_plan(plan, [1e8; 3]).unwrap())
            .interface(Bonded)
            .build()
            .unwrap();
        let warnings = simulation.run(1, |_| {}).unwrap().warnings;
        warnings.into_iter().find(|own| matches!(own, Warning::LongTriangles { .. }))
    };
    let group = |model: FemModel| StructureGroup::new().with(model, 0.0).unwrap();
    assert_eq!(warned(group(vessel(0.1, 4, |_| false))), None);
    let Some(Warning::LongTriangles { side, longest }) =
        warned(group(vessel(0.1, 4, |row| row > 3)))
    else {
        panic!("no warning")
    };
    assert!((3.3..4.2).contains(&side) && (longest - 1.0).abs() < 0.03, "{side} {longest}");
}
