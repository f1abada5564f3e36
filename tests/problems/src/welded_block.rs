//! A rigid block welded to the faces of a trench, stepped with three degrees of freedom without a `Simulation`.
//!
//! Half width, depth, density, shear modulus and shear wave speed are 1; the block is 3 high. The equations are
//! M a + (L R)ᵀ τ = f and R u = s + G(τ − t). Here u is the displacement of the middle of the base, R u are the means over
//! the elements, L are their lengths, G is the ground's convolution, and s and t are displacements and tractions of the
//! free field.

use basemat::bem::{ContactElement, Ground};
use basemat::unobserved;

use super::dense::{dot, inverse};
use super::table;

const MOTION_COUNT: usize = 3;
const TRENCH_DEPTH: f64 = 1.0;
const BLOCK_HEIGHT: f64 = 3.0;

/// Cause of the motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cause {
    /// Vertical shear waves whose surface displacement is the pulse.
    ///
    /// The value is a factor on the free field's tractions on the left wall: 1, or another value for an error on purpose.
    Waves(f64),
    /// The pulse as horizontal force, and −2 times it as moment about the middle of the base.
    Force,
}

/// (1 − 2x²) exp(−x²), x = 0.6 (t − 9).
fn pulse(time: f64) -> f64 {
    let x = 0.6 * (time - 9.0);
    (1.0 - 2.0 * x * x) * (-x * x).exp()
}

/// Means over an element's depths of the displacement of the waves, and of their time integral of shear stress.
///
/// With upward and downward pulses p(t + z) and p(t − z) they are half of the sum and half of the difference.
fn waves(time: f64, [top, bottom]: [f64; 2]) -> [f64; 2] {
    const POINT_COUNT: usize = 8;
    let mut means = [0.0; 2];
    for point in 0..POINT_COUNT {
        let z = top + (bottom - top) * (point as f64 + 0.5) / POINT_COUNT as f64;
        let up = pulse(time + z);
        let downward_pulse = pulse(time - z);
        means[0] += 0.5 * (up + downward_pulse) / POINT_COUNT as f64;
        means[1] += 0.5 * (up - downward_pulse) / POINT_COUNT as f64;
    }
    means
}

/// Depths of both ends of an element.
fn depths(element: &ContactElement) -> [f64; 2] {
    let half = 0.5 * element.length() * element.directions()[1][2].abs();
    let middle = -element.center()[2];
    [middle - half, middle + half]
}

/// Mean displacements of the elements, normal and then tangential, in rigid motions: to the right, down, rotation that
/// lowers the right end.
fn rigid_motion_rows(elements: &[ContactElement]) -> Vec<[f64; MOTION_COUNT]> {
    let normal = elements.iter().map(|element| rigid_motion_row(element, 0));
    let tangential = elements.iter().map(|element| rigid_motion_row(element, 1));
    normal.chain(tangential).collect()
}

/// Mean displacement of an element along one of its directions in each rigid motion.
fn rigid_motion_row(element: &ContactElement, component: usize) -> [f64; MOTION_COUNT] {
    let center = element.center();
    let direction = element.directions()[component];
    [
        direction[0],
        -direction[2],
        direction[0] * (TRENCH_DEPTH + center[2]) - direction[2] * center[0],
    ]
}

/// Mass matrix of the block about the middle of its base.
fn mass_matrix() -> [[f64; MOTION_COUNT]; MOTION_COUNT] {
    let mass = 2.0 * BLOCK_HEIGHT;
    let arm = 0.5 * BLOCK_HEIGHT;
    let inertia = mass * (4.0 + BLOCK_HEIGHT * BLOCK_HEIGHT) / 12.0 + mass * arm * arm;
    [[mass, 0.0, mass * arm], [0.0, mass, 0.0], [mass * arm, 0.0, inertia]]
}

/// Forces of tractions in the block's three motions: (L R)ᵀ τ.
fn resultant(loads: &[[f64; MOTION_COUNT]], traction: &[f64]) -> [f64; MOTION_COUNT] {
    std::array::from_fn(|k| loads.iter().zip(traction).map(|(row, t)| row[k] * t).sum())
}

/// Causes of the block's motion in a step.
struct StepInput {
    /// Displacements of the free field at the end of the step.
    displacement: Vec<f64>,
    /// Tractions of the free field in the step.
    traction: Vec<f64>,
    /// Forces on the block.
    load: [f64; MOTION_COUNT],
}

