//! Blocks of one size over the wavenumbers of a lattice, and spectra that grounds share.

use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use super::level::{Level, Ring, Tables};
use crate::geometry::ContactElement;
use crate::history::exponentials::tail::Fit;
use realfft::RealFftPlanner;
use realfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};

/// Normal, tangential, coupling.
pub(super) const KINDS: usize = 3;

/// Per kind, d = 0 … leaf − 1 times the number of wavenumbers.
pub(super) type Near = [Vec<f64>; KINDS];

/// Effect of b inputs on the next b outputs, for each wavenumber by itself: one wavenumber's blocks
/// and spectra fit into cache.
pub(super) struct WaveLevel {
    /// b.
    pub(super) size: usize,
    forward: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
    /// Normal, tangential, coupling: per wavenumber, the b + 1 lower frequencies of 2b. The
    /// coefficients are real numbers in time, so that the others are conjugates; the coupling's
    /// stand for i times them. The last is empty where the coupling has died out within smaller
    /// blocks.
    spectra: [Vec<Complex<f64>>; KINDS],
}

/// Which components of the tractions move which.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Part {
    /// Pressures move down, shears along.
    Even,
    /// Each moves the other.
    Coupling,
    /// All of it.
    All,
}

impl WaveLevel {
    /// Blocks of `size`, without spectra yet.
    pub(super) fn new(
        size: usize,
        waves: usize,
        couples: bool,
        planner: &mut FftPlanner<f64>,
    ) -> Self {
        let length = waves * (size + 1);
        let spectrum = |length| vec![Complex::default(); length];
        Self {
            size,
            forward: planner.plan_fft_forward(2 * size),
            inverse: planner.plan_fft_inverse(2 * size),
            spectra: [length, length, if couples { length } else { 0 }].map(spectrum),
        }
    }

    /// Numbers held.
    pub(super) fn numbers(&self) -> usize {
        2 * self.spectra.iter().map(Vec::len).sum::<usize>()
    }

    /// Length of the scratch that transforms need.
    pub(super) fn scratch(&self) -> usize {
        let (forward, inverse) = (&self.forward, &self.inverse);
        forward.get_inplace_scratch_len().max(inverse.get_inplace_scratch_len())
    }

    /// Whether there are spectra of this kind.
    pub(super) fn has(&self, kind: usize) -> bool {
        !self.spectra[kind].is_empty()
    }

    /// Keeps the coefficients of d, one per wavenumber, in the place of the spectra.
    pub(super) fn keep(&mut self, kind: usize, d: usize, values: &[f64]) {
        let rows = self.spectra[kind].chunks_exact_mut(self.size + 1);
        if d.is_multiple_of(2) {
            rows.zip(values).for_each(|(row, value)| row[d / 2].re = *value);
        } else {
            rows.zip(values).for_each(|(row, value)| row[d / 2].im = *value);
        }
    }

    /// Overwrites `time` with the coefficients that are kept of a wavenumber.
    pub(super) fn kept(&self, kind: usize, wave: usize, time: &mut [f64]) {
        let row = &self.spectra[kind][wave * (self.size + 1)..][..self.size];
        for (pair, value) in time.chunks_exact_mut(2).zip(row) {
            pair.copy_from_slice(&[value.re, value.im]);
        }
    }

    /// Transforms 2b coefficients, which are overwritten as well, to the spectrum.
    pub(super) fn transform(
        &mut self,
        kind: usize,
        wave: usize,
        time: &mut [f64],
        planner: &mut RealFftPlanner<f64>,
        scratch: &mut Vec<Complex<f64>>,
    ) {
        let plan = planner.plan_fft_forward(2 * self.size);
        scratch.resize(scratch.len().max(plan.get_scratch_len()), Complex::default());
        let spectrum = &mut self.spectra[kind][wave * (self.size + 1)..][..=self.size];
        let scratch = &mut scratch[..plan.get_scratch_len()];
        // All lengths are the plan's own, so there is nothing that could fail.
        let done = plan.process_with_scratch(time, spectrum, scratch);
        debug_assert!(done.is_ok());
    }

