//! A rocking and sliding block on soil, and how smooth its normal force is.

use basemat::bem::{ElasticGround, Strip};
use basemat::coupled::{DissipativeMidpoint, Midpoint, Probe, Theta};
use basemat::fem::{Direction, Layer, Material, Mesh};
use basemat::interface::{Coulomb, UnilateralCondition};
use basemat::motion::{STANDARD_GRAVITY, el_centro_1940};
use basemat::structure::{FemModel, RigidBlock};
use basemat::{Result, Simulation, Soil};

/// Content above this frequency counts as chatter, Hz.
const CUT: f64 = 20.0;
const DENSITY: f64 = 1500.0;
const WIDTH: f64 = 4.0;

#[derive(Debug, Clone, Copy)]
pub enum Scheme {
    Midpoint,
    Theta(f64),
    Dissipative(f64),
}

/// A run of the block under El Centro × 2.
#[derive(Debug, Clone, Copy)]
pub struct Scene {
    pub friction: f64,
    pub scheme: Scheme,
    pub activation: UnilateralCondition,
    pub shear_speed: f64,
    pub elements: usize,
    pub time_step: f64,
    pub duration: f64,
    pub height: f64,
    /// Young's modulus of a flexible block.
    pub young: Option<f64>,
}

/// Results of a run; forces relative to the weight, energies to the input's peak.
#[derive(Debug, Clone, Copy)]
pub struct Outcome {
    pub rms_above: f64,
    pub peak_above: f64,
    /// Root mean square of what alternates from step to step.
    pub alternating: f64,
    /// The same two of the horizontal acceleration of the top, over gravity.
    pub acceleration_above: f64,
    pub acceleration_alternating: f64,
    /// Largest base shear, over the weight.
    pub shear: f64,
    pub peak_slip: f64,
    pub residual_slip: f64,
    pub uplift: f64,
    pub rotation: f64,
    pub contact: f64,
    pub algorithmic: f64,
    /// Deepest penetration of a closed element, m.
    pub penetration: f64,
    pub energy_error: f64,
    pub changes: usize,
}

impl Scene {
    pub fn run(&self) -> Result<Outcome> {
        let soil = Soil::new(1900.0 * self.shear_speed.powi(2), 0.33, 1900.0)?;
        let half = 0.5 * WIDTH;
        let law = Coulomb::new(self.friction)?.with_unilateral_condition(self.activation)?;
        let builder = Simulation::builder(self.time_step)
            .ground(ElasticGround::new(soil, Strip::uniform(-half..half, self.elements)?)?)
            .interface(law)
            .motion(el_centro_1940().scaled(2.0)?)
            .gravity(STANDARD_GRAVITY);
        let builder = match self.scheme {
            Scheme::Midpoint => builder.scheme(Midpoint),
            Scheme::Theta(theta) => builder.scheme(Theta::new(theta)?),
            Scheme::Dissipative(gamma) => builder.scheme(DissipativeMidpoint::new(gamma)?),
        };
        let builder = match self.young {
            None => {
                let block = RigidBlock::new(WIDTH, self.height, DENSITY)?;
                let top = block.horizontal_at(self.height);
                builder.structure(block).probe(Probe::acceleration("top", top))
            }
            Some(young) => {
                let material = Material::new(young, 0.2, DENSITY)?;
                let rows = self.elements;
                let layers = [Layer::new(self.height, rows, material)];
                let mesh = Mesh::layered_block(-half..half, self.elements, &layers)?;
                let model = FemModel::on_base(mesh)?;
                let top = model
                    .row(model.mesh().nearest_node(0.0, self.height).unwrap(), Direction::X)?;
                builder.structure(model).probe(Probe::acceleration("top", top))
            }
        };
        let mut simulation = builder.build()?;
        let weight = WIDTH * self.height * DENSITY * STANDARD_GRAVITY;
        let (mut force, mut acceleration) = (Vec::new(), Vec::new());
        let (mut penetration, mut input) = (0.0_f64, 0.0_f64);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive")]
        let steps = (self.duration / self.time_step).round() as usize;
        let run = simulation.run(steps, |state| {
            force.push(state.normal_force / weight);
            acceleration.push(state.probes[0] / STANDARD_GRAVITY);
            input = input.max(state.energy_balance.input.abs());
            for contact in &state.contact {
                penetration = penetration.max(-contact.gap);
            }
        })?;
        let fast = high_pass(&force, self.time_step);
        Ok(Outcome {
            alternating: alternating(&force),
            acceleration_above: root_mean_square(&high_pass(&acceleration, self.time_step)),
            acceleration_alternating: alternating(&acceleration),
            shear: run.whole.base_shear.magnitude() / weight,
            rms_above: root_mean_square(&fast),
            peak_above: fast.iter().fold(0.0, |m, f| m.max(f.abs())),
            peak_slip: run.whole.largest_slip.largest().value.abs(),
            residual_slip: run.whole.residual_slip,
            uplift: run.whole.uplifted_fraction.largest().value,
            rotation: run.whole.base_rotation.magnitude(),
            contact: run.energy_balance.contact / input,
            algorithmic: run.energy_balance.algorithmic / input,
            penetration,
            energy_error: run.energy_error,
            changes: run.mode_changes,
        })
    }
}

fn root_mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|x| x * x).sum::<f64>() / values.len() as f64).sqrt()
}

/// Root mean square of what alternates from step to step.
fn alternating(values: &[f64]) -> f64 {
    let parts: Vec<f64> = values.windows(3).map(|x| 0.25 * (x[0] + x[2]) - 0.5 * x[1]).collect();
    root_mean_square(&parts)
}

/// Content above [`CUT`]: fourth-order Butterworth high-pass, forwards and backwards, so that it
/// shifts nothing in time.
fn high_pass(signal: &[f64], time_step: f64) -> Vec<f64> {
    let mut out: Vec<f64> = signal.iter().map(|s| s - signal[0]).collect();
    for _ in 0..2 {
        for damping in [0.923_879_532_511_286_7, 0.382_683_432_365_089_8] {
            section(&mut out, damping, time_step);
        }
        out.reverse();
    }
    out
}

/// One second-order section s²/(s² + 2ζωs + ω²), bilinear with the cut-off kept.
fn section(signal: &mut [f64], damping: f64, time_step: f64) {
    let k = (std::f64::consts::PI * CUT * time_step).tan();
    let norm = 1.0 + 2.0 * damping * k + k * k;
    let (a1, a2) = (2.0 * (k * k - 1.0) / norm, (1.0 - 2.0 * damping * k + k * k) / norm);
    let (mut x1, mut x2, mut y1, mut y2) = (0.0, 0.0, 0.0, 0.0);
    for x in signal {
        let y = (*x - 2.0 * x1 + x2) / norm - a1 * y1 - a2 * y2;
        (x2, x1, y2, y1) = (x1, *x, y1, y);
        *x = y;
    }
}
