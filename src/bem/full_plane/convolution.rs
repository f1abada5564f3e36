//! What all past displacements and tractions of a boundary give at the end of the next step.

use super::BoundaryKernel;
use super::pairs::PairClasses;
use crate::error::{Result, same_length};
use crate::linalg::dot;

/// Steps of the sum that are taken together, so that inputs and coefficients stay in cache.
const CHUNK: usize = 512;

/// A series of coefficients between one input and one output.
#[derive(Debug, Clone, Copy)]
struct Link {
    output: usize,
    input: usize,
    series: usize,
    sign: f64,
}

/// Σ_{m<N} G^{N−m} t^m − H^{N−m} u^m, coefficients once per class of pairs.
///
/// Inputs are 4E numbers per step: u, then t.
pub(super) struct BoundaryHistory {
    kernel: Box<dyn BoundaryKernel>,
    pairs: PairClasses,
    /// Which tractions may differ from zero, 2E.
    loaded: Vec<bool>,
    /// Lags for which coefficients are stored.
    capacity: usize,
    /// Per class, matrix and component: the coefficient of lag n at `capacity − n`; empty if zero.
    series: Vec<Vec<f64>>,
    links: Vec<Link>,
    inputs: Vec<Vec<f64>>,
    steps: usize,
}

impl BoundaryHistory {
    pub(super) fn new(kernel: Box<dyn BoundaryKernel>, loaded: Vec<bool>) -> Self {
        let pairs = PairClasses::new(kernel.segments());
        let count = kernel.segments().len();
        Self {
            series: vec![Vec::new(); 8 * pairs.classes.len()],
            pairs,
            kernel,
            loaded,
            capacity: 0,
            links: Vec::new(),
            inputs: vec![Vec::new(); 4 * count],
            steps: 0,
        }
    }

    /// Makes lags up to `lags` available.
    fn grow(&mut self, lags: usize) -> Result<()> {
        if lags <= self.capacity {
            return Ok(());
        }
        let (old, new) = (self.capacity, lags.max(2 * self.capacity).max(64));
        let count = self.kernel.segments().len();
        let size = 2 * count;
        let (mut g, mut h) = (vec![0.0; size * size], vec![0.0; size * size]);
        let mut grown = vec![vec![0.0; new]; self.series.len()];
        for lag in old + 1..=new {
            self.kernel.coefficients(lag, &mut g, &mut h)?;
            for (class, &(p, q)) in self.pairs.classes.iter().enumerate() {
                for (k, matrix) in [&g, &h].into_iter().enumerate() {
                    for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                        grown[8 * class + 4 * k + 2 * i + j][new - lag] =
                            matrix[(i * count + p) * size + j * count + q];
                    }
                }
            }
        }
        for (grown, stored) in grown.iter_mut().zip(&mut self.series) {
            if stored.is_empty() {
                if grown.iter().all(|value| *value == 0.0) {
                    continue;
                }
            } else {
                grown[new - old..].copy_from_slice(stored);
            }
            *stored = std::mem::take(grown);
        }
        self.capacity = new;
        self.link();
        Ok(())
    }

    fn link(&mut self) {
        let count = self.kernel.segments().len();
        self.links.clear();
        for (p, pairs) in self.pairs.pairs.chunks_exact(count).enumerate() {
            for (i, j, k) in [
                (0, 0, 0),
                (0, 0, 1),
                (0, 1, 0),
                (0, 1, 1),
                (1, 0, 0),
                (1, 0, 1),
                (1, 1, 0),
                (1, 1, 1),
            ] {
                for (q, &(class, mirrored)) in pairs.iter().enumerate() {
                    let series = 8 * class + 4 * k + 2 * i + j;
                    let channel = j * count + q;
                    if self.series[series].is_empty() || (k == 0 && !self.loaded[channel]) {
                        continue;
                    }
                    let sign = if mirrored && i != j { -1.0 } else { 1.0 };
                    let (input, sign) =
                        if k == 0 { (2 * count + channel, sign) } else { (channel, -sign) };
                    self.links.push(Link { output: i * count + p, input, series, sign });
                }
            }
        }
    }

    pub(super) fn reserve(&mut self, steps: usize) -> Result<()> {
        self.grow(steps)?;
        for input in &mut self.inputs {
            input.reserve(steps.saturating_sub(input.len()));
        }
        Ok(())
    }

    /// Overwrites `output` (2E).
    pub(super) fn evaluate(&mut self, output: &mut [f64]) -> Result<()> {
        same_length("history of the boundary", output.len(), self.inputs.len() / 2)?;
        output.fill(0.0);
        let past = self.steps;
        self.grow(past)?;
        // Input m (from 0) is seen with lag past − m.
        for begin in (0..past).step_by(CHUNK) {
            let end = (begin + CHUNK).min(past);
            let lags = self.capacity - (past - begin)..self.capacity - (past - end);
            for link in &self.links {
                let sum = dot(
                    &self.series[link.series][lags.clone()],
                    &self.inputs[link.input][begin..end],
                );
                output[link.output] += link.sign * sum;
            }
        }
        Ok(())
    }

    /// Accepts the displacements and tractions (2E each) at the end of the step.
    pub(super) fn push(&mut self, displacement: &[f64], traction: &[f64]) {
        let values = displacement.iter().chain(traction);
        for (input, value) in self.inputs.iter_mut().zip(values) {
            input.push(*value);
        }
        self.steps += 1;
    }

    /// Steps accepted.
    pub(super) fn steps(&self) -> usize {
        self.steps
    }
}
