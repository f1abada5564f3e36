//! Impedances of the rigid strip from its response to pulses.

use basemat::bem::Grading;

use super::rigid_strip::{DrivenStrip, StripTractions};
use super::series::{RelativeError, nearest_integer};
use super::table;

/// Ricker pulse of peak 1.
pub fn ricker(time: f64, sigma: f64, center: f64) -> f64 {
    let a = ((time - center) / sigma).powi(2);
    (1.0 - 2.0 * a) * (-a).exp()
}

/// Sum of `values`(k) e^(−iωt(k)): its real and imaginary part.
fn transform(values: &[f64], omega: f64, time: impl Fn(usize) -> f64) -> [f64; 2] {
    values.iter().enumerate().fold([0.0; 2], |[re, im], (k, v)| {
        let phase = omega * time(k);
        [re + v * phase.cos(), im - v * phase.sin()]
    })
}

fn divide([a, b]: [f64; 2], [c, d]: [f64; 2]) -> [f64; 2] {
    let square = c * c + d * d;
    [(a * c + b * d) / square, (b * c - a * d) / square]
}

/// Time at which a ground's traction of a step stands for the force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ForceSampling {
    /// The traction is the mean over the step.
    Mean,
    /// The traction is the value at the end of the step.
    End,
}

/// Impedances `[hh, vv, rr, hr]` at each of `frequencies`, of strips marched with `time_step`.
pub fn impedances(
    make: impl Fn(StripTractions) -> DrivenStrip,
    time_step: f64,
    sampling: ForceSampling,
    is_bonded: bool,
    frequencies: &[f64],
) -> Vec<[[f64; 2]; 4]> {
    let steps = nearest_integer(60.0 / time_step);
    let pulse: Vec<f64> = (1..=steps).map(|n| ricker(n as f64 * time_step, 0.5, 3.0)).collect();
    // By symmetry, vertical motion is coupled neither with horizontal motion nor with rocking.
    let forces = if is_bonded {
        let by_translation = pulse_response(make(StripTractions::Bonded), &pulse, [1.0, 1.0, 0.0]);
        let by_rotation = pulse_response(make(StripTractions::Bonded), &pulse, [0.0, 0.0, 1.0]);
        [
            by_translation[0].clone(),
            by_translation[1].clone(),
            by_rotation[2].clone(),
            by_rotation[0].clone(),
        ]
    } else {
        let by_pressure = pulse_response(make(StripTractions::Normal), &pulse, [0.0, 1.0, 1.0]);
        let by_shear = pulse_response(make(StripTractions::Tangential), &pulse, [1.0, 0.0, 0.0]);
        [
            by_shear[0].clone(),
            by_pressure[1].clone(),
            by_pressure[2].clone(),
            by_pressure[0].clone(),
        ]
    };
    frequencies
        .iter()
        .map(|&omega| {
            let motion = transform(&pulse, omega, |k| (k + 1) as f64 * time_step);
            // The transform of means over a step has this factor.
            let phase = 0.5 * omega * time_step;
            let sample_position = if sampling == ForceSampling::Mean { 0.5 } else { 1.0 };
            let mean_factor =
                if sampling == ForceSampling::Mean { phase.sin() / phase } else { 1.0 };
            std::array::from_fn(|k| {
                let force =
                    transform(&forces[k], omega, |k| (k as f64 + sample_position) * time_step);
                divide(force, motion).map(|x| x / mean_factor)
            })
        })
        .collect()
}

/// Forces of a strip that a pulse moves along `[right, down, rotation]`.
fn pulse_response(mut strip: DrivenStrip, pulse: &[f64], motion: [f64; 3]) -> [Vec<f64>; 3] {
    let mut forces = [const { Vec::new() }; 3];
    for p in pulse {
        for (series, force) in forces.iter_mut().zip(strip.drive(motion.map(|m| m * p))) {
            series.push(force);
        }
    }
    forces
}

/// Errors of `[hh, vv, rr, hr]` over 0.1 ≤ a₀ ≤ 4, each the root mean square of the error, relative
/// to the root mean square of the modulus.
pub fn impedance_errors(
    file: &str,
    poisson: f64,
    (grading, elements, time_step): (Grading, usize, f64),
    is_bonded: bool,
) -> [f64; 4] {
    let columns =
        ["a0", "re_khh", "im_khh", "re_kvv", "im_kvv", "re_krr", "im_krr", "re_khr", "im_khr"];
    let rows = table(file).rows(columns).into_iter();
    let rows: Vec<_> = rows.filter(|row| (0.0999..4.0001).contains(&row[0])).collect();
    let frequencies: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    let computed = impedances(
        |tractions| DrivenStrip::new(poisson, grading, elements, time_step, tractions),
        time_step,
        ForceSampling::Mean,
        is_bonded,
        &frequencies,
    );
    let mut errors = [RelativeError::default(); 4];
    for (row, computed) in rows.iter().zip(&computed) {
        for k in 0..4 {
            for part in 0..2 {
                errors[k].add(computed[k][part], row[2 * k + 1 + part]);
            }
        }
    }
    errors.map(RelativeError::relative)
}
