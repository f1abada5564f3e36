//! GOAL: a friction pendulum whose weight is the vertical force on it.
//! SCENE: random paths; a block on one bearing on stiff ground, under El Centro and a vertical motion of 1 Hz.
//! REFERENCE: differences, energies; the block's equations integrated with short steps.

use std::f64::consts::TAU;

use basemat::Simulation;
use basemat::bem::SpringGround;
use basemat::bem::plan::Plan;
use basemat::interface::Bonded;
use basemat::motion::{Record, Triaxial, el_centro_1940};
use basemat::structure::{
    Base, BaseNode, FrictionPendulum, NonlinearForce, Structure, Triplets, WithSprings,
};
use basemat_problems::random::Random;

const GRAVITY: f64 = 9.806_65;
const MASS: f64 = 1.0e5;
const RADIUS: f64 = 2.0;
const FRICTION: f64 = 0.05;
/// Vertical frequency of the block on the bearing, Hz.
const FREQUENCY: f64 = 8.0;

fn vertical_stiffness() -> f64 {
    MASS * (TAU * FREQUENCY).powi(2)
}

/// A base with six degrees of freedom, and a block with three above it.
struct Block;

impl Structure for Block {
    fn dofs(&self) -> usize {
        9
    }

    fn base(&self) -> Base {
        let corners = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]];
        Base::Faces(vec![BaseNode::rigid_face(&corners, [0.0; 2], [0, 1, 2, 3, 4, 5])])
    }

    fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        (0..6).for_each(|dof| matrix.add(dof, dof, 1.0e4));
        (6..9).for_each(|dof| matrix.add(dof, dof, MASS));
        Ok(())
    }

    fn stiffness(&self, _: &mut Triplets) -> basemat::Result<()> {
        Ok(())
    }
}

fn isolated() -> WithSprings {
    let law = FrictionPendulum::new(MASS * GRAVITY, RADIUS, FRICTION).unwrap();
    let bearing = law.with_vertical_stiffness(vertical_stiffness()).unwrap();
    let rows = [0, 1, 2].map(|k| [(6 + k, 1.0), (k, -1.0)]);
    WithSprings::new(Block).pendulum(rows, bearing).unwrap()
}

/// Forces are symmetric slopes; energies are the work along a path, and friction follows the force before.
#[test]
fn slopes_and_energies() {
    let mut own = isolated();
    let mut random = Random(7);
    let (mut at, mut before) = ([0.0; 9], own.energy(&[0.0; 9]).unwrap());
    let sink = MASS * GRAVITY / vertical_stiffness();
    for _ in 0..200 {
        let mut next = at;
        for place in &mut next[6..8] {
            *place = 0.9 * *place + random.within(-0.03, 0.03);
        }
        next[8] = random.within(-2.0, 0.2) * sink;
        // Work along the straight path, by Simpson's rule on short pieces.
        let mut work = 0.0;
        let force = |s: f64| -> f64 {
            let u: Vec<f64> = at.iter().zip(&next).map(|(a, b)| a + s * (b - a)).collect();
            let mut force = [0.0; 9];
            own.force(&u, &mut force).unwrap();
            force.iter().zip(at.iter().zip(&next)).map(|(f, (a, b))| f * (b - a)).sum()
        };
        for k in 0..2000 {
            let [low, high] = [k, k + 1].map(|k| f64::from(k) / 2000.0);
            work += (force(low) + 4.0 * force(0.5 * (low + high)) + force(high)) / 12_000.0;
        }
        let after = own.energy(&next).unwrap();
        let gained = after.stored + after.dissipated - before.stored - before.dissipated;
        let scale = after.stored + before.stored + after.dissipated - before.dissipated;
        assert!((gained - work).abs() < 1e-5 * scale, "{gained} {work}");
        assert!(after.dissipated >= before.dissipated);
        let mut tangent = Triplets::new(9);
        own.tangent(&next, &mut tangent).unwrap();
        for column in 6..9 {
            let slope = |sign: f64| {
                let (mut u, mut force) = (next, [0.0; 9]);
                u[column] += sign * 1e-9;
                own.force(&u, &mut force).unwrap();
                force
            };
            let [low, high] = [slope(-1.0), slope(1.0)];
            for row in 0..9 {
                let found: f64 = tangent
                    .entries()
                    .iter()
                    .filter(|e| (e.0, e.1) == (row, column))
                    .map(|e| e.2)
                    .sum();
                let difference = (high[row] - low[row]) / 2e-9;
                assert!((found - difference).abs() < 1e-4 * vertical_stiffness());
            }
        }
        // Friction that falls with the vertical force turns stored energy into heat.
        own.commit(&next);
        let committed = own.energy(&next).unwrap();
        assert!(committed.dissipated >= after.dissipated - 1e-9 * scale);
        let [sum, was] = [committed, after].map(|own| own.stored + own.dissipated);
        assert!((sum - was).abs() < 1e-9 * scale, "{sum} {was}");
        let saved = own.save().unwrap();
        let mut other = isolated();
        other.restore(&saved).unwrap();
        assert_eq!(other.energy(&next), own.energy(&next));
        (at, before) = (next, committed);
    }
    let mut saved = own.save().unwrap();
    for limit in [-1.0, f64::NAN] {
        *saved.last_mut().unwrap() = limit;
        assert!(own.restore(&saved).is_err());
    }
    assert!(own.restore(&[]).is_err());
    let law = FrictionPendulum::new(1.0, 1.0, 0.1).unwrap();
    assert!(law.with_vertical_stiffness(0.0).is_err());
}

