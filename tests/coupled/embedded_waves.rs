//! GOAL: waves act on all faces of a structure in a trench.
//! SCENE: a block bonded to springs around a trench under shear and pressure waves.
//! REFERENCE: the block's equations of motion under standing waves, by Runge and Kutta's method.

use basemat::Simulation;
use basemat::bem::ContactElement;
use basemat::interface::Bonded;
use basemat::motion::{Record, VerticalIncidence};

use super::trench_springs::{
    BLOCK_HEIGHT, SOIL_DENSITY, TRENCH_DEPTH, TRENCH_WIDTH, TrenchSprings, soil, trench_elements,
    trench_motion, walled_block,
};

/// Displacement and velocity of the surface at any time.
fn pulse(time: f64) -> [f64; 2] {
    let x = 6.0 * (time - 1.2);
    let square = x * x;
    let bell = (-x * x).exp();
    [0.05 * (1.0 - 2.0 * square) * bell, 0.05 * 6.0 * x * (4.0 * square - 6.0) * bell]
}

/// Acceleration of the surface, by a central difference of its velocity.
fn pulse_acceleration(time: f64) -> f64 {
    let interval = 1e-4;
    (pulse(time + interval)[1] - pulse(time - interval)[1]) / (2.0 * interval)
}

/// Standing wave u = [a(t + z/c) + a(t − z/c)]/2 at a depth of the half-plane.
struct StandingWave {
    /// Displacement and velocity.
    motion: [f64; 2],
    /// Stress ∫ρ a dz.
    stress: f64,
}

fn standing_wave(speed: f64, depth: f64, time: f64) -> StandingWave {
    let upgoing_wave = pulse(time + depth / speed);
    let downgoing_wave = pulse(time - depth / speed);
    StandingWave {
        motion: [0, 1].map(|k| 0.5 * (upgoing_wave[k] + downgoing_wave[k])),
        stress: 0.5 * SOIL_DENSITY * speed * (upgoing_wave[1] - downgoing_wave[1]),
    }
}

/// The free field averaged over an element.
#[derive(Default)]
struct MeanFreeField {
    displacement: [f64; 2],
    velocity: [f64; 2],
    /// Tractions on the soil.
    traction: [f64; 2],
}

/// Outer point of Gauss's rule with three points.
const OUTER_GAUSS_POINT: f64 = 0.774_596_669_241_483_4;

fn mean_free_field(element: &ContactElement, time: f64) -> MeanFreeField {
    let half_length = 0.5 * element.length();
    let z = element.center()[2];
    let normal = element.directions()[0];
    let tangent = element.directions()[1];
    let mut mean = MeanFreeField::default();
    for (place, weight) in
        [(-OUTER_GAUSS_POINT, 5.0 / 18.0), (0.0, 8.0 / 18.0), (OUTER_GAUSS_POINT, 5.0 / 18.0)]
    {
        let depth = -(z + tangent[2] * half_length * place);
        let shear_wave = standing_wave(soil().shear_wave_speed(), depth, time);
        let pressure_wave = standing_wave(soil().pressure_wave_speed(), depth, time);
        let lateral_stress = 0.3 / 0.7 * pressure_wave.stress;
        let traction = if normal[2] < -0.5 {
            [-shear_wave.stress, -pressure_wave.stress]
        } else {
            [normal[0] * lateral_stress, tangent[2] * shear_wave.stress]
        };
        for (k, wave) in [shear_wave, pressure_wave].iter().enumerate() {
            mean.displacement[k] += weight * wave.motion[0];
            mean.velocity[k] += weight * wave.motion[1];
            mean.traction[k] += weight * traction[k];
        }
    }
    mean
}

/// Equations of motion of a block bonded to springs and dashpots, about its centre of gravity.
///
/// Motions are to the right, up and the rotation.
struct BondedBlock {
    elements: Vec<ContactElement>,
    stiffness: f64,
    dashpots: f64,
}

/// Height of the centre of gravity above the base, m.
const CENTER_HEIGHT: f64 = 0.5 * BLOCK_HEIGHT;

