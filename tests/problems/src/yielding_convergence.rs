//! Errors of a chain of yielding springs on a fixed base, by its time step.

use std::f64::consts::PI;

use basemat::bem::SpringGround;
use basemat::coupled::State;
use basemat::interface::Bonded;
use basemat::motion::FreeFieldFn;
use basemat::{Result, Simulation};

use crate::yielding_springs::spring_column;

/// Cells of the chain.
const CELL_COUNT: usize = 4;
/// Longest time step, s, and the number of its steps in a run.
const LONGEST_TIME_STEP: f64 = 0.005;
const LONGEST_STEP_COUNT: usize = 400;
/// Halvings of the longest time step in the run of reference.
const REFERENCE_HALVINGS: u32 = 7;
/// Acceleration amplitude of the ground, m/s².
const GROUND_ACCELERATION: f64 = 3.0;
/// Degree of freedom of the highest mass.
const TOP_DOF: usize = 6;

/// Shaking at 1.5 Hz that grows over six seconds.
fn shaking() -> FreeFieldFn {
    let omega = 3.0 * PI;
    FreeFieldFn::new(move |_, time| {
        let growth = (PI / 12.0 * time.min(6.0)).sin().powi(2);
        [-GROUND_ACCELERATION / (omega * omega) * growth * (omega * time).sin(), 0.0]
    })
}

/// Displacement of the top at the ends of the longest steps.
fn top_displacements(halvings: u32) -> Result<Vec<f64>> {
    let stride = 1_usize << halvings;
    let mut simulation = Simulation::builder(LONGEST_TIME_STEP / stride as f64)
        .ground(SpringGround::new(-2.0..2.0, 4, 2e9, 2e9)?)
        .interface(Bonded)
        .structure(spring_column(CELL_COUNT))
        .motion(shaking())
        .on_fixed_base()
        .build()?;
    let mut displacements = Vec::new();
    simulation.run(LONGEST_STEP_COUNT * stride, |state: &State| {
        if state.step.is_multiple_of(stride) {
            displacements.push(state.absolute_displacement()[TOP_DOF]);
        }
    })?;
    Ok(displacements)
}

/// Errors of five time steps, each half of the one before, and the slope of their fit.
#[derive(Debug, Clone)]
pub struct StepErrors {
    /// Root mean square of the error of the top, m.
    pub errors: Vec<f64>,
    /// Slope of the line of best fit through the logarithms of the errors.
    pub slope: f64,
}

/// Halves the time step four times.
pub fn step_errors() -> Result<StepErrors> {
    let reference = top_displacements(REFERENCE_HALVINGS)?;
    let mut errors = Vec::new();
    let mut slope = 0.0;
    for halvings in 0..5_u32 {
        let displacements = top_displacements(halvings)?;
        let squares = displacements.iter().zip(&reference).map(|(a, b)| (a - b).powi(2));
        let error = (squares.sum::<f64>() / reference.len() as f64).sqrt();
        slope -= (f64::from(halvings) - 2.0) * error.log2() / 10.0;
        errors.push(error);
    }
    Ok(StepErrors { errors, slope })
}
