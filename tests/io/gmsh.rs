//! GOAL: meshes from Gmsh are read as they are, or refused with their line.
//! SCENE: the example of Gmsh's manual, partitions, second-order elements, damaged files, any
//! bytes.
//! REFERENCE: a layered block written and read back; typed errors.

use std::fmt::Write;

use basemat::bem::{ElasticGround, Strip};
use basemat::fem::{Layer, Material, Mesh};
use basemat::interface::Bonded;
use basemat::io::GmshMesh;
use basemat::structure::{Base, FemModel, Structure};
use basemat::{Error, FileError, FileFault, Simulation, Soil};
use basemat_problems::faults::{count, not_a_number, value};
use proptest::prelude::*;

use basemat_problems::dense;

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
    assert_eq!(mesh.nodes()[4], [2.0, 0.0, 0.0]);
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
        let [x, y, _] = mesh.nodes()[node];
        let _ = writeln!(text, "{x:e} {y:e} 0 {x}");
    }
    let _ = writeln!(text, "2 1 0 {}", count - on_line);
    let rest = || (0..count).filter(|node| !contact.contains(node));
    for node in rest() {
        let _ = writeln!(text, "{}", tag(node));
    }
    for node in rest() {
        let [x, y, _] = mesh.nodes()[node];
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
            let mut nodes = mesh.elements().nth(k).unwrap().nodes().to_vec();
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
    [dense::mass(model).concat(), dense::stiffness(model).concat()]
}

#[test]
fn a_block_comes_back_as_it_was() {
    let soft = Material::new(1.0e9, 0.3, 1800.0).unwrap();
    let layers = [Layer::new(1.0, 2, soft), Layer::new(1.0, 1, concrete())];
    let mesh = Mesh::graded_block(&[0.0, 0.3, 0.7, 1.0], &layers).unwrap();
    let model = FemModel::on_base(mesh).unwrap();
    let text = written(model.mesh(), 6, &[0, 1, 2, 3]);
    let gmsh = read(&text).unwrap();
    // The upper surface is in an unnamed group of number 9 as well.
    assert_eq!(gmsh.surfaces(), ["9", "lower part", "upper"]);
    assert_eq!(gmsh.lines(), ["base"]);
    let back = gmsh.mesh(&[("upper", concrete()), ("lower part", soft)]).unwrap();
    assert_eq!(back.nodes(), model.mesh().nodes());
    let back = FemModel::new(back, &gmsh.line("base").unwrap()).unwrap();
    assert_eq!(back.base(), model.base());
    for (own, wanted) in matrices(&back).iter().zip(matrices(&model)) {
        let scale = wanted.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        // Turned quadrilaterals sum in another order.
        assert!(own.iter().zip(&wanted).all(|(a, b)| (a - b).abs() < 1e-14 * scale));
    }
}

/// Line and reason of the refusal of `text`.
fn refusal(text: &str) -> (usize, FileFault) {
    match read(text) {
        Err(Error::File(FileError { file, line, fault })) if file == "test.msh" => (line, fault),
        other => panic!("{other:?}"),
    }
}

#[test]
fn bad_files_are_refused_with_their_line() {
    let with = |from: &str, to: &str| refusal(&MANUAL.replacen(from, to, 1));
    assert!(matches!(with("4.1 0 8", "4.0 0 8"), (2, FileFault::Format { .. })));
    assert!(matches!(with("4.1 0 8", "4.1 1 8"), (2, FileFault::Missing { .. })));
    assert!(matches!(with("4.1 0 8", "4.1 1 4"), (2, FileFault::Format { .. })));
    assert!(matches!(with("2 1 3 2", "2 1 2 2"), (22, FileFault::Format { .. })));
    assert_eq!(with("0. 1. 0.", "0. 1. 0.5"), (16, value("z of a node", "0.5", "0")));
    assert_eq!(with("1. 1. 0.", "1. x 0."), (15, not_a_number("x")));
    assert_eq!(with("1. 1. 0.", "1. nan 0."), (15, not_a_number("nan")));
    assert!(matches!(with("2 2 5 6 3", "2 2 5 7 3"), (24, FileFault::Missing { .. })));
    assert_eq!(with("\n6\n", "\n5\n"), (12, value("node 5", "given twice", "given once")));
    assert!(matches!(with("$EndNodes", "$EndElements"), (19, FileFault::Missing { .. })));
    let begin = value("field", "'Elements'", "the beginning of a section");
    assert_eq!(with("$Elements", "Elements"), (20, begin));
    assert!(matches!(refusal(""), (0, FileFault::Missing { .. })));
    let long = value("length of the line", "65536 bytes or more", "less");
    assert_eq!(refusal(&"1".repeat(100_000)), (1, long));
    let cut = refusal(&MANUAL[..MANUAL.find("2 2 5 6 3").unwrap()]);
    assert!(matches!(cut, (24, FileFault::Missing { .. })), "{cut:?}");
    let Err(Error::File(error)) = GmshMesh::read("no such file") else { panic!("there is a file") };
    assert!(error.line == 0 && matches!(error.fault, FileFault::Unreadable(_)), "{error}");
}

