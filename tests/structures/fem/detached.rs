//! Parts that nothing holds on the base: no simulation is built, and the error names the nodes.

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
    let (left, right) = (nodes[0].x, nodes[nodes.len() - 1].x);
    let ground = SpringGround::new(left..right, 4, 4.0e7, 2.0e7)?;
    Simulation::builder(0.01).structure(structure).ground(ground).interface(Bonded).build()
}

/// Degrees of freedom and place of the refusal.
#[track_caller]
fn refused(structure: impl Structure + 'static) -> (Vec<usize>, String) {
    match build(structure) {
        Err(Error::Structure(StructureError::Detached { dofs, place })) => (dofs, place),
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("accepted"),
    }
}

fn material() -> Material {
    Material::new(3.0e9, 0.2, 2400.0).unwrap()
}

/// Rows of quadrilaterals 1 m high on a base 2 m wide; `merged` says whether the nodes at the seam
/// between the first row and the rest are.
fn stack(rows: usize, merged: bool) -> Mesh {
    let mut mesh = Mesh::new();
    let mut row = |y: f64| [-1.0, 0.0, 1.0].map(|x| mesh.add_node(x, y).unwrap());
    let mut quads = Vec::new();
    let mut below = row(0.0);
    for k in 0..rows {
        if k == 1 && !merged {
            below = row(1.0);
        }
        let above = row(1.0 + k as f64);
        for i in 0..2 {
            quads.push([below[i], below[i + 1], above[i + 1], above[i]]);
        }
        below = above;
    }
    for quad in quads {
        mesh.add(Quad4::new(quad, material(), QuadFormulation::default())).unwrap();
    }
    mesh
}

/// GOAL: a stack whose nodes at a seam are not merged is refused by the nodes above it, with the two
/// at one place; merged, it has all of its weight.
#[test]
fn a_seam_that_is_not_merged_is_named() {
    let weight = |mesh: Mesh| {
        let model = FemModel::on_base(mesh).unwrap();
        build(model).map(|simulation| simulation.state().normal_force)
    };
    for rows in [2, 5, 20] {
        let full = 2.0 * rows as f64 * 2400.0 * STANDARD_GRAVITY;
        assert!((weight(stack(rows, true)).unwrap() / full - 1.0).abs() < 1e-8);
        let (dofs, place) = refused(FemModel::on_base(stack(rows, false)).unwrap());
        assert_eq!(dofs, (12..6 * (rows + 2)).collect::<Vec<_>>());
        assert!(place.starts_with("node 6 at (-1, 1), node 7 at (0, 1), "), "{place}");
        assert!(place.ends_with("; node 6 lies where node 3 is, but is not merged with it"));
        assert!(rows == 2 || place.contains(&format!(" and {} more;", 3 * rows - 8)), "{place}");
    }
}

/// GOAL: a part that a rigid link or a spring ties to the rest is not detached, however soft the tie.
#[test]
fn links_and_springs_tie_parts() {
    let seam = [(3, 6), (4, 7), (5, 8)];
    for stiffness in [1e3, 1e9] {
        let mut mesh = stack(3, false);
        for (low, high) in seam {
            for direction in [Direction::X, Direction::Y] {
                mesh.add(Spring::new([low, high], direction, stiffness).unwrap()).unwrap();
            }
        }
        assert!(build(FemModel::on_base(mesh).unwrap()).is_ok(), "{stiffness:e}");
    }
    let model = FemModel::on_base(stack(3, false)).unwrap();
    let row = |node, direction| model.row(node, direction).unwrap();
    let mut isolated = WithSprings::new(model.clone());
    for (low, high) in seam {
        for direction in [Direction::X, Direction::Y] {
            let law = Bilinear::new(1e9, 1e8, 0.1).unwrap();
            isolated = isolated.spring(row(high, direction) - row(low, direction), law).unwrap();
        }
    }
    assert!(build(isolated).is_ok());

    // Two columns on one line, the upper one on the lower by a rigid link.
    let mut mesh = Mesh::new();
    let [left, foot, right] = [-1.0, 0.0, 1.0].map(|x| mesh.add_node(x, 0.0).unwrap());
    let [head, above, top] = [3.0, 3.0, 6.0].map(|y| mesh.add_node(0.0, y).unwrap());
    for ends in [[left, foot], [foot, right], [foot, head], [above, top]] {
        mesh.add(Beam::new(ends, 30.0e9, 0.1, 1e-3, 2400.0).unwrap()).unwrap();
    }
    let model = FemModel::on_base(mesh).unwrap();
    let (dofs, place) = refused(model.clone());
    assert_eq!(dofs, [12, 13, 14, 15, 16, 17]);
    let seam = "node 4 at (0, 3), node 5 at (0, 6); node 4 lies where node 3 is, but is not merged";
    assert!(place.starts_with(seam), "{place}");
    assert!(build(model.with_rigid_link(head, &[above]).unwrap()).is_ok());
}

