//! GOAL: layered blocks, their contact line, and the look-up of nodes.
//! SCENE: blocks of one to three layers, uniform and graded; bars and masses; a surface of revolution.
//! REFERENCE: coordinates and numbers written down here.

use basemat::Error;
use basemat::fem::{
    Direction, Layer, LumpedMass, Material, Mesh, Quad4, QuadFormulation, Shell, Truss,
};
use basemat::structure::{DofCombination, FemModel, Structure};

fn soft() -> Material {
    Material::new(1.0e7, 0.2, 1500.0).unwrap()
}

#[test]
fn layered_block_runs_from_the_base_upwards() {
    let concrete = Material::new(30.0e9, 0.2, 2400.0).unwrap();
    let layers = [
        Layer::new(1.0, 1, concrete),
        Layer { formulation: QuadFormulation::OnePoint, ..Layer::new(4.0, 2, soft()) },
        Layer::new(2.0, 1, concrete),
    ];
    let mesh = Mesh::layered_block(-3.0..3.0, 3, &layers).unwrap();
    assert_eq!(mesh.elements().len(), 12);
    let heights: Vec<f64> = mesh.nodes().iter().step_by(4).map(|node| node[1]).collect();
    assert_eq!(heights, [0.0, 1.0, 3.0, 5.0, 7.0]);
    let line: Vec<f64> = mesh.nodes()[..4].iter().map(|node| node[0]).collect();
    assert_eq!(line, [-3.0, -1.0, 1.0, 3.0]);
    assert_eq!(mesh.elements().nth(3).unwrap().nodes(), [4, 5, 9, 8]);
    assert_eq!(mesh.nodes_at_height(3.0, 1e-9).unwrap(), [8, 9, 10, 11]);
    assert_eq!(mesh.nearest_node(1.4, 4.8), Some(14));
    assert_eq!(Mesh::new().nearest_node(0.0, 0.0), None);
    assert_eq!(mesh.elements().len(), 12);
    // A clone is independent.
    let mut larger_mesh = mesh.clone();
    let low = larger_mesh.add_node(5.0, 0.0).unwrap();
    let high = larger_mesh.add_node(5.0, 1.0).unwrap();
    larger_mesh
        .add(Quad4::new([3, low, high, 7], concrete, QuadFormulation::OnePoint))
        .unwrap();
    assert_eq!((mesh.elements().len(), larger_mesh.elements().len()), (12, 13));
    let last_element = larger_mesh.elements().last().unwrap();
    assert_eq!(last_element.nodes(), [3, 20, 21, 7]);
    assert_eq!((mesh.nodes().len(), larger_mesh.nodes().len()), (20, 22));
    let model = FemModel::on_base(mesh).unwrap();
    assert_eq!(model.clone().dofs(), model.dofs());
}

/// A point without a node is an error, however near the next one, so that no wrong node is taken.
#[test]
fn a_node_is_where_it_is_looked_for_or_nowhere() {
    let mesh = Mesh::layered_block(-2.0..2.0, 3, &[Layer::new(20.0, 10, soft())]).unwrap();
    let model = FemModel::on_base(mesh).unwrap();
    // Coordinates with rounding: −2 + 4/3 and 7 · 2.
    assert_eq!(model.mesh().node_at(-0.666_666_67, 14.0), Ok(7 * 4 + 1));
    for (x, y, nearest) in
        [(0.0, 200.0, [-2.0 / 3.0, 20.0]), (2.0, 13.9, [2.0, 14.0]), (2.001, 14.0, [2.0, 14.0])]
    {
        let Err(Error::NoNode { nearest: found, distance, .. }) = model.mesh().node_at(x, y) else {
            panic!("({x}, {y})")
        };
        assert!((found[0] - nearest[0]).hypot(found[1] - nearest[1]) < 1e-12);
        assert!((distance - (x - nearest[0]).hypot(y - nearest[1])).abs() < 1e-12);
    }
    let error = model.mesh().node_at(2.0, 200.0).unwrap_err().to_string();
    assert_eq!(error, "no node at (2, 200): the nearest, at (2, 20), is 180 m away");
    for invalid_value in [f64::NAN, f64::INFINITY] {
        assert!(matches!(model.mesh().node_at(invalid_value, 0.0), Err(Error::Input { .. })));
        assert!(matches!(model.mesh().node_at(0.0, invalid_value), Err(Error::Input { .. })));
    }
    assert!(matches!(Mesh::new().node_at(0.0, 0.0), Err(Error::Size { .. })));
    // A mesh of one node has no size: only the exact place finds it.
    let mut point = Mesh::new();
    point.add_node(1.0, 2.0).unwrap();
    assert_eq!(point.node_at(1.0, 2.0), Ok(0));
    assert!(point.node_at(1.0, 2.0 + 1e-12).is_err());
}

#[test]
fn rows_that_no_node_has_are_errors() {
    let mesh = Mesh::layered_block(-2.0..2.0, 2, &[Layer::new(2.0, 1, soft())]).unwrap();
    let model = FemModel::on_base(mesh).unwrap();
    assert_eq!(model.row(5, Direction::Y), Ok(DofCombination::from(11)));
    let expected = Error::part(
        "node 5",
        "it has no degree of freedom in direction rotation: no element needs one there",
    );
    assert_eq!(model.row(5, Direction::Rotation), Err(expected));
    let expected = Error::Index { quantity: "node", index: 6, bound: 6 };
    assert_eq!(model.row(6, Direction::X), Err(expected));
}

#[test]
fn graded_grid_becomes_the_contact_line() {
    let grid = [-1.0, -0.8, 0.0, 0.8, 1.0];
    let model =
        FemModel::on_base(Mesh::graded_block(&grid, &[Layer::new(1.0, 1, soft())]).unwrap());
    let places: Vec<f64> = model.unwrap().base().nodes().map(|node| node.x).collect();
    assert_eq!(places, grid);
}

#[test]
fn only_used_directions_are_numbered() {
    let mut mesh = Mesh::new();
    for k in 0..4 {
        mesh.add_node(f64::from(k), 0.0).unwrap();
    }
    mesh.add(Truss::new([0, 1], 1.0, 1.0, 0.0).unwrap()).unwrap();
    mesh.add(LumpedMass::new(3, 2.0).unwrap().with_rotary_inertia(1.0).unwrap()).unwrap();
    // node 2 has no element, node 3 a rotation
    assert_eq!(FemModel::new(mesh, &[0, 1]).unwrap().dofs(), 7);
}

fn ring_thickness(row: usize) -> f64 {
    if row < 2 { 0.5 } else { 0.2 }
}

/// The triangles at the pole of a surface of revolution are matched to the ring of quadrilaterals.
#[test]
fn shells_of_a_grid_are_matched() {
    let concrete = Material::new(30.0e9, 0.2, 2500.0).unwrap();
    let mut mesh = Mesh::in_space();
    let meridian = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0]];
    let grid = mesh.revolve([0.0; 2], &meridian, 6).unwrap();
    let shells = grid.shells(concrete, ring_thickness).unwrap();
    let mut by_hand: Vec<Shell> = grid
        .cells()
        .map(|(row, cell)| Shell::new(cell, concrete, ring_thickness(row)).unwrap())
        .collect();
    assert!(shells.len() == 18 && shells[..6].iter().zip(&by_hand).all(|(a, b)| a != b));
    Shell::match_sides(&mut by_hand);
    assert_eq!(shells, by_hand);
    assert!(grid.shells(concrete, |_| 0.0).is_err());
}
