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

/// Triangles of a mesh: sums at their nodes, and the unit normals at their sides.
#[derive(Default)]
struct TriangleMesh {
    nodes: BTreeMap<usize, NodeSurroundings>,
    /// Normals of the triangles on a side, by the side's ends.
    sides: BTreeMap<[usize; 2], Vec<[f64; 3]>>,
}

impl TriangleMesh {
    fn new(mesh: &Mesh) -> Self {
        let mut triangles = Self::default();
        for element in mesh.elements() {
            let Some(shell) = (element as &dyn Any).downcast_ref::<Shell>() else { continue };
            if let Corners::Three(corners) = shell.nodes {
                triangles.add(corners, corners.map(|node| mesh.nodes()[node]), shell.thickness);
            }
        }
        triangles
    }

    fn add(&mut self, corners: [usize; 3], points: [[f64; 3]; 3], thickness: f64) {
        let side_vector = |from: usize, to: usize| add(points[to % 3], -1.0, points[from]);
        let across = cross(side_vector(0, 1), side_vector(0, 2));
        let double_area = length(across);
        let normal = unit(across);
        for k in 0..3 {
            let to_next = unit(side_vector(k, k + 1));
            let to_previous = unit(side_vector(k, k + 2));
            let node = self.nodes.entry(corners[k]).or_default();
            node.angle += dot(to_next, to_previous).clamp(-1.0, 1.0).acos();
            node.area += double_area / 6.0;
            node.volume += thickness * double_area / 6.0;
            let ends = super::side(corners[k], corners[(k + 1) % 3]);
            self.sides.entry(ends).or_default().push(normal);
        }
    }

    /// Nodes on sides where the surface turns, and which triangles surround.
    fn inner_nodes(&self) -> BTreeSet<usize> {
        let mut curved = BTreeSet::<usize>::new();
        let mut outer = BTreeSet::<usize>::new();
        for (ends, normals) in &self.sides {
            // Sides at edges and beside quadrilaterals have one triangle.
            let cosine = if let [one, other] = normals[..] { dot(one, other).abs() } else { 0.0 };
            if cosine < EDGE_TURN_COSINE {
                outer.extend(ends);
            } else if cosine < FLAT_TURN_COSINE {
                curved.extend(ends);
            }
        }
        curved.difference(&outer).copied().collect()
    }

    /// √(R t) of the surface around `nodes`, m.
    fn bending_length(&self, nodes: &BTreeSet<usize>) -> f64 {
        let mut area = 0.0;
        let mut volume = 0.0;
        let mut angle_defect = 0.0_f64;
        for node in nodes {
            let node = &self.nodes[node];
            angle_defect += std::f64::consts::TAU - node.angle;
            area += node.area;
            volume += node.volume;
        }
        let radius = (area / angle_defect.abs()).sqrt();
        let thickness = volume / area;
        (radius * thickness).sqrt()
    }
}

/// Mean side of doubly curved shells' triangles, and √(R t), m.
///
/// `None` without such triangles.
///
/// A side counts if both of its ends are surrounded by triangles: at the pole of a dome no side counts.
pub(crate) fn triangle_sides(mesh: &Mesh) -> Option<[f64; 2]> {
    let triangles = TriangleMesh::new(mesh);
    let inner = triangles.inner_nodes();
    let mut total_length = 0.0;
    let mut count = 0;
    let mut ends_of_sides = BTreeSet::new();
    for ends in triangles.sides.keys() {
        if ends.iter().all(|node| inner.contains(node)) {
            total_length += length(add(mesh.nodes()[ends[0]], -1.0, mesh.nodes()[ends[1]]));
            count += 1;
            ends_of_sides.extend(ends);
        }
    }
    (count > 0).then(|| [total_length / f64::from(count), triangles.bending_length(&ends_of_sides)])
}
