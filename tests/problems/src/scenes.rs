//! Scenes in which a base slides, uplifts or stays bonded.

use basemat::bem::{ElasticGround, Grading, Strip};
use basemat::coupled::{SimulationBuilder, State};
use basemat::fem::{Layer, Material, Mesh};
use basemat::interface::Coulomb;
use basemat::motion::FreeFieldFn;
use basemat::results::{Recorder, Run, TimeSeries};
use basemat::structure::{
    FemModel, NonlinearForce, RayleighDamping, RigidBlock, Structure, Triplets,
};
use basemat::{Simulation, Soil};

/// Units of length, time and mass, and whether left and right are exchanged.
#[derive(Debug, Clone, Copy)]
pub struct UnitFrame {
    pub length: f64,
    pub time: f64,
    pub mass: f64,
    pub mirrored: bool,
}

pub const SI_UNITS: UnitFrame = UnitFrame { length: 1.0, time: 1.0, mass: 1.0, mirrored: false };

impl UnitFrame {
    pub fn sign(&self) -> f64 {
        if self.mirrored { -1.0 } else { 1.0 }
    }

    /// Unit of pressure.
    pub fn pressure(&self) -> f64 {
        self.mass / (self.length * self.time * self.time)
    }

    pub fn density(&self) -> f64 {
        self.mass / self.length.powi(3)
    }

    pub fn acceleration(&self) -> f64 {
        self.length / (self.time * self.time)
    }
}

/// Two pulses of ground motion, horizontal and (smaller) vertical: m at `strength` = 1.
pub fn shake(frame: UnitFrame, strength: f64) -> FreeFieldFn {
    let horizontal_unit = frame.sign() * strength * frame.length;
    let vertical_unit = strength * frame.length;
    // No law here uses the velocity.
    FreeFieldFn::new(move |_, time| {
        let t = time / frame.time;
        let horizontal = 0.12 * pulse(t, 0.4, 0.13) + 0.05 * pulse(t, 0.75, 0.08);
        let vertical = 0.02 * pulse(t, 0.5, 0.07);
        [horizontal_unit * horizontal, vertical_unit * vertical]
    })
}

/// Ricker's wavelet, (1 − 2a²) e^−a².
fn ricker(time: f64, middle: f64, width: f64) -> f64 {
    let a = (time - middle) / width;
    (1.0 - 2.0 * a * a) * (-a * a).exp()
}

/// The wavelet that begins at zero.
fn pulse(time: f64, middle: f64, width: f64) -> f64 {
    ricker(time, middle, width) - ricker(0.0, middle, width)
}

pub fn soil(frame: UnitFrame) -> Soil {
    Soil::new(6e7 * frame.pressure(), 0.3, 1900.0 * frame.density()).unwrap()
}

pub fn ground(frame: UnitFrame, elements: usize, grading: Grading) -> ElasticGround {
    let half = 2.0 * frame.length;
    let strip = Strip::new(-half..half, elements, grading).unwrap();
    ElasticGround::new(soil(frame), strip).unwrap()
}

pub fn block(frame: UnitFrame) -> RigidBlock {
    RigidBlock::new(4.0 * frame.length, 6.0 * frame.length, 1500.0 * frame.density()).unwrap()
}

/// Flexible tower of 6 × 6 elements on the base of [`block`].
pub fn tower(frame: UnitFrame, damping: Option<RayleighDamping>) -> FemModel {
    let material = Material::new(2e8 * frame.pressure(), 0.2, 1500.0 * frame.density()).unwrap();
    let layers = [Layer::new(6.0 * frame.length, 6, material)];
    let half = 2.0 * frame.length;
    let mesh = Mesh::layered_block(-half..half, 6, &layers).unwrap();
    let model = FemModel::on_base(mesh).unwrap();
    match damping {
        Some(damping) => model.with_rayleigh(damping),
        None => model,
    }
}

pub const TIME_STEP: f64 = 2.5e-3;
pub const SCENE_GRAVITY: f64 = 9.81;

