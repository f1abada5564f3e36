//! Convolution weights of a layered ground by Runge–Kutta convolution quadrature.
//!
//! The mobility Y(s) = s F(s) is discretised with a traction that is constant over all stages of a step. The stage
//! velocities are averaged with the weights b:
//!
//! (1−z) Ĝ(z) = Δt bᵀ Y(Δ(z)/Δt) 1 = Σ wⱼ λⱼ F(λⱼ/Δt),   Ĝ(z) = Σ Gⁿ zⁿ⁻¹
//!
//! The work of the tractions, Σ τⁿ·(sⁿ − sⁿ⁻¹), is then never negative if Herm Y ≥ 0 for Re s > 0 (Banjai &
//! Lubich 2019), for every time step, mesh, profile and passive damping law. The weights follow by fast Fourier
//! transform from a circle |z| = r of L points with rᴸ = ε. Aliases have the magnitude ε, and errors of F grow like r⁻ⁿ
//! (Lubich 1988).
//!
//! A panel of the circle is sampled only if a test predicts that it is resolved. The test uses a surrogate of the
//! mobility: the surface compliance at a few wavenumbers, in a hundredth of the time. The prediction is reliable because
//! reflections are vertical waves, whose resonances are the branch points of the mobility. Resonances at other
//! wavenumbers are smooth in the integral.
//!
//! Lags N+1 … 2N always use L = 4N, N a power of two, so that the bits of a weight depend only on its lag.

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

/// Tolerance of the integrals relative to that of the weights, so that integration errors do not halve panels.
pub(crate) const INTEGRAL_TOLERANCE_FACTOR: f64 = 0.03;
/// Multiple of the tolerance to which a panel must be predicted as resolved to be sampled.
///
/// Half of the panels at this limit are resolved.
pub(super) const SAMPLING_TOLERANCE_FACTOR: f64 = 100.0;

/// Progress of a block's samples, reported to its observer.
pub(crate) struct SampleProgress<'w, 'a> {
    reporter: &'w mut ProgressReporter<'a>,
    /// Expected numbers of samples at the start of this block and at its end.
    expected_range: Range<usize>,
    /// Number of computed samples of this block.
    computed_count: usize,
}

impl<'w, 'a> SampleProgress<'w, 'a> {
    /// Progress of a block without samples; `expected_range`: expected numbers of samples at its start and at its end.
    pub(crate) fn new(
        reporter: &'w mut ProgressReporter<'a>,
        expected_range: Range<usize>,
    ) -> Self {
        Self { reporter, expected_range, computed_count: 0 }
    }

    /// Reports the computed samples and `additional_count` further samples.
    fn reach(&mut self, additional_count: usize) -> Result<()> {
        let count = self.expected_range.start + self.computed_count + additional_count;
        self.reporter.reach(count.min(self.expected_range.end))
    }

    /// Reports the block as complete, with any number of samples.
    pub(crate) fn end(self) -> Result<()> {
        self.reporter.reach(self.expected_range.end)
    }
}

/// Convolution quadrature of a layered ground: all data on which its weights depend.
#[derive(Debug)]
pub(crate) struct Quadrature<I = Wavenumbers, const KINDS: usize = STRIP_KINDS> {
    pub(crate) profile: SoilProfile,
    /// Element compliances F(s).
    pub(crate) integrals: I,
    /// Number of classes of pairs.
    pub(crate) class_count: usize,
    pub(crate) stages: Stages,
    /// Time step, s.
    pub(crate) time_step: f64,
    /// Relative accuracy of F.
    pub(crate) tolerance: f64,
    /// Tested panels of each eigenvalue.
    pub(crate) panels: Vec<Panels>,
}

