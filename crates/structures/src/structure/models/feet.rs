//! Points and faces at which a finite-element model is in contact with the ground.

use std::collections::{HashMap, HashSet};

use crate::error::{Result, at_least, in_bounds, positive, require, require_part};
use crate::fem::{Element, ElementFace, Mesh};

/// Inward shift of a shell's corner, relative to its distance from the middle.
///
/// It is far above rounding.
const INWARD_OFFSET_RATIO: f64 = 1e-6;

/// A point of the base, below the node with which it moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Foot {
    /// Index of the node.
    pub(super) node: usize,
    /// Distance of the point below the node, m.
    ///
    /// It is half the thickness of a shell, whose underside is the base.
    pub(super) depth: f64,
    /// Height of the point above the surface, m.
    pub(super) height: f64,
}

/// Feet of the `lines` of a base in the plane.
///
/// Each line lists its nodes from left to right.
///
/// # Errors
/// [`Error::Scene`](crate::Error::Scene) for a mesh in space, [`Error::Size`](crate::Error::Size) for fewer than two
/// nodes, [`Error::Index`](crate::Error::Index) for a node that does not exist, [`Error::Input`](crate::Error::Input)
/// unless the nodes of all lines are listed from left to right and lie at one height.
pub(super) fn line_feet(mesh: &Mesh, lines: &[&[usize]]) -> Result<Vec<Vec<Foot>>> {
    mesh.require_plane("line of contact nodes")?;
    let contact_nodes = lines.concat();
    at_least("contact nodes", contact_nodes.len(), 2)?;
    for line in lines {
        at_least("contact nodes of a foundation", line.len(), 2)?;
    }
    let mut common_height = None;
    let mut previous_x = None;
    for node in contact_nodes {
        let coordinates = mesh.nodes()[in_bounds("contact node", node, mesh.nodes().len())?];
        let y = coordinates[1];
        let is_level = (y - *common_height.get_or_insert(y)).abs() <= mesh.height_tolerance();
        require("y of a contact node", y, is_level, "the height of the others")?;
        if let Some(left_x) = previous_x.replace(coordinates[0]) {
            positive("distance between contact nodes", coordinates[0] - left_x)?;
        }
    }
    Ok(lines.iter().map(|line| feet_at(line, 0.0)).collect())
}

/// Feet at a `depth` (m) below these nodes, on the surface.
fn feet_at(nodes: &[usize], depth: f64) -> Vec<Foot> {
    nodes.iter().map(|&node| Foot { node, depth, height: 0.0 }).collect()
}

/// Feet of the `faces` of a base in space; each face lists its corner nodes.
///
/// # Errors
/// [`Error::Size`](crate::Error::Size) without faces, or for a face of fewer than three corners;
/// [`Error::Index`](crate::Error::Index) for a node that does not exist, [`Error::Input`](crate::Error::Input) for
/// corners at different heights.
pub(super) fn face_feet(mesh: &Mesh, faces: &[Vec<usize>]) -> Result<Vec<Vec<Foot>>> {
    mesh.require_space("faces of a base")?;
    at_least("faces of the base", faces.len(), 1)?;
    let shells = faces_by_corners(mesh, |face| !face.is_side());
    let mut common_height = None;
    let mut feet = Vec::with_capacity(faces.len());
    for face in faces {
        at_least("corners of a face of the base", face.len(), 3)?;
        for &node in face {
            let coordinates =
                mesh.nodes()[in_bounds("corner of the base", node, mesh.nodes().len())?];
            let z = coordinates[2];
            let is_level = (z - *common_height.get_or_insert(z)).abs() <= mesh.height_tolerance();
            require("z of a corner of the base", z, is_level, "the height of the others")?;
        }
        let shell = shells.get(&sorted_nodes(face));
        let thickness = shell
            .map_or_else(|| max_covered_thickness(mesh, &shells, face), ElementFace::thickness);
        feet.push(feet_at(face, 0.5 * thickness));
    }
    Ok(feet)
}

/// Largest thickness of the `shells` that a face of the base covers, m; zero without any.
fn max_covered_thickness(
    mesh: &Mesh,
    shells: &HashMap<Vec<usize>, ElementFace>,
    face: &[usize],
) -> f64 {
    let height = mesh.nodes()[face[0]][mesh.up_axis()];
    let covered_shells = shells
        .iter()
        .filter(|(corners, _)| is_level(mesh, corners, height) && covers_face(mesh, face, corners));
    covered_shells.map(|(_, shell)| shell.thickness()).fold(0.0, f64::max)
}

