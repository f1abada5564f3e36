//! GOAL: elements, meshes and structures return typed errors that name bad input.
//! SCENE: bad numbers, nodes, shapes, grids and contact lines.
//! REFERENCE: the fields of the error.

use basemat::Error;
use basemat::fem::{
    Beam, Dashpot, Direction, Element, Layer, LumpedMass, MassKind, Material, Mesh, Quad4, Quad8,
    QuadFormulation, Spring, Truss,
};
use basemat::structure::{FemModel, RayleighDamping, RigidBlock, ShearBuilding, Storey};
use std::fmt::Debug;

const INVALID_NUMBERS: [f64; 4] = [0.0, -1.0, f64::NAN, f64::INFINITY];
const NEGATIVE_OR_NAN: [f64; 3] = [-1.0, f64::NAN, f64::NEG_INFINITY];
const NOT_FINITE: [f64; 2] = [f64::NAN, f64::INFINITY];

fn assert_errors<T: Debug>(values: &[f64], build: impl Fn(f64) -> basemat::Result<T>) {
    for &value in values {
        match build(value) {
            Err(Error::Input { value: reported, .. }) => {
                assert!(reported == value || !value.is_finite(), "{reported} {value}");
            }
            other => panic!("{value}: {other:?}"),
        }
    }
}

fn material() -> Material {
    Material::new(1.0e7, 0.2, 1500.0).unwrap()
}

fn two_nodes() -> Mesh {
    let mut mesh = Mesh::new();
    mesh.add_node(0.0, 0.0).unwrap();
    mesh.add_node(1.0, 0.0).unwrap();
    mesh
}

#[test]
fn elements_return_errors_for_bad_numbers() {
    assert_errors(&INVALID_NUMBERS, |x| Material::new(x, 0.2, 1.0));
    assert_errors(&[-1.0, 0.5, 0.7, f64::NAN], |x| Material::new(1.0, x, 1.0));
    assert_errors(&NEGATIVE_OR_NAN, |x| Material::new(1.0, 0.2, x));
    assert_errors(&INVALID_NUMBERS, |x| Beam::new([0, 1], x, 1.0, 1.0, 1.0));
    assert_errors(&INVALID_NUMBERS, |x| Beam::new([0, 1], 1.0, x, 1.0, 1.0));
    assert_errors(&INVALID_NUMBERS, |x| Beam::new([0, 1], 1.0, 1.0, x, 1.0));
    assert_errors(&NEGATIVE_OR_NAN, |x| Beam::new([0, 1], 1.0, 1.0, 1.0, x));
    assert_errors(&INVALID_NUMBERS, |x| {
        Beam::new([0, 1], 1.0, 1.0, 1.0, 1.0)?.with_shear_stiffness(x)
    });
    assert_errors(&INVALID_NUMBERS, |x| Truss::new([0, 1], x, 1.0, 1.0));
    assert_errors(&INVALID_NUMBERS, |x| Truss::new([0, 1], 1.0, x, 1.0));
    assert_errors(&NEGATIVE_OR_NAN, |x| Truss::new([0, 1], 1.0, 1.0, x));
    assert_errors(&INVALID_NUMBERS, |x| Spring::new([0, 1], Direction::X, x));
    assert_errors(&INVALID_NUMBERS, |x| Spring::axial([0, 1], x));
    assert_errors(&INVALID_NUMBERS, |x| Dashpot::new([0, 1], Direction::X, x));
    assert_errors(&INVALID_NUMBERS, |x| Dashpot::axial([0, 1], x));
    assert_errors(&INVALID_NUMBERS, |x| LumpedMass::new(0, x));
    assert_errors(&NEGATIVE_OR_NAN, |x| LumpedMass::new(0, 1.0)?.with_rotary_inertia(x));
    // Products of valid numbers overflow.
    assert!(Beam::new([0, 1], 1e200, 1e200, 1.0, 1.0).is_err());
    assert!(Truss::new([0, 1], 1e200, 1e200, 1.0).is_err());
}

fn add_quad(points: [[f64; 2]; 4]) -> basemat::Result<usize> {
    let mut mesh = Mesh::new();
    for [x, y] in points {
        mesh.add_node(x, y).unwrap();
    }
    mesh.add(Quad4::new([0, 1, 2, 3], material(), QuadFormulation::Full))
}