impl BondedBlock {
    fn acceleration(&self, displacement: [f64; 3], velocity: [f64; 3], time: f64) -> [f64; 3] {
        let mass = 900.0 * TRENCH_WIDTH * BLOCK_HEIGHT;
        let inertia = mass * (TRENCH_WIDTH * TRENCH_WIDTH + BLOCK_HEIGHT * BLOCK_HEIGHT) / 12.0;
        let mut force = [0.0; 3];
        for element in &self.elements {
            let free_field = mean_free_field(element, time);
            // The middle of the element, from the centre of gravity.
            let center = element.center();
            let arm = [center[0], center[2] + TRENCH_DEPTH - CENTER_HEIGHT];
            let element_displacement = motion_at(displacement, arm);
            let element_velocity = motion_at(velocity, arm);
            for k in 0..2 {
                let reaction = self.stiffness
                    * (element_displacement[k] - free_field.displacement[k])
                    + self.dashpots * (element_velocity[k] - free_field.velocity[k]);
                let on_block = -element.length() * (free_field.traction[k] + reaction);
                force[k] += on_block;
                force[2] += [-arm[1], arm[0]][k] * on_block;
            }
        }
        [force[0] / mass, force[1] / mass, force[2] / inertia]
    }

    /// Motions of the middle of the base by Runge and Kutta's method: to the right, up and the rotation.
    fn base_motion(&self, step: f64, count: u32) -> Vec<[f64; 3]> {
        let mut displacement = [0.0; 3];
        let mut velocity = [0.0; 3];
        let mut base_motion = vec![];
        for n in 0..count {
            let time = f64::from(n) * step;
            let rate = |previous: Rate, interval: f64| {
                let velocity = add_scaled(velocity, previous.velocity, interval);
                let displacement = add_scaled(displacement, previous.displacement, interval);
                let velocity_rate = self.acceleration(displacement, velocity, time + interval);
                Rate { displacement: velocity, velocity: velocity_rate }
            };
            let first = Rate {
                displacement: velocity,
                velocity: self.acceleration(displacement, velocity, time),
            };
            let second = rate(first, 0.5 * step);
            let third = rate(second, 0.5 * step);
            let fourth = rate(third, step);
            for (rate, weight) in [(first, 1.0), (second, 2.0), (third, 2.0), (fourth, 1.0)] {
                displacement = add_scaled(displacement, rate.displacement, step * weight / 6.0);
                velocity = add_scaled(velocity, rate.velocity, step * weight / 6.0);
            }
            let base_sway = displacement[0] + CENTER_HEIGHT * displacement[2];
            base_motion.push([base_sway, displacement[1], displacement[2]]);
        }
        base_motion
    }
}

/// Rates of the displacement and of the velocity.
#[derive(Clone, Copy)]
struct Rate {
    displacement: [f64; 3],
    velocity: [f64; 3],
}

/// Motion of a point of the block with this arm from the centre of gravity.
fn motion_at(motion: [f64; 3], arm: [f64; 2]) -> [f64; 2] {
    [motion[0] - arm[1] * motion[2], motion[1] + arm[0] * motion[2]]
}

fn add_scaled(a: [f64; 3], b: [f64; 3], factor: f64) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] + factor * b[k])
}

/// A block bonded to all faces moves under shear and pressure waves as by its equations of motion.
#[test]
fn waves_act_on_all_faces_as_in_an_independent_integration() {
    let stiffness = 4e7;
    let dashpots = 8e5;
    let step = 0.0025;
    let elements = trench_elements().elements();
    let reference = BondedBlock { elements, stiffness, dashpots }.base_motion(step, 960);
    let record = Record::from_fn(0.005, 3.0, pulse_acceleration).unwrap();
    let motion = trench_motion(VerticalIncidence {
        horizontal: Some(record.clone()),
        vertical: Some(record),
    });
    let mut simulation = Simulation::builder(step)
        .structure(walled_block())
        .ground(TrenchSprings::new(&trench_elements(), stiffness, dashpots))
        .interface(Bonded)
        .motion(motion)
        .build()
        .unwrap();
    let mut max_values = [0.0_f64; 3];
    let mut difference = [0.0_f64; 3];
    for expected in &reference {
        let state = simulation.step().unwrap();
        let displacement = state.absolute_displacement();
        let computed = [displacement[0], displacement[1], state.base_rotation];
        for k in 0..3 {
            max_values[k] = max_values[k].max(expected[k].abs());
            difference[k] = difference[k].max((computed[k] - expected[k]).abs());
        }
    }
    for k in 0..3 {
        assert!(
            difference[k] < 0.003 * max_values[k],
            "{k}: {} of {}",
            difference[k],
            max_values[k]
        );
    }
    assert!(max_values[2] > 1e-3, "{max_values:?}");
}
