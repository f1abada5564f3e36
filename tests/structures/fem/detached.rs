//! Parts without a connection to the base: the build returns an error that names the nodes.

use basemat::bem::SpringGround;
use basemat::coupled::StabilityError;
use basemat::fem::{
    Beam, Dashpot, Direction, LumpedMass, Material, Mesh, Quad4, QuadFormulation, Spring, Truss,
};
use basemat::interface::Bonded;
use basemat::motion::STANDARD_GRAVITY;
use basemat::structure::StructureError;
use basemat::structure::{
    BaseNode, Bilinear, CraigBampton, DofCombination, FemModel, MatrixModel, RigidBlock, Structure,
    StructureGroup, Triplets, WithSprings,
};
use basemat::{Error, Result, Simulation};

fn build(structure: impl Structure + 'static) -> Result<Simulation> {
    let base = structure.base();
    let nodes: Vec<_> = base.nodes().collect();
    let left = nodes[0].x;
    let right = nodes[nodes.len() - 1].x;
    let ground = SpringGround::new(left..right, 4, 4.0e7, 2.0e7)?;
    Simulation::builder(0.01)
        .structure(structure)
        .ground(ground)
        .interface(Bonded)
        .build()
}

/// Data of the error of a detached part.
struct DetachedPart {
    dofs: Vec<usize>,
    place: String,
}

#[track_caller]
fn detached_part(structure: impl Structure + 'static) -> DetachedPart {
    match build(structure) {
        Err(Error::Structure(StructureError::Detached { dofs, place })) => {
            DetachedPart { dofs, place }
        }
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("accepted"),
    }
}

fn material() -> Material {
    Material::new(3.0e9, 0.2, 2400.0).unwrap()
}

fn add_row(mesh: &mut Mesh, y: f64) -> [usize; 3] {
    [-1.0, 0.0, 1.0].map(|x| mesh.add_node(x, y).unwrap())
}

/// Rows of quadrilaterals 1 m high on a base 2 m wide.
///
/// With `is_merged` the second row stands on the upper nodes of the first one.
fn stack(rows: usize, is_merged: bool) -> Mesh {
    let mut mesh = Mesh::new();
    let mut quads = Vec::new();
    let mut lower_nodes = add_row(&mut mesh, 0.0);
    for k in 0..rows {
        if k == 1 && !is_merged {
            lower_nodes = add_row(&mut mesh, 1.0);
        }
        let upper_nodes = add_row(&mut mesh, 1.0 + k as f64);
        for i in 0..2 {
            quads.push([lower_nodes[i], lower_nodes[i + 1], upper_nodes[i + 1], upper_nodes[i]]);
        }
        lower_nodes = upper_nodes;
    }
    for quad in quads {
        mesh.add(Quad4::new(quad, material(), QuadFormulation::default())).unwrap();
    }
    mesh
}

fn standing_weight(mesh: Mesh) -> Result<f64> {
    build(FemModel::on_base(mesh).unwrap()).map(|simulation| simulation.state().normal_force)
}

/// GOAL: the error for a stack with a seam that is not merged names the nodes above the seam, and two nodes at one
/// place. With a merged seam the base carries the whole weight.
#[test]
fn a_seam_that_is_not_merged_is_named() {
    for rows in [2, 5, 20] {
        let weight = 2.0 * rows as f64 * 2400.0 * STANDARD_GRAVITY;
        assert!((standing_weight(stack(rows, true)).unwrap() / weight - 1.0).abs() < 1e-8);
        let DetachedPart { dofs, place } =
            detached_part(FemModel::on_base(stack(rows, false)).unwrap());
        assert_eq!(dofs, (12..6 * (rows + 2)).collect::<Vec<_>>());
        assert!(place.starts_with("node 6 at (-1, 1), node 7 at (0, 1), "), "{place}");
        let seam_text =
            "; node 6 lies where node 3 is, but is not merged with it by `Mesh::merge_nodes`";
        assert!(place.ends_with(seam_text), "{place}");
        assert!(rows == 2 || place.contains(&format!(" and {} more;", 3 * rows - 8)), "{place}");
    }
}

