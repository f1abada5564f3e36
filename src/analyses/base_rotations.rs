//! Rotations of a base from the displacement of a structure.

use crate::structure::{Base, BaseNode, Structure};

/// Determinant of the second moments of nodes, relative to the square of one, up to which they lie on a line.
const COLLINEAR_NODES_TOLERANCE: f64 = 1e-12;

/// Rotations of the base about y and, in plan, about x: of the plane that fits its nodes best, the largest of all parts.
pub(super) fn base_rotations(structure: &dyn Structure, displacement: &[f64]) -> [f64; 2] {
    let base = structure.base();
    let mut largest = [0.0_f64; 2];
    for part in base.parts() {
        let [slope, slope_across] = slopes(part, displacement);
        let rotations = match base {
            Base::Faces(_) => [-slope, slope_across],
            Base::Lines(_) => [slope, 0.0],
        };
        for (sum, value) in largest.iter_mut().zip(rotations) {
            if value.abs() > sum.abs() {
                *sum = value;
            }
        }
    }
    largest
}

/// Slopes along x and y of the plane that fits the vertical displacements of nodes best.
fn slopes(nodes: &[BaseNode], displacement: &[f64]) -> [f64; 2] {
    let count = nodes.len() as f64;
    let mut points = Vec::with_capacity(nodes.len());
    let mut mean = [0.0; 3];
    for node in nodes {
        let point = [node.x, node.y, node.vertical.value(displacement)];
        for (sum, value) in mean.iter_mut().zip(point) {
            *sum += value / count;
        }
        points.push(point);
    }
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
