//! Compliances of the cells of a lattice by integrals over the wavenumber.
//!
//! C is the surface compliance of a profile, `C_rr` along the wavenumber and `C_tt` normal to it. g are the
//! [form factors](super::forms). Integrals over receiver and source are
//!
//! | series | 2π × |
//! |---|---|
//! | `F_zz` | ∫ `C_zz` g₀ k dk |
//! | `F_xx`, `F_yy` | ∫ (`C_rr` `g_cc` + `C_tt` `g_ss`) k dk, ∫ (`C_rr` `g_ss` + `C_tt` `g_cc`) k dk |
//! | `F_xy` | ∫ (`C_rr` − `C_tt`) `g_cs` k dk |
//! | `F_zx`, `F_zy` | −∫ `C_zr` `g_c` k dk, −∫ `C_zr` `g_s` k dk (down due to shear) |
//!
//! The static part, the half-space of the top layer, is integrated in closed form. The dynamic part, k times the
//! difference, is integrated up to K, and by its series beyond K. Panels are halved until the dynamic part is a
//! polynomial on each. Values on halves enter through Legendre moments over the whole panel, so that forms need no
//! further evaluation. For Re s > 0 no pole lies on the axis, and k = 0 needs no regularisation.

use super::form_table::{FormRows, FormTable, TAIL_TERMS};
use super::forms::FORM_COUNT;
use crate::bem::layered::{
    Compliances, LEGENDRE_DEGREES, LayeredCompliance, PANEL_POINTS, PANEL_TOLERANCE_EXPONENT,
    ROUNDING_FLOOR_FACTOR, SurfaceCompliance, SurrogateLengths, by_halves, last_coefficients,
    legendre, median, surface_series, top_layer_wavenumber, unresolved,
};
use crate::error::{GroundError, ProgressReporter, Result};
use crate::geometry::{COMPLIANCES_PER_OFFSET, Lattice};
use crate::linalg::Complex;
use crate::soil::SoilProfile;

/// Number of components of the surface compliance: zz, rr, tt and zr.
const KERNEL_COUNT: usize = 4;
/// Surface compliance minus its static part, times k; or moments of this difference.
type CellKernel = [Complex; KERNEL_COUNT];

/// For each form: its first series, and the factors of the kernels in this series and in the next.
///
/// The series zz, xx, yy, xy, zx and zy have two indices each, for real and imaginary parts.
const KERNEL_FACTORS: [(usize, &[[f64; KERNEL_COUNT]]); FORM_COUNT] = [
    (0, &[[1.0, 0.0, 0.0, 0.0]]),
    (2, &[[0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]),
    (2, &[[0.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 0.0]]),
    (6, &[[0.0, 1.0, -1.0, 0.0]]),
    (8, &[[0.0, 0.0, 0.0, -1.0]]),
    (10, &[[0.0, 0.0, 0.0, -1.0]]),
];

/// Integrals over the wavenumber for the cells of a lattice.
#[derive(Debug)]
pub(in crate::bem) struct CellIntegrals {
    pub(super) table: FormTable,
    /// Shorter side of a cell, m.
    pub(super) shorter_side: f64,
    /// Accuracy, relative to the displacement of a cell due to a traction on itself.
    pub(super) tolerance: f64,
}

/// Buffers of one thread.
#[derive(Debug, Default)]
pub(crate) struct CellWorkspace {
    ground: LayeredCompliance,
    panels: PanelBuffers,
}

/// Buffers for the panels of successive integrals.
#[derive(Debug, Default)]
struct PanelBuffers {
    /// Kernels at all points, times the weights of the points.
    kernels: Vec<CellKernel>,
    /// Kernels at the points of each panel.
    samples: Vec<[CellKernel; PANEL_POINTS]>,
    /// Stack of [`by_halves`].
    stack: Vec<(f64, f64, u32)>,
    /// Weights of the rows of a form.
    weights: Vec<f64>,
    /// 2π × the integrals: series by series, real and imaginary parts, all classes.
    sums: Vec<f64>,
    /// Number of evaluations of C.
    evaluation_count: usize,
}

/// Kernels of the ground at one Laplace variable, without their static parts.
struct DynamicKernel<'a> {
    ground: &'a mut LayeredCompliance,
    /// Kernel k C of the top layer's half-space at s = 0.
    static_kernel: CellKernel,
}