/// GOAL: a part that a rigid link or a spring ties to the rest is not detached, however soft the tie.
#[test]
fn links_and_springs_tie_parts() {
    let seam = [(3, 6), (4, 7), (5, 8)];
    for stiffness in [1e3, 1e9] {
        let mut mesh = stack(3, false);
        for (lower_node, upper_node) in seam {
            for direction in [Direction::X, Direction::Y] {
                mesh.add(Spring::new([lower_node, upper_node], direction, stiffness).unwrap())
                    .unwrap();
            }
        }
        assert!(build(FemModel::on_base(mesh).unwrap()).is_ok(), "{stiffness:e}");
    }
    let model = FemModel::on_base(stack(3, false)).unwrap();
    let mut isolated_model = WithSprings::new(model.clone());
    for (lower_node, upper_node) in seam {
        for direction in [Direction::X, Direction::Y] {
            let law = Bilinear::new(1e9, 1e8, 0.1).unwrap();
            let elongation = model.row(upper_node, direction).unwrap()
                - model.row(lower_node, direction).unwrap();
            isolated_model = isolated_model.spring(elongation, law).unwrap();
        }
    }
    assert!(build(isolated_model).is_ok());

    // Two columns on one line, the upper one on the lower by a rigid link.
    let mut mesh = Mesh::new();
    let feet = [-1.0, 0.0, 1.0].map(|x| mesh.add_node(x, 0.0).unwrap());
    let column = [3.0, 3.0, 6.0].map(|y| mesh.add_node(0.0, y).unwrap());
    for ends in
        [[feet[0], feet[1]], [feet[1], feet[2]], [feet[1], column[0]], [column[1], column[2]]]
    {
        mesh.add(Beam::new(ends, 30.0e9, 0.1, 1e-3, 2400.0).unwrap()).unwrap();
    }
    let model = FemModel::on_base(mesh).unwrap();
    let DetachedPart { dofs, place } = detached_part(model.clone());
    assert_eq!(dofs, [12, 13, 14, 15, 16, 17]);
    let seam = "node 4 at (0, 3), node 5 at (0, 6); node 4 lies where node 3 is, but is not merged";
    assert!(place.starts_with(seam), "{place}");
    assert!(build(model.with_rigid_link(column[0], &[column[1]]).unwrap()).is_ok());
}

/// Middle node at the top of a stack of one row.
const TOP_NODE: usize = 4;

/// Error of a stack of one row with a node 4 m above it, and with what `add` puts on that node.
fn detached_part_with_node(add: impl FnOnce(&mut Mesh, usize)) -> DetachedPart {
    let mut mesh = stack(1, true);
    let node = mesh.add_node(0.0, 5.0).unwrap();
    add(&mut mesh, node);
    detached_part(FemModel::on_base(mesh).unwrap())
}

fn mass_at(node: usize) -> LumpedMass {
    LumpedMass::new(node, 100.0).unwrap()
}

/// GOAL: single degrees of freedom are named with their direction: a rotation without stiffness; a mass
/// without a connection, on a bar across its motion, on a dashpot.
#[test]
fn single_dofs_are_named() {
    let DetachedPart { dofs, place } = detached_part_with_node(|mesh, _| {
        mesh.add(mass_at(TOP_NODE).with_rotary_inertia(10.0).unwrap()).unwrap();
    });
    assert_eq!((dofs, place.as_str()), (vec![10], "node 4 at (0, 1) in Rotation"));
    let DetachedPart { dofs, place } = detached_part_with_node(|mesh, node| {
        mesh.add(mass_at(node)).unwrap();
    });
    assert_eq!((dofs, place.as_str()), (vec![12, 13], "node 6 at (0, 5)"));
    let DetachedPart { dofs, place } = detached_part_with_node(|mesh, node| {
        mesh.add(mass_at(node)).unwrap();
        mesh.add(Truss::new([TOP_NODE, node], 1e9, 0.1, 0.0).unwrap()).unwrap();
    });
    assert_eq!((dofs, place.as_str()), (vec![12], "node 6 at (0, 5) in X"));
    let on_dashpot = detached_part_with_node(|mesh, node| {
        mesh.add(mass_at(node)).unwrap();
        mesh.add(Dashpot::axial([TOP_NODE, node], 1e6).unwrap()).unwrap();
    });
    assert_eq!(on_dashpot.dofs, [12, 13]);
    // Two nodes and a spring between them: stiffness without mass, and none to the base.
    let free_pair = detached_part_with_node(|mesh, node| {
        let other_node = mesh.add_node(0.0, 6.0).unwrap();
        mesh.add(Spring::new([node, other_node], Direction::Y, 0.1).unwrap()).unwrap();
    });
    assert_eq!(free_pair.dofs, [12, 13]);
}

