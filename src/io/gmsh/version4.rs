//! The sections of version 4.1 of `.msh` files (Gmsh reference manual, "MSH file format").

use std::io::Read;

use super::fields::{LineResult, MshFields};
use super::kind::AcceptedKinds;
use super::raw::{FileCell, FileMesh, FileNode, duplicate_fault};

/// Reads the parts of a partitioned mesh: separate entities, with the groups of their parents.
pub(super) fn partitioned_entities(
    fields: &mut MshFields<impl Read>,
    mesh: &mut FileMesh,
) -> LineResult<()> {
    fields.count_or_tag("number of partitions")?;
    let ghost_count = fields.count_or_tag("number of ghost entities")?;
    for _ in 0..ghost_count {
        let _: i64 = fields.whole_number("tag of a ghost entity")?;
        let _: i64 = fields.whole_number("partition")?;
    }
    entities(fields, mesh, true)
}

/// Reads the section of entities.
pub(super) fn entities(
    fields: &mut MshFields<impl Read>,
    mesh: &mut FileMesh,
    is_partitioned: bool,
) -> LineResult<()> {
    let mut counts = [0; 4];
    for count in &mut counts {
        *count = fields.count_or_tag("number of entities")?;
    }
    for (dimension, count) in (0_u8..).zip(counts) {
        for _ in 0..count {
            let tag: i64 = fields.whole_number("tag of an entity")?;
            if is_partitioned {
                let _: u8 = fields.whole_number("dimension of the parent")?;
                let _: i64 = fields.whole_number("tag of the parent")?;
                let partition_count = fields.count_or_tag("number of partitions")?;
                for _ in 0..partition_count {
                    let _: i64 = fields.whole_number("partition")?;
                }
            }
            // A point has 3 coordinates; other entities have the corners of a box, which may be infinite.
            for _ in 0..if dimension == 0 { 3 } else { 6 } {
                fields.real("coordinate of an entity")?;
            }
            let group_count = fields.count_or_tag("number of groups")?;
            let mut groups: Vec<i64> = Vec::new();
            for _ in 0..group_count {
                groups.push(fields.whole_number("tag of a group")?);
            }
            let earlier_groups = mesh.groups.get(&(dimension, tag));
            let has_other_groups =
                earlier_groups.is_some_and(|earlier| *earlier != groups && !groups.is_empty());
            if has_other_groups && !is_partitioned {
                let item = format!("group of entity {tag} of dimension {dimension}");
                return Err(fields.fault(duplicate_fault(item)));
            }
            if !groups.is_empty() {
                mesh.groups.insert((dimension, tag), groups);
            }
            if dimension > 0 {
                let boundary_count = fields.count_or_tag("number of bounding entities")?;
                for _ in 0..boundary_count {
                    let _: i64 = fields.whole_number("tag of a bounding entity")?;
                }
            }
        }
    }
    Ok(())
}

/// Reads the section of nodes.
pub(super) fn nodes(fields: &mut MshFields<impl Read>, mesh: &mut FileMesh) -> LineResult<()> {
    let BlockCounts { block_count, entry_count } = block_counts(fields, "number of nodes")?;
    for _ in 0..block_count {
        let dimension: usize = fields.whole_number("dimension of an entity")?;
        let _: i64 = fields.whole_number("tag of an entity")?;
        let parametric_flag: u8 = fields.whole_number("0 or 1")?;
        let node_count = fields.count_or_tag("number of nodes")?;
        let first_index = mesh.nodes.len();
        for (_, node_index) in (0..node_count).zip(first_index..) {
            let tag = fields.count_or_tag("tag of a node")?;
            if mesh.node_indices.insert(tag, node_index).is_some() {
                return Err(fields.fault(duplicate_fault(format!("node {tag}"))));
            }
        }
        for _ in 0..node_count {
            let mut coordinates = [0.0; 3];
            for coordinate in &mut coordinates {
                *coordinate = fields.finite_number()?;
            }
            mesh.nodes.push(FileNode { coordinates, line: fields.line });
            for _ in 0..if parametric_flag == 0 { 0 } else { dimension.min(3) } {
                fields.finite_number()?;
            }
        }
    }
    fields.check_count("nodes", mesh.nodes.len() as u64, entry_count)
}

/// Counts at the beginning of a section of nodes or elements.
struct BlockCounts {
    block_count: u64,
    /// Number of nodes or elements in all blocks.
    entry_count: u64,
}

/// Reads the counts and the range of tags at the beginning of a section.
fn block_counts(fields: &mut MshFields<impl Read>, item: &'static str) -> LineResult<BlockCounts> {
    let block_count = fields.count_or_tag("number of blocks")?;
    let entry_count = fields.count_or_tag(item)?;
    fields.count_or_tag("smallest tag")?;
    fields.count_or_tag("largest tag")?;
    Ok(BlockCounts { block_count, entry_count })
}

/// Reads the section of elements.
pub(super) fn elements(
    fields: &mut MshFields<impl Read>,
    mesh: &mut FileMesh,
    accepted_element_kinds: &AcceptedKinds,
) -> LineResult<()> {
    let BlockCounts { block_count, entry_count } = block_counts(fields, "number of elements")?;
    for _ in 0..block_count {
        let entity = (
            fields.whole_number("dimension of an entity")?,
            fields.whole_number("tag of an entity")?,
        );
        let kind_number: u32 = fields.whole_number("type of elements")?;
        let element_count = fields.count_or_tag("number of elements")?;
        let kind = accepted_element_kinds
            .kind(kind_number, element_count)
            .map_err(|fault| fields.fault(fault))?;
        for _ in 0..element_count {
            let tag = fields.count_or_tag("tag of an element")?;
            let mut nodes = Vec::with_capacity(kind.node_count());
            for _ in 0..kind.node_count() {
                nodes.push(fields.count_or_tag("tag of a node")?);
            }
            mesh.cells.push(FileCell { kind, entity, tag, nodes, line: fields.line });
        }
    }
    fields.check_count("elements", mesh.cells.len() as u64, entry_count)
}
