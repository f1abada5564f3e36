//! GOAL: meshes in space from Gmsh become the beams, shells and bricks of their groups, or are an error.
//! SCENE: a file written by Gmsh 4.15 (`tests/data/gmsh/space.py`): a block of bricks, a wall of quadrilaterals around
//! triangles, a column and a beam; a brick, a shell and a line by hand; damaged files.
//! REFERENCE: volumes and lengths, uniform strains of solids and plates, bending of a column; typed errors.

use basemat::fem::{BeamSection, Element, MassKind, Material, Mesh};
use basemat::io::{GmshPart, GmshSpaceMesh};
use basemat::{Error, FileError, FileFault};
use basemat_problems::faults::value;
use proptest::prelude::*;

fn concrete() -> Material {
    Material::new(30.0e9, 0.2, 2500.0).unwrap()
}

/// Section whose I_z, about the axis across the orientation, is twice I_y.
fn section() -> BeamSection {
    BeamSection::new(0.2, [0.002, 0.004], 0.003).unwrap()
}

fn soft() -> Material {
    Material::new(1.0e9, 0.3, 2000.0).unwrap()
}

const Z_AXIS: [f64; 3] = [0.0, 0.0, 1.0];
const X_AXIS: [f64; 3] = [1.0, 0.0, 0.0];

fn parts() -> [(&'static str, GmshPart); 4] {
    [
        ("block", GmshPart::Solid(soft())),
        ("wall", GmshPart::Shell(concrete(), 0.25)),
        ("column", GmshPart::Beam(concrete(), section(), X_AXIS)),
        ("beam", GmshPart::Beam(concrete(), section(), Z_AXIS)),
    ]
}

fn file() -> GmshSpaceMesh {
    GmshSpaceMesh::read(basemat_problems::data_path("gmsh/space.msh")).unwrap()
}

/// Elements with these numbers of nodes.
fn elements<'a>(mesh: &'a Mesh, nodes: &'a [usize]) -> impl Iterator<Item = &'a dyn Element> {
    mesh.elements().filter(|element| nodes.contains(&element.nodes().len()))
}

/// Forces and moments at all nodes, and their work on the displacements that cause them.
struct ElementForces {
    nodal: Vec<[f64; 6]>,
    work: f64,
}

/// Forces of the elements for a `displacement` of each point.
fn forces<'a>(
    mesh: &Mesh,
    elements: impl Iterator<Item = &'a dyn Element>,
    displacement: impl Fn([f64; 3]) -> [f64; 6],
) -> ElementForces {
    let mut nodal = vec![[0.0; 6]; mesh.nodes().len()];
    let mut work = 0.0;
    for element in elements {
        let points: Vec<_> = element.nodes().iter().map(|&node| mesh.nodes()[node]).collect();
        let node_dofs = element.directions().len();
        let displacements: Vec<f64> =
            points.iter().flat_map(|&point| displacement(point)[..node_dofs].to_vec()).collect();
        let mut matrix = vec![0.0; displacements.len() * displacements.len()];
        element.stiffness(&points, &mut matrix);
        for (k, row) in matrix.chunks(displacements.len()).enumerate() {
            let force: f64 = row.iter().zip(&displacements).map(|(a, b)| a * b).sum();
            nodal[element.nodes()[k / node_dofs]][k % node_dofs] += force;
            work += force * displacements[k];
        }
    }
    ElementForces { nodal, work }
}

#[test]
fn groups_are_those_of_the_file() {
    let gmsh = file();
    let names = [0, 1, 2, 3].map(|dimension| gmsh.groups(dimension));
    let expected =
        [&["head"][..], &["beam", "column", "edge"][..], &["base", "wall"][..], &["block"][..]];
    assert_eq!(names, expected);
    let head = gmsh.cells(0, "head").unwrap();
    assert_eq!(gmsh.nodes()[head[0][0]], [4.0, 0.0, 3.0]);
    let base = gmsh.cells(2, "base").unwrap();
    assert!(base.len() == 16 && base.iter().flatten().all(|&node| gmsh.nodes()[node][2] == -0.8));
    let mesh = gmsh.mesh(&parts()).unwrap();
    assert_eq!(mesh.nodes(), gmsh.nodes());
    let counts = [2, 3, 4, 8].map(|nodes| elements(&mesh, &[nodes]).count());
    assert_eq!(counts, [5, 32, 32, 32]);
    // The base is the lower side of the bricks.
    let sides: Vec<Vec<usize>> = mesh
        .elements()
        .flat_map(Element::faces)
        .map(|face| {
            let mut corners = face.corners().to_vec();
            corners.sort_unstable();
            corners
        })
        .collect();
    for mut face in base {
        face.sort_unstable();
        assert!(sides.contains(&face));
    }
}

