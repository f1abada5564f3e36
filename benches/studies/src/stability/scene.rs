//! The scene of a cell: a block or a tower on a strip of soil.

use std::collections::HashMap;
use std::f64::consts::TAU;
use std::sync::{Mutex, PoisonError};

use basemat::bem::full_plane::{ConvolutionQuadrature, CqMethod, FullPlaneGround};
use basemat::bem::{ElasticGround, Strip};
use basemat::contact::ContactSearch;
use basemat::coupled::{
    DissipativeMidpoint, GravityStage, HhtAlpha, Load, Newmark, SimulationBuilder,
};
use basemat::fem::{Layer, Material, Mesh};
use basemat::history::HistoryMethod;
use basemat::interface::{Bonded, Coulomb, ThinLayer, Yielding};
use basemat::motion::STANDARD_GRAVITY;
use basemat::structure::{FemModel, RigidBlock};
use basemat::{Result, Simulation, Soil};

use super::motions::ShakingMotion;

/// Width of the base, m.
const BASE_WIDTH: f64 = 10.0;
/// Free elements beside the base in the full-plane schemes, as in the paper.
const FREE_ELEMENTS: usize = 5;

/// Scheme of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) enum StabilityScheme {
    /// Half-plane with element means, midpoint rule.
    Basemat,
    /// The half-plane with other time schemes: dissipative midpoint rule with γ = 0.8, average acceleration,
    /// HHT-α with α = −0.1.
    Dissipative,
    Newmark,
    Hht,
    /// Patel & Spyrakos as printed: full plane in time, collocation, trapezoidal rule.
    Paper,
    /// Full plane by convolution quadrature (BDF2), trapezoidal rule.
    Quadrature,
}

impl StabilityScheme {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Basemat => "basemat",
            Self::Dissipative => "dissipative",
            Self::Newmark => "newmark",
            Self::Hht => "hht",
            Self::Paper => "paper",
            Self::Quadrature => "quadrature",
        }
    }

    /// Whether the ground is the crate's half-plane.
    pub(crate) fn is_half_plane(self) -> bool {
        !matches!(self, Self::Paper | Self::Quadrature)
    }

    /// Whether the scheme cannot create energy.
    pub(crate) fn is_passive(self) -> bool {
        matches!(self, Self::Basemat | Self::Dissipative)
    }
}

/// Law between base and soil.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum StabilityLaw {
    Bonded,
    /// Friction coefficient.
    Coulomb(f64),
    /// Thickness over height of the neighbouring element (1 m), and ratio of the debonded stiffness; friction 0.4.
    Layer(f64, f64),
    /// Bearing pressure relative to the mean static pressure; friction 0.4.
    Yielding(f64),
}

/// All parameters of a cell.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StabilityScene {
    pub(crate) scheme: StabilityScheme,
    /// c₁Δt over the mean element length.
    pub(crate) beta: f64,
    pub(crate) poisson: f64,
    pub(crate) elements: usize,
    /// Longest over shortest element; the short ones at both ends.
    pub(crate) grading: f64,
    /// Ratio of Young's modulus of the structure to the soil's; infinite for a rigid block.
    pub(crate) stiffness: f64,
    /// Ratio of the structure's mass to the mass of a piece of soil as wide and as high as its base.
    pub(crate) mass: f64,
    /// Height over width.
    pub(crate) slenderness: f64,
    pub(crate) law: StabilityLaw,
    pub(crate) motion: ShakingMotion,
    /// Steps of shaking; the steps of [`StabilityScene::rest`] follow.
    pub(crate) steps: usize,
    pub(crate) history: HistoryMethod,
    /// Amplitude of a horizontal load at the top, over the weight.
    pub(crate) push: f64,
    /// Initial tilt over b/h, the largest tilt in static equilibrium on rigid ground.
    pub(crate) tilt: f64,
}

impl Default for StabilityScene {
    fn default() -> Self {
        Self {
            scheme: StabilityScheme::Basemat,
            beta: 0.5,
            poisson: 1.0 / 3.0,
            elements: 10,
            grading: 1.0,
            stiffness: f64::INFINITY,
            mass: 0.7,
            slenderness: 1.5,
            law: StabilityLaw::Coulomb(0.4),
            motion: ShakingMotion::Sines,
            steps: 1000,
            history: HistoryMethod::Auto,
            push: 0.0,
            tilt: 0.0,
        }
    }
}

