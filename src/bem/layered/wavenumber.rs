//! Element compliances of a layered ground by integrals over the wavenumber.
//!
//! `F_zz` = (1/π) ∫₀^∞ `C_zz` `S_p` `S_q` cos kX dk, `F_xx` with `C_xx` in place of `C_zz`, and
//! `F_zx` = −(1/π) ∫₀^∞ `C_zx` `S_p` `S_q` sin kX dk (down due to shear, receiver X to the right),
//! integrals over receiver and source, m²/Pa × m.
//!
//! For Re s > 0 and passive layers no pole lies on the real axis, so that the path is the axis itself. A path in the
//! complex plane would need the poles of backward waves. Panels of 16 Gauss points are halved until C is a polynomial on
//! each. The first panels are as wide as C permits, for any elements: the weights of wide panels contain the form factors.
//! Halves of the narrowest panels enter through Legendre moments over the whole panel, so that form factors need no
//! further evaluation. Beyond K the integral is a [series](super::tail).

use super::compliance::{LayeredCompliance, SurfaceCompliance};
use super::form_factors::{
    FormFactors, LEGENDRE_DEGREES, PAIR_LANES, PANEL_POINTS, Panel, Sums, accumulate, legendre,
};
use super::tail::{TAIL_START_RATIO, TAIL_TERMS, Tails, rounded_panel_count, surface_series};
use crate::error::{Error, GroundError, ProgressReporter, Result};
use crate::history::{PairClasses, STRIP_KINDS};
use crate::linalg::Complex;
use crate::soil::SoilProfile;

/// Depth, in decay lengths, at which the bottom of the top layer does not affect the surface, as e^(−2·20) is 4e-18.
const OPAQUE_DECAY_LENGTHS: f64 = 20.0;
/// Smallest product of K and the shortest element for which the second differences of the tail are accurate.
pub(super) const MIN_TAIL_PHASE: f64 = 0.05;
/// Largest number of panels of one integral, which limits computing time and memory.
const MAX_PANEL_COUNT: f64 = 65_536.0;
/// Largest number of panels required by short elements, whose errors are small beside the compliance of longer ones.
const MAX_PANELS_FOR_SHORT_ELEMENTS: f64 = 100.0;

/// Lengths of a patch that determine the surrogate of its compliances, m.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SurrogateLengths {
    /// Length of the shortest element.
    pub(crate) min_element_length: f64,
    /// Length of the patch.
    pub(crate) span: f64,
}

/// Element compliances F(s) of classes of pairs, with `KINDS` components for each class.
pub(crate) trait Compliances<const KINDS: usize>: Send + Sync {
    /// Workspace of one thread.
    type Workspace: Default;

    /// Sum of the errors of late weights, relative to the sum of all weights times the 2/3 power of the tolerance.
    const LATE_ERROR_FACTOR: f64 = 0.0;

    /// Number of points of the passivity check.
    const PASSIVITY_POINTS: usize = 40;

    /// Computes the data common to all compliances at the first call.
    ///
    /// # Errors
    /// [`Error::Stopped`](crate::Error::Stopped).
    fn make_ready(&self, _progress: &mut ProgressReporter) -> Result<()> {
        Ok(())
    }

    /// Overwrites `values`, one per class, with the compliances at `s`, integrals over receiver and source.
    ///
    /// Re s must be above zero, or all layers damped.
    ///
    /// # Errors
    /// As for [`SoilProfile::moduli`]; [`GroundError::Unresolved`].
    fn compliance(
        &self,
        profile: &SoilProfile,
        s: Complex,
        workspace: &mut Self::Workspace,
        values: &mut [[Complex; KINDS]],
    ) -> Result<()>;

    /// Lengths of the patch for which [`append_surrogate`](Self::append_surrogate) computes waves.
    fn surrogate_lengths(&self) -> SurrogateLengths;

    /// Surface compliance in the workspace.
    fn surface_compliance(workspace: &mut Self::Workspace) -> &mut LayeredCompliance;

    /// Counts evaluations of the surface compliance, if the workspace has a counter.
    fn count_evaluations(_workspace: &mut Self::Workspace, _evaluation_count: usize) {}

