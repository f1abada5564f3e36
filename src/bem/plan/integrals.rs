//! Compliances of the cells of a lattice by integrals over the wavenumber.
//!
//! With C the surface compliance of a profile (`C_rr` along the wavenumber, `C_tt` across it) and g the
//! [means](super::forms) over its direction, integrals over receiver and source are
//!
//! | series | 2π × |
//! |---|---|
//! | `F_zz` | ∫ `C_zz` g₀ k dk |
//! | `F_xx`, `F_yy` | ∫ (`C_rr` `g_cc` + `C_tt` `g_ss`) k dk, ∫ (`C_rr` `g_ss` + `C_tt` `g_cc`) k dk |
//! | `F_xy` | ∫ (`C_rr` − `C_tt`) `g_cs` k dk |
//! | `F_zx`, `F_zy` | −∫ `C_zr` `g_c` k dk, −∫ `C_zr` `g_s` k dk (down due to shear) |
//!
//! The static part of the top layer's half-space is integrated in closed form. k times the rest is integrated up
//! to K, beyond which its series is used. Panels are halved until the rest is a polynomial. The values on halves
//! reach the cells through Legendre moments over the whole panel, so that only C is evaluated more often. For Re s
//! > 0 no pole lies on the axis, and k = 0 needs no regularisation.

use super::form_table::{FormRows, FormTable, TAIL_TERMS};
use super::forms::FORM_COUNT;
use crate::bem::layered::{
    Compliances, LEGENDRE_DEGREES, LayeredCompliance, PANEL_POINTS, PANEL_TOLERANCE_EXPONENT,
    ROUNDING_FLOOR_FACTOR, SurfaceCompliance, by_halves, deep, last_coefficients, legendre, median,
    surface_outlook, surface_series, unresolved,
};
use crate::error::{GroundError, Result, Watch};
use crate::geometry::{Lattice, SERIES_PER_OFFSET};
use crate::linalg::Complex;
use crate::soil::SoilProfile;

/// Number of kernels: zz, rr, tt and zr.
const KERNEL_COUNT: usize = 4;
/// C minus its static value, times k; or moments of it.
type CellKernel = [Complex; KERNEL_COUNT];

/// For each form: the first series to which it contributes, and the factor of each kernel there and in the next.
///
/// Series count twice, for real and imaginary parts: zz, xx, yy, xy, zx, zy.
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
    pub(super) finest: f64,
    pub(super) tolerance: f64,
}

/// Buffers of one thread.
#[derive(Debug, Default)]
pub(crate) struct CellWorkspace {
    ground: LayeredCompliance,
    panels: PanelBuffers,
}

/// Buffers for the panels of one integral after the other.
#[derive(Debug, Default)]
struct PanelBuffers {
    /// Kernels at all points, with their weights.
    kernels: Vec<CellKernel>,
    samples: Vec<[CellKernel; PANEL_POINTS]>,
    stack: Vec<(f64, f64, u32)>,
    weights: Vec<f64>,
    sums: Vec<f64>,
    /// Number of evaluations of C so far.
    evaluations: usize,
}

/// Kernels of the ground at one Laplace variable, without their static values.
struct DynamicKernel<'a> {
    ground: &'a mut LayeredCompliance,
    /// k C at s = 0.
    static_kernel: CellKernel,
}

impl DynamicKernel<'_> {
    /// The kernels at the wavenumber `k`.
    fn at(&mut self, k: f64) -> CellKernel {
        let SurfaceCompliance { xx, zz, xz } = self.ground.at(k);
        let all = [zz, xx, self.ground.across(), xz];
        std::array::from_fn(|i| all[i].scale(k) - self.static_kernel[i])
    }
}

/// Coefficients of the kernels' series at large wavenumbers: zz, rr, tt, zr.
///
/// dⱼ of C = Σ dⱼ (q₂/k²)ʲ/(μk) in the half-space of the top layer.
fn kernel_series(a2: f64) -> [[f64; KERNEL_COUNT]; TAIL_TERMS] {
    let in_plane = surface_series(a2);
    let mut tt = 1.0;
    std::array::from_fn(|j| {
        let term = [in_plane[1][j], in_plane[0][j], tt, in_plane[2][j]];
        // (1 + x)^(−½).
        tt *= -(j as f64 + 0.5) / (j as f64 + 1.0);
        term
    })
}

