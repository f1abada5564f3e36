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

const GRAVITY_ACCELERATION: f64 = 9.806_65;
const BLOCK_MASS: f64 = 1.0e5;
const PENDULUM_RADIUS: f64 = 2.0;
const FRICTION_COEFFICIENT: f64 = 0.05;
/// Vertical frequency of the block on the bearing, Hz.
const VERTICAL_FREQUENCY: f64 = 8.0;

fn vertical_stiffness() -> f64 {
    BLOCK_MASS * (TAU * VERTICAL_FREQUENCY).powi(2)
}

/// A base with six degrees of freedom, and a block with three above it.
struct IsolatedBlock;

impl Structure for IsolatedBlock {
    fn dofs(&self) -> usize {
        9
    }

    fn base(&self) -> Base {
        let corners = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]];
        Base::Faces(vec![BaseNode::rigid_face(&corners, [0.0; 2], [0, 1, 2, 3, 4, 5])])
    }

    fn mass(&self, matrix: &mut Triplets) -> basemat::Result<()> {
        (0..6).for_each(|dof| matrix.add(dof, dof, 1.0e4));
        (6..9).for_each(|dof| matrix.add(dof, dof, BLOCK_MASS));
        Ok(())
    }

    fn stiffness(&self, _: &mut Triplets) -> basemat::Result<()> {
        Ok(())
    }
}

fn isolated() -> WithSprings {
    let law = FrictionPendulum::new(
        BLOCK_MASS * GRAVITY_ACCELERATION,
        PENDULUM_RADIUS,
        FRICTION_COEFFICIENT,
    )
    .unwrap();
    let bearing = law.with_vertical_stiffness(vertical_stiffness()).unwrap();
    let rows = [0, 1, 2].map(|k| [(6 + k, 1.0), (k, -1.0)]);
    WithSprings::new(IsolatedBlock).pendulum(rows, bearing).unwrap()
}

fn spring_force(structure: &WithSprings, u: &[f64]) -> [f64; 9] {
    let mut force = [0.0; 9];
    structure.force(u, &mut force).unwrap();
    force
}

/// Force times the path from `start` to `end`, at this part of it.
fn work_rate(structure: &WithSprings, start: &[f64; 9], end: &[f64; 9], part: f64) -> f64 {
    let u: Vec<f64> = start.iter().zip(end).map(|(a, b)| a + part * (b - a)).collect();
    let force = spring_force(structure, &u);
    force.iter().zip(start.iter().zip(end)).map(|(f, (a, b))| f * (b - a)).sum()
}

/// Work along the straight path, by Simpson's rule on short pieces.
fn work_along(structure: &WithSprings, start: &[f64; 9], end: &[f64; 9]) -> f64 {
    let mut work = 0.0;
    for k in 0..2000 {
        let low = f64::from(k) / 2000.0;
        let high = f64::from(k + 1) / 2000.0;
        let rates =
            [low, 0.5 * (low + high), high].map(|part| work_rate(structure, start, end, part));
        work += (rates[0] + 4.0 * rates[1] + rates[2]) / 12_000.0;
    }
    work
}

/// The tangent is the central difference of the force.
fn assert_tangent(structure: &WithSprings, u: &[f64; 9]) {
    let mut tangent = Triplets::new(9);
    structure.tangent(u, &mut tangent).unwrap();
    for column in 6..9 {
        let [low, high] = [-1.0, 1.0].map(|sign| {
            let mut u = *u;
            u[column] += sign * 1e-9;
            spring_force(structure, &u)
        });
        for row in 0..9 {
            let computed: f64 =
                tangent.entries().iter().filter(|e| (e.0, e.1) == (row, column)).map(|e| e.2).sum();
            let difference = (high[row] - low[row]) / 2e-9;
            assert!((computed - difference).abs() < 1e-4 * vertical_stiffness());
        }
    }
}

/// Tangents are differences of forces and energies the work along a path; friction follows the last vertical force.
#[test]
fn tangents_and_energies_are_those_of_the_force() {
    let mut structure = isolated();
    let mut random = Random(7);
    let mut at = [0.0; 9];
    let mut before = structure.energy(&[0.0; 9]).unwrap();
    let sink = BLOCK_MASS * GRAVITY_ACCELERATION / vertical_stiffness();
    for _ in 0..200 {
        let mut next_displacement = at;
        for place in &mut next_displacement[6..8] {
            *place = 0.9 * *place + random.within(-0.03, 0.03);
        }
        next_displacement[8] = random.within(-2.0, 0.2) * sink;
        let work = work_along(&structure, &at, &next_displacement);
        let after = structure.energy(&next_displacement).unwrap();
        let energy_change = after.stored + after.dissipated - before.stored - before.dissipated;
        let scale = after.stored + before.stored + after.dissipated - before.dissipated;
        assert!((energy_change - work).abs() < 1e-5 * scale, "{energy_change} {work}");
        assert!(after.dissipated >= before.dissipated);
        assert_tangent(&structure, &next_displacement);
        // Friction that falls with the vertical force turns stored energy into heat.
        structure.commit(&next_displacement);
        let committed = structure.energy(&next_displacement).unwrap();
        assert!(committed.dissipated >= after.dissipated - 1e-9 * scale);
        let sum = committed.stored + committed.dissipated;
        let before_commit = after.stored + after.dissipated;
        assert!((sum - before_commit).abs() < 1e-9 * scale, "{sum} {before_commit}");
        let saved_variables = structure.save().unwrap();
        let mut other = isolated();
        other.restore(&saved_variables).unwrap();
        assert_eq!(other.energy(&next_displacement), structure.energy(&next_displacement));
        at = next_displacement;
        before = committed;
    }
    let mut saved_variables = structure.save().unwrap();
    for limit in [-1.0, f64::NAN] {
        *saved_variables.last_mut().unwrap() = limit;
        assert!(structure.restore(&saved_variables).is_err());
    }
    assert!(structure.restore(&[]).is_err());
    let law = FrictionPendulum::new(1.0, 1.0, 0.1).unwrap();
    assert!(law.with_vertical_stiffness(0.0).is_err());
}