    /// Adds what the b inputs before `now` give to the b outputs from there on, in all rows: one
    /// per wavenumber for the normal components, then as many for the tangential ones.
    pub(super) fn apply(
        &self,
        rows: &mut [Complex<f64>],
        stride: usize,
        (ring, now): (Ring, usize),
        part: Part,
        blocks: &mut [Complex<f64>],
        scratch: &mut [Complex<f64>],
    ) {
        let (size, bins) = (self.size, self.size + 1);
        // Rows may end before the block does.
        let (before, begin) = (ring.before(now, size), ring.place(now));
        let ahead = begin..stride.min(begin + size);
        let (normal, tangential) = rows.split_at_mut(rows.len() / 2);
        if part == Part::Even {
            // One component at a time: the largest blocks are the coupling's, or half as many.
            let block = &mut blocks[..2 * size];
            for (kind, rows) in [normal, tangential].into_iter().enumerate() {
                for (wave, row) in rows.chunks_exact_mut(stride).enumerate() {
                    self.take(&row[before.clone()], block, scratch);
                    multiply(block, &self.spectra[kind][wave * bins..][..bins]);
                    self.give(block, &mut row[ahead.clone()], scratch);
                }
            }
            return;
        }
        let (one, two) = blocks[..4 * size].split_at_mut(2 * size);
        let rows = normal.chunks_exact_mut(stride).zip(tangential.chunks_exact_mut(stride));
        for (wave, (normal, tangential)) in rows.enumerate() {
            let spectrum = |kind: usize| &self.spectra[kind][wave * bins..][..bins];
            self.take(&normal[before.clone()], one, scratch);
            self.take(&tangential[before.clone()], two, scratch);
            if part == Part::All {
                multiply_all(one, two, [spectrum(0), spectrum(1), spectrum(2)]);
            } else {
                exchange(one, two, spectrum(2));
            }
            self.give(one, &mut normal[ahead.clone()], scratch);
            self.give(two, &mut tangential[ahead.clone()], scratch);
        }
    }

    /// Transforms b inputs, as many zeros behind them.
    fn take(
        &self,
        inputs: &[Complex<f64>],
        block: &mut [Complex<f64>],
        scratch: &mut [Complex<f64>],
    ) {
        block[..self.size].copy_from_slice(inputs);
        block[self.size..].fill(Complex::default());
        self.forward.process_with_scratch(block, scratch);
    }

    /// Transforms back, and adds the later half to b outputs, or as many as there are.
    fn give(
        &self,
        block: &mut [Complex<f64>],
        outputs: &mut [Complex<f64>],
        scratch: &mut [Complex<f64>],
    ) {
        self.inverse.process_with_scratch(block, scratch);
        let scale = 0.5 / self.size as f64;
        for (output, value) in outputs.iter_mut().zip(&block[self.size..]) {
            *output += value.scale(scale);
        }
    }
}

/// The upper frequencies of a spectrum whose lower ones are given, from the lowest of them on.
fn upper(lower: &[Complex<f64>]) -> impl Iterator<Item = Complex<f64>> {
    lower[1..lower.len() - 1].iter().rev().map(Complex::conj)
}

fn multiply(block: &mut [Complex<f64>], spectrum: &[Complex<f64>]) {
    let (low, high) = block.split_at_mut(spectrum.len());
    for (value, factor) in low.iter_mut().zip(spectrum) {
        *value *= factor;
    }
    for (value, factor) in high.iter_mut().zip(upper(spectrum)) {
        *value *= factor;
    }
}

/// (p, s) ← (i c s, −i c p).
fn exchange(one: &mut [Complex<f64>], two: &mut [Complex<f64>], coupling: &[Complex<f64>]) {
    let all = coupling.iter().copied().chain(upper(coupling));
    for ((p, s), c) in one.iter_mut().zip(two).zip(all) {
        let c = Complex::new(-c.im, c.re);
        (*p, *s) = (c * *s, -c * *p);
    }
}

