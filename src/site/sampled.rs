//! Layers modified so that sampled motions can pass through them.
//!
//! At their highest frequency, π/Δt, samples cannot represent a delay that is not a multiple of the time step: e^(iωτ)
//! must be real there. Otherwise the response to one sample alternates without end, before the sample and after it
//! (Oppenheim & Schafer 2010, § 4.5). Layers are therefore unmodified up to a fraction
//! [`BAND_FRACTION`](super::transform::BAND_FRACTION) below that frequency. Within the band they change smoothly, until
//! at its end
//!
//! * travel times from the surface to any depth are multiples of Δt, with an error of at most half a step,
//! * moduli are real: their values at the real s = π/Δt.
//!
//! Each modified layer is passive, so that a motion can be computed through the site and back.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use std::f64::consts::PI;

use super::transform::ContourPoint;
use crate::error::Result;
use crate::linalg::{Complex, ComplexArithmetic, Lanes, Simd, WithSimd, vectorized};
use crate::soil::SoilProfile;

/// Points on the contour, one in each lane of the processor's vectors.
#[derive(Debug, Clone, Copy)]
pub(super) struct ContourLanes<C> {
    /// Laplace variable.
    pub(super) s: C,
    /// s, or i at frequency zero, which is the limit from above.
    pub(super) nonzero_s: C,
    /// Whether the moduli equal those in the previous call, with the same `layer_values`.
    pub(super) has_same_moduli: bool,
    /// Values in the transition band; `None` if no point is in the band.
    band: Option<BandLanes<C>>,
}

/// Values of points in the transition band, one in each lane.
#[derive(Debug, Clone, Copy)]
struct BandLanes<C> {
    /// Weight of the modified layers.
    modified_weight: C,
    /// Frequency relative to the highest one.
    frequency_ratio: C,
}

impl<C> ContourLanes<C> {
    /// Whether a point is in the transition band.
    #[inline(always)]
    pub(super) fn is_in_band(&self) -> bool {
        self.band.is_some()
    }
}

/// `s`, or i in place of zero.
fn nonzero_s(s: Complex) -> Complex {
    if s == Complex::default() { Complex::new(0.0, 1.0) } else { s }
}

impl ContourLanes<Complex> {
    /// A single point.
    fn single(point: &ContourPoint) -> Self {
        let band = BandLanes {
            modified_weight: Complex::real(point.modified_weight),
            frequency_ratio: Complex::real(point.frequency_ratio),
        };
        Self {
            s: point.s,
            nonzero_s: nonzero_s(point.s),
            has_same_moduli: false,
            band: (point.modified_weight > 0.0).then_some(band),
        }
    }
}

/// Real moduli of layers at the highest frequency, and their complex phases s h/c there.
///
/// The imaginary parts of the phases are multiples of π. Both lists are empty for unmodified layers.
#[derive(Debug, Default)]
pub(super) struct NyquistLayers<const WAVES: usize> {
    moduli: Vec<f64>,
    phases: Vec<[Complex; WAVES]>,
}

impl<const WAVES: usize> NyquistLayers<WAVES> {
    /// Modified layers of a profile on a contour that ends at s = `contour_end`.
    ///
    /// `layer_phases(index, modulus)`: phases of all waves through a layer.
    pub(super) fn new(
        profile: &SoilProfile,
        contour_end: Complex,
        layer_phases: impl Fn(usize, Complex) -> [Complex; WAVES],
    ) -> Result<Self> {
        let mut moduli = vec![];
        profile.moduli(contour_end, &mut moduli)?;
        // Phase from the surface to each depth, in half turns. The phases of the layers add up to its rounded value.
        let mut half_turns = [0.0_f64; WAVES];
        let mut round_phase = |wave: usize, phase: Complex| {
            let previous_half_turns = half_turns[wave].round();
            half_turns[wave] += phase.im / PI;
            Complex::new(phase.re, PI * (half_turns[wave].round() - previous_half_turns))
        };
        let mut phases = vec![];
        for (index, modulus) in moduli.iter().enumerate().take(profile.layers().len()) {
            let exact_phases = layer_phases(index, *modulus);
            phases.push(std::array::from_fn(|wave| round_phase(wave, exact_phases[wave])));
        }
        profile.moduli(Complex::real(contour_end.im), &mut moduli)?;
        Ok(Self { moduli: moduli.iter().map(|modulus| modulus.re).collect(), phases })
    }

    /// Modulus of a soil on the contour; `modulus` outside the transition band.
    #[inline(always)]
    pub(super) fn modulus<C: ComplexArithmetic>(
        &self,
        index: usize,
        contour: &ContourLanes<C>,
        modulus: C,
    ) -> C {
        let Some(band) = contour.band else { return modulus };
        modulus + (modulus.like_real(self.moduli[index]) - modulus) * band.modified_weight
    }

    /// Phases through a layer on the contour; `phases` outside the transition band.
    #[inline(always)]
    pub(super) fn phases<C: ComplexArithmetic>(
        &self,
        index: usize,
        contour: &ContourLanes<C>,
        mut phases: [C; WAVES],
    ) -> [C; WAVES] {
        let Some(band) = contour.band else { return phases };
        for (phase, nyquist_phase) in phases.iter_mut().zip(&self.phases[index]) {
            let ratio = band.frequency_ratio;
            let imaginary_part = ratio * ratio.like(Complex::new(0.0, nyquist_phase.im));
            *phase = *phase
                + (ratio.like_real(nyquist_phase.re) + imaginary_part - *phase)
                    * band.modified_weight;
        }
        phases
    }
}

