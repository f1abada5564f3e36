//! Compliances of the cells of a lattice by integrals over the wavenumber.
//!
//! With C the surface compliance of a profile (`C_rr` along the wavenumber, `C_tt` across it) and g the
//! [means](super::angular_means) over its direction, integrals over receiver and source are
//!
//! | series | 2π × |
//! |---|---|
//! | `F_zz` | ∫ `C_zz` g₀ k dk |
//! | `F_xx`, `F_yy` | ∫ (`C_rr` `g_cc` + `C_tt` `g_ss`) k dk, ∫ (`C_rr` `g_ss` + `C_tt` `g_cc`) k dk |
//! | `F_xy` | ∫ (`C_rr` − `C_tt`) `g_cs` k dk |
//! | `F_zx`, `F_zy` | −∫ `C_zr` `g_c` k dk, −∫ `C_zr` `g_s` k dk (down due to shear) |
//!
//! What the half-space of the top layer has at rest goes into closed forms, so that k times the rest is integrated up
//! to K, where its series takes over. Panels are halved until that rest is a polynomial; what halves find reaches the
//! cells through Legendre moments over the whole panel, so that only C is evaluated more often. No pole lies on the
//! axis for Re s > 0, and none of this needs a regularisation at k = 0.

use super::angular_means::FORMS;
use super::form_table::{FormTable, Need, Rows, TERMS};
use super::sh::transverse;
use crate::bem::layered::{
    Compliance, Compliances, DEGREES, FLOOR, POINTS, SHARE, Surface, by_halves, legendre,
    surface_outlook, surface_series,
};
use crate::error::{Error, LayeredError, PlanError, Result, Watch};
use crate::geometry::{Lattice, SERIES};
use crate::linalg::Complex;
use crate::soil::SoilProfile;

/// Kernels: zz, rr, tt and zr.
const KERNELS: usize = 4;
/// C − C at rest, times k; or its moments.
type Kernel = [Complex; KERNELS];
/// Decay lengths in the top layer beyond which its bottom is not felt: e^(−2·20) is 4e-18.
const DEEP: f64 = 20.0;

/// Per form: the first of the sums it goes into (real and imaginary parts of zz, xx, yy, xy, zx, zy), and the share of
/// each kernel there.
const SHARES: [(usize, &[[f64; KERNELS]]); FORMS] = [
    (0, &[[1.0, 0.0, 0.0, 0.0]]),
    (2, &[[0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]),
    (2, &[[0.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 0.0]]),
    (6, &[[0.0, 1.0, -1.0, 0.0]]),
    (8, &[[0.0, 0.0, 0.0, -1.0]]),
    (10, &[[0.0, 0.0, 0.0, -1.0]]),
];

/// Integrals over the wavenumber for the cells of a lattice.
#[derive(Debug)]
pub(super) struct Integrals {
    pub(super) table: FormTable,
    pub(super) finest: f64,
    tolerance: f64,
}

/// What one thread needs for one integral after the other.
#[derive(Debug, Default)]
pub(crate) struct Workspace {
    ground: Compliance,
    /// At all points, with their weights.
    kernels: Vec<Kernel>,
    samples: Vec<[Kernel; POINTS]>,
    stack: Vec<(f64, f64, u32)>,
    weights: Vec<f64>,
    sums: Vec<f64>,
    /// Number of evaluations of C so far.
    pub(super) evaluations: usize,
}

/// The ground at one Laplace variable.
struct Symbol<'a> {
    ground: &'a mut Compliance,
    /// k C at rest.
    rest: Kernel,
}

impl Symbol<'_> {
    fn at(&mut self, k: f64) -> Kernel {
        let Surface { xx, zz, xz } = self.ground.at(k);
        let all = [zz, xx, transverse(self.ground), xz];
        std::array::from_fn(|i| all[i].scale(k) - self.rest[i])
    }
}

/// dⱼ of zz, rr, tt, zr: C = Σ dⱼ (q₂/k²)ʲ/(μk) in the half-space of the top layer.
fn series(a2: f64) -> [[f64; KERNELS]; TERMS] {
    let [rr, zz, zr] = surface_series(a2);
    let mut tt = 1.0;
    std::array::from_fn(|j| {
        let term = [zz[j], rr[j], tt, zr[j]];
        // (1 + x)^(−½).
        tt *= -(j as f64 + 0.5) / (j as f64 + 1.0);
        term
    })
}

/// Of a class zz, xx, yy, xy, zx and zy, m³/Pa × m.
impl Compliances<SERIES> for Integrals {
    type Workspace = Workspace;