/// (p, s) ← (g p + i c s, h s − i c p).
fn multiply_all(one: &mut [Complex<f64>], two: &mut [Complex<f64>], spectra: [&[Complex<f64>]; 3]) {
    let [normal, tangential, coupling] = spectra;
    let multiply = |p: &mut Complex<f64>, s: &mut Complex<f64>, [g, h, c]: [Complex<f64>; 3]| {
        let c = Complex::new(-c.im, c.re);
        (*p, *s) = (g * *p + c * *s, h * *s - c * *p);
    };
    let bins = normal.len();
    let ((one, one_high), (two, two_high)) = (one.split_at_mut(bins), two.split_at_mut(bins));
    for k in 0..bins {
        multiply(&mut one[k], &mut two[k], [normal[k], tangential[k], coupling[k]]);
    }
    let factors = upper(normal).zip(upper(tangential)).zip(upper(coupling));
    for ((p, s), ((g, h), c)) in one_high.iter_mut().zip(two_high).zip(factors) {
        multiply(p, s, [g, h, c]);
    }
}

// Spectra of a kernel's coefficients, shared by its histories and made by the first that needs
// them.

/// Levels of blocks, from the smallest on, for leaves of one length.
pub(crate) struct Levels<L, N> {
    pub(super) levels: Vec<Arc<L>>,
    /// Coefficients of a leaf.
    pub(super) near: Option<Arc<N>>,
}

impl<L, N> Default for Levels<L, N> {
    fn default() -> Self {
        Self { levels: Vec::new(), near: None }
    }
}

/// Spectra of a kernel's coefficients, and exponentials for its late lags, for all histories of this
/// kernel and of its clones.
///
/// Clones are one and the same store. A [`ConvolutionWeights`](crate::history::ConvolutionWeights) keeps one beside
/// its coefficients and shows it in [`spectra`](crate::history::ConvolutionWeights::spectra).
#[derive(Clone, Default)]
pub struct SharedSpectra {
    stores: Arc<Stores>,
}

/// Levels of the usual leaves, by pairs and by wavenumbers.
#[derive(Default)]
struct Stores {
    /// Whose they are: set by the first history.
    elements: OnceLock<Vec<ContactElement>>,
    pairs: Mutex<Levels<Level, Tables>>,
    waves: Mutex<Levels<WaveLevel, Near>>,
    tails: Mutex<Vec<Windowed>>,
}

/// Tail behind a window, and the spectra of the window alone.
#[derive(Clone)]
pub(crate) struct Windowed {
    pub(crate) fit: Arc<Fit>,
    pub(crate) spectra: SharedSpectra,
}

/// Others wait while one makes what it lacks. A panic leaves levels complete or not there at all.
fn lock<T>(made: &Mutex<T>) -> MutexGuard<'_, T> {
    made.lock().unwrap_or_else(PoisonError::into_inner)
}

impl SharedSpectra {
    /// Whether these are spectra of this patch, or can become so.
    pub(crate) fn are_of(&self, elements: &[ContactElement]) -> bool {
        self.stores.elements.get_or_init(|| elements.to_vec()) == elements
    }

    pub(super) fn pairs(&self) -> MutexGuard<'_, Levels<Level, Tables>> {
        lock(&self.stores.pairs)
    }

    pub(super) fn waves(&self) -> MutexGuard<'_, Levels<WaveLevel, Near>> {
        lock(&self.stores.waves)
    }

    /// The tails made so far.
    pub(crate) fn tails(&self) -> MutexGuard<'_, Vec<Windowed>> {
        lock(&self.stores.tails)
    }

    /// Keeps a tail, unless another thread was first: then that one's is taken. Windows of one
    /// length share their spectra.
    pub(crate) fn keep(&self, fit: Arc<Fit>) -> Windowed {
        let mut tails = self.tails();
        if let Some(known) = tails.iter().find(|known| known.fit.request == fit.request) {
            return known.clone();
        }
        let same = tails.iter().find(|known| known.fit.request.lags == fit.request.lags);
        let spectra = same.map_or_else(Self::default, |known| known.spectra.clone());
        let new = Windowed { fit, spectra };
        tails.push(new.clone());
        new
    }
}

impl fmt::Debug for SharedSpectra {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SharedSpectra").finish_non_exhaustive()
    }
}