/// Editors may write a byte-order mark before the first line; anywhere else it is not a number.
#[test]
fn a_byte_order_mark_is_passed_over() {
    let marked = format!("\u{feff}{MANUAL}");
    assert_eq!(read(&marked).unwrap(), read(MANUAL).unwrap());
    // Lines are counted as without it.
    let (line, reason) = refusal(&marked.replacen("1. 1. 0.", "1. x 0.", 1));
    assert_eq!((line, reason), (15, not_a_number("x")));
    let (line, _) = refusal(&MANUAL.replacen("1. 1. 0.", "\u{feff}1. 1. 0.", 1));
    assert_eq!(line, 15);
}

#[test]
fn numbers_are_read_wholly_or_refused() {
    let with = |x: &str| MANUAL.replacen("2. 0. 0.", &format!("{x} 0. 0."), 1);
    for two in ["2", "2.", "+2.0", "0.2e1", "2D0", "2.0d+00", ".2E+1"] {
        assert_eq!(read(&with(two)).unwrap(), read(MANUAL).unwrap(), "{two}");
    }
    for bad in ["2,0", "2.0m", "2D", "0x2", "2_0", "1e999", "inf", "\u{2212}2", "2;", "**", "2/1"] {
        let (line, reason) = refusal(&with(bad));
        assert_eq!((line, reason), (17, not_a_number(bad)));
    }
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
        let Error::File(error) = error else { panic!("{error}") };
        assert!(matches!(error.fault, FileFault::Missing { .. }), "{error}");
    }
    assert!(gmsh.line("base").unwrap_err().to_string().contains("there is no line 'base'"));
    // A quadrilateral that crosses itself has an area of neither sign.
    let crossed_text = MANUAL.replacen("1 1 2 3 4", "1 1 3 2 4", 1);
    let crossed = read(&crossed_text).unwrap();
    let error = crossed.mesh(&[("", concrete())]).unwrap_err();
    let Error::File(FileError { line, fault, .. }) = &error else { panic!("{error}") };
    let FileFault::Unusable(inside) = fault else { panic!("{error}") };
    assert!(matches!(&**inside, Error::Item { item, .. } if item == "element 1"), "{error}");
    let stands = crossed_text.lines().nth(line - 1).unwrap();
    assert_eq!(stands, "1 1 3 2 4");
    assert!(error.to_string().contains(&format!("line {line}: element 1: ")), "{error}");
}

#[test]
fn what_is_announced_must_be_there() {
    let with = |from: &str, to: &str| refusal(&MANUAL.replacen(from, to, 1));
    let nodes = with("1 6 1 6", "1 7 1 6");
    assert_eq!(nodes, (18, count("nodes", 6, "7, as announced")));
    let elements = with("1 2 1 2", "1 1 1 2");
    assert_eq!(elements, (24, count("elements", 2, "1, as announced")));
    let (line, reason) = with("2 1 3 2", "2 1 10 2");
    assert!(line == 22 && reason.to_string().contains("SecondOrderIncomplete"), "{reason}");
}

/// Gmsh leaves some 10⁻¹⁷ of z when a plane mesh was turned or extruded; this is ignored.
#[test]
fn the_plane_is_as_flat_as_rounding_leaves_it() {
    let with = |z: &str| read(&MANUAL.replacen("0. 1. 0.", &format!("0. 1. {z}"), 1));
    assert_eq!(with("1e-17").unwrap(), read(MANUAL).unwrap());
    assert!(with("-1e-10").is_ok());
    assert!(with("1e-6").is_err() && with("-1e-6").is_err());
}

#[test]
fn a_group_has_one_material() {
    let gmsh = read(MANUAL).unwrap();
    let soft = Material::new(1.0e9, 0.2, 2400.0).unwrap();
    let error = gmsh.mesh(&[("", concrete()), ("", soft)]).unwrap_err();
    let Error::File(FileError { fault, .. }) = error else { panic!("{error}") };
    assert_eq!(fault, value("material of surface ''", "given twice", "given once"));
}

