//! The test in space: an actuator turns a rigid wall on its footing slowly through packets of cycles.
//!
//! | symbol | meaning |
//! |---|---|
//! | u_a | displacement of the actuator, h above the base |
//! | θ | rotation of the footing that the actuator reaches |
//! | u | displacement of the footing along x at the end of the step before |
//!
//! The actuator is a mass that a stiff spring joins to the wall. The mass is so large that only the force on it moves it.
//! Before each step this force is set so that u_a = h θ + u at the end of the step, by the midpoint rule. A support in
//! place of the mass is not possible, since a structure of this crate rests on the soil alone. Steps are so long that
//! inertia and waves have no effect. P–Δ is left out: at a prescribed rotation it changes the shear, and the moment on
//! the soil only through the shear.

use std::time::Duration;

use basemat::Simulation;
use basemat::bem::ElasticGround;
use basemat::bem::plan::Plan;
use basemat::coupled::Load;
use basemat::interface::InterfaceLaw;
use basemat::motion::STANDARD_GRAVITY;
use basemat::soil::Soil;
use basemat::structure::{MatrixModel, RigidBody, Structure, Triplets};

use super::{
    ACTUATOR_HEIGHT, CYCLES_PER_PACKET, FOOTING_SIDES, FootingRow, GRAVITY_CENTER_HEIGHT,
    RockingPacket, SAND_DENSITY, VERTICAL_FORCE,
};

/// Degrees of freedom: u_x, u_z, r_x and r_y of the body, and the displacement of the actuator.
const ALONG_DOF: usize = 0;
const UP_DOF: usize = 2;
const TILT_ACROSS_DOF: usize = 3;
const TURN_DOF: usize = 4;
const ACTUATOR_DOF: usize = 6;
const DOF_COUNT: usize = 7;

/// Mass of the actuator, kg.
const ACTUATOR_MASS: f64 = 1e13;
/// Stiffness of the actuator's spring, N/m: a force of 60 kN stretches it by 0.6 µm.
const ACTUATOR_STIFFNESS: f64 = 1e11;
/// Stiffness of the guides against tilting across the load, N·m. A single row of cells does not resist this tilt.
const GUIDE_STIFFNESS: f64 = 1e9;
/// Time step, s. A cycle of 200 steps takes a minute, in which waves cross the footing 3000 times.
const TIME_STEP: f64 = 0.3;

/// The test, with the numbers of cells and steps of its computation.
#[derive(Debug, Clone)]
pub struct SlowRockingTest {
    /// G of the half-space, Pa.
    pub shear_modulus: f64,
    /// ν of the half-space.
    pub poisson: f64,
    /// Cells along the load and across it.
    pub cells: [usize; 2],
    /// Steps of a cycle, a multiple of 4.
    pub steps_per_cycle: usize,
    /// s.
    pub time_step: f64,
    /// Names of the packets and amplitudes of their rotation, rad.
    pub packets: Vec<(String, f64)>,
}

/// Results of the test.
#[derive(Debug)]
pub struct SlowRockingRun {
    /// Rows of each packet, from the state at rest on.
    pub packets: Vec<RockingPacket>,
    /// Largest violation of the energy balance, relative to the energy of the actuator.
    pub energy_error: f64,
    pub steps: usize,
    pub wall: Duration,
}

impl SlowRockingTest {
    /// The test with the amplitudes of some packets, on 16 strips of a half-space of G = 30 MPa and ν = 0.35.
    pub fn with_amplitudes(packets: &[RockingPacket]) -> Self {
        let packets =
            packets.iter().map(|packet| (packet.name.clone(), packet.rotation_amplitude()));
        Self {
            shear_modulus: 30.0e6,
            poisson: 0.35,
            cells: [16, 1],
            steps_per_cycle: 200,
            time_step: TIME_STEP,
            packets: packets.collect(),
        }
    }

