//! The building and one run of it.

use basemat::bem::SharedKernels;
use basemat::prelude::*;
use basemat::{Result, Soil};

pub(crate) const TIME_STEP: f64 = 5.0e-3;
/// Longest duration of a record in a run, and time after it, s.
const MAX_RECORD_DURATION: f64 = 15.0;
const REST_DURATION: f64 = 3.0;
const STOREY_COUNT: usize = 5;
const ELEMENT_COUNT: usize = 8;

/// Results of a run.
pub(crate) const RESULT_COLUMNS: [&str; 7] = [
    "peak_slip_m",
    "residual_slip_m",
    "largest_gap_m",
    "uplifted_fraction",
    "peak_drift_ratio",
    "base_shear_over_weight",
    "steps",
];

/// Runs five storeys of 3 m on a mat of this width, on soil with a shear wave speed of 250 m/s.
///
/// `motion` has the peak velocity `intensity`, m/s.
pub(crate) fn shake(
    friction: f64,
    width: f64,
    motion: &Record,
    intensity: f64,
    kernels: &SharedKernels,
) -> Result<[f64; 7]> {
    let storeys = [Storey::new(3.0, 3.0e3 * width, 7.5e6 * width); STOREY_COUNT];
    let mass = 7.5e3 * width;
    let inertia = mass * width * width / 12.0;
    let building =
        ShearBuilding::new(width, mass, inertia, &storeys)?.with_stiffness_damping(0.05)?;
    let soil = Soil::from_shear_wave_speed(250.0, 0.33, 1900.0)?;
    let mut drifts = Vec::new();
    for storey in 0..STOREY_COUNT {
        drifts.push(Probe::displacement(format!("drift {storey}"), building.drift(storey)?));
    }
    let ground = ElasticGround::under(soil, &building, ELEMENT_COUNT)?.with_shared_kernels(kernels);
    let mut simulation = Simulation::builder(TIME_STEP)
        .ground(ground)
        .structure(building)
        .interface(Coulomb::new(friction)?)
        .motion(motion.scaled(intensity / motion.peaks().velocity)?)
        .probes(drifts)
        .build()?;
    let steps = simulation.steps_for(motion.duration().min(MAX_RECORD_DURATION) + REST_DURATION);
    let run = simulation.run(steps, |_| {})?;
    let drift = run
        .probes
        .iter()
        .fold(0.0_f64, |largest, probe| largest.max(probe.extremes.magnitude()));
    Ok([
        run.whole.mean_slip.magnitude(),
        run.whole.residual_slip.abs(),
        run.largest_gap().value,
        run.whole.uplifted_fraction.largest().value,
        drift / 3.0,
        run.shear_coefficient().unwrap_or(f64::NAN),
        steps as f64,
    ])
}
