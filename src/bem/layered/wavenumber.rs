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

use super::compliance::{Compliance, SurfaceCompliance};
use super::form_factors::{DEGREES, FormFactors, LANES, POINTS, Panel, Sums, accumulate, legendre};
use super::tail::{REACH, TERMS, Tails, on_grid, surface_series};
use crate::error::{Error, GroundError, Result, Watch};
use crate::history::{PairClasses, STRIP_KINDS};
use crate::linalg::Complex;
use crate::soil::SoilProfile;

/// Number of decay lengths in the top layer beyond which its bottom has no effect: e^(−2·20) is 4e-18.
const DEEP: f64 = 20.0;
/// K × shortest element below which the second differences of the tail cancel.
pub(super) const SHORT: f64 = 0.05;
/// Largest number of panels of one integral.
const MOST_PANELS: f64 = 65_536.0;
/// Largest number of panels required by short elements.
const MOST_FOR_SHORT: f64 = 100.0;

/// Element compliances F(s) of classes of pairs, with several kinds for each class.
pub(crate) trait Compliances<const KINDS: usize>: Send + Sync {
    /// Workspace of one thread.
    type Workspace: Default;

    /// Sum of the errors of late weights, divided by the 2/3 power of the tolerance and the sum of all weights.
    const LATE_ERROR: f64 = 0.0;

    /// Number of points of the passivity gate.
    const GATE_POINTS: usize = 40;

    /// Computes the data common to all compliances, if they are missing.
    ///
    /// # Errors
    /// [`Error::Stopped`](crate::Error::Stopped).
    fn make_ready(&self, _watch: &mut Watch) -> Result<()> {
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
        values: &mut [[Complex; KINDS]],
    ) -> Result<()>;

    /// Appends [`OUTLOOK`] numbers for each of a few wavenumbers, which replace the compliances at `s`.
    ///
    /// They take a hundredth of the time of the compliances.
    ///
    /// # Errors
    /// As for [`SoilProfile::moduli`].
    fn outlook(
        &self,
        profile: &SoilProfile,
        s: Complex,
        work: &mut Self::Workspace,
        values: &mut Vec<Complex>,
    ) -> Result<()>;
}

/// Wavenumbers at which the surface compliance replaces the mobility, times the length of the patch.
///
/// The first is always used, the others if a slab carries waves along the patch.
const WAVENUMBERS: [f64; 3] = [1e-5, 0.5, 2.0];
/// Number of components of the surface compliance in an outlook: zz, xx, xz.
pub(crate) const OUTLOOK: usize = 3;

/// Integrals over the wavenumber for the pairs of a patch.
#[derive(Debug)]
pub(crate) struct Wavenumbers {
    pub(crate) forms: FormFactors,
    tails: Tails,
    /// Legendre polynomials at the Gauss points.
    pub(super) polynomials: Vec<[f64; DEGREES]>,
    pub(crate) span: f64,
    pub(crate) shortest: f64,
    pub(super) longest: f64,
    /// Accuracy relative to the compliance of an element with itself.
    pub(super) tolerance: f64,
}

/// Workspace of one thread.
#[derive(Debug, Default)]
pub(crate) struct Workspace {
    pub(crate) compliance: Compliance,
    pub(super) panels: Scratch,
}

/// Workspace for the panels of successive integrals.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    pub(super) samples: Vec<(Panel, [SurfaceCompliance; POINTS])>,
    sums: Vec<Sums>,
    pub(super) wide: Vec<Panel>,
    pub(super) stack: Vec<(f64, f64, u32)>,
    /// Number of evaluations of C so far.
    pub(super) evaluations: usize,
}