    /// Turns the footing on an interface law through all packets.
    pub fn run(&self, law: impl InterfaceLaw + 'static) -> basemat::Result<SlowRockingRun> {
        let time_step = self.time_step;
        let mut simulation = Simulation::builder(time_step)
            .structure(wall(time_step)?)
            .ground(self.ground()?)
            .interface(law)
            .load(Load::constant(vec![(ACTUATOR_DOF, 1.0)], 0.0))
            .expected_steps(self.packets.len() * CYCLES_PER_PACKET * self.steps_per_cycle)
            .build()?;
        let mut run = simulation.begin_run();
        let mut packets = Vec::new();
        let mut row = FootingRow::default();
        for (name, amplitude) in &self.packets {
            let mut rows = vec![row];
            for step in 1..=CYCLES_PER_PACKET * self.steps_per_cycle {
                let phase = std::f64::consts::TAU * step as f64 / self.steps_per_cycle as f64;
                // The measured cycles begin to the left.
                let rotation = -amplitude * phase.sin();
                let state = simulation.state();
                let target = ACTUATOR_HEIGHT * rotation + state.displacement()[ALONG_DOF];
                let distance = target - state.displacement()[ACTUATOR_DOF];
                let speed = state.velocity()[ACTUATOR_DOF];
                let acceleration = 2.0 * (distance / time_step - speed) / time_step;
                simulation.set_load(0, ACTUATOR_MASS * acceleration)?;
                let state = simulation.step()?;
                run.record(state);
                let displacement = state.displacement();
                row = FootingRow {
                    shear: state.base_shear / VERTICAL_FORCE,
                    moment: 2.0 * state.base_moment / (VERTICAL_FORCE * FOOTING_SIDES[0]),
                    settlement: -displacement[UP_DOF] / FOOTING_SIDES[0],
                    sliding: displacement[ALONG_DOF] / FOOTING_SIDES[0],
                    rotation: displacement[TURN_DOF],
                };
                rows.push(row);
            }
            packets.push(RockingPacket { name: name.clone(), rows });
        }
        let run = simulation.end_run(run);
        let energy_error = run.energy_error;
        Ok(SlowRockingRun { packets, energy_error, steps: run.steps, wall: run.wall })
    }

    fn ground(&self) -> basemat::Result<ElasticGround> {
        let soil = Soil::new(self.shear_modulus, self.poisson, SAND_DENSITY)?;
        let [along, across] = self.cells;
        let pitch = [FOOTING_SIDES[0] / along as f64, FOOTING_SIDES[1] / across as f64];
        let corner = FOOTING_SIDES.map(|side| -0.5 * side);
        let plan = Plan::masked(corner, pitch, along, &vec![true; along * across])?;
        ElasticGround::in_plan(soil, plan)
    }
}

/// The wall on its footing, and the actuator, for steps of this length, s.
fn wall(time_step: f64) -> basemat::Result<MatrixModel> {
    let [x, y] = FOOTING_SIDES.map(|side| 0.5 * side);
    let mass = VERTICAL_FORCE / STANDARD_GRAVITY;
    // Inertia has no effect; here it is that of a wall of twice the height of its centre of gravity.
    let tilt_inertia = mass * (2.0 * GRAVITY_CENTER_HEIGHT).powi(2) / 12.0;
    let inertia = [[tilt_inertia, 0.0, 0.0], [0.0, tilt_inertia, 0.0], [0.0, 0.0, mass]];
    let outline = vec![[-x, -y], [x, -y], [x, y], [-x, y]];
    let gravity_center = [0.0, 0.0, GRAVITY_CENTER_HEIGHT];
    let body = RigidBody::from_mass(outline, mass, inertia, gravity_center)?;
    let mut mass = Triplets::new(DOF_COUNT);
    body.mass(&mut mass)?;
    mass.add(ACTUATOR_DOF, ACTUATOR_DOF, ACTUATOR_MASS);
    let stroke = [(ALONG_DOF, 1.0), (TURN_DOF, ACTUATOR_HEIGHT), (ACTUATOR_DOF, -1.0)];
    let mut stiffness = Triplets::new(DOF_COUNT);
    stiffness.add_outer(stroke, ACTUATOR_STIFFNESS);
    stiffness.add(TILT_ACROSS_DOF, TILT_ACROSS_DOF, GUIDE_STIFFNESS);
    // With this dashpot the midpoint rule ends each step with the spring's force, without alternating about it.
    let mut damping = Triplets::new(DOF_COUNT);
    damping.add_outer(stroke, 0.5 * time_step * ACTUATOR_STIFFNESS);
    MatrixModel::new(mass, stiffness, body.base())?.with_damping(damping)
}