/// Compliances zz, xx, yy, xy, zx and zy of each class, m³/Pa × m.
impl Compliances<SERIES_PER_OFFSET> for CellIntegrals {
    type Workspace = CellWorkspace;

    /// Errors are 0.4 to 4.8 with 8 × 8 cells on a half-space and a damped layer, two time steps, tolerances of 1e-13
    /// to 1e-10, and up to 32 768 lags.
    const LATE_ERROR_FACTOR: f64 = 5.0;

    fn make_ready(&self, progress: &mut Watch) -> Result<()> {
        self.table.tabulate(progress)
    }

    fn compliance(
        &self,
        profile: &SoilProfile,
        s: Complex,
        work: &mut CellWorkspace,
        values: &mut [[Complex; SERIES_PER_OFFSET]],
    ) -> Result<()> {
        let CellWorkspace { ground, panels } = work;
        ground.set(profile, s)?;
        self.integrate(ground, s, panels)?;
        let classes = self.table.classes;
        let unit = 0.5 * std::f64::consts::FRAC_1_PI;
        for (class, values) in values.iter_mut().enumerate() {
            for (series, value) in values.iter_mut().enumerate() {
                let re = panels.sums[2 * series * classes + class];
                let im = panels.sums[(2 * series + 1) * classes + class];
                *value = Complex::new(unit * re, unit * im);
            }
        }
        Ok(())
    }

    fn outlook(
        &self,
        profile: &SoilProfile,
        s: Complex,
        work: &mut CellWorkspace,
        values: &mut Vec<Complex>,
    ) -> Result<()> {
        work.ground.set(profile, s)?;
        let sizes = [self.finest, self.table.span()];
        work.panels.evaluations += surface_outlook(profile, &mut work.ground, sizes, values);
        Ok(())
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
        progress: &mut Watch,
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
        let mut largest_root = 0.0_f64;
        for s in variables {
            ground.set(profile, s)?;
            largest_root = largest_root.max(ground.root());
        }
        let table = FormTable::new(lattice, largest_root, deep(profile))?;
        Ok(Self { table, finest: lattice.shorter_side(), tolerance })
    }

    /// Overwrites `work.sums` with 2π × the integrals: series by series, real and imaginary parts, all classes.
    fn integrate(
        &self,
        ground: &mut LayeredCompliance,
        s: Complex,
        work: &mut PanelBuffers,
    ) -> Result<()> {
        let top = ground.top();
        let series = kernel_series(top.a2);
        let softness = top.modulus.inverse();
        let panels = self.table.panels(ground.root());
        let Some([values, tail]) = self.table.tabulated(panels) else {
            let width = self.table.width;
            let span = self.table.span();
            let wavenumber = panels as f64 * width;
            let most = self.table.panel_count as f64 * width;
            return Err(GroundError::TooFine { span, wavenumber, most }.into());
        };
        work.sums.clear();
        work.sums.resize(2 * SERIES_PER_OFFSET * self.table.classes, 0.0);
        let ratio = top.q2.scale(self.table.unit().powi(-2));
        let mut power = softness;
        work.kernels.clear();
        for term in series {
            work.kernels.push(term.map(|d| power.scale(d)));
            power = power * ratio;
        }
        self.add_products(tail, work);
        let static_kernel = series[0].map(|d| softness.scale(d));
        let mut dynamic = DynamicKernel { ground, static_kernel };
        self.integrate_panels(panels, work, &mut dynamic, &mut |panel, work| {
            self.add_products(panel.map_or(values, |panel| self.table.legendre(panel)), work);
        })
        .map_err(|wavenumber| unresolved(s, wavenumber))
    }

