//! Blocks of finite elements in space: stiff ones against the rigid body, soft ones that lift off and slide.

use basemat::bem::{ElasticGround, Ground};
use basemat::fem::{Direction, Mesh};
use basemat::interface::{Bonded, Coulomb, Mode};
use basemat::structure::{FemModel, RigidBody, Structure};
use basemat::{Simulation, Soil};
use basemat_problems::stiff_element::StiffElement;

use super::cells::{BED_PROPERTIES, CrossingPulses, SpringCells};

/// Sides, m, and bricks along x, y and z.
const BLOCK_SIDES: [f64; 3] = [6.0, 4.0, 4.0];
const BRICK_COUNTS: [usize; 3] = [3, 2, 2];

/// Mass of a brick, kg: the block is heavier on the right and in front.
fn brick_mass([i, j, _]: [usize; 3]) -> f64 {
    2.0e4 * (1.0 + i as f64 - 0.5 * j as f64)
}

/// Positions of the bricks: along x, y and z.
fn bricks() -> impl Iterator<Item = [usize; 3]> {
    let [nx, ny, nz] = BRICK_COUNTS;
    (0..nx * ny * nz).map(move |k| [k % nx, k / nx % ny, k / nx / ny])
}

/// Nodes of a brick, the lower four first.
fn brick_nodes([i, j, k]: [usize; 3]) -> [usize; 8] {
    let nx = BRICK_COUNTS[0];
    let ny = BRICK_COUNTS[1];
    let corners =
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
    corners.map(|[a, b, c]| i + a + (nx + 1) * (j + b + (ny + 1) * (k + c)))
}

/// Bricks of this stiffness (N/m) on their lower sides, about the origin.
fn block(stiffness: f64) -> FemModel {
    let mut mesh = Mesh::in_space();
    let [nx, ny, nz] = BRICK_COUNTS;
    for k in 0..(nx + 1) * (ny + 1) * (nz + 1) {
        let cell = [k % (nx + 1), k / (nx + 1) % (ny + 1), k / (nx + 1) / (ny + 1)];
        let place: [f64; 3] = std::array::from_fn(|axis| {
            BLOCK_SIDES[axis] * cell[axis] as f64 / BRICK_COUNTS[axis] as f64
        });
        let x = place[0] - 0.5 * BLOCK_SIDES[0];
        let y = place[1] - 0.5 * BLOCK_SIDES[1];
        mesh.add_node_at([x, y, place[2]]).unwrap();
    }
    for brick in bricks() {
        let nodal_mass = brick_mass(brick) / 8.0;
        mesh.add(StiffElement::brick(brick_nodes(brick), stiffness, nodal_mass)).unwrap();
    }
    FemModel::on_base(mesh).unwrap()
}

/// A rigid body with the mass and the base of the block.
fn rigid_block() -> RigidBody {
    let mass: f64 = bricks().map(brick_mass).sum();
    let center = [0, 1, 2].map(|axis| {
        let mut moment = 0.0;
        for brick in bricks() {
            let place = BLOCK_SIDES[axis] * (brick[axis] as f64 + 0.5) / BRICK_COUNTS[axis] as f64;
            let arm = if axis < 2 { place - 0.5 * BLOCK_SIDES[axis] } else { place };
            moment += brick_mass(brick) * arm;
        }
        moment / mass
    });
    let inertia = [[mass, 0.0, 0.0], [0.0, mass, 0.0], [0.0, 0.0, mass]];
    let x = 0.5 * BLOCK_SIDES[0];
    let y = 0.5 * BLOCK_SIDES[1];
    RigidBody::from_mass(vec![[-x, -y], [x, -y], [x, y], [-x, y]], mass, inertia, center).unwrap()
}

/// Displacement of a structure at rest on a ground.
fn static_displacement(
    structure: impl Structure + 'static,
    ground: impl Ground + 'static,
) -> Vec<f64> {
    let simulation = Simulation::builder(0.01)
        .structure(structure)
        .ground(ground)
        .interface(Bonded)
        .build()
        .unwrap();
    simulation.static_displacement().to_vec()
}

/// The half-space under a structure, with cells that extend equally far beyond both bases.
fn half_space(structure: &dyn Structure) -> ElasticGround {
    let soil = Soil::from_shear_wave_speed(200.0, 0.33, 1900.0).unwrap();
    ElasticGround::under(soil, structure, 8).unwrap()
}

