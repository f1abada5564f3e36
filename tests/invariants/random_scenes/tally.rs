//! Runs a property over random scenes and keeps the worst of everything that was measured.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt;

use basemat::Error;
use basemat::coupled::State;
use basemat::coupled::{CheckpointError, StepError};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};

use super::recipe::Recipe;

/// Results of the scenes of a property.
#[derive(Debug, Default)]
pub(crate) struct Tally {
    worst: BTreeMap<&'static str, f64>,
    counts: BTreeMap<&'static str, usize>,
}

impl Tally {
    /// Fails if `value` is beyond `limit`, or NaN.
    pub(crate) fn within(
        &mut self,
        what: &'static str,
        value: f64,
        limit: f64,
    ) -> Result<(), TestCaseError> {
        let worst = self.worst.entry(what).or_insert(0.0);
        *worst = worst.max(value);
        if value <= limit {
            Ok(())
        } else {
            Err(TestCaseError::fail(format!("{what}: {value:e}, allowed {limit:e}")))
        }
    }

    pub(crate) fn count(&mut self, what: &'static str, number: usize) {
        *self.counts.entry(what).or_default() += number;
    }

    pub(crate) fn counted(&self, what: &str) -> usize {
        self.counts.get(what).copied().unwrap_or(0)
    }

    /// EnergyAccumulator what happened in a run.
    pub(crate) fn see(&mut self, states: &[State]) {
        self.count("scenes", 1);
        let modes = || states.iter().flat_map(|state| &state.modes);
        self.count("open element steps", modes().filter(|mode| !mode.is_closed()).count());
        self.count("sliding element steps", modes().filter(|mode| mode.is_slip()).count());
        self.count("changes of mode", states.iter().map(|state| state.transitions.len()).sum());
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (what, count) in &self.counts {
            writeln!(f, "  {count:>9} {what}")?;
        }
        for (what, worst) in &self.worst {
            writeln!(f, "  {worst:9.1e} {what}")?;
        }
        Ok(())
    }
}

/// Checks `property` on random scenes: `cases` of them, or as many as the environment variable
/// PROPTEST_CASES says, then from another seed each time.
pub(crate) fn for_all<T: std::fmt::Debug>(
    name: &str,
    cases: u32,
    scenes: &impl Strategy<Value = T>,
    property: impl Fn(&T, &mut Tally) -> Result<(), TestCaseError>,
) -> Tally {
    let heavy = std::env::var_os("PROPTEST_CASES").is_some();
    let config = if heavy {
        Config { failure_persistence: None, ..Config::default() }
    } else {
        Config {
            cases,
            failure_persistence: None,
            rng_seed: RngSeed::Fixed(1),
            ..Config::default()
        }
    };
    let tally = RefCell::new(Tally::default());
    let outcome =
        TestRunner::new(config).run(scenes, |scene| property(&scene, &mut tally.borrow_mut()));
    let tally = tally.into_inner();
    println!("{name}:\n{tally}");
    if let Err(failure) = outcome {
        panic!("{name}: {failure}");
    }
    tally
}

/// Name of a history in errors.
const EXPONENTIALS: &str = "history by exponentials";

/// The states of a run, or `None` if a part of the scene says that it cannot be had.
pub(crate) fn accepted(
    recipe: &Recipe,
    outcome: Result<Vec<State>, Error>,
    tally: &mut Tally,
) -> Result<Option<Vec<State>>, TestCaseError> {
    let refused = |error: &Error| {
        matches!(
            error,
            Error::Accuracy { quantity: EXPONENTIALS, .. }
                | Error::NotPassive { quantity: EXPONENTIALS, .. }
                | Error::Scene { quantity: "modal coordinates", .. }
                | Error::Checkpoint(CheckpointError::Unsupported { .. })
        )
    };
    match outcome {
        Ok(states) => Ok(Some(states)),
        Err(Error::Step { source: StepError::Part { source: error, .. }, .. })
            if refused(&error) =>
        {
            tally.count("refused", 1);
            Ok(None)
        }
        Err(error) if refused(&error) => {
            tally.count("refused", 1);
            Ok(None)
        }
        // An open thin layer that still pulls along the base has to let go at once when it lands.
        Err(Error::Step { source: StepError::Contact { .. }, .. }) if recipe.pulls_while_open() => {
            tally.count("steps without solution, layers that pull while open", 1);
            Ok(None)
        }
        Err(error) => Err(TestCaseError::fail(error.to_string())),
    }
}