    /// Appends a surrogate of the compliances at `s` that needs a hundredth of their time.
    ///
    /// The surrogate is the surface compliance at a few wavenumbers, [`SURROGATE_COMPONENTS`] numbers for each.
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

/// Wavenumbers of a surrogate, times the span of the elements.
///
/// The first is always used, the others if a slab transmits waves along the elements.
const SURROGATE_WAVENUMBERS: [f64; 3] = [1e-5, 0.5, 2.0];
/// Number of components of the surface compliance in a surrogate: zz, xx, xz.
pub(crate) const SURROGATE_COMPONENTS: usize = 3;

/// Integrals over the wavenumber for all pairs of elements.
#[derive(Debug)]
pub(crate) struct Wavenumbers {
    pub(crate) forms: FormFactors,
    tails: Tails,
    /// Legendre polynomials at the Gauss points.
    pub(super) polynomials: Vec<[f64; LEGENDRE_DEGREES]>,
    /// Length of all elements together, m.
    pub(crate) span: f64,
    /// Length of the shortest element, m.
    pub(crate) min_length: f64,
    /// Length of the longest element, m.
    pub(super) max_length: f64,
    /// Accuracy relative to the compliance of an element with itself.
    pub(super) tolerance: f64,
}

/// Workspace of one thread.
#[derive(Debug, Default)]
pub(crate) struct StripWorkspace {
    pub(crate) compliance: LayeredCompliance,
    pub(super) panels: IntegralBuffers,
}

/// Buffers for the panels of successive integrals.
#[derive(Debug, Default)]
pub(super) struct IntegralBuffers {
    /// C at the points of the widest panels.
    pub(super) samples: Vec<(Panel, [SurfaceCompliance; PANEL_POINTS])>,
    /// Integrals so far, block by block of pairs.
    sums: Vec<Sums>,
    /// Stack of panels to be sampled.
    pub(super) panel_stack: Vec<Panel>,
    /// Stack of [`by_halves`](super::halving::by_halves).
    pub(super) part_stack: Vec<(f64, f64, u32)>,
    /// Number of evaluations of C.
    pub(super) evaluation_count: usize,
}

/// Result on a panel: C at its points, or moments from its halves.
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
        workspace: &mut Self::Workspace,
        values: &mut [[Complex; STRIP_KINDS]],
    ) -> Result<()> {
        let StripWorkspace { compliance, panels: buffers } = workspace;
        compliance.set(profile, s)?;
        // The series of the tail converges from this wavenumber on.
        let min_k = TAIL_START_RATIO * compliance.root();
        let panel_count = self.panel_count(min_k.max(top_layer_wavenumber(profile)))?;
        self.sum_panels(panel_count, buffers, &mut |k| compliance.at(k))
            .map_err(|k| unresolved(s, k))?;
        self.add_tail(compliance, panel_count, buffers);
        self.copy_sums(buffers, values);
        Ok(())
    }

    fn surrogate_lengths(&self) -> SurrogateLengths {
        SurrogateLengths { min_element_length: self.min_length, span: self.span }
    }

    fn surface_compliance(workspace: &mut StripWorkspace) -> &mut LayeredCompliance {
        &mut workspace.compliance
    }

    fn count_evaluations(workspace: &mut StripWorkspace, evaluation_count: usize) {
        workspace.panels.evaluation_count += evaluation_count;
    }
}