impl DynamicKernel<'_> {
    /// Kernels at the wavenumber `k`.
    fn at(&mut self, k: f64) -> CellKernel {
        let SurfaceCompliance { xx, zz, xz } = self.ground.at(k);
        let compliances = [zz, xx, self.ground.transverse(), xz];
        std::array::from_fn(|i| compliances[i].scale(k) - self.static_kernel[i])
    }
}

/// Coefficients dⱼ of the kernels' series at large wavenumbers, for zz, rr, tt and zr.
///
/// C = Σ dⱼ (q₂/k²)ʲ/(μk) in the half-space of the top layer; `a2`: (c₂/c₁)².
fn kernel_series(a2: f64) -> [[f64; KERNEL_COUNT]; TAIL_TERMS] {
    let plane_series = surface_series(a2);
    let mut tt = 1.0;
    std::array::from_fn(|j| {
        let term = [plane_series[1][j], plane_series[0][j], tt, plane_series[2][j]];
        // Binomial series of (1 + x)^(−½).
        tt *= -(j as f64 + 0.5) / (j as f64 + 1.0);
        term
    })
}

/// Compliances zz, xx, yy, xy, zx and zy of each class, m³/Pa × m.
impl Compliances<COMPLIANCES_PER_OFFSET> for CellIntegrals {
    type Workspace = CellWorkspace;

    /// Upper bound of the factors 0.4 to 4.8 of 8 × 8 cells on a half-space and on a damped layer.
    ///
    /// They were computed for two time steps, tolerances of 1e-13 to 1e-10, and up to 32 768 lags.
    const LATE_ERROR_FACTOR: f64 = 5.0;

    fn make_ready(&self, progress: &mut ProgressReporter) -> Result<()> {
        self.table.tabulate(progress)
    }

    fn compliance(
        &self,
        profile: &SoilProfile,
        s: Complex,
        workspace: &mut CellWorkspace,
        values: &mut [[Complex; COMPLIANCES_PER_OFFSET]],
    ) -> Result<()> {
        let CellWorkspace { ground, panels } = workspace;
        ground.set(profile, s)?;
        self.integrate(ground, s, panels)?;
        let class_count = self.table.class_count;
        let factor = 0.5 * std::f64::consts::FRAC_1_PI;
        for (class, class_values) in values.iter_mut().enumerate() {
            for (series, value) in class_values.iter_mut().enumerate() {
                let re = panels.sums[2 * series * class_count + class];
                let im = panels.sums[(2 * series + 1) * class_count + class];
                *value = Complex::new(factor * re, factor * im);
            }
        }
        Ok(())
    }

    fn surrogate_lengths(&self) -> SurrogateLengths {
        SurrogateLengths { min_element_length: self.shorter_side, span: self.table.span() }
    }

    fn surface_compliance(workspace: &mut CellWorkspace) -> &mut LayeredCompliance {
        &mut workspace.ground
    }

    fn count_evaluations(workspace: &mut CellWorkspace, evaluation_count: usize) {
        workspace.panels.evaluation_count += evaluation_count;
    }
}

impl CellIntegrals {
    /// Integrals for `profile` at some Laplace `variables`.
    ///
    /// `tolerance` is relative to the displacement of a cell due to a traction on itself.
    ///
    /// # Errors
    /// [`Error::Stopped`](crate::Error::Stopped); as for [`CellIntegrals::untabulated`].
    pub(super) fn new(
        lattice: &Lattice,
        profile: &SoilProfile,
        variables: impl IntoIterator<Item = Complex>,
        tolerance: f64,
        progress: &mut ProgressReporter,
    ) -> Result<Self> {
        let integrals = Self::untabulated(lattice, profile, variables, tolerance)?;
        integrals.table.tabulate(progress)?;
        Ok(integrals)
    }