#[test]
fn meshes_return_errors_for_bad_nodes_and_shapes() {
    assert_errors(&NOT_FINITE, |x| Mesh::new().add_node(x, 0.0));
    assert_errors(&NOT_FINITE, |x| Mesh::new().add_node(0.0, x));
    assert_errors(&NOT_FINITE, |x| two_nodes().nodes_at_height(x, 0.0));
    assert_errors(&NEGATIVE_OR_NAN, |x| two_nodes().nodes_at_height(0.0, x));
    let missing_node = two_nodes().add(Truss::new([0, 7], 1.0, 1.0, 0.0).unwrap());
    assert_eq!(
        missing_node,
        Err(Error::Index { quantity: "node of the element", index: 7, bound: 2 })
    );
    let repeated_node = two_nodes().add(Truss::new([1, 1], 1.0, 1.0, 0.0).unwrap());
    assert!(matches!(repeated_node, Err(Error::Scene { .. })));
    let mut coincident = two_nodes();
    coincident.add_node(1.0, 0.0).unwrap();
    assert!(coincident.add(Truss::new([1, 2], 1.0, 1.0, 0.0).unwrap()).is_err());
    assert!(coincident.add(Beam::new([1, 2], 1.0, 1.0, 1.0, 0.0).unwrap()).is_err());
    assert!(coincident.add(Spring::axial([1, 2], 1.0).unwrap()).is_err());
    assert!(coincident.add(Dashpot::axial([1, 2], 1.0).unwrap()).is_err());
    assert!(coincident.add(Spring::new([1, 2], Direction::X, 1.0).unwrap()).is_ok());

    assert!(add_quad([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]).is_ok());
    assert!(add_quad([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]]).is_err(), "clockwise");
    assert!(add_quad([[0.0, 0.0], [1.0, 0.0], [0.2, 0.2], [0.0, 1.0]]).is_err(), "not convex");
    assert!(add_quad([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 1.0]]).is_err(), "flat corner");
}

#[track_caller]
fn assert_twice(outcome: &basemat::Result<usize>, first: usize, nodes: &[usize]) {
    let reason = format!("it duplicates element {first}, and would count twice");
    let expected = Err(Error::part(format!("element on nodes {nodes:?}"), reason));
    assert_eq!(*outcome, expected);
}

fn beam_of_area(ends: [usize; 2], area: f64) -> Beam {
    Beam::new(ends, 1e9, area, 1e-2, 2400.0).unwrap()
}

fn bar_of_density(ends: [usize; 2], density: f64) -> Truss {
    Truss::new(ends, 1e9, 0.3, density).unwrap()
}

/// GOAL: an element that counts twice is an error; what acts in parallel is not.
#[test]
fn elements_count_once() {
    let mut mesh = Mesh::new();
    for [x, y] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.0]] {
        mesh.add_node(x, y).unwrap();
    }
    for [x, y] in [[1.0, 0.5], [0.5, 1.0], [0.0, 0.5]] {
        mesh.add_node(x, y).unwrap();
    }
    let full_integration = QuadFormulation::Full;
    mesh.add(Quad4::new([0, 1, 2, 3], material(), full_integration)).unwrap();
    let other_material = Material::new(2.0e7, 0.3, 0.0).unwrap();
    assert_twice(
        &mesh.add(Quad4::new([0, 1, 2, 3], material(), full_integration)),
        0,
        &[0, 1, 2, 3],
    );
    assert_twice(
        &mesh.add(Quad4::new([2, 3, 0, 1], other_material, QuadFormulation::OnePoint)),
        0,
        &[2, 3, 0, 1],
    );
    let boxed: Box<dyn Element> = Box::new(Quad4::new([1, 2, 3, 0], material(), full_integration));
    assert_twice(&mesh.add(boxed), 0, &[1, 2, 3, 0]);
    let eight = [0, 1, 2, 3, 4, 5, 6, 7];
    assert_twice(&mesh.add(Quad8::new(eight, other_material)), 0, &eight);
    assert_eq!(mesh.elements().len(), 1);

    // Beams on an edge, of two sections, and the bar of a tie are accepted.
    assert_eq!(mesh.add(beam_of_area([0, 1], 0.1)), Ok(1));
    assert_eq!(mesh.add(beam_of_area([0, 1], 0.2)), Ok(2));
    assert_eq!(mesh.add(bar_of_density([0, 1], 2400.0)), Ok(3));
    assert_twice(&mesh.add(beam_of_area([0, 1], 0.2)), 2, &[0, 1]);
    assert_twice(&mesh.add(beam_of_area([1, 0], 0.1)), 1, &[1, 0]);
    assert_twice(&mesh.add(bar_of_density([1, 0], 2400.0)), 3, &[1, 0]);
    assert_eq!(mesh.add(beam_of_area([0, 2], 0.1)), Ok(4));
    assert_twice(&mesh.add(beam_of_area([2, 0], 0.1)), 4, &[2, 0]);
    // Springs, dashpots, weightless bars and masses add up.
    for _ in 0..2 {
        mesh.add(Spring::axial([0, 1], 1e6).unwrap()).unwrap();
        mesh.add(Dashpot::new([0, 1], Direction::X, 1e6).unwrap()).unwrap();
        mesh.add(bar_of_density([0, 1], 0.0)).unwrap();
        mesh.add(LumpedMass::new(2, 10.0).unwrap()).unwrap();
    }
    assert_eq!(mesh.elements().len(), 13);
    // A clone contains the elements that were added before.
    assert_twice(&mesh.clone().add(beam_of_area([0, 1], 0.1)), 1, &[0, 1]);
}