    /// Calls `take` with kernels at the points of all panels up to K, and with moments of each halved panel.
    ///
    /// Returns as an error the wavenumber at which halving stopped without success.
    fn integrate_panels(
        &self,
        panels: usize,
        work: &mut PanelBuffers,
        dynamic: &mut DynamicKernel,
        take: &mut dyn FnMut(Option<usize>, &mut PanelBuffers),
    ) -> std::result::Result<(), f64> {
        let width = self.table.width;
        let half_width = 0.5 * self.table.width;
        work.samples.clear();
        let mut integral_size = 0.0;
        for panel in 0..panels {
            let left = panel as f64 * width;
            let samples = self.kernel_samples(left, width, dynamic);
            let size = median(samples.map(|c| c[0].abs() + c[1].abs()));
            integral_size += half_width
                * self.form_size(left + half_width)
                * (size + dynamic.static_kernel[0].abs());
            work.samples.push(samples);
        }
        work.evaluations += PANEL_POINTS * panels;
        let max_error = self.tolerance.powf(PANEL_TOLERANCE_EXPONENT) * integral_size;
        let mut unresolved_panels = vec![];
        work.kernels.clear();
        for panel in 0..panels {
            let samples = &work.samples[panel];
            let left = panel as f64 * width;
            if self.is_resolved(samples, dynamic, left, width, max_error) {
                for (sample, weight) in samples.iter().zip(&self.table.rule.weights) {
                    work.kernels.push(sample.map(|c| c.scale(half_width * weight)));
                }
            } else {
                unresolved_panels.push(panel);
                work.kernels.extend([CellKernel::default(); PANEL_POINTS]);
            }
        }
        take(None, work);
        for panel in unresolved_panels {
            self.halve_panel(panel, max_error, work, dynamic)?;
            take(Some(panel), work);
        }
        Ok(())
    }

    /// Estimated ratio of the forms at a wavenumber to the forms at zero.
    fn form_size(&self, k: f64) -> f64 {
        (2.0 / (k * self.finest)).powi(2).min(1.0)
    }

    /// Kernels at the Gauss points of a panel.
    fn kernel_samples(
        &self,
        left: f64,
        width: f64,
        dynamic: &mut DynamicKernel,
    ) -> [CellKernel; PANEL_POINTS] {
        std::array::from_fn(|i| dynamic.at(left + 0.5 * width * (1.0 + self.table.rule.nodes[i])))
    }

    /// Whether the last two Legendre coefficients are small enough.
    fn is_resolved(
        &self,
        samples: &[CellKernel; PANEL_POINTS],
        dynamic: &DynamicKernel,
        left: f64,
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
                largest_square = largest_square.max((*value + static_value).square());
            }
        }
        error * width * self.form_size(left) <= max_error
            || error <= ROUNDING_FLOOR_FACTOR * largest_square.sqrt()
    }

    /// Moments ∫ C Pₙ dk over one panel, by halves; written to `work.kernels`.
    fn halve_panel(
        &self,
        panel: usize,
        max_error: f64,
        work: &mut PanelBuffers,
        dynamic: &mut DynamicKernel,
    ) -> std::result::Result<(), f64> {
        let panel_width = self.table.width;
        let panel_range = [panel_width * panel as f64, panel_width];
        let PanelBuffers { kernels, stack, evaluations, .. } = work;
        kernels.clear();
        kernels.resize(LEGENDRE_DEGREES, CellKernel::default());
        let sample = |left: f64, width: f64| {
            *evaluations += PANEL_POINTS;
            let samples = self.kernel_samples(left, width, dynamic);
            let is_resolved = self.is_resolved(&samples, dynamic, left, width, max_error);
            (samples, is_resolved)
        };
        by_halves(panel_range, stack, sample, |[place, size], width, samples| {
            for (sample, (x, weight)) in
                samples.iter().zip(self.table.rule.points_on_unit_interval())
            {
                let polynomials = legendre(2.0 * (place + size * x) - 1.0);
                for (moment, polynomial) in kernels.iter_mut().zip(polynomials) {
                    for (moment, value) in moment.iter_mut().zip(sample) {
                        *moment += value.scale(width * weight * polynomial);
                    }
                }
            }
        })
    }

    /// Adds Σ kernel × forms over the first of `rows` to the sums.
    fn add_products(&self, rows: &FormRows, work: &mut PanelBuffers) {
        let PanelBuffers { kernels, weights, sums, .. } = work;
        for (form, (first, series_factors)) in KERNEL_FACTORS.into_iter().enumerate() {
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
            let classes = self.table.classes;
            let range = first * classes..(first + 2 * series_factors.len()) * classes;
            rows.combine(form, weights, &mut sums[range]);
        }
    }
}

#[cfg(test)]
mod tests;
