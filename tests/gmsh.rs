//! Meshes from Gmsh: the manual's example, a whole block there and back, and bad files.

use std::fmt::Write;

use basemat::fem::{GmshMesh, Layer, Material, Mesh};
use basemat::structure::{FemModel, Structure, Triplets};
use basemat::{Error, MeshFileError};
use proptest::prelude::*;

fn concrete() -> Material {
    Material::new(30.0e9, 0.2, 2400.0).unwrap()
}

fn read(text: &str) -> basemat::Result<GmshMesh> {
    GmshMesh::from_reader("test.msh", text.as_bytes())
}

/// The example of the Gmsh reference manual, "MSH file format", version 4.1, comments left out.
const MANUAL: &str = "$MeshFormat
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
fn the_manuals_example_is_read() {
    let gmsh = read(MANUAL).unwrap();
    assert_eq!((gmsh.surfaces(), gmsh.lines().len()), (vec![""], 0));
    let mesh = gmsh.mesh(&[("", concrete())]).unwrap();
    assert_eq!(mesh.nodes()[4], [2.0, 0.0]);
    let nodes: Vec<_> = mesh.elements().map(|quad| quad.nodes().to_vec()).collect();
    assert_eq!(nodes, [[0, 1, 2, 3], [1, 4, 5, 2]]);
}

