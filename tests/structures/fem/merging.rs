//! GOAL: nodes at the same place become one, and elements act on each other through it.
//! SCENE: a frame of separate beams, a block of separate bricks, shells beside bricks; rows of near nodes, flat elements.
//! REFERENCE: the same structures made on common nodes.

use basemat::Error;
use basemat::fem::{
    Beam, BeamSection, Direction, Element, Hex8, LumpedMass, MassKind, Material, Mesh, Quad4,
    Quad8, QuadFormulation, Shell, SpaceBeam, Spring, Truss,
};
use basemat::structure::{FemModel, Structure};
use basemat_problems::dense::{mass, stiffness};

fn concrete() -> Material {
    Material::new(30.0e9, 0.2, 2500.0).unwrap()
}

/// Places of a mesh and, element by element, its nodes.
type MeshParts = (Vec<[f64; 3]>, Vec<Vec<usize>>);

/// Makes an element of one kind on these nodes.
type MakeElement = fn(&[usize]) -> Box<dyn Element>;

/// A mesh on common nodes, and the same elements on separate ones.
struct MeshPair {
    common: Mesh,
    separate_mesh: Mesh,
}

impl MeshPair {
    /// The separate nodes are off by up to a hundredth of a millimetre.
    fn new((places, elements): &MeshParts, makes: &[MakeElement], in_space: bool) -> Self {
        let mut common = if in_space { Mesh::in_space() } else { Mesh::new() };
        let mut separate_mesh = common.clone();
        for &place in places {
            common.add_node_at(place).unwrap();
        }
        let mut count = 0;
        for (nodes, make) in elements.iter().zip(makes) {
            common.add(make(nodes)).unwrap();
            let mut separate_nodes = Vec::new();
            for &node in nodes {
                let mut place = places[node];
                count += 1;
                place[0] += 1e-5 * f64::from(count % 3 - 1);
                separate_nodes.push(separate_mesh.add_node_at(place).unwrap());
            }
            separate_mesh.add(make(&separate_nodes)).unwrap();
        }
        Self { common, separate_mesh }
    }
}

fn rectangle(z: f64) -> [[f64; 3]; 4] {
    [[0.0, 0.0, z], [2.0, 0.0, z], [2.0, 1.0, z], [0.0, 1.0, z]]
}

/// A table with legs, a brick below it, a spring and a mass.
fn in_space() -> (MeshParts, Vec<MakeElement>) {
    let places = [rectangle(0.0), rectangle(1.0), rectangle(3.0)].concat();
    let beam: MakeElement = |nodes| {
        let section = BeamSection::new(0.16, [2.1e-3, 2.1e-3], 3.6e-3).unwrap();
        Box::new(
            SpaceBeam::new([nodes[0], nodes[1]], concrete(), section, [1.0, 0.0, 0.0]).unwrap(),
        )
    };
    let shell: MakeElement = |nodes| Box::new(Shell::new(nodes, concrete(), 0.2).unwrap());
    let brick: MakeElement = |nodes| Box::new(Hex8::new(nodes.try_into().unwrap(), concrete()));
    let spring: MakeElement =
        |nodes| Box::new(Spring::new([nodes[0], nodes[1]], Direction::Z, 1e6).unwrap());
    let truss: MakeElement =
        |nodes| Box::new(Truss::in_space([nodes[0], nodes[1]], 2e11, 1e-3, 7800.0).unwrap());
    let weight: MakeElement =
        |nodes| Box::new(LumpedMass::in_space(nodes[0], 500.0, [1.0; 3]).unwrap());
    let elements = vec![
        (0..8).collect(),
        vec![4, 8],
        vec![5, 9],
        vec![6, 10],
        vec![7, 11],
        vec![8, 9, 10, 11],
        vec![0, 10],
        vec![1, 11],
        vec![10],
        vec![4, 5, 9],
        vec![4, 9, 8],
    ];
    let makes = vec![brick, beam, beam, beam, beam, shell, spring, truss, weight, shell, shell];
    ((places, elements), makes)
}

fn in_plane() -> (MeshParts, Vec<MakeElement>) {
    let places =
        [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 1.0], [1.0, 1.0], [2.0, 1.0], [1.0, 4.0]];
    let mut places: Vec<[f64; 3]> = places.iter().map(|&[x, y]| [x, y, 0.0]).collect();
    for [x, y] in [[0.5, 0.0], [1.0, 0.5], [0.5, 1.0], [0.0, 0.5]] {
        places.push([x, y, 0.0]);
    }
    let quad: MakeElement = |nodes| {
        Box::new(Quad4::new(nodes.try_into().unwrap(), concrete(), QuadFormulation::default()))
    };
    let curved: MakeElement = |nodes| Box::new(Quad8::new(nodes.try_into().unwrap(), concrete()));
    let beam: MakeElement =
        |nodes| Box::new(Beam::new([nodes[0], nodes[1]], 30.0e9, 0.4, 0.02, 2400.0).unwrap());
    let elements =
        vec![vec![0, 1, 4, 3, 7, 8, 9, 10], vec![1, 2, 5, 4], vec![4, 6], vec![4, 5], vec![6, 5]];
    ((places, elements), vec![curved, quad, beam, beam, beam])
}

