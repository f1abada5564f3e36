//! Blocks of finite elements in space: stiff ones against the rigid body, soft ones that lift off and slide.

use basemat::bem::{ElasticGround, Ground};
use basemat::fem::{Direction, Mesh};
use basemat::interface::{Bonded, Coulomb, Mode};
use basemat::structure::{FemModel, RigidBody, Structure};
use basemat::{Simulation, Soil};
use basemat_problems::stiff_element::StiffElement;

use super::cells::{BED, Cells, Waves};

/// Sides, m, and bricks along x, y and z.
const SIDES: [f64; 3] = [6.0, 4.0, 4.0];
const COUNTS: [usize; 3] = [3, 2, 2];

/// Mass of a brick, kg: the block is heavier on the right and in front.
fn brick_mass([i, j, _]: [usize; 3]) -> f64 {
    2.0e4 * (1.0 + i as f64 - 0.5 * j as f64)
}

fn bricks() -> impl Iterator<Item = [usize; 3]> {
    let [nx, ny, nz] = COUNTS;
    (0..nx * ny * nz).map(move |k| [k % nx, k / nx % ny, k / nx / ny])
}

/// Bricks of this stiffness (N/m) on their lower sides, about the origin.
fn block(stiffness: f64) -> FemModel {
    let mut mesh = Mesh::in_space();
    let [nx, ny, nz] = COUNTS;
    for k in 0..(nx + 1) * (ny + 1) * (nz + 1) {
        let cell = [k % (nx + 1), k / (nx + 1) % (ny + 1), k / (nx + 1) / (ny + 1)];
        let [x, y, z] = [0, 1, 2].map(|a| SIDES[a] * cell[a] as f64 / COUNTS[a] as f64);
        mesh.add_node_at([x - 0.5 * SIDES[0], y - 0.5 * SIDES[1], z]).unwrap();
    }
    for brick in bricks() {
        let node = |[a, b, c]: [usize; 3]| {
            let [i, j, k] = [brick[0] + a, brick[1] + b, brick[2] + c];
            i + (nx + 1) * (j + (ny + 1) * k)
        };
        let corner = |c: usize| [[0, 0, c], [1, 0, c], [1, 1, c], [0, 1, c]].map(node);
        let ([a, b, c, d], [e, f, g, h]) = (corner(0), corner(1));
        let nodes = [a, b, c, d, e, f, g, h];
        mesh.add(StiffElement::brick(nodes, stiffness, brick_mass(brick) / 8.0)).unwrap();
    }
    FemModel::on_base(mesh).unwrap()
}

/// The same mass on the same base, which is rigid.
fn rigid() -> RigidBody {
    let mass: f64 = bricks().map(brick_mass).sum();
    let center = [0, 1, 2].map(|axis| {
        let moment = |brick: [usize; 3]| {
            let place = SIDES[axis] * (brick[axis] as f64 + 0.5) / COUNTS[axis] as f64;
            brick_mass(brick) * if axis < 2 { place - 0.5 * SIDES[axis] } else { place }
        };
        bricks().map(moment).sum::<f64>() / mass
    });
    let inertia = [[mass, 0.0, 0.0], [0.0, mass, 0.0], [0.0, 0.0, mass]];
    let [x, y] = [0.5 * SIDES[0], 0.5 * SIDES[1]];
    RigidBody::from_mass(vec![[-x, -y], [x, -y], [x, y], [-x, y]], mass, inertia, center).unwrap()
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

/// Compares the base of a stiff model at rest with a rigid body, on springs and on a half-space, which couples the
/// cells. Returns the displacement of the body on each.
pub(super) fn assert_moves_rigidly(
    stiff: &FemModel,
    rigid: impl Fn() -> RigidBody,
    sides: [f64; 2],
) -> [Vec<f64>; 2] {
    let bed = || Cells::under(sides, [0.0; 2], [7, 5], BED);
    let soil = Soil::from_shear_wave_speed(200.0, 0.33, 1900.0).unwrap();
    // Cells extend equally far beyond both bases.
    let half_space = |own: &dyn Structure| ElasticGround::under(soil, own, 8).unwrap();
    let cases = [
        (at_rest(stiff.clone(), bed()), at_rest(rigid(), bed())),
        (at_rest(stiff.clone(), half_space(stiff)), at_rest(rigid(), half_space(&rigid()))),
    ];
    for (found, exact) in &cases {
        let size = exact[2].abs();
        assert!(size > 1e-5, "{exact:?}");
        let base = stiff.base();
        for node in base.nodes() {
            let own = [&node.horizontal, &node.across, &node.vertical].map(|row| row.value(found));
            let rows = rigid().displacement_at([node.x, node.y, 0.0]);
            for (own, row) in own.into_iter().zip(rows) {
                let exact = row.value(exact);
                assert!((own - exact).abs() < 1e-6 * size, "{own} {exact} of {size}");
            }
        }
    }
    cases.map(|(_, exact)| exact)
}

/// Waves from three sides: cells open and slide under a soft model, its `top` sways, and no energy is lost.
///
/// Another simulation resumes halfway, to the last bit.
pub(super) fn assert_lifts_off_and_slides(
    model: &FemModel,
    top: [f64; 3],
    sides: [f64; 2],
    friction: f64,
    gravity: f64,
) {
    let top = model.mesh().node_at_point(top).unwrap();
    let drift = model.row(top, Direction::X).unwrap();
    let simulation = || {
        Simulation::builder(2e-3)
            .structure(model.clone())
            .ground(Cells::under(sides, [0.0; 2], [7, 5], BED))
            .interface(Coulomb::new(friction).unwrap())
            .motion(Waves { quarters: 0 })
            .gravity(gravity)
            .build()
            .unwrap()
    };
    let [mut whole, mut resumed] = [simulation(), simulation()];
    let (mut open, mut sliding, mut sway) = (0, 0, 0.0_f64);
    for half in 0..2 {
        let run = whole.run(300, |state| {
            open = open.max(state.modes.iter().filter(|mode| **mode == Mode::Open).count());
            sliding = sliding.max(state.modes.iter().filter(|mode| **mode == Mode::Slip).count());
            sway = sway.max(drift.value(state.displacement()).abs());
        });
        let run = run.unwrap();
        assert!(run.energy_error < 1e-9, "{:e}", run.energy_error);
        if half == 0 {
            resumed.resume(&whole.checkpoint().unwrap()).unwrap();
        }
    }
    assert!(open > 3 && sliding > 3 && sway > 1e-4, "{open} {sliding} {sway}");
    resumed.run(300, |_| {}).unwrap();
    assert_eq!(resumed.state(), whole.state());
}

#[test]
fn a_stiff_block_is_the_rigid_body() {
    let stiff = block(1.0e14);
    assert_eq!(stiff.base().nodes().count(), 4 * 3 * 2);
    for exact in assert_moves_rigidly(&stiff, rigid, [SIDES[0], SIDES[1]]) {
        let [_, _, settlement, about_x, about_y, _] = exact[..] else { panic!("{exact:?}") };
        assert!(about_x.abs().min(about_y.abs()) > 1e-2 * settlement.abs(), "{exact:?}");
    }
}

#[test]
fn a_soft_block_lifts_off_and_slides() {
    let sides = [SIDES[0], SIDES[1]];
    assert_lifts_off_and_slides(&block(4.0e8), [3.0, 2.0, 4.0], sides, 0.4, 2.0);
}
