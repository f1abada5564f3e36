//! GOAL: a base whose parts touch and are not tied together says so, and parts that overlap are refused.
//! SCENE: rafts of shells with two nodes at each point of a joint, and with a node in the middle of a longer side; a raft of
//! free corners by matrices.
//! REFERENCE: points by hand; the same rafts with common nodes, or with the node tied to the ends of the side.

use basemat::bem::{PlanError, SpringGround};
use basemat::coupled::{Mistake, Warning};
use basemat::fem::{Direction, Material, Mesh, Shell};
use basemat::interface::Coulomb;
use basemat::structure::{
    Base, BaseNode, DofCombination, FemModel, MatrixModel, RigidBody, Structure, StructureGroup,
    Triplets,
};
use basemat::{Error, Result, Simulation};

/// Adds a square raft of `count` × `count` shells from (`left`, 0) on, with sides of 6 m; their corners.
fn add_raft(mesh: &mut Mesh, count: usize, left: f64) -> Result<Vec<Vec<usize>>> {
    add_raft_of(mesh, count, left, |_| 0.8)
}

/// The same with a thickness for each shell.
fn add_raft_of(
    mesh: &mut Mesh,
    count: usize,
    left: f64,
    thickness: impl Fn(usize) -> f64,
) -> Result<Vec<Vec<usize>>> {
    let size = 6.0 / count as f64;
    let place = |row: usize, column: usize| [left + size * column as f64, size * row as f64, 0.0];
    let grid = mesh.add_grid(count + 1, count + 1, place)?;
    let concrete = Material::new(30e9, 0.2, 2500.0)?;
    let cells: Vec<Vec<usize>> = grid.cells().map(|(_, corners)| corners).collect();
    for (shell, corners) in cells.iter().enumerate() {
        mesh.add(Shell::new(corners, concrete, thickness(shell))?)?;
    }
    Ok(cells)
}

/// The warning of a torn base in a run of one step.
fn torn(structure: impl Structure + Clone + 'static) -> Result<Option<(usize, [f64; 2], String)>> {
    let ground = SpringGround::under(&structure, 4, 5e7, 4e7)?.with_dashpots(4e5, 3e5)?;
    let builder = Simulation::builder(0.01).ground(ground).structure(structure);
    let run = builder.interface(Coulomb::new(0.5)?).build()?.run(1, |_| {})?;
    let found = run.warnings.iter().find_map(|warning| match warning {
        Warning::Mistake(Mistake::TornBase { points, x, y }) => {
            Some((*points, [*x, *y], warning.to_string()))
        }
        _ => None,
    });
    Ok(found)
}

fn model(rafts: &[(usize, f64)]) -> Result<FemModel> {
    let mut mesh = Mesh::in_space();
    for (count, left) in rafts {
        add_raft(&mut mesh, *count, *left)?;
    }
    FemModel::on_base(mesh)
}

#[test]
fn rafts_side_by_side_with_nodes_of_their_own_are_torn() -> Result<()> {
    let Some((points, place, text)) = torn(model(&[(3, 0.0), (3, 6.0)])?)? else { panic!("quiet") };
    assert_eq!((points, place), (4, [6.0, 0.0]));
    assert!(text.contains("torn at 4 points, first at x = 6.00 m, y = 0.00 m"), "{text}");
    // A node in the middle of a longer side, and its ends twice.
    let found = torn(model(&[(1, 0.0), (2, 6.0)])?)?.map(|(points, place, _)| (points, place));
    assert_eq!(found, Some((3, [6.0, 0.0])));
    // One raft, also with a thicker middle, and two a cell apart.
    let mut mesh = Mesh::in_space();
    add_raft_of(&mut mesh, 3, 0.0, |shell| if shell == 4 { 1.6 } else { 0.8 })?;
    assert_eq!(torn(FemModel::on_base(mesh)?)?, None);
    assert_eq!(torn(model(&[(3, 0.0)])?)?, None);
    assert_eq!(torn(model(&[(3, 0.0), (3, 12.0)])?)?, None);
    Ok(())
}

/// A node on the side of a longer face: free, and tied to the ends of the side.
#[test]
fn a_node_on_a_side_is_tied_or_torn() -> Result<()> {
    let node =
        |place: [f64; 2], k: usize| BaseNode::free_in_plan(place, [3 * k, 3 * k + 1, 3 * k + 2]);
    let places =
        [[0.0, 0.0], [6.0, 0.0], [6.0, 6.0], [0.0, 6.0], [9.0, 0.0], [9.0, 3.0], [9.0, 6.0]];
    let corner = |k: usize| node(places[k], k);
    let free = node([6.0, 3.0], 7);
    let half = |k: usize| -> DofCombination { [(3 + k, 0.5), (6 + k, 0.5)].into() };
    let tied = BaseNode { horizontal: half(0), across: half(1), vertical: half(2), ..free.clone() };
    for (middle, wanted) in [(free, Some((1, [6.0, 3.0]))), (tied, None)] {
        let faces = vec![
            [0, 1, 2, 3].map(corner).to_vec(),
            // In either order of the corners.
            vec![middle.clone(), corner(5), corner(4), corner(1)],
            vec![middle, corner(5), corner(6), corner(2)],
        ];
        let mass = Triplets::from_entries(24, (0..24).map(|k| (k, k, 1e4)));
        // In each direction springs between all nodes.
        let springs = (0..24).flat_map(|i| {
            let same = (0..24).filter(move |j| i % 3 == j % 3);
            same.map(move |j| (i, j, if i == j { 7e9 } else { -1e9 }))
        });
        let stiffness = Triplets::from_entries(24, springs);
        let model = MatrixModel::new(mass, stiffness, Base::Faces(faces))?;
        let found = torn(model)?.map(|(points, place, _)| (points, place));
        assert_eq!(found, wanted);
    }
    Ok(())
}

