//! Panels of wavenumbers, halved until the surface compliance is a polynomial on each.

use super::compliance::SurfaceCompliance;
use super::form_factors::{LEGENDRE_DEGREES, PANEL_POINTS, Panel, legendre_at};
use super::tail::grid;
use super::wavenumber::{
    IntegralBuffers, MIN_TAIL_PHASE, PanelResult, Wavenumbers, weighted_parts,
};
use crate::linalg::Complex;
use crate::linalg::gauss::Rule;

/// Rounding error of C relative to its largest value on a panel.
pub(crate) const ROUNDING_FLOOR_FACTOR: f64 = 3e-14;
/// Exponent of the tolerance for Legendre coefficients neglected on the narrowest panels and their halves.
///
/// 16 points integrate products up to degree 31, so the error is about the coefficients' power 3/2 to 5/3.
pub(crate) const PANEL_TOLERANCE_EXPONENT: f64 = 2.0 / 3.0;
/// Largest number of successive halvings of a panel.
const MAX_HALVING_DEPTH: u32 = 44;
/// Largest number of halves of one integral: rounding above [`ROUNDING_FLOOR_FACTOR`] must not halve for ever.
const MAX_HALVES: usize = 1 << 16;

/// Halves the panel from `start`, of width `panel_width`, until C is resolved on every part.
///
/// `sample` gets the left end and the width of a part, and returns its samples and whether they resolve it.
/// `take` gets the position and size of a resolved part relative to the panel, its width and its samples.
/// Returns the wavenumber at which halving stopped as the error.
pub(crate) fn by_halves<S>(
    [start, panel_width]: [f64; 2],
    stack: &mut Vec<(f64, f64, u32)>,
    mut sample: impl FnMut(f64, f64) -> (S, bool),
    mut take: impl FnMut([f64; 2], f64, S),
) -> std::result::Result<(), f64> {
    let mut halves = 0;
    stack.clear();
    stack.extend([(0.5, 0.5, 1), (0.0, 0.5, 1)]);
    while let Some((place, size, depth)) = stack.pop() {
        let left = start + panel_width * place;
        let width = panel_width * size;
        let (samples, is_resolved) = sample(left, width);
        if is_resolved {
            take([place, size], width, samples);
        } else if depth < MAX_HALVING_DEPTH && halves < MAX_HALVES {
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
pub(crate) fn median(mut sizes: [f64; PANEL_POINTS]) -> f64 {
    *sizes.select_nth_unstable_by(PANEL_POINTS / 2, f64::total_cmp).1
}

/// Largest size of the last two Legendre coefficients of functions given by `samples` at Gauss points.
///
/// `None` if a coefficient is not a number.
pub(crate) fn last_coefficients<const N: usize>(
    samples: impl Iterator<Item = [Complex; N]>,
    rule: &Rule,
    polynomials: &[[f64; LEGENDRE_DEGREES]],
) -> Option<f64> {
    let mut last = [[Complex::default(); N]; 2];
    for ((values, weight), polynomials) in samples.zip(&rule.weights).zip(polynomials) {
        for (degree, last) in [PANEL_POINTS - 2, PANEL_POINTS - 1].into_iter().zip(&mut last) {
            let factor = (degree as f64 + 0.5) * weight * polynomials[degree];
            for (last, value) in last.iter_mut().zip(values) {
                *last += value.scale(factor);
            }
        }
    }
    let errors: [f64; N] = std::array::from_fn(|c| last[0][c].abs() + last[1][c].abs());
    (!errors.iter().sum::<f64>().is_nan()).then(|| errors.into_iter().fold(0.0, f64::max))
}

/// Largest errors of the integral over a panel.
struct MaxErrors {
    /// On panels wider than the narrowest.
    wide: f64,
    /// On the narrowest panels and their halves.
    narrow: f64,
}

impl Wavenumbers {
    /// Calls `take` with each panel up to K and the result on it.
    pub(super) fn integrate_panels(
        &self,
        panels: usize,
        work: &mut IntegralBuffers,
        compliance: &mut dyn FnMut(f64) -> SurfaceCompliance,
        take: &mut dyn FnMut(Panel, PanelResult),
    ) -> std::result::Result<(), f64> {
        let max_errors = self.sample_widest_panels(panels, work, compliance);
        for place in 0..work.samples.len() {
            let (mut panel, mut samples) = work.samples[place];
            work.wide.clear();
            loop {
                let extent = self.forms.extent(panel);
                let is_narrow = panel.level == 0;
                let max_error = if is_narrow { max_errors.narrow } else { max_errors.wide };
                if self.is_resolved(&samples, extent, max_error) {
                    take(panel, PanelResult::Samples(&samples));
                } else if is_narrow {
                    let moments = self.halve_panel(extent, max_error, work, compliance)?;
                    take(panel, PanelResult::Moments(&moments));
                } else {
                    work.wide.extend(panel.halves().into_iter().rev());
                }
                let Some(next) = work.wide.pop() else { break };
                panel = next;
                samples = self.compliance_samples(self.forms.extent(panel), compliance);
                work.evaluations += PANEL_POINTS;
            }
        }
        Ok(())
    }

    /// Calls `take` with the widest panels up to K.
    pub(super) fn for_each_widest_panel(
        &self,
        panels: usize,
        stack: &mut Vec<Panel>,
        mut take: impl FnMut(Panel),
    ) {
        let widest = grid(panels);
        let level = widest.ilog2();
        stack.clear();
        stack.extend((0..panels / widest).rev().map(|index| Panel { level, index }));
        while let Some(panel) = stack.pop() {
            let left = self.forms.extent(panel)[0];
            // Near k = 0 the four waves of a wide panel would cancel.
            if panel.level > 0 && (panel.index < 2 || left * self.shortest < MIN_TAIL_PHASE) {
                stack.extend(panel.halves().into_iter().rev());
            } else {
                take(panel);
            }
        }
    }

    /// Stores samples on the widest panels up to K in `work.samples`.
    fn sample_widest_panels(
        &self,
        panels: usize,
        work: &mut IntegralBuffers,
        compliance: &mut dyn FnMut(f64) -> SurfaceCompliance,
    ) -> MaxErrors {
        let IntegralBuffers { samples, wide, .. } = work;
        samples.clear();
        let mut integral_size = 0.0;
        self.for_each_widest_panel(panels, wide, |panel| {
            let extent = self.forms.extent(panel);
            let panel_samples = self.compliance_samples(extent, compliance);
            let size = median(panel_samples.map(|c| c.xx.abs() + c.zz.abs()));
            let middle = extent[0] + 0.5 * extent[1];
            let form_size = (2.0 / (middle * self.longest)).powi(2).min(1.0);
            integral_size += 0.5 * extent[1] * form_size * size;
            samples.push((panel, panel_samples));
        });
        work.evaluations += PANEL_POINTS * work.samples.len();
        MaxErrors {
            wide: self.tolerance * integral_size,
            narrow: self.tolerance.powf(PANEL_TOLERANCE_EXPONENT) * integral_size,
        }
    }

    /// C at the Gauss points of a panel, by its left end and its width.
    fn compliance_samples(
        &self,
        [left, width]: [f64; 2],
        compliance: &mut dyn FnMut(f64) -> SurfaceCompliance,
    ) -> [SurfaceCompliance; PANEL_POINTS] {
        std::array::from_fn(|i| compliance(left + 0.5 * width * (1.0 + self.forms.rule.nodes[i])))
    }

    /// Whether the last two Legendre coefficients of C are small enough.
    fn is_resolved(
        &self,
        samples: &[SurfaceCompliance; PANEL_POINTS],
        [left, width]: [f64; 2],
        max_error: f64,
    ) -> bool {
        let values = samples.iter().map(|sample| [sample.xx, sample.zz, sample.xz]);
        let rule = &self.forms.rule;
        let Some(error) = last_coefficients(values.clone(), rule, &self.polynomials) else {
            return false;
        };
        let sizes = values.flatten().map(|value| value.re.abs().max(value.im.abs()));
        let largest = sizes.fold(0.0_f64, f64::max);
        let form_size = (2.0 / (left * self.shortest)).powi(2).min(1.0);
        error * width * form_size <= max_error || error <= ROUNDING_FLOOR_FACTOR * largest
    }

    /// ∫ C Pₙ dk over one panel, by repeated halving.
    fn halve_panel(
        &self,
        extent: [f64; 2],
        max_error: f64,
        work: &mut IntegralBuffers,
        compliance: &mut dyn FnMut(f64) -> SurfaceCompliance,
    ) -> std::result::Result<[[f64; 6]; LEGENDRE_DEGREES], f64> {
        let rule = &self.forms.rule;
        let mut moments = [[0.0; 6]; LEGENDRE_DEGREES];
        let IntegralBuffers { stack, evaluations, .. } = work;
        let sample = |left: f64, width: f64| {
            *evaluations += PANEL_POINTS;
            let samples = self.compliance_samples([left, width], compliance);
            let is_resolved = self.is_resolved(&samples, [left, width], max_error);
            (samples, is_resolved)
        };
        by_halves(extent, stack, sample, |[place, size], width, samples| {
            let x: [f64; PANEL_POINTS] =
                std::array::from_fn(|i| 2.0 * (place + 0.5 * size * (1.0 + rule.nodes[i])) - 1.0);
            let polynomials = legendre_at(x);
            let c: [[f64; 6]; PANEL_POINTS] =
                std::array::from_fn(|i| weighted_parts(&samples[i], 0.5 * width * rule.weights[i]));
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