/// GOAL: what a file gives twice is refused, whole sections and single elements.
#[test]
fn nothing_counts_twice() {
    let twice = |text: &str, part: &str| {
        let (line, reason) = refusal(text);
        let FileFault::Value { quantity, found, .. } = &reason else { panic!("{reason}") };
        assert!(line > 0 && quantity.contains(part), "{line}: {quantity}, not {part}");
        assert_eq!(found, "given twice");
        line
    };
    let section = |name: &str, text: &str| {
        let begin = text.find(&format!("${name}")).unwrap();
        let end = text.find(&format!("$End{name}")).unwrap() + name.len() + 5;
        text[begin..end].to_owned()
    };
    assert_eq!(twice(&format!("{MANUAL}{}", section("Elements", MANUAL)), "$Elements"), 42);
    for name in ["MeshFormat", "Nodes", "PhysicalNames", "Entities", "Elements"] {
        twice(&format!("{STRIPS}{}", section(name, STRIPS)), &format!("section ${name}"));
    }
    // The other sections may come more than once, as results do.
    assert!(read(&format!("{MANUAL}{}", section("NodeData", MANUAL))).is_ok());
    // Once more as it is, from another corner, clockwise, under another tag and entity.
    for again in ["1 1 2 3 4", "9 3 4 1 2", "9 4 3 2 1"] {
        let text = MANUAL.replacen("1 2 1 2\n2 1 3 2\n", "1 3 1 9\n2 1 3 3\n", 1);
        let line =
            twice(&text.replacen("$EndElements", &format!("{again}\n$EndElements"), 1), "quad");
        assert_eq!(line, 25, "{again}");
    }
    let other = MANUAL.replacen("\n1 2 1 2\n", "\n2 3 1 3\n", 1);
    twice(&other.replacen("$EndElements", "2 8 3 1\n3 1 2 3 4\n$EndElements", 1), "nodes 1 2 3 4");
    let named = STRIPS.replacen("1\n1 7 \"base\"", "2\n1 7 \"base\"\n1 7 \"roof\"", 1);
    twice(&named, "group 7");
    let entity = "1 0 0 0 3 0 0 1 7 0\n";
    let apart = STRIPS.replacen("0 1 1 0\n", "0 2 1 0\n", 1);
    let with = |second: &str| apart.replacen(entity, &format!("{entity}{second}"), 1);
    twice(&with(&entity.replace("1 7 0", "1 8 0")), "entity 1");
    // A line that two curves share is a line.
    let lines = STRIPS.replacen("2 5 1 5\n1 1 1 2", "2 6 1 6\n1 1 1 3\n8 1 2", 1);
    assert_eq!(read(&lines).unwrap().foundations("base").unwrap().len(), 2);
}

/// A square of the second order, clockwise: corners and the nodes between them are turned round.
#[test]
fn clockwise_elements_of_the_second_order_are_turned() {
    let text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 8 1 8\n2 1 0 8\n\
        1\n2\n3\n4\n5\n6\n7\n8\n0 0 0\n0 2 0\n2 2 0\n2 0 0\n0 1 0\n1 2 0\n2 1 0\n1 0 0\n$EndNodes\n\
        $Elements\n1 1 1 1\n2 1 16 1\n1 1 2 3 4 5 6 7 8\n$EndElements\n";
    let mesh = read(text).unwrap().mesh(&[("", concrete())]).unwrap();
    let nodes = mesh.elements().next().unwrap().nodes();
    let places: Vec<[f64; 3]> = nodes.iter().map(|&node| mesh.nodes()[node]).collect();
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(|[x, y]| [x, y, 0.0]);
    assert_eq!(places[..4], corners);
    for k in 0..4 {
        let (a, b) = (corners[k], corners[(k + 1) % 4]);
        assert_eq!(places[4 + k], [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.0]);
    }
}