/// Degrees of freedom of the node at a place.
fn dofs_at(model: &FemModel, place: [f64; 3]) -> Vec<usize> {
    let nearest_node = model.mesh().nearest_node_to(place).unwrap();
    let directions = model.mesh().directions();
    directions
        .iter()
        .filter_map(|&direction| model.dof(nearest_node, direction))
        .collect()
}

#[test]
fn merged_meshes_are_those_on_common_nodes() {
    for (depth, (parts, makes)) in [(true, in_space()), (false, in_plane())] {
        let MeshPair { common, mut separate_mesh } = MeshPair::new(&parts, &makes, depth);
        let before = separate_mesh.nodes().len();
        assert!(before > common.nodes().len() + 5);
        let merged = separate_mesh.merge_nodes(1e-3).unwrap();
        assert_eq!(
            (merged.count, separate_mesh.nodes().len()),
            (before - common.nodes().len(), common.nodes().len())
        );
        assert_eq!(
            (merged.indices.len(), separate_mesh.elements().len()),
            (before, common.elements().len())
        );
        // A second merge finds no pair.
        assert_eq!(separate_mesh.clone().merge_nodes(1e-3).unwrap().count, 0);
        // Element types are kept, so that forces of beams and shells can be computed.
        let expected_model = FemModel::on_base(common).unwrap();
        let merged_model = FemModel::on_base(separate_mesh).unwrap();
        assert_eq!(expected_model.dofs(), merged_model.dofs());
        for &place in &parts.0 {
            // Nodes come in another order.
            let expected_dofs = dofs_at(&expected_model, place);
            let merged_dofs = dofs_at(&merged_model, place);
            for matrix in [stiffness, mass] {
                let expected_matrix = matrix(&expected_model);
                let merged_matrix = matrix(&merged_model);
                for (&i, &j) in expected_dofs.iter().zip(&merged_dofs) {
                    let computed = merged_matrix[j][j];
                    let expected = expected_matrix[i][i];
                    assert!(
                        (computed / expected - 1.0).abs() < 1e-3,
                        "{place:?}: {computed} {expected}"
                    );
                }
            }
        }
        assert_eq!(merged_model.beam_rows(2).is_ok(), expected_model.beam_rows(2).is_ok());
    }
}

fn merge_error(mesh: &mut Mesh, tolerance: f64) -> String {
    mesh.merge_nodes(tolerance).unwrap_err().to_string()
}

#[test]
fn degenerate_elements_and_rows_of_nodes_are_named() {
    let mut mesh = Mesh::new();
    let nodes: Vec<usize> =
        [0.0, 0.5, 1.0, 5.0].iter().map(|&x| mesh.add_node(x, 0.0).unwrap()).collect();
    mesh.add(Beam::new([nodes[0], nodes[1]], 30.0e9, 0.4, 0.02, 0.0).unwrap()).unwrap();
    let nodes_before = mesh.nodes().to_vec();
    let row = merge_error(&mut mesh, 0.6);
    assert!(row.contains("nodes") && row.contains("tolerance"), "{row}");
    let mut short_mesh = Mesh::new();
    let ends = [short_mesh.add_node(0.0, 0.0).unwrap(), short_mesh.add_node(0.01, 0.0).unwrap()];
    short_mesh.add(Beam::new(ends, 30.0e9, 0.4, 0.02, 0.0).unwrap()).unwrap();
    let degenerate = merge_error(&mut short_mesh, 0.05);
    assert!(degenerate.contains("element 0 on nodes [0, 1]"), "{degenerate}");
    for tolerance in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(mesh.merge_nodes(tolerance), Err(Error::Input { .. })));
    }
    assert_eq!((mesh.nodes(), short_mesh.nodes().len()), (&nodes_before[..], 2));
    // Two equal beams would count twice.
    let mut double = Mesh::new();
    for _ in 0..2 {
        let ends = [0.0, 3.0].map(|x| double.add_node(x, 0.0).unwrap());
        double.add(Beam::new(ends, 30.0e9, 0.4, 0.02, 2400.0).unwrap()).unwrap();
    }
    let error = merge_error(&mut double, 1e-6);
    assert!(error.contains("element 1") && error.contains("count twice"), "{error}");
    // An element of a user without new nodes.
    mesh.add(Tie([nodes[2], nodes[3]])).unwrap();
    let tie = merge_error(&mut mesh, 1e-6);
    assert!(tie.contains("element 1") && tie.contains("with_nodes"), "{tie}");
}

/// An element of a user that cannot be renumbered.
struct Tie([usize; 2]);
impl Element for Tie {
    fn nodes(&self) -> &[usize] {
        &self.0
    }
    fn directions(&self) -> &[Direction] {
        &[Direction::X]
    }
    fn stiffness(&self, _coordinates: &[[f64; 3]], _matrix: &mut [f64]) {}
    fn mass(&self, _coordinates: &[[f64; 3]], _kind: MassKind, _matrix: &mut [f64]) {}
}
