//! The history as the sum that it is: exact, O(N) per step.

use std::sync::Arc;

use super::convolution::{ConvolutionHistory, ExactHistory, check_inputs};
use super::lag_kernel::LagKernel;
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
    kernel: Arc<dyn LagKernel>,
    /// Lags for which coefficients are stored; grows by doubling.
    capacity: usize,
    /// Per class: the coefficient of lag n at `capacity − n`.
    normal: Vec<Vec<f64>>,
    tangential: Vec<Vec<f64>>,
    coupling: Vec<Vec<f64>>,
    /// Per contact component: its value at every step.
    traction: Vec<Vec<f64>>,
    steps: usize,
}

short_debug! {
    DirectHistory; self; elements: self.kernel.classes().elements().len(), steps: self.steps
}

impl DirectHistory {
    /// History of `kernel`, empty.
    pub fn new(kernel: Arc<dyn LagKernel>) -> Self {
        let classes = kernel.classes();
        let (classes, components) = (classes.count(), 2 * classes.elements().len());
        Self {
            kernel,
            capacity: 0,
            normal: vec![Vec::new(); classes],
            tangential: vec![Vec::new(); classes],
            coupling: vec![Vec::new(); classes],
            traction: vec![Vec::new(); components],
            steps: 0,
        }
    }

    /// Makes lags up to `lags` available.
    fn grow(&mut self, lags: usize) -> Result<()> {
        let (old, new) = (self.capacity, lags.max(2 * self.capacity).max(64));
        let (mut zz, mut xx, mut zx) = (vec![0.0; new - old], vec![0.0; new - old], vec![]);
        self.kernel.prepare(new)?;
        for class in 0..self.kernel.classes().count() {
            let last = self.kernel.last_coupling_lag(class)?.unwrap_or(new).min(new);
            zx.clear();
            zx.resize(new - old, 0.0);
            self.kernel.coefficients(class, old + 1, &mut zz, &mut xx, &mut zx)?;
            prepend_reversed(&mut self.normal[class], &zz);
            prepend_reversed(&mut self.tangential[class], &xx);
            // Only as long as it is not zero.
            if last > self.coupling[class].len() {
                let kept = last - old.min(last);
                prepend_reversed(&mut self.coupling[class], &zx[..kept]);
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
        let count = self.kernel.classes().elements().len();
        same_length("displacement of the history", displacement.len(), 2 * count)?;
        displacement.fill(0.0);
        let past = self.steps;
        if past == 0 {
            return Ok(());
        }
        if past + 1 > self.capacity {
            self.grow(past + 1)?;
        }
        let (down, along) = displacement.split_at_mut(count);
        // Input m (from 0) is seen with lag past + 1 − m.
        for begin in (0..past).step_by(CHUNK) {
            let end = (begin + CHUNK).min(past);
            let range = |stored: usize, begin: usize| {
                stored - (past + 1 - begin)..stored - (past + 1 - end)
            };
            for (p, pairs) in self.kernel.classes().pairs().chunks_exact(count).enumerate() {
                for (q, pair) in pairs.iter().enumerate() {
                    let pressure = &self.traction[q];
                    let shear = &self.traction[count + q];
                    let lags = range(self.capacity, begin);
                    let zz = dot(&self.normal[pair.class][lags.clone()], &pressure[begin..end]);
                    let xx = dot(&self.tangential[pair.class][lags], &shear[begin..end]);
                    down[p] += pair.scale * zz;
                    along[p] += pair.scale * xx;
                    let coupling = &self.coupling[pair.class];
                    let first = (past + 1).saturating_sub(coupling.len()).max(begin);
                    if first < end && pair.sign != 0.0 {
                        let lags = range(coupling.len(), first);
                        let zx = dot(&coupling[lags.clone()], &shear[first..end]);
                        let xz = dot(&coupling[lags], &pressure[first..end]);
                        down[p] += pair.sign * pair.scale * zx;
                        along[p] -= pair.sign * pair.scale * xz;
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
