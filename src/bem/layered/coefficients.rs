//! Convolution weights of a layered ground by Runge–Kutta convolution quadrature.
//!
//! The mobility Y(s) = s F(s) is discretised with the traction constant over all stages of a step, and the
//! stage velocities averaged with the weights b:
//!
//! (1−z) Ĝ(z) = Δt bᵀ Y(Δ(z)/Δt) 1 = Σ wⱼ λⱼ F(λⱼ/Δt),   Ĝ(z) = Σ Gⁿ zⁿ⁻¹
//!
//! The work of the tractions, Σ τⁿ·(sⁿ − sⁿ⁻¹), is then never negative if Herm Y ≥ 0 for Re s > 0 (Banjai &
//! Lubich 2019), for every time step, mesh, profile and passive damping law. The weights follow by fast
//! Fourier transform from a circle |z| = r of L points with rᴸ = ε: aliases have the size ε, and errors of F
//! grow like r⁻ⁿ (Lubich 1988).
//!
//! A panel of the circle is sampled only if a test predicts that it is resolved. The test replaces the mobility
//! by the surface compliance at a few wavenumbers, at a hundredth of the cost. This works because waves that
//! travel vertically carry the reflections, and their resonances are at the branch points of the mobility.
//! Resonances at other wavenumbers are smooth in the integral.
//!
//! Lags N+1 … 2N always use L = 4N, N a power of two, so that the bits of a lag depend on nothing else.

use std::ops::Range;
use std::sync::Arc;

use realfft::RealFftPlanner;

use super::contour::{
    Circle, CirclePanel, POINTS, Panels, Polynomials, evaluate, factor, own_classes,
};
use super::runge_kutta::{Node, Stages, on_circle};
use super::threads::on_threads;
use super::wavenumber::{Compliances, OUTLOOK, Wavenumbers};
use crate::error::{Error, Result, Watch};
use crate::history::{PairClasses, STRIP_KINDS};
use crate::linalg::Complex;
use crate::soil::SoilProfile;

/// Number of lags of the first block.
pub(crate) const FIRST: usize = 128;
/// Largest number of blocks: lags up to 2³¹.
pub(crate) const BLOCKS: usize = 25;
/// Number of points of the circle per N, for lags N+1 … 2N; the first block has 2N points.
const POINTS_PER_LAG: usize = 4;
/// Tolerance of the integrals relative to the tolerance of the weights: integration errors must not cause halving.
pub(crate) const FINER: f64 = 0.03;
/// A panel is sampled only if it is predicted as resolved to this multiple of the tolerance.
///
/// Half of the panels at this limit are resolved.
pub(super) const DOUBT: f64 = 100.0;

/// Weights of consecutive lags, for all classes.
#[derive(Debug)]
pub(crate) struct Block {
    /// One list of lags for each class and kind, class by class.
    pub(crate) values: Vec<Vec<f64>>,
}

impl Block {
    /// Number of the block that contains `lag` ≥ 1, and the position of the lag in it.
    pub(crate) fn place(lag: usize) -> (usize, usize) {
        let index = lag - 1;
        if index < FIRST {
            return (0, index);
        }
        let block = (index / FIRST).ilog2() as usize + 1;
        (block, index - (FIRST << (block - 1)))
    }

    /// Number of lags in block `number`.
    pub(crate) fn lags(number: usize) -> usize {
        FIRST << number.saturating_sub(1)
    }

    /// Circle for the transform of block `number`, for a relative accuracy of F.
    pub(crate) fn circle(number: usize, tolerance: f64) -> Circle {
        let length = POINTS_PER_LAG * Self::lags(number) / if number == 0 { 2 } else { 1 };
        Circle::new(length, tolerance)
    }

    /// The last lag in block `number`.
    pub(crate) fn last(number: usize) -> usize {
        FIRST << number
    }

    /// Weights of one class from position `place` to the block's end.
    pub(crate) fn from<const KINDS: usize>(&self, class: usize, place: usize) -> [&[f64]; KINDS] {
        std::array::from_fn(|kind| &self.values[class * KINDS + kind][place..])
    }
}

