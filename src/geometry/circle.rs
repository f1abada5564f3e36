//! Circle as a polygon.

use std::f64::consts::TAU;

/// Number of corners of the polygon that replaces a circle.
const CORNERS: usize = 32;

/// Corners of a regular polygon about the origin with the area of a circle.
pub(crate) fn circle(radius: f64) -> impl Iterator<Item = [f64; 2]> {
    let angle = TAU / CORNERS as f64;
    let reach = radius * (angle / angle.sin()).sqrt();
    (0..CORNERS).map(move |k| {
        let (sin, cos) = ((k as f64 + 0.5) * angle).sin_cos();
        [reach * cos, reach * sin]
    })
}