/// GOAL: the error names a node that has only a dashpot, neither mass nor stiffness.
#[test]
fn a_node_on_a_dashpot_alone_is_a_mechanism() {
    let mut mesh = stack(1, true);
    let node = mesh.add_node(0.0, 5.0).unwrap();
    mesh.add(Dashpot::axial([TOP_NODE, node], 1e6).unwrap()).unwrap();
    let model = FemModel::on_base(mesh).unwrap();
    for fixed_base in [false, true] {
        let builder = Simulation::builder(0.01)
            .structure(model.clone())
            .interface(Bonded)
            .ground(SpringGround::new(-1.0..1.0, 4, 4.0e7, 2.0e7).unwrap());
        let result = if fixed_base { builder.on_fixed_base().build() } else { builder.build() };
        let Err(Error::Stability(cause)) = result else { panic!("{:?}", result.err()) };
        let StabilityError::Mechanism { dofs, place, massless: false } = *cause else {
            panic!("{cause}")
        };
        assert_eq!((dofs, place.as_str()), (vec![12, 13], "node 6 at (0, 5)"));
    }
}

fn torn_stack() -> FemModel {
    FemModel::on_base(stack(2, false)).unwrap()
}

/// In groups the error also names the structure; in reductions it names the nodes.
#[test]
fn wrappers_lead_to_the_nodes() {
    let block = RigidBlock::new(2.0, 1.0, 2000.0).unwrap();
    let group = StructureGroup::new().with(block, -4.0).unwrap();
    let group = group.with(torn_stack(), 0.0).unwrap();
    let strips = [-5.0..-3.0, -1.0..1.0].map(|x| basemat::bem::Strip::uniform(x, 4).unwrap());
    let result = Simulation::builder(0.01)
        .structure(group)
        .ground(SpringGround::on_strips(&strips, 4.0e7, 2.0e7).unwrap())
        .interface(Bonded)
        .build();
    let Err(Error::Structure(StructureError::Detached { dofs, place })) = result else {
        panic!("{:?}", result.err())
    };
    assert_eq!(dofs, (15..27).collect::<Vec<_>>());
    assert!(place.starts_with("structure 1: node 6 at (-1, 1), "), "{place}");

    let reduced_structure = CraigBampton::new(3).reduce(torn_stack());
    let Err(Error::Structure(StructureError::Detached { dofs, place })) = reduced_structure else {
        panic!("reduced")
    };
    assert_eq!(dofs, (12..24).collect::<Vec<_>>());
    assert!(place.starts_with("node 6 at (-1, 1)"), "{place}");
    // Kept degrees of freedom may be tied later.
    let kept_dofs: Vec<usize> = (6..18).collect();
    let reduced_structure = CraigBampton::new(3).keep(&kept_dofs).reduce(torn_stack()).unwrap();
    let DetachedPart { dofs, place } = detached_part(reduced_structure);
    assert_eq!(dofs, [12, 13, 14, 15, 16, 17]);
    assert!(place.starts_with("node 6 at (-1, 1), "), "{place}");
    let reduced_structure = CraigBampton::new(3).keep(&kept_dofs).reduce(torn_stack()).unwrap();
    let mut tied_model = WithSprings::new(reduced_structure);
    for k in 6..12 {
        let deformation = DofCombination::from(k + 6) - DofCombination::from(k);
        tied_model = tied_model.spring(deformation, Bilinear::new(1e9, 1e8, 0.1).unwrap()).unwrap();
    }
    assert!(build(tied_model).is_ok());
}