    /// Integrals without tabulated forms; [`Compliances::make_ready`] tabulates them.
    ///
    /// # Errors
    /// As for [`SoilProfile::moduli`]; [`GroundError::TooFine`]; [`Error::Memory`](crate::Error::Memory).
    pub(super) fn untabulated(
        lattice: &Lattice,
        profile: &SoilProfile,
        variables: impl IntoIterator<Item = Complex>,
        tolerance: f64,
    ) -> Result<Self> {
        let mut ground = LayeredCompliance::default();
        let mut max_root = 0.0_f64;
        for s in variables {
            ground.set(profile, s)?;
            max_root = max_root.max(ground.root());
        }
        let table = FormTable::new(lattice, max_root, top_layer_wavenumber(profile))?;
        Ok(Self { table, shorter_side: lattice.shorter_side(), tolerance })
    }

    /// Overwrites `buffers.sums` with 2π × the integrals: series by series, real and imaginary parts, all classes.
    fn integrate(
        &self,
        ground: &mut LayeredCompliance,
        s: Complex,
        buffers: &mut PanelBuffers,
    ) -> Result<()> {
        let top = ground.top();
        let series = kernel_series(top.a2);
        let top_compliance = top.modulus.inverse();
        let panel_count = self.table.panels_to_k(ground.root());
        let Some([values, tail]) = self.table.tabulated_forms(panel_count) else {
            let width = self.table.panel_width;
            let span = self.table.span();
            let wavenumber = panel_count as f64 * width;
            let most = self.table.panel_count as f64 * width;
            return Err(GroundError::TooFine { span, wavenumber, most }.into());
        };
        buffers.sums.clear();
        buffers.sums.resize(2 * COMPLIANCES_PER_OFFSET * self.table.class_count, 0.0);
        let ratio = top.q2.scale(self.table.wavenumber_scale().powi(-2));
        let mut power = top_compliance;
        buffers.kernels.clear();
        for term in series {
            buffers.kernels.push(term.map(|d| power.scale(d)));
            power = power * ratio;
        }
        self.add_products(tail, buffers);
        let static_kernel = series[0].map(|d| top_compliance.scale(d));
        let mut dynamic = DynamicKernel { ground, static_kernel };
        self.integrate_panels(panel_count, buffers, &mut dynamic, &mut |panel, buffers| {
            self.add_products(panel.map_or(values, |panel| self.table.legendre(panel)), buffers);
        })
        .map_err(|wavenumber| unresolved(s, wavenumber))
    }

    /// Calls `use_kernels` with kernels at the points of all panels up to K, and with moments of each halved panel.
    ///
    /// # Errors
    /// The wavenumber at which halving stopped without success.
    fn integrate_panels(
        &self,
        panel_count: usize,
        buffers: &mut PanelBuffers,
        dynamic: &mut DynamicKernel,
        use_kernels: &mut dyn FnMut(Option<usize>, &mut PanelBuffers),
    ) -> std::result::Result<(), f64> {
        let width = self.table.panel_width;
        let half_width = 0.5 * self.table.panel_width;
        buffers.samples.clear();
        let mut integral_magnitude = 0.0;
        for panel in 0..panel_count {
            let start = panel as f64 * width;
            let samples = self.kernel_samples(start, width, dynamic);
            let magnitude = median(samples.map(|c| c[0].abs() + c[1].abs()));
            integral_magnitude += half_width
                * self.relative_form_magnitude(start + half_width)
                * (magnitude + dynamic.static_kernel[0].abs());
            buffers.samples.push(samples);
        }
        buffers.evaluation_count += PANEL_POINTS * panel_count;
        let max_error = self.tolerance.powf(PANEL_TOLERANCE_EXPONENT) * integral_magnitude;
        let mut unresolved_panels = vec![];
        buffers.kernels.clear();
        for panel in 0..panel_count {
            let samples = &buffers.samples[panel];
            let start = panel as f64 * width;
            if self.is_resolved(samples, dynamic, start, width, max_error) {
                for (sample, weight) in samples.iter().zip(&self.table.rule.weights) {
                    buffers.kernels.push(sample.map(|c| c.scale(half_width * weight)));
                }
            } else {
                unresolved_panels.push(panel);
                buffers.kernels.extend([CellKernel::default(); PANEL_POINTS]);
            }
        }
        use_kernels(None, buffers);
        for panel in unresolved_panels {
            self.halve_panel(panel, max_error, buffers, dynamic)?;
            use_kernels(Some(panel), buffers);
        }
        Ok(())
    }

