//! Sliding in space against Newmark's block and on a ground that moves in a circle.

use std::f64::consts::PI;

use basemat::bem::ElasticGround;
use basemat::interface::Coulomb;
use basemat::motion::{FreeField, Record, STANDARD_GRAVITY, Triaxial, el_centro_1940};
use basemat::reference::SlidingBlock;
use basemat::structure::RigidBody;
use basemat::{Simulation, Soil};

use basemat_problems::series::{RelativeError, nearest_integer};
use basemat_problems::table;

/// A low block, 4 m square, on stiff soil, shaken along the direction (cos, sin) by El Centro.
fn newmark_block(friction: f64, direction: [f64; 2]) -> Simulation {
    let soil = Soil::from_wave_speeds(1600.0, 3200.0, 2000.0).unwrap();
    let body = RigidBody::cuboid([4.0, 4.0, 0.4], 2000.0).unwrap();
    Simulation::builder(0.0025)
        .ground(ElasticGround::under(soil, &body, 4).unwrap())
        .structure(body)
        .interface(Coulomb::new(friction).unwrap())
        .motion(Triaxial { x: component(direction[0]), y: component(direction[1]), up: None })
        .build()
        .unwrap()
}

/// El Centro times a factor; `None` for zero.
fn component(factor: f64) -> Option<Record> {
    (factor != 0.0).then(|| el_centro_1940().scaled(factor).unwrap())
}

/// GOAL: Newmark's sliding block (1965) in space, along x, along y and askew.
/// SCENE: low block, 4 m square, on stiff soil under El Centro; the record along the direction of motion is the table's.
/// REFERENCE: `reference::SlidingBlock`, event by event, and `sliding_rigid_block.csv`, as in the plane
/// (`tests/published/analytic.rs`).
#[test]
fn newmarks_block_slides_in_space() {
    let rows = table("sliding_rigid_block.csv").rows(["mu", "max_abs_slip_m", "slip_residual_m"]);
    let record = el_centro_1940();
    // The table itself is within 2e-6 m.
    for (friction, error_limit, peak_tolerance, residual_tolerance) in
        [(0.1, 2e-2, 8e-6, 4e-4), (0.2, 4e-3, 2.5e-6, 1.2e-5)]
    {
        let expected_slide = SlidingBlock::new(friction, STANDARD_GRAVITY).unwrap().slide(&record);
        let row = rows.iter().find(|row| row[0] == friction).unwrap();
        for (cos, sin, duration) in [(1.0, 0.0, 31.18), (0.0, 1.0, 7.0), (0.6, -0.8, 7.0)] {
            let mut simulation = newmark_block(friction, [cos, sin]);
            let mut error = RelativeError::default();
            let mut peak_along = 0.0_f64;
            let mut peak_across = 0.0_f64;
            let run = simulation
                .run(nearest_integer(duration / 0.0025), |state| {
                    let foundation = &state.foundations[0];
                    let x = foundation.mean_slip;
                    let y = foundation.mean_slip_across;
                    let along = cos * x + sin * y;
                    let across = cos * y - sin * x;
                    error.add(along, expected_slide.slip(state.time));
                    peak_along = peak_along.max(along.abs());
                    peak_across = peak_across.max(across.abs());
                })
                .unwrap();
            let residual = cos * run.whole.residual_slip + sin * run.whole.residual_slip_across;
            let peak_error = (peak_along - row[1]).abs();
            let residual_error = (residual - row[2]).abs();
            println!(
                "{friction} {cos}: {:.1e} {peak_error} {residual_error} {peak_across:.1e}",
                error.relative()
            );
            assert!(error.relative() < error_limit, "{}", error.relative());
            assert!(peak_across < 2e-9, "{peak_across}");
            assert!(peak_error < peak_tolerance, "{peak_error}");
            // Shorter runs end before the block comes to rest.
            assert!(duration < 10.0 || residual_error < residual_tolerance, "{residual_error}");
            assert!(run.energy_error < 1e-9);
        }
    }
}

/// Displacement of a ground that moves in a circle.
struct CircularMotion {
    radius: f64,
    frequency: f64,
}

impl FreeField for CircularMotion {
    fn displacement(&self, _: f64, _: f64) -> [f64; 2] {
        unreachable!("a ground in space needs three directions")
    }

    fn displacement_at(&self, _: [f64; 2], time: f64) -> [f64; 3] {
        let angle = self.frequency * time;
        [self.radius * angle.cos(), self.radius * angle.sin(), 0.0]
    }
}

/// A block slides in a circle: its acceleration is that of friction, at right angles to the rest of the ground's
/// (relative speed √(A² − (φ g)²)/ω).
#[test]
fn a_block_on_a_ground_that_moves_in_a_circle_slides_in_a_circle() {
    let friction = 0.3;
    let gravity = 1e-3;
    let frequency = 0.1;
    let acceleration = 2.0 * friction * gravity;
    let body = RigidBody::cuboid([2.0, 2.0, 0.1], 1.0).unwrap();
    let soil = Soil::new(1.0, 1.0 / 3.0, 1.0).unwrap();
    let time_step = 2.0 * PI / frequency / 200.0;
    let mut simulation = Simulation::builder(time_step)
        .ground(ElasticGround::under(soil, &body, 4).unwrap())
        .structure(body)
        .interface(Coulomb::new(friction).unwrap())
        .motion(CircularMotion { radius: acceleration / (frequency * frequency), frequency })
        .gravity(gravity)
        .build()
        .unwrap();
    let run = simulation.run(800, |_| {}).unwrap();
    assert!(run.energy_error < 1e-9);
    let expected_speed = (acceleration.powi(2) - (friction * gravity).powi(2)).sqrt() / frequency;
    for _ in 0..200 {
        let start = simulation.state().contact.clone();
        let state = simulation.step().unwrap();
        for (end, start) in state.contact.iter().zip(start) {
            let slip = (end.slip - start.slip).hypot(end.slip_across - start.slip_across);
            let ratio = slip / time_step / expected_speed;
            assert!((ratio - 1.0).abs() < 5e-3, "{ratio}");
        }
    }
}
