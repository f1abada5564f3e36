//! The linear problem against tables that were computed independently of this crate.

mod support;

use basemat::bem::Grading;
use std::f64::consts::PI;
use support::rigid_strip::{Contact, RigidStrip};
use support::table;

/// Ricker pulse of peak 1.
fn ricker(time: f64, sigma: f64, center: f64) -> f64 {
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

/// Impedances `[hh, vv, rr, hr]` at each of `frequencies`.
fn impedances(
    poisson: f64,
    (grading, elements, time_step): (Grading, usize, f64),
    bonded: bool,
    frequencies: &[f64],
) -> Vec<[[f64; 2]; 4]> {
    let steps = (60.0 / time_step).round() as usize;
    let pulse: Vec<f64> = (1..=steps).map(|n| ricker(n as f64 * time_step, 0.5, 3.0)).collect();
    // By symmetry vertical and horizontal, or vertical and rocking, do not mix.
    let run = |contact, motion: [f64; 3]| -> [Vec<f64>; 3] {
        let mut strip = RigidStrip::new(poisson, grading, elements, time_step, contact);
        let mut forces = [const { Vec::new() }; 3];
        for p in &pulse {
            for (list, force) in forces.iter_mut().zip(strip.drive(motion.map(|m| m * p))) {
                list.push(force);
            }
        }
        forces
    };
    let forces = if bonded {
        let [hh, vv, _] = run(Contact::Bonded, [1.0, 1.0, 0.0]);
        let [hr, _, rr] = run(Contact::Bonded, [0.0, 0.0, 1.0]);
        [hh, vv, rr, hr]
    } else {
        let [hr, vv, rr] = run(Contact::Normal, [0.0, 1.0, 1.0]);
        let [hh, _, _] = run(Contact::Tangential, [1.0, 0.0, 0.0]);
        [hh, vv, rr, hr]
    };
    frequencies
        .iter()
        .map(|&omega| {
            let motion = transform(&pulse, omega, |k| (k + 1) as f64 * time_step);
            // Forces are means over the step, whose transform has this factor.
            let phase = 0.5 * omega * time_step;
            let mean = phase.sin() / phase;
            std::array::from_fn(|k| {
                let force = transform(&forces[k], omega, |k| (k as f64 + 0.5) * time_step);
                divide(force, motion).map(|x| x / mean)
            })
        })
        .collect()
}

/// Errors of `[hh, vv, rr, hr]`: root mean square over 0.1 ≤ a₀ ≤ 4 of the error over the modulus,
/// for hr over √|hh·rr|.
fn impedance_errors(file: &str, poisson: f64, mesh: (Grading, usize, f64), bonded: bool) -> [f64; 4] {
    let rows: Vec<[f64; 9]> = table(file)
        .rows(["a0", "re_khh", "im_khh", "re_kvv", "im_kvv", "re_krr", "im_krr", "re_khr", "im_khr"])
        .into_iter()
        .filter(|row| (0.0999..4.0001).contains(&row[0]))
        .collect();
    let frequencies: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    let found = impedances(poisson, mesh, bonded, &frequencies);
    let mut errors = [0.0; 4];
    for (row, found) in rows.iter().zip(&found) {
        let modulus = |k: usize| row[2 * k + 1].hypot(row[2 * k + 2]);
        for k in 0..4 {
            let error = (found[k][0] - row[2 * k + 1]).hypot(found[k][1] - row[2 * k + 2]);
            let scale = if k == 3 { (modulus(0) * modulus(2)).sqrt() } else { modulus(k) };
            errors[k] += (error / scale).powi(2);
        }
    }
    errors.map(|e| (e / rows.len() as f64).sqrt())
}

#[test]
fn explore() {
    let _ = PI;
    for bonded in [true, false] {
        for (name, nu) in [("0", 0.0), ("025", 0.25), ("0333", 1.0 / 3.0)] {
            for dt in [0.1, 0.05, 0.025] {
                for (grading, n) in [
                    (Grading::Uniform, 8),
                    (Grading::Uniform, 16),
                    (Grading::Uniform, 32),
                    (Grading::Cosine, 8),
                    (Grading::Cosine, 16),
                ] {
                    if dt < 0.05 && (nu != 0.25 || n > 16) { continue; }
                    let start = std::time::Instant::now();
                    let kind = if bonded { "bonded" } else { "relaxed" };
                    let e = impedance_errors(&format!("strip_{kind}_nu{name}_xi00.csv"), nu, (grading, n, dt), bonded);
                    let s: Vec<String> = e.iter().map(|x| format!("{x:.2e}")).collect(); println!("{kind} {name} {grading:?} {n} {dt} {} {:?}", s.join(" "), start.elapsed());
                }
            }
        }
    }
}
