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

use super::sampled::{At, Functions, Highest};
use crate::error::Result;
use crate::linalg::{Complex, ComplexArithmetic};
use crate::soil::{Bedrock, Soil, SoilProfile};

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

/// Functions of s of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sought {
    /// Control motion by surface motion without its factor e^x, and x.
    Inverse,
    /// Acceleration at the tops of all layers and of the base, by the control motion.
    Accelerations,
    /// Strain in the middle of all layers, by the control motion's acceleration.
    Strains,
}

/// Functions of a profile for one kind of wave, with unmodified layers or layers modified for samples.
#[derive(Debug)]
pub(super) struct Column<'a> {
    profile: &'a SoilProfile,
    /// Soils from the surface down: density, and M/(μρ) of the wave's stiffness M.
    soils: Vec<[f64; 2]>,
    control: ControlPoint,
    sought: Sought,
    highest: Highest<1>,
}

impl<'a> Column<'a> {
    /// Functions of the unmodified layers.
    pub(super) fn exact(
        profile: &'a SoilProfile,
        wave: VerticalWave,
        control: ControlPoint,
        sought: Sought,
    ) -> Self {
        let stiffness = |soil: Soil| match wave {
            VerticalWave::Shear => 1.0,
            VerticalWave::Pressure => 1.0 / soil.speed_ratio_squared(),
        };
        let of = |soil: Soil| [soil.density(), stiffness(soil) / soil.density()];
        let soils = profile.soils().map(|(soil, _)| of(soil)).collect();
        Self { profile, soils, control, sought, highest: Highest::default() }
    }

    /// These functions for layers modified for samples, on a contour that ends at s = `end`.
    pub(super) fn sampled(self, end: Complex) -> Result<Self> {
        let travel = |index: usize, modulus| [self.travel(index, end, self.speed(index, modulus))];
        Ok(Self { highest: Highest::new(self.profile, end, travel)?, ..self })
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
    fn cross<C: ComplexArithmetic>([up, down]: [C; 2], above: C, below: C) -> [C; 2] {
        let sum = (up + down).scale(0.5);
        let difference = (up - down).scale(0.5) * above * below;
        [sum + difference, sum - difference]
    }

    /// Overwrites `found` with the functions, from the waves (up, down) at the bottom.
    ///
    /// `total`: travel Σ κh through all layers. `kept`: values of each soil.
    #[inline(always)]
    fn sought<C: ComplexArithmetic>(
        &self,
        at: &At<C>,
        waves: [C; 2],
        total: C,
        kept: &[[C; 6]],
        found: &mut [C],
    ) {
        let ([up, down], layers) = (waves, self.profile.layers().len());
        // A rigid base moves like the bottom of the lowest layer.
        let is_outcrop = self.control == ControlPoint::Outcrop
            && matches!(self.profile.bedrock(), Bedrock::HalfPlane { .. });
        let value = if is_outcrop { up } else { (up + down).scale(0.5) };
        let mut decay = value.inverse().scale(0.5);
        match self.sought {
            Sought::Inverse => {
                found[0] = value;
                found[1] = total;
            }
            Sought::Accelerations => {
                found[layers] = (up + down) * decay;
                let kept = found[..layers].iter_mut().zip(&kept[..layers]);
                for (found, [_, _, up, down, _, half]) in kept.rev() {
                    decay = decay * *half * *half;
                    *found = (*up + *down) * decay;
                }
            }
            Sought::Strains => {
                let square = (at.s * at.s).inverse();
                let sizes = self.profile.layers().iter().zip(&kept[..layers]);
                for (found, (layer, own)) in found[..layers].iter_mut().zip(sizes).rev() {
                    let [_, _, up, down, travel, half] = own;
                    decay = decay * *half;
                    let wavenumber = travel.scale(1.0 / layer.thickness) * square;
                    *found = (*up - *down * *half * *half) * wavenumber * decay;
                    decay = decay * *half;
                }
            }
        }
    }
}

impl Functions for Column<'_> {
    /// For a soil: c and 1/c; for a layer also waves up and down at its top, its travel κh and e^(−κh/2).
    type LayerValues<C: ComplexArithmetic> = [C; 6];

    fn profile(&self) -> &SoilProfile {
        self.profile
    }

    fn count(&self) -> usize {
        let layers = self.profile.layers().len();
        match self.sought {
            Sought::Inverse => 2,
            Sought::Accelerations => layers + 1,
            Sought::Strains => layers,
        }
    }

    #[inline(always)]
    fn evaluate<C: ComplexArithmetic>(
        &self,
        at: &At<C>,
        moduli: &[C],
        kept: &mut Vec<[C; 6]>,
        found: &mut [C],
    ) {
        let [none, one] = [at.s.like_real(0.0), at.s.like_real(1.0)];
        let (mut waves, mut total) = ([one; 2], none);
        let mut above: Option<C> = None;
        if kept.len() != moduli.len() {
            kept.clear();
            kept.resize(moduli.len(), [none; 6]);
        }
        let layers = self.profile.layers().len();
        for (index, modulus) in moduli.iter().enumerate() {
            if !at.repeats {
                let [speed, slowness] = self.speed(index, *modulus);
                kept[index] = [speed, slowness, none, none, none, none];
            }
            let speeds = [kept[index][0], kept[index][1]];
            let mut now = speeds;
            let is_layer = index < layers;
            let mut travel = none;
            if is_layer {
                travel = self.travel(index, at.s, speeds);
            }
            if at.is_near() {
                now = self.speed(index, self.highest.modulus(index, at, *modulus));
                if is_layer {
                    [travel] = self.highest.travels(index, at, [travel]);
                }
            }
            let [speed, slowness] = now;
            let density = self.soils[index][0];
            if let Some(above) = above {
                waves = Self::cross(waves, above, slowness.scale(1.0 / density));
            }
            above = Some(speed.scale(density));
            if !is_layer {
                break;
            }
            let [up, down] = waves;
            total = total + travel;
            let both = if self.sought == Sought::Inverse {
                travel.scale(-2.0).exp()
            } else {
                let half = travel.scale(-0.5).exp();
                kept[index] = [speeds[0], speeds[1], up, down, travel, half];
                let once = half * half;
                once * once
            };
            waves = [up, down * both];
        }
        self.sought(at, waves, total, kept, found);
    }
}