/// Progress of a block's samples, reported to its observer.
pub(crate) struct Samples<'w, 'a> {
    watch: &'w mut Watch<'a>,
    /// Expected numbers of samples up to the beginning of this block, and up to its end.
    expected: Range<usize>,
    /// Number of samples of this block made so far.
    done: usize,
}

impl<'w, 'a> Samples<'w, 'a> {
    pub(crate) fn new(watch: &'w mut Watch<'a>, expected: Range<usize>) -> Self {
        Self { watch, expected, done: 0 }
    }

    /// Reports `more` further samples to the observer.
    fn reach(&mut self, more: usize) -> Result<()> {
        let done = self.expected.start + self.done + more;
        self.watch.reach(done.min(self.expected.end))
    }

    /// Reports the block as complete, for any number of samples made.
    pub(crate) fn end(self) -> Result<()> {
        self.watch.reach(self.expected.end)
    }
}

/// Convolution quadrature: all data on which the weights depend.
#[derive(Debug)]
pub(crate) struct Quadrature<I = Wavenumbers, const KINDS: usize = STRIP_KINDS> {
    pub(crate) profile: SoilProfile,
    pub(crate) integrals: I,
    pub(crate) classes: usize,
    pub(crate) stages: Stages,
    pub(crate) time_step: f64,
    /// Relative accuracy of F.
    pub(crate) tolerance: f64,
    /// Panels for each eigenvalue.
    pub(crate) panels: Vec<Panels>,
}

impl Quadrature {
    pub(crate) fn new(
        profile: SoilProfile,
        classes: &PairClasses,
        stages: Stages,
        time_step: f64,
        tolerance: f64,
    ) -> Self {
        let integrals = Wavenumbers::new(classes, FINER * tolerance);
        Self::over(profile, integrals, own_classes(classes), stages, [time_step, tolerance])
    }
}

impl<I: Compliances<KINDS>, const KINDS: usize> Quadrature<I, KINDS> {
    /// Quadrature of the given integrals.
    ///
    /// `own` has, for each class, the classes of the pairs of its two elements with themselves.
    pub(crate) fn over(
        profile: SoilProfile,
        integrals: I,
        own: Vec<[usize; 2]>,
        stages: Stages,
        [time_step, tolerance]: [f64; 2],
    ) -> Self {
        let (classes, own) = (own.len(), Arc::from(own));
        let panels = (0..stages.count()).map(|_| Panels::new(&own)).collect();
        Self { profile, integrals, classes, stages, time_step, tolerance, panels }
    }

    /// Σ wⱼ λⱼ F(λⱼ/Δt) = (1−z) Ĝ(z) for all classes, at the z with the given ln |z| and angle.
    pub(crate) fn mobility(
        &self,
        place: [f64; 2],
        work: &mut I::Workspace,
        scratch: &mut [[Complex; KINDS]],
        sums: &mut [[Complex; KINDS]],
    ) -> Result<()> {
        sums.fill([Complex::default(); KINDS]);
        for node in self.nodes(place) {
            self.add(node, work, scratch, sums)?;
        }
        Ok(())
    }

    /// Eigenvalues and weights at the z with the given ln |z| and angle.
    pub(crate) fn nodes(&self, [logarithm, angle]: [f64; 2]) -> impl Iterator<Item = Node> {
        let [z, rest] = on_circle(logarithm, angle);
        self.stages.nodes(z, rest)
    }

    /// Adds the contribution of one sample to the mobility.
    pub(super) fn add(
        &self,
        node: Node,
        work: &mut I::Workspace,
        scratch: &mut [[Complex; KINDS]],
        sums: &mut [[Complex; KINDS]],
    ) -> Result<()> {
        self.integrals.compliance(&self.profile, self.variable(node), work, scratch)?;
        for (sum, value) in sums.iter_mut().zip(scratch.iter()) {
            for (sum, value) in sum.iter_mut().zip(value) {
                *sum += node.weight * *value;
            }
        }
        Ok(())
    }

