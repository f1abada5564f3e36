//! Tears of a base in plan: points at which adjacent faces can separate vertically.

use std::collections::BTreeSet;

use super::corner_weights::Point;
use crate::bem::plan::faces::MatFace;
use crate::bem::plan::points::{PointIndex, without_pairs};
use crate::error::Result;
use crate::structure::{Base, BaseNode, DofCombination};

/// Difference of displacements that counts as rounding, relative to their largest weight.
const TEAR_ROUNDING_TOLERANCE: f64 = 1e-6;

/// Number of tears of a base, and the first torn point; `None` without tears.
///
/// Two corners at one point are torn if some degree of freedom raises them by different amounts. A corner on the edge of
/// another face is torn if it does not stay on the line between the ends of the edge.
pub(crate) fn tears(base: &Base) -> Result<Option<(usize, Point)>> {
    let Base::Faces(faces) = base else { return Ok(None) };
    let mut mat_faces = Vec::with_capacity(faces.len());
    for (face_number, face) in faces.iter().enumerate() {
        let corners: Vec<Point> = face.iter().map(BaseNode::place).collect();
        mat_faces.push(MatFace::new(face_number, &corners)?);
    }
    let coincidence_distance = mat_faces.iter().map(MatFace::touch_distance).fold(0.0, f64::max);
    let mut points = PointIndex::new(coincidence_distance);
    // The first node at each point.
    let mut point_nodes: Vec<&BaseNode> = vec![];
    let mut torn_points = BTreeSet::new();
    let mut edges = vec![];
    for (face, mat_face) in faces.iter().zip(&mat_faces) {
        for node in face {
            let point = points.index_of(node.place());
            match point_nodes.get(point) {
                Some(first_node) if rises_differently(node, &[(first_node, 1.0)]) => {
                    torn_points.insert(point);
                }
                Some(_) => {}
                None => point_nodes.push(node),
            }
        }
        let corners: Vec<_> =
            mat_face.corners().iter().map(|place| points.index_of(*place)).collect();
        edges.extend((0..corners.len()).map(|k| [corners[k], corners[(k + 1) % corners.len()]]));
    }
    // Points along each edge, with their fractions of its length.
    for edge_points in points.on_edges(&without_pairs(edges)) {
        if let [(_, start), inner_points @ .., (_, end)] = &edge_points[..] {
            for (fraction, point) in inner_points {
                let line = [(point_nodes[*start], 1.0 - fraction), (point_nodes[*end], *fraction)];
                if rises_differently(point_nodes[*point], &line) {
                    torn_points.insert(*point);
                }
            }
        }
    }
    Ok(torn_points.first().map(|point| (torn_points.len(), points.point(*point))))
}

/// Whether a degree of freedom can part a node from a weighted mean of nodes.
///
/// It then raises both by different amounts.
///
/// Only vertical displacements count. Shells of different thickness have undersides at different heights. Where the
/// shells rotate, the undersides move horizontally by different amounts, but rise together.
fn rises_differently(node: &BaseNode, mean: &[(&BaseNode, f64)]) -> bool {
    let mut difference = node.vertical.clone();
    let mut scale = max_weight(&difference);
    for (other, weight) in mean {
        difference -= *weight * other.vertical.clone();
        scale = scale.max(max_weight(&other.vertical));
    }
    max_weight(&difference) > TEAR_ROUNDING_TOLERANCE * scale
}

/// Largest magnitude of a weight.
fn max_weight(row: &DofCombination) -> f64 {
    row.iter().fold(0.0_f64, |max, (_, weight)| max.max(weight.abs()))
}