/// Functions of s that describe the waves through a layered ground.
pub(super) trait SiteFunctions {
    /// Intermediate values of a layer, which the caller stores from call to call.
    type LayerValues<C: ComplexArithmetic>;

    /// Profile of the ground.
    fn profile(&self) -> &SoilProfile;

    /// Number of functions.
    fn function_count(&self) -> usize;

    /// Overwrites `results` with one number for each function, at one point.
    ///
    /// `moduli`: shear moduli of the soils from the surface down. Implementations must be `#[inline(always)]`.
    fn evaluate<C: ComplexArithmetic>(
        &self,
        contour: &ContourLanes<C>,
        moduli: &[C],
        layer_values: &mut Vec<Self::LayerValues<C>>,
        results: &mut [C],
    );

    /// Overwrites `results` with the functions at one point, each a single number.
    fn evaluate_at(&self, point: &ContourPoint, results: &mut [Complex]) -> Result<()> {
        let mut moduli = vec![];
        self.profile().moduli(point.s, &mut moduli)?;
        self.evaluate(&ContourLanes::single(point), &moduli, &mut vec![], results);
        Ok(())
    }
}

/// Overwrites `results` with the functions at all points.
///
/// `results`: the values of the first function at all points, then those of the next function.
pub(super) fn evaluate(
    functions: &impl SiteFunctions,
    points: &[ContourPoint],
    moduli: &mut Vec<Complex>,
    results: &mut [Complex],
) -> Result<()> {
    let s: Vec<Complex> = points.iter().map(|point| point.s).collect();
    functions.profile().moduli_at(&s, moduli)?;
    vectorized(Evaluation { functions, points, s: &s, moduli, results });
    Ok(())
}

/// Arguments of [`evaluate`], compiled for the vectors of the processor.
struct Evaluation<'a, F> {
    functions: &'a F,
    points: &'a [ContourPoint],
    s: &'a [Complex],
    moduli: &'a [Complex],
    results: &'a mut [Complex],
}

impl<F: SiteFunctions> WithSimd for Evaluation<'_, F> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { functions, points, s, moduli, results } = self;
        let point_count = points.len();
        let lane_count = Lanes::<S>::LANE_COUNT;
        let zero = Complex::default();
        let nonzero_values: Vec<Complex> = s.iter().map(|s| nonzero_s(*s)).collect();
        // Hysteretic damping has constant moduli.
        let has_constant_moduli = moduli
            .chunks_exact(point_count)
            .all(|values| values.iter().all(|modulus| *modulus == values[0]));
        let mut layer_values = vec![];
        let mut values = vec![Lanes::load(simd, &[zero]); functions.function_count()];
        let mut modulus_lanes = Vec::with_capacity(moduli.len() / point_count);
        for start in (0..point_count).step_by(lane_count) {
            let end = point_count.min(start + lane_count);
            let lane_points = &points[start..end];
            let band = lane_points.iter().any(|point| point.modified_weight > 0.0).then(|| {
                let mut weights = vec![zero; lane_points.len()];
                let mut ratios = vec![zero; lane_points.len()];
                for (k, point) in lane_points.iter().enumerate() {
                    weights[k] = Complex::real(point.modified_weight);
                    ratios[k] = Complex::real(point.frequency_ratio);
                }
                BandLanes {
                    modified_weight: Lanes::load(simd, &weights),
                    frequency_ratio: Lanes::load(simd, &ratios),
                }
            });
            let nonzero_s = Lanes::load(simd, &nonzero_values[start..end]);
            let has_same_moduli = start > 0 && band.is_none() && has_constant_moduli;
            let s = Lanes::load(simd, &s[start..end]);
            let contour = ContourLanes { s, nonzero_s, has_same_moduli, band };
            if !has_same_moduli {
                modulus_lanes.clear();
                for soil_moduli in moduli.chunks_exact(point_count) {
                    modulus_lanes.push(Lanes::load(simd, &soil_moduli[start..end]));
                }
            }
            functions.evaluate(&contour, &modulus_lanes, &mut layer_values, &mut values);
            let mut is_finite = true;
            for (value, function_results) in
                values.iter().zip(results.chunks_exact_mut(point_count))
            {
                value.store(&mut function_results[start..end]);
                is_finite &= function_results[start..end].iter().all(|value| value.is_finite());
            }
            if !is_finite {
                evaluate_singly(functions, lane_points, start, moduli, results);
            }
        }
    }
}

/// Evaluates points one by one, where the vectors of several points overflowed.
///
/// `start`: index of the first of these points in `results`.
fn evaluate_singly<F: SiteFunctions>(
    functions: &F,
    points: &[ContourPoint],
    start: usize,
    moduli: &[Complex],
    results: &mut [Complex],
) {
    let function_count = functions.function_count();
    let mut point_moduli = vec![];
    let mut layer_values = vec![];
    let mut values = vec![Complex::default(); function_count];
    let point_count = results.len() / function_count;
    for (k, point) in points.iter().enumerate() {
        point_moduli.clear();
        point_moduli.extend(moduli.iter().skip(start + k).step_by(point_count));
        let contour = ContourLanes::single(point);
        functions.evaluate(&contour, &point_moduli, &mut layer_values, &mut values);
        for (value, function_results) in values.iter().zip(results.chunks_exact_mut(point_count)) {
            function_results[start + k] = *value;
        }
    }
}
