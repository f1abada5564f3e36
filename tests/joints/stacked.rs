//! Two stacked blocks that slide on the ground and on each other, beside Newmark's sliding blocks.

use basemat::bem::SpringGround;
use basemat::coupled::{Joint, Theta};
use basemat::interface::Coulomb;
use basemat::motion::{Record, STANDARD_GRAVITY, el_centro_1940};
use basemat::structure::{RigidBlock, StructureGroup};
use basemat::{Result, Simulation};

const BLOCK_MASSES: [f64; 2] = [24.0e3, 9.6e3];
const FRICTION_COEFFICIENTS: [f64; 2] = [0.2, 0.12];
const RUN_DURATION: f64 = 15.0;

/// Sliding interfaces of two rigid blocks, each sticking or sliding in one sense.
///
/// Integrated event by event: a step ends where a relative velocity vanishes.
struct SlidingBlocks {
    /// Velocities relative to the ground, m/s.
    velocities: [f64; 2],
    /// Slips of the lower block on the ground and of the upper block on the lower one, m.
    slips: [f64; 2],
}

impl SlidingBlocks {
    /// Accelerations of both blocks relative to a ground of this acceleration.
    fn accelerations(&self, ground: f64) -> [f64; 2] {
        let lower_mass = BLOCK_MASSES[0];
        let upper_mass = BLOCK_MASSES[1];
        let total_weight = STANDARD_GRAVITY * (lower_mass + upper_mass);
        let limits = [
            FRICTION_COEFFICIENTS[0] * total_weight,
            FRICTION_COEFFICIENTS[1] * upper_mass * STANDARD_GRAVITY,
        ];
        let relative_velocities = [self.velocities[0], self.velocities[1] - self.velocities[0]];
        let sense = |velocity: f64| if velocity == 0.0 { None } else { Some(velocity.signum()) };
        let forces = |base_force: f64, upper_force: f64| {
            [(base_force - upper_force) / lower_mass - ground, upper_force / upper_mass - ground]
        };
        match relative_velocities.map(sense) {
            [Some(base), Some(upper)] => forces(-base * limits[0], -upper * limits[1]),
            [Some(base), None] => {
                let common = -base * limits[0] / (lower_mass + upper_mass);
                let needed = upper_mass * common;
                if needed.abs() <= limits[1] {
                    [common - ground; 2]
                } else {
                    forces(-base * limits[0], needed.signum() * limits[1])
                }
            }
            [None, Some(upper)] => {
                let upper_force = -upper * limits[1];
                let needed = lower_mass * ground + upper_force;
                if needed.abs() <= limits[0] {
                    forces(needed, upper_force)
                } else {
                    forces(needed.signum() * limits[0], upper_force)
                }
            }
            [None, None] => {
                let needed = (lower_mass + upper_mass) * ground;
                let upper_needed = upper_mass * ground;
                match (needed.abs() <= limits[0], upper_needed.abs() <= limits[1]) {
                    (true, true) => [0.0; 2],
                    (true, false) => {
                        let upper_force = upper_needed.signum() * limits[1];
                        let base_force = lower_mass * ground + upper_force;
                        forces(base_force.clamp(-limits[0], limits[0]), upper_force)
                    }
                    (false, _) => {
                        let base_force = needed.signum() * limits[0];
                        let common = base_force / (lower_mass + upper_mass);
                        if (upper_mass * common).abs() <= limits[1] {
                            [common - ground; 2]
                        } else {
                            forces(base_force, common.signum() * limits[1])
                        }
                    }
                }
            }
        }
    }

