//! Responses of modes to suddenly applied unit forces, by the time scheme; they serve to compare two sets of Ritz
//! modes.
//!
//! | symbol | meaning |
//! |---|---|
//! | f | row in terms of the modes, with f K_eff⁻¹ fᵀ = 1 |
//! | u, v, a | displacement, velocity, acceleration of the modes under a unit force on each |
//!
//! Tractions begin to grow suddenly where contact opens or slides. Under a force that grows at a constant rate,
//! the accelerations are the velocities v under a constant force, and the velocities the displacements u. Loads
//! may jump: the value of a probe is then its sum of u, v and a.

use crate::coupled::assembly::subspace::Ritz;
use crate::coupled::scheme::SchemeCoefficients;
use crate::linalg::{largest, row_products};

/// Rounding of a response, relative to the largest response.
const RESPONSE_ROUNDING: f64 = 1e-13;

/// Rows of degrees of freedom with forces, and rows of probes.
#[derive(Default)]
pub(crate) struct ResponseRows {
    /// Rows of loads, other forces, displacements and velocities, accelerations: an entry for every degree of
    /// freedom.
    pub(crate) all: Vec<f64>,
    /// Number of loads, which are the first rows.
    pub(crate) load_count: usize,
    /// Number of all forces, loads included.
    pub(crate) force_count: usize,
    /// Number of the first row of an acceleration.
    pub(crate) first_acceleration: usize,
    /// Row numbers of displacements, velocities and accelerations that each probe sums.
    pub(crate) probes: Vec<[Option<usize>; 3]>,
}

/// Responses of all outputs to all forces.
pub(crate) struct StepResponses {
    /// Displacements and velocities at some steps: forces × outputs each.
    values: [Vec<f64>; 2],
    outputs: usize,
    /// Number of the first output that is an acceleration.
    accelerations: usize,
    /// Values of the probes at these steps: loads × probes.
    read: Vec<f64>,
    probes: usize,
}

impl StepResponses {
    /// Responses over `steps` steps of `rows`; `modal_rows`: the rows in terms of the modes.
    ///
    /// Forces grow over `growth_steps` steps by binomial weights.
    pub(crate) fn new(
        modes: &Ritz,
        mut modal_rows: Vec<f64>,
        rows: &ResponseRows,
        c: &SchemeCoefficients,
        steps: usize,
        growth_steps: usize,
    ) -> Self {
        let loads = rows.load_count;
        let forces = rows.force_count;
        let accelerations = rows.first_acceleration;
        let count = modes.stiffness.len().max(1);
        let mut effective = Vec::with_capacity(count);
        for (k, d) in modes.stiffness.iter().zip(&modes.damping) {
            effective.push(c.acceleration[0] + c.velocity[0] * d + c.displacement[0] * k);
        }
        let norms = normalise_rows(&mut modal_rows, &effective);
        let times: Vec<usize> = std::iter::successors(Some(1), |step| Some(step + 1 + step / 8))
            .take_while(|s| *s <= steps)
            .collect();
        let states = mode_states(modes, c, &effective, &times, &binomial(growth_steps));
        let mut values = [Vec::new(), Vec::new()];
        let mut read = Vec::new();
        let mut weighted = vec![0.0; forces * count];
        for states in states.chunks_exact(3 * count) {
            let mut responses = |forces: usize, kind: usize| {
                let states = &states[kind * count..(kind + 1) * count];
                let weighted = &mut weighted[..forces * count];
                for (row, weighted) in
                    modal_rows.chunks_exact(count).zip(weighted.chunks_exact_mut(count))
                {
                    let terms = row.iter().zip(states).zip(weighted);
                    terms.for_each(|((f, state), term)| *term = f * state);
                }
                row_products(weighted, &modal_rows, count)
            };
            let displacements = responses(forces, 0);
            let velocities = responses(forces, 1);
            if loads > 0 {
                let by_kind = [&displacements, &velocities, &responses(loads, 2)];
                for load in 0..loads {
                    read.extend(rows.probes.iter().map(|probe| {
                        let parts = probe.iter().zip(by_kind).filter_map(|(row, responses)| {
                            row.map(|row| responses[load * norms.len() + row] * norms[row])
                        });
                        parts.sum::<f64>()
                    }));
                }
            }
            values[0].extend(displacements);
            values[1].extend(velocities);
        }
        Self { values, outputs: norms.len(), accelerations, read, probes: rows.probes.len() }
    }

