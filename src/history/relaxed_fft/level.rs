//! Blocks of one size: the spectra of the coefficients, and how they are multiplied.

use realfft::num_complex::Complex64;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};

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

/// Numbers of a cache line.
const LINE: usize = 8;

/// A row for each normal component, then one for each tangential one: inputs before the present step,
/// outputs as far as known from there on.
///
/// By itself, a step is an array of the same numbers: of each of the two kinds of components all real parts
/// before all imaginary ones, if they have any.
pub(super) struct Rows {
    pub(super) values: Vec<f64>,
    /// Length of a row.
    pub(super) stride: usize,
    /// Numbers of a step.
    width: usize,
    /// Numbers of a component: one, or a real and an imaginary part.
    parts: usize,
    /// Steps after which places are used again.
    period: usize,
}

impl Rows {
    /// For steps of `width` numbers, without room; places are used again after `period` steps.
    pub(super) fn new([width, parts]: [usize; 2], period: usize) -> Self {
        Self { values: Vec::new(), stride: 0, width, parts, period }
    }

    /// Makes room for at least `steps` steps.
    pub(super) fn lengthen(&mut self, steps: usize) {
        // An odd number of lines: else equal places of all rows fall into few sets of the cache.
        let stride = (steps * self.parts).next_multiple_of(2 * LINE) + LINE;
        let mut values = vec![0.0; self.width / self.parts * stride];
        let old = self.values.chunks_exact(self.stride.max(1));
        for (new, old) in values.chunks_exact_mut(stride).zip(old) {
            new[..self.stride].copy_from_slice(old);
        }
        (self.values, self.stride) = (values, stride);
    }

    /// Where in its row a step is.
    pub(super) fn place(&self, step: usize) -> usize {
        self.parts * if step < self.period { step } else { step % self.period }
    }

    /// Where the numbers of a step are, in the order of the step.
    fn places(&self, step: usize) -> impl Iterator<Item = usize> + use<> {
        let (begin, parts, stride) = (self.place(step), self.parts, self.stride);
        let count = self.width / (2 * parts);
        (0..2 * parts).flat_map(move |part| {
            let begin = part / parts * count * stride + begin + part % parts;
            (0..count).map(move |row| begin + row * stride)
        })
    }

    /// Numbers of `step`.
    pub(super) fn step(&self, step: usize) -> impl Iterator<Item = f64> {
        self.places(step).map(|place| self.values[place])
    }

    /// Overwrites what stands from step `begin` on, the multiple of a leaf, by the `steps` of one.
    pub(super) fn write(&mut self, begin: usize, steps: &[f64]) {
        for (number, place) in self.places(begin).enumerate() {
            let row = self.values[place..].iter_mut().step_by(self.parts);
            row.zip(steps.chunks_exact(self.width)).for_each(|(own, step)| *own = step[number]);
        }
    }

    /// Overwrites the `steps` of a leaf by what stands from step `begin` on.
    pub(super) fn read(&self, begin: usize, steps: &mut [f64]) {
        for (number, place) in self.places(begin).enumerate() {
            let row = self.values[place..].iter().step_by(self.parts);
            row.zip(steps.chunks_exact_mut(self.width)).for_each(|(own, step)| step[number] = *own);
        }
    }

    /// The `size` inputs before `now`, a block of their size.
    pub(super) fn inputs(&self, row: usize, now: usize, size: usize) -> &[f64] {
        &self.values[row * self.stride + self.place(now - size)..][..size * self.parts]
    }

    /// The `size` outputs from `now` on, or as many as there are.
    pub(super) fn outputs(&mut self, row: usize, now: usize, size: usize) -> &mut [f64] {
        let begin = self.place(now);
        let end = self.stride.min(begin + size * self.parts);
        &mut self.values[row * self.stride..][begin..end]
    }

    /// Clears the places of old inputs that outputs from `now` on take.
    pub(super) fn renew(&mut self, now: usize) {
        let half = self.period / 2;
        if now.is_multiple_of(half) {
            for row in 0..self.width / self.parts {
                self.outputs(row, now, half).fill(0.0);
            }
        }
    }
}
