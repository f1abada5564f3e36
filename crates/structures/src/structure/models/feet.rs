//! Points and faces by which a finite-element model touches the ground.

use std::collections::{HashMap, HashSet};

use crate::error::{Result, at_least, in_bounds, positive, require, require_part};
use crate::fem::{Element, ElementFace, Mesh};

/// Distance from a corner of a shell towards its middle, relative to it, that clears rounding.
const INWARD_OFFSET_RATIO: f64 = 1e-6;

/// A point of the base: it moves with a node of the mesh, some distance above it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Foot {
    pub(super) node: usize,
    /// Distance of the point below the node, m: half of the thickness of a shell, whose underside is the base.
    pub(super) depth: f64,
    /// Height of the point above the surface, m.
    pub(super) height: f64,
}

/// Feet of the `lines` of a base in the plane, each given by its nodes from left to right.
///
/// # Errors
/// [`Error::Scene`](crate::Error::Scene) for a mesh in space, [`Error::Size`](crate::Error::Size) for fewer than two
/// nodes, [`Error::Index`](crate::Error::Index) for a node that does not exist, [`Error::Input`](crate::Error::Input)
/// when the nodes of all lines do not run to the right at one height.
pub(super) fn of_lines(mesh: &Mesh, lines: &[&[usize]]) -> Result<Vec<Vec<Foot>>> {
    require_part(
        "line of contact nodes",
        !mesh.has_depth(),
        "must be in a mesh in the plane, but this one is in space",
    )?;
    let contact = lines.concat();
    at_least("contact nodes", contact.len(), 2)?;
    for line in lines {
        at_least("contact nodes of a foundation", line.len(), 2)?;
    }
    let mut height = None;
    let mut previous_x = None;
    for index in contact {
        let place = mesh.nodes()[in_bounds("contact node", index, mesh.nodes().len())?];
        let y = place[1];
        let is_level = (y - *height.get_or_insert(y)).abs() <= mesh.tolerance();
        require("y of a contact node", y, is_level, "the height of the others")?;
        if let Some(previous_x) = previous_x.replace(place[0]) {
            positive("distance between contact nodes", place[0] - previous_x)?;
        }
    }
    Ok(lines.iter().map(|line| feet_at(line, 0.0)).collect())
}

/// Feet of these nodes at the surface, `depth` (m) below the nodes.
fn feet_at(nodes: &[usize], depth: f64) -> Vec<Foot> {
    nodes.iter().map(|&node| Foot { node, depth, height: 0.0 }).collect()
}

/// Feet of the `faces` of a base in space, each given by its corner nodes.
///
/// # Errors
/// [`Error::Size`](crate::Error::Size) without faces, or for a face of less than three corners;
/// [`Error::Index`](crate::Error::Index) for a node that does not exist, [`Error::Input`](crate::Error::Input) for
/// corners at different heights.
pub(super) fn of_faces(mesh: &Mesh, faces: &[Vec<usize>]) -> Result<Vec<Vec<Foot>>> {
    require_part(
        "faces of a base",
        mesh.has_depth(),
        "must be in a mesh in space, but this one is in the plane",
    )?;
    at_least("faces of the base", faces.len(), 1)?;
    let shells = faces_by_corners(mesh, |face| !face.is_side());
    let mut height = None;
    let mut feet = Vec::with_capacity(faces.len());
    for face in faces {
        at_least("corners of a face of the base", face.len(), 3)?;
        for &node in face {
            let place = mesh.nodes()[in_bounds("corner of the base", node, mesh.nodes().len())?];
            let z = place[2];
            let is_level = (z - *height.get_or_insert(z)).abs() <= mesh.tolerance();
            require("z of a corner of the base", z, is_level, "the height of the others")?;
        }
        let shell = shells.get(&sorted(face));
        let thickness =
            shell.map_or_else(|| thickness_over(mesh, &shells, face), ElementFace::thickness);
        feet.push(feet_at(face, 0.5 * thickness));
    }
    Ok(feet)
}

/// Largest thickness of the `shells` that a face of the base covers, m; zero without any.
fn thickness_over(mesh: &Mesh, shells: &HashMap<Vec<usize>, ElementFace>, face: &[usize]) -> f64 {
    let height = mesh.nodes()[face[0]][mesh.up()];
    let covered = shells
        .iter()
        .filter(|(corners, _)| is_level(mesh, corners, height) && covers_all(mesh, face, corners));
    covered.map(|(_, shell)| shell.thickness()).fold(0.0, f64::max)
}

