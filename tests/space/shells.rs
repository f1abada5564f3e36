//! Mats and walls of shells: stiff ones against the rigid body, soft ones that lift off and slide.

use basemat::fem::{Material, Mesh, Shell};
use basemat::structure::{FemModel, RigidBody};

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
