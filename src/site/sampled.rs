//! Layers modified so that sampled motions can pass through them.
//!
//! At their highest frequency, π/Δt, samples cannot represent a delay that is not a multiple of the time step: e^(iωτ)
//! must be real there. Otherwise the response to one sample alternates for ever, before it as well as after
//! (Oppenheim & Schafer 2010, § 4.5). Layers are therefore unmodified up to a fraction
//! [`BAND_FRACTION`](super::transform::BAND_FRACTION) below that frequency. Within the band they change smoothly, until
//! at its end
//!
//! * travel times are multiples of Δt: half a step off at most, from the surface to any depth,
//! * moduli are real: their values for growth at the same rate, s = π/Δt.
//!
//! Each layer is still passive, so a motion can pass through the site and back.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use std::f64::consts::PI;

use super::transform::ContourPoint;
use crate::error::Result;
use crate::linalg::{Complex, ComplexArithmetic, Lanes, Simd, WithSimd, vectorized};
use crate::soil::SoilProfile;

/// Places on the contour, one in each lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct ContourLanes<C> {
    pub(super) s: C,
    /// s, or i at frequency zero, which is the limit from above.
    pub(super) direction: C,
    /// Whether the moduli equal those in the previous call, with the same `layer_values`.
    pub(super) repeats: bool,
    /// Nearness and ratio of the places; `None` if none is in the band.
    band: Option<[C; 2]>,
}

impl<C> ContourLanes<C> {
    /// Whether any of the places is in the band.
    #[inline(always)]
    pub(super) fn is_in_band(&self) -> bool {
        self.band.is_some()
    }
}

fn direction(s: Complex) -> Complex {
    if s == Complex::default() { Complex::new(0.0, 1.0) } else { s }
}

impl ContourLanes<Complex> {
    fn single(place: &ContourPoint) -> Self {
        let band = [place.nearness, place.ratio].map(Complex::real);
        let direction = direction(place.s);
        let band = (place.nearness > 0.0).then_some(band);
        Self { s: place.s, direction, repeats: false, band }
    }
}

/// Real moduli of layers at the highest frequency, and their travels s h/c there.
///
/// The imaginary parts of the travels are multiples of π. Empty for unmodified layers.
#[derive(Debug, Default)]
pub(super) struct NyquistLayers<const WAVES: usize> {
    moduli: Vec<f64>,
    travels: Vec<[Complex; WAVES]>,
}

impl<const WAVES: usize> NyquistLayers<WAVES> {
    /// Layers of `profile` on a contour that ends at s = `end`.
    ///
    /// `travel(index, modulus)`: travels through a layer.
    pub(super) fn new(
        profile: &SoilProfile,
        end: Complex,
        travel: impl Fn(usize, Complex) -> [Complex; WAVES],
    ) -> Result<Self> {
        let mut moduli = vec![];
        profile.moduli(end, &mut moduli)?;
        // Travel to each depth in half turns; travels are rounded such that their sums are.
        let mut depth = [0.0_f64; WAVES];
        let mut rounded = |wave: usize, travel: Complex| {
            let above = depth[wave].round();
            depth[wave] += travel.im / PI;
            Complex::new(travel.re, PI * (depth[wave].round() - above))
        };
        let mut travels = vec![];
        for (index, modulus) in moduli.iter().enumerate().take(profile.layers().len()) {
            let exact = travel(index, *modulus);
            travels.push(std::array::from_fn(|wave| rounded(wave, exact[wave])));
        }
        profile.moduli(Complex::real(end.im), &mut moduli)?;
        Ok(Self { moduli: moduli.iter().map(|modulus| modulus.re).collect(), travels })
    }

    /// Modulus of a soil; `modulus` outside the band.
    #[inline(always)]
    pub(super) fn modulus<C: ComplexArithmetic>(
        &self,
        index: usize,
        contour: &ContourLanes<C>,
        modulus: C,
    ) -> C {
        let Some([nearness, _]) = contour.band else { return modulus };
        modulus + (modulus.like_real(self.moduli[index]) - modulus) * nearness
    }

    /// Travels through a layer; `travels` outside the band.
    #[inline(always)]
    pub(super) fn travels<C: ComplexArithmetic>(
        &self,
        index: usize,
        contour: &ContourLanes<C>,
        mut travels: [C; WAVES],
    ) -> [C; WAVES] {
        let Some([nearness, ratio]) = contour.band else { return travels };
        for (travel, highest) in travels.iter_mut().zip(&self.travels[index]) {
            let turns = ratio * ratio.like(Complex::new(0.0, highest.im));
            *travel = *travel + (ratio.like_real(highest.re) + turns - *travel) * nearness;
        }
        travels
    }
}

