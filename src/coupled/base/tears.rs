//! Tears of a base in plan: points where faces meet and move apart.

use std::collections::BTreeSet;

use super::corner_weights::Point;
use crate::bem::plan::faces::MatFace;
use crate::bem::plan::points::{PointIndex, without_pairs};
use crate::error::Result;
use crate::structure::{Base, BaseNode, DofCombination};

/// Difference of displacements that counts as rounding, relative to their largest weight.
const TEAR_ROUNDING: f64 = 1e-6;

/// Points where faces of a base meet and move apart: their number, and the first one; `None` without any.
///
/// Two corners at one point move apart if they rise by different amounts for some degrees of freedom. A corner on the edge of
/// another face moves apart from it if it leaves the line between the ends of the edge.
pub(crate) fn tears(base: &Base) -> Result<Option<(usize, Point)>> {
    let Base::Faces(faces) = base else { return Ok(None) };
    let mut checked = Vec::with_capacity(faces.len());
    for (number, face) in faces.iter().enumerate() {
        let corners: Vec<Point> = face.iter().map(BaseNode::place).collect();
        checked.push(MatFace::new(number, &corners)?);
    }
    let touch_distance = checked.iter().map(MatFace::touch_distance).fold(0.0, f64::max);
    let mut points = PointIndex::new(touch_distance);
    let mut first: Vec<&BaseNode> = vec![];
    let mut torn = BTreeSet::new();
    let mut edges = vec![];
    for (face, checked) in faces.iter().zip(&checked) {
        for node in face {
            let number = points.index_of(node.place());
            match first.get(number) {
                Some(other) if differ(node, &[(other, 1.0)]) => _ = torn.insert(number),
                Some(_) => {}
                None => first.push(node),
            }
        }
        let corners: Vec<_> =
            checked.corners().iter().map(|place| points.index_of(*place)).collect();
        edges.extend((0..corners.len()).map(|k| [corners[k], corners[(k + 1) % corners.len()]]));
    }
    for on in points.on_edges(&without_pairs(edges)) {
        if let [(_, begin), inner @ .., (_, end)] = &on[..] {
            for (along, number) in inner {
                let line = [(first[*begin], 1.0 - along), (first[*end], *along)];
                if differ(first[*number], &line) {
                    torn.insert(*number);
                }
            }
        }
    }
    Ok(torn.first().map(|number| (torn.len(), points.point(*number))))
}

/// Whether a node rises otherwise than this mean of others for some degrees of freedom.
///
/// Shells of different thickness have undersides at different heights, which move along the ground by different amounts
/// where the shells turn. They rise together.
fn differ(node: &BaseNode, mean: &[(&BaseNode, f64)]) -> bool {
    let mut difference = node.vertical.clone();
    let mut scale = max_weight(&difference);
    for (other, weight) in mean {
        difference -= *weight * other.vertical.clone();
        scale = scale.max(max_weight(&other.vertical));
    }
    max_weight(&difference) > TEAR_ROUNDING * scale
}

/// Largest magnitude of a weight.
fn max_weight(row: &DofCombination) -> f64 {
    row.iter().fold(0.0_f64, |largest, (_, weight)| largest.max(weight.abs()))
}
