//! The history as the sum that it is: exact, O(N) per step.

use std::sync::Arc;

use super::convolution::{ConvolutionHistory, ExactHistory, check_inputs};
use super::convolution_weights::ConvolutionWeights;
use super::pair_classes::{ACTIONS, KINDS};
use crate::error::{Result, same_length};
use crate::linalg::dot;

/// Steps of the sum that are taken together, so that tractions and kernels stay in cache.
const CHUNK: usize = 512;

/// Steps ahead that a hint prepares for, at most; beyond, memory grows as it goes.
const RESERVED_STEPS: usize = 100_000;

/// Direct summation of the history: the oracle for all others.
///
/// Kernels are kept per pair *class* (on a uniform patch, per offset), reversed in time, so that
/// each contribution is one contiguous dot product.
pub struct DirectHistory {
    kernel: Arc<dyn ConvolutionWeights>,
    /// Lags for which coefficients are stored; grows by doubling.
    capacity: usize,
    /// Of each kind, class by class: the coefficient of lag n at the length less n. The coupling only
    /// as long as it is not zero.
    kinds: [Vec<Vec<f64>>; KINDS],
    /// Per contact component: its value at every step.
    traction: Vec<Vec<f64>>,
    steps: usize,
}

short_debug! {
    DirectHistory; self; elements: self.kernel.classes().elements().len(), steps: self.steps
}

impl DirectHistory {
    /// History of `kernel`, empty.
    pub fn new(kernel: Arc<dyn ConvolutionWeights>) -> Self {
        let classes = kernel.classes();
        let kinds = [(); KINDS].map(|()| vec![Vec::new(); classes.count()]);
        let traction = vec![Vec::new(); classes.layout().len()];
        Self { kernel, capacity: 0, kinds, traction, steps: 0 }
    }

    /// Makes lags up to `lags` available.
    fn grow(&mut self, lags: usize) -> Result<()> {
        let (old, new) = (self.capacity, lags.max(2 * self.capacity).max(64));
        let mut lags = [(); KINDS].map(|()| vec![0.0; new - old]);
        self.kernel.prepare(new)?;
        for class in 0..self.kernel.classes().count() {
            let last = self.kernel.last_coupling_lag(class)?.unwrap_or(new).min(new);
            let values = lags.each_mut().map(Vec::as_mut_slice);
            self.kernel.coefficients(class, old + 1, values)?;
            let [normal, tangential, coupling] = &mut self.kinds;
            let [zz, xx, zx] = &lags;
            prepend_reversed(&mut normal[class], zz);
            prepend_reversed(&mut tangential[class], xx);
            if last > coupling[class].len() {
                let kept = last - old.min(last);
                prepend_reversed(&mut coupling[class], &zx[..kept]);
            }
        }
        self.capacity = new;
        Ok(())
    }
}

/// Puts `next` (lags following those stored) in front of `stored`, reversed.
fn prepend_reversed(stored: &mut Vec<f64>, next: &[f64]) {
    let mut grown = Vec::with_capacity(stored.len() + next.len());
    grown.extend(next.iter().rev());
    grown.extend_from_slice(stored);
    *stored = grown;
}

impl ConvolutionHistory for DirectHistory {
    fn steps(&self) -> usize {
        self.steps
    }

    /// Prepares for 100 000 further steps at most: a larger hint may stand for a run without end.
    fn reserve(&mut self, steps: usize) -> Result<()> {
        let steps = steps.min(self.steps.saturating_add(RESERVED_STEPS));
        if steps >= self.capacity {
            self.grow(steps.saturating_add(1))?;
        }
        for component in &mut self.traction {
            component.reserve(steps.saturating_sub(component.len()));
        }
        Ok(())
    }

    fn evaluate(&mut self, displacement: &mut [f64]) -> Result<()> {
        let classes = self.kernel.classes();
        let (layout, count) = (classes.layout(), classes.elements().len());
        same_length("displacement of the history", displacement.len(), layout.len())?;
        displacement.fill(0.0);
        let past = self.steps;
        if past == 0 {
            return Ok(());
        }
        if past + 1 > self.capacity {
            self.grow(past + 1)?;
        }
        // Input m (from 0) is seen with lag past + 1 − m.
        for begin in (0..past).step_by(CHUNK) {
            let end = (begin + CHUNK).min(past);
            for (place, pair) in self.kernel.classes().pairs().iter().enumerate() {
                for action in &ACTIONS {
                    let factor = pair.factor(action) * pair.scale;
                    let lags = &self.kinds[action.kind][pair.class];
                    let first = (past + 1).saturating_sub(lags.len()).max(begin);
                    if first < end && factor != 0.0 {
                        let seen = lags.len() - (past + 1 - first)..lags.len() - (past + 1 - end);
                        let traction = &self.traction[layout.place(action.traction, place % count)];
                        displacement[layout.place(action.displacement, place / count)] +=
                            factor * dot(&lags[seen], &traction[first..end]);
                    }
                }
            }
        }
        Ok(())
    }

    fn push(&mut self, traction: &[f64]) {
        for (i, stored) in self.traction.iter_mut().enumerate() {
            stored.push(traction.get(i).copied().unwrap_or(0.0));
        }
        self.steps += 1;
    }

    /// All tractions, step by step.
    fn save(&self) -> Result<Vec<f64>> {
        Ok((0..self.steps).flat_map(|m| self.traction.iter().map(move |row| row[m])).collect())
    }

    fn restore(&mut self, steps: usize, values: &[f64]) -> Result<()> {
        let size = self.traction.len();
        check_inputs(steps, size, values)?;
        for row in &mut self.traction {
            row.clear();
        }
        self.steps = 0;
        values.chunks_exact(size).for_each(|traction| self.push(traction));
        Ok(())
    }
}

impl ExactHistory for DirectHistory {
    fn traction(&mut self, step: usize, traction: &mut [f64]) {
        for (value, component) in traction.iter_mut().zip(&self.traction) {
            *value = component[step];
        }
    }
}
