//! Element compliances of a layered ground by integrals over the wavenumber.
//!
//! `F_zz` = (1/π) ∫₀^∞ `C_zz` `S_p` `S_q` cos kX dk, `F_xx` alike, and
//! `F_zx` = −(1/π) ∫₀^∞ `C_zx` `S_p` `S_q` sin kX dk (down due to shear, receiver X to the right),
//! integrals over receiver and source, m²/Pa × m.
//!
//! For Re s > 0 and passive layers no pole lies on the real axis, so the path is the axis itself: a
//! path into the complex plane would have to know where poles of backward waves are. Panels of 16 Gauss points
//! are halved until C is a polynomial there. They begin as wide as C lets expect, whatever the elements are, and
//! wide ones have weights that know the form factors; what halves of the narrowest find reaches the pairs
//! through Legendre moments over the whole panel, so that only C is evaluated more often. Beyond K the integral
//! is a [series](super::tail).

use super::compliance::{Compliance, SurfaceCompliance};
use super::form_factors::{DEGREES, FormFactors, LANES, POINTS, Panel, Sums, accumulate, legendre};
use super::tail::{REACH, TERMS, Tails, on_grid, surface_series};
use crate::error::{Error, LayeredError, Result, Watch};
use crate::history::{KINDS, PairClasses};
use crate::linalg::Complex;
use crate::soil::SoilProfile;

/// Decay lengths in the top layer beyond which its bottom is not felt: e^(−2·20) is 4e-18.
const DEEP: f64 = 20.0;
/// K × shortest element: below it the second differences of the tail cancel.
pub(super) const SHORT: f64 = 0.05;
/// Most panels of one integral.
const MOST_PANELS: f64 = 65_536.0;
/// Panels that short elements may ask for.
const MOST_FOR_SHORT: f64 = 100.0;

/// Compliances of classes of pairs, of some kinds each.
pub(crate) trait Compliances<const KINDS: usize>: Send + Sync {
    /// Scratch of one thread.
    type Workspace: Default;

    /// Errors of late convolution weights, summed, over the 2/3 power of the tolerance and the sum of all coefficients.
    const LATE_ERROR: f64 = 0.0;

    /// Makes the data common to all compliances, unless they are there.
    ///
    /// # Errors
    /// [`Error::Stopped`](crate::Error::Stopped).
    fn make_ready(&self, _watch: &mut Watch) -> Result<()> {
        Ok(())
    }

    /// Overwrites `values`, one per class, with the compliances at `s`, Re s > 0 (or damped layers), integrals over
    /// receiver and source.
    ///
    /// # Errors
    /// As for [`SoilProfile::moduli`]; [`LayeredError::Unresolved`].
    fn compliance(
        &self,
        profile: &SoilProfile,
        s: Complex,
        work: &mut Self::Workspace,
        values: &mut [[Complex; KINDS]],
    ) -> Result<()>;

    /// Appends [`OUTLOOK`] numbers for each of a few wavenumbers that stand for the compliances at `s`, at a hundredth of
    /// the cost.
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

/// Wavenumbers at which the surface compliance stands for the mobility, times the length of the patch: the first, and
/// the others where a slab carries waves along.
const WAVENUMBERS: [f64; 3] = [1e-5, 0.5, 2.0];
/// Components of the surface compliance in an outlook: zz, xx, xz.
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
    /// Accuracy relative to an element's own compliance.
    pub(super) tolerance: f64,
}

/// Scratch of one thread.
#[derive(Debug, Default)]
pub(crate) struct Workspace {
    pub(crate) compliance: Compliance,
    pub(super) panels: Scratch,
}

/// Scratch for the panels of one integral after the other.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    pub(super) samples: Vec<(Panel, [SurfaceCompliance; POINTS])>,
    sums: Vec<Sums>,
    pub(super) wide: Vec<Panel>,
    pub(super) stack: Vec<(f64, f64, u32)>,
    /// Number of evaluations of C so far.
    pub(super) evaluations: usize,
}

/// Work that integrals take: numbers, estimated.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Counts {
    /// Panels that are summed.
    pub(crate) panels: f64,
    /// Panels that are halved below the narrowest.
    pub(crate) halved: f64,
    /// Integrals, and those whose K is for the thickness of the top layer's sake.
    pub(crate) integrals: f64,
    pub(crate) deep: f64,
    /// Evaluations of C.
    pub(crate) evaluations: f64,
    /// Evaluations of C in halves.
    pub(crate) halves: f64,
    /// Layers that evaluations go through after the first.
    pub(crate) layers: f64,
}

impl Counts {
    /// Combined with another, number by number.
    pub(crate) fn with(&self, other: &Self, combine: impl Fn(f64, f64) -> f64) -> Self {
        Self {
            panels: combine(self.panels, other.panels),
            halved: combine(self.halved, other.halved),
            integrals: combine(self.integrals, other.integrals),
            deep: combine(self.deep, other.deep),
            evaluations: combine(self.evaluations, other.evaluations),
            halves: combine(self.halves, other.halves),
            layers: combine(self.layers, other.layers),
        }
    }
}

