//! The sections of version 4.1 of `.msh` files (Gmsh reference manual, "MSH file format").

use std::io::Read;

use super::fields::{Fields, Reason};
use super::kind::Accepted;
use super::raw::{Point, Raw, RawCell, twice};

/// The parts of a partitioned mesh: separate entities, with the groups of their parents.
pub(super) fn partitioned_entities(fields: &mut Fields<impl Read>, raw: &mut Raw) -> Reason<()> {
    fields.size("number of partitions")?;
    let ghosts = fields.size("number of ghost entities")?;
    for _ in 0..ghosts {
        let _: i64 = fields.int("tag of a ghost entity")?;
        let _: i64 = fields.int("partition")?;
    }
    entities(fields, raw, true)
}

pub(super) fn entities(
    fields: &mut Fields<impl Read>,
    raw: &mut Raw,
    partitioned: bool,
) -> Reason<()> {
    let mut counts = [0; 4];
    for count in &mut counts {
        *count = fields.size("number of entities")?;
    }
    for (dimension, count) in (0_u8..).zip(counts) {
        for _ in 0..count {
            let tag: i64 = fields.int("tag of an entity")?;
            if partitioned {
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
            let before = raw.groups.get(&(dimension, tag));
            let other = before.is_some_and(|before| *before != groups && !groups.is_empty());
            if other && !partitioned {
                let what = format!("group of entity {tag} of dimension {dimension}");
                return Err(fields.refuse(twice(what)));
            }
            if !groups.is_empty() {
                raw.groups.insert((dimension, tag), groups);
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

pub(super) fn nodes(fields: &mut Fields<impl Read>, raw: &mut Raw) -> Reason<()> {
    let (blocks, announced) = counts(fields, "number of nodes")?;
    for _ in 0..blocks {
        let dimension: usize = fields.int("dimension of an entity")?;
        let _: i64 = fields.int("tag of an entity")?;
        let parametric: u8 = fields.int("0 or 1")?;
        let count = fields.size("number of nodes")?;
        let first = raw.coordinates.len();
        for (_, place) in (0..count).zip(first..) {
            let tag = fields.size("tag of a node")?;
            if raw.places.insert(tag, place).is_some() {
                return Err(fields.refuse(twice(format!("node {tag}"))));
            }
        }
        for _ in 0..count {
            let mut values = [0.0; 3];
            for value in &mut values {
                *value = fields.number()?;
            }
            raw.coordinates.push(Point { values, line: fields.line });
            for _ in 0..if parametric == 0 { 0 } else { dimension.min(3) } {
                fields.number()?;
            }
        }
    }
    fields.agree("nodes", raw.coordinates.len() as u64, announced)
}

/// Numbers of blocks and of entries in them; the smallest and the largest tag follow in the file.
fn counts(fields: &mut Fields<impl Read>, what: &'static str) -> Reason<(u64, u64)> {
    let counts = (fields.size("number of blocks")?, fields.size(what)?);
    for tag in ["smallest tag", "largest tag"] {
        fields.size(tag)?;
    }
    Ok(counts)
}

pub(super) fn elements(
    fields: &mut Fields<impl Read>,
    raw: &mut Raw,
    accepted: &Accepted,
) -> Reason<()> {
    let (blocks, announced) = counts(fields, "number of elements")?;
    for _ in 0..blocks {
        let entity = (fields.int("dimension of an entity")?, fields.int("tag of an entity")?);
        let number: u32 = fields.int("type of elements")?;
        let count = fields.size("number of elements")?;
        let kind = accepted.kind(number, count).map_err(|reason| fields.refuse(reason))?;
        for _ in 0..count {
            let tag = fields.size("tag of an element")?;
            let mut nodes = Vec::with_capacity(kind.nodes());
            for _ in 0..kind.nodes() {
                nodes.push(fields.size("tag of a node")?);
            }
            raw.cells.push(RawCell { kind, entity, tag, nodes, line: fields.line });
        }
    }
    fields.agree("elements", raw.cells.len() as u64, announced)
}
