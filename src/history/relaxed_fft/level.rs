//! Blocks of one size: the spectra of the coefficients, and how they are multiplied.

use realfft::num_complex::Complex64;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};

use super::rows::Rows;

/// Normal, tangential, coupling.
pub(super) const KINDS: usize = 3;

/// Coefficients that are summed directly, per kind, as a [`Space`](super::blocks::Space) orders them.
///
/// Index d of a coefficient is the number of steps from the traction to the first step that sees
/// it as history: lag d + 1 of the kernel. The first of all, d = 0, is zero.
pub(super) type Near = [Vec<f64>; KINDS];

/// Which components of the tractions move which.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Part {
    /// Pressure moves down, shear along.
    Even,
    /// Each moves the other.
    Coupling,
    /// All of it.
    All,
}

/// Transforms of blocks of one size, and the products between them.
pub(super) trait Convolution: Send + Sync {
    /// Makes room in `work` for blocks of `level`.
    fn reserve(&self, level: &Level, work: &mut Work);

    /// Adds what the b inputs before `now` give to the b outputs from there on.
    fn apply(&self, level: &Level, rows: &mut Rows, now: usize, part: Part, work: &mut Work);
}

/// Effect of b inputs on the next b outputs: convolutions of length 2b.
pub(super) struct Level {
    /// b.
    pub(super) size: usize,
    /// Per kind and series of coefficients, over 2b: b + 1 real parts, then as many imaginary ones.
    /// The coupling's are empty where it has died out within smaller blocks.
    spectra: [Vec<f64>; KINDS],
    pub(super) convolution: Box<dyn Convolution>,
}

impl Level {
    /// Blocks of `size` for so many series of coefficients, all of them zero yet.
    pub(super) fn new(
        size: usize,
        series: usize,
        couples: bool,
        convolution: Box<dyn Convolution>,
    ) -> Self {
        let length = 2 * (size + 1) * series;
        let spectra = [length, length, if couples { length } else { 0 }];
        Self { size, spectra: spectra.map(|length| vec![0.0; length]), convolution }
    }

    /// Numbers held.
    pub(super) fn numbers(&self) -> usize {
        self.spectra.iter().map(Vec::len).sum()
    }

    /// Whether there are spectra of this kind.
    pub(super) fn has(&self, kind: usize) -> bool {
        !self.spectra[kind].is_empty()
    }

    /// Real and imaginary parts of a spectrum, from its `begin`-th frequency on.
    pub(super) fn spectrum(&self, kind: usize, series: usize, begin: usize) -> [&[f64]; 2] {
        let (bins, spectra) = (self.size + 1, &self.spectra[kind]);
        [2 * series, 2 * series + 1].map(|part| &spectra[part * bins + begin..])
    }

    /// Where a spectrum will be, and until then its 2b coefficients may.
    pub(super) fn place(&mut self, kind: usize, series: usize) -> &mut [f64] {
        let length = 2 * (self.size + 1);
        &mut self.spectra[kind][length * series..][..length]
    }
}

/// Scratch of blocks.
#[derive(Default)]
pub(super) struct Work {
    pub(super) real: Vec<f64>,
    pub(super) complex: Vec<Complex64>,
    pub(super) scratch: Vec<Complex64>,
    /// Of inputs and of outputs: a few frequencies of each, real parts before imaginary ones.
    pub(super) tiles: [Vec<f64>; 2],
}

impl Work {
    /// Real numbers held.
    pub(super) fn numbers(&self) -> usize {
        let tiles: usize = self.tiles.iter().map(Vec::len).sum();
        self.real.len() + tiles + 2 * (self.complex.len() + self.scratch.len())
    }
}

/// Makes room for at least `length` values.
pub(super) fn reserve<T: Clone + Default>(values: &mut Vec<T>, length: usize) {
    values.resize(values.len().max(length), T::default());
}

/// Puts the spectra of one series of coefficients into all `levels` that have its kind.
pub(super) fn fill(
    levels: &mut [Level],
    [kind, series]: [usize; 2],
    coefficients: &[f64],
    planner: &mut RealFftPlanner<f64>,
    work: &mut Work,
) {
    for level in levels.iter_mut().filter(|level| level.has(kind)) {
        let (length, bins) = (2 * level.size, level.size + 1);
        let plan = planner.plan_fft_forward(length);
        reserve(&mut work.real, length);
        reserve(&mut work.complex, bins);
        reserve(&mut work.scratch, plan.get_scratch_len());
        let (real, spectrum) = (&mut work.real[..length], &mut work.complex[..bins]);
        real.copy_from_slice(&coefficients[..length]);
        forward(&*plan, real, spectrum, &mut work.scratch);
        let (re, im) = level.place(kind, series).split_at_mut(bins);
        for (value, (re, im)) in spectrum.iter().zip(re.iter_mut().zip(im)) {
            (*re, *im) = (value.re, value.im);
        }
    }
}

/// Transform of `real`, which is overwritten as well.
pub(super) fn forward(
    plan: &dyn RealToComplex<f64>,
    real: &mut [f64],
    spectrum: &mut [Complex64],
    scratch: &mut [Complex64],
) {
    // All lengths are the plan's own, so there is nothing that could fail.
    let done = plan.process_with_scratch(real, spectrum, scratch);
    debug_assert!(done.is_ok());
}

/// Transform of a spectrum, which is overwritten as well, to an even number of values.
pub(super) fn inverse(
    plan: &dyn ComplexToReal<f64>,
    spectrum: &mut [Complex64],
    real: &mut [f64],
    scratch: &mut [Complex64],
) {
    // Real up to rounding, and the transform insists on it.
    let last = spectrum.len() - 1;
    (spectrum[0].im, spectrum[last].im) = (0.0, 0.0);
    let done = plan.process_with_scratch(spectrum, real, scratch);
    debug_assert!(done.is_ok());
}
