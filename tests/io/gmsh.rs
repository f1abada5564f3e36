//! GOAL: meshes from Gmsh are read, or cause an error with its line.
//! SCENE: the example of Gmsh's manual, partitions, second-order elements, damaged files, any
//! bytes.
//! REFERENCE: a layered block written and read back; typed errors.

use std::fmt::Write;

use basemat::fem::{Layer, Material, Mesh};
use basemat::io::GmshMesh;
use basemat::structure::{FemModel, Structure};
use basemat::{Error, FileError, FileFault};
use basemat_problems::faults::{count, not_a_number, value};
use proptest::prelude::*;

use basemat_problems::dense;

pub(super) fn concrete() -> Material {
    Material::new(30.0e9, 0.2, 2400.0).unwrap()
}

pub(super) fn read(text: &str) -> basemat::Result<GmshMesh> {
    GmshMesh::from_reader("test.msh", text.as_bytes())
}

/// The example of the Gmsh reference manual, "MSH file format", version 4.1, comments left out.
pub(super) const MANUAL_EXAMPLE: &str = "$MeshFormat
4.1 0 8
$EndMeshFormat
$Nodes
1 6 1 6
2 1 0 6
1
2
3
4
5
6
0. 0. 0.
1. 0. 0.
1. 1. 0.
0. 1. 0.
2. 0. 0.
2. 1. 0.
$EndNodes
$Elements
1 2 1 2
2 1 3 2
1 1 2 3 4
2 2 5 6 3
$EndElements
$NodeData
1
\"A scalar view\"
1
0.0
3
0
1
6
1 0.0
2 0.1
3 0.2
4 0.0
5 0.2
6 0.4
$EndNodeData
";

#[test]
fn the_example_of_the_manual_is_read() {
    let gmsh = read(MANUAL_EXAMPLE).unwrap();
    assert_eq!((gmsh.surfaces(), gmsh.lines().len()), (vec![""], 0));
    let mesh = gmsh.mesh(&[("", concrete())]).unwrap();
    assert_eq!(mesh.nodes()[4], [2.0, 0.0, 0.0]);
    let nodes: Vec<_> = mesh.elements().map(|quad| quad.nodes().to_vec()).collect();
    assert_eq!(nodes, [[0, 1, 2, 3], [1, 4, 5, 2]]);
}

/// Tag of a node in the written file; the tags have gaps.
fn node_tag(node: usize) -> usize {
    10 + 3 * node
}

