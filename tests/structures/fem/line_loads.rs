//! GOAL: rows of loads along a line do the work of the traction on the edges.
//! SCENE: a block of four- or eight-node elements, its left side and its roof.
//! REFERENCE: integrals of linear and quadratic displacements by hand.

use basemat::bem::SpringGround;
use basemat::coupled::Load;
use basemat::fem::{Direction, Layer, Material, Mesh, Quad8, Quad8Integration};
use basemat::interface::Coulomb;
use basemat::structure::{FemModel, Structure};
use basemat::{Error, Simulation};

fn material() -> Material {
    Material::new(1.0e9, 0.2, 2000.0).unwrap()
}

/// One element of 2 m × 3 m.
fn block_of_eight_nodes() -> FemModel {
    let mut mesh = Mesh::new();
    let places = [
        [0.0, 0.0],
        [2.0, 0.0],
        [2.0, 3.0],
        [0.0, 3.0],
        [1.0, 0.0],
        [2.0, 1.5],
        [1.0, 3.0],
        [0.0, 1.5],
    ];
    let nodes = places.map(|[x, y]| mesh.add_node(x, y).unwrap());
    mesh.add(Quad8::new(nodes, material()).with_integration(Quad8Integration::Full))
        .unwrap();
    FemModel::on_base(mesh).unwrap()
}

#[test]
fn pressure_does_the_work_of_quadratic_displacements() {
    let model = block_of_eight_nodes();
    // Down the left side, u_x = y²: ∫ y² dy = 9.
    let side = [3, 7, 0];
    let row = model.pressure_row(&side).unwrap();
    let mut displacement = vec![0.0; model.dofs()];
    for (node, [_, y, _]) in model.mesh().nodes().iter().enumerate() {
        displacement[model.dof(node, Direction::X).unwrap()] = y * y;
    }
    assert!((row.value(&displacement) - 9.0).abs() < 1e-12);
    // In the other order of nodes the pressure is suction; without the middle node the load acts on the ends alone.
    let suction_row = model.pressure_row(&[0, 7, 3]).unwrap();
    assert!((suction_row.value(&displacement) + 9.0).abs() < 1e-12);
    let ends = model.pressure_row(&[3, 0]).unwrap();
    assert!((ends.value(&displacement) - 13.5).abs() < 1e-12);
    // A resultant of 1 N upwards along the roof turns nothing about its middle.
    let up = model.resultant_row(&[2, 6, 3], Direction::Y).unwrap();
    let turn = model.rigid_motion(Direction::Rotation, [1.0, 0.0, 0.0]);
    let rise = model.rigid_motion(Direction::Y, [0.0; 3]);
    assert!((up.value(&rise) - 1.0).abs() < 1e-14 && up.value(&turn).abs() < 1e-14);
}

/// Wind on a wall: the soil carries force and moment.
#[test]
fn wind_on_a_wall_meets_the_ground() {
    let mesh = Mesh::layered_block(-2.0..2.0, 4, &[Layer::new(6.0, 4, material())]).unwrap();
    let wall = FemModel::on_base(mesh).unwrap();
    let side: Vec<usize> =
        [6.0, 4.5, 3.0, 1.5, 0.0].map(|y| wall.mesh().node_at(-2.0, y).unwrap()).to_vec();
    let row = wall.pressure_row(&side).unwrap();
    let simulation = Simulation::builder(0.01)
        .structure(wall)
        .ground(SpringGround::new(-2.0..2.0, 8, 5.0e7, 5.0e7).unwrap())
        .interface(Coulomb::new(0.6).unwrap())
        .load(Load::constant(row, 2.0e3))
        .build()
        .unwrap();
    let state = simulation.state();
    assert!((state.base_shear - 12.0e3).abs() < 1e-3, "{}", state.base_shear);
    assert!((state.base_moment + 36.0e3).abs() < 1e-2, "{}", state.base_moment);
}

#[test]
fn lines_that_are_none_are_errors() {
    let model = block_of_eight_nodes();
    assert!(matches!(model.pressure_row(&[0]), Err(Error::Size { found: 1, .. })));
    assert!(matches!(model.pressure_row(&[0, 99]), Err(Error::Index { index: 99, .. })));
    assert!(matches!(model.pressure_row(&[0, 0]), Err(Error::Input { .. })));
    assert!(matches!(model.resultant_row(&[0, 1], Direction::Rotation), Err(Error::Scene { .. })));
}
