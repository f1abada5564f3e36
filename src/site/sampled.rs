//! Layers modified so that sampled motions can pass through them.
//!
//! Samples cannot represent a delay that is not a multiple of the time step at their highest frequency, π/Δt: e^(iωτ)
//! must be real there. Otherwise the response to one sample alternates for ever, before it as well as after
//! (Oppenheim & Schafer 2010, § 4.5). Layers are therefore unmodified up to a fraction
//! [`BAND`](super::transform::BAND) below that frequency. Within the band they change smoothly, until at its end
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

/// A place on the contour, one in each lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct At<C> {
    pub(super) s: C,
    /// s, or i at frequency zero, which is the limit from above.
    pub(super) direction: C,
    /// Whether the moduli equal the previous call's, with the same `kept`.
    pub(super) repeats: bool,
    /// Nearness and ratio of the places; `None` if none is in the band.
    near: Option<[C; 2]>,
}

impl<C> At<C> {
    /// Whether any of the places is in the band.
    #[inline(always)]
    pub(super) fn is_near(&self) -> bool {
        self.near.is_some()
    }
}

fn direction(s: Complex) -> Complex {
    if s == Complex::default() { Complex::new(0.0, 1.0) } else { s }
}

impl At<Complex> {
    fn one(place: &ContourPoint) -> Self {
        let near = [place.nearness, place.ratio].map(Complex::real);
        let direction = direction(place.s);
        let near = (place.nearness > 0.0).then_some(near);
        Self { s: place.s, direction, repeats: false, near }
    }
}

/// Real moduli of layers at the highest frequency, and their travels s h/c there.
///
/// The imaginary parts of the travels are multiples of π. Empty for unmodified layers.
#[derive(Debug, Default)]
pub(super) struct Highest<const WAVES: usize> {
    moduli: Vec<f64>,
    travels: Vec<[Complex; WAVES]>,
}

impl<const WAVES: usize> Highest<WAVES> {
    /// Layers of `profile` on a contour that ends at s = `end`; `travel` gives their travels for a modulus.
    pub(super) fn new(
        profile: &SoilProfile,
        end: Complex,
        travel: impl Fn(usize, Complex) -> [Complex; WAVES],
    ) -> Result<Self> {
        let mut moduli = vec![];
        profile.moduli(end, &mut moduli)?;
        let mut depth = [0.0_f64; WAVES];
        let mut rounded = |wave: usize, travel: Complex| {
            let above = depth[wave].round();
            depth[wave] += travel.im / PI;
            Complex::new(travel.re, PI * (depth[wave].round() - above))
        };
        let mut travels = vec![];
        for (index, modulus) in moduli.iter().enumerate().take(profile.layers().len()) {
            let own = travel(index, *modulus);
            travels.push(std::array::from_fn(|wave| rounded(wave, own[wave])));
        }
        profile.moduli(Complex::real(end.im), &mut moduli)?;
        Ok(Self { moduli: moduli.iter().map(|modulus| modulus.re).collect(), travels })
    }

    /// Modulus of a soil; `modulus` outside the band.
    #[inline(always)]
    pub(super) fn modulus<C: ComplexArithmetic>(&self, index: usize, at: &At<C>, modulus: C) -> C {
        let Some([nearness, _]) = at.near else { return modulus };
        modulus + (modulus.like_real(self.moduli[index]) - modulus) * nearness
    }

    /// Travels through a layer; `travels` outside the band.
    #[inline(always)]
    pub(super) fn travels<C: ComplexArithmetic>(
        &self,
        index: usize,
        at: &At<C>,
        mut travels: [C; WAVES],
    ) -> [C; WAVES] {
        let Some([nearness, ratio]) = at.near else { return travels };
        for (travel, highest) in travels.iter_mut().zip(&self.travels[index]) {
            let turns = ratio * ratio.like(Complex::new(0.0, highest.im));
            *travel = *travel + (ratio.like_real(highest.re) + turns - *travel) * nearness;
        }
        travels
    }
}

/// Functions of s, one or several, of a layered ground.
pub(super) trait Functions {
    /// Intermediate values of a layer, kept between calls.
    type LayerValues<C: ComplexArithmetic>;

    fn profile(&self) -> &SoilProfile;

    /// Number of functions.
    fn count(&self) -> usize;