struct NodelessElement;

impl Element for NodelessElement {
    fn nodes(&self) -> &[usize] {
        &[]
    }

    fn directions(&self) -> &[Direction] {
        &[Direction::X]
    }

    fn stiffness(&self, _coordinates: &[[f64; 3]], _matrix: &mut [f64]) {}

    fn mass(&self, _coordinates: &[[f64; 3]], _kind: MassKind, _matrix: &mut [f64]) {}
}

#[test]
fn element_without_dofs_is_an_error() {
    assert!(matches!(two_nodes().add(NodelessElement), Err(Error::Size { .. })));
}

#[test]
fn blocks_return_errors_for_bad_grids_and_layers() {
    let layers = [Layer::new(1.0, 1, material())];
    assert_errors(&INVALID_NUMBERS, |x| Mesh::layered_block(0.0..x, 2, &layers));
    assert_errors(&NOT_FINITE, |x| Mesh::layered_block(x..1.0, 2, &layers));
    assert_errors(&INVALID_NUMBERS, |x| {
        Mesh::layered_block(0.0..1.0, 2, &[Layer::new(x, 1, material())])
    });
    let layer_without_elements = [Layer::new(1.0, 0, material())];
    for block in [
        Mesh::layered_block(0.0..1.0, 0, &layers),
        Mesh::layered_block::<Material>(0.0..1.0, 1, &[]),
        Mesh::layered_block(0.0..1.0, 1, &layer_without_elements),
    ] {
        assert!(matches!(block, Err(Error::Size { .. })));
    }
    assert_errors(&NOT_FINITE, |x| Mesh::graded_block(&[0.0, x, 1.0], &layers));
    assert!(Mesh::graded_block(&[0.0, 0.5, 0.5], &layers).is_err());
    assert!(Mesh::graded_block(&[0.0], &layers).is_err());
}

fn contact_error(contact: &[usize]) -> Error {
    let block = Mesh::layered_block(0.0..2.0, 2, &[Layer::new(1.0, 1, material())]).unwrap();
    FemModel::new(block, contact).unwrap_err()
}

#[test]
fn contact_lines_are_checked() {
    assert!(matches!(contact_error(&[]), Error::Size { found: 0, .. }));
    assert!(matches!(contact_error(&[1]), Error::Size { found: 1, .. }));
    assert!(matches!(contact_error(&[0, 9]), Error::Index { index: 9, bound: 6, .. }));
    assert!(matches!(contact_error(&[0, 4]), Error::Input { value: 1.0, .. }), "another height");
    assert!(matches!(contact_error(&[1, 0]), Error::Input { value: -1.0, .. }), "to the left");
    assert!(matches!(FemModel::new(two_nodes(), &[0, 1]), Err(Error::Scene { .. })));
    assert!(FemModel::on_base(Mesh::new()).is_err());
}

