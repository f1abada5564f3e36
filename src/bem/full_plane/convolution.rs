//! Effect of all past displacements and tractions of a boundary at the end of the next step.
//!
//! Relaxed blocked convolution, exact to rounding (Hairer, Lubich & Schlichte 1985, SIAM J. Sci. Stat.
//! Comput. 6, 532–541), as in [`crate::history::RelaxedFftHistory`]. Pairs of input and output within a leaf
//! of 64 steps are summed directly. After i steps, i a multiple of 64, let b be the largest number of the form
//! 64 · 2ᵏ that divides i. The effect of the last b inputs on the next b outputs is one convolution of length 2b,
//! computed by transforms.

use super::BoundaryKernel;
use super::block::{BlockTransform, SeriesLink, TransformBuffers};
use super::pair_classes::SegmentPairClasses;
use crate::error::{Result, same_length};
use crate::geometry::{COMPONENTS_IN_PLANE, ContactLayout};
use basemat_fourier::RealPlanner;

/// Number of steps that are summed directly, before the smallest block is transformed.
const DIRECT_STEPS: usize = 64;

/// Largest number of steps for which [`BoundaryHistory::prepare`] allocates memory; for more steps memory grows later.
const MAX_PREALLOCATED_STEPS: usize = 1 << 17;
/// Largest memory that [`BoundaryHistory::prepare`] allocates, bytes.
const MAX_PREALLOCATED_BYTES: usize = 1 << 30;
/// Bytes for a class of pairs and a step: eight series, with their values and spectra.
const BYTES_PER_CLASS: usize = 192;
/// Bytes for a component and a step: two inputs and an output.
const BYTES_PER_COMPONENT: usize = 24;
/// Number of series of a class: two matrices with four components each.
const SERIES_PER_CLASS: usize = 8;

/// History of a boundary: Σ_{m<N} G^{N−m} t^m − H^{N−m} u^m at step N.
///
/// Coefficients are stored once per class of pairs. Inputs are 4E numbers per step: u, then t.
pub(super) struct BoundaryHistory {
    pub(super) kernel: Box<dyn BoundaryKernel>,
    pairs: SegmentPairClasses,
    /// All pairs of an input and an output, with their series.
    links: Vec<SeriesLink>,
    /// For each class, matrix and component: coefficients of the lags below [`DIRECT_STEPS`]; empty if zero.
    direct_series: Vec<Vec<f64>>,
    /// Transforms of blocks, each twice as long as the one before.
    transforms: Vec<BlockTransform>,
    planner: RealPlanner,
    buffers: TransformBuffers,
    /// 4E rows of `capacity`.
    inputs: Vec<f64>,
    /// 2E rows of `capacity`: outputs, with the contributions of the earlier inputs.
    outputs: Vec<f64>,
    /// Number of steps for which rows and transforms are allocated: the leaf times a power of two.
    capacity: usize,
    /// Number of accepted steps.
    steps: usize,
    /// Whether the outputs do not contain the contribution of the last input.
    has_pending_input: bool,
}

impl BoundaryHistory {
    /// Creates a history without inputs; `loaded` marks the tractions (2E) that may differ from zero.
    pub(super) fn new(kernel: Box<dyn BoundaryKernel>, loaded: &[bool]) -> Self {
        let pairs = SegmentPairClasses::new(kernel.segments());
        Self {
            links: links(&pairs, kernel.segments().len(), loaded),
            direct_series: Vec::new(),
            pairs,
            kernel,
            transforms: Vec::new(),
            planner: RealPlanner::new(),
            buffers: TransformBuffers::default(),
            inputs: Vec::new(),
            outputs: Vec::new(),
            capacity: 0,
            steps: 0,
            has_pending_input: false,
        }
    }

    /// Number of components 2E.
    fn component_count(&self) -> usize {
        ContactLayout::new(COMPONENTS_IN_PLANE, self.kernel.segments().len()).len()
    }