    /// Largest displacement of each of these `outputs`, the smallest of all.
    ///
    /// It is at most about 1, the response of a row of unit energy norm to a force on itself. The row of a section force
    /// has a large norm by the stiffness at the cut, and responds little to tractions far away. Directions that the modes
    /// lack cause errors relative to the norms, which are larger relative to such a response.
    pub(crate) fn weakest(&self, outputs: std::ops::Range<usize>) -> f64 {
        let mut sizes = vec![0.0_f64; outputs.len()];
        for responses in self.values[0].chunks_exact(self.outputs.max(1)) {
            let values = sizes.iter_mut().zip(&responses[outputs.clone()]);
            values.for_each(|(size, value)| *size = size.max(value.abs()));
        }
        sizes.into_iter().filter(|size| *size > 0.0).fold(1.0, f64::min)
    }

    /// Largest difference of any output from `other`, relative to the largest value of that output.
    ///
    /// At least rounding.
    pub(crate) fn difference(&self, other: &Self, tolerance: f64) -> f64 {
        let [displacements, velocities] = &self.values;
        let first_acceleration = self.accelerations;
        let outputs = self.outputs;
        let rounding = RESPONSE_ROUNDING / tolerance;
        let displacement_floor = rounding * largest(displacements);
        let velocity_floor = rounding * largest(velocities);
        let comparisons = [
            (displacements, &other.values[0], outputs, 0..first_acceleration, displacement_floor),
            (velocities, &other.values[1], outputs, first_acceleration..outputs, velocity_floor),
            // Probes have different units: no common floor.
            (&self.read, &other.read, self.probes, 0..self.probes, 0.0),
        ];
        let mut worst = RESPONSE_ROUNDING;
        for (values, others, outputs, compared, floor) in comparisons {
            let mut sizes = vec![floor; compared.len()];
            let mut changes = vec![0.0_f64; compared.len()];
            let outputs = outputs.max(1);
            for (row, other) in values.chunks_exact(outputs).zip(others.chunks_exact(outputs)) {
                let pairs = row[compared.clone()].iter().zip(&other[compared.clone()]);
                for ((a, b), (size, change)) in pairs.zip(sizes.iter_mut().zip(&mut changes)) {
                    *size = size.max(a.abs());
                    // `max` ignores NaN.
                    let difference = (a - b).abs();
                    *change =
                        if difference.is_finite() { change.max(difference) } else { f64::INFINITY };
                }
            }
            for (size, change) in sizes.into_iter().zip(changes) {
                if change.is_infinite() {
                    return f64::INFINITY;
                }
                worst =
                    worst.max(if change > 0.0 { change / (size * rounding.max(1.0)) } else { 0.0 });
            }
        }
        worst
    }
}

/// Weights of a force at each of `count` steps and the one before: k of `count`, over 2 to the power of `count`.
fn binomial(count: usize) -> Vec<f64> {
    let mut weight = 0.5_f64.powi(i32::try_from(count).unwrap_or(i32::MAX));
    let mut weights = vec![weight];
    for k in 0..count {
        let ratio = (count - k) as f64 / (k + 1) as f64;
        weight *= ratio;
        weights.push(weight);
    }
    weights
}

/// u, v and a of each mode under a unit force that grows by `weights`, at these steps: steps × 3 × modes.
fn mode_states(
    modes: &Ritz,
    coefficients: &SchemeCoefficients,
    effective: &[f64],
    times: &[usize],
    weights: &[f64],
) -> Vec<f64> {
    let count = effective.len().max(1);
    let mut states = vec![0.0; times.len() * 3 * count];
    for (j, (k, d)) in modes.stiffness.iter().zip(&modes.damping).enumerate() {
        // Every set contains the rigid motions.
        if *k == 0.0 {
            continue;
        }
        let step = Step::new(coefficients, effective[j], *d, *k);
        for (at, mut state) in step.states(times).enumerate() {
            let mut sums = [0.0; 3];
            for weight in weights {
                sums.iter_mut().zip(state).for_each(|(sum, value)| *sum += weight * value);
                state = step.apply(state);
            }
            for (kind, value) in sums.into_iter().enumerate() {
                states[(3 * at + kind) * count + j] = value;
            }
        }
    }
    states
}

/// A step of one mode under a unit force.
///
/// Rows of the new displacement, velocity and acceleration in terms of the old ones and of 1.
#[derive(Clone, Copy)]
struct Step([[f64; 4]; 3]);

