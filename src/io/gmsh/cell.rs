//! Elements of a mesh that refer to their nodes by index.

use std::collections::{BTreeMap, BTreeSet};

use super::kind::ElementKind;
use super::raw::{FileCell, FileMesh, FileNode, duplicate_fault};
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

/// Nodes and elements of a file, whose elements refer to nodes by index.
pub(super) struct NumberedMesh<'a> {
    pub(super) nodes: Vec<&'a FileNode>,
    pub(super) cells: Vec<MeshCell>,
}

impl MeshCell {
    /// Whether the element is in the group `name`.
    pub(super) fn is_in(&self, name: &str) -> bool {
        self.groups.iter().any(|group| group == name)
    }

    /// Adds the tag of an element, and its line in `file`, to its error.
    pub(super) fn unusable(&self, file: &str, error: Error) -> Error {
        let error = error.within(format!("element {}", self.tag));
        FileFault::Unusable(Box::new(error)).of(file, self.line)
    }
}

/// Numbers the nodes of the selected elements in the order of the file, independently of their tags.
///
/// Other elements stay in the mesh if all their nodes belong to selected elements.
pub(super) fn numbered_mesh(
    mesh: &FileMesh,
    is_selected: impl Fn(&FileCell) -> bool,
) -> Result<NumberedMesh<'_>, (usize, FileFault)> {
    let mut node_tags_in_file_order = BTreeMap::new();
    for cell in mesh.cells.iter().filter(|cell| is_selected(cell)) {
        for &tag in &cell.nodes {
            let Some(&file_index) = mesh.node_indices.get(&tag) else {
                return Err((cell.line, FileFault::missing(format!("node {tag}"))));
            };
            node_tags_in_file_order.insert(file_index, tag);
        }
    }
    let new_indices: BTreeMap<u64, usize> = node_tags_in_file_order
        .values()
        .enumerate()
        .map(|(index, &tag)| (tag, index))
        .collect();
    let mut earlier_corners = BTreeSet::new();
    let mut cells = Vec::with_capacity(mesh.cells.len());
    for cell in &mesh.cells {
        let nodes: Option<Vec<usize>> =
            cell.nodes.iter().map(|tag| new_indices.get(tag).copied()).collect();
        let Some(nodes) = nodes else { continue };
        let is_surface_or_solid = cell.kind.dimension() > 1;
        if is_surface_or_solid
            && !earlier_corners.insert(sorted_nodes(&nodes[..cell.kind.corner_count()]))
        {
            let tags: Vec<String> = cell.nodes.iter().map(u64::to_string).collect();
            let item = format!("{} of nodes {}", cell.kind.name(), tags.join(" "));
            return Err((cell.line, duplicate_fault(item)));
        }
        let groups = mesh.groups(cell);
        cells.push(MeshCell { kind: cell.kind, groups, nodes, tag: cell.tag, line: cell.line });
    }
    let selected_nodes =
        node_tags_in_file_order.keys().map(|&file_index| &mesh.nodes[file_index]).collect();
    Ok(NumberedMesh { nodes: selected_nodes, cells })
}

/// Indices of nodes in ascending order.
pub(super) fn sorted_nodes(nodes: &[usize]) -> Vec<usize> {
    let mut copy = nodes.to_vec();
    copy.sort_unstable();
    copy
}

/// Sorted names of the groups to which cells belong.
pub(super) fn group_names<'a>(cells: impl Iterator<Item = &'a MeshCell>) -> Vec<&'a str> {
    let names: BTreeSet<&str> =
        cells.flat_map(|cell| cell.groups.iter().map(String::as_str)).collect();
    names.into_iter().collect()
}
