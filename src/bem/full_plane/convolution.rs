//! Effect of all past displacements and tractions of a boundary at the end of the next step.
//!
//! Relaxed blocked convolution, exact to rounding (Hairer, Lubich & Schlichte 1985, SIAM J. Sci. Stat.
//! Comput. 6, 532–541), as in [`crate::history::RelaxedFftHistory`]. Pairs of input and output within a leaf
//! of 64 steps are summed directly. After i steps, with i a multiple of the leaf, the effect of the last b
//! inputs on the next b outputs is one convolution of length 2b, computed by transforms. b is the leaf times
//! the largest power of two for which b divides i.

use super::BoundaryKernel;
use super::block::{BlockTransform, SeriesLink, TransformBuffers};
use super::pair_classes::SegmentPairClasses;
use crate::error::{Result, same_length};
use crate::geometry::{COMPONENTS_IN_PLANE, ContactLayout};
use basemat_fourier::RealPlanner;

/// Number of steps that are summed directly, before the smallest block is transformed.
const DIRECT_STEPS: usize = 64;

/// Largest number of steps for which memory is allocated at once; beyond, memory grows with the steps.
const MAX_HINTED_STEPS: usize = 1 << 17;
/// Largest memory for hinted steps, bytes.
const MAX_HINTED_BYTES: usize = 1 << 30;

/// Σ_{m<N} G^{N−m} t^m − H^{N−m} u^m, with coefficients stored once per class of pairs.
///
/// Inputs are 4E numbers per step: u, then t.
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
    work: TransformBuffers,
    /// 4E rows of `capacity`.
    inputs: Vec<f64>,
    /// 2E rows of `capacity`: outputs, with the contributions so far.
    outputs: Vec<f64>,
    /// Number of steps for which rows and levels are allocated: the leaf times a power of two.
    capacity: usize,
    /// Number of steps accepted.
    steps: usize,
    /// Whether the contribution of the last input is still missing.
    pending: bool,
}

impl BoundaryHistory {
    /// Empty history; `loaded` marks the tractions (2E) that may differ from zero.
    pub(super) fn new(kernel: Box<dyn BoundaryKernel>, loaded: &[bool]) -> Self {
        let pairs = SegmentPairClasses::new(kernel.segments());
        Self {
            links: links(&pairs, kernel.segments().len(), loaded),
            direct_series: Vec::new(),
            pairs,
            kernel,
            transforms: Vec::new(),
            planner: RealPlanner::new(),
            work: TransformBuffers::default(),
            inputs: Vec::new(),
            outputs: Vec::new(),
            capacity: 0,
            steps: 0,
            pending: false,
        }
    }

    /// Number of components 2E.
    fn size(&self) -> usize {
        ContactLayout::new(COMPONENTS_IN_PLANE, self.kernel.segments().len()).len()
    }

    /// Coefficients of all series for the lags below `lags`, without lag 0, which belongs to the present
    /// step.
    fn series(&self, lags: usize) -> Result<Vec<Vec<f64>>> {
        let size = self.size();
        let count = size / 2;
        let mut g = vec![0.0; size * size];
        let mut h = vec![0.0; size * size];
        let mut series = vec![Vec::new(); 8 * self.pairs.classes.len()];
        for lag in 1..lags {
            self.kernel.coefficients(lag, &mut g, &mut h)?;
            for (class, &(p, q)) in self.pairs.classes.iter().enumerate() {
                for (k, matrix) in [&g, &h].into_iter().enumerate() {
                    for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                        let value = matrix[(i * count + p) * size + j * count + q];
                        let list = &mut series[8 * class + 4 * k + 2 * i + j];
                        // Many series are zero at all lags, on flat boundaries half of them.
                        if value != 0.0 || !list.is_empty() {
                            list.resize(lag, 0.0);
                            list.push(value);
                        }
                    }
                }
            }
        }
        for list in series.iter_mut().filter(|list| !list.is_empty()) {
            list.resize(lags, 0.0);
        }
        Ok(series)
    }

    /// Allocates and computes all data for `steps` steps; changes nothing on an error.
    fn grow(&mut self, steps: usize) -> Result<()> {
        if steps <= self.capacity {
            return Ok(());
        }
        let capacity = steps.div_ceil(DIRECT_STEPS).next_power_of_two() * DIRECT_STEPS;
        let series = self.series(capacity)?;
        if self.direct_series.is_empty() {
            for list in &series {
                self.direct_series.push(list[..DIRECT_STEPS.min(list.len())].to_vec());
            }
        }
        let mut size = DIRECT_STEPS << self.transforms.len();
        while size < capacity {
            let transform = BlockTransform::new(size, &series, &mut self.planner, &mut self.work);
            self.transforms.push(transform);
            size *= 2;
        }
        if let Some(transform) = self.transforms.last() {
            self.work.grow(transform, 2 * self.size());
        }
        self.inputs = with_longer_rows(&self.inputs, self.capacity, capacity, 2 * self.size());
        self.outputs = with_longer_rows(&self.outputs, self.capacity, capacity, self.size());
        self.capacity = capacity;
        Ok(())
    }

    /// Allocates for `steps` further steps, up to 131 072 steps and 1 GiB.
    ///
    /// The number is limited because a larger one may mean a run without end.
    pub(super) fn prepare(&mut self, steps: usize) -> Result<()> {
        // Eight series for each class of pairs, their values and spectra, and inputs and outputs.
        let bytes_per_step = 192 * self.pairs.classes.len() + 24 * self.size();
        let max_steps = MAX_HINTED_STEPS.min(MAX_HINTED_BYTES / bytes_per_step.max(1));
        self.grow(self.steps.saturating_add(steps.min(max_steps)))
    }

    /// Adds the contribution of the last input, so that the next output is complete.
    fn add_last_input(&mut self) {
        let step = self.steps;
        let stride = self.capacity;
        let last = step - 1;
        let remaining = DIRECT_STEPS - 1 - last % DIRECT_STEPS;
        if remaining > 0 {
            for link in &self.links {
                let series = &self.direct_series[link.series];
                let value = link.sign * self.inputs[link.input * stride + last];
                if series.is_empty() || value == 0.0 {
                    continue;
                }
                let output = &mut self.outputs[link.output * stride + step..][..remaining];
                for (output, coefficient) in output.iter_mut().zip(&series[1..]) {
                    *output += coefficient * value;
                }
            }
        } else {
            let number = (step / DIRECT_STEPS).trailing_zeros() as usize;
            if let Some(transform) = self.transforms.get(number) {
                transform.apply(
                    &self.links,
                    &self.inputs,
                    &mut self.outputs,
                    stride,
                    step,
                    &mut self.work,
                );
            }
        }
        self.pending = false;
    }

    /// Overwrites `output` (2E) with the history at the end of the next step.
    pub(super) fn evaluate(&mut self, output: &mut [f64]) -> Result<()> {
        same_length("history of the boundary", output.len(), self.size())?;
        self.grow(self.steps + 1)?;
        if self.pending {
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
        self.pending = true;
    }

    /// Number of steps accepted.
    pub(super) fn steps(&self) -> usize {
        self.steps
    }
}

