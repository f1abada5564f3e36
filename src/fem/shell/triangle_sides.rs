//! Sides of the triangles of doubly curved shells.
//!
//! | symbol | meaning |
//! |---|---|
//! | δ | 2π minus the angles of all triangles at a node |
//! | R | radius of curvature, √(A/∣Σδ∣) for nodes with the area A (Gauss and Bonnet) |
//! | t | mean thickness |
//!
//! On a doubly curved shell a triangle rotates about its normal when its neighbours bend, and its membrane resists.
//! Cylinders and folded plates, which bend about straight lines, have δ = 0 on average.

use std::any::Any;
use std::collections::{BTreeMap, BTreeSet};

use super::Shell;
use super::corners::Corners;
use crate::fem::mesh::Mesh;
use crate::fem::vector::{add, cross, dot, length, unit};

/// Cosine of 30°: at larger turns between two triangles their common side is an edge.
const EDGE_TURN_COSINE: f64 = 0.866;
/// Cosine of the turn between two triangles up to which they count as coplanar.
const FLAT_TURN_COSINE: f64 = 1.0 - 1e-6;

/// Sums over the triangles at a node.
#[derive(Default)]
struct NodeSurroundings {
    angle: f64,
    area: f64,
    /// Area × thickness, m³.
    volume: f64,
}

/// Mean side of doubly curved shells' triangles, and √(R t), m.
///
/// `None` without such triangles.
///
/// A side counts if both of its ends are surrounded by triangles: at the pole of a dome no side counts.
pub(crate) fn triangle_sides(mesh: &Mesh) -> Option<[f64; 2]> {
    let shells = mesh.elements().filter_map(|element| (element as &dyn Any).downcast_ref());
    let mut nodes = BTreeMap::<usize, NodeSurroundings>::new();
    let mut sides = BTreeMap::new();
    for shell in shells {
        let shell: &Shell = shell;
        let Corners::Three(corners) = shell.nodes else { continue };
        let points = corners.map(|node| mesh.nodes()[node]);
        let side_vector = |from: usize, to: usize| add(points[to % 3], -1.0, points[from]);
        let across = cross(side_vector(0, 1), side_vector(0, 2));
        let double_area = length(across);
        let normal = unit(across);
        for k in 0..3 {
            let to_next = unit(side_vector(k, k + 1));
            let to_previous = unit(side_vector(k, k + 2));
            let node = nodes.entry(corners[k]).or_default();
            node.angle += dot(to_next, to_previous).clamp(-1.0, 1.0).acos();
            node.area += double_area / 6.0;
            node.volume += shell.thickness * double_area / 6.0;
            let ends = super::side(corners[k], corners[(k + 1) % 3]);
            sides.entry(ends).or_insert_with(Vec::new).push(normal);
        }
    }
    let mut curved = BTreeSet::<usize>::new();
    let mut outer = BTreeSet::<usize>::new();
    for (ends, normals) in &sides {
        // Sides at edges and beside quadrilaterals have one triangle.
        let cosine = if let [one, other] = normals[..] { dot(one, other).abs() } else { 0.0 };
        if cosine < EDGE_TURN_COSINE {
            outer.extend(ends);
        } else if cosine < FLAT_TURN_COSINE {
            curved.extend(ends);
        }
    }
    let inner: BTreeSet<usize> = curved.difference(&outer).copied().collect();
    let inner_sides: Vec<_> =
        sides.keys().filter(|ends| ends.iter().all(|node| inner.contains(node))).collect();
    let mut total_length = 0.0;
    for [one, other] in &inner_sides {
        total_length += length(add(mesh.nodes()[*one], -1.0, mesh.nodes()[*other]));
    }
    let mut area = 0.0;
    let mut volume = 0.0;
    let mut angle_defect = 0.0_f64;
    for node in inner_sides.iter().copied().flatten().collect::<BTreeSet<_>>() {
        let node = &nodes[node];
        angle_defect += std::f64::consts::TAU - node.angle;
        area += node.area;
        volume += node.volume;
    }
    let radius = (area / angle_defect.abs()).sqrt();
    let thickness = volume / area;
    (!inner_sides.is_empty())
        .then(|| [total_length / inner_sides.len() as f64, (radius * thickness).sqrt()])
}
