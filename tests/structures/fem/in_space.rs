//! GOAL: meshes in three coordinates accept elements of space, and none of the plane; models of them stand on faces.
//! SCENE: a few nodes and elements, a tower on a mat, bricks.
//! REFERENCE: by hand.

use basemat::Error;
use basemat::fem::{
    Beam, Direction, Element, Layer, LumpedMass, MassKind, Material, Mesh, Quad4, QuadFormulation,
    Spring, Truss,
};
use basemat::results::DeformedShape;
use basemat::structure::{Base, BaseNode, DofCombination, FemModel, Structure};
use basemat_problems::dense::{form, largest, mass, multiply, stiffness};
use basemat_problems::stiff_element::StiffElement;
use basemat_problems::supported::CLAMPED_DIRECTIONS as DIRECTIONS;

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

fn text<T: std::fmt::Debug>(outcome: basemat::Result<T>) -> String {
    outcome.unwrap_err().to_string()
}

#[test]
fn a_mesh_takes_elements_of_its_kind_only() {
    let material = Material::new(1.0e9, 0.2, 2000.0).unwrap();
    let mut space = cube();
    let direction =
        "direction of the element: x, y, z, rotation_x, rotation_y or rotation_z in space";
    assert_eq!(text(space.add(Beam::new([0, 4], 1.0, 1.0, 1.0, 0.0).unwrap())), direction);
    let rotational_spring = Spring::new([0, 4], Direction::Rotation, 1.0).unwrap();
    assert_eq!(text(space.add(rotational_spring.clone())), direction);
    let plane = "element of the plane: must be in a mesh in the plane, but this one is in space";
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
    let Err(Error::Input { value, .. }) = mesh.add_node_at([0.0, 2.0, 0.5]) else {
        panic!()
    };
    assert_eq!(value, 0.5);
    mesh.add(Spring::new([0, 1], Direction::Rotation, 1.0).unwrap()).unwrap();
    for axis in [Direction::Z, Direction::RotationX, Direction::RotationY, Direction::RotationZ] {
        let result = text(mesh.add(Spring::new([0, 1], axis, 1.0).unwrap()));
        assert_eq!(result, "direction of the element: x, y or rotation in the plane");
    }
}

/// A mat of a shell on four nodes, 0.5 m thick, with a tower of four nodes over it.
fn tower() -> FemModel {
    let mut mesh = cube();
    mesh.add(StiffElement::shell(&[7, 6, 4, 5], 0.5, 1.0e12, 10.0)).unwrap();
    mesh.add(StiffElement::frame(&[7, 6, 4, 5, 3, 2, 0, 1], 1.0e12, 20.0)).unwrap();
    FemModel::on_base(mesh).unwrap()
}

/// Rigid motions meet no force, and their inertia is that of 30 kg at the base and 20 kg at the top of each corner.
fn assert_free(model: &FemModel) {
    let stiffness = stiffness(model);
    let mass = mass(model);
    let point = [0.3, -0.2, 1.5];
    for direction in DIRECTIONS {
        let motion = model.rigid_motion(direction, point);
        assert!(largest(&multiply(&stiffness, &motion)) < 1e-13 * 1e12, "{direction:?}");
        let mut expected = 0.0;
        for node in cube().nodes() {
            let x = node[0] - point[0];
            let y = node[1] - point[1];
            let z = node[2] - point[2];
            let square = match direction {
                Direction::RotationX => y * y + z * z,
                Direction::RotationY => z * z + x * x,
                Direction::RotationZ => x * x + y * y,
                _ => 1.0,
            };
            let mass = if z < 0.0 { 30.0 } else { 20.0 };
            expected += mass * square;
        }
        let computed = form(&motion, &mass, &motion);
        assert!((computed / expected - 1.0).abs() < 1e-12, "{direction:?} {computed} {expected}");
    }
    assert_eq!(model.rigid_motion(Direction::Rotation, point), vec![0.0; model.dofs()]);
}