/// The rows of `count` series, copied from rows of length `old_length` to rows of length `length`.
fn with_longer_rows(rows: &[f64], old_length: usize, length: usize, count: usize) -> Vec<f64> {
    let mut longer = vec![0.0; count * length];
    for (new, row) in longer.chunks_exact_mut(length).zip(rows.chunks_exact(old_length.max(1))) {
        new[..old_length].copy_from_slice(row);
    }
    longer
}

/// All pairs of components, G with tractions and −H with displacements.
fn links(pairs: &SegmentPairClasses, count: usize, loaded: &[bool]) -> Vec<SeriesLink> {
    let layout = ContactLayout::new(COMPONENTS_IN_PLANE, count);
    let mut links = Vec::new();
    for (p, pairs) in pairs.pairs.chunks_exact(count).enumerate() {
        for i in 0..2 {
            for (k, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                for (q, &(class, mirrored)) in pairs.iter().enumerate() {
                    let channel = layout.place(j, q);
                    if k == 0 && !loaded[channel] {
                        continue;
                    }
                    let mut sign = if mirrored && i != j { -1.0 } else { 1.0 };
                    let mut input = layout.len() + channel;
                    if k == 1 {
                        sign = -sign;
                        input = channel;
                    }
                    let series = 8 * class + 4 * k + 2 * i + j;
                    links.push(SeriesLink { output: layout.place(i, p), input, series, sign });
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

    /// Compares transforms with the direct sum, over several sizes of blocks and without a hint.
    #[test]
    fn blocks_equal_the_direct_sum() {
        let soil = Soil::new(1.0, 0.3, 1.0).unwrap();
        let nodes = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.5, 0.8], [3.5, 0.8]];
        let segments: Vec<Segment> =
            nodes.windows(2).map(|n| Segment { from: n[0], to: n[1] }).collect();
        let kernel = TimeKernel::new(soil, &segments, 0.4).unwrap();
        let loaded = [true, true, false, true, true, true, true, true];
        let mut history = BoundaryHistory::new(Box::new(kernel.clone()), &loaded);
        let mut past: Vec<[Vec<f64>; 2]> = Vec::new();
        let mut coefficients = vec![];
        for lag in 0..400 {
            let mut g = vec![0.0; 64];
            let mut h = vec![0.0; 64];
            kernel.coefficients(lag, &mut g, &mut h).unwrap();
            coefficients.push([g, h]);
        }
        let mut found = [7.0; 8];
        for n in 0..400 {
            history.evaluate(&mut found).unwrap();
            let mut wanted = [0.0; 8];
            for (m, [u, t]) in past.iter().enumerate() {
                let lag = &coefficients[n - m];
                crate::linalg::dense_multiply_add(&lag[0], 1.0, t, &mut wanted);
                crate::linalg::dense_multiply_add(&lag[1], -1.0, u, &mut wanted);
            }
            for (a, b) in found.iter().zip(wanted) {
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
            past.push([u, t]);
        }
        assert_eq!(history.steps(), 400);
    }
}