/// Three squares in a row; what is below them is a line each for the first and the last.
const STRIPS: &str = "$MeshFormat\n4.1 0 8\n$EndMeshFormat
$PhysicalNames\n1\n1 7 \"base\"\n$EndPhysicalNames
$Entities\n0 1 1 0\n1 0 0 0 3 0 0 1 7 0\n1 0 0 0 3 1 0 0 0\n$EndEntities
$Nodes\n1 8 1 8\n2 1 0 8\n1\n2\n3\n4\n5\n6\n7\n8
0 0 0\n1 0 0\n2 0 0\n3 0 0\n0 1 0\n1 1 0\n2 1 0\n3 1 0\n$EndNodes
$Elements\n2 5 1 5\n1 1 1 2\n1 4 3\n2 1 2\n2 1 3 3\n3 1 2 6 5\n4 2 3 7 6\n5 3 4 8 7\n$EndElements
";

#[test]
fn a_base_with_a_gap_is_two_foundations() {
    let gmsh = read(STRIPS).unwrap();
    let error = gmsh.line("base").unwrap_err().to_string();
    assert!(error.contains("number of pieces of line 'base' is 2, but must be 1"), "{error}");
    let lines = gmsh.foundations("base").unwrap();
    assert_eq!(lines, [[0, 1], [2, 3]]);
    let mesh = || gmsh.mesh(&[("", concrete())]).unwrap();
    let model = FemModel::on_foundations(mesh(), &lines).unwrap();
    let Base::Lines(found) = model.base() else { panic!("a base in the plane") };
    assert_eq!(found.iter().map(Vec::len).collect::<Vec<_>>(), [2, 2]);
    let build = |model: FemModel, strips: &[std::ops::Range<f64>]| {
        let strips: Vec<Strip> =
            strips.iter().map(|range| Strip::uniform(range.clone(), 4).unwrap()).collect();
        let ground = ElasticGround::new(Soil::new(80.0e6, 0.33, 1900.0).unwrap(), &strips);
        let builder = Simulation::builder(0.01).structure(model).ground(ground.unwrap());
        builder.interface(Bonded).gravity(9.81).build()
    };
    let built = build(model, &[0.0..1.0, 2.0..3.0]).unwrap();
    assert_eq!(built.state().foundations.len(), 2);
    let whole = || FemModel::on_foundations(mesh(), &[vec![0, 1, 2, 3]]).unwrap();
    assert!(matches!(whole().base(), Base::Lines(lines) if lines.len() == 1));
    let built = build(whole(), std::slice::from_ref(&(0.0..3.0))).unwrap();
    assert_eq!(built.state().foundations.len(), 1);
    // Between the strips there is no base.
    let two = FemModel::on_foundations(mesh(), &lines).unwrap();
    assert!(build(two, std::slice::from_ref(&(0.0..3.0))).is_err());
    for bad in
        [&[][..], &[vec![0, 1], vec![2]], &[vec![2, 3], vec![0, 1]], &[vec![0, 1], vec![1, 2]]]
    {
        assert!(FemModel::on_foundations(mesh(), bad).is_err(), "{bad:?}");
    }
    // With the middle closed it is one line.
    let closed = STRIPS.replacen("2 5 1 5\n1 1 1 2\n", "2 6 1 6\n1 1 1 3\n9 3 2\n", 1);
    assert_eq!(read(&closed).unwrap().line("base").unwrap(), [0, 1, 2, 3]);
}

/// The middle square belongs to another partition: its surface is an entity of its own.
#[test]
fn partitions_keep_their_groups() {
    let parted = STRIPS
        .replacen("$EndPhysicalNames", "2 4 \"wall\"\n$EndPhysicalNames", 1)
        .replacen("Names\n1\n", "Names\n2\n", 1)
        .replacen(
            "$EndEntities",
            "$EndEntities\n$PartitionedEntities\n2\n1\n5 1\n0 1 2 0\n\
             2 1 1 2 1 2 0 0 0 3 0 0 1 7 0\n8 2 1 1 1 0 0 0 3 1 0 1 4 0\n\
             9 2 1 1 2 1 0 0 2 1 0 1 4 1 2\n$EndPartitionedEntities",
            1,
        )
        .replacen("2 5 1 5\n1 1 1 2", "3 5 1 5\n1 2 1 2", 1)
        .replacen("2 1 3 3", "2 8 3 2", 1)
        .replacen("4 2 3 7 6\n5 3 4 8 7", "5 3 4 8 7\n2 9 3 1\n4 2 3 7 6", 1);
    let gmsh = read(&parted).unwrap();
    assert_eq!((gmsh.surfaces(), gmsh.lines()), (vec!["wall"], vec!["base"]));
    assert_eq!(gmsh.foundations("base").unwrap().len(), 2);
    assert_eq!(gmsh.mesh(&[("wall", concrete())]).unwrap().elements().len(), 3);
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