/// Result of a panel: C at its points, or the moments of its halves.
pub(super) enum Found<'a> {
    Samples(&'a [SurfaceCompliance; POINTS]),
    Moments(&'a [[f64; 6]; DEGREES]),
}

/// Compliances zz, xx and zx of each class.
impl Compliances<KINDS> for Wavenumbers {
    type Workspace = Workspace;

    fn compliance(
        &self,
        profile: &SoilProfile,
        s: Complex,
        work: &mut Self::Workspace,
        values: &mut [[Complex; KINDS]],
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

    /// The surface compliance at small wavenumbers, and on waves along the shortest element and the patch.
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

/// The surface compliance at small wavenumbers, and on waves along the shortest element and the patch: how often it was
/// evaluated.
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

    /// Work for the compliances at `s`: all of it but the pairs'. `meet` is called with each panel, and whether it
    /// is halved.
    ///
    /// # Errors
    /// As for [`Compliances::compliance`].
    pub(crate) fn counts(
        &self,
        profile: &SoilProfile,
        s: Complex,
        work: &mut Workspace,
        mut meet: impl FnMut(Panel, bool),
    ) -> Result<Counts> {
        let Workspace { compliance, panels: work } = work;
        compliance.set(profile, s)?;
        let (reach, deep) = (Self::reach(compliance), deep(profile));
        let panels = self.panels(reach.max(deep))?;
        let deep = if deep > reach { 1.0 } else { 0.0 };
        let mut counts = Counts { integrals: 1.0, deep, ..Counts::default() };
        compliance.visited = 0;
        let before = work.evaluations;
        let mut count = |panel: Panel, found: Found, evaluations: usize| {
            counts.panels += 1.0;
            let halved = matches!(found, Found::Moments(_));
            meet(panel, halved);
            if halved {
                counts.halved += 1.0;
                counts.halves += evaluations as f64;
            }
        };
        let resolved = self.resolve(panels, work, &mut |k| compliance.at(k), &mut count);
        resolved.map_err(|k| unresolved(s, k))?;
        counts.evaluations = (work.evaluations - before) as f64;
        // The lowest is a half-plane, or half as dear as another layer on a rigid base.
        let lowest = if compliance.half_plane().is_some() { 1.0 } else { 0.5 };
        counts.layers = compliance.visited as f64 - lowest * counts.evaluations;
        Ok(counts)
    }

    /// Compliances at s = 0 with `symbol` for C up to `least` (1/m) at least, and the static tail of the
    /// top layer of `compliance` beyond.
    pub(super) fn at_rest(
        &self,
        compliance: &Compliance,
        least: f64,
        work: &mut Scratch,
        values: &mut [[Complex; KINDS]],
        symbol: &mut dyn FnMut(f64) -> SurfaceCompliance,
    ) -> Result<()> {
        let panels = self.panels(least)?;
        let resolved = self.sum(panels, work, symbol);
        resolved.map_err(|k| unresolved(Complex::default(), k))?;
        self.add_tail(compliance, panels, work);
        self.read(work, values);
        Ok(())
    }

    /// Least K for which the series of the tail converges.
    fn reach(compliance: &Compliance) -> f64 {
        REACH * compliance.root()
    }

    /// Number of panels up to K ≥ `least`.
    fn panels(&self, least: f64) -> Result<usize> {
        let width = self.forms.width;
        let short = (SHORT / self.shortest).min(MOST_FOR_SHORT * width);
        let count = (least / width).max(short / width).ceil().max(1.0);
        if count > MOST_PANELS {
            let (span, wavenumber) = (self.span, least);
            return Err(LayeredError::TooFine { span, wavenumber }.into());
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked")]
        let count = count as usize;
        Ok(on_grid(count))
    }

    /// Panels up to K into `work.sums`; the wavenumber where halving stopped if it did.
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
        let outcome = self.resolve(panels, work, symbol, &mut |panel, found, _| match found {
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

    /// Number of panels that an integral begins with at `s`.
    ///
    /// # Errors
    /// As for [`Compliances::compliance`].
    pub(crate) fn widest(&self, profile: &SoilProfile, s: Complex) -> Result<usize> {
        let mut compliance = Compliance::default();
        compliance.set(profile, s)?;
        let panels = self.panels(Self::reach(&compliance).max(deep(profile)))?;
        let mut widest = vec![];
        self.begin(panels, &mut vec![], |panel| widest.push(panel));
        Ok(widest.len())
    }

    /// Adds the series beyond the last panel.
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

    fn read(&self, work: &Scratch, values: &mut [[Complex; KINDS]]) {
        const UNIT: f64 = std::f64::consts::FRAC_1_PI;
        for (class, value) in values.iter_mut().enumerate().take(self.forms.shapes.len()) {
            let (sums, lane) = (&work.sums[class / LANES], class % LANES);
            let part = |i: usize| Complex::new(sums[i][lane], sums[i + 1][lane]);
            *value = [part(0).scale(UNIT), part(2).scale(UNIT), part(4).scale(-UNIT)];
        }
    }
}

/// Error of an integral at `s` whose halving stopped at the wavenumber `k`.
pub(crate) fn unresolved(s: Complex, k: f64) -> Error {
    LayeredError::Unresolved { re: s.re, im: s.im, wavenumber: k }.into()
}

/// Least K for which the surface sees nothing of the top layer's bottom, 1/m.
pub(crate) fn deep(profile: &SoilProfile) -> f64 {
    profile.layers().first().map_or(0.0, |layer| DEEP / layer.thickness)
}

/// zz, xx, xz, real and imaginary, times a weight.
pub(super) fn parts(c: &SurfaceCompliance, weight: f64) -> [f64; 6] {
    [c.zz.re, c.zz.im, c.xx.re, c.xx.im, c.xz.re, c.xz.im].map(|x| weight * x)
}

#[cfg(test)]
mod tests;
