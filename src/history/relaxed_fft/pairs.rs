//! Blocks over pairs of elements of any lengths and places.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use std::ops::Range;
use std::sync::Arc;

use realfft::num_complex::Complex64;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};

use super::blocks::{Extent, Space};
use super::level::Rows;
use super::level::{Convolution, KINDS, Level, Near, Part, Work, fill, forward, inverse, reserve};
use crate::error::Result;
use crate::history::convolution_weights::ConvolutionWeights;
use crate::history::pair_classes::{Pair, PairClasses};
use crate::linalg::{Simd, WithSimd, add_row, add_rows, vectorized};

/// A coupling that reaches no further ahead than this is summed directly. Times hardly depend on
/// it up to here; further on blocks are faster.
const DIRECT_COUPLING: usize = 64;

/// Frequencies that are multiplied together, so that all inputs and outputs stay in cache.
const TILE: usize = 64;

/// Pairs of a patch: their spectra, and the coefficients of a leaf, are series of d by class.
pub(super) struct Pairs {
    classes: Arc<PairClasses>,
    /// Steps of a leaf.
    leaf: usize,
    /// Per class: last d at which the coupling is not zero; the largest number if it never ends.
    reaches: Vec<usize>,
    /// The largest of them, where blocks have to look after the coupling.
    reach: usize,
    /// Last d at which the coupling is summed directly.
    direct: usize,
    planner: RealFftPlanner<f64>,
}

impl Pairs {
    /// Pairs of `kernel`. Beyond a leaf nothing may be summed directly where rows are `bounded`.
    pub(super) fn new(kernel: &dyn ConvolutionWeights, leaf: usize, bounded: bool) -> Result<Self> {
        let classes = Arc::new(kernel.classes().clone());
        let reach = |last: Option<usize>| last.map_or(usize::MAX, |lag| lag.saturating_sub(1));
        let reaches = (0..classes.count())
            .map(|class| Ok(reach(kernel.last_coupling_lag(class)?)))
            .collect::<Result<Vec<_>>>()?;
        let longest = reaches.iter().copied().max().unwrap_or(0);
        let is_direct = longest <= if bounded { 0 } else { DIRECT_COUPLING };
        let (reach, direct) = if is_direct { (0, longest) } else { (longest, leaf - 1) };
        Ok(Self { classes, leaf, reaches, reach, direct, planner: RealFftPlanner::new() })
    }
}

impl Space for Pairs {
    fn extent(&self) -> Extent {
        Extent {
            along_surface: false,
            width: self.classes.layout().len(),
            parts: 1,
            lags: self.leaf.max(self.direct + 1),
            ahead: self.direct,
            reach: self.reach,
        }
    }

    fn level(&mut self, size: usize, couples: bool) -> Level {
        let convolution = Products {
            classes: Arc::clone(&self.classes),
            forward: self.planner.plan_fft_forward(2 * size),
            inverse: self.planner.plan_fft_inverse(2 * size),
        };
        Level::new(size, self.classes.count(), couples, Box::new(convolution))
    }

    fn fill(
        &mut self,
        kernel: &dyn ConvolutionWeights,
        levels: &mut [Level],
        wanted: bool,
    ) -> Result<Near> {
        let far = levels.last().map_or(0, |level| 2 * level.size);
        let length = far.max(if wanted { self.extent().lags } else { 0 });
        let (mut near, mut work) = (Near::default(), Work::default());
        if length == 0 {
            return Ok(near);
        }
        let mut values = [(); KINDS].map(|()| vec![0.0; length]);
        for class in 0..self.classes.count() {
            // The first is the instantaneous coefficient, no part of the history.
            let [normal, tangential, coupling] = values.each_mut().map(|values| &mut values[1..]);
            kernel.coefficients(class, 2, [normal, tangential, coupling])?;
            let lengths = [self.leaf, self.leaf, self.direct + 1];
            for (kind, values) in values.iter().enumerate() {
                if wanted {
                    near[kind].extend(&values[..lengths[kind]]);
                }
                fill(levels, [kind, class], values, &mut self.planner, &mut work);
            }
        }
        Ok(near)
    }

    fn input(&mut self, traction: &[f64], input: &mut [f64]) {
        let given = traction.len().min(input.len());
        input[..given].copy_from_slice(&traction[..given]);
        input[given..].fill(0.0);
    }

    fn traction(&mut self, input: &[f64], traction: &mut [f64]) {
        traction.copy_from_slice(input);
    }

    fn work_in(&mut self, near: &Near, rows: &mut Rows, last: usize, input: &[f64]) {
        let ahead = self.leaf - 1 - last % self.leaf;
        let coupled = if self.reach > 0 { ahead } else { self.direct };
        vectorized(Scatter { pairs: self, near, rows, now: last + 1, input, ahead, coupled });
    }

