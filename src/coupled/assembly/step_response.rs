//! Responses of Ritz modes to unit forces, to compare two sets of modes.
//!
//! | symbol | meaning |
//! |---|---|
//! | f | modal weights of a row, with f K_eff⁻¹ fᵀ = 1 |
//! | u, v, a | displacement, velocity and acceleration of each mode under a unit force |
//!
//! Tractions begin to grow suddenly where contact opens or slides. Under a force that grows at a constant rate, the
//! accelerations are the velocities v under a constant force, and the velocities are the displacements u. Loads may start
//! suddenly. The value of a probe is then its sum of u, v and a.

use std::ops::Range;

use crate::coupled::assembly::response_rows::ResponseRows;
use crate::coupled::assembly::subspace::RitzModes;
use crate::coupled::scheme::SchemeCoefficients;
use crate::linalg::{largest, row_products};

/// Rounding of a response, relative to the largest response.
const RESPONSE_ROUNDING_TOLERANCE: f64 = 1e-13;
/// Number of a compared step, divided by its distance from the next one.
const COMPARED_STEP_DIVISOR: usize = 8;
/// Smallest predicted ratio of the changes of two successive rounds.
const MIN_CHANGE_RATIO: f64 = 0.1;

/// Responses of all outputs (rows) to all forces, at some steps.
pub(crate) struct StepResponses {
    /// Displacements at each step: forces × outputs.
    displacements: Vec<f64>,
    /// Velocities in the same order.
    velocities: Vec<f64>,
    output_count: usize,
    /// Index of the first output that is an acceleration.
    first_acceleration: usize,
    /// Values of the probes at each step: loads × probes.
    probe_values: Vec<f64>,
    probe_count: usize,
}

impl StepResponses {
    /// Responses of `rows` over `step_count` steps to forces that grow over `growth_steps` steps.
    ///
    /// `modal_rows` has the modal weights of the rows. The forces grow by binomial weights.
    pub(crate) fn new(
        modes: &RitzModes,
        mut modal_rows: Vec<f64>,
        rows: &ResponseRows,
        c: &SchemeCoefficients,
        step_count: usize,
        growth_steps: usize,
    ) -> Self {
        let mode_count = modes.stiffness.len().max(1);
        let mut effective_stiffness = Vec::with_capacity(mode_count);
        for (k, d) in modes.stiffness.iter().zip(&modes.damping) {
            effective_stiffness.push(c.acceleration[0] + c.velocity[0] * d + c.displacement[0] * k);
        }
        let norms = normalise_rows(&mut modal_rows, &effective_stiffness);
        let compared_steps: Vec<usize> =
            std::iter::successors(Some(1), |step| Some(step + 1 + step / COMPARED_STEP_DIVISOR))
                .take_while(|step| *step <= step_count)
                .collect();
        let growth_weights = binomial_weights(growth_steps);
        let all_states =
            mode_states(modes, c, &effective_stiffness, &compared_steps, &growth_weights);
        let mut responses = Self {
            displacements: Vec::new(),
            velocities: Vec::new(),
            output_count: norms.len(),
            first_acceleration: rows.first_acceleration,
            probe_values: Vec::new(),
            probe_count: rows.probes.len(),
        };
        let mut scratch = vec![0.0; rows.force_count * mode_count];
        for states in all_states.chunks_exact(3 * mode_count) {
            let [u, v, a] = [0, 1, 2].map(|k| &states[k * mode_count..(k + 1) * mode_count]);
            let displacements = output_responses(&modal_rows, u, rows.force_count, &mut scratch);
            let velocities = output_responses(&modal_rows, v, rows.force_count, &mut scratch);
            if rows.load_count > 0 {
                let accelerations = output_responses(&modal_rows, a, rows.load_count, &mut scratch);
                let derivatives = [&displacements, &velocities, &accelerations];
                responses.add_probe_values(rows, derivatives, &norms);
            }
            responses.displacements.extend(displacements);
            responses.velocities.extend(velocities);
        }
        responses
    }

