//! GOAL: finite elements in space.
//! SCENE: single elements, patches, columns, cantilevers, plates and cylinders on supports.
//! REFERENCE: matrices and benchmarks of an independent program, closed forms, the elements of the plane.

mod bars;
mod beams;
mod bricks;
mod columns;
mod refused;
mod tables;

use basemat::fem::{BeamSection, Material};

/// Concrete of the tables.
fn concrete() -> Material {
    Material::new(30.0e9, 0.2, 2500.0).unwrap()
}

/// Section of the tables' beams, 0.3 m × 0.4 m, without shear deformation.
fn section() -> BeamSection {
    BeamSection::new(0.12, [1.6e-3, 0.9e-3], 1.94e-3).unwrap()
}

/// Section of the tables' beams with shear deformation.
fn sheared() -> BeamSection {
    section().with_shear_areas([0.1, 0.1]).unwrap()
}

fn add(a: [f64; 3], factor: f64, b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[k] + factor * b[k])
}

fn inner(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
