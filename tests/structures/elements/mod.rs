//! GOAL: finite elements in space.
//! SCENE: single elements, patches, columns, cantilevers, plates and cylinders on supports.
//! REFERENCE: matrices and benchmarks of an independent program, closed forms, the elements of the plane.

mod bars;
mod beams;
mod bricks;
mod columns;
mod refused;
mod tables;

fn add(a: [f64; 3], factor: f64, b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[k] + factor * b[k])
}

fn inner(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
