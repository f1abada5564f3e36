//! A building on a basement, with and without soil at its walls, and the same building on the surface, under El Centro.
//!
//! ```text
//! cargo run --release --example basement
//! ```
//!
//! The basement is a rigid box, 12 m wide and 5 m deep. Its base and its walls touch the soil, and can lift off and
//! slide. In the second run the walls stand free in an open trench, and in the third the same box stands on the surface.
//! Most of its half minute goes into the convolution weights around the trench, which the first two runs share.

use basemat::bem::embedded::{Trench, TrenchGround};
use basemat::bem::{ElasticGround, SharedKernels};
use basemat::coupled::Face;
use basemat::interface::{InterfaceLaw, Limits, PreviousContact};
use basemat::prelude::*;
use basemat::site::TrenchMotion;
use basemat::structure::{ModalDamping, WithModalDamping, WithWalls};
use basemat::{Result, unobserved};

const STEP: f64 = 0.01;
const STEPS: usize = 1000;
const WIDTH: f64 = 12.0;
const DEPTH: f64 = 5.0;

fn soil() -> Result<Soil> {
    Soil::from_shear_wave_speed(200.0, 0.35, 1900.0)
}

/// Five storeys on the box, which reaches 5 m above its base.
fn building() -> Result<ShearBuilding> {
    let mut storeys = [Storey::new(3.2, 12.0e3, 40.0e6); 5];
    storeys[0] = Storey::new(3.2 + DEPTH, 12.0e3, 40.0e6);
    let mass = 600.0 * WIDTH * DEPTH;
    ShearBuilding::new(WIDTH, mass, mass * WIDTH * WIDTH / 12.0, &storeys)
}

/// The building with 5 % of damping in every mode.
fn damped() -> Result<WithModalDamping> {
    ModalDamping::new(&[0.05])?.on_fixed_base(building()?)
}

/// Law of walls that the soil does not touch: a gap that never closes.
#[derive(Debug, Clone)]
struct Free;

impl InterfaceLaw for Free {
    fn limits(&self, _start: &PreviousContact<'_>) -> Result<Limits> {
        Ok(Limits { gap_offset: f64::NEG_INFINITY, ..Limits::default() })
    }
}

/// Displacement of the roof against the base, without its rotation.
fn drift() -> Result<Probe> {
    Ok(Probe::displacement("drift", building()?.total_drift(4)?))
}

/// The building in a trench, under laws for base and walls; `at_rest`: pressure at rest on the walls.
fn in_trench(
    walls: impl InterfaceLaw + Clone + 'static,
    at_rest: f64,
    kernels: &SharedKernels,
) -> Result<Simulation> {
    let elements = Trench::new(-0.5 * WIDTH..0.5 * WIDTH, DEPTH)?.elements(6, 4)?;
    let laws = elements.interfaces(Coulomb::new(0.5)?, walls);
    let ground = TrenchGround::new(soil()?, elements)?
        .with_pressure_at_rest(at_rest)?
        .with_shared_kernels(kernels);
    // Quiet while waves travel from the base to the surface.
    let record = el_centro_1940().padded(0.2, 0.0)?;
    let motion = TrenchMotion::new(&ground, record, &mut unobserved)?;
    Simulation::builder(STEP)
        .structure(WithWalls::new(damped()?, DEPTH)?)
        .ground(ground)
        .interfaces(laws)
        .motion(motion)
        .probe(drift()?)
        .expected_steps(STEPS)
        .build()
}

fn main() -> Result<()> {
    let kernels = SharedKernels::default();
    let mut in_ground = in_trench(Coulomb::new(0.3)?, 0.5, &kernels)?;
    let at_rest = in_ground.state().face(Face::LeftWall).thrust;
    let [mut thrust, mut open] = [0.0_f64; 2];
    let below = in_ground.run(STEPS, |state| {
        let wall = state.face(Face::LeftWall);
        (thrust, open) = (thrust.max(wall.thrust), open.max(wall.open_fraction));
    })?;
    let free = in_trench(Free, 0.0, &kernels)?.run(STEPS, |_| {})?;

    let building = damped()?;
    let mut on_surface = Simulation::builder(STEP)
        .ground(ElasticGround::under(soil()?, &building, 16)?)
        .structure(building)
        .interface(Coulomb::new(0.5)?)
        .motion(el_centro_1940())
        .probe(drift()?)
        .build()?;
    let above = on_surface.run(STEPS, |_| {})?;

    println!("{below}\n");
    for (name, run) in [("basement", &below), ("free walls", &free), ("surface", &above)] {
        let drift = 1e3 * run.probe("drift")?.magnitude();
        let rotation = 1e3 * run.whole.base_rotation.magnitude();
        println!(
            "{name:10}: drift of the roof {drift:.1} mm, rotation of the base {rotation:.2} mrad"
        );
        assert!(run.energy_error < 1e-9);
    }
    let [at_rest, thrust] = [at_rest, thrust].map(|force| 1e-3 * force);
    println!("thrust on the left wall: {at_rest:.0} kN/m at rest, up to {thrust:.0} kN/m");
    println!("largest open part of the left wall: {:.0} %", 100.0 * open);
    Ok(())
}
