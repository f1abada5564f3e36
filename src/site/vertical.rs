//! Waves up and down a soil column, as in SHAKE (Schnabel, Lysmer & Seed 1972).
//!
//! Each layer carries Aⱼ e^(κz) up and Bⱼ e^(−κz) down, κ = s/c. With A₁ = B₁ = 1 at the free surface and
//! the impedance ratio aⱼ = √(ρⱼMⱼ/(ρⱼ₊₁Mⱼ₊₁)),
//!
//! Aⱼ₊₁ = ½ Aⱼ(1+aⱼ) e^(κh) + ½ Bⱼ(1−aⱼ) e^(−κh),   Bⱼ₊₁ = ½ Aⱼ(1−aⱼ) e^(κh) + ½ Bⱼ(1+aⱼ) e^(−κh)
//!
//! the outcrop of the base moves by 2Aₙ, its top within by Aₙ + Bₙ, the surface by 2. Amplitudes are computed without
//! the factor e^(Σκh) of the layers above, which may leave the range of f64.

#![allow(clippy::inline_always, reason = "to be compiled for the instructions of their caller")]

use super::sampled::{ContourLanes, NyquistLayers, SiteFunctions};
use crate::error::Result;
use crate::linalg::{Complex, ComplexArithmetic};
use crate::soil::{Bedrock, SoilProfile};

/// Kind of wave that travels along a column.
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

/// Place of a prescribed or computed motion at depth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum ControlPoint {
    /// The surface of the base without layers above: rock outcrop.
    #[default]
    Outcrop,
    /// The base under the layers, including reflected waves; equal to the outcrop if the base is rigid.
    Within,
}

/// Quantity of a column as a function of s.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ColumnQuantity {
    /// Control motion by surface motion without its factor e^x, and x.
    Inverse,
    /// Acceleration at the tops of all layers and of the base, by the control motion.
    Accelerations,
    /// Strain in the middle of all layers, by the control motion's acceleration.
    Strains,
}

/// Speed of a wave in a soil, and its reciprocal.
#[derive(Clone, Copy)]
pub(super) struct WaveSpeed<C> {
    speed: C,
    slowness: C,
}

/// Amplitudes of the waves up and down at one depth.
#[derive(Clone, Copy)]
pub(super) struct WavePair<C> {
    up: C,
    down: C,
}

impl<C: ComplexArithmetic> WavePair<C> {
    /// Waves below an interface from these waves above it.
    ///
    /// `above`: impedance above; `below`: reciprocal of the impedance below.
    #[inline(always)]
    fn below_interface(self, above: C, below: C) -> Self {
        let sum = (self.up + self.down).scale(0.5);
        let difference = (self.up - self.down).scale(0.5) * above * below;
        Self { up: sum + difference, down: sum - difference }
    }
}

/// Intermediate values of a soil; of the base only the speed is set.
#[derive(Clone, Copy)]
pub(super) struct ColumnLayer<C> {
    /// Speed in the unmodified soil.
    exact: WaveSpeed<C>,
    /// Waves at the top of the layer.
    top: WavePair<C>,
    /// κh.
    travel: C,
    /// e^(−κh/2).
    half_decay: C,
}

impl<C: Copy> ColumnLayer<C> {
    #[inline(always)]
    fn filled(value: C) -> Self {
        Self {
            exact: WaveSpeed { speed: value, slowness: value },
            top: WavePair { up: value, down: value },
            travel: value,
            half_decay: value,
        }
    }
}

