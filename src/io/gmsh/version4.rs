//! The sections of version 4.1 of `.msh` files (Gmsh reference manual, "MSH file format").

use std::io::Read;

use super::fields::{LineResult, MshFields};
use super::kind::AcceptedKinds;
use super::raw::{FileCell, FileMesh, FilePoint, given_twice};

/// Reads the parts of a partitioned mesh: separate entities, with the groups of their parents.
pub(super) fn partitioned_entities(
    fields: &mut MshFields<impl Read>,
    mesh: &mut FileMesh,
) -> LineResult<()> {
    fields.size("number of partitions")?;
    let ghosts = fields.size("number of ghost entities")?;
    for _ in 0..ghosts {
        let _: i64 = fields.int("tag of a ghost entity")?;
        let _: i64 = fields.int("partition")?;
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
        *count = fields.size("number of entities")?;
    }
    for (dimension, count) in (0_u8..).zip(counts) {
        for _ in 0..count {
            let tag: i64 = fields.int("tag of an entity")?;
            if is_partitioned {
                let _: u8 = fields.int("dimension of the parent")?;
                let _: i64 = fields.int("tag of the parent")?;
                let partitions = fields.size("number of partitions")?;
                for _ in 0..partitions {
                    let _: i64 = fields.int("partition")?;
                }
            }
            // A point has its coordinates; other entities have the corners of a box, which may be infinite.
            for _ in 0..if dimension == 0 { 3 } else { 6 } {
                fields.real("coordinate of an entity")?;
            }
            let number = fields.size("number of groups")?;
            let mut groups: Vec<i64> = Vec::new();
            for _ in 0..number {
                groups.push(fields.int("tag of a group")?);
            }
            let groups_before = mesh.groups.get(&(dimension, tag));
            let differs =
                groups_before.is_some_and(|before| *before != groups && !groups.is_empty());
            if differs && !is_partitioned {
                let item = format!("group of entity {tag} of dimension {dimension}");
                return Err(fields.fault(given_twice(item)));
            }
            if !groups.is_empty() {
                mesh.groups.insert((dimension, tag), groups);
            }
            if dimension > 0 {
                let bounds = fields.size("number of bounding entities")?;
                for _ in 0..bounds {
                    let _: i64 = fields.int("tag of a bounding entity")?;
                }
            }
        }
    }
    Ok(())
}

/// Reads the section of nodes.
pub(super) fn nodes(fields: &mut MshFields<impl Read>, mesh: &mut FileMesh) -> LineResult<()> {
    let BlockCounts { blocks, entries } = block_counts(fields, "number of nodes")?;
    for _ in 0..blocks {
        let dimension: usize = fields.int("dimension of an entity")?;
        let _: i64 = fields.int("tag of an entity")?;
        let parametric: u8 = fields.int("0 or 1")?;
        let count = fields.size("number of nodes")?;
        let first = mesh.coordinates.len();
        for (_, place) in (0..count).zip(first..) {
            let tag = fields.size("tag of a node")?;
            if mesh.places.insert(tag, place).is_some() {
                return Err(fields.fault(given_twice(format!("node {tag}"))));
            }
        }
        for _ in 0..count {
            let mut values = [0.0; 3];
            for value in &mut values {
                *value = fields.number()?;
            }
            mesh.coordinates.push(FilePoint { values, line: fields.line });
            for _ in 0..if parametric == 0 { 0 } else { dimension.min(3) } {
                fields.number()?;
            }
        }
    }
    fields.check_count("nodes", mesh.coordinates.len() as u64, entries)
}

/// Numbers of blocks and of entries in them.
struct BlockCounts {
    blocks: u64,
    entries: u64,
}

/// Reads the head of a section; the smallest and the largest tag follow the counts.
fn block_counts(fields: &mut MshFields<impl Read>, item: &'static str) -> LineResult<BlockCounts> {
    let blocks = fields.size("number of blocks")?;
    let entries = fields.size(item)?;
    fields.size("smallest tag")?;
    fields.size("largest tag")?;
    Ok(BlockCounts { blocks, entries })
}

/// Reads the section of elements.
pub(super) fn elements(
    fields: &mut MshFields<impl Read>,
    mesh: &mut FileMesh,
    accepted: &AcceptedKinds,
) -> LineResult<()> {
    let BlockCounts { blocks, entries } = block_counts(fields, "number of elements")?;
    for _ in 0..blocks {
        let entity = (fields.int("dimension of an entity")?, fields.int("tag of an entity")?);
        let number: u32 = fields.int("type of elements")?;
        let count = fields.size("number of elements")?;
        let kind = accepted.kind(number, count).map_err(|fault| fields.fault(fault))?;
        for _ in 0..count {
            let tag = fields.size("tag of an element")?;
            let mut nodes = Vec::with_capacity(kind.nodes());
            for _ in 0..kind.nodes() {
                nodes.push(fields.size("tag of a node")?);
            }
            mesh.cells.push(FileCell { kind, entity, tag, nodes, line: fields.line });
        }
    }
    fields.check_count("elements", mesh.cells.len() as u64, entries)
}
