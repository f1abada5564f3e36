//! Blocks that lift off and slide in all directions on elastic ground.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use basemat::bem::ElasticGround;
use basemat::bem::layered::Stages;
use basemat::interface::Coulomb;
use basemat::motion::FreeField;
use basemat::structure::RigidBody;
use basemat::{Simulation, Soil};

const GRAVITY: f64 = 1e-3;

/// Ricker's wavelet (1 − 2u) e^−u, u = (π f (t − t₀))².
fn ricker(frequency: f64, middle: f64, time: f64) -> f64 {
    let u = (PI * frequency * (time - middle)).powi(2);
    (1.0 - 2.0 * u) * (-u).exp()
}

/// Amplitude of a wavelet whose acceleration is so many g.
fn amplitude(share: f64, frequency: f64) -> f64 {
    share * GRAVITY / (6.0 * (PI * frequency).powi(2))
}

/// The table's motion. It begins with a jump, since the surface is at rest at t = 0.
struct Shake;

impl FreeField for Shake {
    fn displacement(&self, _: f64, _: f64) -> [f64; 2] {
        unreachable!("a ground in plan asks for three directions")
    }

    fn displacement_at(&self, _: [f64; 2], time: f64) -> [f64; 3] {
        if time == 0.0 {
            return [0.0; 3];
        }
        let x = amplitude(1.5, 0.06) * ricker(0.06, 14.0, time);
        let y = amplitude(1.05 / 0.8_f64.powi(2), 0.06) * ricker(0.048, 17.0, time);
        let down = amplitude(0.45 / 1.7_f64.powi(2), 0.06) * ricker(0.102, 13.0, time);
        // The table's y points towards the reader, its z down.
        [x, -y, -down]
    }
}

/// Ricker's wavelet along a direction (x, y).
struct Along([f64; 2]);

impl FreeField for Along {
    fn displacement(&self, _: f64, _: f64) -> [f64; 2] {
        unreachable!("a ground in plan asks for three directions")
    }

    fn displacement_at(&self, _: [f64; 2], time: f64) -> [f64; 3] {
        let motion = amplitude(1.8, 0.06) * ricker(0.06, 14.0, time);
        [self.0[0] * motion, self.0[1] * motion, 0.0]
    }
}

/// A block of 2 × 2 × 4 on a homogeneous half-space.
fn block(cells: usize, motion: impl FreeField + 'static) -> Simulation {
    let body = RigidBody::cuboid([2.0, 2.0, 4.0], 1.0).unwrap();
    let soil = Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap();
    let ground = ElasticGround::under(soil, &body, cells).unwrap().with_stages(Stages::Two);
    Simulation::builder(0.1)
        .structure(body)
        .ground(ground)
        .interface(Coulomb::new(0.5).unwrap())
        .motion(motion)
        .gravity(GRAVITY)
        .expected_steps(300)
        .build()
        .unwrap()
}

/// `uplift_biaxial.csv`, written by another program: down, x, y, rotations, open part, work on the soil, friction work.
#[test]
fn a_block_that_lifts_and_slides_follows_the_table() {
    let table = include_str!("../data/plan/uplift_biaxial.csv");
    let numbers = |line: &str| line.split(',').map(|number| number.parse().unwrap()).collect();
    let rows: Vec<Vec<f64>> = table.lines().skip(1).map(numbers).collect();
    assert_eq!(rows.len(), 300);
    for (cells, gates) in [
        (16, [1e-5; 8]),
        (8, [2e-2, 1e-2, 1e-2, 1e-2, 1e-2, 2e-2, 3e-2, 1e-2]),
    ] {
        let mut simulation = block(cells, Shake);
        let (mut errors, mut sizes) = ([0.0; 8], [0.0; 8]);
        let (mut row, mut iterations) = (rows.iter(), 0);
        let mut worst = 0.0_f64;
        let run = simulation.run(300, |state| {
            let u = state.absolute_displacement();
            let energy = &state.energy_balance;
            let found =
                [-u[2], u[0], -u[1], u[3], -u[4], -u[5], state.uplifted_fraction, energy.soil];
            let wanted = &row.next().unwrap()[1..];
            for k in 0..8 {
                errors[k] += (found[k] - wanted[k]).powi(2);
                sizes[k] += wanted[k].powi(2);
            }
            iterations += state.trials;
            worst = worst.max(energy.residual());
        });
        let run = run.unwrap();
        let errors: [f64; 8] = std::array::from_fn(|k| f64::sqrt(errors[k] / sizes[k]));
        println!("{cells}: {errors:?}, {iterations} iterations, {:?}", run.fallbacks);
        assert!(worst < 1e-9, "{worst:e}");
        for (error, gate) in errors.iter().zip(gates) {
            assert!(*error < gate, "{cells}: {errors:?}");
        }
    }
}

/// A square scene shaken along a diagonal, and along the other.
#[test]
fn diagonals_are_alike() {
    let march = |direction: [f64; 2]| {
        let mut simulation = block(8, Along(direction));
        let mut all: Vec<[f64; 6]> = Vec::new();
        let run = simulation.run(300, |state| {
            all.push(state.absolute_displacement().try_into().unwrap());
        });
        assert!(run.unwrap().energy_error < 1e-9);
        all
    };
    let one = march([FRAC_1_SQRT_2; 2]);
    let other = march([-FRAC_1_SQRT_2, FRAC_1_SQRT_2]);
    let along = march([1.0, 0.0]);
    let largest = |all: &[[f64; 6]], k: usize| all.iter().fold(0.0_f64, |m, u| m.max(u[k].abs()));
    let size = largest(&along, 0);
    assert!(largest(&along, 4) > 0.1 * size, "it rocks");
    for (u, v) in one.iter().zip(&other) {
        let turned = [-u[1], u[0], u[2], -u[4], u[3], u[5]];
        for (a, b) in turned.iter().zip(v) {
            assert!((a - b).abs() < 1e-10 * size, "{turned:?} {v:?}");
        }
        // The diagonal is an axis of symmetry.
        assert!((u[0] - u[1]).abs() < 1e-10 * size && (u[3] + u[4]).abs() < 1e-10 * size);
    }
    for (k, name) in [(1, "y"), (3, "roll"), (5, "twist")] {
        let across = largest(&along, k);
        assert!(across < 1e-12 * size, "{name}: {across:e} of {size:e}");
    }
}
