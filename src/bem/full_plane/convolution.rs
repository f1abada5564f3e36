//! Effect of all past displacements and tractions of a boundary at the end of the next step.
//!
//! Relaxed blocked convolution, exact to rounding (Hairer, Lubich & Schlichte 1985, SIAM J. Sci. Stat.
//! Comput. 6, 532–541), as in [`crate::history::RelaxedFftHistory`]. Pairs of input and output within a leaf
//! of 64 steps are summed directly. After i steps, with i a multiple of the leaf, the effect of the last b
//! inputs on the next b outputs is one convolution of length 2b, computed by transforms. b is the leaf times
//! the largest power of two for which b divides i.

use super::BoundaryKernel;
use super::block::{Level, Link, Work};
use super::pair_classes::PairClasses;
use crate::error::{Result, same_length};
use crate::geometry::{COMPONENTS_IN_PLANE, ContactLayout};
use realfft::RealFftPlanner;

/// Steps that are summed directly before the smallest block is transformed.
const LEAF: usize = 64;

/// Largest hint for which memory is allocated at once; above, memory grows with the steps.
const LONGEST_HINT: usize = 1 << 17;
/// Largest memory for hinted steps, bytes.
const MOST_HINTED: usize = 1 << 30;

/// Σ_{m<N} G^{N−m} t^m − H^{N−m} u^m, with coefficients stored once per class of pairs.
///
/// Inputs are 4E numbers per step: u, then t.
pub(super) struct BoundaryHistory {
    pub(super) kernel: Box<dyn BoundaryKernel>,
    pairs: PairClasses,
    links: Vec<Link>,
    /// For each class, matrix and component: coefficients of the lags below [`LEAF`]; empty if zero.
    near: Vec<Vec<f64>>,
    levels: Vec<Level>,
    planner: RealFftPlanner<f64>,
    work: Work,
    /// 4E rows of `capacity`.
    inputs: Vec<f64>,
    /// 2E rows of `capacity`: outputs, with the contributions so far.
    outputs: Vec<f64>,
    /// Number of steps for which rows and levels are allocated: the leaf times a power of two.
    capacity: usize,
    steps: usize,
    /// Whether the contribution of the last input is still missing.
    pending: bool,
}

impl BoundaryHistory {
    /// Empty history; `loaded` marks the tractions (2E) that may differ from zero.
    pub(super) fn new(kernel: Box<dyn BoundaryKernel>, loaded: &[bool]) -> Self {
        let pairs = PairClasses::new(kernel.segments());
        Self {
            links: links(&pairs, kernel.segments().len(), loaded),
            near: Vec::new(),
            pairs,
            kernel,
            levels: Vec::new(),
            planner: RealFftPlanner::new(),
            work: Work::default(),
            inputs: Vec::new(),
            outputs: Vec::new(),
            capacity: 0,
            steps: 0,
            pending: false,
        }
    }

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
        let capacity = steps.div_ceil(LEAF).next_power_of_two() * LEAF;
        let series = self.series(capacity)?;
        if self.near.is_empty() {
            let first = |list: &Vec<f64>| list[..LEAF.min(list.len())].to_vec();
            self.near = series.iter().map(first).collect();
        }
        let mut size = LEAF << self.levels.len();
        while size < capacity {
            let level = Level::new(size, &series, &mut self.planner, &mut self.work);
            self.levels.push(level);
            size *= 2;
        }
        if let Some(level) = self.levels.last() {
            self.work.grow(level, 2 * self.size());
        }
        let longer = |rows: &[f64], old: usize, count: usize| {
            let mut grown = vec![0.0; count * capacity];
            for (new, row) in grown.chunks_exact_mut(capacity).zip(rows.chunks_exact(old.max(1))) {
                new[..old].copy_from_slice(row);
            }
            grown
        };
        self.inputs = longer(&self.inputs, self.capacity, 2 * self.size());
        self.outputs = longer(&self.outputs, self.capacity, self.size());
        self.capacity = capacity;
        Ok(())
    }

    /// Allocates for `steps` further steps, up to 131 072 steps and 1 GiB.
    ///
    /// The hint is limited because a larger one may stand for a run without end.
    pub(super) fn prepare(&mut self, steps: usize) -> Result<()> {
        // Eight series for each class of pairs, their values and spectra, and inputs and outputs.
        let step = 192 * self.pairs.classes.len() + 24 * self.size();
        let most = LONGEST_HINT.min(MOST_HINTED / step.max(1));
        self.grow(self.steps.saturating_add(steps.min(most)))
    }

    /// Adds the contribution of the last input, so that the next output is complete.
    fn settle(&mut self) {
        let now = self.steps;
        let stride = self.capacity;
        let last = now - 1;
        let ahead = LEAF - 1 - last % LEAF;
        if ahead > 0 {
            for link in &self.links {
                let near = &self.near[link.series];
                let value = link.sign * self.inputs[link.input * stride + last];
                if near.is_empty() || value == 0.0 {
                    continue;
                }
                let output = &mut self.outputs[link.output * stride + now..][..ahead];
                for (output, coefficient) in output.iter_mut().zip(&near[1..]) {
                    *output += coefficient * value;
                }
            }
        } else {
            let number = (now / LEAF).trailing_zeros() as usize;
            if let Some(level) = self.levels.get(number) {
                level.apply(
                    &self.links,
                    &self.inputs,
                    &mut self.outputs,
                    stride,
                    now,
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
            self.settle();
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

/// All pairs of components, G with tractions and −H with displacements.
fn links(pairs: &PairClasses, count: usize, loaded: &[bool]) -> Vec<Link> {
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
                    let sign = if mirrored && i != j { -1.0 } else { 1.0 };
                    let (input, sign) =
                        if k == 0 { (layout.len() + channel, sign) } else { (channel, -sign) };
                    let series = 8 * class + 4 * k + 2 * i + j;
                    links.push(Link { output: layout.place(i, p), input, series, sign });
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
        let coefficients: Vec<_> = (0..400)
            .map(|lag| {
                let mut g = vec![0.0; 64];
                let mut h = vec![0.0; 64];
                kernel.coefficients(lag, &mut g, &mut h).unwrap();
                [g, h]
            })
            .collect();
        let mut found = [7.0; 8];
        for n in 0..400 {
            history.evaluate(&mut found).unwrap();
            let mut wanted = [0.0; 8];
            for (m, [u, t]) in past.iter().enumerate() {
                let [g, h] = &coefficients[n - m];
                crate::linalg::dense_multiply_add(g, 1.0, t, &mut wanted);
                crate::linalg::dense_multiply_add(h, -1.0, u, &mut wanted);
            }
            for (a, b) in found.iter().zip(wanted) {
                assert!((a - b).abs() < 1e-13, "step {n}: {a} {b}");
            }
            let wave = |k: usize, rate: f64| ((n * 8 + k) as f64 * rate).sin();
            let u: Vec<f64> = (0..8).map(|k| wave(k, 1.7)).collect();
            let t: Vec<f64> = (0..8).map(|k| if loaded[k] { wave(k, 2.3) } else { 0.0 }).collect();
            history.push(&u, &t);
            past.push([u, t]);
        }
        assert_eq!(history.steps(), 400);
    }
}
