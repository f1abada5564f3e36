//! Blocks over the wavenumbers of a lattice: no pairs of elements are left, only one convolution in
//! time per wavenumber and kind.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use std::sync::Arc;

use realfft::RealFftPlanner;
use realfft::num_complex::Complex64;
use rustfft::{Fft, FftPlanner};

use super::blocks::{Extent, Space};
use super::lattice::Lattice;
use super::level::Rows;
use super::level::{Convolution, KINDS, Level, Near, Part, Work, fill, reserve};
use crate::error::Result;
use crate::history::convolution_weights::ConvolutionWeights;
use crate::linalg::{Simd, WithSimd, vectorized};

/// Wavenumbers of a lattice, B of them: their spectra are series of d by wavenumber, and the
/// coefficients of a leaf are B numbers for each d.
///
/// A step is kept as four slices of B: real and imaginary parts of the normal components, then of
/// the tangential ones.
pub(super) struct Waves {
    lattice: Lattice,
    /// Steps of a leaf.
    leaf: usize,
    /// Last d at which any coupling is not zero; the largest number if it never ends.
    reach: usize,
    planner: FftPlanner<f64>,
    /// What all earlier leaves give at the outputs of this one, step by step.
    far: Vec<f64>,
    sum: Vec<f64>,
}

impl Waves {
    /// Wavenumbers of elements on `lattice`.
    pub(super) fn new(
        lattice: Lattice,
        kernel: &dyn ConvolutionWeights,
        leaf: usize,
    ) -> Result<Self> {
        let width = 4 * lattice.waves();
        Ok(Self {
            reach: lattice.last_coupling_lag(kernel)?.saturating_sub(1),
            lattice,
            leaf,
            planner: FftPlanner::new(),
            far: vec![0.0; leaf * width],
            sum: vec![0.0; width],
        })
    }
}

impl Space for Waves {
    fn extent(&self) -> Extent {
        let (width, reach) = (4 * self.lattice.waves(), self.reach);
        Extent { along_surface: true, width, parts: 2, lags: self.leaf, ahead: 0, reach }
    }

    fn level(&mut self, size: usize, couples: bool) -> Level {
        let transforms = Products {
            waves: self.lattice.waves(),
            forward: self.planner.plan_fft_forward(2 * size),
            inverse: self.planner.plan_fft_inverse(2 * size),
        };
        Level::new(size, self.lattice.waves(), couples, Box::new(transforms))
    }

    fn fill(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        levels: &mut [Level],
        wanted: bool,
    ) -> Result<Near> {
        let (waves, leaf) = (self.lattice.waves(), if wanted { self.leaf } else { 0 });
        let mut near = [(); KINDS].map(|()| vec![0.0; leaf * waves]);
        // Coefficients wait in the place of the largest spectra that are made of them.
        let largest: [_; KINDS] =
            std::array::from_fn(|kind| levels.iter().rposition(|level| level.has(kind)));
        let lags = largest.map(|number| number.map_or(leaf, |number| 2 * levels[number].size));
        let coupled = lags[2].min(self.reach.saturating_add(1));
        self.lattice.coefficients(kernel, lags[0], coupled, |kind, d, values| {
            if d < leaf {
                near[kind][d * waves..(d + 1) * waves].copy_from_slice(values);
            }
            if let Some(level) = largest[kind].and_then(|number| levels.get_mut(number)) {
                for (wave, value) in values.iter().enumerate() {
                    level.place(kind, wave)[d] = *value;
                }
            }
        })?;
        let (mut planner, mut work) = (RealFftPlanner::new(), Work::default());
        let mut series = vec![0.0; lags[0]];
        for (kind, number) in largest.into_iter().enumerate() {
            let Some(number) = number else { continue };
            for wave in 0..waves {
                let series = &mut series[..lags[kind]];
                series.copy_from_slice(&levels[number].place(kind, wave)[..lags[kind]]);
                fill(levels, [kind, wave], series, &mut planner, &mut work);
            }
        }
        Ok(near)
    }

    fn input(&mut self, traction: &[f64], input: &mut [f64]) {
        let waves = self.lattice.waves();
        let (normal, tangential) = traction.split_at(traction.len().min(self.lattice.elements()));
        for (values, part) in
            [normal, tangential].into_iter().zip(input.chunks_exact_mut(2 * waves))
        {
            self.lattice.forward(values, part.split_at_mut(waves).into());
        }
    }

    fn traction(&mut self, input: &[f64], traction: &mut [f64]) {
        let (waves, elements) = (self.lattice.waves(), self.lattice.elements());
        let parts = traction.chunks_exact_mut(elements);
        for (values, part) in parts.zip(input.chunks_exact(2 * waves)) {
            self.lattice.back(part.split_at(waves).into(), 1.0, values);
        }
    }

    fn begin(&mut self, rows: &Rows, now: usize) {
        rows.read(now, &mut self.far);
    }