#[test]
fn masses_are_volumes_times_densities() {
    let mesh = file().mesh(&parts()).unwrap();
    for (nodes, expected) in [
        (&[8][..], 2000.0 * 4.0 * 3.0 * 0.8),
        (&[3, 4], 2500.0 * 3.0 * 3.0 * 0.25),
        (&[2], 2500.0 * 0.2 * (3.0 + 4.0)),
    ] {
        let mut found = 0.0;
        for element in elements(&mesh, nodes) {
            let points: Vec<_> = element.nodes().iter().map(|&node| mesh.nodes()[node]).collect();
            let order = element.order();
            let mut matrix = vec![0.0; order * order];
            element.mass(&points, MassKind::Lumped, &mut matrix);
            let node_dofs = element.directions().len();
            found += (0..points.len()).map(|k| matrix[(k * node_dofs) * (order + 1)]).sum::<f64>();
        }
        assert!((found / expected - 1.0).abs() < 1e-12, "{nodes:?}: {found}, not {expected}");
    }
}

/// Whether a point is within the block, not on its surface.
fn is_inside_block([x, y, z]: [f64; 3]) -> bool {
    x > 0.01 && x < 3.99 && y > 0.01 && y < 2.99 && z > -0.79 && z < -0.01
}

/// Under a uniform strain the block of unstructured bricks has the exact energy, and no force inside.
#[test]
fn bricks_pass_the_patch_test() {
    let mesh = file().mesh(&parts()).unwrap();
    let ElementForces { nodal, work } =
        forces(&mesh, elements(&mesh, &[8]), |[x, ..]| [1e-3 * x, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let modulus = 1.0e9 * 0.7 / (1.3 * 0.4);
    let expected = modulus * 1e-6 * 4.0 * 3.0 * 0.8;
    assert!((work / expected - 1.0).abs() < 1e-12, "{work} {expected}");
    let mut count = 0;
    for (_, force) in mesh.nodes().iter().zip(&nodal).filter(|(point, _)| is_inside_block(**point))
    {
        count += 1;
        assert!(force.iter().all(|force| force.abs() < 1e-9 * modulus * 1e-3), "{force:?}");
    }
    assert!(count >= 4, "{count}");
}

/// A uniform membrane strain of the wall: triangles are matched to the quadrilaterals around them, or a quarter of the
/// stress would be lost in moments at the corners of the panel.
#[test]
fn triangles_and_quadrilaterals_of_a_wall_pass_the_patch_test_together() {
    let mesh = file().mesh(&parts()).unwrap();
    let ElementForces { nodal, work } =
        forces(&mesh, elements(&mesh, &[3, 4]), |[_, y, z]: [f64; 3]| {
            // The rotation of the wall about x is ½(∂u_z/∂y − ∂u_y/∂z).
            [0.0, 1e-3 * y + 4e-4 * z, -2e-4 * y + 5e-4 * z, 0.5 * (-2e-4 - 4e-4), 0.0, 0.0]
        });
    let e = 30.0e9;
    let nu = 0.2;
    let a: f64 = 1e-3;
    let b: f64 = 5e-4;
    let shear: f64 = 4e-4 - 2e-4;
    let density =
        e / (1.0 - nu * nu) * (a * a + b * b + 2.0 * nu * a * b + 0.5 * (1.0 - nu) * shear * shear);
    let expected = density * 9.0 * 0.25;
    assert!((work / expected - 1.0).abs() < 1e-12, "{work} {expected}");
    let scale = e * 1e-3 * 0.25;
    for (_, force) in mesh
        .nodes()
        .iter()
        .zip(&nodal)
        .filter(|([x, y, z], _)| *x == 0.0 && *y > 0.01 && *y < 2.99 && *z > 0.01 && *z < 2.99)
    {
        assert!(force.iter().all(|force| force.abs() < 1e-9 * scale), "{force:?}");
    }
}

/// The column, bent like a cantilever, has the stiffness 3EI/L³ of its section across and along the orientation.
#[test]
fn beams_have_their_section_and_orientation() {
    let gmsh = file();
    let column = gmsh.cells(1, "column").unwrap();
    let mesh = gmsh.mesh(&parts()).unwrap();
    let column_elements: Vec<&dyn Element> = mesh
        .elements()
        .filter(|element| column.iter().any(|line| line == element.nodes()))
        .collect();
    assert_eq!(column_elements.len(), 3);
    for (axis, moment) in [(0, 0.004), (1, 0.002)] {
        let bent_forces = forces(&mesh, column_elements.iter().copied(), |[_, _, z]| {
            let deflection = z * z * (9.0 - z) / 54.0;
            let slope = z * (6.0 - z) / 18.0;
            let mut displacement = [0.0; 6];
            displacement[axis] = deflection;
            displacement[4 - axis] = if axis == 0 { slope } else { -slope };
            displacement
        });
        let work = bent_forces.work;
        let expected = 3.0 * 30.0e9 * moment / 27.0;
        assert!((work / expected - 1.0).abs() < 1e-12, "{axis}: {work} {expected}");
    }
}

/// A brick, a shell on its upper face, a line over it, and a line of the geometry on an edge.
const BRICK_FILE: &str = "$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
4
1 1 \"mast\"
1 2 \"edge\"
2 3 \"slab\"
3 4 \"block\"
$EndPhysicalNames
$Entities
0 2 1 1
1 0 0 1 0 0 3 1 1 0
2 0 0 0 2 0 0 1 2 0
1 0 0 1 2 2 1 1 3 0
1 0 0 0 2 2 1 1 4 0
$EndEntities
$Nodes
1 9 1 9
3 1 0 9
1
2
3
4
5
6
7
8
9
0 0 0
2 0 0
2 2 0
0 2 0
0 0 1
2 0 1
2 2 1
0 2 1
0 0 3
$EndNodes
$Elements
4 4 1 4
1 1 1 1
1 5 9
1 2 1 1
2 1 2
2 1 3 1
3 5 6 7 8
3 1 5 1
4 1 2 3 4 5 6 7 8
$EndElements
";

fn brick_parts() -> [(&'static str, GmshPart); 3] {
    [
        ("mast", GmshPart::Beam(concrete(), section(), X_AXIS)),
        ("slab", GmshPart::Shell(concrete(), 0.2)),
        ("block", GmshPart::Solid(concrete())),
    ]
}

fn read(text: &str) -> basemat::Result<GmshSpaceMesh> {
    GmshSpaceMesh::from_reader("test.msh", text.as_bytes())
}

fn fault<T: std::fmt::Debug>(result: basemat::Result<T>) -> (usize, FileFault) {
    match result {
        Err(Error::File(FileError { file, line, fault })) if file == "test.msh" => (line, fault),
        other => panic!("{other:?}"),
    }
}

/// Line and text of the error of a part of a mesh.
struct PartError {
    line: usize,
    text: String,
}

/// Error of the mesh of `text` with these parts.
fn read_error(text: &str, parts: &[(&str, GmshPart)]) -> PartError {
    let (line, fault) = fault(read(text).unwrap().mesh(parts));
    PartError { line, text: fault.to_string() }
}

#[test]
fn inverted_bricks_are_reordered() {
    let mesh = read(BRICK_FILE).unwrap().mesh(&brick_parts()).unwrap();
    let inverted_brick = BRICK_FILE.replacen("4 1 2 3 4 5 6 7 8", "4 5 6 7 8 1 2 3 4", 1);
    let reordered_mesh = read(&inverted_brick).unwrap().mesh(&brick_parts()).unwrap();
    let last_nodes = mesh.elements().last().unwrap().nodes();
    assert_eq!(last_nodes, [0, 1, 2, 3, 4, 5, 6, 7]);
    assert_eq!(reordered_mesh.elements().last().unwrap().nodes(), last_nodes);
}

#[test]
fn elements_need_one_part_unless_they_are_sides() {
    // The line on the edge needs no part.
    assert_eq!(read(BRICK_FILE).unwrap().mesh(&brick_parts()).unwrap().elements().len(), 3);
    let PartError { line, text } = read_error(BRICK_FILE, &brick_parts()[1..]);
    assert!(line == 43 && text.contains("part for line 1 of the group 'mast'"), "{line} {text}");
    let left_out = [&brick_parts()[1..], &[("mast", GmshPart::LeftOut)]].concat();
    assert_eq!(read(BRICK_FILE).unwrap().mesh(&left_out).unwrap().elements().len(), 2);
    // The slab is a face of the brick.
    let without_slab = [brick_parts()[0], brick_parts()[2]];
    assert_eq!(read(BRICK_FILE).unwrap().mesh(&without_slab).unwrap().elements().len(), 2);
    let PartError { line, text } = read_error(BRICK_FILE, &brick_parts()[..2]);
    assert!(line == 49 && text.contains("brick 4 of the group 'block'"), "{line} {text}");
    let two_groups = BRICK_FILE.replacen("2 2 1 1 3 0", "2 2 1 2 3 9 0", 1);
    let two = [&brick_parts()[..], &[("9", GmshPart::Shell(soft(), 0.1))]].concat();
    let PartError { line, text } = read_error(&two_groups, &two);
    assert!(line == 47 && text.contains("quadrilateral 3, in 'slab' and '9',"), "{text}");
    let text = read_error(BRICK_FILE, &[&brick_parts()[..], &brick_parts()[..1]].concat()).text;
    assert!(text.contains("part of group 'mast' is given twice"), "{text}");
    let text = read_error(BRICK_FILE, &[("mast", GmshPart::Shell(concrete(), 0.2))]).text;
    assert!(text.contains("there is no surface 'mast'"), "{text}");
    let reason = fault(read(BRICK_FILE).unwrap().cells(3, "slab")).1;
    assert!(reason.to_string().contains("volume 'slab'"));
}

#[test]
fn invalid_elements_are_named_with_their_line() {
    let along = [
        brick_parts()[1],
        brick_parts()[2],
        ("mast", GmshPart::Beam(concrete(), section(), Z_AXIS)),
    ];
    let PartError { line, text } = read_error(BRICK_FILE, &along);
    assert!(line == 43 && text.starts_with("element 1: beam between nodes 4 and 8"), "{text}");
    let crossed_text = BRICK_FILE.replacen("3 5 6 7 8", "3 5 7 6 8", 1);
    let PartError { line, text } = read_error(&crossed_text, &brick_parts());
    assert!(line == 47 && text.starts_with("element 3: shell"), "{text}");
    let flat_text = BRICK_FILE.replacen("0 0 1\n", "0 0 -1\n", 1);
    let PartError { line, text } = read_error(&flat_text, &brick_parts());
    assert!(line == 49 && text.starts_with("element 4: brick"), "{text}");
    let thin_parts =
        [brick_parts()[0], brick_parts()[2], ("slab", GmshPart::Shell(concrete(), 0.0))];
    let PartError { line, text } = read_error(BRICK_FILE, &thin_parts);
    assert!(line == 47 && text.contains("thickness of a shell is 0"), "{text}");
    let repeated_text =
        BRICK_FILE.replacen("2 1 3 1\n3 5 6 7 8", "2 1 3 2\n3 5 6 7 8\n9 7 8 5 6", 1);
    let fault_of_twin = value("quadrilateral of nodes 7 8 5 6", "given twice", "given once");
    assert_eq!(fault(read(&repeated_text.replacen("4 4 1 4", "4 5 1 9", 1))), (48, fault_of_twin));
}

#[test]
fn unsupported_elements_are_named_and_counted() {
    let kinds = [
        (4, "12 tetrahedra (type 4)", "extruded layers, recombined)"),
        (7, "12 pyramids (type 7)", "extruded layers, recombined)"),
        (9, "12 triangles of 6 nodes (type 9)", "Mesh.ElementOrder = 1"),
        (17, "12 bricks of 20 nodes (type 17)", "Mesh.ElementOrder = 1"),
        (92, "12 elements (type 92)", "of the first order"),
    ];
    for (kind, name, remedy) in kinds {
        let text = BRICK_FILE.replacen("3 1 5 1\n", &format!("3 1 {kind} 12\n"), 1);
        let error = fault(read(&text));
        let FileFault::Format { found, needed } = error.1 else { panic!() };
        assert_eq!((error.0, &found[..]), (48, name));
        assert!(needed.ends_with(remedy), "{needed}");
    }
}

/// The brick's file with a point above it that belongs to `groups`.
fn brick_with_point(groups: &str) -> GmshSpaceMesh {
    let text = BRICK_FILE.replacen("0 2 1 1\n", &format!("1 2 1 1\n1 0 0 -9 {groups}\n"), 1);
    let text = text.replacen("1 9 1 9\n3 1 0 9", "1 10 1 10\n3 1 0 10\n99", 1);
    let text = text.replacen("0 0 0\n", "0 0 -9\n0 0 0\n", 1);
    read(&text.replacen("4 4 1 4\n", "5 5 1 5\n0 1 15 1\n5 99\n", 1)).unwrap()
}

/// Points without a group, such as centres of arcs, are left out; points of a group are nodes.
#[test]
fn points_of_groups_are_nodes() {
    assert_eq!(brick_with_point("0").nodes(), read(BRICK_FILE).unwrap().nodes());
    let pointed_mesh = brick_with_point("1 6");
    assert_eq!(pointed_mesh.nodes()[pointed_mesh.cells(0, "6").unwrap()[0][0]], [0.0, 0.0, -9.0]);
    assert!(pointed_mesh.mesh(&brick_parts()).is_ok());
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_damage_is_an_error_or_a_mesh(place in 0..BRICK_FILE.len(), byte: u8, keep in 0..BRICK_FILE.len()) {
        let mut bytes = BRICK_FILE.as_bytes().to_vec();
        bytes[place] = byte;
        for bytes in [&bytes[..], &bytes[..keep]] {
            if let Ok(gmsh) = GmshSpaceMesh::from_reader("damaged", bytes) {
                let _ = gmsh.mesh(&brick_parts());
                let _ = gmsh.cells(2, "slab");
            }
        }
    }
}