    /// Adds the values of all probes under each load, from responses of the normalised rows.
    fn add_probe_values(
        &mut self,
        rows: &ResponseRows,
        derivatives: [&Vec<f64>; 3],
        norms: &[f64],
    ) {
        for load in 0..rows.load_count {
            for probe in &rows.probes {
                let terms = probe.iter().zip(derivatives).filter_map(|(row, responses)| {
                    row.map(|row| responses[load * norms.len() + row] * norms[row])
                });
                self.probe_values.push(terms.sum::<f64>());
            }
        }
    }

    /// Weakest response: the smallest of the largest displacements of some outputs.
    ///
    /// The response is at most about 1, which is that of a row of unit energy norm to the force of the same row. The
    /// row of a section force has a large norm because of the stiffness at the section, and small responses to distant
    /// tractions. Directions that the modes do not contain cause errors relative to the norms. These errors are larger
    /// relative to a small response.
    pub(crate) fn weakest_response(&self, outputs: Range<usize>) -> f64 {
        let mut max_values = vec![0.0_f64; outputs.len()];
        for responses in self.displacements.chunks_exact(self.output_count.max(1)) {
            let pairs = max_values.iter_mut().zip(&responses[outputs.clone()]);
            pairs.for_each(|(max_value, value)| *max_value = max_value.max(value.abs()));
        }
        max_values.into_iter().filter(|value| *value > 0.0).fold(1.0, f64::min)
    }

    /// Largest difference of any output from `other`, relative to the largest value of this output.
    ///
    /// The result is not smaller than the rounding of a response.
    pub(crate) fn difference(&self, other: &Self, tolerance: f64) -> f64 {
        let Self { output_count, first_acceleration, .. } = *self;
        let rounding = RESPONSE_ROUNDING_TOLERANCE / tolerance;
        let compare = |values: [&[f64]; 2], output_count, outputs, min_scale| {
            largest_difference(values, output_count, outputs, min_scale, rounding)
        };
        let values = [&self.displacements[..], &other.displacements[..]];
        let scale = rounding * largest(&self.displacements);
        let displacements = compare(values, output_count, 0..first_acceleration, scale);
        let values = [&self.velocities[..], &other.velocities[..]];
        let scale = rounding * largest(&self.velocities);
        let accelerations = compare(values, output_count, first_acceleration..output_count, scale);
        // Probes have different units and therefore no common smallest scale.
        let values = [&self.probe_values[..], &other.probe_values[..]];
        let probes = compare(values, self.probe_count, 0..self.probe_count, 0.0);
        [displacements, accelerations, probes]
            .into_iter()
            .fold(RESPONSE_ROUNDING_TOLERANCE, f64::max)
    }
}

/// Changes of the responses from each round of a reduction to the next.
pub(super) struct ResponseChanges {
    /// Relative change in the last round; infinite before the second round.
    pub(super) last_change: f64,
    /// Ratio of the last two changes, at most 1; it predicts the next ratio.
    pub(super) change_ratio: f64,
}

impl ResponseChanges {
    /// No change so far.
    pub(super) fn none() -> Self {
        Self { last_change: f64::INFINITY, change_ratio: 1.0 }
    }

    /// Stores the change in another round.
    pub(super) fn push(&mut self, change: f64) {
        if self.last_change.is_finite() {
            self.change_ratio = (change / self.last_change).clamp(MIN_CHANGE_RATIO, 1.0);
        }
        self.last_change = change;
    }

    /// Predicted change in the next round, at the ratio of the last two changes.
    pub(super) fn next_change(&self) -> f64 {
        self.last_change * self.change_ratio
    }
}

