//! GOAL: full-plane boundary elements: coefficients, stability, cavities, incident waves, and
//! agreement with the half-plane.
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
    (0..count)
        .map(|k| Segment { from: [k as f64, 0.0], to: [k as f64 + 1.0, 0.0] })
        .collect()
}

/// Matrices of displacements G and tractions H of one lag, row by row.
struct LagMatrices {
    g: Vec<f64>,
    h: Vec<f64>,
}

/// G and H of the time kernel at a lag.
fn coefficients(kernel: &TimeKernel, lag: usize) -> LagMatrices {
    let order = 2 * kernel.segments().len();
    let mut g = vec![7.0; order * order];
    let mut h = vec![7.0; order * order];
    kernel.coefficients(lag, &mut g, &mut h).unwrap();
    LagMatrices { g, h }
}

/// Polygon of area π, with the soil outside or inside.
fn circle(count: usize, outside: bool) -> Vec<Segment> {
    let angle = 2.0 * PI / count as f64;
    let radius = (PI / (0.5 * count as f64 * angle.sin())).sqrt();
    let nodes: Vec<[f64; 2]> = (0..count)
        .map(|k| {
            let a = k as f64 * angle;
            [radius * a.sin(), radius * a.cos()]
        })
        .collect();
    (0..count)
        .map(|k| {
            let from = nodes[k];
            let to = nodes[(k + 1) % count];
            if outside { Segment { from, to } } else { Segment { from: to, to: from } }
        })
        .collect()
}

/// Point between two others, at a fraction of their distance.
fn point_between(from: [f64; 2], to: [f64; 2], fraction: f64) -> [f64; 2] {
    [0, 1].map(|i| from[i] + fraction * (to[i] - from[i]))
}

/// Arithmetic mean.
fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