    /// The Laplace variable of an eigenvalue, 1/s.
    pub(crate) fn variable(&self, node: Node) -> Complex {
        node.lambda.scale(1.0 / self.time_step)
    }

    /// Computes the weights of block `number` on `threads` threads.
    pub(crate) fn block(
        &self,
        number: usize,
        threads: usize,
        mut samples: Samples,
    ) -> Result<Block> {
        let lags = Block::lags(number);
        let first = if number == 0 { 0 } else { lags };
        let circle = Block::circle(number, self.tolerance);
        let Circle { length, logarithm } = circle;
        let spectra = self.spectra(circle, threads, &mut samples)?;
        // Factor 1/(1−z) from the mobility to the transform of Gⁿ.
        let over: Vec<_> = (0..circle.points())
            .map(|point| on_circle(logarithm, circle.angle(point))[1].inverse())
            .collect();
        let transform = RealFftPlanner::<f64>::new().plan_fft_inverse(length);
        let growth: Vec<_> =
            (first..first + lags).map(|n| (-logarithm * n as f64).exp() / length as f64).collect();
        let mut values = vec![vec![]; self.classes * KINDS];
        let turn = |buffers: &mut Option<_>, (row, lags): (&[Complex], &mut Vec<f64>)| {
            let (input, output, scratch) = buffers.get_or_insert_with(|| {
                let [input, scratch] = [transform.make_input_vec(), transform.make_scratch_vec()];
                (input, transform.make_output_vec(), scratch)
            });
            for (input, (value, over)) in input.iter_mut().zip(row.iter().zip(&over)) {
                // The transform has the opposite sign in its exponent.
                *input = (*value * *over).conj().inner();
            }
            // The values at both ends of the half circle are real.
            [input[0].im, input[length / 2].im] = [0.0; 2];
            transform.process_with_scratch(input, output, scratch).map_err(|_| {
                Error::Singular { matrix: "spectrum of convolution weights", order: length }
            })?;
            lags.extend(output[first..].iter().zip(&growth).map(|(value, scale)| value * scale));
            Ok(())
        };
        let rows = spectra.chunks_exact(circle.points()).zip(&mut values);
        on_threads(threads, rows, turn, |_| samples.reach(0))?;
        samples.end()?;
        Ok(Block { values })
    }

    /// Computes the mobility on the upper half of a circle: all points of one class and component, then the next.
    pub(super) fn spectra(
        &self,
        circle: Circle,
        threads: usize,
        samples: &mut Samples,
    ) -> Result<Vec<Complex>> {
        let (count, functions) = (circle.points(), self.classes * KINDS);
        let mut spectra = vec![];
        spectra.try_reserve_exact(count * functions).map_err(|_| Error::Input {
            quantity: "number of lags of a layered ground",
            value: count as f64,
            needed: "few enough for the memory of the machine",
        })?;
        for function in 1..=functions {
            // The allocation may take time.
            samples.reach(0)?;
            spectra.resize(count * function, Complex::default());
        }
        for (node, panels) in self.panels.iter().enumerate() {
            let (covering, alone) = circle.covered(node, |places| {
                self.sample(node, panels, places, threads, samples)?;
                Ok(places.iter().map(|place| panels.known(*place) == Some(true)).collect())
            })?;
            for place in covering {
                let Some(Some(panel)) = panels.stored().get(&place).cloned() else { continue };
                evaluate(node, &panel, place, circle, &mut spectra, || samples.reach(0))?;
            }
            let places = alone.iter().map(|point| [circle.logarithm, circle.angle(*point)]);
            let values = self.shares(node, &places.collect::<Vec<_>>(), threads, samples)?;
            for (function, row) in spectra.chunks_exact_mut(count).enumerate() {
                samples.reach(0)?;
                let values = values.as_flattened().iter().skip(function).step_by(functions);
                alone.iter().zip(values).for_each(|(point, value)| row[*point] += *value);
            }
        }
        Ok(spectra)
    }

