//! GOAL: full-plane boundary elements: coefficients, stability, cavities, incident waves, and the
//! ground against the half-plane.
//! SCENE: circles, trenches and flat surfaces in a soil of unit modulus and density.
//! REFERENCE: quadrature, closed forms and half-plane kernels.

mod assessment;
mod cavity;
mod coefficients;
mod convolution_quadrature;
mod growth;
mod half_plane;
mod incident_waves;
mod navier;
mod refused;
mod stability;

use std::f64::consts::PI;

use basemat::Soil;
use basemat::bem::full_plane::{BoundaryKernel, Segment, TimeKernel};

fn soil(poisson: f64) -> Soil {
    Soil::new(1.0, poisson, 1.0).unwrap()
}

/// μ = ρ = c₂ = 1, ν = 1/3: c₁ = 2.
fn unit_soil() -> Soil {
    soil(1.0 / 3.0)
}

/// `count` unit elements of a flat surface.
fn flat(count: usize) -> Vec<Segment> {
    (0..count).map(|k| Segment { from: [k as f64, 0.0], to: [k as f64 + 1.0, 0.0] }).collect()
}

/// G and H of a lag.
fn coefficients(kernel: &TimeKernel, lag: usize) -> [Vec<f64>; 2] {
    let size = 2 * kernel.segments().len();
    let (mut g, mut h) = (vec![7.0; size * size], vec![7.0; size * size]);
    kernel.coefficients(lag, &mut g, &mut h).unwrap();
    [g, h]
}

/// Polygon around a hole of area π, the soil outside (or inside).
fn circle(count: usize, outside: bool) -> Vec<Segment> {
    let angle = 2.0 * PI / count as f64;
    let radius = (PI / (0.5 * count as f64 * angle.sin())).sqrt();
    let node = |k: usize| {
        let a = (k % count) as f64 * angle;
        [radius * a.sin(), radius * a.cos()]
    };
    (0..count)
        .map(|k| {
            let (from, to) = (node(k), node(k + 1));
            if outside { Segment { from, to } } else { Segment { from: to, to: from } }
        })
        .collect()
}
