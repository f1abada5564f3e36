//! GOAL: a run that is saved and resumed is the run that was never interrupted, to the last bit.
//! SCENE: half-planes with every history, spring beds, structures with internal variables.
//! REFERENCE: the uninterrupted run.

mod damaged;
mod histories;
mod refused;
mod resumed;
mod state_variables;
mod sum;
mod text;

use basemat::bem::{ElasticGround, SpringGround, Strip};
use basemat::coupled::Checkpoint;
use basemat::coupled::CheckpointError;
use basemat::history::HistoryOptions;
use basemat::{Error, Simulation};

use basemat_problems::scenes::{SI_UNITS, soil};

/// Steps of a run, longer than the window of the exponentials and several leaves of the transforms.
const RUN_STEPS: usize = 260;

fn half_plane(history: impl Into<HistoryOptions>) -> ElasticGround {
    ElasticGround::new(soil(SI_UNITS), Strip::graded(-2.0..2.0, 6).unwrap())
        .unwrap()
        .with_history(history)
        .unwrap()
}

fn spring_bed() -> SpringGround {
    SpringGround::new(-2.0..2.0, 8, 5e7, 4e7).unwrap().with_dashpots(4e5, 3e5).unwrap()
}

/// A checkpoint that was written as text and read again.
fn through_text(checkpoint: &Checkpoint) -> Checkpoint {
    let text = serde_json::to_string(checkpoint).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// Error of `resume` with this checkpoint, which must leave the simulation unchanged.
fn resume_error(simulation: &mut Simulation, checkpoint: &Checkpoint) -> CheckpointError {
    let before = simulation.checkpoint().unwrap();
    let error = simulation.resume(checkpoint).unwrap_err();
    assert_eq!(simulation.checkpoint().unwrap(), before, "an error must change nothing");
    match error {
        Error::Checkpoint(error) => error,
        other => panic!("{other}"),
    }
}