    fn output(&mut self, near: &Near, _: &Rows, _: usize, inputs: &[f64], out: &mut [f64]) {
        let (waves, reach, sum) = (self.lattice.waves(), self.reach, &mut self.sum[..]);
        sum.copy_from_slice(&self.far[inputs.len()..][..sum.len()]);
        vectorized(Leaf { sum, inputs, near, waves, reach });
        let parts = out.chunks_exact_mut(self.lattice.elements());
        for (values, sum) in parts.zip(self.sum.chunks_exact(2 * waves)) {
            self.lattice.inverse(sum.split_at(waves).into(), values);
        }
    }

    fn numbers(&self) -> usize {
        self.far.len() + self.sum.len() + self.lattice.numbers()
    }
}

/// Each wavenumber by itself: its blocks and spectra fit into cache.
///
/// Coefficients are real numbers in time, so that the upper frequencies are conjugates of those that
/// are kept; the coupling's stand for i times them.
struct Products {
    waves: usize,
    forward: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
}

impl Convolution for Products {
    fn reserve(&self, level: &Level, work: &mut Work) {
        let (forward, inverse) = (&self.forward, &self.inverse);
        let scratch = forward.get_inplace_scratch_len().max(inverse.get_inplace_scratch_len());
        reserve(&mut work.scratch, scratch);
        reserve(&mut work.complex, 4 * level.size);
    }

    fn apply(&self, level: &Level, rows: &mut Rows, now: usize, part: Part, work: &mut Work) {
        let length = 2 * level.size;
        let Work { complex, scratch, .. } = work;
        let (p, s) = complex[..2 * length].split_at_mut(length);
        for wave in 0..self.waves {
            let spectrum = |kind: usize| level.spectrum(kind, wave, 0);
            self.take(rows, wave, now, p, scratch);
            self.take(rows, self.waves + wave, now, s, scratch);
            let turned = |c: Complex64| Complex64::new(-c.im, c.re);
            match part {
                Part::Even => each([p, s], [0, 1].map(spectrum), |p, s, [g, h]| {
                    *p *= g;
                    *s *= h;
                }),
                Part::Coupling => each([p, s], [spectrum(2)], |p, s, [c]| {
                    (*p, *s) = (turned(c) * *s, -turned(c) * *p);
                }),
                Part::All => each([p, s], [0, 1, 2].map(spectrum), |p, s, [g, h, c]| {
                    (*p, *s) = (g * *p + turned(c) * *s, h * *s - turned(c) * *p);
                }),
            }
            self.give(rows, wave, now, p, scratch);
            self.give(rows, self.waves + wave, now, s, scratch);
        }
    }
}

impl Products {
    /// Transforms the inputs of a row, as many zeros behind them.
    fn take(
        &self,
        rows: &Rows,
        row: usize,
        now: usize,
        block: &mut [Complex64],
        scratch: &mut [Complex64],
    ) {
        let (inputs, rest) = block.split_at_mut(block.len() / 2);
        let row = rows.inputs(row, now, inputs.len());
        for (value, parts) in inputs.iter_mut().zip(row.chunks_exact(2)) {
            *value = Complex64::new(parts[0], parts[1]);
        }
        rest.fill(Complex64::default());
        self.forward.process_with_scratch(block, scratch);
    }

    /// Transforms back, and adds the later half to the outputs of a row.
    fn give(
        &self,
        rows: &mut Rows,
        row: usize,
        now: usize,
        block: &mut [Complex64],
        scratch: &mut [Complex64],
    ) {
        self.inverse.process_with_scratch(block, scratch);
        let later = &block[block.len() / 2..];
        let scale = 0.5 / later.len() as f64;
        let outputs = rows.outputs(row, now, later.len());
        for (output, value) in outputs.chunks_exact_mut(2).zip(later) {
            output[0] += value.re * scale;
            output[1] += value.im * scale;
        }
    }
}

/// Replaces all frequencies of two blocks by their products with some spectra.
fn each<const N: usize>(
    [one, two]: [&mut [Complex64]; 2],
    spectra: [[&[f64]; 2]; N],
    multiply: impl Fn(&mut Complex64, &mut Complex64, [Complex64; N]),
) {
    let bins = one.len() / 2 + 1;
    let ((one, one_high), (two, two_high)) = (one.split_at_mut(bins), two.split_at_mut(bins));
    let lower = spectra.map(|parts| parts.map(|values| &values[..bins]));
    for (k, (p, s)) in one.iter_mut().zip(two).enumerate() {
        multiply(p, s, lower.map(|[re, im]| Complex64::new(re[k], im[k])));
    }
    let upper = spectra.map(|parts| parts.map(|values| &values[1..bins - 1]));
    for (k, (p, s)) in one_high.iter_mut().rev().zip(two_high.iter_mut().rev()).enumerate() {
        multiply(p, s, upper.map(|[re, im]| Complex64::new(re[k], -im[k])));
    }
}

/// Sum over the inputs of a leaf so far, for its next output.
struct Leaf<'a> {
    sum: &'a mut [f64],
    inputs: &'a [f64],
    near: &'a Near,
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
                near.each_ref().map(|values| &values[d * waves..(d + 1) * waves]);
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
