//! GOAL: groups and the pieces of lines are those of the file; repeated definitions are errors.
//! SCENE: three squares in a row on two strips, partitions, repeated sections and elements.
//! REFERENCE: the nodes of each line and strip by hand; typed errors.

use basemat::bem::{ElasticGround, Strip};
use basemat::fem::Mesh;
use basemat::interface::Bonded;
use basemat::io::GmshMesh;
use basemat::structure::{Base, FemModel, Structure};
use basemat::{FileFault, Simulation, Soil};

use super::gmsh::{MANUAL_EXAMPLE, concrete, read, read_error};

/// Three squares in a row, with a line below the first and one below the last.
const THREE_SQUARES: &str = "$MeshFormat\n4.1 0 8\n$EndMeshFormat
$PhysicalNames\n1\n1 7 \"base\"\n$EndPhysicalNames
$Entities\n0 1 1 0\n1 0 0 0 3 0 0 1 7 0\n1 0 0 0 3 1 0 0 0\n$EndEntities
$Nodes\n1 8 1 8\n2 1 0 8\n1\n2\n3\n4\n5\n6\n7\n8
0 0 0\n1 0 0\n2 0 0\n3 0 0\n0 1 0\n1 1 0\n2 1 0\n3 1 0\n$EndNodes
$Elements\n2 5 1 5\n1 1 1 2\n1 4 3\n2 1 2\n2 1 3 3\n3 1 2 6 5\n4 2 3 7 6\n5 3 4 8 7\n$EndElements
";

/// Line of the error of `text`, in which `part` is repeated.
#[track_caller]
fn line_given_twice(text: &str, part: &str) -> usize {
    let error = read_error(text);
    let line = error.0;
    let FileFault::Value { quantity, found, .. } = error.1 else {
        panic!("{}", error.1)
    };
    assert!(line > 0 && quantity.contains(part), "{line}: {quantity}, not {part}");
    assert_eq!(found, "given twice");
    line
}

/// The section `name` of a file.
fn section<'a>(name: &str, text: &'a str) -> &'a str {
    let section_start = text.find(&format!("${name}")).unwrap();
    let end = text.find(&format!("$End{name}")).unwrap() + name.len() + 5;
    &text[section_start..end]
}

/// GOAL: repeated sections, groups, entities and elements are errors.
#[test]
fn repeated_definitions_are_errors() {
    let elements_twice = format!("{MANUAL_EXAMPLE}{}", section("Elements", MANUAL_EXAMPLE));
    assert_eq!(line_given_twice(&elements_twice, "$Elements"), 42);
    for name in ["MeshFormat", "Nodes", "PhysicalNames", "Entities", "Elements"] {
        let section_twice = format!("{THREE_SQUARES}{}", section(name, THREE_SQUARES));
        line_given_twice(&section_twice, &format!("section ${name}"));
    }
    // Other sections, such as results, may be repeated.
    assert!(read(&format!("{MANUAL_EXAMPLE}{}", section("NodeData", MANUAL_EXAMPLE))).is_ok());
    // The same element again, from another corner, clockwise, under another tag and entity.
    for repeated_element in ["1 1 2 3 4", "9 3 4 1 2", "9 4 3 2 1"] {
        let text = MANUAL_EXAMPLE.replacen("1 2 1 2\n2 1 3 2\n", "1 3 1 9\n2 1 3 3\n", 1);
        let line = line_given_twice(
            &text.replacen("$EndElements", &format!("{repeated_element}\n$EndElements"), 1),
            "quad",
        );
        assert_eq!(line, 25, "{repeated_element}");
    }
    let other_entity = MANUAL_EXAMPLE.replacen("\n1 2 1 2\n", "\n2 3 1 3\n", 1);
    line_given_twice(
        &other_entity.replacen("$EndElements", "2 8 3 1\n3 1 2 3 4\n$EndElements", 1),
        "nodes 1 2 3 4",
    );
    let text_of_two_names =
        THREE_SQUARES.replacen("1\n1 7 \"base\"", "2\n1 7 \"base\"\n1 7 \"roof\"", 1);
    line_given_twice(&text_of_two_names, "group 7");
    let entity = "1 0 0 0 3 0 0 1 7 0\n";
    let text_of_another_entity = THREE_SQUARES.replacen("0 1 1 0\n", "0 2 1 0\n", 1);
    let second_entity = entity.replace("1 7 0", "1 8 0");
    let entity_twice =
        text_of_another_entity.replacen(entity, &format!("{entity}{second_entity}"), 1);
    line_given_twice(&entity_twice, "entity 1");
    // A line on two curves is allowed.
    let lines = THREE_SQUARES.replacen("2 5 1 5\n1 1 1 2", "2 6 1 6\n1 1 1 3\n8 1 2", 1);
    assert_eq!(read(&lines).unwrap().foundations("base").unwrap().len(), 2);
}

