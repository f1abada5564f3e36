//! Random numbers of a scene, in SI units.

use basemat::Soil;
use basemat_problems::random::Random;
use basemat_problems::scenes::SCENE_GRAVITY;

use super::view::View;

/// Steps of a run.
pub(crate) const RUN_STEPS: usize = 40;
/// Density of the soil, kg/m³.
pub(crate) const SOIL_DENSITY: f64 = 1900.0;

/// Sizes, stiffnesses and shaking of a scene.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Numbers {
    /// Sides of the base along x and y, m.
    pub(crate) sides: [f64; 2],
    pub(crate) height: f64,
    /// Mean density of the structure, kg/m³.
    pub(crate) density: f64,
    /// Eccentricity of masses along x and y, of the sides.
    pub(crate) eccentricity: [f64; 2],
    /// Approximate lowest frequency of the structure on a fixed base, Hz.
    pub(crate) frequency: f64,
    /// Shear modulus of the soil, Pa.
    pub(crate) modulus: f64,
    pub(crate) poisson: f64,
    pub(crate) friction: f64,
    pub(crate) time_step: f64,
    /// Peaks of the acceleration along x, y and up, m/s².
    pub(crate) peaks: [f64; 3],
    /// Waves in the run.
    pub(crate) waves: f64,
    /// Direction of a wave in plan from x, rad, and its angle from the vertical.
    pub(crate) azimuth: f64,
    pub(crate) angle: f64,
    /// Depth of a trench or of a layer, of half the length.
    pub(crate) depth: f64,
}

impl Numbers {
    pub(crate) fn draw(seed: u64) -> Self {
        let mut random = Random(seed);
        let length = random.within(4.0, 8.0);
        let sides = [length, length * random.within(0.6, 1.0)];
        let modulus = random.log_within(2e7, 2e8);
        let poisson = random.within(0.1, 0.45);
        let speed = (modulus / SOIL_DENSITY).sqrt();
        let eccentricity = [random.within(0.02, 0.08), random.within(0.02, 0.08)];
        let strength = SCENE_GRAVITY * random.log_within(0.1, 0.8);
        Self {
            sides,
            height: length * random.within(0.5, 1.5),
            density: random.within(250.0, 700.0),
            eccentricity,
            frequency: random.log_within(2.0, 10.0),
            modulus,
            poisson,
            friction: random.within(0.2, 0.6),
            time_step: random.log_within(0.05, 0.25) * length / speed,
            peaks: [strength, -0.7 * strength, 0.3 * strength],
            waves: random.within(2.0, 4.0),
            azimuth: random.within(0.2, 1.3),
            angle: random.within(0.1, 0.4),
            depth: random.within(0.3, 0.8),
        }
    }

    pub(crate) fn soil(&self, view: &View) -> Soil {
        let frame = &view.frame;
        let density = SOIL_DENSITY * frame.density();
        Soil::new(self.modulus * frame.pressure(), self.poisson, density).unwrap()
    }

    /// Mass of the structure, kg, in the plane per metre.
    pub(crate) fn mass(&self, in_plan: bool) -> f64 {
        let depth = if in_plan { self.sides[1] } else { 1.0 };
        self.density * self.sides[0] * depth * self.height
    }

    /// Mean pressure of the weight, Pa.
    pub(crate) fn pressure(&self) -> f64 {
        self.density * self.height * SCENE_GRAVITY
    }

    pub(crate) fn duration(&self) -> f64 {
        RUN_STEPS as f64 * self.time_step
    }

    /// Acceleration at a time (s), relative to its peak: waves that grow and fade.
    pub(crate) fn shape(&self, time: f64) -> f64 {
        let phase = (time / self.duration()).clamp(0.0, 1.0);
        let window = (std::f64::consts::PI * phase).sin().powi(2);
        window * (std::f64::consts::TAU * self.waves * phase).sin()
    }
}
