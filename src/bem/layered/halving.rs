//! Panels of wavenumbers, halved until the surface compliance is a polynomial on each.

use super::compliance::SurfaceCompliance;
use super::form_factors::{LEGENDRE_DEGREES, PANEL_POINTS, Panel, legendre_at};
use super::tail::panel_count_step;
use super::wavenumber::{
    IntegralBuffers, MIN_TAIL_PHASE, PanelResult, Wavenumbers, weighted_parts,
};
use crate::linalg::Complex;
use crate::linalg::gauss::Rule;

/// Rounding error of the Legendre coefficients of C, relative to the largest value on a panel.
pub(crate) const ROUNDING_FLOOR_FACTOR: f64 = 3e-14;
/// Exponent of the tolerance for neglected Legendre coefficients on the narrowest panels and their halves.
///
/// 16 points integrate products up to degree 31 exactly, so that the error is about the power 3/2 to 5/3 of the
/// neglected coefficients.
pub(crate) const PANEL_TOLERANCE_EXPONENT: f64 = 2.0 / 3.0;
/// Largest number of successive halvings of a panel; the width of narrower parts is a rounding error of the wavenumber.
const MAX_HALVING_DEPTH: u32 = 44;
/// Largest number of halves of one integral, so that halving ends if rounding exceeds [`ROUNDING_FLOOR_FACTOR`].
const MAX_HALVES: usize = 1 << 16;

/// Halves a panel until C is resolved on every part.
///
/// `panel`: start and width. `sample_part` receives the start and the width of a part, and returns its samples and whether
/// they resolve the part. `use_part` receives a resolved part: start and size relative to the panel, width and samples.
///
/// # Errors
/// The wavenumber at which halving stopped without success.
pub(crate) fn by_halves<S>(
    panel: [f64; 2],
    stack: &mut Vec<(f64, f64, u32)>,
    mut sample_part: impl FnMut(f64, f64) -> (S, bool),
    mut use_part: impl FnMut([f64; 2], f64, S),
) -> std::result::Result<(), f64> {
    let [panel_start, panel_width] = panel;
    let mut half_count = 0;
    stack.clear();
    stack.extend([(0.5, 0.5, 1), (0.0, 0.5, 1)]);
    while let Some((part_start, part_size, depth)) = stack.pop() {
        let start = panel_start + panel_width * part_start;
        let width = panel_width * part_size;
        let (samples, is_resolved) = sample_part(start, width);
        if is_resolved {
            use_part([part_start, part_size], width, samples);
        } else if depth < MAX_HALVING_DEPTH && half_count < MAX_HALVES {
            half_count += 2;
            let half_size = 0.5 * part_size;
            stack.extend([
                (part_start + half_size, half_size, depth + 1),
                (part_start, half_size, depth + 1),
            ]);
        } else {
            return Err(start);
        }
    }
    Ok(())
}

/// Median of the samples' magnitudes, from which the integral's magnitude is estimated.
///
/// The largest sample would not represent the integral if it is near a pole.
pub(crate) fn median(mut magnitudes: [f64; PANEL_POINTS]) -> f64 {
    *magnitudes.select_nth_unstable_by(PANEL_POINTS / 2, f64::total_cmp).1
}

/// Largest sum of the magnitudes of the last two Legendre coefficients, for functions sampled at Gauss points.
///
/// `None` if a coefficient is not a number.
pub(crate) fn last_coefficients<const N: usize>(
    samples: impl Iterator<Item = [Complex; N]>,
    rule: &Rule,
    polynomials: &[[f64; LEGENDRE_DEGREES]],
) -> Option<f64> {
    let mut coefficients = [[Complex::default(); N]; 2];
    for ((values, weight), point_polynomials) in samples.zip(&rule.weights).zip(polynomials) {
        for (degree, sums) in
            [PANEL_POINTS - 2, PANEL_POINTS - 1].into_iter().zip(&mut coefficients)
        {
            let factor = (degree as f64 + 0.5) * weight * point_polynomials[degree];
            for (sum, value) in sums.iter_mut().zip(values) {
                *sum += value.scale(factor);
            }
        }
    }
    let errors: [f64; N] =
        std::array::from_fn(|c| coefficients[0][c].abs() + coefficients[1][c].abs());
    (!errors.iter().sum::<f64>().is_nan()).then(|| errors.into_iter().fold(0.0, f64::max))
}

/// Largest allowed errors of the integral over a panel.
struct MaxErrors {
    /// Error on panels wider than the narrowest.
    wide_panel: f64,
    /// Error on the narrowest panels and their halves.
    narrow_panel: f64,
}

impl Wavenumbers {
    /// Calls `use_panel` with each panel up to K and the result on it.
    pub(super) fn integrate_panels(
        &self,
        panel_count: usize,
        buffers: &mut IntegralBuffers,
        compliance: &mut dyn FnMut(f64) -> SurfaceCompliance,
        use_panel: &mut dyn FnMut(Panel, PanelResult),
    ) -> std::result::Result<(), f64> {
        let max_errors = self.sample_widest_panels(panel_count, buffers, compliance);
        for index in 0..buffers.samples.len() {
            let (mut panel, mut samples) = buffers.samples[index];
            buffers.panel_stack.clear();
            loop {
                let start_and_width = self.forms.start_and_width(panel);
                let is_narrow = panel.level == 0;
                let max_error =
                    if is_narrow { max_errors.narrow_panel } else { max_errors.wide_panel };
                if self.is_resolved(&samples, start_and_width, max_error) {
                    use_panel(panel, PanelResult::Samples(&samples));
                } else if is_narrow {
                    let moments =
                        self.halve_panel(start_and_width, max_error, buffers, compliance)?;
                    use_panel(panel, PanelResult::Moments(&moments));
                } else {
                    buffers.panel_stack.extend(panel.halves().into_iter().rev());
                }
                let Some(next_panel) = buffers.panel_stack.pop() else { break };
                panel = next_panel;
                samples = self.compliance_samples(self.forms.start_and_width(panel), compliance);
                buffers.evaluation_count += PANEL_POINTS;
            }
        }
        Ok(())
    }

