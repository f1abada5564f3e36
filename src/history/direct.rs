//! History by direct summation: exact, O(N) per step.

use std::sync::Arc;

use super::convolution::{ConvolutionHistory, check_inputs};
use super::convolution_weights::ConvolutionWeights;
use crate::error::{Error, MemoryError, Observer, Result, memory_limit, same_length, unobserved};
use crate::linalg::dot;

/// Number of steps summed for one pair before the next pair, so that tractions and coefficients stay in cache.
const STEPS_PER_CHUNK: usize = 512;

/// Smallest number of lags for which coefficients are stored, so that the first steps do not enlarge the tables.
const MIN_CAPACITY_LAGS: usize = 64;

/// Direct summation of the history: the reference for all other methods.
///
/// Coefficients are stored per pair *class* (on a uniform patch, per offset), reversed in time, so that each
/// contribution is one contiguous dot product.
pub struct DirectHistory {
    kernel: Arc<dyn ConvolutionWeights>,
    /// Lags for which coefficients are stored; grows by doubling.
    capacity: usize,
    /// Coefficients of each kind, class by class, reversed: lag n is the n-th from the end.
    ///
    /// The coupling is stored only while it is not zero.
    coefficients: Vec<Vec<Vec<f64>>>,
    /// Tractions of all steps, for each contact component.
    tractions: Vec<Vec<f64>>,
    /// Number of inputs so far.
    steps: usize,
    /// Memory allowed, bytes.
    memory_limit: f64,
}

short_debug! {
    DirectHistory; self; elements: self.kernel.classes().elements().len(), steps: self.steps
}

impl DirectHistory {
    /// Creates a history of `kernel` without inputs.
    pub fn new(kernel: Arc<dyn ConvolutionWeights>) -> Self {
        let classes = kernel.classes();
        let coefficients = vec![vec![Vec::new(); classes.count()]; classes.kinds()];
        let tractions = vec![Vec::new(); classes.layout().len()];
        let memory_limit = memory_limit() as f64;
        Self { kernel, capacity: 0, coefficients, tractions, steps: 0, memory_limit }
    }

    /// Limits the memory to `bytes`; steps that need more return [`Error::Memory`].
    pub(super) fn within_memory(mut self, bytes: usize) -> Self {
        self.memory_limit = self.memory_limit.min(bytes as f64);
        self
    }

    /// Stores the coefficients of the lags up to `lags`.
    fn grow(&mut self, lags: usize, observer: &mut Observer<'_>) -> Result<()> {
        let old_capacity = self.capacity;
        let capacity = lags.max(2 * self.capacity).max(MIN_CAPACITY_LAGS);
        let series_count =
            self.coefficients.len() * self.kernel.classes().count() + self.tractions.len();
        let needed_bytes = 8.0 * series_count as f64 * capacity as f64;
        if needed_bytes > self.memory_limit {
            return Err(Error::Memory(MemoryError {
                quantity: "steps of the convolution history",
                asked: lags as f64,
                needed: needed_bytes,
                limit: self.memory_limit,
                remedy: "take fewer steps, or allow more with `HistoryOptions::memory`: a run can continue there from a checkpoint",
            }));
        }
        let diagonal_kinds = self.kernel.classes().layout().components();
        let mut new_lags = vec![vec![0.0; capacity - old_capacity]; self.coefficients.len()];
        self.kernel.prepare(capacity, observer)?;
        for class in 0..self.kernel.classes().count() {
            let last_lag = self.kernel.last_coupling_lag(class)?;
            let coupling_end = last_lag.unwrap_or(capacity).min(capacity);
            let mut values: Vec<_> = new_lags.iter_mut().map(Vec::as_mut_slice).collect();
            self.kernel.coefficients(class, old_capacity + 1, &mut values)?;
            for (kind, (stored, lags)) in self.coefficients.iter_mut().zip(&new_lags).enumerate() {
                if kind < diagonal_kinds {
                    prepend_reversed(&mut stored[class], lags);
                } else if coupling_end > stored[class].len() {
                    let coupled_lags = coupling_end - old_capacity.min(coupling_end);
                    prepend_reversed(&mut stored[class], &lags[..coupled_lags]);
                }
            }
        }
        self.capacity = capacity;
        Ok(())
    }
}

/// Inserts `later_lags`, reversed, in front of the lags in `stored`, which they follow.
fn prepend_reversed(stored: &mut Vec<f64>, later_lags: &[f64]) {
    let mut reversed_lags = Vec::with_capacity(stored.len() + later_lags.len());
    reversed_lags.extend(later_lags.iter().rev());
    reversed_lags.extend_from_slice(stored);
    *stored = reversed_lags;
}

impl ConvolutionHistory for DirectHistory {
    fn steps(&self) -> usize {
        self.steps
    }

    fn memory(&self) -> usize {
        let coefficient_count: usize = self.coefficients.iter().flatten().map(Vec::capacity).sum();
        let traction_count: usize = self.tractions.iter().map(Vec::capacity).sum();
        (coefficient_count + traction_count) * size_of::<f64>()
    }

    fn prepare(&mut self, steps: usize, observer: &mut Observer<'_>) -> Result<()> {
        if steps > self.capacity {
            self.grow(steps, observer)?;
        }
        for component in &mut self.tractions {
            component.reserve(steps.saturating_sub(component.len()));
        }
        Ok(())
    }

    fn evaluate(&mut self, displacement: &mut [f64]) -> Result<()> {
        let classes = self.kernel.classes();
        let layout = classes.layout();
        same_length("displacement of the history", displacement.len(), layout.len())?;
        displacement.fill(0.0);
        let past_steps = self.steps;
        if past_steps == 0 {
            return Ok(());
        }
        if past_steps + 1 > self.capacity {
            self.grow(past_steps + 1, &mut unobserved)?;
        }
        // Input m (from 0) acts with lag past_steps + 1 − m.
        for chunk_start in (0..past_steps).step_by(STEPS_PER_CHUNK) {
            let chunk_end = (chunk_start + STEPS_PER_CHUNK).min(past_steps);
            self.kernel.classes().each(|[receiver, source], pair, terms| {
                for term in terms {
                    let factor = term.factor * pair.scale;
                    let lags = &self.coefficients[term.kind][pair.class];
                    let first_step = (past_steps + 1).saturating_sub(lags.len()).max(chunk_start);
                    if first_step < chunk_end && factor != 0.0 {
                        let lag_range = lags.len() - (past_steps + 1 - first_step)
                            ..lags.len() - (past_steps + 1 - chunk_end);
                        let tractions =
                            &self.tractions[layout.index_of(term.components[1], source)];
                        displacement[layout.index_of(term.components[0], receiver)] +=
                            factor * dot(&lags[lag_range], &tractions[first_step..chunk_end]);
                    }
                }
            });
        }
        Ok(())
    }

    fn push(&mut self, traction: &[f64]) {
        for (i, stored) in self.tractions.iter_mut().enumerate() {
            stored.push(traction.get(i).copied().unwrap_or(0.0));
        }
        self.steps += 1;
    }

    /// Returns all tractions, step by step.
    fn save(&self) -> Result<Vec<f64>> {
        Ok((0..self.steps).flat_map(|m| self.tractions.iter().map(move |row| row[m])).collect())
    }

    fn restore(&mut self, steps: usize, values: &[f64]) -> Result<()> {
        let component_count = self.tractions.len();
        check_inputs(steps, component_count, values)?;
        for row in &mut self.tractions {
            row.clear();
        }
        self.steps = 0;
        values.chunks_exact(component_count).for_each(|traction| self.push(traction));
        Ok(())
    }
}