/// The builder of a run with weight, without structure and law.
pub fn scene(frame: UnitFrame, strength: f64) -> SimulationBuilder {
    Simulation::builder(TIME_STEP * frame.time)
        .ground(ground(frame, 8, Grading::Cosine))
        .motion(shake(frame, strength))
        .gravity(SCENE_GRAVITY * frame.acceleration())
}

pub fn friction(coefficient: f64) -> Coulomb {
    Coulomb::new(coefficient).unwrap()
}

/// All states of a run, the static one first.
pub fn states(simulation: &mut Simulation, steps: usize) -> Vec<State> {
    let mut states = vec![simulation.state().clone()];
    for _ in 0..steps {
        states.push(simulation.step().unwrap().clone());
    }
    states
}

/// Largest difference of a quantity over two runs, relative to its largest expected value.
pub fn apart<'a>(
    expected: &'a [State],
    computed: &'a [State],
    quantity: impl Fn(&'a State) -> Vec<f64>,
) -> f64 {
    let mut max_value = f64::MIN_POSITIVE;
    let mut max_difference = 0.0_f64;
    for (expected, computed) in expected.iter().zip(computed) {
        for (a, b) in quantity(expected).into_iter().zip(quantity(computed)) {
            max_value = max_value.max(a.abs());
            max_difference = max_difference.max((a - b).abs());
        }
    }
    max_difference / max_value
}

/// A run with its time series.
pub struct RecordedRun {
    pub time_series: TimeSeries,
    pub run: Run,
    /// The state before the run, and that of each step.
    pub states: Vec<State>,
}

/// Records a run of `steps` steps.
pub fn record_run(simulation: &mut Simulation, recorder: Recorder, steps: usize) -> RecordedRun {
    let mut time_series = recorder.start(simulation).unwrap();
    let mut states = vec![simulation.state().clone()];
    let run = simulation.run(steps, |state| {
        time_series.record(state).unwrap();
        states.push(state.clone());
    });
    RecordedRun { time_series, run: run.unwrap(), states }
}

/// Time series, run and states of [`record_run`] as separate results.
pub fn recorded(
    simulation: &mut Simulation,
    recorder: Recorder,
    steps: usize,
) -> (TimeSeries, Run, Vec<State>) {
    let RecordedRun { time_series, run, states } = record_run(simulation, recorder, steps);
    (time_series, run, states)
}

/// A rigid block with a body on its top, on a spring that hardens and dissipates nothing.
///
/// The force is k s³ of the body's displacement s relative to the top.
#[derive(Debug)]
pub struct Rider {
    pub block: RigidBlock,
}

impl Structure for Rider {
    fn dofs(&self) -> usize {
        4
    }

    fn base(&self) -> basemat::structure::Base {
        self.block.base()
    }

    fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        let mut block_mass = Triplets::new(3);
        self.block.mass(&mut block_mass)?;
        for &(i, j, value) in block_mass.entries() {
            matrix.add(i, j, value);
        }
        matrix.add(3, 3, 4000.0);
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        matrix.add_outer([(0, -1.0), (2, 6.0), (3, 1.0)], 1e6);
        Ok(())
    }

    crate::own_force!();
}

impl NonlinearForce for Rider {
    fn force(&self, u: &[f64], force: &mut [f64]) -> basemat::Result<()> {
        let stretch = u[3] - u[0] + 6.0 * u[2];
        let pull = 1e9 * stretch.powi(3);
        force[3] += pull;
        force[0] -= pull;
        force[2] += 6.0 * pull;
        Ok(())
    }

    fn tangent(&self, u: &[f64], matrix: &mut Triplets) -> basemat::Result<()> {
        let stretch = u[3] - u[0] + 6.0 * u[2];
        matrix.add_outer([(0, -1.0), (2, 6.0), (3, 1.0)], 3e9 * stretch * stretch);
        Ok(())
    }

    /// The spring is elastic and has nothing to save.
    fn save(&self) -> basemat::Result<Vec<f64>> {
        Ok(Vec::new())
    }
}
