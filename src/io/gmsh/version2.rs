//! The sections of version 2.2 of `.msh` files (Gmsh reference manual, "MSH file format version 2").

use std::collections::{BTreeMap, HashMap};
use std::io::Read;

use super::fields::{LineResult, MshFields};
use super::kind::{AcceptedKinds, ElementKind};
use super::raw::{FileCell, FileMesh, FileNode, duplicate_fault};

/// Reads the section of nodes.
pub(super) fn nodes(fields: &mut MshFields<impl Read>, mesh: &mut FileMesh) -> LineResult<()> {
    let node_count: u64 = fields.parsed_field("number of nodes")?;
    for (_, node_index) in (0..node_count).zip(0..) {
        let tag = fields.whole_number("tag of a node")?;
        if mesh.node_indices.insert(tag, node_index).is_some() {
            return Err(fields.fault(duplicate_fault(format!("node {tag}"))));
        }
        let mut coordinates = [0.0; 3];
        for coordinate in &mut coordinates {
            *coordinate = fields.finite_number()?;
        }
        mesh.nodes.push(FileNode { coordinates, line: fields.line });
    }
    Ok(())
}

/// Reads the section of elements.
///
/// A binary file has them in blocks, a text file one by one.
pub(super) fn elements(
    fields: &mut MshFields<impl Read>,
    mesh: &mut FileMesh,
    accepted_element_kinds: &AcceptedKinds,
) -> LineResult<()> {
    let announced_count: u64 = fields.parsed_field("number of elements")?;
    let mut grouped_cells = GroupedCells::default();
    let mut read_count = 0;
    while read_count < announced_count {
        let mut single_tag = None;
        if !fields.is_binary() {
            single_tag = Some(fields.whole_number("tag of an element")?);
        }
        let kind_number: u32 = fields.whole_number("type of elements")?;
        let block_size: u64 =
            if single_tag.is_some() { 1 } else { fields.whole_number("number of elements")? };
        let tag_count: u64 = fields.whole_number("number of tags")?;
        let kind = accepted_element_kinds
            .kind(kind_number, block_size)
            .map_err(|fault| fields.fault(fault))?;
        for _ in 0..block_size {
            let tag = match single_tag {
                Some(tag) => tag,
                None => fields.whole_number("tag of an element")?,
            };
            let mut group: i64 = 0;
            let mut entity: i64 = 0;
            // The first tag is the group, the second the entity; partitions follow.
            for index in 0..tag_count {
                let value = fields.whole_number("tag of a group or an entity")?;
                match index {
                    0 => group = value,
                    1 => entity = value,
                    _ => {}
                }
            }
            let mut nodes = Vec::with_capacity(kind.node_count());
            for _ in 0..kind.node_count() {
                nodes.push(fields.whole_number("tag of a node")?);
            }
            grouped_cells.add(TaggedElement { kind, tag, nodes, line: fields.line }, entity, group);
        }
        read_count = read_count.saturating_add(block_size.max(1));
    }
    fields.check_count("elements", read_count, announced_count)?;
    grouped_cells.add_to(mesh);
    Ok(())
}

/// An element with the tags of its nodes.
struct TaggedElement {
    kind: ElementKind,
    tag: u64,
    /// Tags of the nodes.
    nodes: Vec<u64>,
    /// Line in the file.
    line: usize,
}

/// Elements with all their groups; the file repeats an element for each of its groups.
#[derive(Default)]
struct GroupedCells {
    /// Each element with the tags of its groups.
    cells: Vec<(TaggedElement, Vec<i64>)>,
    /// Index of an element by its entity and nodes.
    cell_indices: HashMap<(i64, Vec<u64>), usize>,
}

impl GroupedCells {
    /// Adds an element, or the `group` to the same element if it was added before.
    fn add(&mut self, cell: TaggedElement, entity: i64, group: i64) {
        let key = (entity, cell.nodes.clone());
        let earlier_cell = self.cell_indices.get(&key).and_then(|&index| self.cells.get_mut(index));
        let same_element = earlier_cell
            .filter(|(other, groups)| other.kind == cell.kind && !groups.contains(&group));
        if let Some((_, groups)) = same_element {
            groups.push(group);
        } else {
            self.cell_indices.insert(key, self.cells.len());
            self.cells.push((cell, vec![group]));
        }
    }

    /// Appends the elements to a mesh, with one entity for each set of groups.
    fn add_to(self, mesh: &mut FileMesh) {
        let mut entities: BTreeMap<(u8, Vec<i64>), i64> = BTreeMap::new();
        for (TaggedElement { kind, tag, nodes, line }, mut groups) in self.cells {
            // Zero stands for an element without a group.
            groups.retain(|&group| group != 0);
            groups.sort_unstable();
            let dimension = kind.dimension().try_into().unwrap_or(u8::MAX);
            let next_number = i64::try_from(entities.len()).unwrap_or(i64::MAX);
            let number = *entities.entry((dimension, groups.clone())).or_insert(next_number);
            let entity = (dimension, number);
            mesh.groups.insert(entity, groups);
            mesh.cells.push(FileCell { kind, entity, tag, nodes, line });
        }
    }
}
