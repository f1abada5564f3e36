//! Errors and processor time of a block in a trench over meshes and time steps.
//!
//! Half width, depth, density, shear modulus and shear wave speed are 1, the block is 3 high, ν = 1/3: the block of
//! `tests/data/embedded/td_*.csv`, under its pulse of shear waves. Its faces are welded or in contact.

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

const PULSE_DURATION: f64 = 25.6;
/// Time between samples; a multiple of all time steps.
const SAMPLE_INTERVAL: f64 = 0.4;
/// Largest acceleration of the pulse over gravity.
const PEAK_OVER_GRAVITY: f64 = 0.8;
/// Largest acceleration of the pulse.
const PEAK_ACCELERATION: f64 = 2.16;

/// A mesh, its time step, and whether all faces are welded.
#[derive(Debug, Clone, Copy)]
struct TrenchSetting {
    elements: [usize; 2],
    step: f64,
    welded: bool,
}

/// A march of the block, and its processor times.
struct TrenchMarch {
    /// Motion of the base, rotation and thrust on the left wall at the samples.
    series: [Vec<f64>; 3],
    build_seconds: f64,
    step_seconds: f64,
}

fn elements([base, wall]: [usize; 2]) -> basemat::Result<TrenchElements> {
    Trench::new(-1.0..1.0, 1.0)?.elements(base, wall)
}

fn march(setting: TrenchSetting, kernels: &SharedKernels) -> Result<TrenchMarch, AnyError> {
    let TrenchSetting { elements: counts, step, welded } = setting;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "hundreds")]
    let steps = (PULSE_DURATION / step).round() as usize;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "hundreds")]
    let sample_stride = (SAMPLE_INTERVAL / step).round() as usize;
    // The second derivative of a Ricker pulse.
    let record = Record::from_fn(0.02, 40.0, |t| {
        let x = 0.6 * (t - 9.0);
        0.36 * (-6.0 + x * x * (24.0 - 8.0 * x * x)) * (-x * x).exp()
    })?;
    let start_time = ProcessTime::try_now()?;
    let ground = TrenchGround::new(Soil::new(1.0, 1.0 / 3.0, 1.0)?, elements(counts)?)?
        .with_pressure_at_rest(0.5)?
        .with_shared_kernels(kernels);
    let motion = TrenchMotion::new(&ground, record, &mut unobserved)?;
    let builder = Simulation::builder(step)
        .structure(WithWalls::new(RigidBlock::new(2.0, 3.0, 1.0)?, 1.0)?)
        .ground(ground)
        .motion(motion)
        .gravity(PEAK_ACCELERATION / PEAK_OVER_GRAVITY)
        .expected_steps(steps);
    let builder = if welded {
        builder.interface(Bonded)
    } else {
        builder.interfaces(elements(counts)?.interfaces(Coulomb::new(0.5)?, Coulomb::new(0.3)?))
    };
    let mut simulation = builder.build()?;
    let build_seconds = start_time.try_elapsed()?.as_secs_f64();
    let start_time = ProcessTime::try_now()?;
    let mut series = [const { vec![] }; 3];
    let mut count = 0;
    let run = simulation.run(steps, |state| {
        count += 1;
        if count % sample_stride == 0 {
            series[0].push(state.absolute_displacement()[0]);
            series[1].push(state.base_rotation);
            series[2].push(state.face(Face::LeftWall).thrust);
        }
    })?;
    if run.energy_error >= 1e-9 {
        return Err(format!("energy balance open by {:.1e}", run.energy_error).into());
    }
    let step_seconds = start_time.try_elapsed()?.as_secs_f64();
    Ok(TrenchMarch { series, build_seconds, step_seconds })
}

/// Largest differences relative to the largest changes, %.
fn errors(computed: &TrenchMarch, reference: &TrenchMarch) -> [f64; 3] {
    std::array::from_fn(|k| {
        let computed = &computed.series[k];
        let reference = &reference.series[k];
        let at_rest = reference.first().copied().unwrap_or(0.0);
        let changes = reference.iter().map(|value| (value - at_rest).abs());
        let differences = computed.iter().zip(reference).map(|(a, b)| (a - b).abs());
        100.0 * differences.fold(0.0, f64::max) / changes.fold(0.0, f64::max)
    })
}

/// Adds lines of the settings, with errors relative to the last setting.
fn lines(settings: &[([usize; 2], f64)], text: &mut String) -> Result<(), AnyError> {
    let kernels: Vec<SharedKernels> = settings.iter().map(|_| SharedKernels::default()).collect();
    for is_welded in [true, false] {
        let mut marches = Vec::new();
        for (&(elements, step), kernels) in settings.iter().zip(&kernels) {
            marches.push(march(TrenchSetting { elements, step, welded: is_welded }, kernels)?);
        }
        let Some(last) = marches.last() else { continue };
        for (([base, wall], step), computed) in settings.iter().zip(&marches) {
            let law = if is_welded { "welded" } else { "contact" };
            write!(text, "| {law} | {} | {step} |", base + 2 * wall)?;
            let is_last = std::ptr::eq(computed, last);
            for error in errors(computed, last) {
                if is_last {
                    write!(text, " – |")?;
                } else {
                    write!(text, " {error:.2} |")?;
                }
            }
            // The convolution weights of the welded block are used again.
            let build_seconds = if is_welded {
                format!("{:.1}", computed.build_seconds)
            } else {
                "the same".into()
            };
            writeln!(text, " {build_seconds} | {:.0} |", 1e3 * computed.step_seconds)?;
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
