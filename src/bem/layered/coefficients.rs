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

use basemat_fourier::RealPlanner;

use super::block_file::LagBlock;
use super::contour::{
    CHEBYSHEV_POINTS, Circle, CirclePanel, PanelPolynomials, Panels, panel_factor,
    self_pair_classes,
};
use super::panel_evaluation::evaluate;
use super::runge_kutta::{CirclePoint, Node, Stages, on_circle};
use super::threads::on_threads;
use super::wavenumber::{Compliances, SURROGATE_COMPONENTS, Wavenumbers};
use crate::error::{Error, ProgressReporter, Result};
use crate::history::{PairClasses, STRIP_KINDS};
use crate::linalg::Complex;
use crate::soil::SoilProfile;

/// Tolerance of the integrals relative to the tolerance of the weights: integration errors must not cause halving.
pub(crate) const INTEGRAL_TOLERANCE_FACTOR: f64 = 0.03;
/// A panel is sampled only if it is predicted as resolved to this multiple of the tolerance.
///
/// Half of the panels at this limit are resolved.
pub(super) const SAMPLING_TOLERANCE_FACTOR: f64 = 100.0;

/// Progress of a block's samples, reported to its observer.
pub(crate) struct Samples<'w, 'a> {
    watch: &'w mut ProgressReporter<'a>,
    /// Expected numbers of samples up to the beginning of this block, and up to its end.
    expected: Range<usize>,
    /// Number of samples of this block made so far.
    done: usize,
}

impl<'w, 'a> Samples<'w, 'a> {
    /// No samples yet of a block with these `expected` numbers.
    pub(crate) fn new(watch: &'w mut ProgressReporter<'a>, expected: Range<usize>) -> Self {
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
    /// Element compliances F(s).
    pub(crate) integrals: I,
    /// Number of classes of pairs.
    pub(crate) classes: usize,
    pub(crate) stages: Stages,
    /// s.
    pub(crate) time_step: f64,
    /// Relative accuracy of F.
    pub(crate) tolerance: f64,
    /// Panels for each eigenvalue.
    pub(crate) panels: Vec<Panels>,
}

impl Quadrature {
    /// Quadrature for the pairs of elements of a patch.
    pub(crate) fn new(
        profile: SoilProfile,
        classes: &PairClasses,
        stages: Stages,
        time_step: f64,
        tolerance: f64,
    ) -> Self {
        let integrals = Wavenumbers::new(classes, INTEGRAL_TOLERANCE_FACTOR * tolerance);
        let self_pairs = self_pair_classes(classes);
        Self::over(profile, integrals, self_pairs, stages, time_step, tolerance)
    }
}

impl<I: Compliances<KINDS>, const KINDS: usize> Quadrature<I, KINDS> {
    /// Quadrature of any `integrals`.
    ///
    /// `self_pairs` has, for each class, the classes of the pairs of its two elements with themselves.
    pub(crate) fn over(
        profile: SoilProfile,
        integrals: I,
        self_pairs: Vec<[usize; 2]>,
        stages: Stages,
        time_step: f64,
        tolerance: f64,
    ) -> Self {
        let classes = self_pairs.len();
        let self_pairs = Arc::from(self_pairs);
        let panels = (0..stages.count()).map(|_| Panels::new(&self_pairs)).collect();
        Self { profile, integrals, classes, stages, time_step, tolerance, panels }
    }

    /// Overwrites `sums` with the mobility of all classes, Σ wⱼ λⱼ F(λⱼ/Δt) = (1−z) Ĝ(z).
    ///
    /// `log_z`: ln |z| and angle.
    pub(crate) fn mobility(
        &self,
        log_z: [f64; 2],
        work: &mut I::Workspace,
        scratch: &mut [[Complex; KINDS]],
        sums: &mut [[Complex; KINDS]],
    ) -> Result<()> {
        sums.fill([Complex::default(); KINDS]);
        for node in self.nodes(log_z) {
            self.add_sample(node, work, scratch, sums)?;
        }
        Ok(())
    }