/// Appends the surrogate of the compliances of elements: surface compliances, weighted by waves along the elements.
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
    if let Some((top, (lower_soil, _))) = profile.layers().first().zip(profile.soils().nth(1)) {
        // A slab that is stiffer along the elements than the ground below transmits waves along them.
        let slab_stiffness = top.soil.shear_modulus() * top.thickness;
        if slab_stiffness > lower_soil.shear_modulus() * span {
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
        let mut min_length = f64::INFINITY;
        let mut max_length = 0.0_f64;
        for element in classes.elements() {
            min_length = min_length.min(element.length());
            max_length = max_length.max(element.length());
        }
        Self {
            polynomials: forms.rule.nodes.iter().map(|x| legendre(*x)).collect(),
            tails: Tails::default(),
            span: classes.span(),
            min_length,
            max_length,
            tolerance,
            forms,
        }
    }

    /// Overwrites `values` with the compliances at s = 0.
    ///
    /// `surface_at` returns C up to a wavenumber of at least `min_k` (1/m). The static tail of the top layer of
    /// `compliance` is used beyond.
    pub(super) fn static_compliance(
        &self,
        compliance: &LayeredCompliance,
        min_k: f64,
        buffers: &mut IntegralBuffers,
        values: &mut [[Complex; STRIP_KINDS]],
        surface_at: &mut dyn FnMut(f64) -> SurfaceCompliance,
    ) -> Result<()> {
        let panel_count = self.panel_count(min_k)?;
        self.sum_panels(panel_count, buffers, surface_at)
            .map_err(|k| unresolved(Complex::default(), k))?;
        self.add_tail(compliance, panel_count, buffers);
        self.copy_sums(buffers, values);
        Ok(())
    }

    /// Number of panels up to K ≥ `min_k`.
    fn panel_count(&self, min_k: f64) -> Result<usize> {
        let width = self.forms.width;
        let min_k_of_tail =
            (MIN_TAIL_PHASE / self.min_length).min(MAX_PANELS_FOR_SHORT_ELEMENTS * width);
        let count = (min_k / width).max(min_k_of_tail / width).ceil().max(1.0);
        if count > MAX_PANEL_COUNT {
            let span = self.span;
            let most = MAX_PANEL_COUNT * width;
            return Err(GroundError::TooFine { span, wavenumber: min_k, most }.into());
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked")]
        let count = count as usize;
        Ok(rounded_panel_count(count))
    }

    /// Overwrites `buffers.sums` with the sums over the panels up to K.
    ///
    /// # Errors
    /// The wavenumber at which halving stopped without success.
    fn sum_panels(
        &self,
        panel_count: usize,
        buffers: &mut IntegralBuffers,
        surface_at: &mut dyn FnMut(f64) -> SurfaceCompliance,
    ) -> std::result::Result<(), f64> {
        let forms = &self.forms;
        let mut sums = std::mem::take(&mut buffers.sums);
        sums.clear();
        sums.resize(forms.block_count(), Sums::default());
        let outcome =
            self.integrate_panels(panel_count, buffers, surface_at, &mut |panel, result| {
                match result {
                    PanelResult::Samples(samples) => {
                        let half_width = 0.5 * forms.start_and_width(panel)[1];
                        let coefficients: [[f64; 6]; PANEL_POINTS] = std::array::from_fn(|i| {
                            weighted_parts(&samples[i], half_width * forms.rule.weights[i])
                        });
                        forms.with_values(panel, |rows| accumulate(rows, &coefficients, &mut sums));
                    }
                    PanelResult::Moments(moments) => {
                        forms.with_legendre(panel.index, |rows| {
                            accumulate(rows, moments, &mut sums);
                        });
                    }
                }
            });
        buffers.sums = sums;
        outcome
    }

    /// Adds the integrals beyond the last panel to the sums.
    fn add_tail(
        &self,
        compliance: &LayeredCompliance,
        panel_count: usize,
        buffers: &mut IntegralBuffers,
    ) {
        let top = compliance.top();
        let series = surface_series(top.a2);
        let max_k = panel_count as f64 * self.forms.width;
        let ratio = top.q2.scale(1.0 / (max_k * max_k));
        let mut power = top.modulus.inverse();
        let mut coefficients = [[0.0; 6]; TAIL_TERMS];
        for (j, coefficient) in coefficients.iter_mut().enumerate() {
            let term = |component: usize| power.scale(series[component][j]);
            let compliance = SurfaceCompliance { xx: term(0), zz: term(1), xz: term(2) };
            *coefficient = weighted_parts(&compliance, 1.0);
            power = power * ratio;
        }
        accumulate(self.tails.rows(&self.forms, panel_count), &coefficients, &mut buffers.sums);
    }

    /// Overwrites `values` with the compliances zz, xx and zx of each class: 1/π × the sums, zx with the opposite sign.
    fn copy_sums(&self, buffers: &IntegralBuffers, values: &mut [[Complex; STRIP_KINDS]]) {
        for (class, class_values) in values.iter_mut().enumerate().take(self.forms.shapes.len()) {
            let sums = &buffers.sums[class / PAIR_LANES];
            let lane = class % PAIR_LANES;
            for (component, value) in class_values.iter_mut().enumerate() {
                let sum = Complex::new(sums[2 * component][lane], sums[2 * component + 1][lane]);
                let sign = if component == 2 { -1.0 } else { 1.0 };
                *value = sum.scale(sign * std::f64::consts::FRAC_1_PI);
            }
        }
    }
}

/// Error for an integral at `s` whose halving stopped at the wavenumber `k`.
pub(crate) fn unresolved(s: Complex, k: f64) -> Error {
    GroundError::Unresolved { re: s.re, im: s.im, wavenumber: k }.into()
}

/// Smallest wavenumber at which only the top layer affects the surface, 1/m.
pub(crate) fn top_layer_wavenumber(profile: &SoilProfile) -> f64 {
    profile.layers().first().map_or(0.0, |layer| OPAQUE_DECAY_LENGTHS / layer.thickness)
}

/// Real and imaginary parts of zz, xx and xz, times a weight, for the sums over form factors.
pub(super) fn weighted_parts(c: &SurfaceCompliance, weight: f64) -> [f64; 6] {
    [c.zz.re, c.zz.im, c.xx.re, c.xx.im, c.xz.re, c.xz.im].map(|x| weight * x)
}

#[cfg(test)]
mod tests;
