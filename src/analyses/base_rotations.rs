//! Rotations of a base from the displacement of a structure.

use crate::structure::{Base, BaseNode, Structure};

/// Determinant of the nodes' second moments, relative to the square of the moment along x.
///
/// Up to this value the nodes count as collinear.
const COLLINEAR_NODES_TOLERANCE: f64 = 1e-12;

/// Rotations of the base about the axes along y and x, rad, from its nodes' displacements.
///
/// A plane is fitted to the displaced nodes of each foundation by least squares. About each axis, the rotation with the
/// largest magnitude of all foundations is returned. A structure in two dimensions has no rotation about x.
pub(super) fn base_rotations(structure: &dyn Structure, displacement: &[f64]) -> [f64; 2] {
    let base = structure.base();
    let mut largest_rotations = [0.0_f64; 2];
    for nodes in base.parts() {
        let [slope_x, slope_y] = fitted_slopes(nodes, displacement);
        let rotations = match base {
            Base::Faces(_) => [-slope_x, slope_y],
            Base::Lines(_) => [slope_x, 0.0],
        };
        for (largest, rotation) in largest_rotations.iter_mut().zip(rotations) {
            if rotation.abs() > largest.abs() {
                *largest = rotation;
            }
        }
    }
    largest_rotations
}

/// Slopes along x and y of the vertical displacements of nodes, by least squares.
///
/// The slope along y of collinear nodes is zero.
fn fitted_slopes(nodes: &[BaseNode], displacement: &[f64]) -> [f64; 2] {
    let node_count = nodes.len() as f64;
    let mut points = Vec::with_capacity(nodes.len());
    let mut mean = [0.0; 3];
    for node in nodes {
        let point = [node.x, node.y, node.vertical.value(displacement)];
        for (sum, value) in mean.iter_mut().zip(point) {
            *sum += value / node_count;
        }
        points.push(point);
    }
    // Sums of the products of coordinates x, y and vertical displacements v, about their means.
    let mut xx = 0.0;
    let mut xy = 0.0;
    let mut yy = 0.0;
    let mut xv = 0.0;
    let mut yv = 0.0;
    for point in points {
        let [x, y, v] = [0, 1, 2].map(|k| point[k] - mean[k]);
        xx += x * x;
        xy += x * y;
        yy += y * y;
        xv += x * v;
        yv += y * v;
    }
    let determinant = xx * yy - xy * xy;
    if determinant > COLLINEAR_NODES_TOLERANCE * xx * xx {
        return [(xv * yy - yv * xy) / determinant, (yv * xx - xv * xy) / determinant];
    }
    [if xx > 0.0 { xv / xx } else { 0.0 }, 0.0]
}