impl StepInput {
    /// Input of a step, counted from 1.
    fn new(cause: Cause, elements: &[ContactElement], step: usize, time_step: f64) -> Self {
        let start = (step - 1) as f64 * time_step;
        let end = step as f64 * time_step;
        let count = elements.len();
        let mut input = Self {
            displacement: vec![0.0; 2 * count],
            traction: vec![0.0; 2 * count],
            load: [0.0; MOTION_COUNT],
        };
        match cause {
            Cause::Waves(left_factor) => {
                for (e, element) in elements.iter().enumerate() {
                    let horizontal_direction = element.directions()[0][0];
                    let start_means = waves(start, depths(element));
                    let end_means = waves(end, depths(element));
                    let stress = (end_means[1] - start_means[1]) / time_step;
                    let is_floor = horizontal_direction == 0.0;
                    let component = if is_floor { count + e } else { e };
                    input.displacement[component] =
                        end_means[0] * if is_floor { 1.0 } else { horizontal_direction };
                    input.traction[count + e] = if is_floor { -stress } else { stress };
                    if horizontal_direction < 0.0 {
                        input.traction[count + e] *= left_factor;
                    }
                }
            }
            Cause::Force => {
                // Simpson's rule.
                let middle = pulse(0.5 * (start + end));
                let mean = (pulse(start) + 4.0 * middle + pulse(end)) / 6.0;
                input.load = [mean, 0.0, -2.0 * mean];
            }
        }
        input
    }
}

/// Displacement and rotation of the middle of the base at the end of each step.
pub fn march(ground: &mut dyn Ground, time_step: f64, steps: usize, cause: Cause) -> Vec<[f64; 2]> {
    ground.prepare(time_step, Some(steps), &mut unobserved).unwrap();
    let elements = ground.elements().to_vec();
    let count = elements.len();
    let size = 2 * count;
    let rows = rigid_motion_rows(&elements);
    let mut compliance = vec![0.0; size * size];
    ground.step_compliance(&mut compliance).unwrap();
    let stiffness = inverse(&compliance, size);
    let loads: Vec<[f64; MOTION_COUNT]> = (0..size)
        .map(|i| rows[i].map(|value| value * elements[i % count].length()))
        .collect();
    let mass = mass_matrix();
    // Mean acceleration over a step: 2 (Δu/Δt − v)/Δt.
    let mut system = [0.0; MOTION_COUNT * MOTION_COUNT];
    for k in 0..MOTION_COUNT {
        let column: Vec<f64> = rows.iter().map(|row| row[k]).collect();
        let force = resultant(&loads, &multiply(&stiffness, &column));
        for i in 0..MOTION_COUNT {
            system[i * MOTION_COUNT + k] = force[i] + 2.0 * mass[i][k] / time_step.powi(2);
        }
    }
    let system_inverse = inverse(&system, MOTION_COUNT);
    let mut displacement = [0.0; MOTION_COUNT];
    let mut velocity = [0.0; MOTION_COUNT];
    let mut history = vec![0.0; size];
    let mut motions = vec![];
    for step in 1..=steps {
        let input = StepInput::new(cause, &elements, step, time_step);
        ground.history(&mut history).unwrap();
        // τ = t + G₁⁻¹ (R u − s − h), with R u at the end of the step.
        let relative_displacement: Vec<f64> = (0..size)
            .map(|i| dot(&rows[i], &displacement) - input.displacement[i] - history[i])
            .collect();
        let mut traction = multiply(&stiffness, &relative_displacement);
        traction.iter_mut().zip(&input.traction).for_each(|(t, field)| *t += field);
        let force = resultant(&loads, &traction);
        let inertia: [f64; MOTION_COUNT] =
            std::array::from_fn(|i| 2.0 * dot(&mass[i], &velocity) / time_step);
        let right_side: Vec<f64> =
            (0..MOTION_COUNT).map(|i| input.load[i] - force[i] + inertia[i]).collect();
        let increment = multiply(&system_inverse, &right_side);
        let element_increments: Vec<f64> = rows.iter().map(|row| dot(row, &increment)).collect();
        let traction_increments = multiply(&stiffness, &element_increments);
        let committed: Vec<f64> =
            (0..size).map(|i| traction[i] + traction_increments[i] - input.traction[i]).collect();
        ground.commit(&committed);
        for k in 0..MOTION_COUNT {
            displacement[k] += increment[k];
            velocity[k] = 2.0 * increment[k] / time_step - velocity[k];
        }
        motions.push([displacement[0], displacement[2]]);
    }
    motions
}

/// Largest errors of displacement and rotation, relative to the largest reference values.
///
/// The reference is the synthesis in `tests/data/embedded`. `name`: SV or force, and the step.
pub fn errors(motions: &[[f64; 2]], name: &str) -> [f64; 2] {
    let table = table(&format!("embedded/td_{name}.csv"));
    let expected = table.rows(["reference_ux", "reference_theta"]);
    std::array::from_fn(|k| {
        let max_expected = expected.iter().fold(0.0_f64, |max, row| max.max(row[k].abs()));
        let errors = motions.iter().zip(&expected).map(|(u, expected)| (u[k] - expected[k]).abs());
        errors.fold(0.0, f64::max) / max_expected
    })
}

/// A row-major matrix times a vector.
fn multiply(matrix: &[f64], vector: &[f64]) -> Vec<f64> {
    matrix.chunks_exact(vector.len()).map(|row| dot(row, vector)).collect()
}