/// Largest difference of any compared output, relative to the largest value of this output.
///
/// Two sets of responses have one output after the other for each force and step. An output's scale is at least `min_scale`.
fn largest_difference(
    [values, other_values]: [&[f64]; 2],
    output_count: usize,
    compared_outputs: Range<usize>,
    min_scale: f64,
    rounding: f64,
) -> f64 {
    let mut scales = vec![min_scale; compared_outputs.len()];
    let mut changes = vec![0.0_f64; compared_outputs.len()];
    let rows = values.chunks_exact(output_count.max(1));
    for (row, other_row) in rows.zip(other_values.chunks_exact(output_count.max(1))) {
        let pairs = row[compared_outputs.clone()].iter().zip(&other_row[compared_outputs.clone()]);
        for ((a, b), (scale, change)) in pairs.zip(scales.iter_mut().zip(&mut changes)) {
            *scale = scale.max(a.abs());
            // `max` ignores NaN.
            let difference = (a - b).abs();
            *change = if difference.is_finite() { change.max(difference) } else { f64::INFINITY };
        }
    }
    let mut max_difference = 0.0_f64;
    for (scale, change) in scales.into_iter().zip(changes) {
        if change.is_infinite() {
            return f64::INFINITY;
        }
        let relative_change = if change > 0.0 { change / (scale * rounding.max(1.0)) } else { 0.0 };
        max_difference = max_difference.max(relative_change);
    }
    max_difference
}

/// Responses of all outputs to the first rows as forces, from states of the modes.
fn output_responses(
    modal_rows: &[f64],
    states: &[f64],
    force_count: usize,
    scratch: &mut [f64],
) -> Vec<f64> {
    let mode_count = states.len();
    let weighted_rows = &mut scratch[..force_count * mode_count];
    let rows = modal_rows.chunks_exact(mode_count);
    for (row, weighted_row) in rows.zip(weighted_rows.chunks_exact_mut(mode_count)) {
        let terms = row.iter().zip(states).zip(weighted_row);
        terms.for_each(|((f, state), term)| *term = f * state);
    }
    row_products(weighted_rows, modal_rows, mode_count)
}

/// Binomial weights of a force that grows over `count` steps; their sum is 1.
fn binomial_weights(count: usize) -> Vec<f64> {
    let mut weight = 0.5_f64.powi(i32::try_from(count).unwrap_or(i32::MAX));
    let mut weights = vec![weight];
    for k in 0..count {
        let ratio = (count - k) as f64 / (k + 1) as f64;
        weight *= ratio;
        weights.push(weight);
    }
    weights
}

/// States u, v and a of each mode under a growing unit force: steps × 3 × modes.
fn mode_states(
    modes: &RitzModes,
    coefficients: &SchemeCoefficients,
    effective_stiffness: &[f64],
    compared_steps: &[usize],
    growth_weights: &[f64],
) -> Vec<f64> {
    let mode_count = effective_stiffness.len().max(1);
    let mut states = vec![0.0; compared_steps.len() * 3 * mode_count];
    for (j, (k, d)) in modes.stiffness.iter().zip(&modes.damping).enumerate() {
        // Every set of modes contains the rigid motions, which need no comparison.
        if *k == 0.0 {
            continue;
        }
        let step = ModeStep::new(coefficients, effective_stiffness[j], *d, *k);
        for (i, mut state) in step.states(compared_steps).enumerate() {
            let mut sums = [0.0; 3];
            for weight in growth_weights {
                sums.iter_mut().zip(state).for_each(|(sum, value)| *sum += weight * value);
                state = step.apply(state);
            }
            for (derivative, value) in sums.into_iter().enumerate() {
                states[(3 * i + derivative) * mode_count + j] = value;
            }
        }
    }
    states
}

/// A step of one mode under a unit force.
///
/// The rows are the new displacement, velocity and acceleration. The columns are the weights of the old displacement,
/// velocity and acceleration in them, and the response to the unit force.
#[derive(Clone, Copy)]
struct ModeStep([[f64; 4]; 3]);

impl ModeStep {
    /// Step of a mode with an effective stiffness, a damping and a stiffness.
    fn new(c: &SchemeCoefficients, effective_stiffness: f64, damping: f64, stiffness: f64) -> Self {
        let residual_weight =
            |i: usize| c.acceleration[i] + damping * c.velocity[i] + stiffness * c.displacement[i];
        let increment = [-stiffness, -residual_weight(1), -residual_weight(2), 1.0]
            .map(|term| term / effective_stiffness);
        let row = |[increment_factor, v, a]: [f64; 3]| {
            let direct = [0.0, v, a, 0.0];
            std::array::from_fn(|i| increment_factor * increment[i] + direct[i])
        };
        let mut displacement = increment;
        displacement[0] += 1.0;
        Self([displacement, row(c.new_velocity), row(c.new_acceleration)])
    }

