//! Nodes and elements of a file that refer to each other by tags.

use std::collections::BTreeMap;

use super::kind::ElementKind;
use crate::error::FileFault;

/// A node of the file.
#[derive(Debug)]
pub(super) struct FileNode {
    /// Coordinates x, y, z, m.
    pub(super) coordinates: [f64; 3],
    /// Line in the file.
    pub(super) line: usize,
}

/// An element of the file.
#[derive(Debug)]
pub(super) struct FileCell {
    pub(super) kind: ElementKind,
    /// Dimension and tag of its geometric entity.
    pub(super) entity: (u8, i64),
    pub(super) tag: u64,
    /// Tags of its nodes.
    pub(super) nodes: Vec<u64>,
    /// Line in the file.
    pub(super) line: usize,
}

/// Content of the sections of a file that a mesh needs.
#[derive(Debug, Default)]
pub(super) struct FileMesh {
    pub(super) nodes: Vec<FileNode>,
    /// Index in `nodes` of each node tag.
    pub(super) node_indices: BTreeMap<u64, usize>,
    pub(super) cells: Vec<FileCell>,
    /// Tags of the physical groups of each entity.
    pub(super) groups: BTreeMap<(u8, i64), Vec<i64>>,
    /// Names of the physical groups, by their dimension and tag.
    pub(super) group_names: BTreeMap<(u8, i64), String>,
}

impl FileMesh {
    /// Whether `cell` is in a physical group.
    pub(super) fn is_in_group(&self, cell: &FileCell) -> bool {
        self.groups.get(&cell.entity).is_some_and(|groups| !groups.is_empty())
    }

    /// Sorted names of the physical groups of an element.
    ///
    /// A group without a name has its number as name. An element without a group has one empty name.
    pub(super) fn groups(&self, cell: &FileCell) -> Vec<String> {
        let tags = self.groups.get(&cell.entity).map_or(&[][..], Vec::as_slice);
        let mut names = Vec::new();
        for tag in tags {
            // A minus sign means that the entity's direction is reversed in its group.
            let key = (cell.entity.0, tag.saturating_abs());
            names.push(self.group_names.get(&key).cloned().unwrap_or_else(|| key.1.to_string()));
        }
        names.sort_unstable();
        names.dedup();
        if names.is_empty() {
            names.push(String::new());
        }
        names
    }
}

/// Fault of an item that the file may have only once.
pub(super) fn duplicate_fault(item: impl Into<String>) -> FileFault {
    FileFault::value(item, "given twice", "given once")
}