/// Whether a convex face covers another one with these corners in plan.
fn covers_all(mesh: &Mesh, face: &[usize], corners: &[usize]) -> bool {
    let middle = middle(mesh, corners);
    // Just inside the corners, which may lie on a side of the face.
    let mut places = corners.iter().map(|&node| {
        let corner = mesh.nodes()[node];
        [0, 1].map(|axis| corner[axis] + INWARD_OFFSET_RATIO * (middle[axis] - corner[axis]))
    });
    places.all(|place| covers(mesh, face, place))
}

/// Whether all `corners` are at this height.
fn is_level(mesh: &Mesh, corners: &[usize], height: f64) -> bool {
    let mut heights = corners.iter().map(|&node| mesh.nodes()[node][mesh.up()]);
    heights.all(|corner| (corner - height).abs() <= mesh.tolerance())
}

/// Mean place of the `corners` in plan.
fn middle(mesh: &Mesh, corners: &[usize]) -> [f64; 2] {
    [0, 1].map(|axis| {
        corners.iter().map(|&node| mesh.nodes()[node][axis]).sum::<f64>() / corners.len() as f64
    })
}

/// Feet of all faces of a mesh in space at its lowest height: sides of solids, and shells.
///
/// # Errors
/// [`Error::Scene`](crate::Error::Scene) if the mesh has no such face.
pub(super) fn of_lowest_faces(mesh: &Mesh) -> Result<Vec<Vec<Foot>>> {
    let highest = mesh.lowest() + mesh.tolerance();
    let lowest_faces = faces_by_corners(mesh, |face| {
        face.corners().iter().all(|&node| mesh.nodes()[node][mesh.up()] <= highest)
    });
    let mut faces: Vec<_> = lowest_faces.into_values().collect();
    let needed = "must have shells or sides of solids at the lowest height of the mesh, which stand on the ground: \
                  add them there, or name the faces that do";
    require_part("base of a mesh in space", !faces.is_empty(), needed)?;
    faces.sort_by(|a, b| a.corners().cmp(b.corners()));
    Ok(faces.iter().map(|face| feet_at(face.corners(), 0.5 * face.thickness())).collect())
}

/// Faces of elements at the height of the base that none of its faces covers: their number, and the middle of the first.
pub(super) fn uncovered(mesh: &Mesh, feet: &[Vec<Foot>]) -> Option<(usize, [f64; 2])> {
    let height = mesh.nodes()[feet.first()?.first()?.node][mesh.up()];
    let base: Vec<Vec<usize>> =
        feet.iter().map(|face| face.iter().map(|foot| foot.node).collect()).collect();
    let base_corners: HashSet<Vec<usize>> = base.iter().map(|face| sorted(face)).collect();
    let level_faces =
        faces_by_corners(mesh, |face| mesh.has_depth() && is_level(mesh, face.corners(), height));
    let others = level_faces.into_iter().filter(|(corners, _)| !base_corners.contains(corners));
    let mut middles: Vec<[f64; 2]> = others
        .map(|(corners, _)| middle(mesh, &corners))
        .filter(|place| !base.iter().any(|face| covers(mesh, face, *place)))
        .collect();
    middles.sort_by(|one, other| one[0].total_cmp(&other[0]).then(one[1].total_cmp(&other[1])));
    Some((middles.len(), *middles.first()?))
}

/// Whether a place in plan lies in the convex face with these corners, in either order.
fn covers(mesh: &Mesh, corners: &[usize], [x, y]: [f64; 2]) -> bool {
    let mut is_left = true;
    let mut is_right = true;
    for (k, &corner) in corners.iter().enumerate() {
        let a = mesh.nodes()[corner];
        let b = mesh.nodes()[corners[(k + 1) % corners.len()]];
        let side = (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
        is_left &= side >= 0.0;
        is_right &= side <= 0.0;
    }
    is_left || is_right
}

/// Faces of elements that `keep` selects, by their sorted corners; of several the thickest.
fn faces_by_corners(
    mesh: &Mesh,
    keep: impl Fn(&ElementFace) -> bool,
) -> HashMap<Vec<usize>, ElementFace> {
    let mut faces: HashMap<Vec<usize>, ElementFace> = HashMap::new();
    for face in mesh.elements().flat_map(Element::faces).filter(keep) {
        let thickest = faces.entry(sorted(face.corners())).or_insert_with(|| face.clone());
        if face.thickness() > thickest.thickness() {
            *thickest = face;
        }
    }
    faces
}

fn sorted(nodes: &[usize]) -> Vec<usize> {
    let mut nodes = nodes.to_vec();
    nodes.sort_unstable();
    nodes
}
