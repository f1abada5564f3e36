//! Blocks over the wavenumbers of a lattice: no pairs of elements are left, only one convolution in
//! time per wavenumber and kind.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use std::sync::Arc;

use realfft::RealFftPlanner;
use realfft::num_complex::Complex;
use rustfft::FftPlanner;

use super::coefficients::{Blocks, LEAF};
use super::lattice::Lattice;
use super::level::Ring;
use super::wave_level::{KINDS, Near, Part, WaveLevel};
use crate::error::Result;
use crate::history::convolution::ConvolutionWeights;
use crate::linalg::{Simd, WithSimd, vectorized};

/// Between the ends of rows, so that equal places of all rows do not fall into one cache set.
const PADDING: usize = 4;

/// Steps of a leaf over wavenumbers, all levels of blocks, and what has come in so far.
///
/// Within a leaf, a step's contact vector over B wavenumbers is held as four slices of B: real and
/// imaginary parts of the normal components, then of the tangential ones.
pub(super) struct Waves {
    lattice: Lattice,
    /// Steps that are summed directly.
    leaf: usize,
    /// Last d at which any coupling is not zero; the largest number if it never ends.
    reach: usize,
    near: Arc<Near>,
    levels: Vec<Arc<WaveLevel>>,
    planner: FftPlanner<f64>,
    /// 2B rows of `stride`: inputs before the present leaf, outputs as far as known from there on.
    rows: Vec<Complex<f64>>,
    stride: usize,
    ring: Ring,
    capacity: usize,
    /// Inputs of this leaf, and what all earlier leaves give at its outputs.
    inputs: Vec<f64>,
    far: Vec<f64>,
    sum: Vec<f64>,
    /// Blocks that are being transformed, and scratch of the transforms.
    blocks: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

impl Waves {
    /// Blocks of elements on `lattice`, empty.
    pub(super) fn new(
        lattice: Lattice,
        kernel: &dyn ConvolutionWeights,
        leaf: usize,
    ) -> Result<Self> {
        let size = 4 * lattice.waves();
        Ok(Self {
            reach: lattice.last_coupling_lag(kernel)?.saturating_sub(1),
            lattice,
            leaf,
            near: Arc::default(),
            levels: Vec::new(),
            planner: FftPlanner::new(),
            rows: Vec::new(),
            stride: 0,
            ring: Ring::ENDLESS,
            capacity: 0,
            inputs: vec![0.0; leaf * size],
            far: vec![0.0; leaf * size],
            sum: vec![0.0; size],
            blocks: Vec::new(),
            scratch: Vec::new(),
        })
    }

    /// Whether blocks of `size` have spectra of the coupling: up to the first that covers its reach.
    fn couples(&self, size: usize) -> bool {
        self.reach > 0 && (size == self.leaf || size / 2 < self.reach)
    }

    /// The levels from the `first`-th to the one before `end`, and the coefficients of a leaf
    /// unless they are there.
    fn make(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        [first, end]: [usize; 2],
        near: &mut Option<Arc<Near>>,
    ) -> Result<Vec<Arc<WaveLevel>>> {
        let waves = self.lattice.waves();
        let mut levels: Vec<_> = (first..end)
            .map(|number| {
                let size = self.leaf << number;
                WaveLevel::new(size, waves, self.couples(size), &mut self.planner)
            })
            .collect();
        let own = self.fill(kernel, &mut levels, near.is_none())?;
        near.get_or_insert(Arc::new(own));
        Ok(levels.into_iter().map(Arc::new).collect())
    }