/// Functions of s, one or several, of a layered ground.
pub(super) trait SiteFunctions {
    /// Intermediate values of a layer, kept between calls.
    type LayerValues<C: ComplexArithmetic>;

    fn profile(&self) -> &SoilProfile;

    /// Number of functions.
    fn count(&self) -> usize;

    /// Overwrites `results` with one number for each function, at one place.
    ///
    /// `moduli`: of the soils from the surface down. Implementations must be `#[inline(always)]`.
    fn evaluate<C: ComplexArithmetic>(
        &self,
        contour: &ContourLanes<C>,
        moduli: &[C],
        layer_values: &mut Vec<Self::LayerValues<C>>,
        results: &mut [C],
    );

    /// Overwrites `results` with the functions at one place, each a single number.
    fn evaluate_at(&self, place: &ContourPoint, results: &mut [Complex]) -> Result<()> {
        let mut moduli = vec![];
        self.profile().moduli(place.s, &mut moduli)?;
        self.evaluate(&ContourLanes::single(place), &moduli, &mut vec![], results);
        Ok(())
    }
}

/// Overwrites `results` with the functions at the places.
///
/// All numbers of the first function come first, then of the next.
pub(super) fn evaluate(
    functions: &impl SiteFunctions,
    places: &[ContourPoint],
    moduli: &mut Vec<Complex>,
    results: &mut [Complex],
) -> Result<()> {
    let s: Vec<Complex> = places.iter().map(|place| place.s).collect();
    functions.profile().moduli_at(&s, moduli)?;
    vectorized(Evaluation { functions, places, s: &s, moduli, results });
    Ok(())
}

struct Evaluation<'a, F> {
    functions: &'a F,
    places: &'a [ContourPoint],
    s: &'a [Complex],
    moduli: &'a [Complex],
    results: &'a mut [Complex],
}

impl<F: SiteFunctions> WithSimd for Evaluation<'_, F> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { functions, places, s, moduli, results } = self;
        let length = places.len();
        let count = Lanes::<S>::LANE_COUNT;
        let zero = Complex::default();
        let directions: Vec<Complex> = s.iter().map(|s| direction(*s)).collect();
        // Hysteretic damping has constant moduli.
        let is_constant = moduli
            .chunks_exact(length)
            .all(|values| values.iter().all(|modulus| *modulus == values[0]));
        let mut layer_values = vec![];
        let mut values = vec![Lanes::load(simd, &[zero]); functions.count()];
        let mut lanes = Vec::with_capacity(moduli.len() / length);
        for begin in (0..length).step_by(count) {
            let end = length.min(begin + count);
            let lane_places = &places[begin..end];
            let band = lane_places.iter().any(|place| place.nearness > 0.0).then(|| {
                let mut nearness = vec![zero; lane_places.len()];
                let mut ratios = vec![zero; lane_places.len()];
                for (k, place) in lane_places.iter().enumerate() {
                    nearness[k] = Complex::real(place.nearness);
                    ratios[k] = Complex::real(place.ratio);
                }
                [Lanes::load(simd, &nearness), Lanes::load(simd, &ratios)]
            });
            let directions = Lanes::load(simd, &directions[begin..end]);
            let repeats = begin > 0 && band.is_none() && is_constant;
            let s = Lanes::load(simd, &s[begin..end]);
            let contour = ContourLanes { s, direction: directions, repeats, band };
            if !repeats {
                lanes.clear();
                for moduli in moduli.chunks_exact(length) {
                    lanes.push(Lanes::load(simd, &moduli[begin..end]));
                }
            }
            functions.evaluate(&contour, &lanes, &mut layer_values, &mut values);
            let mut is_finite = true;
            for (value, results) in values.iter().zip(results.chunks_exact_mut(length)) {
                value.store(&mut results[begin..end]);
                is_finite &= results[begin..end].iter().all(|value| value.is_finite());
            }
            if !is_finite {
                evaluate_singly(functions, lane_places, begin, moduli, results);
            }
        }
    }
}

/// Evaluates places one by one, where numbers left the range of lanes.
///
/// The first place has the number `begin`.
fn evaluate_singly<F: SiteFunctions>(
    functions: &F,
    places: &[ContourPoint],
    begin: usize,
    moduli: &[Complex],
    results: &mut [Complex],
) {
    let count = functions.count();
    let mut place_moduli = vec![];
    let mut layer_values = vec![];
    let mut values = vec![Complex::default(); count];
    let length = results.len() / count;
    for (k, place) in places.iter().enumerate() {
        place_moduli.clear();
        place_moduli.extend(moduli.iter().skip(begin + k).step_by(length));
        let lanes = ContourLanes::single(place);
        functions.evaluate(&lanes, &place_moduli, &mut layer_values, &mut values);
        for (value, results) in values.iter().zip(results.chunks_exact_mut(length)) {
            results[begin + k] = *value;
        }
    }
}
