//! GOAL: every part of the library has a row in `parts.rs`, or a reason here why it has none.
//! SCENE: all types that implement a trait of parts.
//! REFERENCE: the sources of the library.

use std::collections::BTreeSet;
use std::path::Path;

use super::parts::{BodyPart, CoordinatePart, GroundPart, LawPart, MotionPart, SchemePart};
use super::records::FORMAT_NAMES;

/// Parts without a row, and the reason.
const WITHOUT_ROWS: [(&str, &str); 13] = [
    ("FiberBeam", "beside linear beams in coupled/fibre_frames.rs"),
    ("Hinge", "turned and mirrored in yielding_hinges.rs, in frames in coupled/hinges.rs"),
    ("InteractionHinge", "as Hinge"),
    ("SpaceHinge", "as Hinge"),
    (
        "SpaceFiberBeam",
        "beside beams and frames in the plane, and turned: fiber_beams.rs, fiber_frames.rs",
    ),
    (
        "FullPlaneGround",
        "the paper's scheme, which grows by itself: full_plane.rs, and tests/full_plane",
    ),
    ("FixedGround", "private: the ground of a fixed base"),
    ("StructureOnRigidFoundations", "private: the structure of a fixed base"),
    (
        "WithElements",
        "beside a finite-element model in structures/matrices/yielding_elements.rs",
    ),
    ("NoStructure", "private: takes the place of a structure that a fixed base has returned"),
    ("SharedLaw", "private: one law in the places of several elements"),
    ("IncoherentMotion", "random at the elements of one ground: tests/motion/incoherent.rs"),
    ("OutOfPhase", "private: part of a travelling wave beyond the critical angle"),
];

/// Types for which the library's sources in a folder implement a trait.
fn implemented(name: &str, folder: &str) -> BTreeSet<String> {
    let mut types = BTreeSet::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../src").join(folder);
    let mut folders = vec![root];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            // Types of unit tests are no parts.
            if path.file_name().is_some_and(|file| file == "tests.rs") {
                continue;
            }
            let text = std::fs::read_to_string(path).unwrap();
            let text = text.split("\nmod tests {").next().unwrap_or_default();
            let start = format!("{name} for ");
            let lines = text.lines().map(str::trim).filter(|line| line.starts_with("impl "));
            for line in lines {
                let Some((_, rest)) = line.split_once(&start) else { continue };
                let word: String = rest.chars().take_while(|c| c.is_alphanumeric()).collect();
                if !word.is_empty() {
                    types.insert(word);
                }
            }
        }
    }
    types
}

/// Asserts that all types of a folder with this trait are in the rows.
fn assert_all(name: &str, folder: &str, rows: impl IntoIterator<Item = &'static str>) {
    let mut listed_types: BTreeSet<String> = rows.into_iter().map(str::to_owned).collect();
    listed_types.extend(WITHOUT_ROWS.iter().map(|(part, _)| (*part).to_owned()));
    let types = implemented(name, folder);
    assert!(!types.is_empty(), "no {name} in src/{folder}");
    let missing_types: Vec<_> = types.difference(&listed_types).collect();
    assert!(
        missing_types.is_empty(),
        "{missing_types:?} of {name} in src/{folder} has no row in tests/identities/parts.rs"
    );
}

/// Types of all rows of a kind of part.
macro_rules! types {
    ($kind:ident) => {
        $kind::ALL_PARTS.iter().flat_map(|part| part.types().iter().copied())
    };
}

/// GOAL: every part of the library has a row.
#[test]
fn all_parts_of_the_library_have_rows() {
    for folder in ["bem", "coupled"] {
        assert_all("Ground", folder, types!(GroundPart));
    }
    for folder in ["../crates/structures/src/structure", "coupled"] {
        assert_all("Structure", folder, types!(BodyPart));
    }
    assert_all("Element", "../crates/structures/src/fem", types!(BodyPart));
    assert_all("SolidMaterial", "../crates/structures/src/fem/solid", types!(BodyPart));
    assert_all("InterfaceLaw", "interface", types!(LawPart));
    assert_all("FreeField", "motion", types!(MotionPart));
    assert_all("FreeField", "site", types!(MotionPart));
    assert_all("TimeScheme", "coupled/scheme", types!(SchemePart));
    assert_all("RecordFormat", "../crates/records/src", FORMAT_NAMES);
}

/// GOAL: every part of a row exists in the library.
#[test]
fn rows_name_parts_of_the_library() {
    let mut existing = BTreeSet::new();
    for (name, folder) in [
        ("Ground", "bem"),
        ("Structure", "../crates/structures/src/structure"),
        ("Element", "../crates/structures/src/fem"),
        ("SolidMaterial", "../crates/structures/src/fem/solid"),
        ("InterfaceLaw", "interface"),
        ("FreeField", "motion"),
        ("FreeField", "site"),
        ("TimeScheme", "coupled/scheme"),
    ] {
        existing.extend(implemented(name, folder));
    }
    let rows = types!(GroundPart).chain(types!(BodyPart)).chain(types!(LawPart));
    for part in rows
        .chain(types!(MotionPart))
        .chain(types!(SchemePart))
        .chain(types!(CoordinatePart))
    {
        assert!(existing.contains(part), "{part} is no part of the library");
    }
}
