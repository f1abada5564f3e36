//! Peaks of a free-standing pier, and how many of their digits are reliable.
//!
//! ```text
//! cargo run --release --example rocking_pier
//! ```
//!
//! A stone pier of 6 × 4 × 18 m on rock, with an eccentric centre of gravity, is shaken along both axes. It rocks on
//! its edges and corners, and twists on them. Such a motion is sensitive to small changes: with a time step that
//! differs by 1 %, or on fewer cells, some peaks have different values. The printed run warns of this, and
//! `sensitivity` finds the reliable digits of each peak.

use basemat::analyses::sensitivity;
use basemat::motion::Triaxial;
use basemat::prelude::*;
use basemat::structure::RigidBody;

// Sides of the pier along x, y and z, m.
const PIER_LENGTH: f64 = 6.0;
const PIER_WIDTH: f64 = 4.0;
const PIER_HEIGHT: f64 = 18.0;
/// Density of the masonry, kg/m³.
const MASS_DENSITY: f64 = 1900.0;
/// Position of the centre of gravity relative to the middle of the base, m.
const GRAVITY_CENTER: [f64; 3] = [0.4, 0.3, 9.0];

fn pier() -> basemat::Result<RigidBody> {
    let mass = MASS_DENSITY * PIER_LENGTH * PIER_WIDTH * PIER_HEIGHT;
    let inertia = [
        [cuboid_inertia(mass, PIER_WIDTH, PIER_HEIGHT), 0.0, 0.0],
        [0.0, cuboid_inertia(mass, PIER_LENGTH, PIER_HEIGHT), 0.0],
        [0.0, 0.0, cuboid_inertia(mass, PIER_LENGTH, PIER_WIDTH)],
    ];
    let x = 0.5 * PIER_LENGTH;
    let y = 0.5 * PIER_WIDTH;
    RigidBody::from_mass(vec![[-x, -y], [x, -y], [x, y], [-x, y]], mass, inertia, GRAVITY_CENTER)
}

/// Moment of inertia of a cuboid about the axis perpendicular to the sides `a` and `b`.
fn cuboid_inertia(mass: f64, a: f64, b: f64) -> f64 {
    mass * (a * a + b * b) / 12.0
}

fn shake(cells: usize, time_step: f64) -> basemat::Result<Run> {
    let pier = pier()?;
    let rock = Soil::from_shear_wave_speed(1000.0, 0.25, 2300.0)?;
    let along = el_centro_1940().scaled(2.0)?;
    let across = el_centro_1940().trimmed(0.9, 12.0)?.scaled(1.6)?;
    let mut simulation = Simulation::builder(time_step)
        .ground(ElasticGround::under(rock, &pier, cells)?)
        .structure(pier)
        .interface(Coulomb::new(0.7)?)
        .motion(Triaxial { x: Some(along), y: Some(across), up: None })
        .build()?;
    simulation.run(simulation.steps_for(12.0), |_| {})
}

fn main() -> basemat::Result<()> {
    let peaks = sensitivity(6, 0.005, |cells, time_step| {
        let run = shake(cells, time_step)?;
        let base = &run.whole;
        assert!(base.uplifted_fraction.highest.value > 0.5);
        assert!(run.to_string().contains("most of the base opens"));
        Ok(vec![
            ("weight, kN", 1e-3 * base.static_normal_force),
            ("horizontal force, kN", 1e-3 * base.horizontal_force.magnitude()),
            ("torque, kN·m", 1e-3 * base.torque.magnitude()),
            ("rotation, mrad", 1e3 * base.base_rotation.magnitude()),
            ("slip, mm", 1e3 * base.largest_slip.magnitude()),
        ])
    })?;
    println!("{peaks}");
    // All six digits of the weight are reliable, and at most the first digit of the torque.
    assert_eq!(peaks.peak("weight, kN")?.digits(), 6);
    assert!(peaks.peak("torque, kN·m")?.digits() <= 1);
    Ok(())
}
