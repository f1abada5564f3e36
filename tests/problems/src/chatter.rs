//! A rocking and sliding block on soil, and measures of the chatter of its normal force.

use basemat::bem::{ElasticGround, Strip};
use basemat::coupled::{DissipativeMidpoint, Midpoint, Probe, SimulationBuilder, Theta};
use basemat::fem::{Direction, Layer, Material, Mesh};
use basemat::interface::{Coulomb, UnilateralCondition};
use basemat::motion::{STANDARD_GRAVITY, el_centro_1940};
use basemat::structure::{FemModel, RigidBlock};
use basemat::{Result, Simulation, Soil};

/// Frequency above which the content of a force or an acceleration counts as chatter, Hz.
const CUTOFF_FREQUENCY: f64 = 20.0;
const BLOCK_DENSITY: f64 = 1500.0;
const BLOCK_WIDTH: f64 = 4.0;

/// Time integration of the run.
#[derive(Debug, Clone, Copy)]
pub enum ChatterScheme {
    Midpoint,
    Theta(f64),
    Dissipative(f64),
}

/// A run of the block under El Centro × 2.
#[derive(Debug, Clone, Copy)]
pub struct ChatterScene {
    pub friction: f64,
    pub scheme: ChatterScheme,
    pub activation: UnilateralCondition,
    pub shear_speed: f64,
    pub elements: usize,
    pub time_step: f64,
    pub duration: f64,
    pub height: f64,
    /// Young's modulus of a flexible block, Pa; `None` for a rigid block.
    pub young: Option<f64>,
}

/// Results of a run: forces relative to the weight, energies relative to the largest input energy.
#[derive(Debug, Clone, Copy)]
pub struct ChatterResult {
    /// Root mean square of the normal force's content above the cut-off frequency.
    pub rms_above: f64,
    /// Largest magnitude of that content.
    pub peak_above: f64,
    /// Root mean square of the part of the normal force that alternates from step to step.
    pub alternating: f64,
    /// Root mean square of the top's horizontal acceleration above the cut-off frequency, relative to gravity.
    pub acceleration_above: f64,
    /// Root mean square of the part of that acceleration that alternates from step to step.
    pub acceleration_alternating: f64,
    /// Largest base shear, over the weight.
    pub shear: f64,
    pub peak_slip: f64,
    pub residual_slip: f64,
    pub uplift: f64,
    pub rotation: f64,
    pub contact_energy: f64,
    pub algorithmic_energy: f64,
    /// Deepest penetration of an element, m.
    pub penetration: f64,
    pub energy_error: f64,
    pub mode_changes: usize,
}

impl ChatterScene {
    pub fn run(&self) -> Result<ChatterResult> {
        let soil = Soil::new(1900.0 * self.shear_speed.powi(2), 0.33, 1900.0)?;
        let half = 0.5 * BLOCK_WIDTH;
        let law = Coulomb::new(self.friction)?.with_unilateral_condition(self.activation)?;
        let builder = Simulation::builder(self.time_step)
            .ground(ElasticGround::new(soil, Strip::uniform(-half..half, self.elements)?)?)
            .interface(law)
            .motion(el_centro_1940().scaled(2.0)?)
            .gravity(STANDARD_GRAVITY);
        let builder = match self.scheme {
            ChatterScheme::Midpoint => builder.scheme(Midpoint),
            ChatterScheme::Theta(theta) => builder.scheme(Theta::new(theta)?),
            ChatterScheme::Dissipative(gamma) => builder.scheme(DissipativeMidpoint::new(gamma)?),
        };
        let builder = self.with_structure(builder)?;
        let simulation = builder.build()?;
        self.march(simulation)
    }

    /// Adds the rigid or the flexible block, with the acceleration of its top as a probe.
    fn with_structure(&self, builder: SimulationBuilder) -> Result<SimulationBuilder> {
        let half = 0.5 * BLOCK_WIDTH;
        Ok(match self.young {
            None => {
                let block = RigidBlock::new(BLOCK_WIDTH, self.height, BLOCK_DENSITY)?;
                let top = block.horizontal_at(self.height);
                builder.structure(block).probe(Probe::acceleration("top", top))
            }
            Some(young) => {
                let material = Material::new(young, 0.2, BLOCK_DENSITY)?;
                let rows = self.elements;
                let layers = [Layer::new(self.height, rows, material)];
                let mesh = Mesh::layered_block(-half..half, self.elements, &layers)?;
                let model = FemModel::on_base(mesh)?;
                let top = model
                    .row(model.mesh().nearest_node(0.0, self.height).unwrap(), Direction::X)?;
                builder.structure(model).probe(Probe::acceleration("top", top))
            }
        })
    }

