//! Element compliances of a layered ground by integrals over the wavenumber.
//!
//! `F_zz` = (1/π) ∫₀^∞ `C_zz` `S_p` `S_q` cos kX dk, `F_xx` alike, and
//! `F_zx` = −(1/π) ∫₀^∞ `C_zx` `S_p` `S_q` sin kX dk (down due to shear, receiver X to the right),
//! integrals over receiver and source, m²/Pa × m.
//!
//! For Re s > 0 and passive layers no pole lies on the real axis, so the path is the axis itself. A path in
//! the complex plane would need the poles of backward waves. Panels of 16 Gauss points are halved until C is
//! a polynomial there. The first panels are as wide as C permits, for any elements; wide panels have weights
//! that contain the form factors. Halves of the narrowest panels contribute to the pairs through Legendre
//! moments over the whole panel, so that only C is evaluated more often. Beyond K the integral is a
//! [series](super::tail).

use super::compliance::{LayeredCompliance, SurfaceCompliance};
use super::form_factors::{
    FormFactors, LEGENDRE_DEGREES, PAIR_LANES, PANEL_POINTS, Panel, Sums, accumulate, legendre,
};
use super::tail::{TAIL_START_RATIO, TAIL_TERMS, Tails, on_grid, surface_series};
use crate::error::{Error, GroundError, ProgressReporter, Result};
use crate::history::{PairClasses, STRIP_KINDS};
use crate::linalg::Complex;
use crate::soil::SoilProfile;

/// Number of decay lengths in the top layer beyond which its bottom has no effect: e^(−2·20) is 4e-18.
const OPAQUE_DECAY_LENGTHS: f64 = 20.0;
/// Smallest K × shortest element for which the second differences of the tail keep their digits.
pub(super) const MIN_TAIL_PHASE: f64 = 0.05;
/// Largest number of panels of one integral.
const MAX_PANEL_COUNT: f64 = 65_536.0;
/// Largest number of panels required by short elements.
const MAX_PANELS_FOR_SHORT: f64 = 100.0;

/// Lengths of a patch that determine the surrogate of its compliances, m.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SurrogateLengths {
    /// Length of the shortest element.
    pub(crate) min_element_length: f64,
    /// Length of the patch.
    pub(crate) span: f64,
}

/// Element compliances F(s) of classes of pairs, with several kinds for each class.
pub(crate) trait Compliances<const STRIP_KINDS: usize>: Send + Sync {
    /// Workspace of one thread.
    type Workspace: Default;

    /// Sum of the errors of late weights, divided by the 2/3 power of the tolerance and the sum of all weights.
    const LATE_ERROR_FACTOR: f64 = 0.0;

    /// Number of points of the passivity check.
    const PASSIVITY_POINTS: usize = 40;

    /// Computes the data common to all compliances, if they are missing.
    ///
    /// # Errors
    /// [`Error::Stopped`](crate::Error::Stopped).
    fn make_ready(&self, _watch: &mut ProgressReporter) -> Result<()> {
        Ok(())
    }

    /// Overwrites `values`, one per class, with the compliances at `s`, integrals over receiver and source.
    ///
    /// Re s > 0, or damped layers.
    ///
    /// # Errors
    /// As for [`SoilProfile::moduli`]; [`GroundError::Unresolved`].
    fn compliance(
        &self,
        profile: &SoilProfile,
        s: Complex,
        work: &mut Self::Workspace,
        values: &mut [[Complex; STRIP_KINDS]],
    ) -> Result<()>;

    /// Lengths of the patch for which [`append_surrogate`](Self::append_surrogate) computes waves.
    fn surrogate_lengths(&self) -> SurrogateLengths;

    /// Surface compliance in the workspace.
    fn surface_compliance(workspace: &mut Self::Workspace) -> &mut LayeredCompliance;

    /// Counts evaluations of the surface compliance, if the workspace has a counter.
    fn count_evaluations(_workspace: &mut Self::Workspace, _evaluation_count: usize) {}

    /// Appends the surface compliance at a few wavenumbers, a cheap substitute for the compliances at `s`.
    ///
    /// [`SURROGATE_COMPONENTS`] numbers each, in a hundredth of the time.
    ///
    /// # Errors
    /// As for [`SoilProfile::moduli`].
    fn append_surrogate(
        &self,
        profile: &SoilProfile,
        s: Complex,
        workspace: &mut Self::Workspace,
        values: &mut Vec<Complex>,
    ) -> Result<()> {
        let compliance = Self::surface_compliance(workspace);
        compliance.set(profile, s)?;
        let lengths = self.surrogate_lengths();
        let evaluation_count = append_surface_surrogate(profile, compliance, lengths, values);
        Self::count_evaluations(workspace, evaluation_count);
        Ok(())
    }
}

/// Wavenumbers of an outlook, times the length of the patch.
///
/// The first is always used, the others if a slab carries waves along the patch.
const SURROGATE_WAVENUMBERS: [f64; 3] = [1e-5, 0.5, 2.0];
/// Number of components of the surface compliance in an outlook: zz, xx, xz.
pub(crate) const SURROGATE_COMPONENTS: usize = 3;