    fn output(&mut self, _: &Near, rows: &Rows, now: usize, _: &[f64], out: &mut [f64]) {
        let place = rows.place(now);
        for (value, row) in out.iter_mut().zip(rows.values.chunks_exact(rows.stride)) {
            *value = row[place];
        }
    }
}

/// Adds what the input of the step before `now` gives to the rest of its leaf, `ahead` outputs, and its
/// coupling to `coupled` of them.
struct Scatter<'a> {
    pairs: &'a Pairs,
    near: &'a Near,
    rows: &'a mut Rows,
    now: usize,
    input: &'a [f64],
    ahead: usize,
    coupled: usize,
}

impl WithSimd for Scatter<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { pairs: Pairs { classes, leaf, reaches, direct, .. }, near, input, .. } = self;
        let (place, stride) = (self.rows.place(self.now - 1) + 1, self.rows.stride);
        let rows = &mut self.rows.values[..];
        let ahead = self.ahead;
        let [normal, tangential, coupling] = near;
        let count = classes.elements().len();
        for (p, pairs) in classes.pairs().chunks_exact(count).enumerate() {
            let scale = pairs[p].scale;
            for (row, table, other) in [(p, normal, 0), (count + p, tangential, count)] {
                let near = |pair: &Pair| &table[pair.class * leaf + 1..][..ahead];
                let (fours, ones) = pairs.as_chunks();
                let (inputs, others) = input[other..][..count].as_chunks();
                let output = &mut rows[row * stride + place..][..ahead];
                for ([a, b, c, d], inputs) in fours.iter().zip(inputs) {
                    let values = inputs.map(|input| scale * input);
                    add_rows(simd, values, [near(a), near(b), near(c), near(d)], output);
                }
                for (pair, input) in ones.iter().zip(others) {
                    add_row(simd, scale * input, near(pair), output);
                }
            }
            for (q, &Pair { class, sign, .. }) in pairs.iter().enumerate() {
                let reach = self.coupled.min(reaches[class]);
                if sign == 0.0 || reach == 0 {
                    continue;
                }
                let coupling = &coupling[class * (direct + 1)..][1..=reach];
                for (row, source, sign) in [(p, count + q, sign), (count + p, q, -sign)] {
                    let value = sign * scale * input[source];
                    let output = &mut rows[row * stride + place..][..reach];
                    add_row(simd, value, coupling, output);
                }
            }
        }
    }
}

/// Each component is transformed once per block; products are summed over the sources.
struct Products {
    classes: Arc<PairClasses>,
    forward: Arc<dyn RealToComplex<f64>>,
    inverse: Arc<dyn ComplexToReal<f64>>,
}

impl Convolution for Products {
    fn reserve(&self, level: &Level, work: &mut Work) {
        let components = self.classes.elements().len() * if level.has(2) { 2 } else { 1 };
        let scratch = self.forward.get_scratch_len().max(self.inverse.get_scratch_len());
        reserve(&mut work.real, 2 * level.size);
        reserve(&mut work.complex, components * (level.size + 1));
        reserve(&mut work.scratch, scratch);
        work.tiles.iter_mut().for_each(|tile| reserve(tile, components * 2 * TILE));
    }

    fn apply(&self, level: &Level, rows: &mut Rows, now: usize, part: Part, work: &mut Work) {
        let one = self.classes.elements().len();
        let all = 2 * one;
        match part {
            Part::Even => {
                self.convolve(level, rows, now, [0..one, 0..1], work);
                self.convolve(level, rows, now, [one..all, 1..2], work);
            }
            Part::Coupling => self.convolve(level, rows, now, [0..all, 2..3], work),
            Part::All => self.convolve(level, rows, now, [0..all, 0..3], work),
        }
    }
}

impl Products {
    /// The effect of some rows on each other by some kinds of coefficients.
    fn convolve(
        &self,
        level: &Level,
        rows: &mut Rows,
        now: usize,
        [components, kinds]: [Range<usize>; 2],
        work: &mut Work,
    ) {
        let (size, bins) = (level.size, level.size + 1);
        for (component, row) in components.clone().enumerate() {
            let real = &mut work.real[..2 * size];
            real[..size].copy_from_slice(rows.inputs(row, now, size));
            real[size..].fill(0.0);
            let spectrum = &mut work.complex[component * bins..][..bins];
            forward(&*self.forward, real, spectrum, &mut work.scratch);
        }
        self.multiply(level, components.len(), kinds, work);
        let count = self.classes.elements().len();
        for (component, row) in components.enumerate() {
            let receiver = self.classes.pairs()[component % count * count];
            let scale = receiver.scale / (2 * size) as f64;
            let real = &mut work.real[..2 * size];
            let spectrum = &mut work.complex[component * bins..][..bins];
            inverse(&*self.inverse, spectrum, real, &mut work.scratch);
            for (output, value) in rows.outputs(row, now, size).iter_mut().zip(&real[size..]) {
                *output += scale * value;
            }
        }
    }