    /// Coefficients of all series for the lags below `lag_count`, except lag 0.
    ///
    /// Lag 0 belongs to the present step.
    fn series(&self, lag_count: usize) -> Result<Vec<Vec<f64>>> {
        let order = self.component_count();
        let segment_count = order / 2;
        let mut g = vec![0.0; order * order];
        let mut h = vec![0.0; order * order];
        let mut series = vec![Vec::new(); SERIES_PER_CLASS * self.pairs.classes.len()];
        for lag in 1..lag_count {
            self.kernel.coefficients(lag, &mut g, &mut h)?;
            for (class, &(p, q)) in self.pairs.classes.iter().enumerate() {
                for (k, matrix) in [&g, &h].into_iter().enumerate() {
                    for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                        let row = i * segment_count + p;
                        let value = matrix[row * order + j * segment_count + q];
                        let coefficients = &mut series[series_index(class, k, i, j)];
                        // Many series are zero at all lags, on flat boundaries half of them.
                        if value != 0.0 || !coefficients.is_empty() {
                            coefficients.resize(lag, 0.0);
                            coefficients.push(value);
                        }
                    }
                }
            }
        }
        for coefficients in series.iter_mut().filter(|series| !series.is_empty()) {
            coefficients.resize(lag_count, 0.0);
        }
        Ok(series)
    }

    /// Extends rows and transforms to `steps` steps; the history is unchanged on an error.
    fn grow(&mut self, steps: usize) -> Result<()> {
        if steps <= self.capacity {
            return Ok(());
        }
        let capacity = steps.div_ceil(DIRECT_STEPS).next_power_of_two() * DIRECT_STEPS;
        let series = self.series(capacity)?;
        if self.direct_series.is_empty() {
            for coefficients in &series {
                let direct_count = DIRECT_STEPS.min(coefficients.len());
                self.direct_series.push(coefficients[..direct_count].to_vec());
            }
        }
        let mut block_size = DIRECT_STEPS << self.transforms.len();
        while block_size < capacity {
            let transform =
                BlockTransform::new(block_size, &series, &mut self.planner, &mut self.buffers);
            self.transforms.push(transform);
            block_size *= 2;
        }
        if let Some(transform) = self.transforms.last() {
            self.buffers.grow(transform, 2 * self.component_count());
        }
        let output_count = self.component_count();
        self.inputs = with_longer_rows(&self.inputs, self.capacity, capacity, 2 * output_count);
        self.outputs = with_longer_rows(&self.outputs, self.capacity, capacity, output_count);
        self.capacity = capacity;
        Ok(())
    }

    /// Allocates for `steps` further steps, up to 131 072 steps and 1 GiB.
    ///
    /// The number is limited because a very large number may stand for a run of unknown length.
    pub(super) fn prepare(&mut self, steps: usize) -> Result<()> {
        let bytes_per_step = BYTES_PER_CLASS * self.pairs.classes.len()
            + BYTES_PER_COMPONENT * self.component_count();
        let memory_steps = MAX_PREALLOCATED_BYTES / bytes_per_step.max(1);
        let max_steps = MAX_PREALLOCATED_STEPS.min(memory_steps);
        self.grow(self.steps.saturating_add(steps.min(max_steps)))
    }

    /// Adds the contribution of the last input, so that the next output is complete.
    fn add_last_input(&mut self) {
        let step = self.steps;
        let stride = self.capacity;
        let last_step = step - 1;
        let remaining_steps = DIRECT_STEPS - 1 - last_step % DIRECT_STEPS;
        if remaining_steps > 0 {
            for link in &self.links {
                let series = &self.direct_series[link.series_index];
                let value = link.sign * self.inputs[link.input_row * stride + last_step];
                if series.is_empty() || value == 0.0 {
                    continue;
                }
                let first_output = link.output_row * stride + step;
                let row = &mut self.outputs[first_output..][..remaining_steps];
                for (output, coefficient) in row.iter_mut().zip(&series[1..]) {
                    *output += coefficient * value;
                }
            }
        } else {
            let block_level = (step / DIRECT_STEPS).trailing_zeros() as usize;
            if let Some(transform) = self.transforms.get(block_level) {
                transform.apply(
                    &self.links,
                    &self.inputs,
                    &mut self.outputs,
                    stride,
                    step,
                    &mut self.buffers,
                );
            }
        }
        self.has_pending_input = false;
    }

    /// Overwrites `output` (2E) with the history at the end of the next step.
    pub(super) fn evaluate(&mut self, output: &mut [f64]) -> Result<()> {
        same_length("history of the boundary", output.len(), self.component_count())?;
        self.grow(self.steps + 1)?;
        if self.has_pending_input {
            self.add_last_input();
        }
        for (value, row) in output.iter_mut().zip(self.outputs.chunks_exact(self.capacity)) {
            *value = row[self.steps];
        }
        Ok(())
    }

    /// Accepts the displacements and tractions (2E each) at the end of the step.
    ///
    /// Call this once after each evaluation.
    pub(super) fn push(&mut self, displacement: &[f64], traction: &[f64]) {
        let values = displacement.iter().chain(traction);
        for (row, value) in self.inputs.chunks_exact_mut(self.capacity.max(1)).zip(values) {
            row[self.steps] = *value;
        }
        self.steps += 1;
        self.has_pending_input = true;
    }

    /// Number of accepted steps.
    pub(super) fn steps(&self) -> usize {
        self.steps
    }
}