/// Triangles of a rigid body move with it, wherever their corners lie.
#[test]
fn rigid_faces_are_not_torn() -> Result<()> {
    let face = |corners: &[[f64; 2]]| BaseNode::rigid_face(corners, [0.0; 2], [0, 1, 2, 3, 4, 5]);
    let faces = vec![
        face(&[[-3.0, -2.0], [3.0, -2.0], [3.0, 2.0]]),
        face(&[[-3.0, -2.0], [0.0, 0.0], [-3.0, 2.0]]),
        face(&[[0.0, 0.0], [3.0, 2.0], [-3.0, 2.0]]),
    ];
    let mass = [2e5, 2e5, 2e5, 1e6, 1e6, 1e6].into_iter().enumerate().map(|(k, m)| (k, k, m));
    let mass = Triplets::from_entries(6, mass);
    assert_eq!(torn(MatrixModel::new(mass, Triplets::new(6), Base::Faces(faces))?)?, None);
    Ok(())
}

/// A raft of nine faces on the first seven, on all, and on one face that covers all; a second structure of a group.
#[test]
fn faces_that_a_base_does_not_name_are_counted() -> Result<()> {
    let first_seven = |faces: &[Vec<usize>]| faces[..7].to_vec();
    let all = |faces: &[Vec<usize>]| faces.to_vec();
    let outline =
        |faces: &[Vec<usize>]| vec![vec![faces[0][0], faces[2][1], faces[8][2], faces[6][3]]];
    for (name, wanted) in [
        (&first_seven as &dyn Fn(&[Vec<usize>]) -> Vec<Vec<usize>>, Some((2, [33.0, 5.0]))),
        (&all, None),
        (&outline, None),
    ] {
        let mut mesh = Mesh::in_space();
        let cells = add_raft(&mut mesh, 3, 0.0)?;
        let model = FemModel::on_faces(mesh, &name(&cells))?;
        let group = StructureGroup::new().with(model, 30.0)?;
        let ground = SpringGround::under(&group, 4, 5e7, 4e7)?.with_dashpots(4e5, 3e5)?;
        let builder = Simulation::builder(0.01).ground(ground).structure(group);
        let run = builder.interface(Coulomb::new(0.5)?).build()?.run(1, |_| {})?;
        let found = run.warnings.iter().find_map(|warning| match warning {
            Warning::Mistake(Mistake::FacesOffGround { faces, x, y }) => Some((*faces, [*x, *y])),
            _ => None,
        });
        assert_eq!(found, wanted);
    }
    Ok(())
}

/// Rafts that overlap by 0.5 % of a side, and a raft in two layers.
#[test]
fn overlapping_rafts_are_refused() -> Result<()> {
    for (second, wanted) in [((2, 5.97), 0.09), ((1, 0.0), 9.0)] {
        let structure = model(&[(2, 0.0), second])?;
        let fault = SpringGround::under(&structure, 4, 5e7, 4e7).map(drop);
        let Err(Error::Plan(PlanError::Overlap { faces, area })) = fault else {
            panic!("{fault:?}")
        };
        assert!(faces[0] < faces[1] && (area - wanted).abs() < 1e-9, "{faces:?} {area}");
        // On a ground of one's own, too.
        let ground = SpringGround::under(&model(&[(2, 0.0)])?, 4, 5e7, 4e7)?;
        let builder = Simulation::builder(0.01).ground(ground).structure(structure);
        let fault = builder.interface(Coulomb::new(0.5)?).build().map(drop);
        assert!(matches!(fault, Err(Error::Plan(PlanError::Overlap { .. }))), "{fault:?}");
    }
    let body = || RigidBody::cuboid([6.0, 5.0, 4.0], 2000.0);
    assert!(StructureGroup::new().with(body()?, 0.0)?.with(body()?, 3.0).is_err());
    Ok(())
}

/// The base is the underside of the shells, however it is divided: 0.4 m below the nodes, in a rotation about y.
#[test]
fn an_outline_over_several_shells_is_their_underside() -> Result<()> {
    let mut mesh = Mesh::in_space();
    let cells = add_raft(&mut mesh, 2, 0.0)?;
    let outline = vec![cells[0][0], cells[1][1], cells[3][2], cells[2][3]];
    let corners: Vec<[f64; 3]> = outline.iter().map(|&node| mesh.nodes()[node]).collect();
    assert!(corners.iter().all(|corner| [0.0, 6.0].contains(&corner[0])), "{corners:?}");
    for faces in [cells, vec![outline]] {
        let model = FemModel::on_faces(mesh.clone(), &faces)?;
        let turned = model.rigid_motion(Direction::RotationY, [0.0; 3]);
        for node in model.base().nodes() {
            assert!((node.horizontal.value(&turned) + 0.4).abs() < 1e-12, "{}", faces.len());
        }
    }
    Ok(())
}