#[test]
fn rigid_motions_in_space_meet_no_force() {
    let model = tower();
    assert_eq!(model.dofs(), 48);
    assert_free(&model);
    // A link and a diaphragm restrain no rigid motion either.
    let linked = tower().with_rigid_link(7, &[6, 4]).unwrap();
    assert_eq!(linked.dofs(), 36);
    assert_free(&linked);
    let floor = linked.with_rigid_diaphragm(3, &[2, 0, 1]).unwrap();
    assert_eq!(floor.dofs(), 27);
    assert_free(&floor);
    // The elements get the motion of all their nodes, followers included.
    let motion = floor.rigid_motion(Direction::RotationY, [0.0; 3]);
    for element in floor.mesh().elements() {
        let expected = element.nodes().iter().flat_map(|&node| {
            let place = floor.mesh().nodes()[node];
            [place[2], 0.0, -place[0], 0.0, 1.0, 0.0]
        });
        let computed = floor.element_displacements(element, &motion).unwrap();
        assert_eq!(computed.len(), element.order());
        for (computed, expected) in computed.into_iter().zip(expected) {
            assert!((computed - expected).abs() < 1e-14, "{computed} {expected}");
        }
        assert!(matches!(
            floor.element_displacements(element, &motion[1..]),
            Err(Error::Size { found: 26, needed: 27, .. })
        ));
    }
}

/// The terms of a row in the order of their degrees of freedom.
fn sorted(row: &DofCombination) -> Vec<(usize, f64)> {
    let mut row = row.to_vec();
    row.sort_by_key(|term| term.0);
    row
}

/// The ground meets a shell's underside: u + r × (0, 0, −0.25).
#[test]
fn a_mat_stands_on_its_underside() {
    let model = tower();
    let Base::Faces(faces) = model.base() else {
        panic!("a base in space has faces")
    };
    assert_eq!(faces.len(), 1);
    let places: Vec<_> = faces[0].iter().map(|node| [node.x, node.y, node.z]).collect();
    assert_eq!(places, [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]]);
    for (corner, node) in faces[0].iter().zip([7, 6, 4, 5]) {
        let dof = |direction| model.dof(node, direction).unwrap();
        assert_eq!(
            corner.horizontal[..],
            [(dof(Direction::X), 1.0), (dof(Direction::RotationY), -0.25)]
        );
        assert_eq!(
            corner.across[..],
            [(dof(Direction::Y), 1.0), (dof(Direction::RotationX), 0.25)]
        );
        assert_eq!(corner.vertical[..], [(dof(Direction::Z), 1.0)]);
    }
    // The linked corner moves with its leader, 2 m to the left and as much in front, and stands as deep.
    let linked = tower().with_rigid_link(7, &[6, 4]).unwrap();
    let Base::Faces(faces) = linked.base() else {
        panic!("a base in space has faces")
    };
    let [x, y, z, about_x, about_y, about_z] =
        [0, 1, 2, 3, 4, 5].map(|k| linked.dof(7, DIRECTIONS[k]).unwrap());
    let corner = &faces[0][2];
    assert_eq!(sorted(&corner.horizontal), [(x, 1.0), (about_y, -0.25), (about_z, -2.0)]);
    assert_eq!(sorted(&corner.across), [(y, 1.0), (about_x, 0.25), (about_z, 2.0)]);
    assert_eq!(sorted(&corner.vertical), [(z, 1.0), (about_x, 2.0), (about_y, -2.0)]);
    // Faces of bare nodes: the same outline from the shell's corners in another order is the shell, three corners
    // are not.
    let mesh = tower().mesh().clone();
    let reordered_face = FemModel::on_faces(mesh.clone(), &[vec![4, 5, 7, 6]]).unwrap();
    assert_eq!(reordered_face.base().nodes().next().unwrap().horizontal.len(), 2);
    let triangular_face = FemModel::on_faces(mesh, &[vec![7, 6, 4]]).unwrap();
    assert!(triangular_face.base().nodes().all(|node| node.horizontal.len() == 1));
}

#[test]
fn a_diaphragm_ties_its_plane_only() {
    let model = tower().with_rigid_diaphragm(3, &[2, 0, 1]).unwrap();
    let x = model.dof(3, Direction::X).unwrap();
    let y = model.dof(3, Direction::Y).unwrap();
    let about_z = model.dof(3, Direction::RotationZ).unwrap();
    // Node 0 lies 2 m to the right of the leader and 2 m behind it.
    assert_eq!(model.row(0, Direction::X).unwrap()[..], [(x, 1.0), (about_z, -2.0)]);
    assert_eq!(model.row(0, Direction::Y).unwrap()[..], [(y, 1.0), (about_z, 2.0)]);
    assert_eq!(model.row(0, Direction::RotationZ).unwrap()[..], [(about_z, 1.0)]);
    for tied_direction in [Direction::X, Direction::Y, Direction::RotationZ] {
        assert_eq!(model.dof(0, tied_direction), None);
    }
    for free in [Direction::Z, Direction::RotationX, Direction::RotationY] {
        let dof = model.dof(0, free).unwrap();
        assert_eq!(model.row(0, free).unwrap()[..], [(dof, 1.0)]);
    }
    assert_eq!(
        text(tower().with_rigid_diaphragm(3, &[2, 7])),
        "rigid link: the nodes of a diaphragm or a tie must lie at one height"
    );
    let plane = Mesh::layered_block(0.0..1.0, 1, &[Layer::new(1.0, 1, solid())]).unwrap();
    let plane = FemModel::on_base(plane).unwrap();
    assert_eq!(
        text(plane.with_rigid_diaphragm(0, &[1])),
        "rigid diaphragm: must be in a mesh in space, but this one is in the plane"
    );
    // A node of bricks cannot lead a rigid link.
    let mut mesh = cube();
    mesh.add(StiffElement::brick([7, 6, 4, 5, 3, 2, 0, 1], 1.0, 1.0)).unwrap();
    let brick = FemModel::on_base(mesh).unwrap();
    assert!(text(brick.clone().with_rigid_diaphragm(3, &[2])).contains("rotation about z"));
    assert!(text(brick.with_rigid_link(3, &[2])).contains("all degrees of freedom of a node"));
}