/// Copies `row_count` rows of `old_length` to rows of `new_length`, padded by zeros.
fn with_longer_rows(
    old_rows: &[f64],
    old_length: usize,
    new_length: usize,
    row_count: usize,
) -> Vec<f64> {
    let mut new_rows = vec![0.0; row_count * new_length];
    let old_chunks = old_rows.chunks_exact(old_length.max(1));
    for (new_row, old_row) in new_rows.chunks_exact_mut(new_length).zip(old_chunks) {
        new_row[..old_length].copy_from_slice(old_row);
    }
    new_rows
}

/// Index of the series of a class and a pair of components.
///
/// `matrix`: 0 for G, 1 for H. `i`: component of the output. `j`: component of the input.
fn series_index(class: usize, matrix: usize, i: usize, j: usize) -> usize {
    SERIES_PER_CLASS * class + 4 * matrix + 2 * i + j
}

/// Links of all pairs of components: G with tractions and −H with displacements.
fn links(pairs: &SegmentPairClasses, segment_count: usize, loaded: &[bool]) -> Vec<SeriesLink> {
    let layout = ContactLayout::new(COMPONENTS_IN_PLANE, segment_count);
    let mut links = Vec::new();
    for (p, receiver_pairs) in pairs.pairs.chunks_exact(segment_count).enumerate() {
        for i in 0..2 {
            for (k, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                for (q, &(class, is_mirrored)) in receiver_pairs.iter().enumerate() {
                    let source_row = layout.index_of(j, q);
                    if k == 0 && !loaded[source_row] {
                        continue;
                    }
                    let mut sign = if is_mirrored && i != j { -1.0 } else { 1.0 };
                    let mut input_row = layout.len() + source_row;
                    if k == 1 {
                        sign = -sign;
                        input_row = source_row;
                    }
                    let series_index = series_index(class, k, i, j);
                    let output_row = layout.index_of(i, p);
                    links.push(SeriesLink { output_row, input_row, series_index, sign });
                }
            }
        }
    }
    links
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Soil;
    use crate::bem::full_plane::{Segment, TimeKernel};

    /// Transforms of several block sizes, without preallocation, against the direct sum.
    #[test]
    fn blocks_equal_the_direct_sum() {
        let soil = Soil::new(1.0, 0.3, 1.0).unwrap();
        let nodes = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.5, 0.8], [3.5, 0.8]];
        let segments: Vec<Segment> =
            nodes.windows(2).map(|n| Segment { from: n[0], to: n[1] }).collect();
        let kernel = TimeKernel::new(soil, &segments, 0.4).unwrap();
        let loaded = [true, true, false, true, true, true, true, true];
        let mut history = BoundaryHistory::new(Box::new(kernel.clone()), &loaded);
        let mut past_inputs: Vec<[Vec<f64>; 2]> = Vec::new();
        let mut coefficients = vec![];
        for lag in 0..400 {
            let mut g = vec![0.0; 64];
            let mut h = vec![0.0; 64];
            kernel.coefficients(lag, &mut g, &mut h).unwrap();
            coefficients.push([g, h]);
        }
        let mut computed = [7.0; 8];
        for n in 0..400 {
            history.evaluate(&mut computed).unwrap();
            let mut expected = [0.0; 8];
            for (m, [u, t]) in past_inputs.iter().enumerate() {
                let lag = &coefficients[n - m];
                crate::linalg::dense_multiply_add(&lag[0], 1.0, t, &mut expected);
                crate::linalg::dense_multiply_add(&lag[1], -1.0, u, &mut expected);
            }
            for (a, b) in computed.iter().zip(expected) {
                assert!((a - b).abs() < 1e-13, "step {n}: {a} {b}");
            }
            let mut u = vec![];
            let mut t = vec![];
            for (k, is_loaded) in loaded.into_iter().enumerate() {
                let phase = (n * 8 + k) as f64;
                u.push((1.7 * phase).sin());
                t.push(if is_loaded { (2.3 * phase).sin() } else { 0.0 });
            }
            history.push(&u, &t);
            past_inputs.push([u, t]);
        }
        assert_eq!(history.steps(), 400);
    }
}
