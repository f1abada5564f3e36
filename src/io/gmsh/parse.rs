//! Reads a `.msh` file of version 2.2 or 4.1, as text or binary (Gmsh reference manual, "MSH file format").

use std::io::Read;

use super::fields::{LineResult, MshFields};
use super::kind::AcceptedKinds;
use super::raw::{FileMesh, duplicate_fault};
use super::{version2, version4};
use crate::error::FileFault;
use crate::text::decimal::excerpt;

/// Major version of the format.
#[derive(Clone, Copy, PartialEq)]
enum MshVersion {
    Two,
    Four,
}

/// Reads the nodes and elements of a file; an error for other kinds of elements.
pub(super) fn read(
    source: impl Read,
    accepted_element_kinds: &AcceptedKinds,
) -> LineResult<FileMesh> {
    let mut fields = MshFields::new(source);
    let mut mesh = FileMesh::default();
    let mut completed_sections = Vec::new();
    // A section before the section of the format is read as one of version 4.
    let mut version = None;
    while let Some(section) = fields.next_section()? {
        if completed_sections.contains(&section) {
            return Err(fields.fault(duplicate_fault(format!("section ${section}"))));
        }
        let may_be_version_4 = version != Some(MshVersion::Two);
        match section.as_str() {
            "MeshFormat" => version = Some(read_format_version(&mut fields)?),
            "PhysicalNames" => read_physical_names(&mut fields, &mut mesh)?,
            "Entities" if may_be_version_4 => {
                let is_partitioned = false;
                version4::entities(&mut fields, &mut mesh, is_partitioned)?;
            }
            "PartitionedEntities" if may_be_version_4 => {
                version4::partitioned_entities(&mut fields, &mut mesh)?;
            }
            "Nodes" if may_be_version_4 => version4::nodes(&mut fields, &mut mesh)?,
            "Elements" if may_be_version_4 => {
                version4::elements(&mut fields, &mut mesh, accepted_element_kinds)?;
            }
            "Nodes" => version2::nodes(&mut fields, &mut mesh)?,
            "Elements" => version2::elements(&mut fields, &mut mesh, accepted_element_kinds)?,
            _ => {
                fields.skip_section(&section)?;
                continue;
            }
        }
        fields.end_section(&section)?;
        completed_sections.push(section);
    }
    for section in ["MeshFormat", "Nodes", "Elements"] {
        if !completed_sections.iter().any(|name| name == section) {
            return Err((0, FileFault::missing(format!("section ${section}"))));
        }
    }
    Ok(mesh)
}

/// Reads the section with the version of the format.
fn read_format_version(fields: &mut MshFields<impl Read>) -> LineResult<MshVersion> {
    let version_text: String = fields.parsed_field("version of the format")?;
    let binary_flag: u8 = fields.parsed_field("0 for text, 1 for binary")?;
    let bytes_per_number: u8 = fields.parsed_field("bytes of a number")?;
    let version = match version_text.as_str() {
        "4.1" => MshVersion::Four,
        "2.2" | "2.1" | "2" => MshVersion::Two,
        _ => {
            let found_text = format!("format {}", excerpt(&version_text));
            return Err(fields.fault(FileFault::format(found_text, "format 4.1 or 2.2")));
        }
    };
    if binary_flag > 0 {
        if bytes_per_number != 8 {
            let found_text = format!("binary numbers of {bytes_per_number} bytes");
            return Err(fields.fault(FileFault::format(found_text, "numbers of 8 bytes")));
        }
        fields.begin_binary()?;
    }
    Ok(version)
}

/// Reads the section with the names of groups.
fn read_physical_names(fields: &mut MshFields<impl Read>, mesh: &mut FileMesh) -> LineResult<()> {
    let count: usize = fields.parsed_field("number of names")?;
    for _ in 0..count {
        let group_key = (fields.parsed_field("dimension")?, fields.parsed_field("tag of a group")?);
        let name = fields.quoted_text()?;
        if mesh.group_names.insert(group_key, name).is_some() {
            let item = format!("name of group {} of dimension {}", group_key.1, group_key.0);
            return Err(fields.fault(duplicate_fault(item)));
        }
    }
    Ok(())
}
