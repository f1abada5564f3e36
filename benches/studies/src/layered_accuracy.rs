//! Error of the base shear against run time on layered ground, against the tables of the tests: a
//! bonded rigid block under an SV pulse on an elastic layer over rock, on the same damped, and on a
//! damped layer over a rigid base. The numbers of `docs/validation.md` come from
//!
//! ```text
//! cargo study layered-accuracy
//! ```
//!
//! Lengths are in half widths b of the block, times in b/c of the layer, which is 2 b thick. Times are of one thread:
//! coefficients and static state, then the march of 30 b/c.

use basemat::Simulation;
use basemat::bem::layered::Stages;
use basemat::bem::{ElasticGround, Strip};
use basemat::interface::Bonded;
use basemat::motion::RickerDisplacement;
use basemat::soil::{Elastic, Kjartansson, SoilProfile};
use basemat::structure::RigidBlock;
use cpu_time::ThreadTime;

use crate::AnyError;
use crate::precision::force::{Errors, ForceSeries};
use basemat_problems::profiles::{gmb, p1, p3};

const ELEMENT_COUNTS: [usize; 3] = [8, 16, 32];
/// Time steps in b/c of the layer.
const TIME_STEPS: [f64; 4] = [0.2, 0.1, 0.05, 0.025];

/// Error against run time on layered ground.
#[derive(Debug, clap::Args)]
pub(crate) struct LayeredAccuracyOptions {
    /// Eight elements only, as a test.
    #[arg(long)]
    short: bool,
}

struct LayeredMarch {
    errors: Errors,
    /// Processor time before the first step, s.
    setup_seconds: f64,
    /// Processor time of all steps, s.
    march_seconds: f64,
}

fn march(
    profile: &SoilProfile,
    reference: &ForceSeries,
    elements: usize,
    step: f64,
    stages: Stages,
) -> Result<LayeredMarch, AnyError> {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1200 at most")]
    let steps = (reference.duration() / step).round() as usize;
    let start_time = ThreadTime::try_now()?;
    let ground = ElasticGround::new(profile.clone(), Strip::graded(-1.0..1.0, elements)?)?
        .with_stages(stages);
    // Dimensionless, without weight.
    let mut simulation = Simulation::builder(step)
        .ground(ground)
        .structure(RigidBlock::new(2.0, 2.0, 1.0)?)
        .interface(Bonded)
        .motion(RickerDisplacement::new(1.0, 1.0, 5.0)?)
        .gravity(0.0)
        .expected_steps(steps)
        .build()?;
    let mut mean_shears = Vec::with_capacity(steps);
    let setup_seconds = start_time.try_elapsed()?.as_secs_f64();
    simulation.run(steps, |state| mean_shears.push(state.base_shear))?;
    let errors = ForceSeries::new(step, mean_shears).errors(reference);
    let march_seconds = start_time.try_elapsed()?.as_secs_f64() - setup_seconds;
    Ok(LayeredMarch { errors, setup_seconds, march_seconds })
}

pub(crate) fn run(options: &LayeredAccuracyOptions) -> Result<(), AnyError> {
    let short = options.short;
    let cases = [
        ("elastic layer on rock", p1(Elastic, Elastic), "layered/td_block_SV_P1_elastic.csv"),
        ("the same, 5 % and 1 %", p1(gmb(5), gmb(1)), "layered/td_block_SV_P1_gmb.csv"),
        (
            "layer on rigid base, 5 %",
            p3(Kjartansson::new(0.05, 0.3)?),
            "layered/td_block_SV_P3_kj.csv",
        ),
    ];
    println!("| profile | elements | Δt c/b | stages | error: history | peak | before | march |");
    println!("|---|---|---|---|---|---|---|---|");
    for (name, profile, table) in cases {
        let reference = ForceSeries::from_table(table, "V");
        let counts = &ELEMENT_COUNTS[..if short { 1 } else { 3 }];
        let steps = &TIME_STEPS[..if short { 2 } else { 4 }];
        for elements in counts {
            for step in steps {
                // Three stages make a difference where the error of the elements is small.
                let compares_both = elements == &counts[counts.len() - 1];
                for stages in &[Stages::Two, Stages::Three][..if compares_both { 2 } else { 1 }] {
                    let march = march(&profile, &reference, *elements, *step, *stages)?;
                    let LayeredMarch { errors, setup_seconds, march_seconds } = march;
                    println!(
                        "| {name} | {elements} | {step} | {} | {:.1e} | {:.1e} | {setup_seconds:.2} s | {:.1} ms |",
                        stages.count(),
                        errors.series,
                        errors.peak,
                        1e3 * march_seconds
                    );
                }
            }
        }
    }
    Ok(())
}
