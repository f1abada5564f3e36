//! Waves up and down a soil column, as in SHAKE (Schnabel, Lysmer & Seed 1972).
//!
//! Each layer carries Aⱼ e^(κz) up and Bⱼ e^(−κz) down, κ = s/c. With A₁ = B₁ = 1 at the free surface and
//! the impedance ratio aⱼ = √(ρⱼMⱼ/(ρⱼ₊₁Mⱼ₊₁)),
//!
//! Aⱼ₊₁ = ½ Aⱼ(1+aⱼ) e^(κh) + ½ Bⱼ(1−aⱼ) e^(−κh),   Bⱼ₊₁ = ½ Aⱼ(1−aⱼ) e^(κh) + ½ Bⱼ(1+aⱼ) e^(−κh)
//!
//! The outcrop of the base moves by 2Aₙ, the base under the layers by Aₙ + Bₙ, the surface by 2. Amplitudes are computed
//! without the factor e^(Σκh) of the layers above, which may exceed the range of f64.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use super::sampled::{ContourLanes, NyquistLayers, SiteFunctions};
use crate::error::Result;
use crate::linalg::{Complex, ComplexArithmetic};
use crate::soil::{Bedrock, SoilProfile};

/// Kind of the vertical waves in a soil column.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum VerticalWave {
    /// Shear waves: horizontal motion.
    #[default]
    Shear,
    /// Pressure waves: vertical motion.
    Pressure,
}

/// Position of a motion at depth, prescribed or computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum ControlPoint {
    /// The base as a free surface without layers: rock outcrop.
    #[default]
    Outcrop,
    /// The base under the layers, including reflected waves; equal to the outcrop if the base is rigid.
    Within,
}

/// Quantities of a column as functions of s.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ColumnQuantity {
    /// Control motion per surface motion without its factor e^x, and x.
    InverseTransfer,
    /// Accelerations of the tops of all layers and of the base, per control motion.
    Accelerations,
    /// Strains in the middle of all layers, per acceleration of the control motion.
    Strains,
}

/// Speed of a wave in a soil, and its reciprocal.
#[derive(Clone, Copy)]
pub(super) struct WaveSpeed<C> {
    /// Complex speed c, m/s.
    speed: C,
    /// 1/c, s/m.
    slowness: C,
}

/// Amplitudes of the waves up and down at one depth.
#[derive(Clone, Copy)]
pub(super) struct WavePair<C> {
    /// Amplitude A of the upward wave.
    up: C,
    /// Amplitude B of the downward wave.
    down: C,
}

impl<C: ComplexArithmetic> WavePair<C> {
    /// The waves below an interface, if these are the waves above it.
    ///
    /// `upper_impedance`: impedance above the interface. `lower_inverse_impedance`: reciprocal of the impedance below it.
    #[inline(always)]
    fn below_interface(self, upper_impedance: C, lower_inverse_impedance: C) -> Self {
        let sum = (self.up + self.down).scale(0.5);
        let difference =
            (self.up - self.down).scale(0.5) * upper_impedance * lower_inverse_impedance;
        Self { up: sum + difference, down: sum - difference }
    }
}

/// Intermediate values of a layer, or of the base, of which only the speed is used.
#[derive(Clone, Copy)]
pub(super) struct ColumnLayer<C> {
    /// Speed in the unmodified soil.
    exact_speed: WaveSpeed<C>,
    /// Waves at the top of the layer.
    top_waves: WavePair<C>,
    /// κh.
    phase: C,
    /// e^(−κh/2).
    half_decay: C,
}

impl<C: Copy> ColumnLayer<C> {
    /// Values that are all equal to `value`.
    #[inline(always)]
    fn filled(value: C) -> Self {
        Self {
            exact_speed: WaveSpeed { speed: value, slowness: value },
            top_waves: WavePair { up: value, down: value },
            phase: value,
            half_decay: value,
        }
    }
}

/// Properties of a soil for one kind of wave.
#[derive(Debug)]
struct ColumnSoil {
    /// Density ρ, kg/m³.
    density: f64,
    /// Squared wave speed per shear modulus: M/(μρ), with the wave's stiffness M.
    squared_speed_per_modulus: f64,
}

/// Functions of a profile for one kind of wave.
#[derive(Debug)]
pub(super) struct ColumnFunctions<'a> {
    profile: &'a SoilProfile,
    /// Properties of the soils, from the surface down.
    soils: Vec<ColumnSoil>,
    control: ControlPoint,
    quantity: ColumnQuantity,
    /// Layers modified for samples.
    nyquist: NyquistLayers<1>,
}

impl<'a> ColumnFunctions<'a> {
    /// Functions of the unmodified layers.
    pub(super) fn exact(
        profile: &'a SoilProfile,
        wave: VerticalWave,
        control: ControlPoint,
        quantity: ColumnQuantity,
    ) -> Self {
        let soils = profile
            .soils()
            .map(|(soil, _)| {
                let modulus_ratio = match wave {
                    VerticalWave::Shear => 1.0,
                    VerticalWave::Pressure => 1.0 / soil.speed_ratio_squared(),
                };
                ColumnSoil {
                    density: soil.density(),
                    squared_speed_per_modulus: modulus_ratio / soil.density(),
                }
            })
            .collect();
        Self { profile, soils, control, quantity, nyquist: NyquistLayers::default() }
    }

    /// Functions of layers modified for samples, on a contour that ends at s = `contour_end`.
    pub(super) fn sampled(self, contour_end: Complex) -> Result<Self> {
        let nyquist = NyquistLayers::new(self.profile, contour_end, |index, modulus| {
            [self.phase(index, contour_end, self.speed(index, modulus).slowness)]
        })?;
        Ok(Self { nyquist, ..self })
    }

