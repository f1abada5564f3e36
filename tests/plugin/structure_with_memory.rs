//! GOAL: a structure of one's own that yields: internal variables, checkpoints, a limit of its own.
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

const MASS: f64 = 2.0e4;
/// First stiffness (N/m), yield force (N), and the share of the stiffness that stays.
const STIFFNESS: f64 = 1.2e6;
const STRENGTH: f64 = 1.0e4;
const HARDENING: f64 = 0.1;
const YIELD: f64 = STRENGTH / STIFFNESS;

/// Degrees of freedom: slab to the right, up and turning, mass to the right.
const DRIFT: [(usize, f64); 2] = [(3, 1.0), (0, -1.0)];

/// Bouc and Wen's law with n = 1, A = 1, β = γ = ½: dz/dd = 1 − |z| while loading, 1 while
/// unloading, over the yield displacement.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Isolator {
    /// Drift (m) and z of the last committed step.
    drift: f64,
    z: f64,
    /// Drift (m) at which the plate ends.
    plate: f64,
}

impl Isolator {
    /// z and dz/dd on the way straight from the committed drift, in closed form.
    fn led_to(&self, drift: f64) -> [f64; 2] {
        let sign = if drift < self.drift { -1.0 } else { 1.0 };
        let (way, begin) = ((drift - self.drift).abs() / YIELD, sign * self.z);
        if way <= -begin {
            return [sign * (begin + way), 1.0 / YIELD];
        }
        let [way, begin] = [way - (-begin).max(0.0), begin.max(0.0)];
        let rest = (1.0 - begin) * (-way).exp();
        [sign * (1.0 - rest), rest / YIELD]
    }
}

fn drift(u: &[f64]) -> f64 {
    u[3] - u[0]
}

impl Structure for Isolator {
    fn dofs(&self) -> usize {
        4
    }

    fn base(&self) -> Base {
        BaseNode::rigid_base(-2.0, 2.0, [0, 1, 2]).into()
    }

    fn mass(&self, matrix: &mut Triplets) -> Result<()> {
        for (unknown, mass) in [1.0e4, 3.0e4, 4.0e4, MASS].into_iter().enumerate() {
            matrix.add(unknown, unknown, mass);
        }
        Ok(())
    }

    fn stiffness(&self, matrix: &mut Triplets) -> Result<()> {
        matrix.add_outer(DRIFT, HARDENING * STIFFNESS);
        Ok(())
    }

    own_force!();
}

impl NonlinearForce for Isolator {
    fn force(&self, u: &[f64], force: &mut [f64]) -> Result<()> {
        if drift(u).abs() > self.plate {
            let plate = self.plate;
            return Err(Error::part(
                "isolator",
                format!("{:.4} m is off its plate of {plate} m", drift(u)),
            ));
        }
        let [z, _] = self.led_to(drift(u));
        for (unknown, weight) in DRIFT {
            force[unknown] += weight * (1.0 - HARDENING) * STRENGTH * z;
        }
        Ok(())
    }

    fn tangent(&self, u: &[f64], matrix: &mut Triplets) -> Result<()> {
        let [_, slope] = self.led_to(drift(u));
        matrix.add_outer(DRIFT, (1.0 - HARDENING) * STRENGTH * slope);
        Ok(())
    }