/// Functions of a profile for one kind of wave, with unmodified layers or layers modified for samples.
#[derive(Debug)]
pub(super) struct ColumnFunctions<'a> {
    profile: &'a SoilProfile,
    /// Soils from the surface down: density, and M/(μρ) of the wave's stiffness M.
    soils: Vec<[f64; 2]>,
    control: ControlPoint,
    quantity: ColumnQuantity,
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
                let stiffness = match wave {
                    VerticalWave::Shear => 1.0,
                    VerticalWave::Pressure => 1.0 / soil.speed_ratio_squared(),
                };
                [soil.density(), stiffness / soil.density()]
            })
            .collect();
        Self { profile, soils, control, quantity, nyquist: NyquistLayers::default() }
    }

    /// These functions for layers modified for samples, on a contour that ends at s = `end`.
    pub(super) fn sampled(self, end: Complex) -> Result<Self> {
        let nyquist = NyquistLayers::new(self.profile, end, |index, modulus| {
            [self.travel(index, end, self.speed(index, modulus).slowness)]
        })?;
        Ok(Self { nyquist, ..self })
    }

    #[inline(always)]
    fn speed<C: ComplexArithmetic>(&self, index: usize, modulus: C) -> WaveSpeed<C> {
        let speed = modulus.scale(self.soils[index][1]).sqrt();
        WaveSpeed { speed, slowness: speed.inverse() }
    }

    /// κh of a layer, from the slowness 1/c.
    #[inline(always)]
    fn travel<C: ComplexArithmetic>(&self, index: usize, s: C, slowness: C) -> C {
        s.scale(self.profile.layers()[index].thickness) * slowness
    }

    /// Overwrites `results` with the functions, from the waves at the bottom.
    ///
    /// `total`: travel Σ κh through all layers.
    #[inline(always)]
    fn quantities<C: ComplexArithmetic>(
        &self,
        contour: &ContourLanes<C>,
        bottom: WavePair<C>,
        total: C,
        layer_values: &[ColumnLayer<C>],
        results: &mut [C],
    ) {
        let layers = self.profile.layers().len();
        // A rigid base moves like the bottom of the lowest layer.
        let is_outcrop = self.control == ControlPoint::Outcrop
            && matches!(self.profile.bedrock(), Bedrock::HalfPlane { .. });
        let value = if is_outcrop { bottom.up } else { (bottom.up + bottom.down).scale(0.5) };
        let mut decay = value.inverse().scale(0.5);
        match self.quantity {
            ColumnQuantity::Inverse => {
                results[0] = value;
                results[1] = total;
            }
            ColumnQuantity::Accelerations => {
                results[layers] = (bottom.up + bottom.down) * decay;
                let pairs = results[..layers].iter_mut().zip(&layer_values[..layers]);
                for (result, values) in pairs.rev() {
                    decay = decay * values.half_decay * values.half_decay;
                    *result = (values.top.up + values.top.down) * decay;
                }
            }
            ColumnQuantity::Strains => {
                let square = (contour.s * contour.s).inverse();
                let layer_data = self.profile.layers().iter().zip(&layer_values[..layers]);
                for (result, (layer, values)) in results[..layers].iter_mut().zip(layer_data).rev()
                {
                    let half_decay = values.half_decay;
                    decay = decay * half_decay;
                    let wavenumber = values.travel.scale(1.0 / layer.thickness) * square;
                    let difference = values.top.up - values.top.down * half_decay * half_decay;
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

    fn count(&self) -> usize {
        let layers = self.profile.layers().len();
        match self.quantity {
            ColumnQuantity::Inverse => 2,
            ColumnQuantity::Accelerations => layers + 1,
            ColumnQuantity::Strains => layers,
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
        let mut total = zero;
        let mut impedance_above: Option<C> = None;
        if layer_values.len() != moduli.len() {
            layer_values.clear();
            layer_values.resize(moduli.len(), ColumnLayer::filled(zero));
        }
        let layers = self.profile.layers().len();
        for (index, modulus) in moduli.iter().enumerate() {
            if !contour.repeats {
                layer_values[index] = ColumnLayer::filled(zero);
                layer_values[index].exact = self.speed(index, *modulus);
            }
            let exact = layer_values[index].exact;
            let mut modified = exact;
            let is_layer = index < layers;
            let mut travel = zero;
            if is_layer {
                travel = self.travel(index, contour.s, exact.slowness);
            }
            if contour.is_in_band() {
                modified = self.speed(index, self.nyquist.modulus(index, contour, *modulus));
                if is_layer {
                    [travel] = self.nyquist.travels(index, contour, [travel]);
                }
            }
            let density = self.soils[index][0];
            if let Some(above) = impedance_above {
                waves = waves.below_interface(above, modified.slowness.scale(1.0 / density));
            }
            impedance_above = Some(modified.speed.scale(density));
            if !is_layer {
                break;
            }
            total = total + travel;
            let round_trip = if self.quantity == ColumnQuantity::Inverse {
                travel.scale(-2.0).exp()
            } else {
                let half_decay = travel.scale(-0.5).exp();
                layer_values[index] = ColumnLayer { exact, top: waves, travel, half_decay };
                let through = half_decay * half_decay;
                through * through
            };
            waves.down = waves.down * round_trip;
        }
        self.quantities(contour, waves, total, layer_values, results);
    }
}