    fn march(&self, mut simulation: Simulation) -> Result<ChatterResult> {
        let weight = BLOCK_WIDTH * self.height * BLOCK_DENSITY * STANDARD_GRAVITY;
        let mut force_ratios = Vec::new();
        let mut acceleration_ratios = Vec::new();
        let mut penetration = 0.0_f64;
        let mut max_input = 0.0_f64;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive")]
        let step_count = (self.duration / self.time_step).round() as usize;
        let run = simulation.run(step_count, |state| {
            force_ratios.push(state.normal_force / weight);
            acceleration_ratios.push(state.probes[0] / STANDARD_GRAVITY);
            max_input = max_input.max(state.energy_balance.input.abs());
            for contact in &state.contact {
                penetration = penetration.max(-contact.gap);
            }
        })?;
        let force_above = high_pass(&force_ratios, self.time_step);
        Ok(ChatterResult {
            alternating: alternating(&force_ratios),
            acceleration_above: root_mean_square(&high_pass(&acceleration_ratios, self.time_step)),
            acceleration_alternating: alternating(&acceleration_ratios),
            shear: run.whole.base_shear.magnitude() / weight,
            rms_above: root_mean_square(&force_above),
            peak_above: force_above.iter().fold(0.0, |m, f| m.max(f.abs())),
            peak_slip: run.whole.largest_slip.largest().value.abs(),
            residual_slip: run.whole.residual_slip,
            uplift: run.whole.uplifted_fraction.largest().value,
            rotation: run.whole.base_rotation.magnitude(),
            contact_energy: run.energy_balance.contact / max_input,
            algorithmic_energy: run.energy_balance.algorithmic / max_input,
            penetration,
            energy_error: run.energy_error,
            mode_changes: run.mode_changes,
        })
    }
}

fn root_mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|x| x * x).sum::<f64>() / values.len() as f64).sqrt()
}

/// Root mean square of the part of a signal that alternates from step to step.
fn alternating(values: &[f64]) -> f64 {
    let components: Vec<f64> =
        values.windows(3).map(|x| 0.25 * (x[0] + x[2]) - 0.5 * x[1]).collect();
    root_mean_square(&components)
}

/// Content of a signal above [`CUTOFF_FREQUENCY`].
///
/// A fourth-order Butterworth high-pass filter runs forwards and backwards, and so adds no phase shift.
fn high_pass(signal: &[f64], time_step: f64) -> Vec<f64> {
    let mut filtered_signal: Vec<f64> = signal.iter().map(|s| s - signal[0]).collect();
    for _ in 0..2 {
        for damping in [0.923_879_532_511_286_7, 0.382_683_432_365_089_8] {
            second_order_section(&mut filtered_signal, damping, time_step);
        }
        filtered_signal.reverse();
    }
    filtered_signal
}

/// One section s²/(s² + 2ζωs + ω²), by the bilinear transform with the same cut-off.
fn second_order_section(signal: &mut [f64], damping: f64, time_step: f64) {
    let k = (std::f64::consts::PI * CUTOFF_FREQUENCY * time_step).tan();
    let norm = 1.0 + 2.0 * damping * k + k * k;
    let a1 = 2.0 * (k * k - 1.0) / norm;
    let a2 = (1.0 - 2.0 * damping * k + k * k) / norm;
    // Input and output one and two samples before.
    let mut x1 = 0.0;
    let mut x2 = 0.0;
    let mut y1 = 0.0;
    let mut y2 = 0.0;
    for x in signal {
        let y = (*x - 2.0 * x1 + x2) / norm - a1 * y1 - a2 * y2;
        (x2, x1, y2, y1) = (x1, *x, y1, y);
        *x = y;
    }
}