    /// Advances by `duration` under a constant ground acceleration, from event to event.
    fn advance(&mut self, mut duration: f64, ground: f64) {
        while duration > 0.0 {
            let accelerations = self.accelerations(ground);
            let relative_velocities = [self.velocities[0], self.velocities[1] - self.velocities[0]];
            let rates = [accelerations[0], accelerations[1] - accelerations[0]];
            // Time until the first relative velocity vanishes.
            let mut step = duration;
            let mut stopping = None;
            for k in 0..2 {
                let time = -relative_velocities[k] / rates[k];
                if relative_velocities[k] != 0.0 && time > 0.0 && time <= step {
                    step = time;
                    stopping = Some(k);
                }
            }
            for k in 0..2 {
                self.slips[k] += relative_velocities[k] * step + 0.5 * rates[k] * step * step;
            }
            for (velocity, acceleration) in self.velocities.iter_mut().zip(accelerations) {
                *velocity += acceleration * step;
            }
            match stopping {
                Some(0) => self.velocities[0] = 0.0,
                Some(_) => self.velocities[1] = self.velocities[0],
                None => {}
            }
            // A block that sticks has exactly the velocity of the block or ground under it.
            if relative_velocities[0] == 0.0 && rates[0] == 0.0 {
                self.velocities[0] = 0.0;
            }
            if relative_velocities[1] == 0.0 && rates[1] == 0.0 {
                self.velocities[1] = self.velocities[0];
            }
            duration -= step;
        }
    }
}

/// Slips of both interfaces at the end of each simulation step.
fn expected_slips(record: &Record, step: f64, steps: usize) -> Vec<[f64; 2]> {
    const SUBSTEP_COUNT: usize = 20;
    let mut blocks = SlidingBlocks { velocities: [0.0; 2], slips: [0.0; 2] };
    let mut slips = Vec::with_capacity(steps);
    for k in 0..steps {
        for substep in 0..SUBSTEP_COUNT {
            let fraction = (substep as f64 + 0.5) / SUBSTEP_COUNT as f64;
            let ground = record.at((k as f64 + fraction) * step).acceleration;
            blocks.advance(step / SUBSTEP_COUNT as f64, ground);
        }
        slips.push(blocks.slips);
    }
    slips
}

/// REFERENCE: two rigid blocks with friction (Newmark 1965), event by event.
#[test]
fn stacked_blocks_slide_on_both_interfaces() -> Result<()> {
    let step = 5e-4;
    let record = el_centro_1940().scaled(2.5)?;
    let lower = RigidBlock::new(10.0, 1.0, BLOCK_MASSES[0] / 10.0)?;
    let upper = RigidBlock::new(8.0, 0.5, BLOCK_MASSES[1] / 4.0)?;
    let top = lower.contact_nodes(&[[-4.0, 1.0], [4.0, 1.0]])?;
    let bottom = upper.contact_nodes(&[[-4.0, 0.0], [4.0, 0.0]])?;
    let group = StructureGroup::new().with(lower, 0.0)?.with_above(upper, [0.0, 1.0])?;
    let upper_nodes = group.contact_nodes(1, bottom)?;
    let joint = Joint::between(upper_nodes, group.contact_nodes(0, top)?, 4)?;
    let mut simulation = Simulation::builder(step)
        .ground(SpringGround::under(&group, 4, 1e14, 1e14)?)
        .structure(group)
        .interface(Coulomb::new(FRICTION_COEFFICIENTS[0])?)
        .joint(joint.with_law(Coulomb::new(FRICTION_COEFFICIENTS[1])?))
        .motion(record.clone())
        .scheme(Theta::new(1.0)?)
        .build()?;
    let steps = simulation.steps_for(RUN_DURATION);
    let expected = expected_slips(&record, step, steps);
    let mut computed = Vec::with_capacity(steps);
    let run = simulation.run(steps, |state| {
        computed.push([state.mean_slip, state.joints[0].mean_slip]);
    })?;
    assert!(run.energy_error < 1e-9, "{}", run.energy_error);
    for k in 0..2 {
        let peak = expected.iter().fold(0.0, |peak: f64, slips| peak.max(slips[k].abs()));
        let pairs = expected.iter().zip(&computed);
        let difference = pairs.fold(0.0, |max: f64, (a, b)| max.max((a[k] - b[k]).abs()));
        println!("interface {k}: peak {peak:e} m, difference {:e}", difference / peak);
        assert!(peak > 0.02 && difference < 0.01 * peak, "{difference:e} of {peak:e}");
    }
    Ok(())
}