    fn commit(&mut self, u: &[f64]) {
        let [z, _] = self.led_to(drift(u));
        *self = Self { drift: drift(u), z, ..*self };
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

fn on_rock(plate: f64, time_step: f64) -> Simulation {
    Simulation::builder(time_step)
        .structure(Isolator { plate, ..Isolator::default() })
        .ground(SpringGround::new(-2.0..2.0, 2, 1e13, 1e13).unwrap())
        .interface(Bonded)
        .motion(el_centro_1940())
        .probe(Probe::displacement("drift", DRIFT))
        .build()
        .unwrap()
}

fn isolator(simulation: &Simulation) -> Isolator {
    let structure: &dyn Any = simulation.structure();
    *structure.downcast_ref().unwrap()
}

/// Drift at multiples of `every` steps of `h`: m d̈ = −m a_g − α k d − (1 − α) F_y z, the rate of z by
/// Heun's rule.
fn by_central_differences(record: &Record, h: f64, every: usize, count: usize) -> Vec<f64> {
    let rate = |z: f64, v: f64| (1.0 - if z * v > 0.0 { z.abs() } else { 0.0 }) / YIELD;
    let (mut d, mut v, mut z, mut drifts) = (0.0, 0.0, 0.0, Vec::new());
    for step in 0..every * count {
        let force = HARDENING * STIFFNESS * d + (1.0 - HARDENING) * STRENGTH * z;
        let a = -record.at(step as f64 * h).acceleration - force / MASS;
        v += if step == 0 { 0.5 * h * a } else { h * a };
        let first = rate(z, v);
        z += 0.5 * h * v * (first + rate(z + h * v * first, v));
        d += h * v;
        if (step + 1) % every == 0 {
            drifts.push(d);
        }
    }
    drifts
}

#[test]
fn an_isolator_of_ones_own_follows_its_differential_equation() {
    // Every 0.02 s, for 8 s.
    let exact = by_central_differences(&el_centro_1940(), 2e-5, 1000, 400);
    let largest = exact.iter().fold(0.0_f64, |most, d| most.max(d.abs()));
    assert!(largest > 5.0 * YIELD, "it yields: {largest}");
    let errors = [2, 4, 8, 16, 32].map(|steps| {
        let mut simulation = on_rock(1.0, 0.02 / steps as f64);
        let mut error = 0.0_f64;
        let run = simulation.run(400 * steps, |state| {
            if state.step % steps == 0 {
                error = error.max((state.probes[0] - exact[state.step / steps - 1]).abs());
            }
        });
        assert!(run.unwrap().energy_error < 1e-9);
        error / largest
    });
    println!("peak drift {largest:.4} m, errors {errors:?}");
    assert!(errors[4] < 1e-5, "{errors:?}");
    // The mean order over four halvings; single ones wander with where in a step the motion turns.
    let order = (errors[0] / errors[4]).log2() / 4.0;
    assert!((order - 2.0).abs() < 0.3, "order {order}, {errors:?}");
}

#[test]
fn an_isolator_of_ones_own_resumes_to_the_last_bit() {
    let mut whole = on_rock(1.0, 0.005);
    whole.run(500, |_| {}).unwrap();
    let saved = whole.checkpoint().unwrap();
    let before = isolator(&whole);
    assert!(before.z != 0.0);
    whole.run(500, |_| {}).unwrap();
    let mut other = on_rock(1.0, 0.005);
    other.resume(&saved).unwrap();
    assert_eq!(isolator(&other), before);
    other.run(500, |_| {}).unwrap();
    assert_eq!(other.state(), whole.state());
    assert_eq!(isolator(&other), isolator(&whole));
}

/// The refused step leaves no trace: on a longer plate, the run goes on as if never stopped.
#[test]
fn an_isolator_off_its_plate_ends_the_step_with_its_own_reason() {
    let mut short = on_rock(0.03, 0.005);
    let error = short.run(4000, |_| {}).unwrap_err();
    let Error::Step { step, source, .. } = &error else { panic!("{error:?}") };
    let StepError::Part { source, .. } = source else { panic!("{error:?}") };
    assert!(matches!(&**source, Error::Part { part, .. } if part == "isolator"), "{error:?}");
    assert!(error.to_string().contains("is off its plate of 0.03 m"), "{error}");

    let accepted = short.state().step;
    assert_eq!(*step, accepted + 1);
    let mut long = on_rock(1.0, 0.005);
    long.run(accepted, |_| {}).unwrap();
    assert_eq!(short.state(), long.state());
    assert_eq!(Isolator { plate: 1.0, ..isolator(&short) }, isolator(&long));
    let mut resumed = on_rock(1.0, 0.005);
    resumed.resume(&short.checkpoint().unwrap()).unwrap();
    for simulation in [&mut resumed, &mut long] {
        simulation.run(500, |_| {}).unwrap();
    }
    assert_eq!(resumed.state(), long.state());
}
