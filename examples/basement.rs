//! A building on a basement, with and without soil at its walls.
//!
//! ```text
//! cargo run --release --example basement
//! ```
//!
//! The basement is a rigid box, 12 m wide and 5 m deep. Its base and its walls touch the soil, and can lift off and
//! slide. In the second run the walls stand free in an open trench. In the third run the same box stands on the
//! surface. All three runs use El Centro. Most of the half minute is spent on the convolution weights of the trench,
//! which the first two runs share.

use basemat::bem::embedded::{Trench, TrenchGround};
use basemat::bem::{ElasticGround, SharedKernels};
use basemat::coupled::Face;
use basemat::interface::{InterfaceLaw, Limits, PreviousContact};
use basemat::prelude::*;
use basemat::site::TrenchMotion;
use basemat::structure::{ModalDamping, WithModalDamping, WithWalls};
use basemat::{Result, unobserved};

/// Time step, s.
const TIME_STEP: f64 = 0.01;
const STEP_COUNT: usize = 1000;
/// Width of the base, m.
const BASEMENT_WIDTH: f64 = 12.0;
/// Depth of the base below the surface, m.
const BASEMENT_DEPTH: f64 = 5.0;

fn soil() -> Result<Soil> {
    Soil::from_shear_wave_speed(200.0, 0.35, 1900.0)
}

/// Five storeys on the box. The first storey includes the depth of the box, since heights begin at its base.
fn building() -> Result<ShearBuilding> {
    let mut storeys = [Storey::new(3.2, 12.0e3, 40.0e6); 5];
    storeys[0] = Storey::new(3.2 + BASEMENT_DEPTH, 12.0e3, 40.0e6);
    let mass = 600.0 * BASEMENT_WIDTH * BASEMENT_DEPTH;
    ShearBuilding::new(
        BASEMENT_WIDTH,
        mass,
        mass * BASEMENT_WIDTH * BASEMENT_WIDTH / 12.0,
        &storeys,
    )
}

/// The building with 5 % of damping in every mode.
fn damped_building() -> Result<WithModalDamping> {
    ModalDamping::new(&[0.05])?.on_fixed_base(building()?)
}

/// Law of walls that the soil does not touch: a gap that never closes.
#[derive(Debug, Clone)]
struct FreeWalls;

impl InterfaceLaw for FreeWalls {
    fn limits(&self, _start: &PreviousContact<'_>) -> Result<Limits> {
        Ok(Limits { gap_offset: f64::NEG_INFINITY, ..Limits::default() })
    }
}

/// Displacement of the roof relative to the base, without the part due to the rotation of the base.
fn drift_probe() -> Result<Probe> {
    Ok(Probe::displacement("drift", building()?.total_drift(4)?))
}

/// Simulation of the building in a trench, with a law for its walls.
///
/// `ratio_at_rest` is K₀, the ratio of the pressure at rest on the walls to the vertical pressure.
fn trench_simulation(
    wall_law: impl InterfaceLaw + Clone + 'static,
    ratio_at_rest: f64,
    kernels: &SharedKernels,
) -> Result<Simulation> {
    let elements =
        Trench::new(-0.5 * BASEMENT_WIDTH..0.5 * BASEMENT_WIDTH, BASEMENT_DEPTH)?.elements(6, 4)?;
    let laws = elements.interfaces(Coulomb::new(0.5)?, wall_law);
    let ground = TrenchGround::new(soil()?, elements)?
        .with_pressure_at_rest(ratio_at_rest)?
        .with_shared_kernels(kernels);
    // The record begins 0.2 s after the start, when waves have travelled from the base to the surface.
    let record = el_centro_1940().padded(0.2, 0.0)?;
    let motion = TrenchMotion::new(&ground, record, &mut unobserved)?;
    Simulation::builder(TIME_STEP)
        .structure(WithWalls::new(damped_building()?, BASEMENT_DEPTH)?)
        .ground(ground)
        .interfaces(laws)
        .motion(motion)
        .probe(drift_probe()?)
        .expected_steps(STEP_COUNT)
        .build()
}

fn main() -> Result<()> {
    let kernels = SharedKernels::default();
    let mut embedded_simulation = trench_simulation(Coulomb::new(0.3)?, 0.5, &kernels)?;
    let thrust_at_rest = embedded_simulation.state().face(Face::LeftWall).thrust;
    let mut largest_thrust = 0.0_f64;
    let mut largest_opening = 0.0_f64;
    let embedded_run = embedded_simulation.run(STEP_COUNT, |state| {
        let wall = state.face(Face::LeftWall);
        largest_thrust = largest_thrust.max(wall.thrust);
        largest_opening = largest_opening.max(wall.open_fraction);
    })?;
    let free_walls_run = trench_simulation(FreeWalls, 0.0, &kernels)?.run(STEP_COUNT, |_| {})?;

    let building = damped_building()?;
    let mut surface_simulation = Simulation::builder(TIME_STEP)
        .ground(ElasticGround::under(soil()?, &building, 16)?)
        .structure(building)
        .interface(Coulomb::new(0.5)?)
        .motion(el_centro_1940())
        .probe(drift_probe()?)
        .build()?;
    let surface_run = surface_simulation.run(STEP_COUNT, |_| {})?;

    println!("{embedded_run}\n");
    for (name, run) in
        [("basement", &embedded_run), ("free walls", &free_walls_run), ("surface", &surface_run)]
    {
        let drift = 1e3 * run.probe("drift")?.magnitude();
        let rotation = 1e3 * run.whole.base_rotation.magnitude();
        println!(
            "{name:10}: drift of the roof {drift:.1} mm, rotation of the base {rotation:.2} mrad"
        );
        assert!(run.energy_error < 1e-9);
    }
    println!(
        "thrust on the left wall: {:.0} kN/m at rest, up to {:.0} kN/m",
        1e-3 * thrust_at_rest,
        1e-3 * largest_thrust
    );
    println!("largest open part of the left wall: {:.0} %", 100.0 * largest_opening);
    Ok(())
}
