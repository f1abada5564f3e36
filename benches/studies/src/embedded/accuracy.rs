//! Errors and processor time of a block in a trench, welded and with contact, over meshes and time steps.
//!
//! Half width, depth, density, shear modulus and shear wave speed are 1, the block is 3 high, ν = 1/3: the block of
//! `tests/data/embedded/td_*.csv`, under its pulse of shear waves.

use std::fmt::Write as _;

use basemat::bem::SharedKernels;
use basemat::bem::embedded::{Trench, TrenchElements, TrenchGround};
use basemat::coupled::Face;
use basemat::interface::{Bonded, Coulomb};
use basemat::motion::Record;
use basemat::site::TrenchMotion;
use basemat::structure::{RigidBlock, WithWalls};
use basemat::{Simulation, Soil, unobserved};
use cpu_time::ProcessTime;

use crate::AnyError;

const DURATION: f64 = 25.6;
/// Instants that all time steps have.
const SAMPLE: f64 = 0.4;
/// Largest acceleration of the pulse over gravity.
const STRENGTH: f64 = 0.8;
/// Largest acceleration of the pulse.
const PEAK: f64 = 2.16;

/// A mesh, its time step, and whether all faces are welded.
#[derive(Debug, Clone, Copy)]
struct Setting {
    elements: [usize; 2],
    step: f64,
    welded: bool,
}

/// Motion of the base, rotation and thrust on the left wall at the samples; seconds of build and steps.
struct Found {
    series: [Vec<f64>; 3],
    seconds: [f64; 2],
}

fn elements([base, wall]: [usize; 2]) -> basemat::Result<TrenchElements> {
    Trench::new(-1.0..1.0, 1.0)?.elements(base, wall)
}

fn march(setting: Setting, kernels: &SharedKernels) -> Result<Found, AnyError> {
    let Setting { elements: counts, step, welded } = setting;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "hundreds")]
    let [steps, every] = [DURATION / step, SAMPLE / step].map(|count| count.round() as usize);
    let second = |t: f64| {
        let x = 0.6 * (t - 9.0);
        0.36 * (-6.0 + x * x * (24.0 - 8.0 * x * x)) * (-x * x).exp()
    };
    let record = Record::from_fn(0.02, 40.0, second)?;
    let begin = ProcessTime::try_now()?;
    let ground = TrenchGround::new(Soil::new(1.0, 1.0 / 3.0, 1.0)?, elements(counts)?)?
        .with_pressure_at_rest(0.5)?
        .with_shared_kernels(kernels);
    let motion = TrenchMotion::new(&ground, record, &mut unobserved)?;
    let builder = Simulation::builder(step)
        .structure(WithWalls::new(RigidBlock::new(2.0, 3.0, 1.0)?, 1.0)?)
        .ground(ground)
        .motion(motion)
        .gravity(PEAK / STRENGTH)
        .expected_steps(steps);
    let builder = if welded {
        builder.interface(Bonded)
    } else {
        builder.interfaces(elements(counts)?.interfaces(Coulomb::new(0.5)?, Coulomb::new(0.3)?))
    };
    let mut simulation = builder.build()?;
    let built = begin.try_elapsed()?.as_secs_f64();
    let begin = ProcessTime::try_now()?;
    let mut series = [const { vec![] }; 3];
    let mut count = 0;
    let run = simulation.run(steps, |state| {
        count += 1;
        if count % every == 0 {
            let moved = state.absolute_displacement()[0];
            let thrust = state.face(Face::LeftWall).thrust;
            let values = [moved, state.base_rotation, thrust];
            series.iter_mut().zip(values).for_each(|(own, value)| own.push(value));
        }
    })?;
    if run.energy_error >= 1e-9 {
        return Err(format!("energy balance open by {:.1e}", run.energy_error).into());
    }
    Ok(Found { series, seconds: [built, begin.try_elapsed()?.as_secs_f64()] })
}

/// Largest differences relative to the largest changes, %.
fn errors(found: &Found, wanted: &Found) -> [f64; 3] {
    std::array::from_fn(|k| {
        let [found, wanted] = [&found.series[k], &wanted.series[k]];
        let rest = wanted.first().copied().unwrap_or(0.0);
        let largest = wanted.iter().fold(0.0_f64, |most, own| most.max((own - rest).abs()));
        let apart = found.iter().zip(wanted).map(|(found, wanted)| (found - wanted).abs());
        100.0 * apart.fold(0.0, f64::max) / largest
    })
}

/// Lines of the settings, against the last one.
fn lines(settings: &[([usize; 2], f64)], text: &mut String) -> Result<(), AnyError> {
    let kernels: Vec<SharedKernels> = settings.iter().map(|_| SharedKernels::default()).collect();
    for welded in [true, false] {
        let march =
            |(&(elements, step), kernels)| march(Setting { elements, step, welded }, kernels);
        let all = settings.iter().zip(&kernels).map(march).collect::<Result<Vec<_>, _>>()?;
        let Some((last, _)) = all.split_last() else { continue };
        for (([base, wall], step), found) in settings.iter().zip(&all) {
            let law = if welded { "welded" } else { "contact" };
            write!(text, "| {law} | {} | {step} |", base + 2 * wall)?;
            let is_last = std::ptr::eq(found, last);
            for error in errors(found, last) {
                if is_last {
                    write!(text, " – |")?;
                } else {
                    write!(text, " {error:.2} |")?;
                }
            }
            // Weights are those of the welded block.
            let [built, steps] = found.seconds;
            let built = if welded { format!("{built:.1}") } else { "the same".into() };
            writeln!(text, " {built} | {:.0} |", 1e3 * steps)?;
        }
    }
    Ok(())
}

pub(super) fn tables(short: bool) -> Result<String, AnyError> {
    let mut text = String::new();
    let heading = "| faces | elements | Δt, b/c_S | base, % | rotation, % | thrust, % | weights, s | steps, ms |\n\
                   |---|---|---|---|---|---|---|---|\n";
    let meshes = [[2, 2], [4, 3], [8, 6], [16, 12]].map(|counts| (counts, 0.2));
    let meshes = if short { &meshes[..2] } else { &meshes[..] };
    text += "Meshes, against the finest:\n\n";
    text += heading;
    lines(meshes, &mut text)?;
    let steps = [0.4, 0.2, 0.1, 0.05].map(|step| ([4, 3], step));
    let steps = if short { &[([4, 3], 0.4), ([4, 3], 0.2)][..] } else { &steps[..] };
    text += "\nTime steps, against the shortest:\n\n";
    text += heading;
    lines(steps, &mut text)?;
    Ok(text)
}