    /// Eigenvalues and weights at a z.
    pub(crate) fn nodes(&self, log_z: [f64; 2]) -> impl Iterator<Item = Node> {
        let CirclePoint { z, one_less_z } = on_circle(log_z[0], log_z[1]);
        self.stages.nodes(z, one_less_z)
    }

    /// Adds the contribution of one sample to the mobility.
    pub(super) fn add_sample(
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
    ) -> Result<LagBlock> {
        let lags = LagBlock::lags(number);
        let first = if number == 0 { 0 } else { lags };
        let circle = LagBlock::circle(number, self.tolerance);
        let Circle { length, logarithm } = circle;
        let spectra = self.spectra(circle, threads, &mut samples)?;
        // Factor 1/(1−z) from the mobility to the transform of Gⁿ.
        let inverse_rest: Vec<_> = (0..circle.points())
            .map(|point| on_circle(logarithm, circle.angle(point)).one_less_z.inverse())
            .collect();
        let transform = RealPlanner::new().plan_fft_inverse(length);
        // r⁻ⁿ/L.
        let scales: Vec<_> = (first..first + lags)
            .map(|n| (-logarithm * n as f64).exp() / length as f64)
            .collect();
        let mut values = vec![vec![]; self.classes * KINDS];
        let transform_row = |buffers: &mut Option<_>, (row, lags): (&[Complex], &mut Vec<f64>)| {
            let (input, output, scratch) = buffers.get_or_insert_with(|| {
                let input = transform.make_input_vec();
                let scratch = transform.make_scratch_vec();
                (input, transform.make_output_vec(), scratch)
            });
            for (input, (value, factor)) in input.iter_mut().zip(row.iter().zip(&inverse_rest)) {
                // The transform has the opposite sign in its exponent.
                *input = (*value * *factor).conj().inner();
            }
            // The values at both ends of the half circle are real.
            input[0].im = 0.0;
            input[length / 2].im = 0.0;
            transform.process_with_scratch(input, output, scratch).map_err(|_| {
                Error::Singular { matrix: "spectrum of convolution weights", order: length }
            })?;
            lags.extend(output[first..].iter().zip(&scales).map(|(value, scale)| value * scale));
            Ok(())
        };
        let rows = spectra.chunks_exact(circle.points()).zip(&mut values);
        on_threads(threads, rows, transform_row, |_| samples.reach(0))?;
        samples.end()?;
        Ok(LagBlock { values })
    }

    /// Computes the mobility on the upper half of a circle: all points of one class and component, then the next.
    pub(super) fn spectra(
        &self,
        circle: Circle,
        threads: usize,
        samples: &mut Samples,
    ) -> Result<Vec<Complex>> {
        let count = circle.points();
        let functions = self.classes * KINDS;
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
            let cover = circle.cover(node, |candidates| {
                self.sample_panels(node, panels, candidates, threads, samples)?;
                let are_resolved =
                    candidates.iter().map(|panel| panels.is_resolved(*panel) == Some(true));
                Ok(are_resolved.collect())
            })?;
            for panel in cover.panels {
                let Some(Some(polynomials)) = panels.stored().get(&panel).cloned() else {
                    continue;
                };
                evaluate(node, &polynomials, panel, circle, &mut spectra, || samples.reach(0))?;
            }
            let mut points = Vec::with_capacity(cover.points.len());
            for point in &cover.points {
                points.push([circle.logarithm, circle.angle(*point)]);
            }
            let values = self.contributions(node, &points, threads, samples)?;
            for (function, row) in spectra.chunks_exact_mut(count).enumerate() {
                samples.reach(0)?;
                let values = values.as_flattened().iter().skip(function).step_by(functions);
                for (point, value) in cover.points.iter().zip(values) {
                    row[*point] += *value;
                }
            }
        }
        Ok(spectra)
    }

    /// Largest number of samples of a block: all points of its circle, for each eigenvalue.
    pub(super) fn max_samples(&self, number: usize) -> usize {
        LagBlock::circle(number, self.tolerance).points() * self.stages.count()
    }