/// A block in two materials as Gmsh would write it: tags with gaps, points and lines of the geometry,
/// nodes by entity, some quadrilaterals clockwise, parametric coordinates on the line.
fn written(mesh: &Mesh, lower: usize, contact: &[usize]) -> String {
    let tag = |node: usize| 10 + 3 * node;
    let mut text = String::from("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
    text +=
        "$PhysicalNames\n3\n1 1 \"base\"\n2 2 \"lower part\"\n2 3 \"upper\"\n$EndPhysicalNames\n";
    text += "$Entities\n1 1 2 0\n1 0 0 0 0\n7 0 0 0 1 0 0 1 -1 2 1 -2\n";
    text += "1 0 0 0 1 1 0 1 2 1 7\n2 0 1 0 1 2 0 2 3 9 0\n$EndEntities\n";
    let (count, on_line) = (mesh.nodes().len(), contact.len());
    let _ = write!(text, "$Nodes\n2 {count} 10 {}\n1 7 1 {on_line}\n", tag(count));
    for &node in contact {
        let _ = writeln!(text, "{}", tag(node));
    }
    for &node in contact {
        let [x, y] = mesh.nodes()[node];
        let _ = writeln!(text, "{x:e} {y:e} 0 {x}");
    }
    let _ = writeln!(text, "2 1 0 {}", count - on_line);
    let rest = || (0..count).filter(|node| !contact.contains(node));
    for node in rest() {
        let _ = writeln!(text, "{}", tag(node));
    }
    for node in rest() {
        let [x, y] = mesh.nodes()[node];
        let _ = writeln!(text, "{x} {y} 0");
    }
    let quads = mesh.elements().len();
    let _ = write!(text, "$EndNodes\n$Elements\n4 {} 1 {}\n", quads + on_line, quads + on_line);
    let _ = write!(text, "0 1 15 1\n900 {}\n1 7 1 {}\n", tag(0), on_line - 1);
    for (k, pair) in contact.windows(2).enumerate() {
        let _ = writeln!(text, "{} {} {}", 500 + k, tag(pair[0]), tag(pair[1]));
    }
    for (entity, range) in [(1, 0..lower), (2, lower..quads)] {
        let _ = writeln!(text, "2 {entity} 3 {}", range.len());
        for k in range {
            let mut nodes = mesh.element(k).unwrap().nodes().to_vec();
            if k % 2 == 1 {
                nodes.reverse();
            }
            let tags: Vec<String> = nodes.iter().map(|&node| tag(node).to_string()).collect();
            let _ = writeln!(text, "{} {}", 700 + k, tags.join(" "));
        }
    }
    text + "$EndElements\n"
}

fn matrices(model: &FemModel) -> [Vec<f64>; 2] {
    let n = model.unknowns();
    let dense = |write: &dyn Fn(&mut Triplets)| {
        let mut triplets = Triplets::new(n);
        write(&mut triplets);
        let mut full = vec![0.0; n * n];
        for &(i, j, value) in triplets.entries() {
            full[i * n + j] += value;
        }
        full
    };
    [dense(&|m| model.mass(m)), dense(&|m| model.stiffness(m))]
}

#[test]
fn a_block_comes_back_as_it_was() {
    let soft = Material::new(1.0e9, 0.3, 1800.0).unwrap();
    let layers = [Layer::new(1.0, 2, soft), Layer::new(1.0, 1, concrete())];
    let mesh = Mesh::graded_block(&[0.0, 0.3, 0.7, 1.0], &layers).unwrap();
    let model = FemModel::on_base(mesh).unwrap();
    let text = written(model.mesh(), 6, &[0, 1, 2, 3]);
    let gmsh = read(&text).unwrap();
    assert_eq!(gmsh.surfaces(), ["lower part", "upper"]);
    assert_eq!(gmsh.lines(), ["base"]);
    let back = gmsh.mesh(&[("upper", concrete()), ("lower part", soft)]).unwrap();
    assert_eq!(back.nodes(), model.mesh().nodes());
    let back = FemModel::new(back, &gmsh.line("base").unwrap()).unwrap();
    assert_eq!(back.contact_nodes(), model.contact_nodes());
    for (own, wanted) in matrices(&back).iter().zip(matrices(&model)) {
        let scale = wanted.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        // Turned quadrilaterals sum in another order.
        assert!(own.iter().zip(&wanted).all(|(a, b)| (a - b).abs() < 1e-14 * scale));
    }
}

/// Line and reason of the refusal of `text`.
fn refusal(text: &str) -> (usize, MeshFileError) {
    match read(text) {
        Err(Error::MeshFile { file, line, reason }) if file == "test.msh" => (line, reason),
        other => panic!("{other:?}"),
    }
}

#[test]
fn bad_files_are_refused_with_their_line() {
    let with = |from: &str, to: &str| refusal(&MANUAL.replacen(from, to, 1));
    assert!(matches!(with("4.1 0 8", "2.2 0 8"), (2, MeshFileError::Unsupported { .. })));
    assert!(matches!(with("4.1 0 8", "4.1 1 8"), (2, MeshFileError::Unsupported { .. })));
    assert!(matches!(with("2 1 3 2", "2 1 2 2"), (22, MeshFileError::Unsupported { .. })));
    assert!(matches!(with("0. 1. 0.", "0. 1. 0.5"), (16, MeshFileError::Unsupported { .. })));
    assert!(matches!(with("1. 1. 0.", "1. x 0."), (15, MeshFileError::NotA { .. })));
    assert!(matches!(with("1. 1. 0.", "1. nan 0."), (15, MeshFileError::NotA { .. })));
    assert!(matches!(with("2 2 5 6 3", "2 2 5 7 3"), (24, MeshFileError::Missing { .. })));
    assert!(matches!(with("\n6\n", "\n5\n"), (12, MeshFileError::Twice { .. })));
    assert!(matches!(with("$EndNodes", "$EndElements"), (19, MeshFileError::Missing { .. })));
    assert!(matches!(with("$Elements", "Elements"), (20, MeshFileError::NotA { .. })));
    assert!(matches!(refusal(""), (0, MeshFileError::Missing { .. })));
    assert!(matches!(refusal(&"1".repeat(100_000)), (1, MeshFileError::LineTooLong { .. })));
    let cut = refusal(&MANUAL[..MANUAL.find("2 2 5 6 3").unwrap()]);
    assert!(matches!(cut, (24, MeshFileError::Missing { .. })), "{cut:?}");
    assert!(matches!(GmshMesh::read("no such file"), Err(Error::MeshFile { line: 0, .. })));
}

/// A group of any number that fits into the file's integers has a name.
#[test]
fn groups_of_any_number_are_read() {
    let entities =
        format!("$Entities\n0 0 1 0\n1 0 0 0 2 1 0 1 {} 0\n$EndEntities\n$Nodes", i64::MIN);
    let gmsh = read(&MANUAL.replacen("$Nodes", &entities, 1)).unwrap();
    assert_eq!(gmsh.surfaces(), [i64::MAX.to_string()]);
}

#[test]
fn groups_that_are_not_there_are_named() {
    let gmsh = read(MANUAL).unwrap();
    for materials in [&[][..], &[("", concrete()), ("roof", concrete())]] {
        let error = gmsh.mesh(materials).unwrap_err();
        assert!(matches!(error, Error::MeshFile { .. }), "{error}");
    }
    assert!(gmsh.line("base").unwrap_err().to_string().contains("there is no line 'base'"));
    // A quadrilateral that crosses itself has an area of neither sign.
    let crossed = read(&MANUAL.replacen("1 1 2 3 4", "1 1 3 2 4", 1)).unwrap();
    assert!(crossed.mesh(&[("", concrete())]).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_damage_is_an_error_or_a_mesh(place in 0..MANUAL.len(), byte: u8, keep in 0..MANUAL.len()) {
        let mut bytes = MANUAL.as_bytes().to_vec();
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