    /// Calls `use_panel` with the widest panels up to K.
    pub(super) fn for_each_widest_panel(
        &self,
        panel_count: usize,
        stack: &mut Vec<Panel>,
        mut use_panel: impl FnMut(Panel),
    ) {
        let panel_step = panel_count_step(panel_count);
        let level = panel_step.ilog2();
        stack.clear();
        stack.extend((0..panel_count / panel_step).rev().map(|index| Panel { level, index }));
        while let Some(panel) = stack.pop() {
            let start = self.forms.start_and_width(panel)[0];
            // Near k = 0 the four waves of a wide panel nearly cancel.
            if panel.level > 0 && (panel.index < 2 || start * self.min_length < MIN_TAIL_PHASE) {
                stack.extend(panel.halves().into_iter().rev());
            } else {
                use_panel(panel);
            }
        }
    }

    /// Stores samples on the widest panels up to K in `buffers.samples`.
    fn sample_widest_panels(
        &self,
        panel_count: usize,
        buffers: &mut IntegralBuffers,
        compliance: &mut dyn FnMut(f64) -> SurfaceCompliance,
    ) -> MaxErrors {
        let IntegralBuffers { samples, panel_stack, .. } = buffers;
        samples.clear();
        let mut integral_magnitude = 0.0;
        self.for_each_widest_panel(panel_count, panel_stack, |panel| {
            let [start, width] = self.forms.start_and_width(panel);
            let panel_samples = self.compliance_samples([start, width], compliance);
            let magnitude = median(panel_samples.map(|c| c.xx.abs() + c.zz.abs()));
            let middle = start + 0.5 * width;
            let relative_form = (2.0 / (middle * self.max_length)).powi(2).min(1.0);
            integral_magnitude += 0.5 * width * relative_form * magnitude;
            samples.push((panel, panel_samples));
        });
        buffers.evaluation_count += PANEL_POINTS * buffers.samples.len();
        MaxErrors {
            wide_panel: self.tolerance * integral_magnitude,
            narrow_panel: self.tolerance.powf(PANEL_TOLERANCE_EXPONENT) * integral_magnitude,
        }
    }

    /// C at the Gauss points of a panel from its start and width.
    fn compliance_samples(
        &self,
        [start, width]: [f64; 2],
        compliance: &mut dyn FnMut(f64) -> SurfaceCompliance,
    ) -> [SurfaceCompliance; PANEL_POINTS] {
        std::array::from_fn(|i| compliance(start + 0.5 * width * (1.0 + self.forms.rule.nodes[i])))
    }

    /// Whether the last two Legendre coefficients of C are small enough.
    fn is_resolved(
        &self,
        samples: &[SurfaceCompliance; PANEL_POINTS],
        [start, width]: [f64; 2],
        max_error: f64,
    ) -> bool {
        let values = samples.iter().map(|sample| [sample.xx, sample.zz, sample.xz]);
        let rule = &self.forms.rule;
        let Some(error) = last_coefficients(values.clone(), rule, &self.polynomials) else {
            return false;
        };
        let magnitudes = values.flatten().map(|value| value.re.abs().max(value.im.abs()));
        let max_magnitude = magnitudes.fold(0.0_f64, f64::max);
        let relative_form = (2.0 / (start * self.min_length)).powi(2).min(1.0);
        error * width * relative_form <= max_error || error <= ROUNDING_FLOOR_FACTOR * max_magnitude
    }

    /// Moments ∫ C Pₙ dk over one panel, by repeated halving.
    fn halve_panel(
        &self,
        panel: [f64; 2],
        max_error: f64,
        buffers: &mut IntegralBuffers,
        compliance: &mut dyn FnMut(f64) -> SurfaceCompliance,
    ) -> std::result::Result<[[f64; 6]; LEGENDRE_DEGREES], f64> {
        let rule = &self.forms.rule;
        let mut moments = [[0.0; 6]; LEGENDRE_DEGREES];
        let IntegralBuffers { part_stack, evaluation_count, .. } = buffers;
        let sample_part = |start: f64, width: f64| {
            *evaluation_count += PANEL_POINTS;
            let samples = self.compliance_samples([start, width], compliance);
            let is_resolved = self.is_resolved(&samples, [start, width], max_error);
            (samples, is_resolved)
        };
        by_halves(panel, part_stack, sample_part, |[part_start, part_size], width, samples| {
            let x: [f64; PANEL_POINTS] = std::array::from_fn(|i| {
                2.0 * (part_start + 0.5 * part_size * (1.0 + rule.nodes[i])) - 1.0
            });
            let polynomials = legendre_at(x);
            let c: [[f64; 6]; PANEL_POINTS] =
                std::array::from_fn(|i| weighted_parts(&samples[i], 0.5 * width * rule.weights[i]));
            for (degree_moments, degree_polynomials) in moments.iter_mut().zip(&polynomials) {
                for (polynomial, parts) in degree_polynomials.iter().zip(&c) {
                    for (moment, part) in degree_moments.iter_mut().zip(parts) {
                        *moment += polynomial * part;
                    }
                }
            }
        })?;
        Ok(moments)
    }
}
