//! Element compliances of a layered ground by integrals over the wavenumber.
//!
//! `F_zz` = (1/π) ∫₀^∞ `C_zz` `S_p` `S_q` cos kX dk, `F_xx` alike, and
//! `F_zx` = −(1/π) ∫₀^∞ `C_zx` `S_p` `S_q` sin kX dk (down due to shear, receiver X to the right),
//! integrals over receiver and source, m²/Pa × m.
//!
//! For Re s > 0 and passive layers no pole lies on the real axis, so the path is the axis itself: a
//! path into the complex plane would have to know where poles of backward waves are. Fixed panels of
//! 16 Gauss points are halved until C is a polynomial there; what halved panels find reaches the
//! pairs through Legendre moments over the whole panel, so that only C is evaluated more often. Beyond K the
//! integral is a [series](super::tail).

use super::compliance::{Compliance, Surface};
use super::form_factors::{DEGREES, FormFactors, LANES, POINTS, Sums, accumulate, legendre};
use super::tail::{REACH, TERMS, Tails, on_grid, surface_series};
use crate::error::{LayeredError, Result};
use crate::history::{KINDS, PairClasses};
use crate::linalg::Complex;
use crate::soil::SoilProfile;

/// Decay lengths in the top layer beyond which its bottom is not felt: e^(−2·20) is 4e-18.
const DEEP: f64 = 20.0;
/// K × shortest element: below it the second differences of the tail cancel.
const SHORT: f64 = 0.05;
/// Rounding of C relative to its largest value on a panel.
const FLOOR: f64 = 3e-14;
/// Exponent of the tolerance in the Legendre coefficients that may be left out: 16 points integrate
/// products up to degree 31, so the error is about their power 3/2 to 5/3.
const SHARE: f64 = 2.0 / 3.0;
/// Panels are halved at most so often.
const DEEPEST: u32 = 44;
/// Most halves of one integral: rounding beyond [`FLOOR`] must not halve without end.
const MOST_HALVES: usize = 1 << 16;
/// Most panels of one integral.
const MOST_PANELS: f64 = 65_536.0;
/// Panels that short elements may ask for.
const MOST_FOR_SHORT: f64 = 100.0;
/// Panels of an integral that are looked at to know what all of them cost.
const LOOKED_AT: usize = 256;

/// Integrals over the wavenumber for the pairs of a patch.
#[derive(Debug)]
pub(crate) struct Wavenumbers {
    pub(crate) forms: FormFactors,
    tails: Tails,
    /// Legendre polynomials at the Gauss points.
    polynomials: Vec<[f64; DEGREES]>,
    span: f64,
    pub(crate) shortest: f64,
    longest: f64,
    /// Accuracy relative to an element's own compliance.
    tolerance: f64,
}

/// What one thread needs for one integral after the other.
#[derive(Debug, Default)]
pub(crate) struct Workspace {
    pub(crate) compliance: Compliance,
    samples: Vec<[Surface; POINTS]>,
    sums: Vec<Sums>,
    stack: Vec<(f64, f64, u32)>,
    /// Number of evaluations of C so far.
    pub(crate) evaluations: usize,
}

