//! Motion of the surface under waves of one horizontal slowness.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use super::sampled::{At, Functions, Highest};
use super::slowness::{Medium, surface_motion, surface_motion_across};
use crate::error::Result;
use crate::linalg::{Complex, ComplexArithmetic};
use crate::soil::{Soil, SoilProfile};

/// Prescribed motion of an inclined wave, at the depth of the base's top.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum InclinedControl {
    /// Horizontal motion of the base's free surface without layers above: rock outcrop.
    #[default]
    OutcropHorizontal,
    /// Vertical motion of the same surface, positive up.
    OutcropVertical,
    /// The incident wave itself.
    ///
    /// SV is positive to the right (and down, if it runs to the right), P up (and to the right), SH away from the
    /// reader.
    Incident,
}

/// Kind of the incident wave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum WaveKind {
    Sv,
    P,
    Sh,
}

/// Motion of the surface, horizontal and up, for a unit motion of the control point.
pub(super) struct Surface<'a> {
    profile: &'a SoilProfile,
    base: Soil,
    kind: WaveKind,
    control: InclinedControl,
    /// Horizontal slowness of the wave.
    slowness: f64,
    /// Elastic slowness of the wave, and the cosine of its angle.
    own: [f64; 2],
    highest: Highest<2>,
}

impl<'a> Surface<'a> {
    /// Functions of the unmodified layers.
    ///
    /// `slownesses`: the horizontal one, the elastic one, and the cosine of the angle.
    pub(super) fn exact(
        profile: &'a SoilProfile,
        base: Soil,
        kind: WaveKind,
        control: InclinedControl,
        [slowness, elastic, cosine]: [f64; 3],
    ) -> Self {
        let own = [elastic, cosine];
        Self { profile, base, kind, control, slowness, own, highest: Highest::default() }
    }

    /// These functions for layers modified for samples, on a contour that ends at s = `end`.
    pub(super) fn sampled(self, end: Complex) -> Result<Self> {
        let travels = |index: usize, modulus| self.travels(index, end, modulus);
        Ok(Self { highest: Highest::new(self.profile, end, travels)?, ..self })
    }

    #[inline(always)]
    fn travels<C: ComplexArithmetic>(&self, index: usize, s: C, modulus: C) -> [C; 2] {
        let layer = &self.profile.layers()[index];
        let medium = Medium::layer(layer.soil, modulus, s, self.slowness);
        let [a, b] = medium.slownesses();
        let time = s.scale(layer.thickness);
        [time * a, time * b]
    }
}

impl Functions for Surface<'_> {
    /// A layer and its travels.
    type LayerValues<C: ComplexArithmetic> = (Medium<C>, [C; 2]);

    fn profile(&self) -> &SoilProfile {
        self.profile
    }

    fn count(&self) -> usize {
        2
    }

    #[inline(always)]
    fn evaluate<C: ComplexArithmetic>(
        &self,
        at: &At<C>,
        moduli: &[C],
        kept: &mut Vec<(Medium<C>, [C; 2])>,
        found: &mut [C],
    ) {
        let Self { profile, base, kind, control, slowness, own, highest } = self;
        let (s, p) = (at.direction, *slowness);
        let last = moduli.len() - 1;
        let base = Medium::base(*base, highest.modulus(last, at, moduli[last]), s, p, *own);
        kept.clear();
        for (index, (layer, modulus)) in profile.layers().iter().zip(moduli).enumerate() {
            let time = at.s.scale(layer.thickness);
            let mut medium = Medium::layer(layer.soil, *modulus, s, p);
            let [a, b] = medium.slownesses();
            let mut travels = [time * a, time * b];
            if at.is_near() {
                travels = highest.travels(index, at, travels);
                medium = Medium::layer(layer.soil, highest.modulus(index, at, *modulus), s, p);
            }
            kept.push((medium, travels));
        }
        // The surface and the outcrop by unit amplitudes, and the amplitude of a unit displacement. The amplitudes
        // of SV and P belong to the vectors (b, p) and (p, a), whose length is 1/c.
        let (none, one) = (s.like_real(0.0), s.like_real(1.0));
        let (motion, outcrop, unit) = if *kind == WaveKind::Sh {
            ([surface_motion_across(kept, &base), none], [one + one, none], one)
        } else {
            let [px, sx, pz, sz] = surface_motion(kept, &base);
            let [px0, sx0, pz0, sz0] = base.free_surface();
            match kind {
                WaveKind::P => ([px, pz], [px0, pz0], base.pressure.sqrt().inverse()),
                _ => ([sx, sz], [sx0, sz0], base.shear.sqrt().inverse()),
            }
        };
        let scale = match control {
            InclinedControl::OutcropHorizontal => outcrop[0].inverse(),
            InclinedControl::OutcropVertical => outcrop[1].inverse(),
            InclinedControl::Incident => unit,
        };
        found[0] = motion[0] * scale;
        found[1] = motion[1] * scale;
    }
}