/// GOAL: single degrees of freedom are named with their direction: a rotation that nothing holds, a mass that
/// hangs on nothing, on a bar across its way, on a dashpot.
#[test]
fn single_dofs_are_named() {
    let with = |add: &dyn Fn(&mut Mesh, usize, usize)| {
        let mut mesh = stack(1, true);
        let node = mesh.add_node(0.0, 5.0).unwrap();
        add(&mut mesh, 4, node);
        refused(FemModel::on_base(mesh).unwrap())
    };
    let mass = |node| LumpedMass::new(node, 100.0).unwrap();
    let (dofs, place) = with(&|mesh, corner, _| {
        mesh.add(mass(corner).with_rotary_inertia(10.0).unwrap()).unwrap();
    });
    assert_eq!((dofs, place.as_str()), (vec![10], "node 4 at (0, 1) in Rotation"));
    let (dofs, place) = with(&|mesh, _, node| {
        mesh.add(mass(node)).unwrap();
    });
    assert_eq!((dofs, place.as_str()), (vec![12, 13], "node 6 at (0, 5)"));
    let (dofs, place) = with(&|mesh, corner, node| {
        mesh.add(mass(node)).unwrap();
        mesh.add(Truss::new([corner, node], 1e9, 0.1, 0.0).unwrap()).unwrap();
    });
    assert_eq!((dofs, place.as_str()), (vec![12], "node 6 at (0, 5) in X"));
    let (dofs, _) = with(&|mesh, corner, node| {
        mesh.add(mass(node)).unwrap();
        mesh.add(Dashpot::axial([corner, node], 1e6).unwrap()).unwrap();
    });
    assert_eq!(dofs, [12, 13]);
    // Two nodes and a spring between them: stiffness without mass, and none to the base.
    let (dofs, _) = with(&|mesh, _, node| {
        let other = mesh.add_node(0.0, 6.0).unwrap();
        mesh.add(Spring::new([node, other], Direction::Y, 0.1).unwrap()).unwrap();
    });
    assert_eq!(dofs, [12, 13]);
}

/// GOAL: what has neither mass nor stiffness is named, though it weighs nothing.
#[test]
fn a_node_on_a_dashpot_alone_is_a_mechanism() {
    let mut mesh = stack(1, true);
    let node = mesh.add_node(0.0, 5.0).unwrap();
    mesh.add(Dashpot::axial([4, node], 1e6).unwrap()).unwrap();
    let model = FemModel::on_base(mesh).unwrap();
    let ground = || SpringGround::new(-1.0..1.0, 4, 4.0e7, 2.0e7).unwrap();
    let builder = || Simulation::builder(0.01).structure(model.clone()).interface(Bonded);
    // On the fixed base too: before, "stiffness matrix with its base held of order 14 is singular".
    for built in
        [builder().ground(ground()).build(), builder().ground(ground()).on_fixed_base().build()]
    {
        let Err(Error::Stability(cause)) = built else { panic!("{:?}", built.err()) };
        let StabilityError::Mechanism { dofs, place, massless: false } = *cause else {
            panic!("{cause}")
        };
        assert_eq!((dofs, place.as_str()), (vec![12, 13], "node 6 at (0, 5)"));
    }
}

/// Groups and reductions say whose nodes they are.
#[test]
fn wrappers_lead_to_the_nodes() {
    let model = || FemModel::on_base(stack(2, false)).unwrap();
    let block = || RigidBlock::new(2.0, 1.0, 2000.0).unwrap();
    let group = StructureGroup::new().with(block(), -4.0).unwrap().with(model(), 0.0).unwrap();
    let strips = [-5.0..-3.0, -1.0..1.0].map(|x| basemat::bem::Strip::uniform(x, 4).unwrap());
    let built = Simulation::builder(0.01)
        .structure(group)
        .ground(SpringGround::on_strips(&strips, 4.0e7, 2.0e7).unwrap())
        .interface(Bonded)
        .build();
    let Err(Error::Structure(StructureError::Detached { dofs, place })) = built else {
        panic!("{:?}", built.err())
    };
    assert_eq!(dofs, (15..27).collect::<Vec<_>>());
    assert!(place.starts_with("structure 1: node 6 at (-1, 1), "), "{place}");

    let reduced = CraigBampton::new(3).reduce(model());
    let Err(Error::Structure(StructureError::Detached { dofs, place })) = reduced else {
        panic!("reduced")
    };
    assert_eq!(dofs, (12..24).collect::<Vec<_>>());
    assert!(place.starts_with("node 6 at (-1, 1)"), "{place}");
    // Kept degrees of freedom may be tied later.
    let kept: Vec<usize> = (6..18).collect();
    let reduced = || CraigBampton::new(3).keep(&kept).reduce(model()).unwrap();
    let (dofs, place) = refused(reduced());
    assert_eq!(dofs, [12, 13, 14, 15, 16, 17]);
    assert!(place.starts_with("node 6 at (-1, 1), "), "{place}");
    let mut tied = WithSprings::new(reduced());
    for k in 6..12 {
        let row = DofCombination::from(k + 6) - DofCombination::from(k);
        tied = tied.spring(row, Bilinear::new(1e9, 1e8, 0.1).unwrap()).unwrap();
    }
    assert!(build(tied).is_ok());
}

