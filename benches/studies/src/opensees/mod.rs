//! The crate's half of a comparison with OpenSees.
//!
//! The scene is a rigid block on soil under a vertically incident SV pulse, bonded, or with weight, uplift and friction.
//!
//! ```text
//! cargo study opensees --elements 16 --step 0.002            # bonded
//! cargo study opensees --elements 16 --step 0.002 --friction
//! ```
//!
//! The scene is in `scene.json`, also for the other half; `compare.py` runs both and prints
//! their differences and run times. Prints time series of the block.

use std::io::{BufWriter, Write};

use basemat::coupled::GravityStage;
use basemat::interface::ContactState;
use basemat::motion::RickerDisplacement;
use basemat::prelude::*;
use serde_json::Value;

use crate::AnyError;
use crate::document::peak_memory;

/// A rigid block on soil under an SV pulse: the crate's half of a comparison with OpenSees.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct OpenseesOptions {
    /// Elements of the base, graded towards its edges.
    #[arg(long)]
    elements: usize,
    /// Time step, s.
    #[arg(long)]
    step: f64,
    /// Weight, uplift and friction instead of a bonded base.
    #[arg(long)]
    friction: bool,
}

/// Writes the row of a state.
fn write_row(out: &mut dyn Write, state: &State) -> std::io::Result<()> {
    writeln!(
        out,
        "{:.9e},{:.9e},{:.9e},{:.9e},{:.9e},{:.9e},{:.9e},{:.9e}",
        state.time,
        state.probes[0],
        state.probes[1],
        state.base_rotation,
        state.probes[2],
        state.mean_slip,
        gap(state.contact.first()),
        gap(state.contact.last()),
    )
}

fn gap(element: Option<&ContactState>) -> f64 {
    element.map_or(0.0, |element| element.gap)
}

pub(crate) fn run(options: &OpenseesOptions) -> Result<(), AnyError> {
    let scene: Value = serde_json::from_str(include_str!("scene.json"))?;
    let number = |name: &str| scene[name].as_f64().ok_or(format!("scene.json: no number {name}"));
    let height = number("height")?;
    let width = number("width")?;
    let soil = Soil::from_shear_wave_speed(
        number("shear_wave_speed")?,
        number("poisson")?,
        number("soil_density")?,
    )?;
    let block = RigidBlock::new(width, height, number("block_density")?)?;
    // The acceleration of the pulse is −6 A/σ² at its peak.
    let sigma = number("sigma")?;
    let amplitude = number("peak_acceleration")? * sigma.powi(2) / 6.0;
    let pulse = RickerDisplacement::new(amplitude, sigma, number("center")?)?;
    let law: Box<dyn InterfaceLaw> = if options.friction {
        Box::new(Coulomb::new(number("friction")?)?)
    } else {
        Box::new(Bonded)
    };
    let roof = block.horizontal_at(height);
    let mut simulation = Simulation::builder(options.step)
        .ground(ElasticGround::under(soil, &block, options.elements)?)
        .structure(block)
        .interface(law)
        .gravity(number("gravity")?)
        // As in the finite elements: friction acts while the weight is applied.
        .gravity_stage(GravityStage::Frictional)
        .motion(pulse)
        .probe(Probe::displacement("roof", roof.clone()))
        .probe(Probe::acceleration("acceleration", roof))
        .probe(Probe::displacement("vertical", RigidBlock::VERTICAL_DOF))
        .build()?;
    let mut out = BufWriter::new(std::io::stdout().lock());
    // The acceleration of a step is its mean: it belongs to the middle of the step.
    writeln!(out, "time,roof,acceleration,rotation,vertical,slip,left_gap,right_gap")?;
    write_row(&mut out, simulation.state())?;
    let steps = simulation.steps_for(number("duration")?);
    simulation.run(steps, |state| {
        write_row(&mut out, state)
            .map_err(|error| basemat::Error::part("output", error.to_string()))
    })?;
    out.flush()?;
    // The system's own figure for a child would include the memory of the program that started it.
    if let Some(megabytes) = peak_memory() {
        eprintln!("{{\"megabytes\": {megabytes}}}");
    }
    Ok(())
}