/// Text of a block in two materials as Gmsh would write it: tags with gaps, points and lines of the geometry,
/// nodes by entity, some quadrilaterals clockwise, parametric coordinates on the line.
fn gmsh_text(mesh: &Mesh, lower: usize, contact: &[usize]) -> String {
    let mut text = String::from("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
    text +=
        "$PhysicalNames\n3\n1 1 \"base\"\n2 2 \"lower part\"\n2 3 \"upper\"\n$EndPhysicalNames\n";
    text += "$Entities\n1 1 2 0\n1 0 0 0 0\n7 0 0 0 1 0 0 1 -1 2 1 -2\n";
    text += "1 0 0 0 1 1 0 1 2 1 7\n2 0 1 0 1 2 0 2 3 9 0\n$EndEntities\n";
    let count = mesh.nodes().len();
    let on_line = contact.len();
    let _ = write!(text, "$Nodes\n2 {count} 10 {}\n1 7 1 {on_line}\n", node_tag(count));
    for &node in contact {
        let _ = writeln!(text, "{}", node_tag(node));
    }
    for &node in contact {
        let place = mesh.nodes()[node];
        let _ = writeln!(text, "{:e} {:e} 0 {}", place[0], place[1], place[0]);
    }
    let _ = writeln!(text, "2 1 0 {}", count - on_line);
    let other_nodes: Vec<usize> = (0..count).filter(|node| !contact.contains(node)).collect();
    for &node in &other_nodes {
        let _ = writeln!(text, "{}", node_tag(node));
    }
    for &node in &other_nodes {
        let place = mesh.nodes()[node];
        let _ = writeln!(text, "{} {} 0", place[0], place[1]);
    }
    let quads = mesh.elements().len();
    let _ = write!(text, "$EndNodes\n$Elements\n4 {} 1 {}\n", quads + on_line, quads + on_line);
    let _ = write!(text, "0 1 15 1\n900 {}\n1 7 1 {}\n", node_tag(0), on_line - 1);
    for (k, pair) in contact.windows(2).enumerate() {
        let _ = writeln!(text, "{} {} {}", 500 + k, node_tag(pair[0]), node_tag(pair[1]));
    }
    for (entity, range) in [(1, 0..lower), (2, lower..quads)] {
        let _ = writeln!(text, "2 {entity} 3 {}", range.len());
        for k in range {
            let mut nodes = mesh.elements().nth(k).unwrap().nodes().to_vec();
            if k % 2 == 1 {
                nodes.reverse();
            }
            let tags: Vec<String> = nodes.iter().map(|&node| node_tag(node).to_string()).collect();
            let _ = writeln!(text, "{} {}", 700 + k, tags.join(" "));
        }
    }
    text + "$EndElements\n"
}

fn matrices(model: &FemModel) -> [Vec<f64>; 2] {
    [dense::mass(model).concat(), dense::stiffness(model).concat()]
}

#[test]
fn a_written_block_is_read_back() {
    let soft_material = Material::new(1.0e9, 0.3, 1800.0).unwrap();
    let layers = [Layer::new(1.0, 2, soft_material), Layer::new(1.0, 1, concrete())];
    let mesh = Mesh::graded_block(&[0.0, 0.3, 0.7, 1.0], &layers).unwrap();
    let model = FemModel::on_base(mesh).unwrap();
    let text = gmsh_text(model.mesh(), 6, &[0, 1, 2, 3]);
    let gmsh = read(&text).unwrap();
    // The upper surface is in an unnamed group of number 9 as well.
    assert_eq!(gmsh.surfaces(), ["9", "lower part", "upper"]);
    assert_eq!(gmsh.lines(), ["base"]);
    let read_mesh = gmsh.mesh(&[("upper", concrete()), ("lower part", soft_material)]).unwrap();
    assert_eq!(read_mesh.nodes(), model.mesh().nodes());
    let read_model = FemModel::new(read_mesh, &gmsh.line("base").unwrap()).unwrap();
    assert_eq!(read_model.base(), model.base());
    for (computed, expected) in matrices(&read_model).iter().zip(matrices(&model)) {
        let scale = expected.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        // Reordered quadrilaterals sum in another order.
        assert!(computed.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-14 * scale));
    }
}

/// Line and cause of the error of `text`.
pub(super) fn read_error(text: &str) -> (usize, FileFault) {
    match read(text) {
        Err(Error::File(FileError { file, line, fault })) if file == "test.msh" => (line, fault),
        other => panic!("{other:?}"),
    }
}

/// Line and cause of the error of the manual's example with `from` replaced by `to`.
fn error_with(from: &str, to: &str) -> (usize, FileFault) {
    read_error(&MANUAL_EXAMPLE.replacen(from, to, 1))
}