    /// Largest memory of the first `blocks` blocks while the last is computed, bytes.
    pub(super) fn memory(&self, blocks: usize) -> f64 {
        let Some(last) = blocks.checked_sub(1) else { return 0.0 };
        let points = LagBlock::circle(last, self.tolerance).points() as f64;
        let bytes_per_function =
            8.0 * LagBlock::last_lag(last) as f64 + size_of::<Complex>() as f64 * points;
        bytes_per_function * (KINDS * self.classes) as f64
    }

    /// Whether a panel is predicted as resolved to a multiple `factor` of the tolerance.
    pub(super) fn is_promising(
        &self,
        node: usize,
        panel: CirclePanel,
        factor: f64,
        work: &mut I::Workspace,
    ) -> Result<bool> {
        let mut values = vec![];
        for point in panel.chebyshev_points() {
            let inverse_factor = panel_factor(node, point).inverse();
            let Some(node) = self.nodes(point).nth(node) else { continue };
            let first = values.len();
            self.integrals.append_surrogate(
                &self.profile,
                self.variable(node),
                work,
                &mut values,
            )?;
            let weight = node.weight * inverse_factor;
            for value in &mut values[first..] {
                *value = *value * weight;
            }
        }
        let count = values.len() / (CHEBYSHEV_POINTS * SURROGATE_COMPONENTS);
        // Each function is compared with itself.
        let self_pairs: Vec<_> = (0..count).map(|function| [function; 2]).collect();
        let tolerance = factor * self.tolerance;
        let polynomials =
            PanelPolynomials::through::<SURROGATE_COMPONENTS>(&values, &self_pairs, tolerance);
        Ok(polynomials.is_some())
    }

    /// Samples those `candidates` that are new and predicted as resolved.
    fn sample_panels(
        &self,
        node: usize,
        panels: &Panels,
        candidates: &[CirclePanel],
        threads: usize,
        samples: &mut Samples,
    ) -> Result<()> {
        let mut missing = vec![];
        let mut work = I::Workspace::default();
        for panel in candidates.iter().filter(|panel| panels.is_resolved(**panel).is_none()) {
            samples.reach(0)?;
            if self.is_promising(node, *panel, SAMPLING_TOLERANCE_FACTOR, &mut work)? {
                missing.push(panel);
            } else {
                panels.stored().insert(*panel, None);
            }
        }
        let points: Vec<_> = missing.iter().flat_map(|panel| panel.chebyshev_points()).collect();
        let mut values = self.contributions(node, &points, threads, samples)?;
        for (point, row) in points.iter().zip(values.chunks_mut(self.classes)) {
            let inverse_factor = panel_factor(node, *point).inverse();
            for value in row.as_flattened_mut() {
                *value = *value * inverse_factor;
            }
        }
        let mut stored = panels.stored();
        let rows = values.chunks(CHEBYSHEV_POINTS * self.classes);
        for (panel, values) in missing.into_iter().zip(rows) {
            let polynomials = PanelPolynomials::through::<KINDS>(
                values.as_flattened(),
                &panels.self_pairs,
                self.tolerance,
            );
            stored.insert(*panel, polynomials.map(Arc::new));
        }
        Ok(())
    }

    /// Computes the contribution of an eigenvalue to the mobility at points ln |z|, angle; class by class.
    fn contributions(
        &self,
        node: usize,
        points: &[[f64; 2]],
        threads: usize,
        samples: &mut Samples,
    ) -> Result<Vec<[Complex; KINDS]>> {
        let mut values = vec![[Complex::default(); KINDS]; points.len() * self.classes];
        let items = points.iter().zip(values.chunks_mut(self.classes));
        let add_sample = |(work, scratch): &mut (_, Vec<_>),
                          (point, sums): (&[f64; 2], &mut [_])| {
            scratch.resize(self.classes, [Complex::default(); KINDS]);
            match self.nodes(*point).nth(node) {
                Some(node) => self.add_sample(node, work, scratch, sums),
                None => Ok(()),
            }
        };
        on_threads(threads, items, add_sample, |done| samples.reach(done))?;
        samples.done += points.len();
        Ok(values)
    }
}

#[cfg(test)]
mod tests;
