//! Counts of the scenes and pairs of parts that the rows of the suite covered, and all their failures.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::sync::Mutex;

use basemat::Result;
use basemat_problems::heavy;

/// Pairs of parts that any row has compared so far.
static COVERED: Mutex<BTreeSet<[&'static str; 2]>> = Mutex::new(BTreeSet::new());

/// One row of the suite: an identity with its limits.
pub(crate) struct IdentityTally {
    row: &'static str,
    scenes: usize,
    /// Scenes that are errors in both forms, with the reason.
    errors: Vec<String>,
    pairs: BTreeSet<[&'static str; 2]>,
    /// Largest value over its limit.
    largest_ratio: f64,
    /// Value, limit and place of the largest ratio.
    largest_text: String,
    failures: Vec<String>,
}

/// Number of scenes: `short` in CI, `long` at night.
pub(crate) fn scenes(short: usize, long: usize) -> usize {
    if heavy() { long } else { short }
}

impl IdentityTally {
    pub(crate) fn new(row: &'static str) -> Self {
        Self {
            row,
            scenes: 0,
            errors: Vec::new(),
            pairs: BTreeSet::new(),
            largest_ratio: 0.0,
            largest_text: String::new(),
            failures: Vec::new(),
        }
    }

    /// Counts a scene of these parts.
    pub(crate) fn scene(&mut self, parts: &[&'static str]) {
        self.scenes += 1;
        self.pair(parts);
    }

    /// Counts the pairs of these parts.
    pub(crate) fn pair(&mut self, parts: &[&'static str]) {
        for (k, one) in parts.iter().enumerate() {
            for other in &parts[k + 1..] {
                let mut pair = [*one, *other];
                pair.sort_unstable();
                self.pairs.insert(pair);
            }
        }
    }

    /// Adds a scene that is an error in either form.
    pub(crate) fn add_error(&mut self, text: String) {
        self.errors.push(text);
    }

    pub(crate) fn fail(&mut self, text: String) {
        self.failures.push(text);
    }

    /// Compares two results; counts two errors, and fails if one alone is an error.
    pub(crate) fn compare<T>(
        &mut self,
        place: &str,
        results: [Result<T>; 2],
        compare: impl FnOnce(&mut Self, T, T),
    ) {
        match results {
            [Ok(one), Ok(other)] => compare(self, one, other),
            [Err(error), Err(_)] => self.add_error(format!("{place}: {error}")),
            results => {
                let errors = results.map(|result| result.err().map(|error| error.to_string()));
                self.fail(format!("{place}: one alone is an error, {errors:?}"));
            }
        }
    }

    /// Fails if `value` is beyond `limit`, or NaN.
    pub(crate) fn within(&mut self, place: &str, value: f64, limit: f64) {
        let ratio = value / limit;
        if ratio > self.largest_ratio {
            self.largest_ratio = ratio;
            self.largest_text = format!("{value:.1e} of {limit:.1e}, {place}");
        }
        if value.is_nan() || value > limit {
            self.fail(format!("{place}: {value:.3e}, allowed {limit:.1e}"));
        }
    }

    /// Prints the covered scenes and pairs, and panics with all failures.
    ///
    /// `accepted`: smallest fraction of the scenes that must be accepted.
    pub(crate) fn close(self, accepted: f64) {
        let all_pairs = {
            let mut covered = COVERED.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            covered.extend(self.pairs.iter());
            covered.len()
        };
        println!(
            "{}: {} scenes, {} with errors, {} pairs of parts ({all_pairs} in all rows so far), largest {}",
            self.row,
            self.scenes,
            self.errors.len(),
            self.pairs.len(),
            self.largest_text,
        );
        for text in &self.errors {
            println!("    error: {text}");
        }
        let mut report = String::new();
        for text in &self.failures {
            let _ = write!(report, "\n    {text}");
        }
        let failures = self.failures.len();
        assert!(failures == 0, "{}: {failures} failures{report}", self.row);
        let accepted_scenes = (self.scenes - self.errors.len().min(self.scenes)) as f64;
        let is_enough = accepted_scenes >= accepted * self.scenes as f64;
        assert!(is_enough, "{}: too many errors", self.row);
        assert!(self.scenes > 0, "{}: no scene", self.row);
    }
}