    fn compliance(
        &self,
        profile: &SoilProfile,
        s: Complex,
        work: &mut Workspace,
        values: &mut [[Complex; SERIES]],
    ) -> Result<()> {
        let mut ground = std::mem::take(&mut work.ground);
        let outcome = ground.set(profile, s).and_then(|()| self.sum(&mut ground, s, work));
        work.ground = ground;
        outcome?;
        let (classes, unit) = (self.table.classes, 0.5 * std::f64::consts::FRAC_1_PI);
        for (class, values) in values.iter_mut().enumerate() {
            for (series, value) in values.iter_mut().enumerate() {
                let part = |part: usize| unit * work.sums[(2 * series + part) * classes + class];
                *value = Complex::new(part(0), part(1));
            }
        }
        Ok(())
    }

    fn outlook(
        &self,
        profile: &SoilProfile,
        s: Complex,
        work: &mut Workspace,
        values: &mut Vec<Complex>,
    ) -> Result<()> {
        work.ground.set(profile, s)?;
        let sizes = [self.finest, self.table.span()];
        work.evaluations += surface_outlook(profile, &mut work.ground, sizes, values);
        Ok(())
    }
}

impl Integrals {
    /// Panels of an integral, and those of them that are halved; its evaluations are added to those of `work`.
    pub(super) fn counts(
        &self,
        profile: &SoilProfile,
        s: Complex,
        work: &mut Workspace,
    ) -> Result<[usize; 2]> {
        let mut ground = std::mem::take(&mut work.ground);
        let outcome = ground.set(profile, s).and_then(|()| {
            let (modulus, q2, a2) = ground.top();
            let panels = self.table.panels(q2.sqrt().abs());
            let rest = series(a2)[0].map(|d| modulus.inverse().scale(d));
            let mut halved = 0;
            self.resolve(
                panels,
                work,
                &mut Symbol { ground: &mut ground, rest },
                &mut |panel, _| {
                    halved += usize::from(panel.is_some());
                },
            )
            .map_err(|wavenumber| unresolved(s, wavenumber))?;
            Ok([panels, halved])
        });
        work.ground = ground;
        outcome
    }

    /// Integrals that serve `profile` at all Laplace variables of `list`, relative to a cell's own compliance.
    ///
    /// # Errors
    /// [`Error::Stopped`](crate::Error::Stopped); as for [`Integrals::sketch`].
    pub(super) fn new(
        lattice: &Lattice,
        profile: &SoilProfile,
        list: impl IntoIterator<Item = Complex>,
        tolerance: f64,
        watch: &mut Watch,
    ) -> Result<Self> {
        let mut integrals = Self::sketch(lattice, profile, list, tolerance)?;
        integrals.table.tabulate(watch)?;
        Ok(integrals)
    }

    /// The same without the forms, to be counted.
    ///
    /// # Errors
    /// As for [`SoilProfile::moduli`]; [`PlanError::TooFine`]; [`Error::Memory`](crate::Error::Memory).
    pub(super) fn sketch(
        lattice: &Lattice,
        profile: &SoilProfile,
        list: impl IntoIterator<Item = Complex>,
        tolerance: f64,
    ) -> Result<Self> {
        let deep = profile.layers().first().map_or(0.0, |layer| DEEP / layer.thickness);
        let mut ground = Compliance::default();
        let mut root = 0.0_f64;
        for s in list {
            ground.set(profile, s)?;
            let own = ground.top().1.sqrt().abs();
            // Squares may leave the range of f64.
            root = root.max(if own.is_nan() { f64::INFINITY } else { own });
        }
        let table = FormTable::new(lattice, Need { root, deep })?;
        Ok(Self { table, finest: lattice.finest(), tolerance })
    }

    fn sum(&self, ground: &mut Compliance, s: Complex, work: &mut Workspace) -> Result<()> {
        let (modulus, q2, a2) = ground.top();
        let series = series(a2);
        let softness = modulus.inverse();
        let panels = self.table.panels(q2.sqrt().abs());
        let Some(tail) = self.table.tail(panels) else {
            let width = self.table.width;
            let (span, wavenumber) = (self.table.span(), panels as f64 * width);
            return Err(PlanError::TooFine { span, wavenumber }.into());
        };
        work.sums.clear();
        work.sums.resize(2 * SERIES * self.table.classes, 0.0);
        let ratio = q2.scale(self.table.unit().powi(-2));
        let mut power = softness;
        work.kernels.clear();
        for term in series {
            work.kernels.push(term.map(|d| power.scale(d)));
            power = power * ratio;
        }
        self.add(tail, work);
        let rest = series[0].map(|d| softness.scale(d));
        self.resolve(panels, work, &mut Symbol { ground, rest }, &mut |panel, work| {
            self.add(panel.map_or(&self.table.values, |panel| self.table.legendre(panel)), work);
        })
        .map_err(|wavenumber| unresolved(s, wavenumber))
    }

