//! Nodes and elements of a file by their tags.

use std::collections::BTreeMap;

use super::kind::ElementKind;
use crate::error::FileFault;

/// A node of the file.
#[derive(Debug)]
pub(super) struct FilePoint {
    /// Coordinates x, y, z.
    pub(super) values: [f64; 3],
    pub(super) line: usize,
}

/// An element of the file; its nodes are tags.
#[derive(Debug)]
pub(super) struct FileCell {
    pub(super) kind: ElementKind,
    /// Dimension and tag of its entity.
    pub(super) entity: (u8, i64),
    pub(super) tag: u64,
    pub(super) nodes: Vec<u64>,
    pub(super) line: usize,
}

/// The parts of a file that are used.
#[derive(Debug, Default)]
pub(super) struct FileMesh {
    pub(super) coordinates: Vec<FilePoint>,
    /// Place of each node tag in `coordinates`.
    pub(super) places: BTreeMap<u64, usize>,
    pub(super) cells: Vec<FileCell>,
    /// Physical groups of each entity, and the groups' names.
    pub(super) groups: BTreeMap<(u8, i64), Vec<i64>>,
    pub(super) names: BTreeMap<(u8, i64), String>,
}

impl FileMesh {
    /// Whether `cell` is in a physical group.
    pub(super) fn is_in_a_group(&self, cell: &FileCell) -> bool {
        self.groups.get(&cell.entity).is_some_and(|groups| !groups.is_empty())
    }

    /// Names of the physical groups of `cell`, sorted; for a group without a name, its number.
    ///
    /// A cell without a group has one empty name.
    pub(super) fn groups(&self, cell: &FileCell) -> Vec<String> {
        let tags = self.groups.get(&cell.entity).map_or(&[][..], Vec::as_slice);
        let mut names = Vec::new();
        for tag in tags {
            // A minus sign means that the entity's direction is reversed in its group.
            let key = (cell.entity.0, tag.saturating_abs());
            names.push(self.names.get(&key).cloned().unwrap_or_else(|| key.1.to_string()));
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
pub(super) fn given_twice(item: impl Into<String>) -> FileFault {
    FileFault::value(item, "given twice", "given once")
}
