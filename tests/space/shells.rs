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

/// Lengths in m.
const MAT_SIDES: [f64; 2] = [6.0, 4.0];
const MAT_THICKNESS: f64 = 1.0;
/// Of a wall across the mat at x = 1.
const WALL_THICKNESS: f64 = 0.5;
const WALL_HEIGHT: f64 = 6.0;
const CONCRETE_DENSITY: f64 = 2400.0;

/// A mat of quadrilaterals listed both ways and of triangles, and a wall of quadrilaterals on it.
fn building(young_modulus: f64) -> FemModel {
    let concrete = Material::new(young_modulus, 0.2, CONCRETE_DENSITY).unwrap();
    let mut mesh = Mesh::in_space();
    let mut grid = Vec::new();
    for i in 0..4 {
        let x = 2.0 * f64::from(i) - 3.0;
        let column =
            [0, 1, 2].map(|j| mesh.add_node_at([x, 2.0 * f64::from(j) - 2.0, 7.0]).unwrap());
        grid.push(column);
    }
    let mut wall_rows = vec![grid[2]];
    for height in [3.0, WALL_HEIGHT] {
        let row = [-2.0, 0.0, 2.0].map(|y| mesh.add_node_at([1.0, y, 7.0 + height]).unwrap());
        wall_rows.push(row);
    }
    let mut shells = Vec::new();
    for i in 0..3 {
        for j in 0..2 {
            let [a, b, c, d] = [grid[i][j], grid[i + 1][j], grid[i + 1][j + 1], grid[i][j + 1]];
            let cell = match (i, j) {
                (0, 0) => vec![vec![a, d, c, b]],
                (1, _) => vec![vec![a, b, c], vec![a, d, c]],
                _ => vec![vec![a, b, c, d]],
            };
            for nodes in cell {
                shells.push(Shell::new(nodes, concrete, MAT_THICKNESS).unwrap());
            }
        }
    }
    for pair in wall_rows.windows(2) {
        for j in 0..2 {
            let nodes = [pair[0][j], pair[0][j + 1], pair[1][j + 1], pair[1][j]];
            shells.push(Shell::new(nodes, concrete, WALL_THICKNESS).unwrap());
        }
    }
    Shell::match_sides(&mut shells);
    for shell in shells {
        mesh.add(shell).unwrap();
    }
    FemModel::on_base(mesh).unwrap()
}

/// The same mass on the same base, which is rigid. The wall begins in the middle of the mat.
fn rigid_building() -> RigidBody {
    let mat_mass = CONCRETE_DENSITY * (MAT_SIDES[0] * MAT_SIDES[1] * MAT_THICKNESS);
    let wall_mass = CONCRETE_DENSITY * (MAT_SIDES[1] * WALL_THICKNESS * WALL_HEIGHT);
    let mass = mat_mass + wall_mass;
    let moment = mat_mass * 0.5 * MAT_THICKNESS + wall_mass * 0.5 * (MAT_THICKNESS + WALL_HEIGHT);
    let inertia = [[mass, 0.0, 0.0], [0.0, mass, 0.0], [0.0, 0.0, mass]];
    let x = 0.5 * MAT_SIDES[0];
    let y = 0.5 * MAT_SIDES[1];
    let outline = vec![[-x, -y], [x, -y], [x, y], [-x, y]];
    RigidBody::from_mass(outline, mass, inertia, [wall_mass / mass, 0.0, moment / mass]).unwrap()
}

#[test]
fn a_stiff_building_of_shells_is_the_rigid_body() {
    for displacement in assert_moves_rigidly(&building(1.0e16), rigid_building, MAT_SIDES) {
        assert!(displacement[4].abs() > 1e-2 * displacement[2].abs(), "{displacement:?}");
    }
}

#[test]
fn a_soft_building_of_shells_lifts_off_and_slides() {
    assert_lifts_off_and_slides(&building(2.0e8), [1.0, 2.0, 13.0], MAT_SIDES, 1.0, 0.5);
}

/// A mat, a wall of 5 m and a dome on it, all of a radius of 10 m.
///
/// Quadrilaterals of the rows with `is_split` are two triangles.
fn vessel(thickness: f64, rows: usize, is_split: impl Fn(usize) -> bool) -> FemModel {
    let concrete = Material::new(30.0e9, 0.2, CONCRETE_DENSITY).unwrap();
    let mut meridian = vec![[0.0, 0.0], [5.0, 0.0], [10.0, 0.0], [10.0, 2.5]];
    meridian.extend((0..=rows).map(|k| {
        let angle = 0.5 * PI * k as f64 / rows as f64;
        [if k == rows { 0.0 } else { 10.0 * angle.cos() }, 5.0 + 10.0 * angle.sin()]
    }));
    let mut mesh = Mesh::in_space();
    let surface = mesh.revolve([0.0; 2], &meridian, 4 * rows).unwrap();
    let mut shells = Vec::new();
    for (row, cell) in surface.cells() {
        let thickness = if row < 2 { 1.0 } else { thickness };
        let faces = match cell[..] {
            [a, b, c, d] if is_split(row) => vec![vec![a, b, c], vec![a, c, d]],
            _ => vec![cell.clone()],
        };
        for nodes in faces {
            shells.push(Shell::new(nodes, concrete, thickness).unwrap());
        }
    }
    Shell::match_sides(&mut shells);
    for shell in shells {
        mesh.add(shell).unwrap();
    }
    FemModel::on_base(mesh).unwrap()
}

/// The warning of long triangles in a run of one step.
fn long_triangles_warning(model: FemModel) -> Option<Warning> {
    let structure = StructureGroup::new().with(model, 0.0).unwrap();
    let plan = Plan::under(&structure, 4).unwrap();
    let mut simulation = Simulation::builder(0.01)
        .structure(structure)
        .ground(SpringGround::in_plan(plan, [1e8; 3]).unwrap())
        .interface(Bonded)
        .build()
        .unwrap();
    let warnings = simulation.run(1, |_| {}).unwrap().warnings;
    warnings.into_iter().find(|warning| matches!(warning, Warning::LongTriangles { .. }))
}

/// Reference: √(R t).
#[test]
fn long_triangles_of_a_dome_warn() {
    // Triangles of the mat, of the wall and at the pole are right.
    assert_eq!(vessel(0.1, 4, |_| false).description().triangle_sides, None);
    let sides = vessel(0.1, 4, |row| row < 4).description().triangle_sides.unwrap();
    assert!(sides[0] < 1e-3 * sides[1], "{sides:?}");
    for thickness in [0.1, 0.9] {
        let model = vessel(thickness, 6, |row| row > 3);
        let sides = model.description().triangle_sides.unwrap();
        // From 2.6 m along a meridian by 2.6 m at its foot and 0.7 m at the top, and diagonals.
        assert!((2.2..2.8).contains(&sides[0]), "{sides:?}");
        let ratio = sides[1] / (10.0 * thickness).sqrt();
        assert!((ratio - 1.0).abs() < 0.03, "{ratio}");
    }
    assert_eq!(long_triangles_warning(vessel(0.1, 4, |_| false)), None);
    let Some(Warning::LongTriangles { side, longest }) =
        long_triangles_warning(vessel(0.1, 4, |row| row > 3))
    else {
        panic!("no warning")
    };
    assert!((3.3..4.2).contains(&side) && (longest - 1.0).abs() < 0.03, "{side} {longest}");
}
