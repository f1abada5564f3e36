//! A block with walls in a trench, on independent springs and dashpots at all elements of the trench.

use basemat::bem::embedded::{Trench, TrenchElements, TrenchGround};
use basemat::bem::{ContactElement, Ground, GroundDescription};
use basemat::interface::{Coulomb, InterfaceLaw};
use basemat::motion::VerticalIncidence;
use basemat::site::TrenchMotion;
use basemat::structure::{RigidBlock, WithWalls};
use basemat::{Observer, Result, Soil, unobserved};

/// Independent springs and dashpots at all elements of the trench, Pa/m and Pa s/m.
#[derive(Clone)]
pub(super) struct TrenchSprings {
    elements: Vec<ContactElement>,
    stiffness: f64,
    dashpots: f64,
    /// Pressure at rest over gravity, kg/m².
    pressure_at_rest: Vec<f64>,
    mass_above: Vec<f64>,
    /// Factor by which displacements decay in a step without traction.
    decay: f64,
    displacement: Vec<f64>,
}

pub(super) const SOIL_DENSITY: f64 = 1900.0;

impl TrenchSprings {
    pub(super) fn new(elements: &TrenchElements, stiffness: f64, dashpots: f64) -> Self {
        let elements = elements.elements();
        let pressure_at_rest =
            elements.iter().map(|element| -0.5 * SOIL_DENSITY * element.center()[2]).collect();
        let displacement = vec![0.0; 2 * elements.len()];
        Self {
            elements,
            stiffness,
            dashpots,
            pressure_at_rest,
            mass_above: vec![],
            decay: 0.0,
            displacement,
        }
    }

    /// The same springs with the mass of soil above each element as around `ground`.
    pub(super) fn with_mass_above(self, ground: &TrenchGround) -> Self {
        Self { mass_above: ground.description().mass_above, ..self }
    }

    fn set_diagonal(&self, value: f64, matrix: &mut [f64]) {
        matrix.fill(0.0);
        matrix
            .iter_mut()
            .step_by(self.displacement.len() + 1)
            .for_each(|entry| *entry = value);
    }

    /// Displacement at the end of a step under a unit traction, m/Pa.
    fn step_flexibility(&self) -> f64 {
        (1.0 - self.decay) / self.stiffness
    }
}

impl Ground for TrenchSprings {
    fn elements(&self) -> &[ContactElement] {
        &self.elements
    }

    fn prepare(&mut self, step: f64, _: Option<usize>, _: &mut Observer<'_>) -> Result<()> {
        self.decay = (-self.stiffness * step / self.dashpots).exp();
        self.displacement.fill(0.0);
        Ok(())
    }

    fn step_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.set_diagonal(self.step_flexibility(), matrix);
        Ok(())
    }

    fn history(&mut self, displacement: &mut [f64]) -> Result<()> {
        for (history, previous) in displacement.iter_mut().zip(&self.displacement) {
            *history = self.decay * previous;
        }
        Ok(())
    }

    fn commit(&mut self, traction: &[f64]) {
        let step_flexibility = self.step_flexibility();
        for (displacement, traction) in self.displacement.iter_mut().zip(traction) {
            *displacement = self.decay * *displacement + step_flexibility * traction;
        }
    }

    fn static_compliance(&self, matrix: &mut [f64]) -> Result<()> {
        self.set_diagonal(1.0 / self.stiffness, matrix);
        Ok(())
    }

    fn description(&self) -> GroundDescription {
        GroundDescription {
            pressure_at_rest: self.pressure_at_rest.clone(),
            mass_above: self.mass_above.clone(),
            ..Default::default()
        }
    }
}

pub(super) const TRENCH_WIDTH: f64 = 12.0;
pub(super) const BLOCK_HEIGHT: f64 = 20.0;
pub(super) const TRENCH_DEPTH: f64 = 5.0;

pub(super) fn soil() -> Soil {
    Soil::from_shear_wave_speed(200.0, 0.3, SOIL_DENSITY).unwrap()
}

pub(super) fn walled_block() -> WithWalls {
    WithWalls::new(RigidBlock::new(TRENCH_WIDTH, BLOCK_HEIGHT, 900.0).unwrap(), TRENCH_DEPTH)
        .unwrap()
}

pub(super) fn trench_elements() -> TrenchElements {
    Trench::new(-0.5 * TRENCH_WIDTH..0.5 * TRENCH_WIDTH, TRENCH_DEPTH)
        .unwrap()
        .elements(6, 4)
        .unwrap()
}

/// Motion of the free field around the trench under waves from below.
pub(super) fn trench_motion(motion: impl Into<VerticalIncidence>) -> TrenchMotion {
    let ground = TrenchGround::new(soil(), trench_elements()).unwrap();
    TrenchMotion::new(&ground, motion, &mut unobserved).unwrap()
}

/// Coulomb friction of 0.5 on the base and 0.3 on the walls.
pub(super) fn friction_laws() -> Vec<Box<dyn InterfaceLaw>> {
    trench_elements().interfaces(Coulomb::new(0.5).unwrap(), Coulomb::new(0.3).unwrap())
}
