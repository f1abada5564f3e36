//! Runs a property over random scenes and stores the largest value of each quantity that it checks.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt;

use basemat::Error;
use basemat::coupled::{CheckpointError, State, StepError};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};

use super::recipe::SceneRecipe;

/// Results of the scenes of a property.
#[derive(Debug, Default)]
pub(crate) struct PropertyTally {
    max_values: BTreeMap<&'static str, f64>,
    counts: BTreeMap<&'static str, usize>,
}

impl PropertyTally {
    /// Fails if `value` is beyond `limit`, or NaN.
    pub(crate) fn within(
        &mut self,
        quantity: &'static str,
        value: f64,
        limit: f64,
    ) -> Result<(), TestCaseError> {
        let max_value = self.max_values.entry(quantity).or_insert(0.0);
        *max_value = max_value.max(value);
        if value <= limit {
            Ok(())
        } else {
            Err(TestCaseError::fail(format!("{quantity}: {value:e}, allowed {limit:e}")))
        }
    }

    pub(crate) fn count(&mut self, event: &'static str, number: usize) {
        *self.counts.entry(event).or_default() += number;
    }

    pub(crate) fn counted(&self, event: &str) -> usize {
        self.counts.get(event).copied().unwrap_or(0)
    }

    /// Counts scenes, open and sliding elements and changes of mode of a run.
    pub(crate) fn add_run(&mut self, states: &[State]) {
        self.count("scenes", 1);
        let modes = states.iter().flat_map(|state| &state.modes);
        self.count("open element steps", modes.clone().filter(|mode| !mode.is_closed()).count());
        self.count("sliding element steps", modes.filter(|mode| mode.is_slip()).count());
        self.count("changes of mode", states.iter().map(|state| state.transitions.len()).sum());
    }
}

impl fmt::Display for PropertyTally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (event, count) in &self.counts {
            writeln!(f, "  {count:>9} {event}")?;
        }
        for (quantity, max_value) in &self.max_values {
            writeln!(f, "  {max_value:9.1e} {quantity}")?;
        }
        Ok(())
    }
}

/// Checks `property` on random scenes.
///
/// `cases` of them, or the number in the environment variable PROPTEST_CASES, then with another seed each time.
pub(crate) fn for_all<T: std::fmt::Debug>(
    name: &str,
    cases: u32,
    scenes: &impl Strategy<Value = T>,
    property: impl Fn(&T, &mut PropertyTally) -> Result<(), TestCaseError>,
) -> PropertyTally {
    let has_case_count = std::env::var_os("PROPTEST_CASES").is_some();
    let config = if has_case_count {
        Config { failure_persistence: None, ..Config::default() }
    } else {
        Config {
            cases,
            failure_persistence: None,
            rng_seed: RngSeed::Fixed(1),
            ..Config::default()
        }
    };
    let tally = RefCell::new(PropertyTally::default());
    let result =
        TestRunner::new(config).run(scenes, |scene| property(&scene, &mut tally.borrow_mut()));
    let tally = tally.into_inner();
    println!("{name}:\n{tally}");
    if let Err(failure) = result {
        panic!("{name}: {failure}");
    }
    tally
}

/// Name of a history in errors.
const EXPONENTIAL_HISTORY: &str = "history by exponentials";

/// Whether a part of a scene states that it does not support the scene.
fn is_unsupported(error: &Error) -> bool {
    matches!(
        error,
        Error::Accuracy { quantity: EXPONENTIAL_HISTORY, .. }
            | Error::NotPassive { quantity: EXPONENTIAL_HISTORY, .. }
            | Error::Scene { quantity: "modal coordinates", .. }
            | Error::Checkpoint(CheckpointError::Unsupported { .. })
    )
}

/// The states of a run, or `None` if a part of the scene does not support it.
pub(crate) fn accepted(
    recipe: &SceneRecipe,
    result: Result<Vec<State>, Error>,
    tally: &mut PropertyTally,
) -> Result<Option<Vec<State>>, TestCaseError> {
    match result {
        Ok(states) => Ok(Some(states)),
        Err(Error::Step { source: StepError::Part { source: error, .. }, .. })
            if is_unsupported(&error) =>
        {
            tally.count("build errors", 1);
            Ok(None)
        }
        Err(error) if is_unsupported(&error) => {
            tally.count("build errors", 1);
            Ok(None)
        }
        // An open thin layer with shear traction has to release it in one step when it lands.
        Err(Error::Step { source: StepError::Contact { .. }, .. })
            if recipe.has_shear_while_open() =>
        {
            tally.count("steps without solution, layers with shear while open", 1);
            Ok(None)
        }
        Err(error) => Err(TestCaseError::fail(error.to_string())),
    }
}
