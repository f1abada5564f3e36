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
type Parts = (Vec<[f64; 3]>, Vec<Vec<usize>>);

/// An element on nodes, of which a number of kinds exist.
type Make = fn(&[usize]) -> Box<dyn Element>;

/// Mesh on common nodes, and one with nodes of its own for each element, which are off by up to a hundredth of a millimetre.
fn meshes((places, elements): &Parts, makes: &[Make], in_space: bool) -> [Mesh; 2] {
    let empty = || if in_space { Mesh::in_space() } else { Mesh::new() };
    let (mut common, mut apart) = (empty(), empty());
    for &place in places {
        common.add_node_at(place).unwrap();
    }
    let mut count = 0;
    for (nodes, make) in elements.iter().zip(makes) {
        common.add(make(nodes)).unwrap();
        let mut own = Vec::new();
        for &node in nodes {
            let mut place = places[node];
            count += 1;
            place[0] += 1e-5 * f64::from(count % 3 - 1);
            own.push(apart.add_node_at(place).unwrap());
        }
        apart.add(make(&own)).unwrap();
    }
    [common, apart]
}

/// A table with legs, a brick below it, a spring and a mass.
fn in_space() -> (Parts, Vec<Make>) {
    let square = |z: f64| [[0.0, 0.0, z], [2.0, 0.0, z], [2.0, 1.0, z], [0.0, 1.0, z]];
    let places = [square(0.0), square(1.0), square(3.0)].concat();
    let beam: Make = |nodes| {
        let section = BeamSection::new(0.16, [2.1e-3, 2.1e-3], 3.6e-3).unwrap();
        Box::new(
            SpaceBeam::new([nodes[0], nodes[1]], concrete(), section, [1.0, 0.0, 0.0]).unwrap(),
        )
    };
    let shell: Make = |nodes| Box::new(Shell::new(nodes, concrete(), 0.2).unwrap());
    let brick: Make = |nodes| Box::new(Hex8::new(nodes.try_into().unwrap(), concrete()));
    let spring: Make =
        |nodes| Box::new(Spring::new([nodes[0], nodes[1]], Direction::Z, 1e6).unwrap());
    let truss: Make =
        |nodes| Box::new(Truss::in_space([nodes[0], nodes[1]], 2e11, 1e-3, 7800.0).unwrap());
    let weight: Make = |nodes| Box::new(LumpedMass::in_space(nodes[0], 500.0, [1.0; 3]).unwrap());
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

fn in_plane() -> (Parts, Vec<Make>) {
    let places =
        [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 1.0], [1.0, 1.0], [2.0, 1.0], [1.0, 4.0]];
    let mut places: Vec<[f64; 3]> = places.iter().map(|&[x, y]| [x, y, 0.0]).collect();
    for [x, y] in [[0.5, 0.0], [1.0, 0.5], [0.5, 1.0], [0.0, 0.5]] {
        places.push([x, y, 0.0]);
    }
    let quad: Make = |nodes| {
        Box::new(Quad4::new(nodes.try_into().unwrap(), concrete(), QuadFormulation::default()))
    };
    let curved: Make = |nodes| Box::new(Quad8::new(nodes.try_into().unwrap(), concrete()));
    let beam: Make =
        |nodes| Box::new(Beam::new([nodes[0], nodes[1]], 30.0e9, 0.4, 0.02, 2400.0).unwrap());
    let elements =
        vec![vec![0, 1, 4, 3, 7, 8, 9, 10], vec![1, 2, 5, 4], vec![4, 6], vec![4, 5], vec![6, 5]];
    ((places, elements), vec![curved, quad, beam, beam, beam])
}

#[test]
fn merged_meshes_are_those_on_common_nodes() {
    for (depth, (parts, makes)) in [(true, in_space()), (false, in_plane())] {
        let [common, mut apart] = meshes(&parts, &makes, depth);
        let before = apart.nodes().len();
        assert!(before > common.nodes().len() + 5);
        let merged = apart.merge_nodes(1e-3).unwrap();
        assert_eq!(
            (merged.count, apart.nodes().len()),
            (before - common.nodes().len(), common.nodes().len())
        );
        assert_eq!(
            (merged.indices.len(), apart.elements().len()),
            (before, common.elements().len())
        );
        // Again: nothing to do.
        assert_eq!(apart.clone().merge_nodes(1e-3).unwrap().count, 0);
        // Types remain, so that forces of beams and shells can be asked for.
        let model = |mesh: Mesh| FemModel::on_base(mesh).unwrap();
        let [common, apart] = [common, apart].map(model);
        assert_eq!(common.dofs(), apart.dofs());
        for place in &parts.0 {
            // Nodes come in another order.
            let [a, b] = [&common, &apart].map(|model| {
                let nearest = model.mesh().nearest_node_to(*place).unwrap();
                model
                    .mesh()
                    .directions()
                    .iter()
                    .filter_map(|&own| model.dof(nearest, own))
                    .collect::<Vec<_>>()
            });
            for matrix in [stiffness, mass] {
                let [one, two] = [matrix(&common), matrix(&apart)];
                for (&i, &j) in a.iter().zip(&b) {
                    let (found, wanted) = (two[j][j], one[i][i]);
                    assert!((found / wanted - 1.0).abs() < 1e-3, "{place:?}: {found} {wanted}");
                }
            }
        }
        assert_eq!(apart.beam_rows(2).is_ok(), common.beam_rows(2).is_ok());
    }
}

#[test]
fn degenerate_elements_and_rows_of_nodes_are_named() {
    let mut mesh = Mesh::new();
    let nodes: Vec<usize> =
        [0.0, 0.5, 1.0, 5.0].iter().map(|&x| mesh.add_node(x, 0.0).unwrap()).collect();
    mesh.add(Beam::new([nodes[0], nodes[1]], 30.0e9, 0.4, 0.02, 0.0).unwrap()).unwrap();
    let unchanged = mesh.nodes().to_vec();
    let error = |mesh: &mut Mesh, tolerance| mesh.merge_nodes(tolerance).unwrap_err().to_string();
    let row = error(&mut mesh, 0.6);
    assert!(row.contains("nodes") && row.contains("tolerance"), "{row}");
    let mut short = Mesh::new();
    let ends = [short.add_node(0.0, 0.0).unwrap(), short.add_node(0.01, 0.0).unwrap()];
    short.add(Beam::new(ends, 30.0e9, 0.4, 0.02, 0.0).unwrap()).unwrap();
    let degenerate = error(&mut short, 0.05);
    assert!(degenerate.contains("element 0 on nodes [0, 1]"), "{degenerate}");
    for tolerance in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(mesh.merge_nodes(tolerance), Err(Error::Input { .. })));
    }
    assert_eq!((mesh.nodes(), short.nodes().len()), (&unchanged[..], 2));
    // Two equal beams would count twice.
    let mut double = Mesh::new();
    for _ in 0..2 {
        let ends = [0.0, 3.0].map(|x| double.add_node(x, 0.0).unwrap());
        double.add(Beam::new(ends, 30.0e9, 0.4, 0.02, 2400.0).unwrap()).unwrap();
    }
    let twice = error(&mut double, 1e-6);
    assert!(twice.contains("element 1") && twice.contains("count twice"), "{twice}");
    // An element of a user without new nodes.
    mesh.add(Tie([nodes[2], nodes[3]])).unwrap();
    let tie = error(&mut mesh, 1e-6);
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