#[test]
fn invalid_files_are_errors_with_their_line() {
    assert!(matches!(error_with("4.1 0 8", "4.0 0 8"), (2, FileFault::Format { .. })));
    assert!(matches!(error_with("4.1 0 8", "4.1 1 8"), (2, FileFault::Missing { .. })));
    assert!(matches!(error_with("4.1 0 8", "4.1 1 4"), (2, FileFault::Format { .. })));
    assert!(matches!(error_with("2 1 3 2", "2 1 2 2"), (22, FileFault::Format { .. })));
    assert_eq!(error_with("0. 1. 0.", "0. 1. 0.5"), (16, value("z of a node", "0.5", "0")));
    assert_eq!(error_with("1. 1. 0.", "1. x 0."), (15, not_a_number("x")));
    assert_eq!(error_with("1. 1. 0.", "1. nan 0."), (15, not_a_number("nan")));
    assert!(matches!(error_with("2 2 5 6 3", "2 2 5 7 3"), (24, FileFault::Missing { .. })));
    assert_eq!(error_with("\n6\n", "\n5\n"), (12, value("node 5", "given twice", "given once")));
    assert!(matches!(error_with("$EndNodes", "$EndElements"), (19, FileFault::Missing { .. })));
    let missing_section = value("field", "'Elements'", "the beginning of a section");
    assert_eq!(error_with("$Elements", "Elements"), (20, missing_section));
    assert!(matches!(read_error(""), (0, FileFault::Missing { .. })));
    let long_line = value("length of the line", "65536 bytes or more", "less");
    assert_eq!(read_error(&"1".repeat(100_000)), (1, long_line));
    let truncated_text = read_error(&MANUAL_EXAMPLE[..MANUAL_EXAMPLE.find("2 2 5 6 3").unwrap()]);
    assert!(matches!(truncated_text, (24, FileFault::Missing { .. })), "{truncated_text:?}");
    let Err(Error::File(error)) = GmshMesh::read("no such file") else {
        panic!("there is a file")
    };
    assert!(error.line == 0 && matches!(error.fault, FileFault::Unreadable(_)), "{error}");
}

/// Editors may write a byte-order mark before the first line; anywhere else it is not a number.
#[test]
fn a_byte_order_mark_is_skipped() {
    let text_with_mark = format!("\u{feff}{MANUAL_EXAMPLE}");
    assert_eq!(read(&text_with_mark).unwrap(), read(MANUAL_EXAMPLE).unwrap());
    // Line numbers are those of the text without the mark.
    assert_eq!(
        read_error(&text_with_mark.replacen("1. 1. 0.", "1. x 0.", 1)),
        (15, not_a_number("x"))
    );
    assert_eq!(error_with("1. 1. 0.", "\u{feff}1. 1. 0.").0, 15);
}

/// The manual's example with `x` as the coordinate of its fifth node.
fn manual_with_coordinate(x: &str) -> String {
    MANUAL_EXAMPLE.replacen("2. 0. 0.", &format!("{x} 0. 0."), 1)
}

#[test]
fn numbers_are_read_completely_or_are_errors() {
    for two in ["2", "2.", "+2.0", "0.2e1", "2D0", "2.0d+00", ".2E+1"] {
        assert_eq!(
            read(&manual_with_coordinate(two)).unwrap(),
            read(MANUAL_EXAMPLE).unwrap(),
            "{two}"
        );
    }
    for invalid_number in
        ["2,0", "2.0m", "2D", "0x2", "2_0", "1e999", "inf", "\u{2212}2", "2;", "**", "2/1"]
    {
        assert_eq!(
            read_error(&manual_with_coordinate(invalid_number)),
            (17, not_a_number(invalid_number))
        );
    }
}

/// A group of any number that fits into the file's integers has a name.
#[test]
fn groups_of_any_number_are_read() {
    let entities =
        format!("$Entities\n0 0 1 0\n1 0 0 0 2 1 0 1 {} 0\n$EndEntities\n$Nodes", i64::MIN);
    let gmsh = read(&MANUAL_EXAMPLE.replacen("$Nodes", &entities, 1)).unwrap();
    assert_eq!(gmsh.surfaces(), [i64::MAX.to_string()]);
}

#[test]
fn missing_groups_are_named() {
    let gmsh = read(MANUAL_EXAMPLE).unwrap();
    for materials in [&[][..], &[("", concrete()), ("roof", concrete())]] {
        let error = gmsh.mesh(materials).unwrap_err();
        let Error::File(error) = error else { panic!("{error}") };
        assert!(matches!(error.fault, FileFault::Missing { .. }), "{error}");
    }
    assert!(gmsh.line("base").unwrap_err().to_string().contains("there is no line 'base'"));
    // A quadrilateral that crosses itself has an area of neither sign.
    let crossed_text = MANUAL_EXAMPLE.replacen("1 1 2 3 4", "1 1 3 2 4", 1);
    let crossed_mesh = read(&crossed_text).unwrap();
    let error = crossed_mesh.mesh(&[("", concrete())]).unwrap_err();
    let Error::File(FileError { line, fault, .. }) = &error else {
        panic!("{error}")
    };
    let FileFault::Unusable(inside) = fault else { panic!("{error}") };
    assert!(matches!(&**inside, Error::Item { item, .. } if item == "element 1"), "{error}");
    let wrong_line = crossed_text.lines().nth(line - 1).unwrap();
    assert_eq!(wrong_line, "1 1 3 2 4");
    assert!(error.to_string().contains(&format!("line {line}: element 1: ")), "{error}");
}

