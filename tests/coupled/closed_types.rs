//! GOAL: every type that is read returns an error for unknown keys, also the results of long computations.
//! SCENE: all types with `Deserialize` in the sources of the library.
//! REFERENCE: the attributes in the sources.

use std::path::{Path, PathBuf};

#[test]
fn every_type_that_is_read_is_closed() {
    fn collect_files(folder: &Path, files: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                collect_files(&path, files);
            } else {
                files.push(path);
            }
        }
    }

    let mut files = Vec::new();
    for folder in ["../src", "../crates"] {
        collect_files(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder), &mut files);
    }
    files.retain(|file| file.extension().is_some_and(|extension| extension == "rs"));
    let mut types = 0;
    for file in files {
        // Types within macros are indented.
        let text = std::fs::read_to_string(&file).unwrap();
        let text: String = text.lines().flat_map(|line| [line.trim_start(), "\n"]).collect();
        for attribute in
            text.split("Deserialize))]\n").skip(1).chain(text.split("Deserialize)]\n").skip(1))
        {
            types += 1;
            let (attributes, body) = attribute.split_once(" {").unwrap_or((attribute, ""));
            let body = body.split("\n}").next().unwrap_or_default();
            let rules = ["deny_unknown_fields", "try_from", "transparent"];
            let is_enum = attributes.contains("enum ");
            let has_fields = !is_enum || body.lines().any(|line| line.ends_with(" {"));
            let is_unit = attributes.lines().any(|line| line.ends_with(';'));
            let is_closed = rules.iter().any(|rule| attributes.contains(rule));
            assert!(is_closed || is_unit || !has_fields, "{}: {attributes}", file.display());
        }
    }
    assert!(types > 80, "{types}");
}