const DURATION: f64 = 12.0;

fn upwards(time: f64) -> f64 {
    0.3 * GRAVITY * (TAU * time).sin() * (0.5 * time).min(1.0)
}

/// Largest displacement and range of the vertical force over the weight, by short steps; `climbs` is false for a bearing
/// under its weight at rest.
fn reference(climbs: bool, ground: impl Fn(f64) -> f64) -> [f64; 3] {
    let step = 2e-5;
    let (mut u, mut v, mut w, mut rate, mut slip) = (0.0_f64, 0.0, 0.0, 0.0, 0.0);
    let (stiffness, yielding) = ((TAU * FREQUENCY).powi(2), 0.5e-3);
    let (mut most, mut range) = (0.0_f64, [f64::INFINITY, 0.0_f64]);
    for k in 0..600_000 {
        let time = step * f64::from(k);
        let force = GRAVITY + stiffness * (0.5 * u * u / RADIUS - w);
        let force = if climbs { force.max(0.0) } else { GRAVITY };
        let reach = yielding * force / GRAVITY;
        slip = u - (u - slip).clamp(-reach, reach);
        let friction = FRICTION * GRAVITY * (u - slip) / yielding;
        v -= step * (force * u / RADIUS + friction + ground(time));
        u += step * v;
        rate += step * (force - GRAVITY - upwards(time));
        w += step * rate;
        most = most.max(u.abs());
        range = [range[0].min(force), range[1].max(force)];
    }
    [most, range[0] / GRAVITY, range[1] / GRAVITY]
}

/// The vertical motion makes the weight vary by a third, and the block slide 11 % further.
#[test]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small and > 0")]
fn a_block_slides_under_a_varying_weight() {
    let record = el_centro_1940().scaled(1.5).unwrap();
    let samples = (record.duration() / record.time_step()).round() as usize;
    let at = |time: f64| {
        let place = time / record.time_step();
        let k = (place as usize).min(samples - 1);
        let [low, high] = [k, k + 1].map(|k| record.accelerations()[k]);
        low + (place - k as f64) * (high - low)
    };
    let exact = reference(true, at);
    let fixed = reference(false, at);
    let up = Record::from_fn(0.01, DURATION + 1.0, upwards).unwrap();
    let plan = Plan::rectangle(-2.0..2.0, -2.0..2.0, 2).unwrap();
    let mut simulation = Simulation::builder(2.5e-3)
        .structure(isolated())
        .ground(SpringGround::in_plan(plan, [1.0e10; 3]).unwrap())
        .interface(Bonded)
        .motion(Triaxial { x: Some(record.clone()), y: None, up: Some(up) })
        .build()
        .unwrap();
    let rest = simulation.static_displacement().to_vec();
    assert!((rest[8] - rest[2] + MASS * GRAVITY / vertical_stiffness()).abs() < 1e-9);
    let law = FrictionPendulum::new(MASS * GRAVITY, RADIUS, FRICTION).unwrap();
    let law = law.with_vertical_stiffness(vertical_stiffness()).unwrap();
    let (mut most, mut range) = (0.0_f64, [f64::INFINITY, 0.0_f64]);
    let run = simulation
        .run((DURATION / 2.5e-3) as usize, |state| {
            let u = state.displacement();
            let own = [0, 1, 2].map(|k| u[6 + k] + rest[6 + k] - u[k] - rest[k]);
            let force = law.vertical_force(own) / (MASS * GRAVITY);
            most = most.max(own[0].abs());
            range = [range[0].min(force), range[1].max(force)];
        })
        .unwrap();
    println!("{most} {range:?} {exact:?} {fixed:?} {}", run.energy_error);
    assert!((most / exact[0] - 1.0).abs() < 0.005 && (fixed[0] / exact[0] - 1.0).abs() > 0.08);
    assert!((range[0] - exact[1]).abs() < 0.01 && (range[1] - exact[2]).abs() < 0.01);
    assert!(run.energy_error < 1e-9, "{}", run.energy_error);
    let energies = run.energy_balance;
    let algorithmic = energies.algorithmic.abs() / energies.hysteresis;
    assert!(algorithmic < 1e-3, "{algorithmic}");
}
