//! Mats and walls of shells: stiff ones against the rigid body, soft ones that lift off and slide.

use basemat::fem::{Material, Mesh, Shell};
use basemat::structure::{FemModel, RigidBody};

use super::finite_elements::{assert_lifts_off_and_slides, assert_moves_rigidly};

/// Lengths in m.
const MAT_SIDES: [f64; 2] = [6.0, 4.0];
const MAT_THICKNESS: f64 = 1.0;
/// Dimensions of a wall across the mat at x = 1.
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

/// A rigid body with the same mass on the same base. The wall begins in the middle of the mat.
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
