//! GOAL: meshes in three coordinates take what belongs there, and nothing of the plane.
//! SCENE: a few nodes and elements.
//! REFERENCE: by hand.

use basemat::Error;
use basemat::fem::{
    Beam, Direction, LumpedMass, Material, Mesh, Quad4, QuadFormulation, Spring, Truss,
};

/// The corners of a cube of 2 m, from the upper ones down.
fn cube() -> Mesh {
    let mut mesh = Mesh::in_space();
    for z in [3.0, 1.0] {
        for y in [2.0, 0.0] {
            for x in [2.0, 0.0] {
                mesh.add_node_at([x, y, z]).unwrap();
            }
        }
    }
    mesh
}

#[test]
fn nodes_in_space_are_found() {
    let mesh = cube();
    // From left to right, and from front to back.
    assert_eq!(mesh.nodes_at_height(1.0, 1e-9), Ok(vec![7, 5, 6, 4]));
    assert_eq!(mesh.nodes_at_height(2.0, 1e-9), Ok(vec![]));
    assert_eq!(mesh.node_at_point([2.0, 0.0, 1.0 + 1e-9]), Ok(6));
    assert_eq!(mesh.nearest_node_to([0.4, 1.9, 9.0]), Some(1));
    let error = mesh.node_at_point([2.0, 0.0, 0.0]).unwrap_err().to_string();
    assert_eq!(error, "no node at (2, 0, 0): the nearest, at (2, 0, 1), is 1 m away");
    let mut mesh = Mesh::in_space();
    // Two coordinates mean the height 0.
    assert_eq!(mesh.add_node(1.0, 2.0), Ok(0));
    assert_eq!(mesh.nodes(), [[1.0, 2.0, 0.0]]);
    for place in 0..3 {
        let mut point = [0.0; 3];
        point[place] = f64::NAN;
        assert!(matches!(mesh.add_node_at(point), Err(Error::Input { .. })));
        assert!(matches!(mesh.node_at_point(point), Err(Error::Input { .. })));
    }
}

#[test]
fn a_mesh_takes_elements_of_its_kind_only() {
    let material = Material::new(1.0e9, 0.2, 2000.0).unwrap();
    let text = |outcome: basemat::Result<usize>| outcome.unwrap_err().to_string();
    let mut space = cube();
    let direction =
        "direction of the element: x, y, z, rotation_x, rotation_y or rotation_z in space";
    assert_eq!(text(space.add(Beam::new([0, 4], 1.0, 1.0, 1.0, 0.0).unwrap())), direction);
    let turned = Spring::new([0, 4], Direction::Rotation, 1.0).unwrap();
    assert_eq!(text(space.add(turned.clone())), direction);
    let plane = "element of the plane: a mesh in the plane";
    assert_eq!(text(space.add(Truss::new([0, 4], 1.0, 1.0, 0.0).unwrap())), plane);
    assert_eq!(text(space.add(Spring::axial([0, 4], 1.0).unwrap())), plane);
    assert_eq!(text(space.add(LumpedMass::new(0, 1.0).unwrap())), plane);
    let quad = Quad4::new([7, 6, 4, 5], material, QuadFormulation::default());
    assert_eq!(text(space.add(quad)), plane);
    assert_eq!(space.elements().len(), 0);
    for direction in [Direction::X, Direction::Y, Direction::Z, Direction::RotationY] {
        space.add(Spring::new([0, 4], direction, 1.0).unwrap()).unwrap();
    }

    let mut mesh = Mesh::new();
    mesh.add_node(0.0, 0.0).unwrap();
    mesh.add_node_at([0.0, 1.0, 0.0]).unwrap();
    let Err(Error::Input { value, .. }) = mesh.add_node_at([0.0, 2.0, 0.5]) else { panic!() };
    assert_eq!(value, 0.5);
    mesh.add(Spring::new([0, 1], Direction::Rotation, 1.0).unwrap()).unwrap();
    for own in [Direction::Z, Direction::RotationX, Direction::RotationY, Direction::RotationZ] {
        let refused = text(mesh.add(Spring::new([0, 1], own, 1.0).unwrap()));
        assert_eq!(refused, "direction of the element: x, y or rotation in the plane");
    }
}
