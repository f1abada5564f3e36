//! Equal elements on a lattice: their coefficients depend on the offset alone, so that a Fourier
//! transform along the surface takes all pairs apart.
//!
//! | symbol | meaning |
//! |---|---|
//! | S | length of the transform, at least two patches less one: nothing wraps around |
//! | k | wavenumber, 0 … S/2 |
//! | ĝ | 𝓕 of the coefficients over the offset: real for normal and tangential ones, which are even, i times a real number for the coupling, which is odd |

use std::sync::Arc;

use realfft::num_complex::Complex;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};

use crate::error::Result;
use crate::history::convolution::ConvolutionWeights;
use crate::history::pair_classes::PairClasses;

/// Lags that are evaluated together.
const CHUNK: usize = 512;

/// Cells of the lattice per element, at most: gaps between strips are transformed too.
const EMPTY: usize = 2;

/// Where the elements are, and the transforms along the surface.
pub(super) struct Lattice {
    /// Cell of each element.
    cells: Vec<usize>,
    /// Class of each offset, where a pair has it.
    classes: Vec<Option<usize>>,
    /// 1/length of the elements.
    scale: f64,
    /// S.
    length: usize,
    forward: Arc<dyn RealToComplex<f64>>,
    inverse: Arc<dyn ComplexToReal<f64>>,
    real: Vec<f64>,
    spectrum: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

impl Lattice {
    /// The lattice of the elements; `None` if they are not on one, or one mostly empty.
    pub(super) fn of(pairs: &PairClasses) -> Option<Self> {
        let elements = pairs.elements();
        let (first, last) = (elements.first()?, elements.last()?);
        let pitch = first.length();
        let most = EMPTY * elements.len();
        if (last.right - first.left) / pitch >= most as f64 + 0.5 {
            return None;
        }
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "at most `most`"
        )]
        let cell = |left: f64| ((left - first.left) / pitch).round() as usize;
        let cells: Vec<_> = elements.iter().map(|element| cell(element.left)).collect();
        let mut classes = vec![None; cells.last()? + 1];
        // Pairs are in one class if they are equal but for rounding: offsets have to agree with it.
        let mut scales = pairs.pairs().iter().map(|pair| pair.scale);
        let scale = scales.next()?;
        if scales.any(|other| (other - scale).abs() > 1e-9 * scale) {
            return None;
        }
        for (p, sources) in pairs.pairs().chunks_exact(cells.len()).enumerate() {
            for (q, pair) in sources.iter().enumerate() {
                let class = classes[cells[p].abs_diff(cells[q])].get_or_insert(pair.class);
                if *class != pair.class {
                    return None;
                }
            }
        }
        let length = smooth(2 * classes.len() - 1);
        let mut planner = RealFftPlanner::new();
        let (forward, inverse) =
            (planner.plan_fft_forward(length), planner.plan_fft_inverse(length));
        let scratch = forward.get_scratch_len().max(inverse.get_scratch_len());
        Some(Self {
            cells,
            classes,
            scale,
            length,
            real: vec![0.0; length],
            spectrum: vec![Complex::default(); length / 2 + 1],
            scratch: vec![Complex::default(); scratch],
            forward,
            inverse,
        })
    }

    /// Number of wavenumbers.
    pub(super) fn waves(&self) -> usize {
        self.length / 2 + 1
    }

    /// Real numbers held.
    pub(super) fn numbers(&self) -> usize {
        self.real.len() + 2 * (self.spectrum.len() + self.scratch.len())
    }

    /// Last lag at which any coupling is not zero; the largest number if it never ends.
    pub(super) fn last_coupling_lag(&self, kernel: &dyn ConvolutionWeights) -> Result<usize> {
        let mut last = 0;
        for class in self.classes.iter().flatten() {
            last = last.max(kernel.last_coupling_lag(*class)?.unwrap_or(usize::MAX));
        }
        Ok(last)
    }

    fn transform(&mut self) {
        let Self { forward, real, spectrum, scratch, .. } = self;
        let scratch = &mut scratch[..forward.get_scratch_len()];
        // All lengths are the plan's own, so there is nothing that could fail.
        let done = forward.process_with_scratch(real, spectrum, scratch);
        debug_assert!(done.is_ok());
    }

    /// 𝓕 of one value per element (missing ones count as zero) into real and imaginary parts.
    pub(super) fn forward(&mut self, values: &[f64], [re, im]: [&mut [f64]; 2]) {
        self.real.fill(0.0);
        for (&cell, &value) in self.cells.iter().zip(values) {
            self.real[cell] = value;
        }
        self.transform();
        for (value, (re, im)) in self.spectrum.iter().zip(re.iter_mut().zip(im)) {
            (*re, *im) = (value.re, value.im);
        }
    }

    /// Overwrites one value per element from real and imaginary parts; means over the elements.
    pub(super) fn inverse(&mut self, parts: [&[f64]; 2], values: &mut [f64]) {
        self.back(parts, self.scale, values);
    }

    /// Overwrites the values of which [`Lattice::forward`] made real and imaginary parts, times a
    /// factor.
    pub(super) fn back(&mut self, [re, im]: [&[f64]; 2], factor: f64, values: &mut [f64]) {
        for (value, (re, im)) in self.spectrum.iter_mut().zip(re.iter().zip(im)) {
            *value = Complex::new(*re, *im);
        }
        // Real up to rounding, and the inverse transform insists on it; S is even.
        let last = self.length / 2;
        (self.spectrum[0].im, self.spectrum[last].im) = (0.0, 0.0);
        let Self { inverse, real, spectrum, scratch, .. } = self;
        let scratch = &mut scratch[..inverse.get_scratch_len()];
        let done = inverse.process_with_scratch(spectrum, real, scratch);
        debug_assert!(done.is_ok());
        let scale = factor / self.length as f64;
        for (&cell, value) in self.cells.iter().zip(values) {
            *value = scale * self.real[cell];
        }
    }

    /// Hands out ĝ of lag d + 1 for d = 0 … `count` − 1, zero for d = 0: `accept` is given d, and
    /// one slice over the wavenumbers per kind; the coupling, over i, is left out from d =
    /// `coupled` on.
    pub(super) fn coefficients(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        count: usize,
        coupled: usize,
        mut accept: impl FnMut(usize, usize, &[f64]),
    ) -> Result<()> {
        let offsets = self.classes.len();
        let mut table: [_; 3] = std::array::from_fn(|_| vec![0.0; CHUNK.min(count) * offsets]);
        let mut values = vec![0.0; self.waves()];
        for begin in (0..count).step_by(CHUNK) {
            let width = CHUNK.min(count - begin);
            // The first is the instantaneous coefficient, no part of the history.
            let skip = usize::from(begin == 0);
            for (offset, class) in self.classes.iter().enumerate() {
                let Some(class) = class else { continue };
                let of = offset * width + skip..(offset + 1) * width;
                let [normal, tangential, coupling] =
                    table.each_mut().map(|values| &mut values[of.clone()]);
                kernel.coefficients(*class, begin + skip + 1, [normal, tangential, coupling])?;
            }
            for d in begin + skip..begin + width {
                for (kind, table) in table.iter().enumerate() {
                    let odd = kind == 2;
                    if odd && d >= coupled {
                        continue;
                    }
                    self.real.fill(0.0);
                    for offset in 0..offsets {
                        let value = table[offset * width + d - begin];
                        self.real[offset] = if odd && offset == 0 { 0.0 } else { value };
                        if offset > 0 {
                            self.real[self.length - offset] = if odd { -value } else { value };
                        }
                    }
                    self.transform();
                    for (value, spectrum) in values.iter_mut().zip(&self.spectrum) {
                        *value = if odd { spectrum.im } else { spectrum.re };
                    }
                    accept(kind, d, &values);
                }
            }
        }
        Ok(())
    }
}

/// The smallest even number from `least` on with no prime factor above 5.
fn smooth(least: usize) -> usize {
    let is_smooth = |mut number: usize| {
        for factor in [2, 3, 5] {
            while number.is_multiple_of(factor) {
                number /= factor;
            }
        }
        number == 1
    };
    let mut length = least.max(2).next_multiple_of(2);
    while !is_smooth(length) {
        length += 2;
    }
    length
}