fn solid() -> Material {
    Material::new(1.0e9, 0.2, 2000.0).unwrap()
}

/// A brick on the lattice of `brick_mesh` whose first node is this one.
fn brick_on(first: usize) -> StiffElement {
    let lower = [first, first + 1, first + 4, first + 3];
    let nodes: Vec<usize> = lower.into_iter().chain(lower.map(|node| node + 6)).collect();
    StiffElement::brick(nodes.try_into().unwrap(), 1.0e6, 1.0)
}

/// Two by one bricks, with a second storey on the left one.
fn brick_mesh() -> Mesh {
    let mut mesh = Mesh::in_space();
    for z in [-1.0, 0.0, 1.0] {
        for y in [0.0, 1.0] {
            for x in [0.0, 1.0, 2.0] {
                mesh.add_node_at([x, y, z]).unwrap();
            }
        }
    }
    for first in [6, 1, 0] {
        mesh.add(brick_on(first)).unwrap();
    }
    mesh
}

/// Places of the nodes of a face.
fn places(face: &[BaseNode]) -> Vec<[f64; 2]> {
    face.iter().map(|node| [node.x, node.y]).collect()
}

/// Number of points that move by this.
fn count_moved(shape: &DeformedShape, motion: &[f64], by: [f64; 3]) -> usize {
    shape.displacements(motion).unwrap().iter().filter(|u| **u == by).count()
}

fn model_on_faces(mesh: &Mesh, faces: &[&[usize]]) -> basemat::Result<FemModel> {
    let faces: Vec<_> = faces.iter().map(|face| face.to_vec()).collect();
    FemModel::on_faces(mesh.clone(), &faces)
}

#[test]
fn bricks_stand_on_their_lower_sides() {
    let mut mesh = brick_mesh();
    let error = mesh.add(brick_on(1)).unwrap_err().to_string();
    assert!(error.contains("it duplicates element 1, and would count twice"), "{error}");
    let model = FemModel::on_base(mesh).unwrap();
    let Base::Faces(faces) = model.base() else {
        panic!("a base in space has faces")
    };
    assert_eq!(places(&faces[0]), [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]]);
    assert_eq!(places(&faces[1]), [[1.0, 0.0], [1.0, 1.0], [2.0, 1.0], [2.0, 0.0]]);
    assert!(model.base().nodes().all(|node| node.z == 0.0 && node.vertical.len() == 1));
    // Of eighteen sides two pairs are inner and not drawn.
    let shape = DeformedShape::of_model(&model);
    assert_eq!((shape.points().len(), shape.cells().len()), (18, 14));
    assert_eq!((shape.points()[4].position, shape.points()[4].away), ([1.0, 0.0], 1.0));
    let rise = model.rigid_motion(Direction::Z, [0.0; 3]);
    // Two nodes belong to no element.
    assert_eq!(count_moved(&shape, &rise, [0.0, 1.0, 0.0]), 16);
    let shift = model.rigid_motion(Direction::Y, [0.0; 3]);
    assert_eq!(count_moved(&shape, &shift, [0.0, 0.0, 1.0]), 16);
    let free = model.describe(&[0, 1, 2, 5]).unwrap();
    assert_eq!(free, "node 0 at (0, 0, -1), node 1 at (1, 0, -1) in Z");
}