impl Step {
    /// Step of a mode with this effective stiffness, damping and stiffness.
    fn new(c: &SchemeCoefficients, effective: f64, damping: f64, stiffness: f64) -> Self {
        let predicted =
            |i: usize| c.acceleration[i] + damping * c.velocity[i] + stiffness * c.displacement[i];
        let increment =
            [-stiffness, -predicted(1), -predicted(2), 1.0].map(|term| term / effective);
        let row = |[by_increment, v, a]: [f64; 3]| {
            let direct = [0.0, v, a, 0.0];
            std::array::from_fn(|i| by_increment * increment[i] + direct[i])
        };
        let mut displacement = increment;
        displacement[0] += 1.0;
        Self([displacement, row(c.new_velocity), row(c.new_acceleration)])
    }

    fn apply(&self, state: [f64; 3]) -> [f64; 3] {
        self.0.map(|[u, v, a, one]| u * state[0] + v * state[1] + a * state[2] + one)
    }

    /// Two steps in one.
    fn twice(&self) -> Self {
        Self(self.0.map(|row| {
            std::array::from_fn(|i| {
                let through: f64 = (0..3).map(|k| row[k] * self.0[k][i]).sum();
                through + if i == 3 { row[3] } else { 0.0 }
            })
        }))
    }

    /// States from rest after the numbers of steps `times`, ascending; computed by powers of two of the step.
    fn states(self, times: &[usize]) -> impl Iterator<Item = [f64; 3]> {
        let mut powers = vec![self];
        let mut state = [0.0; 3];
        let mut now = 0;
        times.iter().map(move |time| {
            let mut remaining = time - now;
            now = *time;
            for power in 0.. {
                if remaining == 0 {
                    break;
                }
                if power == powers.len() {
                    powers.push(powers[power - 1].twice());
                }
                if remaining % 2 == 1 {
                    state = powers[power].apply(state);
                }
                remaining /= 2;
            }
            state
        })
    }
}

/// Divides rows of modal forces by their energy norms with these effective stiffnesses, and returns the norms.
fn normalise_rows(modal_rows: &mut [f64], effective: &[f64]) -> Vec<f64> {
    let mut norms = Vec::with_capacity(modal_rows.len() / effective.len().max(1));
    for row in modal_rows.chunks_exact_mut(effective.len().max(1)) {
        let energy: f64 = row.iter().zip(effective).map(|(f, k)| f * f / k).sum();
        let norm = if energy > 0.0 { energy.sqrt() } else { 1.0 };
        for value in row {
            *value /= norm;
        }
        norms.push(norm);
    }
    norms
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coupled::scheme::{Newmark, TimeScheme};

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
        assert_eq!(of(1.0).difference(&of(1.0), 1e-6), RESPONSE_ROUNDING);
        assert!((of(1.0).difference(&of(2.0), 1e-6) - 1.0).abs() < 1e-12);
    }
    /// REFERENCE: single steps.
    #[test]
    fn powers_of_a_step_are_many_steps() {
        let c = Newmark::new(0.6, 0.3025).unwrap().coefficients(0.01);
        let damping = 1.0;
        let stiffness = 4.0e3;
        let effective = c.acceleration[0] + c.velocity[0] * damping + c.displacement[0] * stiffness;
        let times = [1, 2, 3, 5, 8, 13, 100, 1000];
        let mut found = Step::new(&c, effective, damping, stiffness).states(&times);
        let apply = SchemeCoefficients::apply;
        let mut u = 0.0;
        let mut v = 0.0;
        let mut a = 0.0;
        for step in 1..=1000 {
            let known = apply(c.acceleration, 0.0, v, a)
                + damping * apply(c.velocity, 0.0, v, a)
                + stiffness * (u + apply(c.displacement, 0.0, v, a));
            let increment = (1.0 - known) / effective;
            let velocity = apply(c.new_velocity, increment, v, a);
            a = apply(c.new_acceleration, increment, v, a);
            (u, v) = (u + increment, velocity);
            if times.contains(&step) {
                for (kind, (value, expected)) in
                    found.next().unwrap().into_iter().zip([u, v, a]).enumerate()
                {
                    let size = [1.0 / stiffness, 1.0 / f64::sqrt(stiffness), 1.0][kind];
                    let difference = f64::abs(value - expected);
                    assert!(difference < 1e-12 * size, "step {step}: {value} for {expected}");
                }
            }
        }
        assert!(found.next().is_none());
    }
}