/// A block on [u_x, u_y, θ] and more degrees of freedom: masses on the diagonal, further entries of M and K.
fn appended(
    masses: &[f64],
    coupling: &[(usize, usize, f64)],
    stiffness: impl Fn(&mut Triplets),
) -> MatrixModel {
    let n = 3 + masses.len();
    let [mut mass, mut springs] = [(); 2].map(|()| Triplets::new(n));
    [1e4, 1e4, 5e4].iter().chain(masses).enumerate().for_each(|(i, m)| mass.add(i, i, *m));
    for &(i, j, value) in coupling {
        mass.add(i, j, value);
        mass.add(j, i, value);
    }
    stiffness(&mut springs);
    MatrixModel::new(mass, springs, BaseNode::rigid_base(-2.0, 2.0, [0, 1, 2])).unwrap()
}

/// GOAL: coordinates relative to the base are held by their own stiffness and coupled by mass: a
/// tower in them marches as in absolute ones. Without the coupling, or without the support, they are
/// a part that floats.
#[test]
fn relative_coordinates_are_no_part() {
    let (m, h) = ([2.0e3, 1.0e3], [3.0, 6.0]);
    let chain = |matrix: &mut Triplets| {
        matrix.add(3, 3, 4.0e6);
        matrix.add_spring(3, 4, 3.0e6);
    };
    let relative = {
        let mut coupling = Vec::new();
        for (k, (m, h)) in m.iter().zip(h).enumerate() {
            coupling.extend([(0, 3 + k, *m), (2, 3 + k, -h * m)]);
        }
        // Floors that move with the base: (u_x − h θ)².
        coupling.push((0, 2, -(m[0] * h[0] + m[1] * h[1])));
        let whole = [m[0] + m[1], m[0] * h[0] * h[0] + m[1] * h[1] * h[1]];
        let halves = [(0, 0, 0.5 * whole[0]), (2, 2, 0.5 * whole[1])];
        appended(&m, &[&coupling[..], &halves].concat(), chain)
    };
    let absolute = appended(&m, &[], |matrix| {
        matrix.add_outer([(3, 1.0), (0, -1.0), (2, h[0])], 4.0e6);
        matrix.add_outer([(4, 1.0), (3, -1.0), (2, h[1] - h[0])], 3.0e6);
    });
    let end = |model: MatrixModel| {
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
    };
    let [a, b] = [end(relative), end(absolute)];
    assert!((a / b - 1.0).abs() < 1e-7, "{a} {b}");

    assert_eq!(refused(appended(&m, &[], chain)).0, [3, 4]);
    let coupled = [(0, 3, 100.0)];
    for stiffness in [1.0, 3.0e6, 1.0 / 3.0] {
        let floating = appended(&m, &coupled, |matrix| matrix.add_spring(3, 4, stiffness));
        assert_eq!(refused(floating).0, [3, 4]);
    }
    // A mass on a spring to a point in space, and one without any.
    let (dofs, place) = refused(appended(&[50.0], &[], |matrix| matrix.add(3, 3, 1e5)));
    assert_eq!((dofs, place.as_str()), (vec![3], "degree of freedom 3"));
    assert_eq!(refused(appended(&[50.0, 0.0], &[], |matrix| matrix.add(4, 4, 1e5))).0, [3]);
    // A mode that the base does not excite, and a degree of freedom without mass that its own spring holds.
    assert!(build(appended(&[1.0], &[], |matrix| matrix.add(3, 3, 1e5))).is_ok());
    assert!(build(appended(&[0.0], &[], |matrix| matrix.add(3, 3, 1e5))).is_ok());
}