/// Compares the base of a stiff model at rest with a rigid body, on springs and on a half-space, which couples the
/// cells. Returns the displacement of the body on each.
pub(super) fn assert_moves_rigidly(
    stiff_model: &FemModel,
    rigid_body: impl Fn() -> RigidBody,
    sides: [f64; 2],
) -> [Vec<f64>; 2] {
    let springs = SpringCells::under(sides, [0.0; 2], [7, 5], BED_PROPERTIES);
    let stiff_displacements = [
        static_displacement(stiff_model.clone(), springs.clone()),
        static_displacement(stiff_model.clone(), half_space(stiff_model)),
    ];
    let rigid_displacements = [
        static_displacement(rigid_body(), springs),
        static_displacement(rigid_body(), half_space(&rigid_body())),
    ];
    for (computed, expected) in stiff_displacements.iter().zip(&rigid_displacements) {
        let settlement = expected[2].abs();
        assert!(settlement > 1e-5, "{expected:?}");
        for node in stiff_model.base().nodes() {
            let stiff_rows = [&node.horizontal, &node.across, &node.vertical];
            let rigid_rows = rigid_body().displacement_at([node.x, node.y, 0.0]);
            for (stiff_row, rigid_row) in stiff_rows.into_iter().zip(rigid_rows) {
                let computed = stiff_row.value(computed);
                let expected = rigid_row.value(expected);
                assert!(
                    (computed - expected).abs() < 1e-6 * settlement,
                    "{computed} {expected} of {settlement}"
                );
            }
        }
    }
    rigid_displacements
}

/// A model on springs under pulses.
fn shaken_simulation(model: &FemModel, sides: [f64; 2], friction: f64, gravity: f64) -> Simulation {
    Simulation::builder(2e-3)
        .structure(model.clone())
        .ground(SpringCells::under(sides, [0.0; 2], [7, 5], BED_PROPERTIES))
        .interface(Coulomb::new(friction).unwrap())
        .motion(CrossingPulses { quarter_turns: 0 })
        .gravity(gravity)
        .build()
        .unwrap()
}

/// Checks a soft model under waves from three sides: cells open and slide, its `top` moves, and the energy balance closes.
///
/// Another simulation, which resumes halfway, has the same states to the last bit.
pub(super) fn assert_lifts_off_and_slides(
    model: &FemModel,
    top: [f64; 3],
    sides: [f64; 2],
    friction: f64,
    gravity: f64,
) {
    let top = model.mesh().node_at_point(top).unwrap();
    let drift = model.row(top, Direction::X).unwrap();
    let mut uninterrupted_simulation = shaken_simulation(model, sides, friction, gravity);
    let mut resumed_simulation = shaken_simulation(model, sides, friction, gravity);
    let mut max_open = 0;
    let mut max_sliding = 0;
    let mut max_drift = 0.0_f64;
    for half in 0..2 {
        let run = uninterrupted_simulation.run(300, |state| {
            let open_count = state.modes.iter().filter(|mode| **mode == Mode::Open).count();
            let sliding_count = state.modes.iter().filter(|mode| **mode == Mode::Slip).count();
            max_open = max_open.max(open_count);
            max_sliding = max_sliding.max(sliding_count);
            max_drift = max_drift.max(drift.value(state.displacement()).abs());
        });
        let run = run.unwrap();
        assert!(run.energy_error < 1e-9, "{:e}", run.energy_error);
        if half == 0 {
            resumed_simulation.resume(&uninterrupted_simulation.checkpoint().unwrap()).unwrap();
        }
    }
    assert!(
        max_open > 3 && max_sliding > 3 && max_drift > 1e-4,
        "{max_open} {max_sliding} {max_drift}"
    );
    resumed_simulation.run(300, |_| {}).unwrap();
    assert_eq!(resumed_simulation.state(), uninterrupted_simulation.state());
}

#[test]
fn a_stiff_block_is_the_rigid_body() {
    let stiff_block = block(1.0e14);
    assert_eq!(stiff_block.base().nodes().count(), 4 * 3 * 2);
    let sides = [BLOCK_SIDES[0], BLOCK_SIDES[1]];
    for displacement in assert_moves_rigidly(&stiff_block, rigid_block, sides) {
        let rotation = displacement[3].abs().min(displacement[4].abs());
        assert!(rotation > 1e-2 * displacement[2].abs(), "{displacement:?}");
    }
}

#[test]
fn a_soft_block_lifts_off_and_slides() {
    let sides = [BLOCK_SIDES[0], BLOCK_SIDES[1]];
    assert_lifts_off_and_slides(&block(4.0e8), [3.0, 2.0, 4.0], sides, 0.4, 2.0);
}
