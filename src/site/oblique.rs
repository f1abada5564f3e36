//! Motion of the surface under waves of one horizontal slowness.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use super::sampled::{ContourLanes, NyquistLayers, SiteFunctions};
use super::slowness::{
    IncidentWave, InclinedLayerWaves, WaveMedium, sh_surface_motion, surface_motion,
};
use crate::error::Result;
use crate::linalg::{Complex, ComplexArithmetic};
use crate::soil::{Soil, SoilProfile};

/// Motion at the top of the base that is prescribed for an inclined wave.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum InclinedControl {
    /// Horizontal motion of the base as a free surface without layers: rock outcrop.
    #[default]
    OutcropHorizontal,
    /// Vertical motion of the same surface, positive up.
    OutcropVertical,
    /// The incident wave itself.
    ///
    /// Its displacement is positive to the right for SV (and down, if the wave runs to the right), up for P (and to the
    /// right), and along y for SH.
    Incident,
}

/// Kind of the incident wave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum WaveKind {
    Sv,
    P,
    Sh,
}

/// Motion of the surface, horizontal and up, per unit motion of the control point.
pub(super) struct SurfaceFunctions<'a> {
    /// Layers, and the half-plane below.
    profile: &'a SoilProfile,
    base: Soil,
    wave_kind: WaveKind,
    control: InclinedControl,
    /// Horizontal slowness of the wave, s/m.
    slowness: f64,
    incident_wave: IncidentWave,
    /// Layers modified for samples.
    nyquist: NyquistLayers<2>,
}

impl<'a> SurfaceFunctions<'a> {
    /// Functions of the unmodified layers.
    pub(super) fn exact(
        profile: &'a SoilProfile,
        base: Soil,
        wave_kind: WaveKind,
        control: InclinedControl,
        slowness: f64,
        incident_wave: IncidentWave,
    ) -> Self {
        Self {
            profile,
            base,
            wave_kind,
            control,
            slowness,
            incident_wave,
            nyquist: NyquistLayers::default(),
        }
    }

    /// Functions of layers modified for samples, on a contour that ends at s = `contour_end`.
    pub(super) fn sampled(self, contour_end: Complex) -> Result<Self> {
        let nyquist = NyquistLayers::new(self.profile, contour_end, |index, modulus| {
            self.phases(index, contour_end, modulus)
        })?;
        Ok(Self { nyquist, ..self })
    }

    /// Complex phases s h a and s h b of P and S waves through a layer.
    #[inline(always)]
    fn phases<C: ComplexArithmetic>(&self, index: usize, s: C, modulus: C) -> [C; 2] {
        let layer = &self.profile.layers()[index];
        let medium = WaveMedium::layer(layer.soil, modulus, s, self.slowness);
        let s_thickness = s.scale(layer.thickness);
        let slownesses = medium.slownesses();
        [s_thickness * slownesses[0], s_thickness * slownesses[1]]
    }
}

impl SiteFunctions for SurfaceFunctions<'_> {
    type LayerValues<C: ComplexArithmetic> = InclinedLayerWaves<C>;

    fn profile(&self) -> &SoilProfile {
        self.profile
    }

    fn function_count(&self) -> usize {
        2
    }

    #[inline(always)]
    fn evaluate<C: ComplexArithmetic>(
        &self,
        contour: &ContourLanes<C>,
        moduli: &[C],
        layer_values: &mut Vec<InclinedLayerWaves<C>>,
        results: &mut [C],
    ) {
        let Self { profile, base, wave_kind, control, slowness, incident_wave, nyquist } = self;
        let s = contour.nonzero_s;
        let p = *slowness;
        let base_index = moduli.len() - 1;
        let base_medium = WaveMedium::base(
            *base,
            nyquist.modulus(base_index, contour, moduli[base_index]),
            s,
            p,
            *incident_wave,
        );
        layer_values.clear();
        for (index, (layer, modulus)) in profile.layers().iter().zip(moduli).enumerate() {
            let s_thickness = contour.s.scale(layer.thickness);
            let mut medium = WaveMedium::layer(layer.soil, *modulus, s, p);
            let slownesses = medium.slownesses();
            let mut phases = [s_thickness * slownesses[0], s_thickness * slownesses[1]];
            if contour.is_in_band() {
                phases = nyquist.phases(index, contour, phases);
                medium =
                    WaveMedium::layer(layer.soil, nyquist.modulus(index, contour, *modulus), s, p);
            }
            layer_values.push(InclinedLayerWaves { medium, phases });
        }
        // Motions of surface and outcrop due to unit amplitudes.
        let response = match wave_kind {
            WaveKind::Sh => sh_response(layer_values, &base_medium),
            WaveKind::P => p_sv_response(layer_values, &base_medium, 0),
            WaveKind::Sv => p_sv_response(layer_values, &base_medium, 1),
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
    /// Motion of the surface.
    surface: [C; 2],
    /// Motion of the outcrop.
    outcrop: [C; 2],
    /// Amplitude of a wave whose displacement is one.
    unit_amplitude: C,
}

/// Response to an incident SH wave.
#[inline(always)]
fn sh_response<C: ComplexArithmetic>(
    layers: &[InclinedLayerWaves<C>],
    base: &WaveMedium<C>,
) -> UnitResponse<C> {
    let zero = base.squared_s_slowness.like_real(0.0);
    let one = base.squared_s_slowness.like_real(1.0);
    UnitResponse {
        surface: [sh_surface_motion(layers, base), zero],
        outcrop: [one + one, zero],
        unit_amplitude: one,
    }
}

/// Response to an incident P wave (`wave_index` 0) or SV wave (`wave_index` 1).
///
/// A unit amplitude displaces by the vector (p, a) or (b, p), whose length is 1/c.
#[inline(always)]
fn p_sv_response<C: ComplexArithmetic>(
    layers: &[InclinedLayerWaves<C>],
    base: &WaveMedium<C>,
    wave_index: usize,
) -> UnitResponse<C> {
    let surface_matrix = surface_motion(layers, base);
    let outcrop_matrix = base.free_surface();
    let squared_slowness =
        if wave_index == 0 { base.squared_p_slowness } else { base.squared_s_slowness };
    UnitResponse {
        surface: [surface_matrix[wave_index], surface_matrix[2 + wave_index]],
        outcrop: [outcrop_matrix[wave_index], outcrop_matrix[2 + wave_index]],
        unit_amplitude: squared_slowness.sqrt().inverse(),
    }
}