/// Result on a panel: C at its points, or the moments of its halves.
pub(super) enum Found<'a> {
    Samples(&'a [SurfaceCompliance; POINTS]),
    Moments(&'a [[f64; 6]; DEGREES]),
}

/// Compliances zz, xx and zx of each class.
impl Compliances<STRIP_KINDS> for Wavenumbers {
    type Workspace = Workspace;

    fn compliance(
        &self,
        profile: &SoilProfile,
        s: Complex,
        work: &mut Self::Workspace,
        values: &mut [[Complex; STRIP_KINDS]],
    ) -> Result<()> {
        let Workspace { compliance, panels: work } = work;
        compliance.set(profile, s)?;
        let panels = self.panels(Self::reach(compliance).max(deep(profile)))?;
        let resolved = self.sum(panels, work, &mut |k| compliance.at(k));
        resolved.map_err(|k| unresolved(s, k))?;
        self.add_tail(compliance, panels, work);
        self.read(work, values);
        Ok(())
    }

    /// Appends the surface compliance at small wavenumbers, and for waves along the shortest element and the
    /// patch.
    fn outlook(
        &self,
        profile: &SoilProfile,
        s: Complex,
        work: &mut Self::Workspace,
        values: &mut Vec<Complex>,
    ) -> Result<()> {
        work.compliance.set(profile, s)?;
        work.panels.evaluations +=
            surface_outlook(profile, &mut work.compliance, [self.shortest, self.span], values);
        Ok(())
    }
}

/// Appends the surface compliance at small wavenumbers, and for waves along shortest element and patch.
///
/// Returns the number of evaluations.
pub(crate) fn surface_outlook(
    profile: &SoilProfile,
    compliance: &mut Compliance,
    [shortest, span]: [f64; 2],
    values: &mut Vec<Complex>,
) -> usize {
    let slab = profile.layers().first().zip(profile.soils().nth(1));
    // Whether the top layer carries more along the patch than the ground below it.
    let has_slab = slab.is_some_and(|(top, (below, _))| {
        let carried = top.soil.shear_modulus() * top.thickness;
        carried > below.shear_modulus() * span
    });
    let wavenumbers = if has_slab { &WAVENUMBERS[..] } else { &WAVENUMBERS[..1] };
    let (_, q2, _) = compliance.top();
    let one = Complex::real(1.0);
    let waves = [shortest, span].map(|way| {
        let turn = q2.sqrt().scale(way);
        (-turn).exp() / (one + turn)
    });
    let weight = one + waves[0] + waves[1];
    for wavenumber in wavenumbers {
        let c = compliance.at(wavenumber / span);
        values.extend([c.zz, c.xx, c.xz].map(|value| weight * value));
    }
    wavenumbers.len()
}

impl Wavenumbers {
    pub(crate) fn new(classes: &PairClasses, tolerance: f64) -> Self {
        let forms = FormFactors::new(classes);
        let lengths = || classes.elements().iter().map(crate::bem::ContactElement::length);
        Self {
            polynomials: forms.rule.nodes.iter().map(|x| legendre(*x)).collect(),
            tails: Tails::default(),
            span: classes.span(),
            shortest: lengths().fold(f64::INFINITY, f64::min),
            longest: lengths().fold(0.0, f64::max),
            tolerance,
            forms,
        }
    }

    /// Compliances at s = 0 with `symbol` for C, up to a wavenumber of at least `least` (1/m).
    ///
    /// Beyond, the static tail of the top layer of `compliance` is used.
    pub(super) fn at_rest(
        &self,
        compliance: &Compliance,
        least: f64,
        work: &mut Scratch,
        values: &mut [[Complex; STRIP_KINDS]],
        symbol: &mut dyn FnMut(f64) -> SurfaceCompliance,
    ) -> Result<()> {
        let panels = self.panels(least)?;
        let resolved = self.sum(panels, work, symbol);
        resolved.map_err(|k| unresolved(Complex::default(), k))?;
        self.add_tail(compliance, panels, work);
        self.read(work, values);
        Ok(())
    }

    /// Smallest K for which the series of the tail converges.
    fn reach(compliance: &Compliance) -> f64 {
        REACH * compliance.root()
    }

    /// Number of panels up to K ≥ `least`.
    fn panels(&self, least: f64) -> Result<usize> {
        let width = self.forms.width;
        let short = (SHORT / self.shortest).min(MOST_FOR_SHORT * width);
        let count = (least / width).max(short / width).ceil().max(1.0);
        if count > MOST_PANELS {
            let (span, wavenumber, most) = (self.span, least, MOST_PANELS * width);
            return Err(GroundError::TooFine { span, wavenumber, most }.into());
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked")]
        let count = count as usize;
        Ok(on_grid(count))
    }

    /// Sums the panels up to K into `work.sums`; returns the wavenumber where halving stopped as the error.
    fn sum(
        &self,
        panels: usize,
        work: &mut Scratch,
        symbol: &mut dyn FnMut(f64) -> SurfaceCompliance,
    ) -> std::result::Result<(), f64> {
        let forms = &self.forms;
        let mut sums = std::mem::take(&mut work.sums);
        sums.clear();
        sums.resize(forms.blocks(), Sums::default());
        let outcome = self.resolve(panels, work, symbol, &mut |panel, found| match found {
            Found::Samples(samples) => {
                let half = 0.5 * forms.extent(panel)[1];
                let coefficients: [[f64; 6]; POINTS] =
                    std::array::from_fn(|i| parts(&samples[i], half * forms.rule.weights[i]));
                forms.with_values(panel, |rows| accumulate(rows, &coefficients, &mut sums));
            }
            Found::Moments(moments) => {
                forms.with_legendre(panel.index, |rows| accumulate(rows, moments, &mut sums));
            }
        });
        work.sums = sums;
        outcome
    }

    /// Adds the series for wavenumbers beyond the last panel.
    fn add_tail(&self, compliance: &Compliance, panels: usize, work: &mut Scratch) {
        let (modulus, q2, a2) = compliance.top();
        let [xx, zz, xz] = surface_series(a2);
        let limit = panels as f64 * self.forms.width;
        let ratio = q2.scale(1.0 / (limit * limit));
        let mut power = modulus.inverse();
        let mut coefficients = [[0.0; 6]; TERMS];
        for (j, coefficient) in coefficients.iter_mut().enumerate() {
            let value = |d: f64| power.scale(d);
            let surface =
                SurfaceCompliance { xx: value(xx[j]), zz: value(zz[j]), xz: value(xz[j]) };
            *coefficient = parts(&surface, 1.0);
            power = power * ratio;
        }
        accumulate(self.tails.rows(&self.forms, panels), &coefficients, &mut work.sums);
    }

    fn read(&self, work: &Scratch, values: &mut [[Complex; STRIP_KINDS]]) {
        const UNIT: f64 = std::f64::consts::FRAC_1_PI;
        for (class, value) in values.iter_mut().enumerate().take(self.forms.shapes.len()) {
            let (sums, lane) = (&work.sums[class / LANES], class % LANES);
            let part = |i: usize| Complex::new(sums[i][lane], sums[i + 1][lane]);
            *value = [part(0).scale(UNIT), part(2).scale(UNIT), part(4).scale(-UNIT)];
        }
    }
}

/// Error for an integral at `s` whose halving stopped at the wavenumber `k`.
pub(crate) fn unresolved(s: Complex, k: f64) -> Error {
    GroundError::Unresolved { re: s.re, im: s.im, wavenumber: k }.into()
}

/// Smallest K at which the bottom of the top layer has no effect on the surface, 1/m.
pub(crate) fn deep(profile: &SoilProfile) -> f64 {
    profile.layers().first().map_or(0.0, |layer| DEEP / layer.thickness)
}

/// zz, xx, xz, real and imaginary, times a weight.
pub(super) fn parts(c: &SurfaceCompliance, weight: f64) -> [f64; 6] {
    [c.zz.re, c.zz.im, c.xx.re, c.xx.im, c.xz.re, c.xz.im].map(|x| weight * x)
}

#[cfg(test)]
mod tests;