    /// Speed of the wave in a soil with this shear `modulus`.
    #[inline(always)]
    fn speed<C: ComplexArithmetic>(&self, index: usize, modulus: C) -> WaveSpeed<C> {
        let speed = modulus.scale(self.soils[index].squared_speed_per_modulus).sqrt();
        WaveSpeed { speed, slowness: speed.inverse() }
    }

    /// κh of a layer, from the slowness 1/c.
    #[inline(always)]
    fn phase<C: ComplexArithmetic>(&self, index: usize, s: C, slowness: C) -> C {
        s.scale(self.profile.layers()[index].thickness) * slowness
    }

    /// Overwrites `results` with the functions, from the waves at the bottom.
    ///
    /// `total_phase`: Σ κh through all layers.
    #[inline(always)]
    fn write_results<C: ComplexArithmetic>(
        &self,
        contour: &ContourLanes<C>,
        bottom_waves: WavePair<C>,
        total_phase: C,
        layer_values: &[ColumnLayer<C>],
        results: &mut [C],
    ) {
        let layer_count = self.profile.layers().len();
        // A rigid base moves like the bottom of the lowest layer.
        let is_outcrop = self.control == ControlPoint::Outcrop
            && matches!(self.profile.bedrock(), Bedrock::HalfPlane { .. });
        let control_motion = if is_outcrop {
            bottom_waves.up
        } else {
            (bottom_waves.up + bottom_waves.down).scale(0.5)
        };
        let mut decay = control_motion.inverse().scale(0.5);
        match self.quantity {
            ColumnQuantity::InverseTransfer => {
                results[0] = control_motion;
                results[1] = total_phase;
            }
            ColumnQuantity::Accelerations => {
                results[layer_count] = (bottom_waves.up + bottom_waves.down) * decay;
                let pairs = results[..layer_count].iter_mut().zip(&layer_values[..layer_count]);
                for (result, values) in pairs.rev() {
                    decay = decay * values.half_decay * values.half_decay;
                    *result = (values.top_waves.up + values.top_waves.down) * decay;
                }
            }
            ColumnQuantity::Strains => {
                let inverse_square = (contour.s * contour.s).inverse();
                let inputs = self.profile.layers().iter().zip(&layer_values[..layer_count]);
                for (result, (layer, values)) in results[..layer_count].iter_mut().zip(inputs).rev()
                {
                    let half_decay = values.half_decay;
                    decay = decay * half_decay;
                    let wavenumber = values.phase.scale(1.0 / layer.thickness) * inverse_square;
                    let difference =
                        values.top_waves.up - values.top_waves.down * half_decay * half_decay;
                    *result = difference * wavenumber * decay;
                    decay = decay * half_decay;
                }
            }
        }
    }
}

impl SiteFunctions for ColumnFunctions<'_> {
    type LayerValues<C: ComplexArithmetic> = ColumnLayer<C>;

    fn profile(&self) -> &SoilProfile {
        self.profile
    }

    fn function_count(&self) -> usize {
        let layer_count = self.profile.layers().len();
        match self.quantity {
            ColumnQuantity::InverseTransfer => 2,
            ColumnQuantity::Accelerations => layer_count + 1,
            ColumnQuantity::Strains => layer_count,
        }
    }

    #[inline(always)]
    fn evaluate<C: ComplexArithmetic>(
        &self,
        contour: &ContourLanes<C>,
        moduli: &[C],
        layer_values: &mut Vec<ColumnLayer<C>>,
        results: &mut [C],
    ) {
        let zero = contour.s.like_real(0.0);
        let one = contour.s.like_real(1.0);
        let mut waves = WavePair { up: one, down: one };
        let mut total_phase = zero;
        let mut upper_impedance: Option<C> = None;
        if layer_values.len() != moduli.len() {
            layer_values.clear();
            layer_values.resize(moduli.len(), ColumnLayer::filled(zero));
        }
        let layer_count = self.profile.layers().len();
        for (index, modulus) in moduli.iter().enumerate() {
            if !contour.has_same_moduli {
                layer_values[index] = ColumnLayer::filled(zero);
                layer_values[index].exact_speed = self.speed(index, *modulus);
            }
            let exact_speed = layer_values[index].exact_speed;
            let mut sampled_speed = exact_speed;
            let is_layer = index < layer_count;
            let mut phase = zero;
            if is_layer {
                phase = self.phase(index, contour.s, exact_speed.slowness);
            }
            if contour.is_in_band() {
                sampled_speed = self.speed(index, self.nyquist.modulus(index, contour, *modulus));
                if is_layer {
                    [phase] = self.nyquist.phases(index, contour, [phase]);
                }
            }
            let density = self.soils[index].density;
            if let Some(impedance) = upper_impedance {
                waves =
                    waves.below_interface(impedance, sampled_speed.slowness.scale(1.0 / density));
            }
            upper_impedance = Some(sampled_speed.speed.scale(density));
            if !is_layer {
                break;
            }
            total_phase = total_phase + phase;
            let round_trip_decay = if self.quantity == ColumnQuantity::InverseTransfer {
                phase.scale(-2.0).exp()
            } else {
                let half_decay = phase.scale(-0.5).exp();
                layer_values[index] =
                    ColumnLayer { exact_speed, top_waves: waves, phase, half_decay };
                let full_decay = half_decay * half_decay;
                full_decay * full_decay
            };
            waves.down = waves.down * round_trip_decay;
        }
        self.write_results(contour, waves, total_phase, layer_values, results);
    }
}