    /// State after the step.
    fn apply(&self, state: [f64; 3]) -> [f64; 3] {
        self.0.map(|[u, v, a, one]| u * state[0] + v * state[1] + a * state[2] + one)
    }

    /// Combines two steps into one.
    fn doubled(&self) -> Self {
        Self(self.0.map(|row| {
            std::array::from_fn(|i| {
                let product: f64 = (0..3).map(|k| row[k] * self.0[k][i]).sum();
                product + if i == 3 { row[3] } else { 0.0 }
            })
        }))
    }

    /// States after numbers of steps from rest, by powers of two of the step.
    ///
    /// `step_numbers` ascend.
    fn states(self, step_numbers: &[usize]) -> impl Iterator<Item = [f64; 3]> {
        let mut powers = vec![self];
        let mut state = [0.0; 3];
        let mut current_step = 0;
        step_numbers.iter().map(move |step| {
            let mut remaining_steps = step - current_step;
            current_step = *step;
            for power in 0.. {
                if remaining_steps == 0 {
                    break;
                }
                if power == powers.len() {
                    powers.push(powers[power - 1].doubled());
                }
                if remaining_steps % 2 == 1 {
                    state = powers[power].apply(state);
                }
                remaining_steps /= 2;
            }
            state
        })
    }
}

/// Divides rows of modal forces by their energy norms, and returns the norms.
fn normalise_rows(modal_rows: &mut [f64], effective_stiffness: &[f64]) -> Vec<f64> {
    let mode_count = effective_stiffness.len().max(1);
    let mut norms = Vec::with_capacity(modal_rows.len() / mode_count);
    for row in modal_rows.chunks_exact_mut(mode_count) {
        let energy: f64 = row.iter().zip(effective_stiffness).map(|(f, k)| f * f / k).sum();
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
        let constant = |value: f64| StepResponses {
            displacements: vec![value; 2],
            velocities: Vec::new(),
            output_count: 1,
            first_acceleration: 1,
            probe_values: Vec::new(),
            probe_count: 0,
        };
        for value in [f64::INFINITY, f64::NAN] {
            assert_eq!(constant(value).difference(&constant(value), 1e-6), f64::INFINITY);
        }
        assert_eq!(constant(1.0).difference(&constant(1.0), 1e-6), RESPONSE_ROUNDING_TOLERANCE);
        assert!((constant(1.0).difference(&constant(2.0), 1e-6) - 1.0).abs() < 1e-12);
    }

    /// REFERENCE: single steps.
    #[test]
    fn powers_of_a_step_are_many_steps() {
        let c = Newmark::new(0.6, 0.3025).unwrap().coefficients(0.01);
        let damping = 1.0;
        let stiffness = 4.0e3;
        let effective = c.acceleration[0] + c.velocity[0] * damping + c.displacement[0] * stiffness;
        let steps = [1, 2, 3, 5, 8, 13, 100, 1000];
        let mut states = ModeStep::new(&c, effective, damping, stiffness).states(&steps);
        let apply = SchemeCoefficients::apply;
        let mut u = 0.0;
        let mut v = 0.0;
        let mut a = 0.0;
        for step in 1..=1000 {
            let residual = apply(c.acceleration, 0.0, v, a)
                + damping * apply(c.velocity, 0.0, v, a)
                + stiffness * (u + apply(c.displacement, 0.0, v, a));
            let increment = (1.0 - residual) / effective;
            let velocity = apply(c.new_velocity, increment, v, a);
            a = apply(c.new_acceleration, increment, v, a);
            (u, v) = (u + increment, velocity);
            if steps.contains(&step) {
                for (derivative, (value, expected)) in
                    states.next().unwrap().into_iter().zip([u, v, a]).enumerate()
                {
                    let scale = [1.0 / stiffness, 1.0 / f64::sqrt(stiffness), 1.0][derivative];
                    let difference = f64::abs(value - expected);
                    assert!(difference < 1e-12 * scale, "step {step}: {value} for {expected}");
                }
            }
        }
        assert!(states.next().is_none());
    }
}