#[test]
fn faces_on_which_nothing_stands_are_errors() {
    let mesh = brick_mesh();
    assert!(matches!(model_on_faces(&mesh, &[]), Err(Error::Size { .. })));
    assert!(matches!(model_on_faces(&mesh, &[&[0, 1]]), Err(Error::Size { .. })));
    let error_of_a_missing_node = model_on_faces(&mesh, &[&[0, 1, 18]]);
    assert!(matches!(error_of_a_missing_node, Err(Error::Index { index: 18, bound: 18, .. })));
    let error_of_inclined_faces = model_on_faces(&mesh, &[&[0, 1, 3], &[1, 2, 10]]);
    let Err(Error::Input { value, .. }) = error_of_inclined_faces else { panic!() };
    assert_eq!(value, 0.0);
    // Node 14 is no brick's.
    let error_of_a_free_node = text(model_on_faces(&mesh, &[&[12, 13, 14]]));
    assert!(error_of_a_free_node.starts_with("contact node: must have three displacements"));
    assert_eq!(
        text(FemModel::new(mesh, &[0, 1])),
        "line of contact nodes: must be in a mesh in the plane, but this one is in space"
    );
    let needed = "base of a mesh in space: must have shells or sides of solids at the lowest height of the mesh, which stand \
on the ground: add them there, or name the faces that do";
    let mut cube_without_shells = cube();
    cube_without_shells.add(StiffElement::solid(&[0, 1, 2, 4], 1.0, 1.0)).unwrap();
    assert_eq!(text(FemModel::on_base(cube_without_shells)), needed);
    let plane = Mesh::layered_block(0.0..1.0, 1, &[Layer::new(1.0, 1, solid())]).unwrap();
    assert_eq!(
        text(FemModel::on_faces(plane, &[vec![0, 1, 2]])),
        "faces of a base: must be in a mesh in space, but this one is in the plane"
    );
}

/// A column that shortens only, with half of its mass at each end.
struct ShorteningColumn {
    nodes: [usize; 2],
    compression: f64,
}

const AXIAL_STIFFNESS: f64 = 1.0e9;
const HALF_MASS: f64 = 5.0e3;

impl Element for ShorteningColumn {
    fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    fn directions(&self) -> &[Direction] {
        &DIRECTIONS[..3]
    }

    fn stiffness(&self, _: &[[f64; 3]], matrix: &mut [f64]) {
        for (i, j, sign) in [(2, 2, 1.0), (5, 5, 1.0), (2, 5, -1.0), (5, 2, -1.0)] {
            matrix[6 * i + j] += sign * AXIAL_STIFFNESS;
        }
    }

    fn geometric_stiffness(&self, p: &[[f64; 3]], matrix: &mut [f64]) {
        let sway = self.compression / (p[1][2] - p[0][2]);
        for axis in [0, 1] {
            for (i, j, sign) in [(0, 0, -1.0), (3, 3, -1.0), (0, 3, 1.0), (3, 0, 1.0)] {
                matrix[6 * (i + axis) + j + axis] += sign * sway;
            }
        }
    }

    fn in_static_state(&self, _: &[[f64; 3]], u: &[f64], _: f64) -> Option<Box<dyn Element>> {
        let compression = AXIAL_STIFFNESS * (u[2] - u[5]);
        Some(Box::new(Self { nodes: self.nodes, compression }))
    }

    fn compression(&self) -> Option<f64> {
        Some(self.compression)
    }

    fn mass(&self, _: &[[f64; 3]], _: MassKind, matrix: &mut [f64]) {
        for i in 0..6 {
            matrix[7 * i] += HALF_MASS;
        }
    }
}

/// Weight acts along −z: the column carries g · 5 t, and sways when this exceeds k L of the weaker spring.
#[test]
fn weight_in_space_acts_down() {
    let mut mesh = tower().mesh().clone();
    let top = mesh.add_node_at([0.0, 0.0, 3.0]).unwrap();
    mesh.add(ShorteningColumn { nodes: [7, top], compression: 0.0 }).unwrap();
    mesh.add(Spring::new([3, top], Direction::X, 6.0e5).unwrap()).unwrap();
    mesh.add(Spring::new([3, top], Direction::Y, 1.2e5).unwrap()).unwrap();
    let model = FemModel::on_base(mesh).unwrap().with_p_delta(9.81).unwrap();
    let column = model.mesh().elements().nth(2).unwrap();
    let weight = HALF_MASS * 9.81;
    assert!((column.compression().unwrap() / weight - 1.0).abs() < 1e-6);
    let factor = model.buckling_factor().unwrap();
    assert!((factor / (1.2e5 * 2.0 / weight) - 1.0).abs() < 1e-6, "{factor}");
}