const MOTION_DURATION: f64 = 12.0;

fn upwards(time: f64) -> f64 {
    0.3 * GRAVITY_ACCELERATION * (TAU * time).sin() * (0.5 * time).min(1.0)
}

/// Largest displacement and range of the vertical force over the weight, by short steps; without `rises` for a bearing
/// under its weight at rest.
fn reference(rises: bool, ground: impl Fn(f64) -> f64) -> [f64; 3] {
    let step = 2e-5;
    let mut u = 0.0_f64;
    let mut v = 0.0;
    let mut w = 0.0;
    let mut rate = 0.0;
    let mut slip = 0.0;
    let stiffness = (TAU * VERTICAL_FREQUENCY).powi(2);
    let yield_displacement = 0.5e-3;
    let mut max_magnitude = 0.0_f64;
    let mut range = [f64::INFINITY, 0.0_f64];
    for k in 0..600_000 {
        let time = step * f64::from(k);
        let force = GRAVITY_ACCELERATION + stiffness * (0.5 * u * u / PENDULUM_RADIUS - w);
        let force = if rises { force.max(0.0) } else { GRAVITY_ACCELERATION };
        let reach = yield_displacement * force / GRAVITY_ACCELERATION;
        slip = u - (u - slip).clamp(-reach, reach);
        let friction = FRICTION_COEFFICIENT * GRAVITY_ACCELERATION * (u - slip) / yield_displacement;
        v -= step * (force * u / PENDULUM_RADIUS + friction + ground(time));
        u += step * v;
        rate += step * (force - GRAVITY_ACCELERATION - upwards(time));
        w += step * rate;
        max_magnitude = max_magnitude.max(u.abs());
        range = [range[0].min(force), range[1].max(force)];
    }
    [max_magnitude, range[0] / GRAVITY_ACCELERATION, range[1] / GRAVITY_ACCELERATION]
}

/// The vertical motion makes the weight vary by a third, and the block slide 11 % further.
#[test]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small and > 0")]
fn a_block_slides_under_a_varying_weight() {
    let record = el_centro_1940().scaled(1.5).unwrap();
    let samples = (record.duration() / record.time_step()).round() as usize;
    let ground = |time: f64| {
        let place = time / record.time_step();
        let k = (place as usize).min(samples - 1);
        let low = record.accelerations()[k];
        let high = record.accelerations()[k + 1];
        low + (place - k as f64) * (high - low)
    };
    let expected = reference(true, ground);
    let fixed = reference(false, ground);
    let up = Record::from_fn(0.01, MOTION_DURATION + 1.0, upwards).unwrap();
    let plan = Plan::rectangle(-2.0..2.0, -2.0..2.0, 2).unwrap();
    let mut simulation = Simulation::builder(2.5e-3)
        .structure(isolated())
        .ground(SpringGround::in_plan(plan, [1.0e10; 3]).unwrap())
        .interface(Bonded)
        .motion(Triaxial { x: Some(record.clone()), y: None, up: Some(up) })
        .build()
        .unwrap();
    let rest = simulation.static_displacement().to_vec();
    assert!(
        (rest[8] - rest[2] + BLOCK_MASS * GRAVITY_ACCELERATION / vertical_stiffness()).abs() < 1e-9
    );
    let law = FrictionPendulum::new(
        BLOCK_MASS * GRAVITY_ACCELERATION,
        PENDULUM_RADIUS,
        FRICTION_COEFFICIENT,
    )
    .unwrap();
    let law = law.with_vertical_stiffness(vertical_stiffness()).unwrap();
    let mut max_magnitude = 0.0_f64;
    let mut range = [f64::INFINITY, 0.0_f64];
    let run = simulation
        .run((MOTION_DURATION / 2.5e-3) as usize, |state| {
            let u = state.displacement();
            let deformation = [0, 1, 2].map(|k| u[6 + k] + rest[6 + k] - u[k] - rest[k]);
            let weight = BLOCK_MASS * GRAVITY_ACCELERATION;
            let force = law.vertical_force(deformation) / weight;
            max_magnitude = max_magnitude.max(deformation[0].abs());
            range = [range[0].min(force), range[1].max(force)];
        })
        .unwrap();
    println!("{max_magnitude} {range:?} {expected:?} {fixed:?} {}", run.energy_error);
    assert!((max_magnitude / expected[0] - 1.0).abs() < 0.005 && (fixed[0] / expected[0] - 1.0).abs() > 0.08);
    assert!((range[0] - expected[1]).abs() < 0.01 && (range[1] - expected[2]).abs() < 0.01);
    assert!(run.energy_error < 1e-9, "{}", run.energy_error);
    let energies = run.energy_balance;
    let algorithmic = energies.algorithmic.abs() / energies.hysteresis;
    assert!(algorithmic < 1e-3, "{algorithmic}");
}