    /// Overwrites `found` with one number for each function, at one place.
    ///
    /// `moduli`: of the soils from the surface down. Implementations must be `#[inline(always)]`.
    fn evaluate<C: ComplexArithmetic>(
        &self,
        at: &At<C>,
        moduli: &[C],
        kept: &mut Vec<Self::LayerValues<C>>,
        found: &mut [C],
    );

    /// The functions at one place.
    fn at(&self, place: &ContourPoint, found: &mut [Complex]) -> Result<()> {
        let mut moduli = vec![];
        self.profile().moduli(place.s, &mut moduli)?;
        self.evaluate(&At::one(place), &moduli, &mut vec![], found);
        Ok(())
    }
}

/// Overwrites `found` with the functions at the places: all numbers of the first function, then of the next.
pub(super) fn evaluate(
    functions: &impl Functions,
    places: &[ContourPoint],
    moduli: &mut Vec<Complex>,
    found: &mut [Complex],
) -> Result<()> {
    let s: Vec<Complex> = places.iter().map(|place| place.s).collect();
    functions.profile().moduli_at(&s, moduli)?;
    vectorized(Evaluation { functions, places, s: &s, moduli, found });
    Ok(())
}

struct Evaluation<'a, F> {
    functions: &'a F,
    places: &'a [ContourPoint],
    s: &'a [Complex],
    moduli: &'a [Complex],
    found: &'a mut [Complex],
}

impl<F: Functions> WithSimd for Evaluation<'_, F> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { functions, places, s, moduli, found } = self;
        let (length, count) = (places.len(), Lanes::<S>::LANE_COUNT);
        let zero = Complex::default();
        let directions: Vec<Complex> = s.iter().map(|s| direction(*s)).collect();
        // Hysteretic damping has constant moduli.
        let is_constant = moduli.chunks_exact(length).all(|own| own.iter().all(|m| *m == own[0]));
        let mut kept = vec![];
        let mut values = vec![Lanes::load(simd, &[zero]); functions.count()];
        let mut lanes = Vec::with_capacity(moduli.len() / length);
        for begin in (0..length).step_by(count) {
            let end = length.min(begin + count);
            let own = &places[begin..end];
            let near = own.iter().any(|place| place.nearness > 0.0).then(|| {
                let load = |of: fn(&ContourPoint) -> f64| {
                    let mut numbers = vec![zero; own.len()];
                    for (number, place) in numbers.iter_mut().zip(own) {
                        *number = Complex::real(of(place));
                    }
                    Lanes::load(simd, &numbers)
                };
                [load(|place| place.nearness), load(|place| place.ratio)]
            });
            let directions = Lanes::load(simd, &directions[begin..end]);
            let repeats = begin > 0 && near.is_none() && is_constant;
            let s = Lanes::load(simd, &s[begin..end]);
            let at = At { s, direction: directions, repeats, near };
            if !repeats {
                lanes.clear();
                for moduli in moduli.chunks_exact(length) {
                    lanes.push(Lanes::load(simd, &moduli[begin..end]));
                }
            }
            functions.evaluate(&at, &lanes, &mut kept, &mut values);
            let mut is_finite = true;
            for (value, found) in values.iter().zip(found.chunks_exact_mut(length)) {
                value.store(&mut found[begin..end]);
                is_finite &= found[begin..end].iter().all(|own| own.is_finite());
            }
            if !is_finite {
                one_by_one(functions, own, begin, moduli, found);
            }
        }
    }
}

/// Overwrites numbers that left the range of lanes; the first of the places has the number `begin`.
fn one_by_one<F: Functions>(
    functions: &F,
    places: &[ContourPoint],
    begin: usize,
    moduli: &[Complex],
    found: &mut [Complex],
) {
    let count = functions.count();
    let (mut own, mut kept, mut values) = (vec![], vec![], vec![Complex::default(); count]);
    let length = found.len() / count;
    for (k, place) in places.iter().enumerate() {
        own.clear();
        own.extend(moduli.iter().skip(begin + k).step_by(length));
        functions.evaluate(&At::one(place), &own, &mut kept, &mut values);
        for (value, found) in values.iter().zip(found.chunks_exact_mut(length)) {
            found[begin + k] = *value;
        }
    }
}
