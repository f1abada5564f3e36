//! A rigid block welded to the faces of a trench, stepped with three degrees of freedom and nothing of a simulation.
//!
//! Half width, depth, density, shear modulus and shear wave speed are 1; the block is 3 high. With displacements of the
//! middle of the base, R their means over the elements, L the lengths and G the ground's convolution:
//! M a + (L R)ᵀ τ = f, R u = s + G(τ − t), with displacements s and tractions t of the free field.

use basemat::bem::{ContactElement, Ground};
use basemat::unobserved;

use super::dense::{dot, inverse};
use super::table;

const MOTIONS: usize = 3;
const DEPTH: f64 = 1.0;
const HEIGHT: f64 = 3.0;

/// Cause of the motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cause {
    /// Vertical shear waves that move the surface by the pulse. The tractions of the free field on the left wall have
    /// this factor, 1 unless they are to be wrong.
    Waves(f64),
    /// The pulse as horizontal force, and −2 times it as moment about the middle of the base.
    Force,
}

/// (1 − 2x²) exp(−x²), x = 0.6 (t − 9).
fn pulse(time: f64) -> f64 {
    let x = 0.6 * (time - 9.0);
    (1.0 - 2.0 * x * x) * (-x * x).exp()
}

/// Means of (t − z) and (t + z) pulses over the depths of an element: their sum's half, and their difference's half.
fn waves(time: f64, [top, bottom]: [f64; 2]) -> [f64; 2] {
    const POINTS: usize = 8;
    let mut means = [0.0; 2];
    for point in 0..POINTS {
        let z = top + (bottom - top) * (point as f64 + 0.5) / POINTS as f64;
        let [up, down] = [pulse(time + z), pulse(time - z)];
        means[0] += 0.5 * (up + down) / POINTS as f64;
        means[1] += 0.5 * (up - down) / POINTS as f64;
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
fn rigid(elements: &[ContactElement]) -> Vec<[f64; MOTIONS]> {
    let row = |component: usize| {
        elements.iter().map(move |element| {
            let [x, _, z] = element.center();
            let [along, _, up] = element.directions()[component];
            [along, -up, along * (DEPTH + z) - up * x]
        })
    };
    row(0).chain(row(1)).collect()
}

/// Displacement and rotation of the middle of the base at the end of each step.
pub fn march(ground: &mut dyn Ground, time_step: f64, steps: usize, cause: Cause) -> Vec<[f64; 2]> {
    ground.prepare(time_step, Some(steps), &mut unobserved).unwrap();
    let elements = ground.elements().to_vec();
    let (count, size) = (elements.len(), 2 * elements.len());
    let rows = rigid(&elements);
    let mut compliance = vec![0.0; size * size];
    ground.step_compliance(&mut compliance).unwrap();
    let stiffness = inverse(&compliance, size);
    let loads: Vec<[f64; MOTIONS]> =
        (0..size).map(|i| rows[i].map(|value| value * elements[i % count].length())).collect();
    let resultant = |traction: &[f64]| -> [f64; MOTIONS] {
        std::array::from_fn(|k| loads.iter().zip(traction).map(|(row, t)| row[k] * t).sum())
    };
    let mass = 2.0 * HEIGHT;
    let arm = 0.5 * HEIGHT;
    let turning = mass * (4.0 + HEIGHT * HEIGHT) / 12.0 + mass * arm * arm;
    let mass = [[mass, 0.0, mass * arm], [0.0, mass, 0.0], [mass * arm, 0.0, turning]];
    // Mean acceleration over a step: 2 (Δu/Δt − v)/Δt.
    let mut system = [0.0; MOTIONS * MOTIONS];
    for k in 0..MOTIONS {
        let column: Vec<f64> = rows.iter().map(|row| row[k]).collect();
        let force = resultant(&times(&stiffness, &column));
        for i in 0..MOTIONS {
            system[i * MOTIONS + k] = force[i] + 2.0 * mass[i][k] / time_step.powi(2);
        }
    }
    let solution = inverse(&system, MOTIONS);
    let (mut displacement, mut velocity) = ([0.0; MOTIONS], [0.0; MOTIONS]);
    let (mut history, mut found) = (vec![0.0; size], vec![]);
    for step in 1..=steps {
        let ends = [(step - 1) as f64 * time_step, step as f64 * time_step];
        let (mut field, mut own) = (vec![0.0; size], vec![0.0; size]);
        let mut load = [0.0; MOTIONS];
        match cause {
            Cause::Waves(left) => {
                for (e, element) in elements.iter().enumerate() {
                    let [along, _, _] = element.directions()[0];
                    let [before, now] = ends.map(|time| waves(time, depths(element)));
                    let stress = (now[1] - before[1]) / time_step;
                    let place = if along == 0.0 { count + e } else { e };
                    field[place] = now[0] * if along == 0.0 { 1.0 } else { along };
                    own[count + e] = if along == 0.0 { -stress } else { stress };
                    if along < 0.0 {
                        own[count + e] *= left;
                    }
                }
            }
            Cause::Force => {
                // Simpson's rule.
                let middle = pulse(0.5 * (ends[0] + ends[1]));
                let mean = (pulse(ends[0]) + 4.0 * middle + pulse(ends[1])) / 6.0;
                load = [mean, 0.0, -2.0 * mean];
            }
        }
        ground.history(&mut history).unwrap();
        // τ = t + G₁⁻¹ (R u − s − h), with R u at the end of the step.
        let at_rest: Vec<f64> = (0..size)
            .map(|i| {
                let kept: f64 = rows[i].iter().zip(&displacement).map(|(r, u)| r * u).sum();
                kept - field[i] - history[i]
            })
            .collect();
        let mut traction = times(&stiffness, &at_rest);
        traction.iter_mut().zip(&own).for_each(|(t, own)| *t += own);
        let held = resultant(&traction);
        let inertia: [f64; MOTIONS] = std::array::from_fn(|i| {
            let speed: f64 = mass[i].iter().zip(&velocity).map(|(m, v)| m * v).sum();
            2.0 * speed / time_step
        });
        let right: Vec<f64> = (0..MOTIONS).map(|i| load[i] - held[i] + inertia[i]).collect();
        let change = times(&solution, &right);
        let moved: Vec<f64> =
            rows.iter().map(|row| row.iter().zip(&change).map(|(r, u)| r * u).sum()).collect();
        let more = times(&stiffness, &moved);
        let committed: Vec<f64> = (0..size).map(|i| traction[i] + more[i] - own[i]).collect();
        ground.commit(&committed);
        for k in 0..MOTIONS {
            displacement[k] += change[k];
            velocity[k] = 2.0 * change[k] / time_step - velocity[k];
        }
        found.push([displacement[0], displacement[2]]);
    }
    found
}

/// Largest errors of displacement and rotation against the synthesis in `tests/data/embedded`, relative to the largest
/// values there.
///
/// `name`: SV or force, and the step.
pub fn errors(found: &[[f64; 2]], name: &str) -> [f64; 2] {
    let table = table(&format!("embedded/td_{name}.csv"));
    let wanted = table.rows(["reference_ux", "reference_theta"]);
    std::array::from_fn(|k| {
        let largest = wanted.iter().fold(0.0_f64, |most, row| most.max(row[k].abs()));
        let errors = found.iter().zip(&wanted).map(|(found, wanted)| (found[k] - wanted[k]).abs());
        errors.fold(0.0, f64::max) / largest
    })
}

/// A row-major matrix times a vector.
fn times(matrix: &[f64], vector: &[f64]) -> Vec<f64> {
    matrix.chunks_exact(vector.len()).map(|row| dot(row, vector)).collect()
}
