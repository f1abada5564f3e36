//! Elements of a mesh by the indices of their nodes.

use std::collections::{BTreeMap, BTreeSet};

use super::kind::ElementKind;
use super::raw::{FileCell, FileMesh, FilePoint, given_twice};
use crate::error::{Error, FileFault};

/// An element of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MeshCell {
    pub(super) kind: ElementKind,
    /// Names of the groups.
    pub(super) groups: Vec<String>,
    /// Indices of the nodes.
    pub(super) nodes: Vec<usize>,
    /// Tag in the file.
    pub(super) tag: u64,
    /// Line in the file.
    pub(super) line: usize,
}

/// Nodes and elements of a file; the elements refer to the nodes by index.
pub(super) struct NumberedMesh<'a> {
    pub(super) points: Vec<&'a FilePoint>,
    pub(super) cells: Vec<MeshCell>,
}

impl MeshCell {
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

/// Numbers the nodes of the selected elements in the order of the file, independently of their tags.
///
/// Other elements are kept if all their nodes are among these.
pub(super) fn number(
    mesh: &FileMesh,
    is_selected: impl Fn(&FileCell) -> bool,
) -> Result<NumberedMesh<'_>, (usize, FileFault)> {
    let mut used = BTreeMap::new();
    for cell in mesh.cells.iter().filter(|cell| is_selected(cell)) {
        for &tag in &cell.nodes {
            let Some(&place) = mesh.places.get(&tag) else {
                return Err((cell.line, FileFault::missing(format!("node {tag}"))));
            };
            used.insert(place, tag);
        }
    }
    let index: BTreeMap<u64, usize> = used.values().enumerate().map(|(k, &tag)| (tag, k)).collect();
    let mut corners_before = BTreeSet::new();
    let mut cells = Vec::with_capacity(mesh.cells.len());
    for cell in &mesh.cells {
        let nodes: Option<Vec<usize>> =
            cell.nodes.iter().map(|tag| index.get(tag).copied()).collect();
        let Some(nodes) = nodes else { continue };
        let must_be_unique = cell.kind.dimension() > 1;
        if must_be_unique && !corners_before.insert(sorted(&nodes[..cell.kind.corners()])) {
            let tags: Vec<String> = cell.nodes.iter().map(u64::to_string).collect();
            let item = format!("{} of nodes {}", cell.kind.name(), tags.join(" "));
            return Err((cell.line, given_twice(item)));
        }
        let groups = mesh.groups(cell);
        cells.push(MeshCell { kind: cell.kind, groups, nodes, tag: cell.tag, line: cell.line });
    }
    let points = used.keys().map(|&place| &mesh.coordinates[place]).collect();
    Ok(NumberedMesh { points, cells })
}

/// Nodes by their indices, the smallest first.
pub(super) fn sorted(nodes: &[usize]) -> Vec<usize> {
    let mut nodes = nodes.to_vec();
    nodes.sort_unstable();
    nodes
}

/// Names of the groups of cells, sorted.
pub(super) fn group_names<'a>(cells: impl Iterator<Item = &'a MeshCell>) -> Vec<&'a str> {
    let all: BTreeSet<&str> =
        cells.flat_map(|cell| cell.groups.iter().map(String::as_str)).collect();
    all.into_iter().collect()
}