/// A block on [u_x, u_y, θ] and more degrees of freedom: masses on the diagonal, further entries of M and K.
fn appended(
    masses: &[f64],
    coupling: &[(usize, usize, f64)],
    stiffness: impl Fn(&mut Triplets),
) -> MatrixModel {
    let n = 3 + masses.len();
    let mut mass = Triplets::new(n);
    let mut springs = Triplets::new(n);
    [1e4, 1e4, 5e4]
        .iter()
        .chain(masses)
        .enumerate()
        .for_each(|(i, m)| mass.add(i, i, *m));
    for &(i, j, value) in coupling {
        mass.add(i, j, value);
        mass.add(j, i, value);
    }
    stiffness(&mut springs);
    MatrixModel::new(mass, springs, BaseNode::rigid_base(-2.0, 2.0, [0, 1, 2])).unwrap()
}

/// Springs of a chain of two floors, the lower on the base.
fn chain(matrix: &mut Triplets) {
    matrix.add(3, 3, 4.0e6);
    matrix.add_spring(3, 4, 3.0e6);
}

/// A tower of floors of masses `m` at heights `h`, in coordinates relative to the base.
fn relative_tower(m: [f64; 2], h: [f64; 2]) -> MatrixModel {
    let mut coupling = Vec::new();
    for (k, (m, h)) in m.iter().zip(h).enumerate() {
        coupling.extend([(0, 3 + k, *m), (2, 3 + k, -h * m)]);
    }
    // Floors that move with the base: (u_x − h θ)².
    coupling.push((0, 2, -(m[0] * h[0] + m[1] * h[1])));
    let inertia = [m[0] + m[1], m[0] * h[0] * h[0] + m[1] * h[1] * h[1]];
    let halves = [(0, 0, 0.5 * inertia[0]), (2, 2, 0.5 * inertia[1])];
    appended(&m, &[&coupling[..], &halves].concat(), chain)
}

/// Base shear after three seconds of El Centro.
fn last_base_shear(model: MatrixModel) -> f64 {
    let ground = SpringGround::new(-2.0..2.0, 4, 4.0e7, 2.0e7).unwrap();
    let mut simulation = Simulation::builder(0.01)
        .structure(model)
        .ground(ground)
        .interface(Bonded)
        .motion(basemat::motion::el_centro_1940())
        .gravity(0.0)
        .build()
        .unwrap();
    simulation.run(300, |_| {}).unwrap();
    simulation.state().base_shear
}

/// GOAL: coordinates relative to the base have springs to it and are coupled by mass: a
/// tower in them has the base shear of one in absolute coordinates. Without the mass coupling, or without the
/// springs to the base, the error names them as a detached part.
#[test]
fn relative_coordinates_are_no_part() {
    let m = [2.0e3, 1.0e3];
    let h = [3.0, 6.0];
    let absolute_tower = appended(&m, &[], |matrix| {
        matrix.add_outer([(3, 1.0), (0, -1.0), (2, h[0])], 4.0e6);
        matrix.add_outer([(4, 1.0), (3, -1.0), (2, h[1] - h[0])], 3.0e6);
    });
    let computed = last_base_shear(relative_tower(m, h));
    let expected = last_base_shear(absolute_tower);
    assert!((computed / expected - 1.0).abs() < 1e-7, "{computed} {expected}");

    assert_eq!(detached_part(appended(&m, &[], chain)).dofs, [3, 4]);
    let mass_coupling = [(0, 3, 100.0)];
    for stiffness in [1.0, 3.0e6, 1.0 / 3.0] {
        let free_tower = appended(&m, &mass_coupling, |matrix| matrix.add_spring(3, 4, stiffness));
        assert_eq!(detached_part(free_tower).dofs, [3, 4]);
    }
    // A mass on a spring to a point in space, and one without any.
    let on_spring = appended(&[50.0], &[], |matrix| matrix.add(3, 3, 1e5));
    let DetachedPart { dofs, place } = detached_part(on_spring);
    assert_eq!((dofs, place.as_str()), (vec![3], "degree of freedom 3"));
    let beside_spring = appended(&[50.0, 0.0], &[], |matrix| matrix.add(4, 4, 1e5));
    assert_eq!(detached_part(beside_spring).dofs, [3]);
    // A degree of freedom with unit mass counts as the amplitude of a mode; a massless one may be held by a spring.
    assert!(build(appended(&[1.0], &[], |matrix| matrix.add(3, 3, 1e5))).is_ok());
    assert!(build(appended(&[0.0], &[], |matrix| matrix.add(3, 3, 1e5))).is_ok());
}
