//! GOAL: a base whose parts touch without a connection causes a warning; parts that overlap are errors.
//! SCENE: rafts of shells with two nodes at each point of a joint, and with a node in the middle of a longer side; a raft of
//! free corners by matrices.
//! REFERENCE: points by hand; the same rafts with common nodes, or with the node tied to the ends of the side.

use basemat::bem::{PlanError, SpringGround};
use basemat::coupled::{Mistake, Warning};
use basemat::fem::{Direction, Material, Mesh, Shell};
use basemat::interface::Coulomb;
use basemat::results::Run;
use basemat::structure::{
    Base, BaseNode, DofCombination, FemModel, MatrixModel, RigidBody, Structure, StructureGroup,
    Triplets,
};
use basemat::{Error, Result, Simulation};

/// Side of a raft, m.
const RAFT_SIDE: f64 = 6.0;
/// Thickness of its shells, m.
const SHELL_THICKNESS: f64 = 0.8;

/// Adds a square raft of `count` × `count` shells from (`start`, 0) on; returns their corners.
fn add_raft(mesh: &mut Mesh, count: usize, start: f64) -> Result<Vec<Vec<usize>>> {
    add_raft_with_thickness(mesh, count, start, |_| SHELL_THICKNESS)
}

/// Adds a square raft with a thickness for each shell.
fn add_raft_with_thickness(
    mesh: &mut Mesh,
    count: usize,
    start: f64,
    thickness: impl Fn(usize) -> f64,
) -> Result<Vec<Vec<usize>>> {
    let size = RAFT_SIDE / count as f64;
    let grid = mesh.add_grid(count + 1, count + 1, |row, column| {
        [start + size * column as f64, size * row as f64, 0.0]
    })?;
    let concrete = Material::new(30e9, 0.2, 2500.0)?;
    let cells: Vec<Vec<usize>> = grid.cells().map(|(_, corners)| corners).collect();
    for (shell, corners) in cells.iter().enumerate() {
        mesh.add(Shell::new(corners, concrete, thickness(shell))?)?;
    }
    Ok(cells)
}

/// Springs and dashpots under a structure.
fn spring_bed(structure: &dyn Structure) -> Result<SpringGround> {
    SpringGround::under(structure, 4, 5e7, 4e7)?.with_dashpots(4e5, 3e5)
}

/// A run of one step.
fn single_step(structure: impl Structure + 'static) -> Result<Run> {
    let builder = Simulation::builder(0.01).ground(spring_bed(&structure)?).structure(structure);
    builder.interface(Coulomb::new(0.5)?).build()?.run(1, |_| {})
}

/// Data of the warning of a torn base.
#[derive(Debug, PartialEq)]
struct Tear {
    points: usize,
    /// x and y of the first point, m.
    first_point: [f64; 2],
}

/// The tear of a base, and the text of its warning.
fn tear_and_text(structure: impl Structure + 'static) -> Result<Option<(Tear, String)>> {
    let run = single_step(structure)?;
    let tear_and_text = run.warnings.iter().find_map(|warning| match warning {
        Warning::Mistake(Mistake::TornBase { points, x, y }) => {
            Some((Tear { points: *points, first_point: [*x, *y] }, warning.to_string()))
        }
        _ => None,
    });
    Ok(tear_and_text)
}

fn tear(structure: impl Structure + 'static) -> Result<Option<Tear>> {
    Ok(tear_and_text(structure)?.map(|(tear, _)| tear))
}

/// Rafts, each with a number of shells along a side and a start along x.
fn model(rafts: &[(usize, f64)]) -> Result<FemModel> {
    let mut mesh = Mesh::in_space();
    for (count, start) in rafts {
        add_raft(&mut mesh, *count, *start)?;
    }
    FemModel::on_base(mesh)
}

#[test]
fn rafts_side_by_side_with_separate_nodes_are_torn() -> Result<()> {
    let Some((first_tear, text)) = tear_and_text(model(&[(3, 0.0), (3, 6.0)])?)? else {
        panic!("no warning")
    };
    assert_eq!(first_tear, Tear { points: 4, first_point: [6.0, 0.0] });
    assert!(text.contains("torn at 4 points, first at x = 6.00 m, y = 0.00 m"), "{text}");
    // A node in the middle of a longer side, and its ends twice.
    let hanging_node = tear(model(&[(1, 0.0), (2, 6.0)])?)?;
    assert_eq!(hanging_node, Some(Tear { points: 3, first_point: [6.0, 0.0] }));
    // One raft, also with a thicker middle, and two a cell apart.
    let mut mesh = Mesh::in_space();
    add_raft_with_thickness(
        &mut mesh,
        3,
        0.0,
        |shell| if shell == 4 { 1.6 } else { SHELL_THICKNESS },
    )?;
    assert_eq!(tear(FemModel::on_base(mesh)?)?, None);
    assert_eq!(tear(model(&[(3, 0.0)])?)?, None);
    assert_eq!(tear(model(&[(3, 0.0), (3, 12.0)])?)?, None);
    Ok(())
}

/// A base node whose three degrees of freedom are free.
fn free_node(place: [f64; 2], node: usize) -> BaseNode {
    BaseNode::free_in_plan(place, [3 * node, 3 * node + 1, 3 * node + 2])
}

/// Mean motion of nodes 1 and 2 in a direction.
fn mean_of_ends(direction: usize) -> DofCombination {
    [(3 + direction, 0.5), (6 + direction, 0.5)].into()
}

