//! GOAL: a structure of a user yields, with internal variables, checkpoints and a limit of its displacement.
//! SCENE: a mass on a Bouc–Wen isolator, its slab bonded to rock, under El Centro 1940.
//! REFERENCE: the differential equation by central differences in steps of 20 µs; the uninterrupted run.

use std::any::Any;

use basemat::bem::SpringGround;
use basemat::coupled::Probe;
use basemat::coupled::{CheckpointError, StepError};
use basemat::interface::Bonded;
use basemat::motion::{Record, el_centro_1940};
use basemat::structure::{Base, BaseNode, NonlinearForce, Structure, Triplets};
use basemat::{Error, Result, Simulation};

use basemat_problems::own_force;

/// Mass on the isolator, kg.
const ISOLATED_MASS: f64 = 2.0e4;
/// Initial stiffness of the isolator, N/m.
const INITIAL_STIFFNESS: f64 = 1.2e6;
/// Force at which the isolator yields, N.
const YIELD_FORCE: f64 = 1.0e4;
/// Stiffness after yield over the initial one.
const HARDENING_RATIO: f64 = 0.1;
const YIELD_DRIFT: f64 = YIELD_FORCE / INITIAL_STIFFNESS;

/// Weights of the drift; degrees of freedom are slab to the right, up and rotation, mass to the right.
const DRIFT_WEIGHTS: [(usize, f64); 2] = [(3, 1.0), (0, -1.0)];

/// A mass on an isolator by Bouc and Wen's law with n = 1, A = 1, β = γ = ½.
///
/// dz/dd is 1 − |z| while loading and 1 while unloading, over the yield drift.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct BoucWenIsolator {
    /// Drift of the last committed step, m.
    drift: f64,
    /// z of the last committed step.
    z: f64,
    /// Largest drift on the plate, m.
    plate_reach: f64,
}

/// Hysteretic variable z and its slope dz/dd.
struct HystereticState {
    z: f64,
    slope: f64,
}

impl BoucWenIsolator {
    /// z after monotonic motion from the committed drift, in closed form.
    fn state_at(&self, drift: f64) -> HystereticState {
        let sign = if drift < self.drift { -1.0 } else { 1.0 };
        let distance = (drift - self.drift).abs() / YIELD_DRIFT;
        let start = sign * self.z;
        if distance <= -start {
            return HystereticState { z: sign * (start + distance), slope: 1.0 / YIELD_DRIFT };
        }
        let loading_distance = distance - (-start).max(0.0);
        let complement = (1.0 - start.max(0.0)) * (-loading_distance).exp();
        HystereticState { z: sign * (1.0 - complement), slope: complement / YIELD_DRIFT }
    }
}

fn drift(u: &[f64]) -> f64 {
    u[3] - u[0]
}

impl Structure for BoucWenIsolator {
    fn dofs(&self) -> usize {
        4
    }

    fn base(&self) -> Base {
        BaseNode::rigid_base(-2.0, 2.0, [0, 1, 2]).into()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        for (dof, mass) in [1.0e4, 3.0e4, 4.0e4, ISOLATED_MASS].into_iter().enumerate() {
            matrix.add(dof, dof, mass);
        }
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        matrix.add_outer(DRIFT_WEIGHTS, HARDENING_RATIO * INITIAL_STIFFNESS);
        Ok(())
    }

    own_force!();
}

impl NonlinearForce for BoucWenIsolator {
    fn force(&self, u: &[f64], force: &mut [f64]) -> Result<()> {
        let drift = drift(u);
        let plate_reach = self.plate_reach;
        if drift.abs() > plate_reach {
            let reason = format!("{drift:.4} m is off its plate of {plate_reach} m");
            return Err(Error::part("isolator", reason));
        }
        let z = self.state_at(drift).z;
        for (dof, weight) in DRIFT_WEIGHTS {
            force[dof] += weight * (1.0 - HARDENING_RATIO) * YIELD_FORCE * z;
        }
        Ok(())
    }

    fn tangent(&self, u: &[f64], matrix: &mut Triplets) -> Result<()> {
        let slope = self.state_at(drift(u)).slope;
        matrix.add_outer(DRIFT_WEIGHTS, (1.0 - HARDENING_RATIO) * YIELD_FORCE * slope);
        Ok(())
    }

    fn commit(&mut self, u: &[f64]) {
        self.z = self.state_at(drift(u)).z;
        self.drift = drift(u);
    }

    fn save(&self) -> Result<Vec<f64>> {
        Ok(vec![self.drift, self.z])
    }

    fn restore(&mut self, values: &[f64]) -> Result<()> {
        match *values {
            [drift, z] if z.abs() <= 1.0 => *self = Self { drift, z, ..*self },
            _ => return Err(CheckpointError::Corrupt { quantity: "isolator" }.into()),
        }
        Ok(())
    }
}

/// The isolator on a plate of this reach on rock under El Centro.
fn isolator_on_rock(plate_reach: f64, time_step: f64) -> Simulation {
    Simulation::builder(time_step)
        .structure(BoucWenIsolator { plate_reach, ..BoucWenIsolator::default() })
        .ground(SpringGround::new(-2.0..2.0, 2, 1e13, 1e13).unwrap())
        .interface(Bonded)
        .motion(el_centro_1940())
        .probe(Probe::displacement("drift", DRIFT_WEIGHTS))
        .build()
        .unwrap()
}