fn mesh_of(gmsh: &GmshMesh) -> Mesh {
    gmsh.mesh(&[("", concrete())]).unwrap()
}

/// A bonded simulation of `model` on elastic ground under the strips.
fn simulation_on(model: FemModel, strips: &[std::ops::Range<f64>]) -> basemat::Result<Simulation> {
    let strips: Vec<Strip> =
        strips.iter().map(|range| Strip::uniform(range.clone(), 4).unwrap()).collect();
    let ground = ElasticGround::new(Soil::new(80.0e6, 0.33, 1900.0).unwrap(), &strips);
    let builder = Simulation::builder(0.01).structure(model).ground(ground.unwrap());
    builder.interface(Bonded).gravity(9.81).build()
}

#[test]
fn a_base_with_a_gap_is_two_foundations() {
    let gmsh = read(THREE_SQUARES).unwrap();
    let error = gmsh.line("base").unwrap_err().to_string();
    assert!(error.contains("number of pieces of line 'base' is 2, but must be 1"), "{error}");
    let lines = gmsh.foundations("base").unwrap();
    assert_eq!(lines, [[0, 1], [2, 3]]);
    let model = FemModel::on_foundations(mesh_of(&gmsh), &lines).unwrap();
    let Base::Lines(found) = model.base() else { panic!("a base in the plane") };
    assert_eq!(found.iter().map(Vec::len).collect::<Vec<_>>(), [2, 2]);
    let simulation = simulation_on(model, &[0.0..1.0, 2.0..3.0]).unwrap();
    assert_eq!(simulation.state().foundations.len(), 2);
    let whole_model = FemModel::on_foundations(mesh_of(&gmsh), &[vec![0, 1, 2, 3]]).unwrap();
    assert!(matches!(whole_model.base(), Base::Lines(lines) if lines.len() == 1));
    let simulation = simulation_on(whole_model, std::slice::from_ref(&(0.0..3.0))).unwrap();
    assert_eq!(simulation.state().foundations.len(), 1);
    // Between the strips there is no base.
    let model_on_two_lines = FemModel::on_foundations(mesh_of(&gmsh), &lines).unwrap();
    assert!(simulation_on(model_on_two_lines, std::slice::from_ref(&(0.0..3.0))).is_err());
    for invalid_value in
        [&[][..], &[vec![0, 1], vec![2]], &[vec![2, 3], vec![0, 1]], &[vec![0, 1], vec![1, 2]]]
    {
        assert!(
            FemModel::on_foundations(mesh_of(&gmsh), invalid_value).is_err(),
            "{invalid_value:?}"
        );
    }
    // With a line below the middle square it is one line.
    let text_of_one_line =
        THREE_SQUARES.replacen("2 5 1 5\n1 1 1 2\n", "2 6 1 6\n1 1 1 3\n9 3 2\n", 1);
    assert_eq!(read(&text_of_one_line).unwrap().line("base").unwrap(), [0, 1, 2, 3]);
}

/// The middle square belongs to another partition: its surface is a separate entity.
#[test]
fn partitions_keep_their_groups() {
    let text_of_partitions = THREE_SQUARES
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
    let gmsh = read(&text_of_partitions).unwrap();
    assert_eq!((gmsh.surfaces(), gmsh.lines()), (vec!["wall"], vec!["base"]));
    assert_eq!(gmsh.foundations("base").unwrap().len(), 2);
    assert_eq!(gmsh.mesh(&[("wall", concrete())]).unwrap().elements().len(), 3);
}
