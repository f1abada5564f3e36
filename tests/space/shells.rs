//! Mats and walls of shells: stiff ones against the rigid body, soft ones that lift off and slide.

use basemat::bem::plan::Plan;
use basemat::bem::{ElasticGround, Ground};
use basemat::fem::{Direction, Material, Mesh, Shell};
use basemat::interface::{Bonded, Coulomb, Mode};
use basemat::structure::{FemModel, RigidBody, Structure};
use basemat::{Simulation, Soil};

use super::cells::{BED, Cells, Waves};

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

/// Displacement of a structure at rest on a ground.
fn at_rest(structure: impl Structure + 'static, ground: impl Ground + 'static) -> Vec<f64> {
    let simulation = Simulation::builder(0.01)
        .structure(structure)
        .ground(ground)
        .interface(Bonded)
        .build()
        .unwrap();
    simulation.static_displacement().to_vec()
}

/// On springs, and on a half-space, which couples the cells.
#[test]
fn a_stiff_building_of_shells_is_the_rigid_body() {
    let stiff = building(1.0e16);
    let bed = || Cells::under(SIDES, [0.0; 2], [7, 5], BED);
    let soil = Soil::from_shear_wave_speed(200.0, 0.33, 1900.0).unwrap();
    // Cells of `under` would extend beyond the rigid base alone.
    let half_space = |own: &dyn Structure| {
        let plan = Plan::under(own, 8).unwrap().without_overhang().unwrap();
        ElasticGround::in_plan(soil, plan).unwrap()
    };
    let cases = [
        (at_rest(stiff.clone(), bed()), at_rest(rigid(), bed())),
        (at_rest(stiff.clone(), half_space(&stiff)), at_rest(rigid(), half_space(&rigid()))),
    ];
    for (found, exact) in cases {
        let size = exact[2].abs();
        assert!(size > 1e-5 && exact[4].abs() > 1e-2 * size, "{exact:?}");
        let base = stiff.base();
        for node in base.nodes() {
            let own = [&node.horizontal, &node.across, &node.vertical].map(|row| row.value(&found));
            let rows = rigid().displacement_at([node.x, node.y, 0.0]);
            for (own, row) in own.into_iter().zip(rows) {
                let exact = row.value(&exact);
                assert!((own - exact).abs() < 1e-6 * size, "{own} {exact} of {size}");
            }
        }
    }
}

/// Waves from three sides: cells open and slide under a soft building, and no energy is lost.
#[test]
fn a_soft_building_of_shells_lifts_off_and_slides() {
    let model = building(2.0e8);
    let top = model.mesh().node_at_point([1.0, 2.0, 13.0]).unwrap();
    let drift = model.row(top, Direction::X).unwrap();
    let mut simulation = Simulation::builder(2e-3)
        .structure(model)
        .ground(Cells::under(SIDES, [0.0; 2], [7, 5], BED))
        .interface(Coulomb::new(1.0).unwrap())
        .motion(Waves { quarters: 0 })
        .gravity(0.5)
        .build()
        .unwrap();
    let (mut open, mut sliding, mut sway) = (0, 0, 0.0_f64);
    let run = simulation.run(600, |state| {
        open = open.max(state.modes.iter().filter(|mode| **mode == Mode::Open).count());
        sliding = sliding.max(state.modes.iter().filter(|mode| **mode == Mode::Slip).count());
        sway = sway.max(drift.value(state.displacement()).abs());
    });
    let run = run.unwrap();
    assert!(run.energy_error < 1e-9, "{:e}", run.energy_error);
    assert!(open > 3 && sliding > 3 && sway > 1e-4, "{open} {sliding} {sway}");
}