/// A node on the side of a longer face: free, and tied to the ends of the side.
#[test]
fn a_node_on_a_side_is_tied_or_torn() -> Result<()> {
    let places =
        [[0.0, 0.0], [6.0, 0.0], [6.0, 6.0], [0.0, 6.0], [9.0, 0.0], [9.0, 3.0], [9.0, 6.0]];
    let corners: [BaseNode; 7] = std::array::from_fn(|k| free_node(places[k], k));
    let free_node_on_side = free_node([6.0, 3.0], 7);
    let tied_node = BaseNode {
        horizontal: mean_of_ends(0),
        across: mean_of_ends(1),
        vertical: mean_of_ends(2),
        ..free_node_on_side.clone()
    };
    for (middle, expected) in
        [(free_node_on_side, Some(Tear { points: 1, first_point: [6.0, 3.0] })), (tied_node, None)]
    {
        let faces = vec![
            corners[..4].to_vec(),
            // In either order of the corners.
            vec![middle.clone(), corners[5].clone(), corners[4].clone(), corners[1].clone()],
            vec![middle, corners[5].clone(), corners[6].clone(), corners[2].clone()],
        ];
        let mass = Triplets::from_entries(24, (0..24).map(|k| (k, k, 1e4)));
        // In each direction springs between all nodes.
        let springs = (0..24).flat_map(|i| {
            let same_direction = (0..24).filter(move |j| i % 3 == j % 3);
            same_direction.map(move |j| (i, j, if i == j { 7e9 } else { -1e9 }))
        });
        let stiffness = Triplets::from_entries(24, springs);
        let model = MatrixModel::new(mass, stiffness, Base::Faces(faces))?;
        assert_eq!(tear(model)?, expected);
    }
    Ok(())
}

fn rigid_face(corners: &[[f64; 2]]) -> Vec<BaseNode> {
    BaseNode::rigid_face(corners, [0.0; 2], [0, 1, 2, 3, 4, 5])
}

/// Triangles of a rigid body move with it, wherever their corners lie.
#[test]
fn rigid_faces_are_not_torn() -> Result<()> {
    let faces = vec![
        rigid_face(&[[-3.0, -2.0], [3.0, -2.0], [3.0, 2.0]]),
        rigid_face(&[[-3.0, -2.0], [0.0, 0.0], [-3.0, 2.0]]),
        rigid_face(&[[0.0, 0.0], [3.0, 2.0], [-3.0, 2.0]]),
    ];
    let mass = [2e5, 2e5, 2e5, 1e6, 1e6, 1e6].into_iter().enumerate().map(|(k, m)| (k, k, m));
    let mass = Triplets::from_entries(6, mass);
    assert_eq!(tear(MatrixModel::new(mass, Triplets::new(6), Base::Faces(faces))?)?, None);
    Ok(())
}

/// Number of faces of a base that the ground does not support, and the place of the first.
fn unsupported_faces(run: &Run) -> Option<(usize, [f64; 2])> {
    run.warnings.iter().find_map(|warning| match warning {
        Warning::Mistake(Mistake::FacesOffGround { faces, x, y }) => Some((*faces, [*x, *y])),
        _ => None,
    })
}

/// A raft of nine shells in a group, whose base is the first seven, all, or one face that covers all.
#[test]
fn faces_without_ground_are_counted() -> Result<()> {
    let mut mesh = Mesh::in_space();
    let cells = add_raft(&mut mesh, 3, 0.0)?;
    let first_seven = cells[..7].to_vec();
    let outline = vec![vec![cells[0][0], cells[2][1], cells[8][2], cells[6][3]]];
    for (faces, expected) in [(first_seven, Some((2, [33.0, 5.0]))), (cells, None), (outline, None)]
    {
        let model = FemModel::on_faces(mesh.clone(), &faces)?;
        let run = single_step(StructureGroup::new().with(model, 30.0)?)?;
        assert_eq!(unsupported_faces(&run), expected);
    }
    Ok(())
}

/// Rafts that overlap by 0.5 % of a side, and a raft in two layers.
#[test]
fn overlapping_rafts_are_errors() -> Result<()> {
    for (second_raft, expected_area) in [((2, 5.97), 0.09), ((1, 0.0), 9.0)] {
        let structure = model(&[(2, 0.0), second_raft])?;
        let result = SpringGround::under(&structure, 4, 5e7, 4e7).map(drop);
        let Err(Error::Plan(PlanError::Overlap { faces, area })) = result else {
            panic!("{result:?}")
        };
        assert!(faces[0] < faces[1] && (area - expected_area).abs() < 1e-9, "{faces:?} {area}");
        // Also on a ground for another base.
        let ground = SpringGround::under(&model(&[(2, 0.0)])?, 4, 5e7, 4e7)?;
        let builder = Simulation::builder(0.01).ground(ground).structure(structure);
        let result = builder.interface(Coulomb::new(0.5)?).build().map(drop);
        assert!(matches!(result, Err(Error::Plan(PlanError::Overlap { .. }))), "{result:?}");
    }
    let body = RigidBody::cuboid([6.0, 5.0, 4.0], 2000.0)?;
    assert!(StructureGroup::new().with(body.clone(), 0.0)?.with(body, 3.0).is_err());
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
        let rotation = model.rigid_motion(Direction::RotationY, [0.0; 3]);
        for node in model.base().nodes() {
            assert!((node.horizontal.value(&rotation) + 0.4).abs() < 1e-12, "{}", faces.len());
        }
    }
    Ok(())
}