/// Whether a convex face covers another face with these corners, seen from above.
fn covers_face(mesh: &Mesh, face: &[usize], corners: &[usize]) -> bool {
    let middle = middle(mesh, corners);
    // Points just inside the corners, since the corners themselves may lie on a side of the face.
    let mut inner_points = corners.iter().map(|&node| {
        let corner = mesh.nodes()[node];
        [0, 1].map(|axis| corner[axis] + INWARD_OFFSET_RATIO * (middle[axis] - corner[axis]))
    });
    inner_points.all(|point| covers_point(mesh, face, point))
}

/// Whether all `corners` are at this height.
fn is_level(mesh: &Mesh, corners: &[usize], height: f64) -> bool {
    let mut heights = corners.iter().map(|&node| mesh.nodes()[node][mesh.up_axis()]);
    heights.all(|corner| (corner - height).abs() <= mesh.height_tolerance())
}

/// Mean [x, y] of the `corners`, m.
fn middle(mesh: &Mesh, corners: &[usize]) -> [f64; 2] {
    [0, 1].map(|axis| {
        corners.iter().map(|&node| mesh.nodes()[node][axis]).sum::<f64>() / corners.len() as f64
    })
}

/// Feet of all faces of a mesh in space at its lowest height: sides of solids, and shells.
///
/// # Errors
/// [`Error::Scene`](crate::Error::Scene) if the mesh has no such face.
pub(super) fn lowest_face_feet(mesh: &Mesh) -> Result<Vec<Vec<Foot>>> {
    let max_height = mesh.lowest_height() + mesh.height_tolerance();
    let lowest_faces = faces_by_corners(mesh, |face| {
        face.corners().iter().all(|&node| mesh.nodes()[node][mesh.up_axis()] <= max_height)
    });
    let mut faces: Vec<_> = lowest_faces.into_values().collect();
    let needed = "must have shells or sides of solids at the lowest height of the mesh, which stand on the ground: \
                  add them there, or name the faces that do";
    require_part("base of a mesh in space", !faces.is_empty(), needed)?;
    faces.sort_by(|a, b| a.corners().cmp(b.corners()));
    Ok(faces.iter().map(|face| feet_at(face.corners(), 0.5 * face.thickness())).collect())
}

/// Element faces at the height of the base that the base does not cover.
///
/// Returns their number, and the middle [x, y] of the first one, m; `None` without such faces.
pub(super) fn uncovered_faces(mesh: &Mesh, feet: &[Vec<Foot>]) -> Option<(usize, [f64; 2])> {
    let height = mesh.nodes()[feet.first()?.first()?.node][mesh.up_axis()];
    let base_faces: Vec<Vec<usize>> =
        feet.iter().map(|face| face.iter().map(|foot| foot.node).collect()).collect();
    let base_corners: HashSet<Vec<usize>> =
        base_faces.iter().map(|face| sorted_nodes(face)).collect();
    let level_faces =
        faces_by_corners(mesh, |face| mesh.has_depth() && is_level(mesh, face.corners(), height));
    let other_faces =
        level_faces.into_iter().filter(|(corners, _)| !base_corners.contains(corners));
    let mut middles: Vec<[f64; 2]> = other_faces
        .map(|(corners, _)| middle(mesh, &corners))
        .filter(|point| !base_faces.iter().any(|face| covers_point(mesh, face, *point)))
        .collect();
    middles.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    Some((middles.len(), *middles.first()?))
}

/// Whether a point [x, y] lies in the convex face with these corners, in either sense of rotation.
fn covers_point(mesh: &Mesh, corners: &[usize], [x, y]: [f64; 2]) -> bool {
    let mut is_left = true;
    let mut is_right = true;
    for (k, &corner) in corners.iter().enumerate() {
        let start = mesh.nodes()[corner];
        let end = mesh.nodes()[corners[(k + 1) % corners.len()]];
        let cross_product =
            (end[0] - start[0]) * (y - start[1]) - (end[1] - start[1]) * (x - start[0]);
        is_left &= cross_product >= 0.0;
        is_right &= cross_product <= 0.0;
    }
    is_left || is_right
}

/// Faces of elements that `is_selected` accepts, by their sorted corners.
///
/// Of several faces with the same corners the thickest one is returned.
fn faces_by_corners(
    mesh: &Mesh,
    is_selected: impl Fn(&ElementFace) -> bool,
) -> HashMap<Vec<usize>, ElementFace> {
    let mut faces: HashMap<Vec<usize>, ElementFace> = HashMap::new();
    for face in mesh.elements().flat_map(Element::faces).filter(is_selected) {
        let thickest_face =
            faces.entry(sorted_nodes(face.corners())).or_insert_with(|| face.clone());
        if face.thickness() > thickest_face.thickness() {
            *thickest_face = face;
        }
    }
    faces
}

/// The nodes in ascending order.
fn sorted_nodes(nodes: &[usize]) -> Vec<usize> {
    let mut sorted_nodes = nodes.to_vec();
    sorted_nodes.sort_unstable();
    sorted_nodes
}
