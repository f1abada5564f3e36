//! Panels of wavenumbers, halved until the surface compliance is a polynomial on each.

use super::compliance::SurfaceCompliance;
use super::form_factors::{DEGREES, POINTS, Panel, legendre_at};
use super::tail::grid;
use super::wavenumber::{Found, SHORT, Scratch, Wavenumbers, parts};
use crate::linalg::Complex;
use crate::linalg::gauss::Rule;

/// Rounding error of C relative to its largest value on a panel.
pub(crate) const FLOOR: f64 = 3e-14;
/// Exponent of the tolerance for Legendre coefficients neglected on the narrowest panels and their halves.
///
/// 16 points integrate products up to degree 31, so the error is about the coefficients' power 3/2 to 5/3.
pub(crate) const SHARE: f64 = 2.0 / 3.0;
/// Largest number of successive halvings of a panel.
const DEEPEST: u32 = 44;
/// Largest number of halves of one integral: rounding above [`FLOOR`] must not cause endless halving.
const MOST_HALVES: usize = 1 << 16;

/// Halves the panel from `start`, of width `whole`, until C is resolved on every part.
///
/// `sample` gets the left end and the width of a part, and returns its samples and whether they resolve it.
/// `take` gets the position and size of a resolved part relative to the panel, its width and its samples.
/// Returns the wavenumber at which halving stopped as the error.
pub(crate) fn by_halves<S>(
    [start, whole]: [f64; 2],
    stack: &mut Vec<(f64, f64, u32)>,
    mut sample: impl FnMut(f64, f64) -> (S, bool),
    mut take: impl FnMut([f64; 2], f64, S),
) -> std::result::Result<(), f64> {
    let mut halves = 0;
    stack.clear();
    stack.extend([(0.5, 0.5, 1), (0.0, 0.5, 1)]);
    while let Some((place, size, depth)) = stack.pop() {
        let left = start + whole * place;
        let width = whole * size;
        let (samples, resolved) = sample(left, width);
        if resolved {
            take([place, size], width, samples);
        } else if depth < DEEPEST && halves < MOST_HALVES {
            halves += 2;
            let half = 0.5 * size;
            stack.extend([(place + half, half, depth + 1), (place, half, depth + 1)]);
        } else {
            return Err(left);
        }
    }
    Ok(())
}

/// Median of the samples' sizes: a single sample near a pole does not represent the integral.
pub(crate) fn median(mut sizes: [f64; POINTS]) -> f64 {
    *sizes.select_nth_unstable_by(POINTS / 2, f64::total_cmp).1
}

/// Largest size of the last two Legendre coefficients of functions given by `samples` at Gauss points.
///
/// `None` if a coefficient is not a number.
pub(crate) fn last_coefficients<const N: usize>(
    samples: impl Iterator<Item = [Complex; N]>,
    rule: &Rule,
    polynomials: &[[f64; DEGREES]],
) -> Option<f64> {
    let mut last = [[Complex::default(); N]; 2];
    for ((values, weight), polynomials) in samples.zip(&rule.weights).zip(polynomials) {
        for (degree, last) in [POINTS - 2, POINTS - 1].into_iter().zip(&mut last) {
            let factor = (degree as f64 + 0.5) * weight * polynomials[degree];
            for (last, value) in last.iter_mut().zip(values) {
                *last += value.scale(factor);
            }
        }
    }
    let errors: [f64; N] = std::array::from_fn(|c| last[0][c].abs() + last[1][c].abs());
    (!errors.iter().sum::<f64>().is_nan()).then(|| errors.into_iter().fold(0.0, f64::max))
}

impl Wavenumbers {
    /// Calls `take` with each panel and the result on it.
    pub(super) fn resolve(
        &self,
        panels: usize,
        work: &mut Scratch,
        symbol: &mut dyn FnMut(f64) -> SurfaceCompliance,
        take: &mut dyn FnMut(Panel, Found),
    ) -> std::result::Result<(), f64> {
        let allowed = self.sample(panels, work, symbol);
        for place in 0..work.samples.len() {
            let (mut panel, mut samples) = work.samples[place];
            work.wide.clear();
            loop {
                let [left, width] = self.forms.extent(panel);
                let below = panel.level == 0;
                if self.resolved(&samples, left, width, allowed[usize::from(below)]) {
                    take(panel, Found::Samples(&samples));
                } else if below {
                    let moments = self.halved(left, allowed[1], work, symbol)?;
                    take(panel, Found::Moments(&moments));
                } else {
                    let [one, two] = panel.halves();
                    work.wide.extend([two, one]);
                }
                let Some(next) = work.wide.pop() else { break };
                let [left, width] = self.forms.extent(next);
                (panel, samples) = (next, self.sampled(left, width, symbol));
                work.evaluations += POINTS;
            }
        }
        Ok(())
    }

