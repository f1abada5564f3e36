//! Circle as a polygon.

use std::f64::consts::TAU;

/// Number of corners of the polygon that replaces a circle.
const CIRCLE_CORNER_COUNT: usize = 32;

/// Corners of a regular polygon about the origin with the area of a circle.
pub fn circle(radius: f64) -> impl Iterator<Item = [f64; 2]> {
    let angle = TAU / CIRCLE_CORNER_COUNT as f64;
    let corner_radius = radius * (angle / angle.sin()).sqrt();
    (0..CIRCLE_CORNER_COUNT).map(move |k| {
        let corner_angle = (k as f64 + 0.5) * angle;
        let sin = corner_angle.sin();
        let cos = corner_angle.cos();
        [corner_radius * cos, corner_radius * sin]
    })
}
