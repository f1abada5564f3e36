//! Every part of the library has a row in `parts.rs`, or a reason here why not.

use std::collections::BTreeSet;
use std::path::Path;

use super::parts::{Body, Coordinate, Ground, Law, Motion, Scheme};
use super::records::FORMATS;

/// Parts without a row of their own.
const WITHOUT_ROWS: [(&str, &str); 4] = [
    (
        "FullPlaneGround",
        "the paper's scheme, which grows by itself: full_plane.rs, and tests/full_plane",
    ),
    ("FixedGround", "private: the ground of a fixed base"),
    ("RigidBase", "private: the structure of a fixed base"),
    ("OutOfPhase", "private: part of a travelling wave beyond the critical angle"),
];

/// Types for which the library's sources in a folder implement a trait.
fn implemented(name: &str, folder: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../src").join(folder);
    let mut folders = vec![root];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            // Doubles of unit tests are no parts.
            if path.file_name().is_some_and(|own| own == "tests.rs") {
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
                    found.insert(word);
                }
            }
        }
    }
    found
}

fn assert_all(name: &str, folder: &str, rows: impl IntoIterator<Item = &'static str>) {
    let mut known: BTreeSet<String> = rows.into_iter().map(str::to_owned).collect();
    known.extend(WITHOUT_ROWS.iter().map(|(part, _)| (*part).to_owned()));
    let found = implemented(name, folder);
    assert!(!found.is_empty(), "no {name} in src/{folder}");
    let missing: Vec<_> = found.difference(&known).collect();
    assert!(
        missing.is_empty(),
        "{missing:?} of {name} in src/{folder} has no row in tests/identities/parts.rs"
    );
}

/// Types of all rows of a kind of part.
macro_rules! types {
    ($kind:ident) => {
        $kind::ALL.iter().flat_map(|part| part.types().iter().copied())
    };
}

#[test]
fn all_parts_of_the_library_have_rows() {
    for folder in ["bem", "coupled"] {
        assert_all("Ground", folder, types!(Ground));
    }
    for folder in ["structure", "coupled"] {
        assert_all("Structure", folder, types!(Body));
    }
    assert_all("Element", "fem", types!(Body));
    assert_all("InterfaceLaw", "interface", types!(Law));
    assert_all("FreeField", "motion", types!(Motion));
    assert_all("FreeField", "site", types!(Motion));
    assert_all("TimeScheme", "coupled/scheme", types!(Scheme));
    assert_all("RecordFormat", "motion", FORMATS);
}

/// No row of the table names a part that the library has not.
#[test]
fn rows_name_parts_of_the_library() {
    let all = [
        ("Ground", "bem"),
        ("Structure", "structure"),
        ("Element", "fem"),
        ("InterfaceLaw", "interface"),
        ("FreeField", "motion"),
        ("FreeField", "site"),
        ("TimeScheme", "coupled/scheme"),
    ];
    let mut known = BTreeSet::new();
    for (name, folder) in all {
        known.extend(implemented(name, folder));
    }
    let rows = types!(Ground).chain(types!(Body)).chain(types!(Law));
    for part in rows.chain(types!(Motion)).chain(types!(Scheme)).chain(types!(Coordinate)) {
        assert!(known.contains(part), "{part} is no part of the library");
    }
}