    /// Largest number of samples of a block: all points of its circle, for each eigenvalue.
    pub(super) fn most_samples(&self, number: usize) -> usize {
        Block::circle(number, self.tolerance).points() * self.stages.count()
    }

    /// Largest memory of the first `blocks` blocks while the last is computed, bytes.
    pub(super) fn memory(&self, blocks: usize) -> f64 {
        let Some(last) = blocks.checked_sub(1) else { return 0.0 };
        let points = Block::circle(last, self.tolerance).points() as f64;
        let own = 8.0 * Block::last(last) as f64 + size_of::<Complex>() as f64 * points;
        own * (KINDS * self.classes) as f64
    }

    /// Returns a test: whether a panel is predicted as resolved to a given multiple of the tolerance.
    pub(super) fn looks(
        &self,
        node: usize,
        place: CirclePanel,
        work: &mut I::Workspace,
    ) -> Result<impl Fn(f64) -> bool> {
        let mut values = vec![];
        for point in place.places() {
            let over = factor(node, point).inverse();
            let Some(node) = self.nodes(point).nth(node) else { continue };
            let first = values.len();
            self.integrals.outlook(&self.profile, self.variable(node), work, &mut values)?;
            let weight = node.weight * over;
            values[first..].iter_mut().for_each(|value| *value = *value * weight);
        }
        let own: Vec<_> = (0..values.len() / (POINTS * OUTLOOK)).map(|place| [place; 2]).collect();
        let tolerance = self.tolerance;
        Ok(move |times| Polynomials::through::<OUTLOOK>(&values, &own, times * tolerance).is_some())
    }

    /// Samples those panels at `places` that are new and predicted as resolved.
    fn sample(
        &self,
        node: usize,
        panels: &Panels,
        places: &[CirclePanel],
        threads: usize,
        samples: &mut Samples,
    ) -> Result<()> {
        let (mut missing, mut work) = (vec![], I::Workspace::default());
        for place in places.iter().filter(|place| panels.known(**place).is_none()) {
            samples.reach(0)?;
            if self.looks(node, *place, &mut work)?(DOUBT) {
                missing.push(place);
            } else {
                panels.stored().insert(*place, None);
            }
        }
        let points: Vec<_> = missing.iter().flat_map(|place| place.places()).collect();
        let mut values = self.shares(node, &points, threads, samples)?;
        for (point, row) in points.iter().zip(values.chunks_mut(self.classes)) {
            let over = factor(node, *point).inverse();
            row.as_flattened_mut().iter_mut().for_each(|value| *value = *value * over);
        }
        let mut stored = panels.stored();
        for (place, values) in missing.into_iter().zip(values.chunks(POINTS * self.classes)) {
            let found =
                Polynomials::through::<KINDS>(values.as_flattened(), &panels.own, self.tolerance);
            stored.insert(*place, found.map(Arc::new));
        }
        Ok(())
    }

    /// Computes the contribution of an eigenvalue to the mobility at each ln |z| and angle, class by class.
    fn shares(
        &self,
        node: usize,
        places: &[[f64; 2]],
        threads: usize,
        samples: &mut Samples,
    ) -> Result<Vec<[Complex; KINDS]>> {
        let mut values = vec![[Complex::default(); KINDS]; places.len() * self.classes];
        let items = places.iter().zip(values.chunks_mut(self.classes));
        let add = |(work, scratch): &mut (_, Vec<_>), (place, sums): (&[f64; 2], &mut [_])| {
            scratch.resize(self.classes, [Complex::default(); KINDS]);
            let own = self.nodes(*place).nth(node);
            own.map_or(Ok(()), |node| self.add(node, work, scratch, sums))
        };
        on_threads(threads, items, add, |done| samples.reach(done))?;
        samples.done += places.len();
        Ok(values)
    }
}

#[cfg(test)]
mod tests;