    /// Calls `take` with the widest panels up to K.
    pub(super) fn begin(&self, panels: usize, stack: &mut Vec<Panel>, mut take: impl FnMut(Panel)) {
        let widest = grid(panels);
        let level = widest.ilog2();
        stack.clear();
        stack.extend((0..panels / widest).rev().map(|index| Panel { level, index }));
        while let Some(panel) = stack.pop() {
            let [left, _] = self.forms.extent(panel);
            // Near k = 0 the four waves of a wide panel would cancel.
            if panel.level > 0 && (panel.index < 2 || left * self.shortest < SHORT) {
                let [one, two] = panel.halves();
                stack.extend([two, one]);
            } else {
                take(panel);
            }
        }
    }

    /// Stores samples on the widest panels up to K in `work.samples`.
    ///
    /// Returns the errors allowed on wide panels and on the narrowest.
    fn sample(
        &self,
        panels: usize,
        work: &mut Scratch,
        symbol: &mut dyn FnMut(f64) -> SurfaceCompliance,
    ) -> [f64; 2] {
        let Scratch { samples, wide, .. } = work;
        samples.clear();
        let mut whole = 0.0;
        self.begin(panels, wide, |panel| {
            let [left, width] = self.forms.extent(panel);
            let found = self.sampled(left, width, symbol);
            let size = median(found.map(|c| c.xx.abs() + c.zz.abs()));
            let share = (2.0 / ((left + 0.5 * width) * self.longest)).powi(2).min(1.0);
            whole += 0.5 * width * share * size;
            samples.push((panel, found));
        });
        work.evaluations += POINTS * work.samples.len();
        [self.tolerance, self.tolerance.powf(SHARE)].map(|tolerance| tolerance * whole)
    }

    fn sampled(
        &self,
        left: f64,
        width: f64,
        symbol: &mut dyn FnMut(f64) -> SurfaceCompliance,
    ) -> [SurfaceCompliance; POINTS] {
        std::array::from_fn(|i| symbol(left + 0.5 * width * (1.0 + self.forms.rule.nodes[i])))
    }

    /// Whether the last two Legendre coefficients of C are small enough.
    fn resolved(
        &self,
        samples: &[SurfaceCompliance; POINTS],
        left: f64,
        width: f64,
        allowed: f64,
    ) -> bool {
        let values = |sample: &SurfaceCompliance| [sample.xx, sample.zz, sample.xz];
        let rule = &self.forms.rule;
        let all = samples.iter().map(values);
        let Some(error) = last_coefficients(all.clone(), rule, &self.polynomials) else {
            return false;
        };
        let sizes = all.flatten().map(|value| value.re.abs().max(value.im.abs()));
        let largest = sizes.fold(0.0_f64, f64::max);
        let share = (2.0 / (left * self.shortest)).powi(2).min(1.0);
        error * width * share <= allowed || error <= FLOOR * largest
    }

    /// ∫ C Pₙ dk over one panel, by repeated halving.
    fn halved(
        &self,
        start: f64,
        allowed: f64,
        work: &mut Scratch,
        symbol: &mut dyn FnMut(f64) -> SurfaceCompliance,
    ) -> std::result::Result<[[f64; 6]; DEGREES], f64> {
        let rule = &self.forms.rule;
        let mut moments = [[0.0; 6]; DEGREES];
        let Scratch { stack, evaluations, .. } = work;
        let sample = |left: f64, width: f64| {
            *evaluations += POINTS;
            let samples = self.sampled(left, width, symbol);
            let resolved = self.resolved(&samples, left, width, allowed);
            (samples, resolved)
        };
        by_halves([start, self.forms.width], stack, sample, |[place, size], width, samples| {
            let x: [f64; POINTS] =
                std::array::from_fn(|i| 2.0 * (place + 0.5 * size * (1.0 + rule.nodes[i])) - 1.0);
            let polynomials = legendre_at(x);
            let c: [[f64; 6]; POINTS] =
                std::array::from_fn(|i| parts(&samples[i], 0.5 * width * rule.weights[i]));
            for (moment, polynomials) in moments.iter_mut().zip(&polynomials) {
                for (polynomial, c) in polynomials.iter().zip(&c) {
                    for (moment, c) in moment.iter_mut().zip(c) {
                        *moment += polynomial * c;
                    }
                }
            }
        })?;
        Ok(moments)
    }
}