/// Integrals over the wavenumber for the pairs of a patch.
#[derive(Debug)]
pub(crate) struct Wavenumbers {
    pub(crate) forms: FormFactors,
    tails: Tails,
    /// Legendre polynomials at the Gauss points.
    pub(super) polynomials: Vec<[f64; LEGENDRE_DEGREES]>,
    pub(crate) span: f64,
    pub(crate) shortest: f64,
    pub(super) longest: f64,
    /// Accuracy relative to the compliance of an element with itself.
    pub(super) tolerance: f64,
}

/// Workspace of one thread.
#[derive(Debug, Default)]
pub(crate) struct StripWorkspace {
    pub(crate) compliance: LayeredCompliance,
    pub(super) panels: IntegralBuffers,
}

/// Workspace for the panels of successive integrals.
#[derive(Debug, Default)]
pub(super) struct IntegralBuffers {
    pub(super) samples: Vec<(Panel, [SurfaceCompliance; PANEL_POINTS])>,
    sums: Vec<Sums>,
    pub(super) wide: Vec<Panel>,
    pub(super) stack: Vec<(f64, f64, u32)>,
    /// Number of evaluations of C so far.
    pub(super) evaluations: usize,
}

/// Result on a panel: C at its points, or the moments of its halves.
pub(super) enum PanelResult<'a> {
    Samples(&'a [SurfaceCompliance; PANEL_POINTS]),
    Moments(&'a [[f64; 6]; LEGENDRE_DEGREES]),
}

/// Compliances zz, xx and zx of each class.
impl Compliances<STRIP_KINDS> for Wavenumbers {
    type Workspace = StripWorkspace;

    fn compliance(
        &self,
        profile: &SoilProfile,
        s: Complex,
        work: &mut Self::Workspace,
        values: &mut [[Complex; STRIP_KINDS]],
    ) -> Result<()> {
        let StripWorkspace { compliance, panels: buffers } = work;
        compliance.set(profile, s)?;
        // The series of the tail converges from this wavenumber on.
        let min_k = TAIL_START_RATIO * compliance.root();
        let panels = self.panels(min_k.max(top_layer_wavenumber(profile)))?;
        self.sum_panels(panels, buffers, &mut |k| compliance.at(k))
            .map_err(|k| unresolved(s, k))?;
        self.add_tail(compliance, panels, buffers);
        self.copy_sums(buffers, values);
        Ok(())
    }

    fn surrogate_lengths(&self) -> SurrogateLengths {
        SurrogateLengths { min_element_length: self.shortest, span: self.span }
    }

    fn surface_compliance(workspace: &mut StripWorkspace) -> &mut LayeredCompliance {
        &mut workspace.compliance
    }

    fn count_evaluations(workspace: &mut StripWorkspace, evaluation_count: usize) {
        workspace.panels.evaluations += evaluation_count;
    }
}

/// Appends the surface compliance at small wavenumbers, and for waves along shortest element and patch.
///
/// Returns the number of evaluations.
fn append_surface_surrogate(
    profile: &SoilProfile,
    compliance: &mut LayeredCompliance,
    lengths: SurrogateLengths,
    values: &mut Vec<Complex>,
) -> usize {
    let SurrogateLengths { min_element_length, span } = lengths;
    let mut wavenumbers = &SURROGATE_WAVENUMBERS[..1];
    if let Some((top, (below, _))) = profile.layers().first().zip(profile.soils().nth(1)) {
        // A slab stiffer along the patch than the ground below it transmits waves along the patch.
        let slab_stiffness = top.soil.shear_modulus() * top.thickness;
        if slab_stiffness > below.shear_modulus() * span {
            wavenumbers = &SURROGATE_WAVENUMBERS[..];
        }
    }
    let root = compliance.top().q2.sqrt();
    let one = Complex::real(1.0);
    let waves = [min_element_length, span].map(|distance| {
        let exponent = root.scale(distance);
        (-exponent).exp() / (one + exponent)
    });
    let weight = one + waves[0] + waves[1];
    for wavenumber in wavenumbers {
        let c = compliance.at(wavenumber / span);
        values.extend([c.zz, c.xx, c.xz].map(|value| weight * value));
    }
    wavenumbers.len()
}

impl Wavenumbers {
    /// Integrals for all classes of pairs.
    pub(crate) fn new(classes: &PairClasses, tolerance: f64) -> Self {
        let forms = FormFactors::new(classes);
        let mut shortest = f64::INFINITY;
        let mut longest = 0.0_f64;
        for element in classes.elements() {
            shortest = shortest.min(element.length());
            longest = longest.max(element.length());
        }
        Self {
            polynomials: forms.rule.nodes.iter().map(|x| legendre(*x)).collect(),
            tails: Tails::default(),
            span: classes.span(),
            shortest,
            longest,
            tolerance,
            forms,
        }
    }

    /// Overwrites `values` with the compliances at s = 0.
    ///
    /// `surface` returns C up to a wavenumber of at least `min_k` (1/m). Beyond, the static tail of the top layer of
    /// `compliance` is used.
    pub(super) fn static_compliance(
        &self,
        compliance: &LayeredCompliance,
        min_k: f64,
        work: &mut IntegralBuffers,
        values: &mut [[Complex; STRIP_KINDS]],
        surface: &mut dyn FnMut(f64) -> SurfaceCompliance,
    ) -> Result<()> {
        let panels = self.panels(min_k)?;
        self.sum_panels(panels, work, surface)
            .map_err(|k| unresolved(Complex::default(), k))?;
        self.add_tail(compliance, panels, work);
        self.copy_sums(work, values);
        Ok(())
    }

    /// Number of panels up to K ≥ `min_k`.
    fn panels(&self, min_k: f64) -> Result<usize> {
        let width = self.forms.width;
        let min_k_of_tail = (MIN_TAIL_PHASE / self.shortest).min(MAX_PANELS_FOR_SHORT * width);
        let count = (min_k / width).max(min_k_of_tail / width).ceil().max(1.0);
        if count > MAX_PANEL_COUNT {
            let span = self.span;
            let most = MAX_PANEL_COUNT * width;
            return Err(GroundError::TooFine { span, wavenumber: min_k, most }.into());
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked")]
        let count = count as usize;
        Ok(on_grid(count))
    }

    /// Sums the panels up to K into `work.sums`; returns the wavenumber where halving stopped as the error.
    fn sum_panels(
        &self,
        panels: usize,
        work: &mut IntegralBuffers,
        surface: &mut dyn FnMut(f64) -> SurfaceCompliance,
    ) -> std::result::Result<(), f64> {
        let forms = &self.forms;
        let mut sums = std::mem::take(&mut work.sums);
        sums.clear();
        sums.resize(forms.blocks(), Sums::default());
        let outcome =
            self.integrate_panels(panels, work, surface, &mut |panel, result| match result {
                PanelResult::Samples(samples) => {
                    let half_width = 0.5 * forms.extent(panel)[1];
                    let coefficients: [[f64; 6]; PANEL_POINTS] = std::array::from_fn(|i| {
                        weighted_parts(&samples[i], half_width * forms.rule.weights[i])
                    });
                    forms.with_values(panel, |rows| accumulate(rows, &coefficients, &mut sums));
                }
                PanelResult::Moments(moments) => {
                    forms.with_legendre(panel.index, |rows| accumulate(rows, moments, &mut sums));
                }
            });
        work.sums = sums;
        outcome
    }

    /// Adds the series for wavenumbers beyond the last panel.
    fn add_tail(&self, compliance: &LayeredCompliance, panels: usize, work: &mut IntegralBuffers) {
        let top = compliance.top();
        let series = surface_series(top.a2);
        let limit = panels as f64 * self.forms.width;
        let ratio = top.q2.scale(1.0 / (limit * limit));
        let mut power = top.modulus.inverse();
        let mut coefficients = [[0.0; 6]; TAIL_TERMS];
        for (j, coefficient) in coefficients.iter_mut().enumerate() {
            let term = |component: usize| power.scale(series[component][j]);
            let compliance = SurfaceCompliance { xx: term(0), zz: term(1), xz: term(2) };
            *coefficient = weighted_parts(&compliance, 1.0);
            power = power * ratio;
        }
        accumulate(self.tails.rows(&self.forms, panels), &coefficients, &mut work.sums);
    }

    /// Overwrites the compliances zz, xx and zx of each class with 1/π × the sums; zx with the opposite sign.
    fn copy_sums(&self, work: &IntegralBuffers, values: &mut [[Complex; STRIP_KINDS]]) {
        for (class, value) in values.iter_mut().enumerate().take(self.forms.shapes.len()) {
            let sums = &work.sums[class / PAIR_LANES];
            let lane = class % PAIR_LANES;
            for (kind, value) in value.iter_mut().enumerate() {
                let sum = Complex::new(sums[2 * kind][lane], sums[2 * kind + 1][lane]);
                let sign = if kind == 2 { -1.0 } else { 1.0 };
                *value = sum.scale(sign * std::f64::consts::FRAC_1_PI);
            }
        }
    }
}

/// Error for an integral at `s` whose halving stopped at the wavenumber `k`.
pub(crate) fn unresolved(s: Complex, k: f64) -> Error {
    GroundError::Unresolved { re: s.re, im: s.im, wavenumber: k }.into()
}

/// Smallest K at which the bottom of the top layer has no effect on the surface, 1/m.
pub(crate) fn top_layer_wavenumber(profile: &SoilProfile) -> f64 {
    profile.layers().first().map_or(0.0, |layer| OPAQUE_DECAY_LENGTHS / layer.thickness)
}

/// zz, xx, xz, real and imaginary, times a weight.
pub(super) fn weighted_parts(c: &SurfaceCompliance, weight: f64) -> [f64; 6] {
    [c.zz.re, c.zz.im, c.xx.re, c.xx.im, c.xz.re, c.xz.im].map(|x| weight * x)
}

#[cfg(test)]
mod tests;
