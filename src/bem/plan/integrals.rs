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

use super::form_table::{FormRows, FormTable, TERMS};
use super::forms::FORMS;
use crate::bem::layered::{
    Compliance, Compliances, DEGREES, FLOOR, POINTS, SHARE, SurfaceCompliance, by_halves, deep,
    last_coefficients, legendre, median, surface_outlook, surface_series, unresolved,
};
use crate::error::{GroundError, Result, Watch};
use crate::geometry::{Lattice, SERIES_PER_OFFSET};
use crate::linalg::Complex;
use crate::soil::SoilProfile;

/// Kernels: zz, rr, tt and zr.
const KERNELS: usize = 4;
/// C minus its static value, times k; or moments of it.
type Kernel = [Complex; KERNELS];

/// For each form: the first sum that it contributes to, and the factor of each kernel there.
///
/// Sums: real and imaginary parts of zz, xx, yy, xy, zx, zy.
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
pub(in crate::bem) struct Integrals {
    pub(super) table: FormTable,
    pub(super) finest: f64,
    pub(super) tolerance: f64,
}

/// Scratch of one thread.
#[derive(Debug, Default)]
pub(crate) struct Workspace {
    ground: Compliance,
    panels: Scratch,
}

/// Scratch for the panels of one integral after the other.
#[derive(Debug, Default)]
struct Scratch {
    /// Kernels at all points, with their weights.
    kernels: Vec<Kernel>,
    samples: Vec<[Kernel; POINTS]>,
    stack: Vec<(f64, f64, u32)>,
    weights: Vec<f64>,
    sums: Vec<f64>,
    /// Number of evaluations of C so far.
    evaluations: usize,
}

/// The ground at one Laplace variable.
struct Symbol<'a> {
    ground: &'a mut Compliance,
    /// k C at rest.
    rest: Kernel,
}

impl Symbol<'_> {
    fn at(&mut self, k: f64) -> Kernel {
        let SurfaceCompliance { xx, zz, xz } = self.ground.at(k);
        let all = [zz, xx, self.ground.across(), xz];
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

/// Compliances zz, xx, yy, xy, zx and zy of each class, m³/Pa × m.
impl Compliances<SERIES_PER_OFFSET> for Integrals {
    type Workspace = Workspace;

    /// Measured: 0.4 to 4.8 (8 × 8 cells, half-space and damped layer, two steps, tolerances 1e-13 to 1e-10, up to
    /// 32 768 lags).
    const LATE_ERROR: f64 = 5.0;

    fn make_ready(&self, watch: &mut Watch) -> Result<()> {
        self.table.tabulate(watch)
    }

    fn compliance(
        &self,
        profile: &SoilProfile,
        s: Complex,
        work: &mut Workspace,
        values: &mut [[Complex; SERIES_PER_OFFSET]],
    ) -> Result<()> {
        let Workspace { ground, panels: work } = work;
        ground.set(profile, s)?;
        self.sum(ground, s, work)?;
        let classes = self.table.classes;
        let unit = 0.5 * std::f64::consts::FRAC_1_PI;
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
        work.panels.evaluations += surface_outlook(profile, &mut work.ground, sizes, values);
        Ok(())
    }
}

impl Integrals {
    /// Integrals for `profile` at all Laplace variables of `list`; `tolerance` relative to a cell's own
    /// compliance.
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
        let integrals = Self::sketch(lattice, profile, list, tolerance)?;
        integrals.table.tabulate(watch)?;
        Ok(integrals)
    }

    /// Integrals without tabulated forms; [`Compliances::make_ready`] tabulates them.
    ///
    /// # Errors
    /// As for [`SoilProfile::moduli`]; [`GroundError::TooFine`]; [`Error::Memory`](crate::Error::Memory).
    pub(super) fn sketch(
        lattice: &Lattice,
        profile: &SoilProfile,
        list: impl IntoIterator<Item = Complex>,
        tolerance: f64,
    ) -> Result<Self> {
        let mut ground = Compliance::default();
        let mut root = 0.0_f64;
        for s in list {
            ground.set(profile, s)?;
            root = root.max(ground.root());
        }
        let table = FormTable::new(lattice, [root, deep(profile)])?;
        Ok(Self { table, finest: lattice.finest(), tolerance })
    }

    fn sum(&self, ground: &mut Compliance, s: Complex, work: &mut Scratch) -> Result<()> {
        let (modulus, q2, a2) = ground.top();
        let series = series(a2);
        let softness = modulus.inverse();
        let panels = self.table.panels(ground.root());
        let Some([values, tail]) = self.table.tabulated(panels) else {
            let width = self.table.width;
            let span = self.table.span();
            let wavenumber = panels as f64 * width;
            let most = self.table.end as f64 * width;
            return Err(GroundError::TooFine { span, wavenumber, most }.into());
        };
        work.sums.clear();
        work.sums.resize(2 * SERIES_PER_OFFSET * self.table.classes, 0.0);
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
            self.add(panel.map_or(values, |panel| self.table.legendre(panel)), work);
        })
        .map_err(|wavenumber| unresolved(s, wavenumber))
    }

    /// Calls `take` with kernels at the points of all panels up to K, and with moments of each halved panel.
    ///
    /// Returns as an error the wavenumber at which halving stopped without success.
    fn resolve(
        &self,
        panels: usize,
        work: &mut Scratch,
        symbol: &mut Symbol,
        take: &mut dyn FnMut(Option<usize>, &mut Scratch),
    ) -> std::result::Result<(), f64> {
        let width = self.table.width;
        let half = 0.5 * self.table.width;
        work.samples.clear();
        let mut whole = 0.0;
        for panel in 0..panels {
            let left = panel as f64 * width;
            let samples = self.sampled(left, width, symbol);
            let size = median(samples.map(|c| c[0].abs() + c[1].abs()));
            whole += half * self.share(left + half) * (size + symbol.rest[0].abs());
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

    /// Ratio of the forms' weight at a wavenumber to their weight at zero.
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
        let rule = &self.table.rule;
        let polynomials = &self.table.polynomials;
        let Some(error) = last_coefficients(samples.iter().copied(), rule, polynomials) else {
            return false;
        };
        let whole = samples.iter().flat_map(|sample| sample.iter().zip(symbol.rest));
        let largest = whole.fold(0.0_f64, |most, (value, rest)| most.max((*value + rest).square()));
        error * width * self.share(left) <= allowed || error <= FLOOR * largest.sqrt()
    }

    /// Moments ∫ C Pₙ dk over one panel, by halves; written to `work.kernels`.
    fn halved(
        &self,
        panel: usize,
        allowed: f64,
        work: &mut Scratch,
        symbol: &mut Symbol,
    ) -> std::result::Result<(), f64> {
        let whole = self.table.width;
        let Scratch { kernels, stack, evaluations, .. } = work;
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
    fn add(&self, rows: &FormRows, work: &mut Scratch) {
        let Scratch { kernels, weights, sums, .. } = work;
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

#[cfg(test)]
mod tests;
