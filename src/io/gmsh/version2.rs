//! The sections of version 2.2 of `.msh` files (Gmsh reference manual, "MSH file format version 2").

use std::collections::{BTreeMap, HashMap};
use std::io::Read;

use super::fields::{LineResult, MshFields};
use super::kind::{AcceptedKinds, ElementKind};
use super::raw::{FileCell, FileMesh, FilePoint, given_twice};

/// Reads the section of nodes.
pub(super) fn nodes(fields: &mut MshFields<impl Read>, mesh: &mut FileMesh) -> LineResult<()> {
    let count: u64 = fields.text("number of nodes")?;
    for (_, place) in (0..count).zip(0..) {
        let tag = fields.int("tag of a node")?;
        if mesh.places.insert(tag, place).is_some() {
            return Err(fields.fault(given_twice(format!("node {tag}"))));
        }
        let mut values = [0.0; 3];
        for value in &mut values {
            *value = fields.number()?;
        }
        mesh.coordinates.push(FilePoint { values, line: fields.line });
    }
    Ok(())
}

/// Reads the section of elements, which come in blocks in a binary file, one by one in a text.
pub(super) fn elements(
    fields: &mut MshFields<impl Read>,
    mesh: &mut FileMesh,
    accepted: &AcceptedKinds,
) -> LineResult<()> {
    let announced: u64 = fields.text("number of elements")?;
    let mut grouped = GroupedCells::default();
    let mut found = 0;
    while found < announced {
        let mut single_tag = None;
        if !fields.is_binary() {
            single_tag = Some(fields.int("tag of an element")?);
        }
        let number: u32 = fields.int("type of elements")?;
        let count: u64 = if single_tag.is_some() { 1 } else { fields.int("number of elements")? };
        let tags: u64 = fields.int("number of tags")?;
        let kind = accepted.kind(number, count).map_err(|fault| fields.fault(fault))?;
        for _ in 0..count {
            let tag = match single_tag {
                Some(tag) => tag,
                None => fields.int("tag of an element")?,
            };
            let mut group: i64 = 0;
            let mut entity: i64 = 0;
            // Behind them stand the partitions.
            for k in 0..tags {
                let value = fields.int("tag of a group or an entity")?;
                match k {
                    0 => group = value,
                    1 => entity = value,
                    _ => {}
                }
            }
            let mut nodes = Vec::with_capacity(kind.nodes());
            for _ in 0..kind.nodes() {
                nodes.push(fields.int("tag of a node")?);
            }
            grouped.add(TaggedElement { kind, tag, nodes, line: fields.line }, entity, group);
        }
        found = found.saturating_add(count.max(1));
    }
    fields.check_count("elements", found, announced)?;
    grouped.finish(mesh);
    Ok(())
}

/// An element with the tags of its nodes.
struct TaggedElement {
    kind: ElementKind,
    tag: u64,
    nodes: Vec<u64>,
    line: usize,
}

/// Elements with all their groups: an element of several groups stands in the file once for each.
#[derive(Default)]
struct GroupedCells {
    cells: Vec<(TaggedElement, Vec<i64>)>,
    /// Index of an element by its entity and nodes.
    index: HashMap<(i64, Vec<u64>), usize>,
}

impl GroupedCells {
    /// Adds an element, or the `group` to an element that stood before.
    fn add(&mut self, cell: TaggedElement, entity: i64, group: i64) {
        let key = (entity, cell.nodes.clone());
        let before = self.index.get(&key).and_then(|&index| self.cells.get_mut(index));
        let same_element =
            before.filter(|(other, groups)| other.kind == cell.kind && !groups.contains(&group));
        if let Some((_, groups)) = same_element {
            groups.push(group);
        } else {
            self.index.insert(key, self.cells.len());
            self.cells.push((cell, vec![group]));
        }
    }

    /// Appends the elements to a mesh, each in an entity for its set of groups.
    fn finish(self, mesh: &mut FileMesh) {
        let mut entities: BTreeMap<(u8, Vec<i64>), i64> = BTreeMap::new();
        for (TaggedElement { kind, tag, nodes, line }, mut groups) in self.cells {
            // Zero stands for an element without a group.
            groups.retain(|&group| group != 0);
            groups.sort_unstable();
            let dimension = kind.dimension().try_into().unwrap_or(u8::MAX);
            let next = i64::try_from(entities.len()).unwrap_or(i64::MAX);
            let number = *entities.entry((dimension, groups.clone())).or_insert(next);
            let entity = (dimension, number);
            mesh.groups.insert(entity, groups);
            mesh.cells.push(FileCell { kind, entity, tag, nodes, line });
        }
    }
}