impl StabilityScene {
    /// The simulation at its first step.
    pub(crate) fn build(&self) -> Result<Simulation> {
        let soil = Soil::new(80.0e6, self.poisson, 1900.0)?;
        let step = self.time_step(&soil);
        let builder = Simulation::builder(step)
            .motion(self.motion.field(self.steps, step)?)
            .expected_steps(self.steps + self.rest());
        let builder = self.with_ground(builder, soil)?;
        let builder = self.with_law(builder, &soil)?;
        let builder = self.with_load(builder, &soil, step)?;
        self.with_structure(builder, &soil)?.build()
    }

    /// Steps of rest after the shaking.
    pub(crate) fn rest(&self) -> usize {
        self.steps.min(100_000)
    }

    pub(crate) fn time_step(&self, soil: &Soil) -> f64 {
        self.beta * BASE_WIDTH / (self.elements as f64 * soil.pressure_wave_speed())
    }

    /// Whether the scheme is computed for these parameters.
    ///
    /// The number of lags of the full plane is the number of steps in which waves cross its surface. It is large where
    /// S waves are slow compared with the P waves of a step. The quadrature computes all of them at once.
    pub(crate) fn exists(&self) -> bool {
        match self.scheme {
            StabilityScheme::Basemat
            | StabilityScheme::Dissipative
            | StabilityScheme::Newmark
            | StabilityScheme::Hht => true,
            StabilityScheme::Paper => self.poisson <= 0.45,
            StabilityScheme::Quadrature => self.poisson <= 0.45 && self.beta >= 0.1,
        }
    }

    fn with_ground(&self, builder: SimulationBuilder, soil: Soil) -> Result<SimulationBuilder> {
        if self.scheme.is_half_plane() {
            let strip = Strip::from_nodes(self.nodes())?;
            let ground = ElasticGround::new(soil, strip)?.with_history(self.history)?;
            let builder = builder.ground(ground);
            return Ok(match self.scheme {
                StabilityScheme::Dissipative => builder.scheme(DissipativeMidpoint::default()),
                StabilityScheme::Newmark => builder.scheme(Newmark::default()),
                StabilityScheme::Hht => builder.scheme(HhtAlpha::new(-0.1)?),
                _ => builder,
            });
        }
        // The maps also have runs with growth.
        let ground = self.full_plane(soil)?.allow_growth();
        Ok(builder.ground(ground).scheme(Newmark::default()))
    }

    /// Element ends: lengths in geometric progression from both ends to the middle.
    fn nodes(&self) -> Vec<f64> {
        let count = self.elements;
        let middle = ((count - 1) / 2).max(1) as f64;
        let mut position = 0.0;
        let mut nodes = vec![0.0];
        for k in 0..count {
            position += self.grading.powf(k.min(count - 1 - k) as f64 / middle);
            nodes.push(position);
        }
        nodes.iter().map(|x| BASE_WIDTH * (x / position - 0.5)).collect()
    }

    fn with_law(&self, builder: SimulationBuilder, soil: &Soil) -> Result<SimulationBuilder> {
        Ok(match self.law {
            StabilityLaw::Bonded => builder.interface(Bonded),
            StabilityLaw::Coulomb(friction) => builder.interface(Coulomb::new(friction)?),
            StabilityLaw::Yielding(ratio) => {
                let pressure = self.weight(soil) / BASE_WIDTH;
                builder.interface(Yielding::new(ratio * pressure, 0.4)?)
            }
            StabilityLaw::Layer(ratio, debonded) => {
                let layer = ThinLayer::new(*soil, 1.0, 0.4)?
                    .with_thickness_ratio(ratio)?
                    .with_debonded_ratio(debonded)?;
                let builder = builder.interface(layer);
                if self.scheme == StabilityScheme::Paper {
                    builder.contact_search(ContactSearch::FlowChart { iterations: 60 })
                } else {
                    builder
                }
            }
        })
    }

