//! Nodes and elements of a file by their tags.

use std::collections::BTreeMap;

use super::kind::Kind;
use crate::error::FileFault;

/// A point, and its line in the file.
#[derive(Debug)]
pub(super) struct Point {
    pub(super) values: [f64; 3],
    pub(super) line: usize,
}

/// An element of the file by its tags, with its line.
#[derive(Debug)]
pub(super) struct RawCell {
    pub(super) kind: Kind,
    /// Dimension and tag of its entity.
    pub(super) entity: (u8, i64),
    pub(super) tag: u64,
    pub(super) nodes: Vec<u64>,
    pub(super) line: usize,
}

/// The parts of a file that are used.
#[derive(Debug, Default)]
pub(super) struct Raw {
    pub(super) coordinates: Vec<Point>,
    /// Place of each node tag in `coordinates`.
    pub(super) places: BTreeMap<u64, usize>,
    pub(super) cells: Vec<RawCell>,
    /// Physical groups of each entity, and the groups' names.
    pub(super) groups: BTreeMap<(u8, i64), Vec<i64>>,
    pub(super) names: BTreeMap<(u8, i64), String>,
}

impl Raw {
    /// Whether `cell` is in a physical group.
    pub(super) fn is_in_a_group(&self, cell: &RawCell) -> bool {
        self.groups.get(&cell.entity).is_some_and(|groups| !groups.is_empty())
    }

    /// Names of the physical groups of `cell`, sorted; for a group without a name, its number.
    ///
    /// A cell without a group has one empty name.
    pub(super) fn groups(&self, cell: &RawCell) -> Vec<String> {
        let tags = self.groups.get(&cell.entity).map_or(&[][..], Vec::as_slice);
        let name = |tag: &i64| {
            // A minus sign means that the entity's direction is reversed in its group.
            let key = (cell.entity.0, tag.saturating_abs());
            self.names.get(&key).cloned().unwrap_or_else(|| key.1.to_string())
        };
        let mut names: Vec<String> = tags.iter().map(name).collect();
        names.sort_unstable();
        names.dedup();
        if names.is_empty() {
            names.push(String::new());
        }
        names
    }
}

/// Fault of an item that may be there once.
pub(super) fn twice(item: impl Into<String>) -> FileFault {
    FileFault::value(item, "given twice", "given once")
}
