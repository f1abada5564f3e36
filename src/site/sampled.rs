//! Layers as sampled motions see them.
//!
//! A delay that is no multiple of the time step has no place in samples at their highest frequency,
//! π/Δt: e^(iωτ) there must be real, or the response to one sample alternates for ever, before it as
//! well as after (Oppenheim & Schafer 2010, § 4.5). So layers keep what they are up to a share
//! [`BAND`](super::transform::BAND) below that frequency and go over smoothly, until there
//!
//! * travel times are multiples of Δt: half a step off at most, from the surface to any depth,
//! * moduli are real: those of growth at the same rate, s = π/Δt.
//!
//! Each is still a passive layer, so a motion through the site has one that comes back.

use super::transform::Place;
use crate::error::Result;
use crate::linalg::Complex;
use crate::soil::{Soil, SoilProfile};

/// Moduli and travels of a profile, along the contour of a transform or at one frequency.
pub(super) struct Sampled<'a, F, const WAVES: usize> {
    profile: &'a SoilProfile,
    /// 1/c down of each kind of wave in a soil, by its complex modulus and s.
    slownesses: F,
    /// Real moduli at the highest frequency, and the travels there, whose imaginary parts are
    /// multiples of π; empty if there is none.
    highest: (Vec<f64>, Vec<[Complex; WAVES]>),
    moduli: Vec<Complex>,
    travels: Vec<[Complex; WAVES]>,
}

impl<'a, F, const WAVES: usize> Sampled<'a, F, WAVES>
where
    F: Fn(Soil, Complex, Complex) -> [Complex; WAVES],
{
    /// Layers as they are, at any frequency.
    pub(super) fn exact(profile: &'a SoilProfile, slownesses: F) -> Self {
        let (highest, moduli, travels) = ((vec![], vec![]), vec![], vec![]);
        Self { profile, slownesses, highest, moduli, travels }
    }

    /// Layers as samples see them on a contour that ends at s = `end`.
    pub(super) fn new(profile: &'a SoilProfile, slownesses: F, end: Complex) -> Result<Self> {
        let mut layers = Self::exact(profile, slownesses);
        profile.moduli(Complex::real(end.im), &mut layers.moduli)?;
        let moduli = layers.moduli.iter().map(|modulus| modulus.re).collect();
        let (_, travels) = layers.at(&Place::alone(end))?;
        let mut depth = [0.0_f64; WAVES];
        let mut rounded = |wave: usize, travel: Complex| {
            let above = depth[wave].round();
            depth[wave] += travel.im / std::f64::consts::PI;
            Complex::new(travel.re, std::f64::consts::PI * (depth[wave].round() - above))
        };
        let whole = travels.iter().map(|travel| std::array::from_fn(|k| rounded(k, travel[k])));
        let whole = whole.collect();
        layers.highest = (moduli, whole);
        Ok(layers)
    }

    /// Shear moduli from the surface down, the base last, and s h/c of the layers.
    pub(super) fn at(&mut self, place: &Place) -> Result<(&[Complex], &[[Complex; WAVES]])> {
        self.profile.moduli(place.s, &mut self.moduli)?;
        self.travels.clear();
        for (layer, modulus) in self.profile.layers().iter().zip(&self.moduli) {
            let time = place.s.scale(layer.thickness);
            let slownesses = (self.slownesses)(layer.soil, *modulus, place.s);
            self.travels.push(slownesses.map(|slowness| time * slowness));
        }
        if place.nearness > 0.0 {
            let between = |here: Complex, highest: Complex| {
                here.scale(1.0 - place.nearness) + highest.scale(place.nearness)
            };
            let (moduli, travels) = &self.highest;
            for (modulus, highest) in self.moduli.iter_mut().zip(moduli) {
                *modulus = between(*modulus, Complex::real(*highest));
            }
            for (travels, highest) in self.travels.iter_mut().zip(travels) {
                for (travel, highest) in travels.iter_mut().zip(highest) {
                    *travel = between(*travel, Complex::new(highest.re, highest.im * place.ratio));
                }
            }
        }
        Ok((&self.moduli, &self.travels))
    }
}
