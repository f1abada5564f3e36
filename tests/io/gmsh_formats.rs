//! GOAL: versions 2.2 and 4.1 of Gmsh's format, as text and binary, contain the same mesh; damaged files are errors.
//! SCENE: files written by Gmsh 4.15 (`tests/data/gmsh/formats.py`): bricks, a wall of quadrilaterals in two groups, a
//! wall of triangles, a column, a point; the example of the manual; files with any byte changed, cut anywhere.
//! REFERENCE: the four forms of one mesh; places and volumes by hand.

use basemat::fem::{BeamSection, Material};
use basemat::io::{GmshMesh, GmshPart, GmshSpaceMesh};
use basemat::structure::{FemModel, Structure};
use basemat::{Error, FileError};
use basemat_problems::dense::stiffness;
use proptest::prelude::*;

const FILE_FORMS: [&str; 4] = ["text41", "binary41", "text22", "binary22"];

fn bytes(form: &str) -> Vec<u8> {
    std::fs::read(basemat_problems::data_path(&format!("gmsh/formats_{form}.msh"))).unwrap()
}

fn read(bytes: &[u8]) -> basemat::Result<GmshSpaceMesh> {
    GmshSpaceMesh::from_reader("formats.msh", bytes)
}

fn model(gmsh: &GmshSpaceMesh) -> FemModel {
    let concrete = Material::new(30.0e9, 0.2, 2500.0).unwrap();
    let section = BeamSection::new(0.16, [2.1e-3, 2.1e-3], 3.6e-3).unwrap();
    let mesh = gmsh.mesh(&[
        ("block", GmshPart::Solid(concrete)),
        ("walls", GmshPart::Shell(concrete, 0.3)),
        ("4", GmshPart::Beam(concrete, section, [1.0, 0.0, 0.0])),
    ]);
    FemModel::on_faces(mesh.unwrap(), &gmsh.cells(2, "base").unwrap()).unwrap()
}

#[test]
fn all_forms_are_the_same_mesh() {
    let first = read(&bytes(FILE_FORMS[0])).unwrap();
    assert_eq!(first.groups(0), ["head"]);
    assert_eq!(first.groups(1), ["4"]);
    assert_eq!(first.groups(2), ["base", "front wall", "walls"]);
    assert_eq!(first.groups(3), ["block"]);
    let counts = [
        (0, "head", 1),
        (1, "4", 2),
        (2, "base", 4),
        (2, "front wall", 4),
        (2, "walls", 12),
        (3, "block", 4),
    ];
    let expected = stiffness(&model(&first));
    let scale = expected.iter().flatten().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
    for form in FILE_FORMS {
        let gmsh = read(&bytes(form)).unwrap();
        assert_eq!(gmsh.nodes().len(), first.nodes().len(), "{form}");
        for (computed, expected) in
            gmsh.nodes().as_flattened().iter().zip(first.nodes().as_flattened())
        {
            assert!((computed - expected).abs() < 1e-15, "{form}: {computed} {expected}");
        }
        for (dimension, group, count) in counts {
            let mut cells = gmsh.cells(dimension, group).unwrap();
            assert_eq!(cells.len(), count, "{form} {group}");
            // Version 2.2 has the kinds one after the other, version 4.1 the surfaces.
            let mut expected = first.cells(dimension, group).unwrap();
            cells.sort_unstable();
            expected.sort_unstable();
            assert_eq!(cells, expected, "{form} {group}");
            assert_eq!(gmsh.groups(dimension), first.groups(dimension), "{form}");
        }
        let head = gmsh.cells(0, "head").unwrap()[0][0];
        assert_eq!(gmsh.nodes()[head], [2.0, 1.0, 1.3]);
        let computed = stiffness(&model(&gmsh));
        for (computed, expected) in computed.iter().flatten().zip(expected.iter().flatten()) {
            assert!((computed - expected).abs() < 1e-12 * scale, "{form}: {computed} {expected}");
        }
        assert_eq!(model(&gmsh).mesh().elements().len(), 4 + 12 + 2);
    }
}

/// The example of the manual of version 2.2, without comments, with a line below, read in the plane.
#[test]
fn the_example_of_the_manual_of_version_2_is_read() {
    let text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 7 \"base\"\n$EndPhysicalNames\n\
        $Nodes\n6\n1 0.0 0.0 0.0\n2 1.0 0.0 0.0\n3 1.0 1.0 0.0\n4 0.0 1.0 0.0\n5 2.0 0.0 0.0\n6 2.0 1.0 0.0\n$EndNodes\n\
        $Elements\n4\n1 3 2 99 2 1 2 3 4\n2 3 2 99 2 2 5 6 3\n3 1 3 7 1 0 1 2\n4 1 2 7 1 2 5\n$EndElements\n\
        $NodeData\n1\n\"A scalar view\"\n1\n0.0\n3\n0\n1\n1\n1 0.0\n$EndNodeData\n";
    let gmsh = GmshMesh::from_reader("manual.msh", text.as_bytes()).unwrap();
    assert_eq!((gmsh.surfaces(), gmsh.lines()), (vec!["99"], vec!["base"]));
    assert_eq!(gmsh.line("base").unwrap().len(), 3);
    let concrete = Material::new(30.0e9, 0.2, 2400.0).unwrap();
    let mesh = gmsh.mesh(&[("99", concrete)]).unwrap();
    assert_eq!(FemModel::new(mesh, &gmsh.line("base").unwrap()).unwrap().dofs(), 12);
    // An element twice in one group, and wrong counts, as in version 4.1.
    for (from, to) in [
        ("4\n1 3 2 99 2 1 2 3 4\n", "5\n1 3 2 99 2 1 2 3 4\n9 3 2 99 2 1 2 3 4\n"),
        ("$Elements\n4\n", "$Elements\n3\n"),
        ("$Elements\n4\n", "$Elements\n5\n"),
        ("$Nodes\n6\n", "$Nodes\n7\n"),
        ("6 2.0 1.0 0.0", "5 2.0 1.0 0.0"),
        ("3 2 99 2 1 2 3 4", "3 -1 99 2 1 2 3 4"),
        ("1 3 2 99 2 1", "1 4 2 99 2 1"),
    ] {
        assert!(text.contains(from));
        let error =
            GmshMesh::from_reader("manual.msh", text.replacen(from, to, 1).as_bytes()).unwrap_err();
        assert!(matches!(error, Error::File(FileError { line, .. }) if line > 3), "{to}: {error}");
    }
}

