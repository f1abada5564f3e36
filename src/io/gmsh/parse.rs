//! A `.msh` file, version 2.2 or 4.1, as text or binary (Gmsh reference manual, "MSH file format").

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::fields::{Fields, Reason};
use super::kind::Accepted;
use super::raw::{Raw, twice};
use super::{version2, version4};
use crate::error::{Error, FileFault};
use crate::text::decimal::excerpt;

/// Version of the format.
#[derive(Clone, Copy, PartialEq)]
enum Version {
    Two,
    Four,
}

/// The file at `path` and its name.
pub(super) fn open(path: &Path) -> Result<(String, File), Error> {
    let name = path.display().to_string();
    match File::open(path) {
        Ok(file) => Ok((name, file)),
        Err(error) => Err(FileFault::Unreadable(error.kind()).of(name, 0)),
    }
}

/// Reads a file whose elements are of the `accepted` kinds.
pub(super) fn read(source: impl Read, accepted: &Accepted) -> Reason<Raw> {
    let mut fields = Fields::new(source);
    let mut raw = Raw::default();
    let mut seen = Vec::new();
    // The numbers of other sections cannot be read before the format is known.
    let mut version = None;
    while let Some(section) = fields.section()? {
        if seen.contains(&section) {
            return Err(fields.refuse(twice(format!("section ${section}"))));
        }
        let four = version != Some(Version::Two);
        match section.as_str() {
            "MeshFormat" => version = Some(format(&mut fields)?),
            "PhysicalNames" => physical_names(&mut fields, &mut raw)?,
            "Entities" if four => version4::entities(&mut fields, &mut raw, false)?,
            "PartitionedEntities" if four => version4::partitioned_entities(&mut fields, &mut raw)?,
            "Nodes" if four => version4::nodes(&mut fields, &mut raw)?,
            "Elements" if four => version4::elements(&mut fields, &mut raw, accepted)?,
            "Nodes" => version2::nodes(&mut fields, &mut raw)?,
            "Elements" => version2::elements(&mut fields, &mut raw, accepted)?,
            _ => {
                fields.pass_over(&section)?;
                continue;
            }
        }
        fields.end(&section)?;
        seen.push(section);
    }
    for needed in ["MeshFormat", "Nodes", "Elements"] {
        if !seen.iter().any(|section| section == needed) {
            return Err((0, FileFault::missing(format!("section ${needed}"))));
        }
    }
    Ok(raw)
}

fn format(fields: &mut Fields<impl Read>) -> Reason<Version> {
    let version: String = fields.text("version of the format")?;
    let binary: u8 = fields.text("0 for text, 1 for binary")?;
    let size: u8 = fields.text("size of a number")?;
    let known = match version.as_str() {
        "4.1" => Version::Four,
        "2.2" | "2.1" | "2" => Version::Two,
        _ => {
            let found = format!("format {}", excerpt(&version));
            return Err(fields.refuse(FileFault::format(found, "format 4.1 or 2.2")));
        }
    };
    if binary > 0 {
        if size != 8 {
            let found = format!("binary numbers of {size} bytes");
            return Err(fields.refuse(FileFault::format(found, "numbers of 8 bytes")));
        }
        fields.begin_binary()?;
    }
    Ok(known)
}

fn physical_names(fields: &mut Fields<impl Read>, raw: &mut Raw) -> Reason<()> {
    let count: usize = fields.text("number of names")?;
    for _ in 0..count {
        let key = (fields.text("dimension")?, fields.text("tag of a group")?);
        let name = fields.quoted()?;
        if raw.names.insert(key, name).is_some() {
            let what = format!("name of group {} of dimension {}", key.1, key.0);
            return Err(fields.refuse(twice(what)));
        }
    }
    Ok(())
}
