//! Sides of the triangles of doubly curved shells.
//!
//! | symbol | meaning |
//! |---|---|
//! | δ | 2π minus the angles of all triangles at a node |
//! | R | radius of curvature, √(A/∣Σδ∣) for nodes with the area A (Gauss and Bonnet) |
//! | t | mean thickness |
//!
//! A triangle turns about its normal when its neighbours bend, and its membrane resists. Cylinders and folded plates, which
//! bend about straight lines, have δ = 0 on the mean.

use std::any::Any;
use std::collections::{BTreeMap, BTreeSet};

use super::Shell;
use super::corners::Corners;
use crate::fem::mesh::Mesh;
use crate::fem::vector::{add, cross, direction, dot};

/// Cosine of the turn from one triangle to the next from which their common side is an edge: 30°.
const EDGE: f64 = 0.866;
/// Cosine of a turn up to which triangles lie in a plane.
const FLAT: f64 = 1.0 - 1e-6;

/// Triangles at a node.
#[derive(Default)]
struct Around {
    angle: f64,
    area: f64,
    /// Area × thickness, m³.
    volume: f64,
}

/// Mean side of the triangles of doubly curved shells and √(R t), m; `None` without such triangles.
///
/// A side counts if both of its ends are amid triangles: at the pole of a dome none does.
pub(crate) fn triangle_sides(mesh: &Mesh) -> Option<[f64; 2]> {
    let shells = mesh.elements().filter_map(|element| (element as &dyn Any).downcast_ref());
    let (mut nodes, mut sides) = (BTreeMap::<usize, Around>::new(), BTreeMap::new());
    for shell in shells {
        let shell: &Shell = shell;
        let Corners::Three(corners) = shell.nodes else { continue };
        let points = corners.map(|node| mesh.nodes()[node]);
        let to = |i: usize, k: usize| add(points[k % 3], -1.0, points[i]);
        let (double, normal) = direction(cross(to(0, 1), to(0, 2)));
        for k in 0..3 {
            let [next, last] = [to(k, k + 1), to(k, k + 2)].map(|side| direction(side).1);
            let own = nodes.entry(corners[k]).or_default();
            own.angle += dot(next, last).clamp(-1.0, 1.0).acos();
            own.area += double / 6.0;
            own.volume += shell.thickness * double / 6.0;
            let ends = super::side(corners[k], corners[(k + 1) % 3]);
            sides.entry(ends).or_insert_with(Vec::new).push(normal);
        }
    }
    let [mut curved, mut outer] = [(); 2].map(|()| BTreeSet::<usize>::new());
    for (ends, normals) in &sides {
        // Sides at edges and beside quadrilaterals have one triangle.
        let turn = if let [one, other] = normals[..] { dot(one, other).abs() } else { 0.0 };
        if turn < EDGE {
            outer.extend(ends);
        } else if turn < FLAT {
            curved.extend(ends);
        }
    }
    let is_amid = |node: &usize| curved.contains(node) && !outer.contains(node);
    let amid: Vec<_> = sides.keys().filter(|ends| ends.iter().all(is_amid)).collect();
    let (mut length, mut whole, mut defect) = (0.0, Around::default(), 0.0);
    for [one, other] in &amid {
        length += direction(add(mesh.nodes()[*one], -1.0, mesh.nodes()[*other])).0;
    }
    for node in amid.iter().copied().flatten().collect::<BTreeSet<_>>() {
        let own = &nodes[node];
        defect += std::f64::consts::TAU - own.angle;
        whole.area += own.area;
        whole.volume += own.volume;
    }
    let radius = (whole.area / f64::abs(defect)).sqrt();
    let thickness = whole.volume / whole.area;
    (!amid.is_empty()).then(|| [length / amid.len() as f64, (radius * thickness).sqrt()])
}
