//! Motion of the surface under waves of one horizontal slowness.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use super::sampled::{ContourLanes, NyquistLayers, SiteFunctions};
use super::slowness::{
    IncidentWave, LayerWaves, WaveMedium, surface_motion, surface_motion_across,
};
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
pub(super) struct SurfaceFunctions<'a> {
    profile: &'a SoilProfile,
    base: Soil,
    kind: WaveKind,
    control: InclinedControl,
    /// Horizontal slowness of the wave.
    slowness: f64,
    incident: IncidentWave,
    nyquist: NyquistLayers<2>,
}

impl<'a> SurfaceFunctions<'a> {
    /// Functions of the unmodified layers.
    pub(super) fn exact(
        profile: &'a SoilProfile,
        base: Soil,
        kind: WaveKind,
        control: InclinedControl,
        slowness: f64,
        incident: IncidentWave,
    ) -> Self {
        Self {
            profile,
            base,
            kind,
            control,
            slowness,
            incident,
            nyquist: NyquistLayers::default(),
        }
    }

    /// These functions for layers modified for samples, on a contour that ends at s = `end`.
    pub(super) fn sampled(self, end: Complex) -> Result<Self> {
        let nyquist = NyquistLayers::new(self.profile, end, |index, modulus| {
            self.travels(index, end, modulus)
        })?;
        Ok(Self { nyquist, ..self })
    }

    #[inline(always)]
    fn travels<C: ComplexArithmetic>(&self, index: usize, s: C, modulus: C) -> [C; 2] {
        let layer = &self.profile.layers()[index];
        let medium = WaveMedium::layer(layer.soil, modulus, s, self.slowness);
        let time = s.scale(layer.thickness);
        let slownesses = medium.slownesses();
        [time * slownesses[0], time * slownesses[1]]
    }
}

impl SiteFunctions for SurfaceFunctions<'_> {
    type LayerValues<C: ComplexArithmetic> = LayerWaves<C>;

    fn profile(&self) -> &SoilProfile {
        self.profile
    }

    fn count(&self) -> usize {
        2
    }

    #[inline(always)]
    fn evaluate<C: ComplexArithmetic>(
        &self,
        contour: &ContourLanes<C>,
        moduli: &[C],
        layer_values: &mut Vec<LayerWaves<C>>,
        results: &mut [C],
    ) {
        let Self { profile, base, kind, control, slowness, incident, nyquist } = self;
        let s = contour.direction;
        let p = *slowness;
        let last = moduli.len() - 1;
        let base =
            WaveMedium::base(*base, nyquist.modulus(last, contour, moduli[last]), s, p, *incident);
        layer_values.clear();
        for (index, (layer, modulus)) in profile.layers().iter().zip(moduli).enumerate() {
            let time = contour.s.scale(layer.thickness);
            let mut medium = WaveMedium::layer(layer.soil, *modulus, s, p);
            let slownesses = medium.slownesses();
            let mut travels = [time * slownesses[0], time * slownesses[1]];
            if contour.is_in_band() {
                travels = nyquist.travels(index, contour, travels);
                medium =
                    WaveMedium::layer(layer.soil, nyquist.modulus(index, contour, *modulus), s, p);
            }
            layer_values.push(LayerWaves { medium, travels });
        }
        // Motions of surface and outcrop due to unit amplitudes.
        let response = match kind {
            WaveKind::Sh => across_response(layer_values, &base),
            WaveKind::P => in_plane_response(layer_values, &base, 0),
            WaveKind::Sv => in_plane_response(layer_values, &base, 1),
        };
        let scale = match control {
            InclinedControl::OutcropHorizontal => response.outcrop[0].inverse(),
            InclinedControl::OutcropVertical => response.outcrop[1].inverse(),
            InclinedControl::Incident => response.unit_amplitude,
        };
        results[0] = response.surface[0] * scale;
        results[1] = response.surface[1] * scale;
    }
}

/// Motions, horizontal and up, due to an incident wave of unit amplitude.
struct UnitResponse<C> {
    surface: [C; 2],
    outcrop: [C; 2],
    /// Amplitude of a wave of unit displacement.
    unit_amplitude: C,
}

#[inline(always)]
fn across_response<C: ComplexArithmetic>(
    layers: &[LayerWaves<C>],
    base: &WaveMedium<C>,
) -> UnitResponse<C> {
    let zero = base.shear.like_real(0.0);
    let one = base.shear.like_real(1.0);
    UnitResponse {
        surface: [surface_motion_across(layers, base), zero],
        outcrop: [one + one, zero],
        unit_amplitude: one,
    }
}

/// Response to P (`wave` 0) or SV (`wave` 1).
///
/// Their amplitudes belong to the vectors (p, a) and (b, p), whose length is 1/c.
#[inline(always)]
fn in_plane_response<C: ComplexArithmetic>(
    layers: &[LayerWaves<C>],
    base: &WaveMedium<C>,
    wave: usize,
) -> UnitResponse<C> {
    let surface = surface_motion(layers, base);
    let outcrop = base.free_surface();
    let squared_slowness = if wave == 0 { base.pressure } else { base.shear };
    UnitResponse {
        surface: [surface[wave], surface[2 + wave]],
        outcrop: [outcrop[wave], outcrop[2 + wave]],
        unit_amplitude: squared_slowness.sqrt().inverse(),
    }
}
