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
pub struct Frame {
    pub length: f64,
    pub time: f64,
    pub mass: f64,
    pub mirrored: bool,
}

pub const SI: Frame = Frame { length: 1.0, time: 1.0, mass: 1.0, mirrored: false };

impl Frame {
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
pub fn shake(frame: Frame, strength: f64) -> FreeFieldFn {
    let pulse = |t: f64, middle: f64, width: f64| {
        let a = (t - middle) / width;
        (1.0 - 2.0 * a * a) * (-a * a).exp()
    };
    let Frame { length, time, .. } = frame;
    let across = frame.sign() * strength * length;
    let at = move |t: f64| {
        let t = t / time;
        let start = |middle, width| pulse(t, middle, width) - pulse(0.0, middle, width);
        let horizontal = 0.12 * start(0.4, 0.13) + 0.05 * start(0.75, 0.08);
        let vertical = 0.02 * start(0.5, 0.07);
        [across * horizontal, strength * length * vertical]
    };
    // No law here uses the velocity.
    FreeFieldFn::new(move |_, t| at(t))
}

pub fn soil(frame: Frame) -> Soil {
    Soil::new(6e7 * frame.pressure(), 0.3, 1900.0 * frame.density()).unwrap()
}

pub fn ground(frame: Frame, elements: usize, grading: Grading) -> ElasticGround {
    let half = 2.0 * frame.length;
    let strip = Strip::new(-half..half, elements, grading).unwrap();
    ElasticGround::new(soil(frame), strip).unwrap()
}

pub fn block(frame: Frame) -> RigidBlock {
    RigidBlock::new(4.0 * frame.length, 6.0 * frame.length, 1500.0 * frame.density()).unwrap()
}

/// Flexible tower of 6 × 6 elements on the base of [`block`].
pub fn tower(frame: Frame, damping: Option<RayleighDamping>) -> FemModel {
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
pub const GRAVITY: f64 = 9.81;

/// The builder of a run with weight, everything but the structure and the law given.
pub fn scene(frame: Frame, strength: f64) -> SimulationBuilder {
    Simulation::builder(TIME_STEP * frame.time)
        .ground(ground(frame, 8, Grading::Cosine))
        .motion(shake(frame, strength))
        .gravity(GRAVITY * frame.acceleration())
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

/// Largest difference of a quantity over a run, relative to its largest value in the first.
pub fn apart<'a>(
    one: &'a [State],
    two: &'a [State],
    quantity: impl Fn(&'a State) -> Vec<f64>,
) -> f64 {
    let (mut scale, mut apart) = (f64::MIN_POSITIVE, 0.0_f64);
    for (a, b) in one.iter().zip(two) {
        for (a, b) in quantity(a).into_iter().zip(quantity(b)) {
            scale = scale.max(a.abs());
            apart = apart.max((a - b).abs());
        }
    }
    apart / scale
}

/// A run of so many steps: its time series, and its states with the one before.
pub fn recorded(
    simulation: &mut Simulation,
    recorder: Recorder,
    steps: usize,
) -> (TimeSeries, Run, Vec<State>) {
    let mut series = recorder.start(simulation).unwrap();
    let mut states = vec![simulation.state().clone()];
    let observe = |state: &State| {
        series.record(state).unwrap();
        states.push(state.clone());
    };
    let run = simulation.run(steps, observe).unwrap();
    (series, run, states)
}

/// A rigid block with a spring that hardens and loses energy in no way: f = k θ³ on the rotation
/// of a rider of the same inertia on the top.
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
        let mut own = Triplets::new(3);
        self.block.mass(&mut own)?;
        for &(i, j, value) in own.entries() {
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

    /// Elastic, without memory.
    fn save(&self) -> basemat::Result<Vec<f64>> {
        Ok(Vec::new())
    }
}