/// A file that ends early is an error wherever it ends.
#[test]
fn files_that_end_early_are_errors() {
    for form in FILE_FORMS {
        let file_bytes = bytes(form);
        let end = b"$EndElements";
        let data_end =
            file_bytes.windows(end.len()).rposition(|part| part == end).unwrap() + end.len();
        for length in 0..data_end {
            match read(&file_bytes[..length]) {
                Err(Error::File(FileError { fault, .. })) => assert!(!fault.to_string().is_empty()),
                other => panic!("{form} cut at {length}: {other:?}"),
            }
        }
        assert!(read(&file_bytes[..data_end]).is_ok());
    }
}

/// Counts larger than any file are errors when the file ends, without memory for them.
#[test]
fn counts_beyond_the_file_are_errors() {
    for (form, section) in
        [("binary41", "$Nodes\n"), ("binary41", "$Elements\n"), ("binary41", "$Entities\n")]
    {
        let file_bytes = bytes(form);
        let at = file_bytes
            .windows(section.len())
            .position(|part| part == section.as_bytes())
            .unwrap()
            + section.len();
        for word in 0..4 {
            let mut changed = file_bytes.clone();
            changed[at + 8 * word..at + 8 * word + 8]
                .copy_from_slice(&(u64::MAX - 1).to_le_bytes());
            // The smallest and the largest tag are not used.
            let is_used = section == "$Entities\n" || word < 2;
            assert_eq!(read(&changed).is_err(), is_used, "{section} {word}");
        }
    }
    let text = String::from_utf8(bytes("text22")).unwrap();
    for section in ["$Nodes\n", "$Elements\n"] {
        let at = text.find(section).unwrap() + section.len();
        let end = at + text[at..].find('\n').unwrap();
        let changed = format!("{}{}{}", &text[..at], u64::MAX, &text[end..]);
        assert!(read(changed.as_bytes()).is_err());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damaged_forms_are_read_or_are_errors(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        for form in FILE_FORMS {
            let mut bytes = bytes(form);
            for (place, value) in &changes {
                let at = place.index(bytes.len());
                bytes[at] = *value;
            }
            if let Some(place) = cut {
                let at = place.index(bytes.len());
                bytes.drain(at..(at + 5).min(bytes.len()));
            }
            match read(&bytes) {
                Ok(gmsh) => prop_assert!(gmsh.nodes().iter().flatten().all(|value| value.is_finite())),
                Err(Error::File(FileError { fault, .. })) => prop_assert!(!fault.to_string().is_empty()),
                Err(other) => prop_assert!(false, "{other}"),
            }
            let _ = GmshMesh::from_reader("damaged", &bytes[..]).is_ok();
        }
    }
}

/// Two squares of the geometry with separate nodes along a common side.
#[test]
fn nodes_of_a_file_are_merged() {
    let text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n\
        $Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 1 0 0\n6 2 0 0\n7 2 1 0\n8 1.0000001 1 0\n$EndNodes\n\
        $Elements\n4\n1 3 2 9 1 1 2 3 4\n2 3 2 9 2 5 6 7 8\n3 1 2 7 1 1 2\n4 1 2 7 2 5 6\n$EndElements\n";
    let mut plane = GmshMesh::from_reader("squares.msh", text.as_bytes()).unwrap();
    let separate_count = plane.nodes().len();
    assert_eq!((plane.merge_nodes(1e-4).unwrap(), separate_count, plane.nodes().len()), (2, 8, 6));
    assert_eq!(plane.line("7").unwrap().len(), 3);
    let concrete = Material::new(30.0e9, 0.2, 2400.0).unwrap();
    assert_eq!(plane.mesh(&[("9", concrete)]).unwrap().nodes().len(), 6);
    let mut space = read(text.as_bytes()).unwrap();
    assert_eq!((space.merge_nodes(1e-4).unwrap(), space.nodes().len()), (2, 6));
    assert_eq!(space.cells(2, "9").unwrap(), [vec![0, 1, 2, 3], vec![1, 4, 5, 2]]);
    // A tolerance beyond the side of a square, or below zero, is an error.
    for tolerance in [1.2, -1.0] {
        assert!(space.merge_nodes(tolerance).is_err());
    }
    let flat_text = text.replace("4 0 1 0\n", "4 0 0.00001 0\n");
    let error = read(flat_text.as_bytes()).unwrap().merge_nodes(1e-4).unwrap_err();
    assert!(matches!(&error, Error::File(FileError { line: 17, .. })), "{error}");
}