    /// Fills the spectra of `levels`, and returns the coefficients of a leaf if they are `wanted`.
    fn fill(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        levels: &mut [WaveLevel],
        wanted: bool,
    ) -> Result<Near> {
        let waves = self.lattice.waves();
        let near = wanted.then_some(self.leaf);
        let mut lags = [near.unwrap_or(0); KINDS];
        // Coefficients wait in the place of the largest spectra that are made of them.
        for (kind, lags) in lags.iter_mut().enumerate() {
            if let Some(level) = levels.iter().rfind(|level| level.has(kind)) {
                *lags = 2 * level.size;
            }
        }
        let mut table: [_; KINDS] = std::array::from_fn(|_| vec![0.0; near.unwrap_or(0) * waves]);
        let largest: [_; KINDS] =
            std::array::from_fn(|kind| levels.iter().rposition(|level| level.has(kind)));
        let coupled = lags[2].min(self.reach + 1);
        self.lattice.coefficients(kernel, lags[0], coupled, |kind, d, values| {
            if near.is_some_and(|leaf| d < leaf) {
                table[kind][d * waves..(d + 1) * waves].copy_from_slice(values);
            }
            if let Some(level) = largest[kind].and_then(|number| levels.get_mut(number)) {
                level.keep(kind, d, values);
            }
        })?;
        let mut planner = RealFftPlanner::new();
        let (mut time, mut real) = (vec![0.0; lags[0]], vec![0.0; lags[0]]);
        for kind in 0..KINDS {
            let Some(from) = largest[kind] else { continue };
            for wave in 0..waves {
                levels[from].kept(kind, wave, &mut time);
                for level in levels.iter_mut().filter(|level| level.has(kind)) {
                    let real = &mut real[..2 * level.size];
                    real.copy_from_slice(&time[..2 * level.size]);
                    level.transform(kind, wave, real, &mut planner, &mut self.scratch);
                }
            }
        }
        Ok(table)
    }

    /// Moves the leaf that ends before `now` to the rows, works it in, and takes up the next one.
    fn turn(&mut self, now: usize) {
        let (waves, ring) = (self.lattice.waves(), self.ring);
        let before = ring.before(now, self.leaf);
        let stale = ring.stale(now);
        for (row, values) in self.rows.chunks_exact_mut(self.stride).enumerate() {
            if let Some(stale) = &stale {
                values[stale.clone()].fill(Complex::default());
            }
            let re = 2 * waves * (row / waves) + row % waves;
            let inputs = self.inputs.chunks_exact(4 * waves);
            for (value, input) in values[before.clone()].iter_mut().zip(inputs) {
                *value = Complex::new(input[re], input[re + waves]);
            }
        }
        let number = ring.level(now, self.leaf, self.levels.len());
        let part = if self.levels[number].has(2) { Part::All } else { Part::Even };
        let Self { levels, rows, blocks, scratch, stride, .. } = self;
        levels[number].apply(rows, *stride, (ring, now), part, blocks, scratch);
        if part == Part::Even
            && let Some(level) = levels.iter().rfind(|level| level.has(2))
        {
            level.apply(rows, *stride, (ring, now), Part::Coupling, blocks, scratch);
        }
        let begin = ring.place(now);
        for (row, values) in self.rows.chunks_exact(self.stride).enumerate() {
            let re = 2 * waves * (row / waves) + row % waves;
            let far = self.far.chunks_exact_mut(4 * waves);
            for (value, far) in values[begin..begin + self.leaf].iter().zip(far) {
                (far[re], far[re + waves]) = (value.re, value.im);
            }
        }
    }