impl Quadrature {
    /// Quadrature for the pairs of elements of strips.
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
    /// Creates a quadrature for any `integrals`.
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
        let class_count = self_pairs.len();
        let shared_pairs = Arc::from(self_pairs);
        let panels = (0..stages.count()).map(|_| Panels::new(&shared_pairs)).collect();
        Self { profile, integrals, class_count, stages, time_step, tolerance, panels }
    }

    /// Overwrites `sums` with the mobility of all classes, Σ wⱼ λⱼ F(λⱼ/Δt) = (1−z) Ĝ(z).
    ///
    /// `log_z`: ln |z| and angle; `compliances`: a buffer for one F.
    pub(crate) fn mobility(
        &self,
        log_z: [f64; 2],
        workspace: &mut I::Workspace,
        compliances: &mut [[Complex; KINDS]],
        sums: &mut [[Complex; KINDS]],
    ) -> Result<()> {
        sums.fill([Complex::default(); KINDS]);
        for node in self.nodes(log_z) {
            self.add_sample(node, workspace, compliances, sums)?;
        }
        Ok(())
    }

    /// Eigenvalues of Δ(z) and their weights; `log_z`: ln |z| and angle.
    pub(crate) fn nodes(&self, log_z: [f64; 2]) -> impl Iterator<Item = Node> {
        let CirclePoint { z, one_less_z } = on_circle(log_z[0], log_z[1]);
        self.stages.nodes(z, one_less_z)
    }

    /// Adds the contribution of one sample to the mobility.
    pub(super) fn add_sample(
        &self,
        node: Node,
        workspace: &mut I::Workspace,
        compliances: &mut [[Complex; KINDS]],
        sums: &mut [[Complex; KINDS]],
    ) -> Result<()> {
        self.integrals
            .compliance(&self.profile, self.variable(node), workspace, compliances)?;
        for (class_sums, class_compliances) in sums.iter_mut().zip(compliances.iter()) {
            for (sum, compliance) in class_sums.iter_mut().zip(class_compliances) {
                *sum += node.weight * *compliance;
            }
        }
        Ok(())
    }

    /// Laplace variable of an eigenvalue, 1/s.
    pub(crate) fn variable(&self, node: Node) -> Complex {
        node.lambda.scale(1.0 / self.time_step)
    }

    /// Computes the weights of the block `block_index` on `thread_count` threads.
    pub(crate) fn block(
        &self,
        block_index: usize,
        thread_count: usize,
        mut progress: SampleProgress,
    ) -> Result<LagBlock> {
        let lag_count = LagBlock::lag_count(block_index);
        let first_index = if block_index == 0 { 0 } else { lag_count };
        let circle = LagBlock::circle(block_index, self.tolerance);
        let Circle { point_count, log_radius } = circle;
        let spectra = self.spectra(circle, thread_count, &mut progress)?;
        // Factor 1/(1−z) from the mobility to the transform of Gⁿ.
        let transform_factors: Vec<_> = (0..circle.half_circle_points())
            .map(|point| on_circle(log_radius, circle.angle(point)).one_less_z.inverse())
            .collect();
        let transform = RealPlanner::new().plan_fft_inverse(point_count);
        // Factor r⁻ⁿ/L of each lag.
        let scales: Vec<_> = (first_index..first_index + lag_count)
            .map(|n| (-log_radius * n as f64).exp() / point_count as f64)
            .collect();
        let mut values = vec![vec![]; self.class_count * KINDS];
        let transform_row = |buffers: &mut Option<_>, (row, lags): (&[Complex], &mut Vec<f64>)| {
            let (input, output, scratch) = buffers.get_or_insert_with(|| {
                let input = transform.make_input_vec();
                let scratch = transform.make_scratch_vec();
                (input, transform.make_output_vec(), scratch)
            });
            for (input, (value, factor)) in input.iter_mut().zip(row.iter().zip(&transform_factors))
            {
                // The exponent of the transform has the opposite sign.
                *input = (*value * *factor).conj().to_complex64();
            }
            // The values at both ends of the half circle are real.
            input[0].im = 0.0;
            input[point_count / 2].im = 0.0;
            transform.process_with_scratch(input, output, scratch).map_err(|_| {
                Error::Singular { matrix: "spectrum of convolution weights", order: point_count }
            })?;
            let scaled_values = output[first_index..].iter().zip(&scales);
            lags.extend(scaled_values.map(|(value, scale)| value * scale));
            Ok(())
        };
        let rows = spectra.chunks_exact(circle.half_circle_points()).zip(&mut values);
        on_threads(thread_count, rows, transform_row, |_| progress.reach(0))?;
        progress.end()?;
        Ok(LagBlock { values })
    }

    /// Computes the mobility on the upper half of a circle: all points of one class and component, then the next.
    pub(super) fn spectra(
        &self,
        circle: Circle,
        thread_count: usize,
        progress: &mut SampleProgress,
    ) -> Result<Vec<Complex>> {
        let point_count = circle.half_circle_points();
        let function_count = self.class_count * KINDS;
        let mut spectra = vec![];
        spectra.try_reserve_exact(point_count * function_count).map_err(|_| Error::Input {
            quantity: "number of lags of a layered ground",
            value: point_count as f64,
            needed: "few enough for the memory of the machine",
        })?;
        for row_count in 1..=function_count {
            // Each report lets the observer stop the run, because the allocation may take time.
            progress.reach(0)?;
            spectra.resize(point_count * row_count, Complex::default());
        }
        for (node, panels) in self.panels.iter().enumerate() {
            let cover = circle.cover(node, |candidates| {
                self.sample_panels(node, panels, candidates, thread_count, progress)?;
                let are_resolved =
                    candidates.iter().map(|panel| panels.is_resolved(*panel) == Some(true));
                Ok(are_resolved.collect())
            })?;
            for panel in cover.panels {
                let Some(Some(polynomials)) = panels.stored().get(&panel).cloned() else {
                    continue;
                };
                let report = || progress.reach(0);
                evaluate(node, &polynomials, panel, circle, &mut spectra, report)?;
            }
            let mut log_points = Vec::with_capacity(cover.points.len());
            for point in &cover.points {
                log_points.push([circle.log_radius, circle.angle(*point)]);
            }
            let values = self.contributions(node, &log_points, thread_count, progress)?;
            for (function, row) in spectra.chunks_exact_mut(point_count).enumerate() {
                progress.reach(0)?;
                let function_values =
                    values.as_flattened().iter().skip(function).step_by(function_count);
                for (point, value) in cover.points.iter().zip(function_values) {
                    row[*point] += *value;
                }
            }
        }
        Ok(spectra)
    }

    /// Largest number of samples of a block: all points of its circle, for each eigenvalue.
    pub(super) fn max_samples(&self, block_index: usize) -> usize {
        LagBlock::circle(block_index, self.tolerance).half_circle_points() * self.stages.count()
    }

    /// Largest memory of the first `block_count` blocks during the computation of the last block, bytes.
    pub(super) fn memory_bytes(&self, block_count: usize) -> f64 {
        let Some(last) = block_count.checked_sub(1) else { return 0.0 };
        let point_count = LagBlock::circle(last, self.tolerance).half_circle_points() as f64;
        let bytes_per_function =
            8.0 * LagBlock::last_lag(last) as f64 + size_of::<Complex>() as f64 * point_count;
        bytes_per_function * (KINDS * self.class_count) as f64
    }

    /// Whether the surrogate predicts that a panel is resolved to a multiple `factor` of the tolerance.
    pub(super) fn is_predicted_resolved(
        &self,
        node: usize,
        panel: CirclePanel,
        factor: f64,
        workspace: &mut I::Workspace,
    ) -> Result<bool> {
        let mut values = vec![];
        for log_z in panel.chebyshev_points() {
            let inverse_factor = panel_factor(node, log_z).inverse();
            let Some(node) = self.nodes(log_z).nth(node) else { continue };
            let start = values.len();
            self.integrals.append_surrogate(
                &self.profile,
                self.variable(node),
                workspace,
                &mut values,
            )?;
            let weight = node.weight * inverse_factor;
            for value in &mut values[start..] {
                *value = *value * weight;
            }
        }
        let wavenumber_count = values.len() / (CHEBYSHEV_POINTS * SURROGATE_COMPONENTS);
        // Each function is compared with itself.
        let self_pairs: Vec<_> = (0..wavenumber_count).map(|function| [function; 2]).collect();
        let tolerance = factor * self.tolerance;
        let polynomials =
            PanelPolynomials::through::<SURROGATE_COMPONENTS>(&values, &self_pairs, tolerance);
        Ok(polynomials.is_some())
    }

    /// Samples all new `candidates` that are predicted as resolved.
    fn sample_panels(
        &self,
        node: usize,
        panels: &Panels,
        candidates: &[CirclePanel],
        thread_count: usize,
        progress: &mut SampleProgress,
    ) -> Result<()> {
        let mut sampled_panels = vec![];
        let mut workspace = I::Workspace::default();
        for panel in candidates.iter().filter(|panel| panels.is_resolved(**panel).is_none()) {
            progress.reach(0)?;
            if self.is_predicted_resolved(
                node,
                *panel,
                SAMPLING_TOLERANCE_FACTOR,
                &mut workspace,
            )? {
                sampled_panels.push(panel);
            } else {
                panels.stored().insert(*panel, None);
            }
        }
        let log_points: Vec<_> =
            sampled_panels.iter().flat_map(|panel| panel.chebyshev_points()).collect();
        let mut values = self.contributions(node, &log_points, thread_count, progress)?;
        for (log_z, point_values) in log_points.iter().zip(values.chunks_mut(self.class_count)) {
            let inverse_factor = panel_factor(node, *log_z).inverse();
            for value in point_values.as_flattened_mut() {
                *value = *value * inverse_factor;
            }
        }
        let mut stored = panels.stored();
        let values_by_panel = values.chunks(CHEBYSHEV_POINTS * self.class_count);
        for (panel, panel_values) in sampled_panels.into_iter().zip(values_by_panel) {
            let polynomials = PanelPolynomials::through::<KINDS>(
                panel_values.as_flattened(),
                &panels.self_pairs,
                self.tolerance,
            );
            stored.insert(*panel, polynomials.map(Arc::new));
        }
        Ok(())
    }

    /// Computes the contribution of an eigenvalue to the mobility at points of z, class by class.
    ///
    /// `log_points`: ln |z| and angle of each point.
    fn contributions(
        &self,
        node: usize,
        log_points: &[[f64; 2]],
        thread_count: usize,
        progress: &mut SampleProgress,
    ) -> Result<Vec<[Complex; KINDS]>> {
        let mut values = vec![[Complex::default(); KINDS]; log_points.len() * self.class_count];
        let items = log_points.iter().zip(values.chunks_mut(self.class_count));
        let add_sample = |(workspace, compliances): &mut (_, Vec<_>),
                          (log_z, sums): (&[f64; 2], &mut [_])| {
            compliances.resize(self.class_count, [Complex::default(); KINDS]);
            match self.nodes(*log_z).nth(node) {
                Some(node) => self.add_sample(node, workspace, compliances, sums),
                None => Ok(()),
            }
        };
        on_threads(thread_count, items, add_sample, |completed| progress.reach(completed))?;
        progress.computed_count += log_points.len();
        Ok(values)
    }
}

#[cfg(test)]
mod tests;
