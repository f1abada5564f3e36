//! Digits of the peaks of a free-standing pier that hold.
//!
//! ```text
//! cargo run --release --example rocking_pier
//! ```
//!
//! A stone pier of 6 × 4 × 18 m on rock, its centre of gravity beside the middle, is shaken along both axes. It rocks on
//! its edges and corners and twists on them. Some peaks then belong to one motion out of many: the same pier with a
//! step that differs by 1 %, or on fewer cells, has others. The page names it, and `sensitivity` finds the peaks that
//! can be quoted.

use basemat::analyses::sensitivity;
use basemat::motion::Triaxial;
use basemat::prelude::*;
use basemat::structure::RigidBody;

/// Along x, y and z, m.
const SIDES: [f64; 3] = [6.0, 4.0, 18.0];
/// kg/m³.
const DENSITY: f64 = 1900.0;
/// Centre of gravity from the middle of the base, m.
const GRAVITY_CENTER: [f64; 3] = [0.4, 0.3, 9.0];

fn pier() -> basemat::Result<RigidBody> {
    let [length, width, height] = SIDES;
    let mass = DENSITY * length * width * height;
    let about = |one: f64, other: f64| mass * (one * one + other * other) / 12.0;
    let inertia = [
        [about(width, height), 0.0, 0.0],
        [0.0, about(length, height), 0.0],
        [0.0, 0.0, about(length, width)],
    ];
    let (x, y) = (0.5 * length, 0.5 * width);
    RigidBody::from_mass(vec![[-x, -y], [x, -y], [x, y], [-x, y]], mass, inertia, GRAVITY_CENTER)
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
    let found = sensitivity(6, 0.005, |cells, time_step| {
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
    println!("{found}");
    // The weight holds to the last digit, the torque to its first one at most.
    assert_eq!(found.peak("weight, kN")?.digits(), 6);
    assert!(found.peak("torque, kN·m")?.digits() <= 1);
    Ok(())
}