    /// The `wanted` smallest levels and the coefficients of a leaf, from the kernel's store as far as
    /// they are there, with scratch for their blocks.
    fn take_levels(&mut self, kernel: &dyn ConvolutionWeights, wanted: usize) -> Result<()> {
        // Before the spectra are locked: a kernel may work on several threads, which must not wait.
        kernel.prepare(self.leaf << wanted)?;
        let spectra = kernel.spectra().filter(|_| self.leaf == LEAF);
        let elements = kernel.classes().elements();
        let (levels, near) = if let Some(spectra) = spectra.filter(|s| s.are_of(elements)) {
            let mut shared = spectra.waves();
            let mut near = shared.near.take();
            let more = self.make(kernel, [shared.levels.len(), wanted], &mut near);
            shared.near.clone_from(&near);
            shared.levels.extend(more?);
            (shared.levels[..wanted].to_vec(), near)
        } else {
            let mut near = (self.capacity > 0).then(|| Arc::clone(&self.near));
            let mut levels = self.levels.clone();
            levels.extend(self.make(kernel, [levels.len(), wanted], &mut near)?);
            (levels, near)
        };
        let zero = Complex::default();
        if let Some(level) = levels.last() {
            // Where components couple, both are transformed before they are multiplied.
            let coupled = levels.iter().rfind(|level| level.has(2)).map_or(0, |l| 4 * l.size);
            let length = self.blocks.len().max(coupled).max(2 * level.size);
            self.blocks.resize(length, zero);
            self.scratch.resize(self.scratch.len().max(level.scratch()), zero);
        }
        self.levels = levels;
        self.near = near.unwrap_or_default();
        Ok(())
    }
}

impl Blocks for Waves {
    fn capacity(&self) -> usize {
        self.capacity
    }

    fn numbers(&self) -> usize {
        let near: usize = self.near.iter().map(Vec::len).sum();
        near + self.levels.iter().map(|level| level.numbers()).sum::<usize>()
            + 2 * (self.rows.len() + self.blocks.len() + self.scratch.len())
            + self.inputs.len()
            + self.far.len()
            + self.sum.len()
            + self.lattice.numbers()
    }

    fn grow(&mut self, kernel: &dyn ConvolutionWeights, steps: usize) -> Result<()> {
        if steps <= self.capacity && self.capacity > 0 {
            return Ok(());
        }
        let leaves = steps.div_ceil(self.leaf).max(1);
        let largest = leaves.next_power_of_two();
        // The first request is met exactly; later ones double the memory.
        let capacity = self.leaf * if self.capacity == 0 { leaves } else { largest };
        let waves = self.lattice.waves();
        let wanted = largest.ilog2() as usize;
        self.take_levels(kernel, wanted)?;
        if capacity > self.leaf {
            let stride = capacity + PADDING;
            let mut rows = vec![Complex::default(); 2 * waves * stride];
            if self.stride > 0 {
                let old = self.rows.chunks_exact(self.stride);
                for (new, old) in rows.chunks_exact_mut(stride).zip(old) {
                    new[..self.capacity].copy_from_slice(&old[..self.capacity]);
                }
            }
            (self.rows, self.stride) = (rows, stride);
        }
        self.capacity = capacity;
        Ok(())
    }

    fn bound(&mut self, kernel: &dyn ConvolutionWeights, reach: usize) -> Result<()> {
        self.take_levels(kernel, (reach / self.leaf).ilog2() as usize + 1)?;
        (self.ring, self.stride) = (Ring(2 * reach), 2 * reach + PADDING);
        self.rows = vec![Complex::default(); 2 * self.lattice.waves() * self.stride];
        self.capacity = usize::MAX;
        Ok(())
    }

    fn work_in(&mut self, now: usize) {
        if now.is_multiple_of(self.leaf) {
            self.turn(now);
        }
    }

    fn write(&mut self, now: usize, traction: &[f64]) {
        let waves = self.lattice.waves();
        let (normal, tangential) = traction.split_at(traction.len() / 2);
        let input = &mut self.inputs[now % self.leaf * 4 * waves..][..4 * waves];
        for (values, part) in
            [normal, tangential].into_iter().zip(input.chunks_exact_mut(2 * waves))
        {
            self.lattice.forward(values, part.split_at_mut(waves).into());
        }
    }

    fn width(&self) -> usize {
        4 * self.lattice.waves()
    }

    fn input(&self, step: usize, worked_in: usize, values: &mut Vec<f64>) {
        let waves = self.lattice.waves();
        if step >= worked_in - worked_in % self.leaf {
            let begin = step % self.leaf * 4 * waves;
            values.extend_from_slice(&self.inputs[begin..begin + 4 * waves]);
        } else {
            let row = |row: usize| self.rows[row * self.stride + step];
            for of in [0..waves, waves..2 * waves] {
                values.extend(of.clone().map(|k| row(k).re));
                values.extend(of.map(|k| row(k).im));
            }
        }
    }