    /// Estimated ratio of the forms at a wavenumber to the forms at zero.
    fn relative_form_magnitude(&self, k: f64) -> f64 {
        (2.0 / (k * self.shorter_side)).powi(2).min(1.0)
    }

    /// Kernels at the Gauss points of a panel.
    fn kernel_samples(
        &self,
        start: f64,
        width: f64,
        dynamic: &mut DynamicKernel,
    ) -> [CellKernel; PANEL_POINTS] {
        std::array::from_fn(|i| dynamic.at(start + 0.5 * width * (1.0 + self.table.rule.nodes[i])))
    }

    /// Whether the last two Legendre coefficients are small enough on a panel or a part of it.
    fn is_resolved(
        &self,
        samples: &[CellKernel; PANEL_POINTS],
        dynamic: &DynamicKernel,
        start: f64,
        width: f64,
        max_error: f64,
    ) -> bool {
        let rule = &self.table.rule;
        let polynomials = &self.table.polynomials;
        let Some(error) = last_coefficients(samples.iter().copied(), rule, polynomials) else {
            return false;
        };
        let mut largest_square = 0.0_f64;
        for sample in samples {
            for (value, static_value) in sample.iter().zip(dynamic.static_kernel) {
                largest_square = largest_square.max((*value + static_value).squared_modulus());
            }
        }
        error * width * self.relative_form_magnitude(start) <= max_error
            || error <= ROUNDING_FLOOR_FACTOR * largest_square.sqrt()
    }

    /// Overwrites `buffers.kernels` with the moments ∫ C Pₙ dk over one panel, by halves.
    fn halve_panel(
        &self,
        panel: usize,
        max_error: f64,
        buffers: &mut PanelBuffers,
        dynamic: &mut DynamicKernel,
    ) -> std::result::Result<(), f64> {
        let panel_width = self.table.panel_width;
        let panel_range = [panel_width * panel as f64, panel_width];
        let PanelBuffers { kernels, stack, evaluation_count, .. } = buffers;
        kernels.clear();
        kernels.resize(LEGENDRE_DEGREES, CellKernel::default());
        let sample_part = |start: f64, width: f64| {
            *evaluation_count += PANEL_POINTS;
            let samples = self.kernel_samples(start, width, dynamic);
            let is_resolved = self.is_resolved(&samples, dynamic, start, width, max_error);
            (samples, is_resolved)
        };
        by_halves(panel_range, stack, sample_part, |[part_start, part_size], width, samples| {
            for (sample, (x, weight)) in
                samples.iter().zip(self.table.rule.points_on_unit_interval())
            {
                let polynomials = legendre(2.0 * (part_start + part_size * x) - 1.0);
                for (moments, polynomial) in kernels.iter_mut().zip(polynomials) {
                    for (moment, value) in moments.iter_mut().zip(sample) {
                        *moment += value.scale(width * weight * polynomial);
                    }
                }
            }
        })
    }

    /// Adds Σ kernel × forms over the first rows of `rows` to the sums.
    fn add_products(&self, rows: &FormRows, buffers: &mut PanelBuffers) {
        let PanelBuffers { kernels, weights, sums, .. } = buffers;
        for (form, (first_series, series_factors)) in KERNEL_FACTORS.into_iter().enumerate() {
            weights.clear();
            for kernel in &*kernels {
                for factors in series_factors {
                    let mut sum = Complex::default();
                    for (value, factor) in kernel.iter().zip(factors) {
                        sum += value.scale(*factor);
                    }
                    weights.extend([sum.re, sum.im]);
                }
            }
            let class_count = self.table.class_count;
            let end_series = first_series + 2 * series_factors.len();
            let form_sums = &mut sums[first_series * class_count..end_series * class_count];
            rows.combine(form, weights, form_sums);
        }
    }
}

#[cfg(test)]
mod tests;