fn good_storey() -> Storey {
    Storey { rotary_inertia: 1.0, ..Storey::new(3.0, 1.0, 1.0) }
}

/// A building with this second storey.
fn building_with(storey: Storey) -> basemat::Result<ShearBuilding> {
    ShearBuilding::new(5.0, 1.0, 1.0, &[good_storey(), storey])
}

#[test]
fn structures_return_errors_for_bad_numbers() {
    assert_errors(&NEGATIVE_OR_NAN, |x| RayleighDamping::new(x, 0.0));
    assert_errors(&NEGATIVE_OR_NAN, |x| RayleighDamping::new(0.0, x));
    assert_errors(&INVALID_NUMBERS, |x| RayleighDamping::from_ratios([1.0, x], [0.1, 0.1]));
    assert_errors(&NEGATIVE_OR_NAN, |x| RayleighDamping::from_ratios([1.0, 2.0], [x, 0.1]));
    assert!(RayleighDamping::from_ratios([2.0, 2.0], [0.1, 0.1]).is_err());
    assert!(RayleighDamping::from_ratios([1.0, 2.0], [0.5, 0.01]).is_err(), "negative β");

    assert_errors(&INVALID_NUMBERS, |x| RigidBlock::new(x, 1.0, 1.0));
    assert_errors(&INVALID_NUMBERS, |x| RigidBlock::new(1.0, x, 1.0));
    assert_errors(&INVALID_NUMBERS, |x| RigidBlock::new(1.0, 1.0, x));
    assert_errors(&INVALID_NUMBERS, |x| RigidBlock::from_mass(1.0, x, 1.0, 1.0));
    assert_errors(&INVALID_NUMBERS, |x| RigidBlock::from_mass(1.0, 1.0, x, 1.0));
    assert_errors(&NEGATIVE_OR_NAN, |x| RigidBlock::from_mass(1.0, 1.0, 1.0, x));
    let block = RigidBlock::new(1.0, 1.0, 1.0).unwrap();
    assert_errors(&NOT_FINITE, |x| block.clone().centered_at(x));
    assert_errors(&NEGATIVE_OR_NAN, |x| block.clone().with_p_delta(x));

    let valid_storey = good_storey();
    assert_errors(&INVALID_NUMBERS, |height| building_with(Storey { height, ..valid_storey }));
    assert_errors(&INVALID_NUMBERS, |mass| building_with(Storey { mass, ..valid_storey }));
    assert_errors(&INVALID_NUMBERS, |stiffness| {
        building_with(Storey { stiffness, ..valid_storey })
    });
    assert_errors(&NEGATIVE_OR_NAN, |rotary_inertia| {
        building_with(Storey { rotary_inertia, ..valid_storey })
    });
    assert_errors(&NEGATIVE_OR_NAN, |damping| building_with(Storey { damping, ..valid_storey }));
    assert_errors(&INVALID_NUMBERS, |x| ShearBuilding::new(x, 1.0, 1.0, &[valid_storey]));
    assert_errors(&INVALID_NUMBERS, |x| ShearBuilding::new(1.0, x, 1.0, &[valid_storey]));
    assert_errors(&NEGATIVE_OR_NAN, |x| ShearBuilding::new(1.0, 1.0, x, &[valid_storey]));
    assert!(matches!(ShearBuilding::new(1.0, 1.0, 1.0, &[]), Err(Error::Size { .. })));
    assert!(ShearBuilding::new(1.0, 1.0, 0.0, &[Storey::new(1.0, 1.0, 1.0)]).is_err());
    assert_errors(&NOT_FINITE, |x| building_with(valid_storey)?.centered_at(x));
    assert_errors(&NEGATIVE_OR_NAN, |x| building_with(valid_storey)?.with_p_delta(x));
    assert_errors(&NEGATIVE_OR_NAN, |x| building_with(valid_storey)?.with_stiffness_damping(x));
    let building = building_with(valid_storey).unwrap();
    for computed in [building.floor(2).map(drop), building.drift(2).map(drop)] {
        assert!(matches!(computed, Err(Error::Index { index: 2, bound: 2, .. })));
    }
    assert!(building.shear(9).is_err());
}