    fn traction(&mut self, input: &[f64], traction: &mut [f64]) {
        let waves = self.lattice.waves();
        let half = traction.len() / 2;
        for (values, part) in traction.chunks_exact_mut(half).zip(input.chunks_exact(2 * waves)) {
            self.lattice.back(part.split_at(waves).into(), 1.0, values);
        }
    }

    fn write_input(&mut self, now: usize, input: &[f64]) {
        self.inputs[now % self.leaf * input.len()..][..input.len()].copy_from_slice(input);
    }

    fn clear(&mut self) {
        self.rows.fill(Complex::default());
        self.inputs.fill(0.0);
        self.far.fill(0.0);
    }

    fn read(&mut self, now: usize, displacement: &mut [f64]) {
        let waves = self.lattice.waves();
        let size = 4 * waves;
        let place = now % self.leaf;
        self.sum.copy_from_slice(&self.far[place * size..(place + 1) * size]);
        let near = self.near.each_ref().map(Vec::as_slice);
        let (sum, inputs) = (&mut self.sum[..], &self.inputs[..place * size]);
        vectorized(Leaf { sum, inputs, near, waves, reach: self.reach });
        let (down, along) = displacement.split_at_mut(displacement.len() / 2);
        for (values, sum) in [down, along].into_iter().zip(self.sum.chunks_exact(2 * waves)) {
            self.lattice.inverse(sum.split_at(waves).into(), values);
        }
    }
}

/// Sum over the inputs of a leaf so far, for its next output.
struct Leaf<'a> {
    sum: &'a mut [f64],
    inputs: &'a [f64],
    near: [&'a [f64]; KINDS],
    waves: usize,
    reach: usize,
}

impl WithSimd for Leaf<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { sum, inputs, near, waves, reach } = self;
        let place = inputs.len() / sum.len();
        for (m, input) in inputs.chunks_exact(sum.len()).enumerate() {
            let d = place - m;
            let [normal, tangential, coupling] =
                near.map(|values| &values[d * waves..(d + 1) * waves]);
            if d <= reach {
                add_coupled(sum, input, [normal, tangential, coupling]);
            } else {
                add(sum, input, [normal, tangential]);
            }
        }
    }
}

/// sum ← sum + ĝ · input.
#[inline(always)]
fn add(sum: &mut [f64], input: &[f64], coefficients: [&[f64]; 2]) {
    let waves = coefficients[0].len();
    let parts = sum.chunks_exact_mut(waves).zip(input.chunks_exact(waves));
    for (number, (sum, input)) in parts.enumerate() {
        for ((sum, input), g) in sum.iter_mut().zip(input).zip(coefficients[number / 2]) {
            *sum += g * input;
        }
    }
}

/// The same with coupling, which is i times a real number and of either sign.
#[inline(always)]
fn add_coupled(sum: &mut [f64], input: &[f64], coefficients: [&[f64]; 3]) {
    let waves = coefficients[0].len();
    let [normal, tangential, coupling] = coefficients.map(|values| &values[..waves]);
    let (down, along) = sum.split_at_mut(2 * waves);
    let ((down_re, down_im), (along_re, along_im)) =
        (down.split_at_mut(waves), along.split_at_mut(waves));
    let (along_re, along_im) = (&mut along_re[..waves], &mut along_im[..waves]);
    let part = |k: usize| &input[k * waves..(k + 1) * waves];
    let [p_re, p_im, s_re, s_im] = [part(0), part(1), part(2), part(3)];
    for k in 0..waves {
        let (g, h, c) = (normal[k], tangential[k], coupling[k]);
        down_re[k] += g * p_re[k] - c * s_im[k];
        down_im[k] += g * p_im[k] + c * s_re[k];
        along_re[k] += h * s_re[k] + c * p_im[k];
        along_im[k] += h * s_im[k] - c * p_re[k];
    }
}
