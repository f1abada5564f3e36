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
            [self.travel(index, end, self.speed(index, modulus))]
        })?;
        Ok(Self { nyquist, ..self })
    }

    #[inline(always)]
    fn speed<C: ComplexArithmetic>(&self, index: usize, modulus: C) -> [C; 2] {
        let speed = modulus.scale(self.soils[index][1]).sqrt();
        [speed, speed.inverse()]
    }

    #[inline(always)]
    fn travel<C: ComplexArithmetic>(&self, index: usize, s: C, [_, slowness]: [C; 2]) -> C {
        s.scale(self.profile.layers()[index].thickness) * slowness
    }

    /// Waves (up, down) below an interface from the waves above it.
    ///
    /// `above`: impedance above; `below`: reciprocal of the impedance below.
    #[inline(always)]
    fn below_interface<C: ComplexArithmetic>([up, down]: [C; 2], above: C, below: C) -> [C; 2] {
        let sum = (up + down).scale(0.5);
        let difference = (up - down).scale(0.5) * above * below;
        [sum + difference, sum - difference]
    }

    /// Overwrites `results` with the functions, from the waves (up, down) at the bottom.
    ///
    /// `total`: travel Σ κh through all layers. `layer_values`: values of each soil.
    #[inline(always)]
    fn quantities<C: ComplexArithmetic>(
        &self,
        at: &ContourLanes<C>,
        waves: [C; 2],
        total: C,
        layer_values: &[[C; 6]],
        results: &mut [C],
    ) {
        let [up, down] = waves;
        let layers = self.profile.layers().len();
        // A rigid base moves like the bottom of the lowest layer.
        let is_outcrop = self.control == ControlPoint::Outcrop
            && matches!(self.profile.bedrock(), Bedrock::HalfPlane { .. });
        let value = if is_outcrop { up } else { (up + down).scale(0.5) };
        let mut decay = value.inverse().scale(0.5);
        match self.quantity {
            ColumnQuantity::Inverse => {
                results[0] = value;
                results[1] = total;
            }
            ColumnQuantity::Accelerations => {
                results[layers] = (up + down) * decay;
                let pairs = results[..layers].iter_mut().zip(&layer_values[..layers]);
                for (result, [_, _, up, down, _, half]) in pairs.rev() {
                    decay = decay * *half * *half;
                    *result = (*up + *down) * decay;
                }
            }
            ColumnQuantity::Strains => {
                let square = (at.s * at.s).inverse();
                let layer_data = self.profile.layers().iter().zip(&layer_values[..layers]);
                for (result, (layer, values)) in results[..layers].iter_mut().zip(layer_data).rev()
                {
                    let [_, _, up, down, travel, half] = values;
                    decay = decay * *half;
                    let wavenumber = travel.scale(1.0 / layer.thickness) * square;
                    *result = (*up - *down * *half * *half) * wavenumber * decay;
                    decay = decay * *half;
                }
            }
        }
    }
}

impl SiteFunctions for ColumnFunctions<'_> {
    /// For a soil: c and 1/c; for a layer also waves up and down at its top, its travel κh and e^(−κh/2).
    type LayerValues<C: ComplexArithmetic> = [C; 6];

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
        at: &ContourLanes<C>,
        moduli: &[C],
        layer_values: &mut Vec<[C; 6]>,
        results: &mut [C],
    ) {
        let zero = at.s.like_real(0.0);
        let one = at.s.like_real(1.0);
        let mut waves = [one; 2];
        let mut total = zero;
        let mut above: Option<C> = None;
        if layer_values.len() != moduli.len() {
            layer_values.clear();
            layer_values.resize(moduli.len(), [zero; 6]);
        }
        let layers = self.profile.layers().len();
        for (index, modulus) in moduli.iter().enumerate() {
            if !at.repeats {
                let [speed, slowness] = self.speed(index, *modulus);
                layer_values[index] = [speed, slowness, zero, zero, zero, zero];
            }
            let exact_speed = [layer_values[index][0], layer_values[index][1]];
            let mut modified_speed = exact_speed;
            let is_layer = index < layers;
            let mut travel = zero;
            if is_layer {
                travel = self.travel(index, at.s, exact_speed);
            }
            if at.is_in_band() {
                modified_speed = self.speed(index, self.nyquist.modulus(index, at, *modulus));
                if is_layer {
                    [travel] = self.nyquist.travels(index, at, [travel]);
                }
            }
            let [speed, slowness] = modified_speed;
            let density = self.soils[index][0];
            if let Some(above) = above {
                waves = Self::below_interface(waves, above, slowness.scale(1.0 / density));
            }
            above = Some(speed.scale(density));
            if !is_layer {
                break;
            }
            let [up, down] = waves;
            total = total + travel;
            let round_trip = if self.quantity == ColumnQuantity::Inverse {
                travel.scale(-2.0).exp()
            } else {
                let half = travel.scale(-0.5).exp();
                layer_values[index] = [exact_speed[0], exact_speed[1], up, down, travel, half];
                let through = half * half;
                through * through
            };
            waves = [up, down * round_trip];
        }
        self.quantities(at, waves, total, layer_values, results);
    }
}