    /// Weight of the structure, N/m.
    fn weight(&self, soil: &Soil) -> f64 {
        self.mass * soil.density() * BASE_WIDTH * BASE_WIDTH * STANDARD_GRAVITY
    }

    /// Adds the push during the shaking, and the tilt, of rigid blocks.
    fn with_load(
        &self,
        mut builder: SimulationBuilder,
        soil: &Soil,
        step: f64,
    ) -> Result<SimulationBuilder> {
        let block = RigidBlock::new(BASE_WIDTH, self.slenderness * BASE_WIDTH, 1.0)?;
        if self.push != 0.0 {
            let amplitude = self.push * self.weight(soil);
            let end = self.steps as f64 * step;
            let top = block.horizontal_at(self.slenderness * BASE_WIDTH);
            builder = builder.load(Load::new(top, move |t: f64| {
                let sines = [7.0, 31.0, 113.0].map(|turns| (TAU * turns * t / end).sin());
                if t < end { amplitude * sines.iter().sum::<f64>() / 3.0 } else { 0.0 }
            }));
        }
        if self.tilt != 0.0 {
            let tilt = self.tilt / self.slenderness;
            let edge = 0.5 * BASE_WIDTH * tilt;
            builder = builder
                .gravity_stage(GravityStage::Unloaded)
                .initial_displacement([0.0, edge, tilt]);
        }
        Ok(builder)
    }

    fn with_structure(&self, builder: SimulationBuilder, soil: &Soil) -> Result<SimulationBuilder> {
        let density = self.mass * soil.density() / self.slenderness;
        let height = self.slenderness * BASE_WIDTH;
        if self.stiffness == f64::INFINITY {
            return Ok(builder.structure(RigidBlock::new(BASE_WIDTH, height, density)?));
        }
        let young = 2.0 * (1.0 + soil.poisson()) * soil.shear_modulus() * self.stiffness;
        let layers = [Layer::new(height, 5, Material::new(young, 0.2, density)?)];
        let mesh = Mesh::layered_block(-0.5 * BASE_WIDTH..0.5 * BASE_WIDTH, 5, &layers)?;
        Ok(builder.structure(FemModel::on_base(mesh)?))
    }

    /// Growth per step by the assessment of the boundary equation, base uplifted and bonded.
    ///
    /// `None` for the half-plane, and for very short steps and many elements, which would take long.
    pub(crate) fn assess(&self, assessments: &Assessments) -> Option<[f64; 2]> {
        let is_affordable = (0.25..=10.0).contains(&self.beta) && self.elements <= 10;
        if self.scheme.is_half_plane() || !is_affordable {
            return None;
        }
        let numbers = [self.beta, self.poisson].map(f64::to_bits);
        let key = (self.scheme, numbers, self.elements);
        let cached_assessments =
            assessments.lock().unwrap_or_else(PoisonError::into_inner).get(&key).copied();
        if let Some(growth) = cached_assessments {
            return growth;
        }
        let growth = self.growth_of_boundary().ok();
        assessments.lock().unwrap_or_else(PoisonError::into_inner).insert(key, growth);
        growth
    }

    fn growth_of_boundary(&self) -> Result<[f64; 2]> {
        let soil = Soil::new(80.0e6, self.poisson, 1900.0)?;
        let min_growth = 1.0 / self.steps as f64;
        let states = self.full_plane(soil)?.assess(self.time_step(&soil), min_growth)?;
        Ok(states.map(|state| state.growth_per_step))
    }

    fn full_plane(&self, soil: Soil) -> Result<FullPlaneGround> {
        let half_width = 0.5 * BASE_WIDTH;
        let ground =
            FullPlaneGround::strip(soil, -half_width..half_width, self.elements, FREE_ELEMENTS)?;
        Ok(if self.scheme == StabilityScheme::Paper {
            ground
        } else {
            ground.with_kernel(|segments, soil, step| {
                let kernel = ConvolutionQuadrature::new(soil, segments, step, CqMethod::Bdf2)?;
                Ok(Box::new(kernel))
            })
        })
    }
}

/// Growth per step of the assessed boundary equations, by scheme, β and ν, and elements.
pub(crate) type Assessments = Mutex<HashMap<(StabilityScheme, [u64; 2], usize), Option<[f64; 2]>>>;
