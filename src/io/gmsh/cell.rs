//! Elements of a mesh by the indices of their nodes.

use std::collections::{BTreeMap, BTreeSet};

use super::kind::Kind;
use super::raw::{Point, Raw, RawCell, twice};
use crate::error::{Error, FileFault};

/// An element: its kind, the names of its groups, the indices of its nodes, its tag and its line in the file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cell {
    pub(super) kind: Kind,
    pub(super) groups: Vec<String>,
    pub(super) nodes: Vec<usize>,
    pub(super) tag: u64,
    pub(super) line: usize,
}

/// Nodes and elements of a file; the elements name the nodes by their indices.
pub(super) struct Numbered<'a> {
    pub(super) points: Vec<&'a Point>,
    pub(super) cells: Vec<Cell>,
}

impl Cell {
    /// Whether it is in the group `name`.
    pub(super) fn is_in(&self, name: &str) -> bool {
        self.groups.iter().any(|group| group == name)
    }

    /// Error of an element that is not accepted, with its tag and its line in `file`.
    pub(super) fn unusable(&self, file: &str, error: Error) -> Error {
        let error = error.within(format!("element {}", self.tag));
        FileFault::Unusable(Box::new(error)).of(file, self.line)
    }
}

/// Numbers the nodes of the elements that `defines` selects in the order of the file, independently of their tags.
///
/// Other elements are kept if all their nodes are among these.
pub(super) fn number(
    raw: &Raw,
    defines: impl Fn(&RawCell) -> bool,
) -> Result<Numbered<'_>, (usize, FileFault)> {
    let mut used = BTreeMap::new();
    for cell in raw.cells.iter().filter(|cell| defines(cell)) {
        for &tag in &cell.nodes {
            let missing = || (cell.line, FileFault::missing(format!("node {tag}")));
            used.insert(*raw.places.get(&tag).ok_or_else(missing)?, tag);
        }
    }
    let index: BTreeMap<u64, usize> = used.values().enumerate().map(|(k, &tag)| (tag, k)).collect();
    let mut twins = BTreeSet::new();
    let mut cells = Vec::with_capacity(raw.cells.len());
    for cell in &raw.cells {
        let nodes: Option<Vec<usize>> =
            cell.nodes.iter().map(|tag| index.get(tag).copied()).collect();
        let Some(nodes) = nodes else { continue };
        let can_be_twin = cell.kind.dimension() > 1;
        if can_be_twin && !twins.insert(sorted(&nodes[..cell.kind.corners()])) {
            let tags: Vec<String> = cell.nodes.iter().map(u64::to_string).collect();
            let what = format!("{} of nodes {}", cell.kind.name(), tags.join(" "));
            return Err((cell.line, twice(what)));
        }
        let (groups, tag, line) = (raw.groups(cell), cell.tag, cell.line);
        cells.push(Cell { kind: cell.kind, groups, nodes, tag, line });
    }
    let points = used.keys().map(|&place| &raw.coordinates[place]).collect();
    Ok(Numbered { points, cells })
}

/// Nodes by their indices, the smallest first.
pub(super) fn sorted(nodes: &[usize]) -> Vec<usize> {
    let mut nodes = nodes.to_vec();
    nodes.sort_unstable();
    nodes
}

/// Names of the groups of cells, sorted.
pub(super) fn group_names<'a>(cells: impl Iterator<Item = &'a Cell>) -> Vec<&'a str> {
    let all: BTreeSet<&str> =
        cells.flat_map(|cell| cell.groups.iter().map(String::as_str)).collect();
    all.into_iter().collect()
}
