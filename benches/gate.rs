//! Wall times of the calls that take a user's time, as lines of seconds and name.
//!
//! A time is the smallest of a few repetitions.
//!
//! `.ci/bench_gate` runs this program of two commits in turns and compares them. Arguments are the
//! names to time, by default all. Statistics of single kernels are in the other benches.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use basemat::bem::{ElasticGround, Ground, PatchKernel, Strip};
use basemat::history::{ConvolutionHistory, ConvolutionWeights, DirectHistory, RelaxedFftHistory};
use basemat::interface::{Bonded, Coulomb, InterfaceLaw, Yielding};
use basemat::motion::{Triaxial, el_centro_1940};
use basemat::results::Recorder;
use basemat::soil::SoilProfile;
use basemat::structure::{RigidBlock, RigidBody};
use basemat::{Result, Simulation, Soil, unobserved};
use basemat_problems::headline;

const REPETITION_COUNT: usize = 3;

/// A timed call, with all data that it needs.
type TimedCall = Box<dyn FnOnce() -> Result<()>>;

/// Function that prepares a timed call.
type PrepareCall = fn() -> Result<TimedCall>;

const TIMED_JOBS: [(&str, PrepareCall); 10] = [
    ("4000 steps, bonded", || headline_steps(Bonded)),
    ("4000 steps, friction", || headline_steps(Coulomb::new(0.2)?)),
    ("1000 steps, friction, 40 graded elements", many_elements),
    ("1000 steps, bearing pressure, 40 graded elements", bearing_pressure),
    ("500 steps, friction, 48 cells in plan", cells_in_plan),
    ("2000 steps, time series and contact", time_series),
    ("build of the headline", build),
    ("coefficients of the half-plane", half_plane),
    ("coefficients of layers", layers),
    ("convolution of 10 000 steps", convolution),
];

fn headline_steps(law: impl InterfaceLaw + 'static) -> Result<TimedCall> {
    let (builder, ground) = headline::headline(headline::ELEMENT_COUNT)?;
    // With fewer expected steps, the simulation would use degrees of freedom instead of modes.
    let builder = builder.ground(ground).interface(law).expected_steps(headline::RECORD_STEPS);
    let mut simulation = builder.build()?;
    Ok(Box::new(move || simulation.run(4_000, |_| ()).map(drop)))
}

fn block(graded_elements: usize, law: impl InterfaceLaw + 'static) -> Result<Simulation> {
    Simulation::builder(2.0e-3)
        .ground(ElasticGround::new(headline::soil()?, Strip::graded(-5.0..5.0, graded_elements)?)?)
        .structure(RigidBlock::new(10.0, 12.0, 1_000.0)?)
        .interface(law)
        .motion(el_centro_1940())
        .build()
}

fn many_elements() -> Result<TimedCall> {
    let mut simulation = block(40, Coulomb::new(0.4)?)?;
    Ok(Box::new(move || simulation.run(1_000, |_| ()).map(drop)))
}

fn bearing_pressure() -> Result<TimedCall> {
    // Twice the pressure of the weight.
    let mut simulation = block(40, Yielding::new(2.4e5, 0.4)?)?;
    Ok(Box::new(move || simulation.run(1_000, |_| ()).map(drop)))
}

fn cells_in_plan() -> Result<TimedCall> {
    let body = RigidBody::cuboid([8.0, 6.0, 10.0], 1_000.0)?;
    let ground = ElasticGround::under(headline::soil()?, &body, 6)?;
    let motion = Triaxial { x: Some(el_centro_1940()), y: Some(el_centro_1940()), up: None };
    let mut simulation = Simulation::builder(5.0e-3)
        .ground(ground)
        .structure(body)
        .interface(Coulomb::new(0.4)?)
        .motion(motion)
        .build()?;
    Ok(Box::new(move || simulation.run(500, |_| ()).map(drop)))
}

fn time_series() -> Result<TimedCall> {
    let mut simulation = block(10, Coulomb::new(0.4)?)?;
    Ok(Box::new(move || {
        let mut time_series = Recorder::new().contact(1).start(&simulation)?;
        simulation.run(2_000, |state| time_series.record(state))?;
        black_box(time_series.bytes());
        Ok(())
    }))
}

fn build() -> Result<TimedCall> {
    let (builder, ground) = headline::headline(headline::ELEMENT_COUNT)?;
    let builder = builder.ground(ground).interface(Bonded).expected_steps(headline::RECORD_STEPS);
    Ok(Box::new(move || builder.build().map(|simulation| drop(black_box(simulation)))))
}

fn half_plane() -> Result<TimedCall> {
    let elements = Strip::graded(-5.0..5.0, 16)?.elements();
    Ok(Box::new(move || {
        let kernel = PatchKernel::new(headline::soil()?, elements, 2.0e-3)?;
        DirectHistory::new(Arc::new(kernel)).prepare(400, &mut unobserved)
    }))
}

fn layers() -> Result<TimedCall> {
    let rock = Soil::new(1.0e9, 0.25, 2200.0)?;
    let profile = SoilProfile::on_half_plane(rock).with_layer(headline::soil()?, 8.0)?;
    let mut ground = ElasticGround::new(profile, Strip::graded(-5.0..5.0, 8)?)?;
    Ok(Box::new(move || ground.prepare(5.0e-3, Some(200), &mut unobserved)))
}

fn convolution() -> Result<TimedCall> {
    let elements = Strip::uniform(-5.0..5.0, 10)?.elements();
    let kernel: Arc<dyn ConvolutionWeights> =
        Arc::new(PatchKernel::new(headline::soil()?, elements, 2.0e-3)?);
    let mut history = RelaxedFftHistory::new(kernel);
    history.prepare(10_000, &mut unobserved)?;
    Ok(Box::new(move || {
        let mut displacement = vec![0.0; 20];
        let traction: Vec<f64> = (0..20).map(|i| f64::from(i).sin()).collect();
        for _ in 0..10_000 {
            history.evaluate(&mut displacement)?;
            history.push(&traction);
        }
        black_box(displacement);
        Ok(())
    }))
}

fn main() -> Result<()> {
    // Cargo adds the argument `--bench`.
    let selected: Vec<String> = std::env::args().skip(1).filter(|name| name != "--bench").collect();
    for (name, prepare) in TIMED_JOBS {
        if !selected.is_empty() && !selected.iter().any(|selected| selected == name) {
            continue;
        }
        let mut fastest = f64::INFINITY;
        for _ in 0..REPETITION_COUNT {
            let prepared_scene = prepare()?;
            let start_time = Instant::now();
            prepared_scene()?;
            fastest = fastest.min(start_time.elapsed().as_secs_f64());
        }
        println!("{fastest:.6}\t{name}");
    }
    Ok(())
}