    /// Replaces the spectra of inputs by those of outputs, tile by tile.
    fn multiply(&self, level: &Level, components: usize, kinds: Range<usize>, work: &mut Work) {
        let (bins, count) = (level.size + 1, self.classes.elements().len());
        let width = bins.div_ceil(bins.div_ceil(TILE));
        let Work { complex: spectra, tiles: [inputs, outputs], .. } = work;
        for begin in (0..bins).step_by(width) {
            let width = width.min(bins - begin);
            let of = |component: usize| component * 2 * width..(component + 1) * 2 * width;
            for component in 0..components {
                let (re, im) = inputs[of(component)].split_at_mut(width);
                let values = &spectra[component * bins + begin..][..width];
                for (value, (re, im)) in values.iter().zip(re.iter_mut().zip(im)) {
                    (*re, *im) = (value.re, value.im);
                }
            }
            outputs[..components * 2 * width].fill(0.0);
            let mut add = |sign: f64, [kind, class]: [usize; 2], source, receiver| {
                let factor = level.spectrum(kind, class, begin).map(|values| &values[..width]);
                let (output, input) = (&mut outputs[of(receiver)], &inputs[of(source)]);
                if sign > 0.0 {
                    vectorized(Product::<true> { output, factor, input });
                } else {
                    vectorized(Product::<false> { output, factor, input });
                }
            };
            for (p, pairs) in self.classes.pairs().chunks_exact(count).enumerate() {
                for (q, &Pair { class, sign, .. }) in pairs.iter().enumerate() {
                    for kind in kinds.clone() {
                        if kind < 2 {
                            let first = if components > count { kind * count } else { 0 };
                            add(1.0, [kind, class], first + q, first + p);
                        } else if sign != 0.0 {
                            add(sign, [kind, class], count + q, p);
                            add(-sign, [kind, class], q, count + p);
                        }
                    }
                }
            }
            for component in 0..components {
                let (re, im) = outputs[of(component)].split_at(width);
                let values = &mut spectra[component * bins + begin..][..width];
                for (value, (re, im)) in values.iter_mut().zip(re.iter().zip(im)) {
                    *value = Complex64::new(*re, *im);
                }
            }
        }
    }
}

/// Adds (or takes away) the product of two spectra, all as real parts before imaginary ones.
struct Product<'a, const PLUS: bool> {
    output: &'a mut [f64],
    factor: [&'a [f64]; 2],
    input: &'a [f64],
}
impl<const PLUS: bool> WithSimd for Product<'_, PLUS> {
    type Output = ();

    #[inline(always)]
    #[allow(clippy::inline_always, reason = "to be compiled for the instructions of its caller")]
    fn with_simd<S: Simd>(self, simd: S) {
        let width = self.output.len() / 2;
        let (out_re, out_im) = self.output.split_at_mut(width);
        let (in_re, in_im) = self.input.split_at(width);
        let [re, im] = self.factor.map(|values| &values[..width]);
        let (wide_re, tail_re) = S::as_mut_simd_f64s(out_re);
        let (wide_im, tail_im) = S::as_mut_simd_f64s(out_im);
        let [(a_re, a_re_tail), (a_im, a_im_tail)] = [re, im].map(S::as_simd_f64s);
        let [(b_re, b_re_tail), (b_im, b_im_tail)] = [in_re, &in_im[..width]].map(S::as_simd_f64s);
        let factors = a_re.iter().zip(a_im).zip(b_re.iter().zip(b_im));
        for ((x, y), ((a, b), (c, d))) in wide_re.iter_mut().zip(wide_im).zip(factors) {
            let minus = |value: S::f64s| simd.neg_f64s(value);
            let (a, b) = if PLUS { (*a, *b) } else { (minus(*a), minus(*b)) };
            *x = simd.mul_add_e_f64s(a, *c, simd.mul_add_e_f64s(minus(b), *d, *x));
            *y = simd.mul_add_e_f64s(a, *d, simd.mul_add_e_f64s(b, *c, *y));
        }
        let sign = if PLUS { 1.0 } else { -1.0 };
        for k in 0..tail_re.len() {
            let (a, b) = (sign * a_re_tail[k], sign * a_im_tail[k]);
            tail_re[k] += a * b_re_tail[k] - b * b_im_tail[k];
            tail_im[k] += a * b_im_tail[k] + b * b_re_tail[k];
        }
    }
}