    /// Calls `take` with kernels at the points of all panels up to K, and with moments of each that is halved; the
    /// wavenumber where halving stopped if it did.
    fn resolve(
        &self,
        panels: usize,
        work: &mut Workspace,
        symbol: &mut Symbol,
        take: &mut dyn FnMut(Option<usize>, &mut Workspace),
    ) -> std::result::Result<(), f64> {
        let (width, half) = (self.table.width, 0.5 * self.table.width);
        work.samples.clear();
        let mut whole = 0.0;
        for panel in 0..panels {
            let left = panel as f64 * width;
            let samples = self.sampled(left, width, symbol);
            // The median: one sample beside a pole says little of the integral.
            let mut sizes = samples.map(|c| c[0].abs() + c[1].abs());
            let (_, median, _) = sizes.select_nth_unstable_by(POINTS / 2, f64::total_cmp);
            whole += half * self.share(left + half) * (*median + symbol.rest[0].abs());
            work.samples.push(samples);
        }
        work.evaluations += POINTS * panels;
        let allowed = self.tolerance.powf(SHARE) * whole;
        let mut hard = vec![];
        work.kernels.clear();
        for panel in 0..panels {
            let samples = &work.samples[panel];
            let left = panel as f64 * width;
            let good = self.resolved(samples, symbol, left, width, allowed);
            if !good {
                hard.push(panel);
            }
            for (sample, weight) in samples.iter().zip(&self.table.rule.weights) {
                let weight = if good { half * weight } else { 0.0 };
                let weighted = sample.map(|c| c.scale(weight));
                work.kernels.push(if good { weighted } else { Kernel::default() });
            }
        }
        take(None, work);
        for panel in hard {
            self.halved(panel, allowed, work, symbol)?;
            take(Some(panel), work);
        }
        Ok(())
    }

    /// How much less forms count at a wavenumber than at zero.
    fn share(&self, k: f64) -> f64 {
        (2.0 / (k * self.finest)).powi(2).min(1.0)
    }

    fn sampled(&self, left: f64, width: f64, symbol: &mut Symbol) -> [Kernel; POINTS] {
        std::array::from_fn(|i| symbol.at(left + 0.5 * width * (1.0 + self.table.rule.nodes[i])))
    }

    /// Whether the last two Legendre coefficients are small enough.
    fn resolved(
        &self,
        samples: &[Kernel; POINTS],
        symbol: &Symbol,
        left: f64,
        width: f64,
        allowed: f64,
    ) -> bool {
        let mut last = [Kernel::default(); 2];
        let mut largest = 0.0_f64;
        for (i, sample) in samples.iter().enumerate() {
            for (value, rest) in sample.iter().zip(symbol.rest) {
                largest = largest.max((*value + rest).square());
            }
            for (degree, last) in [POINTS - 2, POINTS - 1].into_iter().zip(&mut last) {
                let polynomial = self.table.polynomials[i][degree];
                let factor = (degree as f64 + 0.5) * self.table.rule.weights[i] * polynomial;
                for (last, value) in last.iter_mut().zip(sample) {
                    *last += value.scale(factor);
                }
            }
        }
        let errors = [0, 1, 2, 3].map(|c| last[0][c].abs() + last[1][c].abs());
        if errors.iter().sum::<f64>().is_nan() {
            return false;
        }
        let error = errors.into_iter().fold(0.0, f64::max);
        error * width * self.share(left) <= allowed || error <= FLOOR * largest.sqrt()
    }

    /// Moments ∫ C Pₙ dk over one panel, by halves, into `work.kernels`.
    fn halved(
        &self,
        panel: usize,
        allowed: f64,
        work: &mut Workspace,
        symbol: &mut Symbol,
    ) -> std::result::Result<(), f64> {
        let whole = self.table.width;
        let Workspace { kernels, stack, evaluations, .. } = work;
        kernels.clear();
        kernels.resize(DEGREES, Kernel::default());
        let sample = |left: f64, width: f64| {
            *evaluations += POINTS;
            let samples = self.sampled(left, width, symbol);
            let resolved = self.resolved(&samples, symbol, left, width, allowed);
            (samples, resolved)
        };
        by_halves([whole * panel as f64, whole], stack, sample, |[place, size], width, samples| {
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
    fn add(&self, rows: &Rows, work: &mut Workspace) {
        let Workspace { kernels, weights, sums, .. } = work;
        for (form, (first, shares)) in SHARES.into_iter().enumerate() {
            weights.clear();
            for kernel in &*kernels {
                for share in shares {
                    let terms = kernel.iter().zip(share).map(|(value, share)| value.scale(*share));
                    let sum = terms.fold(Complex::default(), |sum, term| sum + term);
                    weights.extend([sum.re, sum.im]);
                }
            }
            let classes = self.table.classes;
            let range = first * classes..(first + 2 * shares.len()) * classes;
            rows.combine(form, weights, &mut sums[range]);
        }
    }
}

fn unresolved(s: Complex, wavenumber: f64) -> Error {
    LayeredError::Unresolved { re: s.re, im: s.im, wavenumber }.into()
}

#[cfg(test)]
mod tests;