#[test]
fn counts_must_be_those_announced() {
    let nodes = error_with("1 6 1 6", "1 7 1 6");
    assert_eq!(nodes, (18, count("nodes", 6, "7, as announced")));
    let elements = error_with("1 2 1 2", "1 1 1 2");
    assert_eq!(elements, (24, count("elements", 2, "1, as announced")));
    let kind = error_with("2 1 3 2", "2 1 10 2");
    assert!(kind.0 == 22 && kind.1.to_string().contains("SecondOrderIncomplete"), "{}", kind.1);
}

/// Reads the manual's example with `z` as the height of its fourth node.
fn read_with_height(z: &str) -> basemat::Result<GmshMesh> {
    read(&MANUAL_EXAMPLE.replacen("0. 1. 0.", &format!("0. 1. {z}"), 1))
}

/// Gmsh writes z of about 10⁻¹⁷ after a plane mesh was rotated or extruded; this is ignored.
#[test]
fn rounding_of_z_is_ignored() {
    assert_eq!(read_with_height("1e-17").unwrap(), read(MANUAL_EXAMPLE).unwrap());
    assert!(read_with_height("-1e-10").is_ok());
    assert!(read_with_height("1e-6").is_err() && read_with_height("-1e-6").is_err());
}

#[test]
fn a_group_has_one_material() {
    let gmsh = read(MANUAL_EXAMPLE).unwrap();
    let soft_material = Material::new(1.0e9, 0.2, 2400.0).unwrap();
    let error = gmsh.mesh(&[("", concrete()), ("", soft_material)]).unwrap_err();
    let Error::File(FileError { fault, .. }) = error else { panic!("{error}") };
    assert_eq!(fault, value("material of surface ''", "given twice", "given once"));
}

/// A clockwise square of the second order: corners and the nodes between them are reordered.
#[test]
fn clockwise_elements_of_the_second_order_are_reordered() {
    let text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 8 1 8\n2 1 0 8\n\
        1\n2\n3\n4\n5\n6\n7\n8\n0 0 0\n0 2 0\n2 2 0\n2 0 0\n0 1 0\n1 2 0\n2 1 0\n1 0 0\n$EndNodes\n\
        $Elements\n1 1 1 1\n2 1 16 1\n1 1 2 3 4 5 6 7 8\n$EndElements\n";
    let mesh = read(text).unwrap().mesh(&[("", concrete())]).unwrap();
    let nodes = mesh.elements().next().unwrap().nodes();
    let places: Vec<[f64; 3]> = nodes.iter().map(|&node| mesh.nodes()[node]).collect();
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(|[x, y]| [x, y, 0.0]);
    assert_eq!(places[..4], corners);
    for k in 0..4 {
        let a = corners[k];
        let b = corners[(k + 1) % 4];
        assert_eq!(places[4 + k], [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.0]);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_damage_is_an_error_or_a_mesh(place in 0..MANUAL_EXAMPLE.len(), byte: u8, keep in 0..MANUAL_EXAMPLE.len()) {
        let mut bytes = MANUAL_EXAMPLE.as_bytes().to_vec();
        bytes[place] = byte;
        for bytes in [&bytes[..], &bytes[..keep]] {
            if let Ok(gmsh) = GmshMesh::from_reader("damaged", bytes) {
                let _ = gmsh.mesh(&[("", concrete())]);
            }
        }
    }

    #[test]
    fn any_bytes_are_an_error(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        prop_assert!(GmshMesh::from_reader("bytes", &bytes[..]).is_err());
    }
}
