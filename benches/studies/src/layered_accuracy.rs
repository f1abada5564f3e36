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
use crate::precision::force::{Errors, Force};
use basemat_problems::profiles::{gmb, p1, p3};

const ELEMENTS: [usize; 3] = [8, 16, 32];
const STEPS: [f64; 4] = [0.2, 0.1, 0.05, 0.025];

/// Error against run time on layered ground.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Eight elements only, to see that all works.
    #[arg(long)]
    short: bool,
}

struct Found {
    errors: Errors,
    /// Before the first step, and all steps, s.
    seconds: [f64; 2],
}

fn march(
    profile: &SoilProfile,
    table: &Force,
    (elements, step, stages): (usize, f64, Stages),
) -> Result<Found, AnyError> {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1200 at most")]
    let steps = (table.duration() / step).round() as usize;
    let begin = ThreadTime::try_now()?;
    let ground = ElasticGround::new(profile.clone(), Strip::graded(-1.0..1.0, elements)?)?
        .with_stages(stages);
    // Without dimensions, and without weight.
    let mut simulation = Simulation::builder(step)
        .ground(ground)
        .structure(RigidBlock::new(2.0, 2.0, 1.0)?)
        .interface(Bonded)
        .motion(RickerDisplacement::new(1.0, 1.0, 5.0)?)
        .gravity(0.0)
        .expected_steps(steps)
        .build()?;
    let mut means = Vec::with_capacity(steps);
    let ready = begin.try_elapsed()?.as_secs_f64();
    simulation.run(steps, |state| means.push(state.base_shear))?;
    let errors = Force::new(step, means).errors(table);
    Ok(Found { errors, seconds: [ready, begin.try_elapsed()?.as_secs_f64() - ready] })
}

pub(crate) fn run(options: &Options) -> Result<(), AnyError> {
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
        let table = Force::from_table(table, "V");
        let counts = &ELEMENTS[..if short { 1 } else { 3 }];
        let steps = &STEPS[..if short { 2 } else { 4 }];
        for elements in counts {
            for step in steps {
                // Three stages show where elements leave little.
                let both = elements == &counts[counts.len() - 1];
                for stages in &[Stages::Two, Stages::Three][..if both { 2 } else { 1 }] {
                    let found = march(&profile, &table, (*elements, *step, *stages))?;
                    let Found { errors, seconds: [ready, march] } = found;
                    println!(
                        "| {name} | {elements} | {step} | {} | {:.1e} | {:.1e} | {ready:.2} s | {:.1} ms |",
                        stages.count(),
                        errors.history,
                        errors.peak,
                        1e3 * march
                    );
                }
            }
        }
    }
    Ok(())
}