/// Work that integrals take: numbers, estimated.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Counts {
    pub(crate) panels: f64,
    /// Those for the thickness of the top layer's sake.
    pub(crate) deep: f64,
    /// Those that are halved.
    pub(crate) halved: f64,
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
            deep: combine(self.deep, other.deep),
            halved: combine(self.halved, other.halved),
            halves: combine(self.halves, other.halves),
            layers: combine(self.layers, other.layers),
        }
    }
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

    /// Overwrites `values` (one per class: zz, xx, zx) with the compliances at `s`, Re s > 0 (or damped
    /// layers), integrals over receiver and source.
    ///
    /// # Errors
    /// As for [`SoilProfile::moduli`]; [`LayeredError::Unresolved`].
    pub(crate) fn compliance(
        &self,
        profile: &SoilProfile,
        s: Complex,
        work: &mut Workspace,
        values: &mut [[Complex; KINDS]],
    ) -> Result<()> {
        let mut compliance = std::mem::take(&mut work.compliance);
        let outcome = compliance.set(profile, s).and_then(|()| {
            let panels = self.panels(Self::reach(&compliance).max(Self::deep(profile)))?;
            let resolved = self.sum(panels, work, &mut |k| compliance.at(k));
            resolved.map_err(|k| unresolved(s, k))?;
            self.add_tail(&compliance, panels, work);
            Ok(())
        });
        work.compliance = compliance;
        outcome?;
        self.read(work, values);
        Ok(())
    }

    /// Work for the compliances at `s`, by a look at some panels.
    ///
    /// # Errors
    /// As for [`Wavenumbers::compliance`].
    pub(crate) fn counts(
        &self,
        profile: &SoilProfile,
        s: Complex,
        work: &mut Workspace,
    ) -> Result<Counts> {
        let mut compliance = std::mem::take(&mut work.compliance);
        let outcome = compliance.set(profile, s).and_then(|()| {
            let panels = self.panels(Self::reach(&compliance).max(Self::deep(profile)))?;
            let stride = panels.div_ceil(LOOKED_AT);
            compliance.visited = 0;
            let (mut halved, before) = (0.0, work.evaluations);
            let mut symbol = |k| compliance.at(k);
            let allowed = self.sample(panels, stride, work, &mut symbol);
            for (place, panel) in (0..panels).step_by(stride).enumerate() {
                let left = self.forms.width * panel as f64;
                if !self.resolved(&work.samples[place], left, self.forms.width, allowed) {
                    halved += 1.0;
                    let done = self.halved(left, allowed, work, &mut symbol);
                    done.map_err(|k| unresolved(s, k))?;
                }
            }
            let looked_at = panels.div_ceil(stride);
            let all = panels as f64 / looked_at as f64;
            let evaluations = work.evaluations - before;
            let halves = (evaluations - POINTS * looked_at) as f64;
            Ok(Counts {
                halved: all * halved,
                halves: all * halves,
                layers: all * (compliance.visited - evaluations) as f64,
                ..self.whole(profile, &compliance)?
            })
        });
        work.compliance = compliance;
        outcome
    }

    /// The same without a look: as if no panel were halved, and one layer seen.
    pub(crate) fn counts_of_panels(&self, profile: &SoilProfile, s: Complex) -> Result<Counts> {
        let mut compliance = Compliance::default();
        compliance.set(profile, s)?;
        self.whole(profile, &compliance)
    }

    fn whole(&self, profile: &SoilProfile, compliance: &Compliance) -> Result<Counts> {
        let (reach, deep) = (Self::reach(compliance), Self::deep(profile));
        let panels = self.panels(reach.max(deep))? as f64;
        let deep = if deep > reach { panels } else { 0.0 };
        Ok(Counts { panels, deep, ..Counts::default() })
    }

    /// The same at s = 0 with `symbol` for C up to `least` (1/m) at least, and the static tail of the
    /// top layer of `compliance` beyond.
    pub(super) fn at_rest(
        &self,
        compliance: &Compliance,
        least: f64,
        work: &mut Workspace,
        values: &mut [[Complex; KINDS]],
        symbol: &mut dyn FnMut(f64) -> Surface,
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
        let (_, q2, _) = compliance.top();
        let reach = REACH * q2.sqrt().abs();
        // Where squares leave the range of f64, no number of panels is enough.
        if reach.is_nan() { f64::INFINITY } else { reach }
    }

    /// Least K for which the surface sees nothing of the top layer's bottom, 1/m.
    pub(super) fn deep(profile: &SoilProfile) -> f64 {
        profile.layers().first().map_or(0.0, |layer| DEEP / layer.thickness)
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
        work: &mut Workspace,
        symbol: &mut dyn FnMut(f64) -> Surface,
    ) -> std::result::Result<(), f64> {
        let (forms, width) = (&self.forms, self.forms.width);
        work.sums.clear();
        work.sums.resize(forms.blocks(), Sums::default());
        let allowed = self.sample(panels, 1, work, symbol);
        for panel in 0..panels {
            let left = width * panel as f64;
            if self.resolved(&work.samples[panel], left, width, allowed) {
                let coefficients: [[f64; 6]; POINTS] = std::array::from_fn(|i| {
                    parts(&work.samples[panel][i], 0.5 * width * forms.rule.weights[i])
                });
                forms.with_values(panel, |rows| accumulate(rows, &coefficients, &mut work.sums));
            } else {
                let moments = self.halved(left, allowed, work, symbol)?;
                forms.with_legendre(panel, |rows| accumulate(rows, &moments, &mut work.sums));
            }
        }
        Ok(())
    }

    /// Every `stride`-th of so many panels into `work.samples`; the error that one of them may have.
    fn sample(
        &self,
        panels: usize,
        stride: usize,
        work: &mut Workspace,
        symbol: &mut dyn FnMut(f64) -> Surface,
    ) -> f64 {
        let width = self.forms.width;
        work.samples.clear();
        let mut whole = 0.0;
        for panel in (0..panels).step_by(stride) {
            let left = width * panel as f64;
            let samples = self.sampled(left, width, symbol);
            // The median: one sample beside a pole says little of the integral.
            let mut sizes = samples.map(|c| c.xx.abs() + c.zz.abs());
            let (_, median, _) = sizes.select_nth_unstable_by(POINTS / 2, f64::total_cmp);
            let share = (2.0 / ((left + 0.5 * width) * self.longest)).powi(2).min(1.0);
            whole += stride as f64 * 0.5 * width * share * *median;
            work.samples.push(samples);
        }
        work.evaluations += POINTS * work.samples.len();
        self.tolerance.powf(SHARE) * whole
    }

    fn sampled(
        &self,
        left: f64,
        width: f64,
        symbol: &mut dyn FnMut(f64) -> Surface,
    ) -> [Surface; POINTS] {
        std::array::from_fn(|i| symbol(left + 0.5 * width * (1.0 + self.forms.rule.nodes[i])))
    }

    /// Whether the last two Legendre coefficients of C are small enough.
    fn resolved(&self, samples: &[Surface; POINTS], left: f64, width: f64, allowed: f64) -> bool {
        let mut last = [[Complex::default(); KINDS]; 2];
        let mut largest = 0.0_f64;
        for (i, sample) in samples.iter().enumerate() {
            let values = [sample.xx, sample.zz, sample.xz];
            for value in values {
                largest = largest.max(value.re.abs()).max(value.im.abs());
            }
            for (degree, last) in [POINTS - 2, POINTS - 1].into_iter().zip(&mut last) {
                let polynomial = self.polynomials[i][degree];
                let factor = (degree as f64 + 0.5) * self.forms.rule.weights[i] * polynomial;
                for (last, value) in last.iter_mut().zip(values) {
                    *last += value.scale(factor);
                }
            }
        }
        let errors = [0, 1, 2].map(|c| last[0][c].abs() + last[1][c].abs());
        if errors.iter().sum::<f64>().is_nan() {
            return false;
        }
        let error = errors.into_iter().fold(0.0, f64::max);
        let share = (2.0 / (left * self.shortest)).powi(2).min(1.0);
        error * width * share <= allowed || error <= FLOOR * largest
    }

    /// ∫ C Pₙ dk over one panel, by halves.
    fn halved(
        &self,
        start: f64,
        allowed: f64,
        work: &mut Workspace,
        symbol: &mut dyn FnMut(f64) -> Surface,
    ) -> std::result::Result<[[f64; 6]; DEGREES], f64> {
        let whole = self.forms.width;
        let mut halves = 0;
        let mut moments = [[0.0; 6]; DEGREES];
        work.stack.clear();
        work.stack.extend([(0.5, 0.5, 1), (0.0, 0.5, 1)]);
        while let Some((place, size, depth)) = work.stack.pop() {
            let (left, width) = (start + whole * place, whole * size);
            let samples = self.sampled(left, width, symbol);
            work.evaluations += POINTS;
            if self.resolved(&samples, left, width, allowed) {
                for (i, sample) in samples.iter().enumerate() {
                    let x = 2.0 * (place + 0.5 * size * (1.0 + self.forms.rule.nodes[i])) - 1.0;
                    let c = parts(sample, 0.5 * width * self.forms.rule.weights[i]);
                    for (moment, polynomial) in moments.iter_mut().zip(legendre(x)) {
                        for (moment, c) in moment.iter_mut().zip(c) {
                            *moment += polynomial * c;
                        }
                    }
                }
            } else if depth < DEEPEST && halves < MOST_HALVES {
                halves += 2;
                let half = 0.5 * size;
                work.stack.extend([(place + half, half, depth + 1), (place, half, depth + 1)]);
            } else {
                return Err(left);
            }
        }
        Ok(moments)
    }

    /// Adds the series beyond the last panel.
    fn add_tail(&self, compliance: &Compliance, panels: usize, work: &mut Workspace) {
        let (modulus, q2, a2) = compliance.top();
        let [xx, zz, xz] = surface_series(a2);
        let limit = panels as f64 * self.forms.width;
        let ratio = q2.scale(1.0 / (limit * limit));
        let mut power = modulus.inverse();
        let mut coefficients = [[0.0; 6]; TERMS];
        for (j, coefficient) in coefficients.iter_mut().enumerate() {
            let value = |d: f64| power.scale(d);
            let surface = Surface { xx: value(xx[j]), zz: value(zz[j]), xz: value(xz[j]) };
            *coefficient = parts(&surface, 1.0);
            power = power * ratio;
        }
        accumulate(self.tails.rows(&self.forms, panels), &coefficients, &mut work.sums);
    }

    fn read(&self, work: &Workspace, values: &mut [[Complex; KINDS]]) {
        const UNIT: f64 = std::f64::consts::FRAC_1_PI;
        for (class, value) in values.iter_mut().enumerate().take(self.forms.shapes.len()) {
            let (sums, lane) = (&work.sums[class / LANES], class % LANES);
            let part = |i: usize| Complex::new(sums[i][lane], sums[i + 1][lane]);
            *value = [part(0).scale(UNIT), part(2).scale(UNIT), part(4).scale(-UNIT)];
        }
    }
}

/// Halving stopped at the wavenumber `k`.
fn unresolved(s: Complex, k: f64) -> LayeredError {
    LayeredError::Unresolved { re: s.re, im: s.im, wavenumber: k }
}

/// zz, xx, xz, real and imaginary, times a weight.
fn parts(c: &Surface, weight: f64) -> [f64; 6] {
    [c.zz.re, c.zz.im, c.xx.re, c.xx.im, c.xz.re, c.xz.im].map(|x| weight * x)
}

#[cfg(test)]
mod tests;