/// The isolator in its present state.
fn isolator(simulation: &Simulation) -> BoucWenIsolator {
    let structure: &dyn Any = simulation.structure();
    *structure.downcast_ref().unwrap()
}

/// dz/dd at a velocity.
fn hysteretic_rate(z: f64, velocity: f64) -> f64 {
    (1.0 - if z * velocity > 0.0 { z.abs() } else { 0.0 }) / YIELD_DRIFT
}

/// Drifts at intervals of 20 ms by central differences, with z by Heun's rule.
///
/// They solve m d̈ = −m a_g − α k d − (1 − α) F_y z in steps of 20 µs.
fn drifts_by_central_differences(record: &Record, count: usize) -> Vec<f64> {
    let step = 2e-5;
    let steps_per_drift = 1000;
    let mut drift = 0.0;
    let mut velocity = 0.0;
    let mut z = 0.0;
    let mut drifts = Vec::new();
    for n in 0..steps_per_drift * count {
        let force =
            HARDENING_RATIO * INITIAL_STIFFNESS * drift + (1.0 - HARDENING_RATIO) * YIELD_FORCE * z;
        let acceleration = -record.at(n as f64 * step).acceleration - force / ISOLATED_MASS;
        velocity += if n == 0 { 0.5 * step * acceleration } else { step * acceleration };
        let first = hysteretic_rate(z, velocity);
        let second = hysteretic_rate(z + step * velocity * first, velocity);
        z += 0.5 * step * velocity * (first + second);
        drift += step * velocity;
        if (n + 1) % steps_per_drift == 0 {
            drifts.push(drift);
        }
    }
    drifts
}

#[test]
fn an_isolator_of_a_user_follows_its_differential_equation() {
    // The run lasts 8 s.
    let expected = drifts_by_central_differences(&el_centro_1940(), 400);
    let max_magnitude = expected.iter().fold(0.0_f64, |max, drift| max.max(drift.abs()));
    assert!(max_magnitude > 5.0 * YIELD_DRIFT, "it yields: {max_magnitude}");
    let errors = [2, 4, 8, 16, 32].map(|steps| {
        let mut simulation = isolator_on_rock(1.0, 0.02 / steps as f64);
        let mut error = 0.0_f64;
        let run = simulation.run(400 * steps, |state| {
            if state.step % steps == 0 {
                error = error.max((state.probes[0] - expected[state.step / steps - 1]).abs());
            }
        });
        assert!(run.unwrap().energy_error < 1e-9);
        error / max_magnitude
    });
    println!("peak drift {max_magnitude:.4} m, errors {errors:?}");
    assert!(errors[4] < 1e-5, "{errors:?}");
    // The mean order over four halvings: a single one depends on where in a step the motion reverses.
    let order = (errors[0] / errors[4]).log2() / 4.0;
    assert!((order - 2.0).abs() < 0.3, "order {order}, {errors:?}");
}

#[test]
fn an_isolator_of_a_user_resumes_to_the_last_bit() {
    let mut uninterrupted_simulation = isolator_on_rock(1.0, 0.005);
    uninterrupted_simulation.run(500, |_| {}).unwrap();
    let checkpoint = uninterrupted_simulation.checkpoint().unwrap();
    let saved_isolator = isolator(&uninterrupted_simulation);
    assert!(saved_isolator.z != 0.0);
    uninterrupted_simulation.run(500, |_| {}).unwrap();
    let mut resumed_simulation = isolator_on_rock(1.0, 0.005);
    resumed_simulation.resume(&checkpoint).unwrap();
    assert_eq!(isolator(&resumed_simulation), saved_isolator);
    resumed_simulation.run(500, |_| {}).unwrap();
    assert_eq!(resumed_simulation.state(), uninterrupted_simulation.state());
    assert_eq!(isolator(&resumed_simulation), isolator(&uninterrupted_simulation));
}

/// A step that returns an error changes nothing: on a larger plate the run continues to the same bits.
#[test]
fn an_isolator_off_its_plate_ends_the_step_with_its_reason() {
    let mut on_small_plate = isolator_on_rock(0.03, 0.005);
    let error = on_small_plate.run(4000, |_| {}).unwrap_err();
    let Error::Step { step, source, .. } = &error else { panic!("{error:?}") };
    let StepError::Part { source, .. } = source else { panic!("{error:?}") };
    assert!(matches!(&**source, Error::Part { part, .. } if part == "isolator"), "{error:?}");
    assert!(error.to_string().contains("is off its plate of 0.03 m"), "{error}");

    let accepted_steps = on_small_plate.state().step;
    assert_eq!(*step, accepted_steps + 1);
    let mut on_large_plate = isolator_on_rock(1.0, 0.005);
    on_large_plate.run(accepted_steps, |_| {}).unwrap();
    assert_eq!(on_small_plate.state(), on_large_plate.state());
    let moved_isolator = BoucWenIsolator { plate_reach: 1.0, ..isolator(&on_small_plate) };
    assert_eq!(moved_isolator, isolator(&on_large_plate));
    let mut resumed_simulation = isolator_on_rock(1.0, 0.005);
    resumed_simulation.resume(&on_small_plate.checkpoint().unwrap()).unwrap();
    for simulation in [&mut resumed_simulation, &mut on_large_plate] {
        simulation.run(500, |_| {}).unwrap();
    }
    assert_eq!(resumed_simulation.state(), on_large_plate.state());
}
