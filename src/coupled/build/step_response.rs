//! Responses of a structure in its modes to unit forces that are suddenly applied, as the time scheme
//! steps them: by these, two sets of Ritz modes are compared.
//!
//! | symbol | meaning |
//! |---|---|
//! | f | row in terms of the modes, with f K_eff⁻¹ fᵀ = 1 |
//! | u, v, a | displacement, velocity, acceleration of the modes under a unit force on each |
//!
//! Tractions begin to grow suddenly where contact opens or slides. Under a force that grows steadily,
//! accelerations are the velocities v, and velocities the displacements u, of a constant one. Loads may
//! jump: what a probe reads then is its sum of u, v and a.

use super::subspace::Ritz;
use crate::coupled::scheme::SchemeCoefficients;
use crate::linalg::{largest, row_products};

/// Rounding of a response, relative to the largest of all.
const ROUNDING: f64 = 1e-13;

/// Rows of degrees of freedom that forces act on and that are looked at.
pub(crate) struct Rows {
    /// Loads, other forces, displacements and velocities, accelerations: an entry for every degree of freedom.
    pub(crate) all: Vec<f64>,
    /// Loads, all forces, and all but accelerations.
    pub(crate) counts: [usize; 3],
    /// Rows of displacements, velocities and accelerations that each probe sums.
    pub(crate) probes: Vec<[Option<usize>; 3]>,
}

/// Responses of all outputs to all forces.
pub(super) struct StepResponses {
    /// Displacements and velocities at some steps: forces × outputs each.
    values: [Vec<f64>; 2],
    outputs: usize,
    /// Outputs from this one on are accelerations.
    accelerations: usize,
    /// What probes read at these steps: loads × probes.
    read: Vec<f64>,
    probes: usize,
}

impl StepResponses {
    /// Responses over `steps` steps of `rows`, whose `shares` in the modes these are.
    pub(super) fn new(
        modes: &Ritz,
        mut shares: Vec<f64>,
        rows: &Rows,
        coefficients: &SchemeCoefficients,
        steps: usize,
    ) -> Self {
        let [loads, forces, accelerations] = rows.counts;
        let (count, c) = (modes.stiffness.len().max(1), coefficients);
        let parts = modes.stiffness.iter().zip(&modes.damping);
        let effective =
            |(k, d): (&f64, &f64)| c.acceleration[0] + c.velocity[0] * d + c.displacement[0] * k;
        let effective: Vec<f64> = parts.map(effective).collect();
        let mut sizes = Vec::with_capacity(shares.len() / count);
        for row in shares.chunks_exact_mut(count) {
            let energy: f64 = row.iter().zip(&effective).map(|(f, k)| f * f / k).sum();
            let size = if energy > 0.0 { energy.sqrt() } else { 1.0 };
            for share in row {
                *share /= size;
            }
            sizes.push(size);
        }
        let apply = SchemeCoefficients::apply;
        let mut state = vec![[0.0_f64; 3]; count];
        let (mut values, mut read) = ([Vec::new(), Vec::new()], Vec::new());
        let mut next = 1;
        for step in 1..=steps {
            for (j, [u, v, a]) in state.iter_mut().enumerate() {
                let (k, d) = (modes.stiffness[j], modes.damping[j]);
                // Rigid motions are in every set.
                if k == 0.0 {
                    continue;
                }
                let known = apply(c.acceleration, 0.0, *v, *a)
                    + d * apply(c.velocity, 0.0, *v, *a)
                    + k * (*u + apply(c.displacement, 0.0, *v, *a));
                let increment = (1.0 - known) / effective[j];
                let velocity = apply(c.new_velocity, increment, *v, *a);
                *a = apply(c.new_acceleration, increment, *v, *a);
                *v = velocity;
                *u += increment;
            }
            if step == next {
                next += 1 + step / 8;
                let answers = |forces: usize, kind: usize| {
                    let rows = shares.chunks_exact(count).take(forces);
                    let rows = rows.flat_map(|row| row.iter().zip(&state));
                    let weighted: Vec<f64> = rows.map(|(f, state)| f * state[kind]).collect();
                    row_products(&weighted, &shares, count)
                };
                let [u, v] = [0, 1].map(|kind| answers(forces, kind));
                if loads > 0 {
                    let (a, outputs) = (answers(loads, 2), sizes.len());
                    for load in 0..loads {
                        let of =
                            |answer: &[f64], row: usize| answer[load * outputs + row] * sizes[row];
                        read.extend(rows.probes.iter().map(|probe| {
                            let parts = probe.iter().zip([&u, &v, &a]);
                            parts.filter_map(|(row, answer)| Some(of(answer, (*row)?))).sum::<f64>()
                        }));
                    }
                }
                values[0].extend(u);
                values[1].extend(v);
            }
        }
        Self { values, outputs: sizes.len(), accelerations, read, probes: rows.probes.len() }
    }

    /// Largest difference to `other` of any output, relative to the largest value of that output.
    pub(super) fn difference(&self, other: &Self, tolerance: f64) -> f64 {
        let [u, v] = [0, 1].map(|kind| [&self.values[kind][..], &other.values[kind]]);
        let (first, all) = (self.accelerations, self.outputs);
        let looks = [
            (u, all, 0..first),
            (v, all, first..all),
            ([&self.read, &other.read], self.probes, 0..self.probes),
        ];
        let mut worst = 0.0_f64;
        for ([own, others], outputs, wanted) in looks {
            for output in wanted {
                let pairs = own.iter().zip(others).skip(output).step_by(outputs);
                // What a probe reads has a unit of its own.
                let scale = pairs.clone().map(|(a, _)| a.abs()).fold(0.0, f64::max);
                let rounding =
                    ROUNDING / tolerance * if outputs == all { largest(own) } else { scale };
                let (top, apart) = pairs.fold((rounding, 0.0_f64), |(top, apart), (a, b)| {
                    // `max` ignores NaN.
                    let apart = if (a - b).is_finite() { apart } else { f64::INFINITY };
                    (top.max(a.abs()), apart.max((a - b).abs()))
                });
                if apart.is_infinite() {
                    return f64::INFINITY;
                }
                worst = worst.max(if apart > 0.0 { apart / top } else { 0.0 });
            }
        }
        worst
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn responses_that_overflow_are_not_equal() {
        let of = |value: f64| StepResponses {
            values: [vec![value; 2], Vec::new()],
            outputs: 1,
            accelerations: 1,
            read: Vec::new(),
            probes: 0,
        };
        for value in [f64::INFINITY, f64::NAN] {
            assert_eq!(of(value).difference(&of(value), 1e-6), f64::INFINITY);
        }
        assert_eq!(of(1.0).difference(&of(1.0), 1e-6), 0.0);
        assert!((of(1.0).difference(&of(2.0), 1e-6) - 1.0).abs() < 1e-12);
    }
}
