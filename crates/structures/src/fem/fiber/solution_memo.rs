//! Last states of a beam by forces, for further evaluations at the same deformations.

use std::fmt;
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::basic_state::{BasicState, BeamLinearisation};

/// Number of states: at mid-step and at the end of a step.
const STATE_COUNT: usize = 2;

/// Length (m) and basic deformations of a state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SolutionKey<const B: usize> {
    pub(super) length: f64,
    pub(super) v: [f64; B],
}

/// States at the same internal variables.
pub(super) struct StoredStates<const N: usize, const B: usize> {
    /// Internal variables of the beam to which the states belong.
    variables: Vec<f64>,
    states: [Option<(SolutionKey<B>, BasicState<N, B>)>; STATE_COUNT],
    /// Length (m) of the beam and its linearisation about the state at the end of the last step.
    start: Option<(f64, BeamLinearisation<N, B>)>,
}

/// Last states that a beam by forces has solved for.
///
/// Force, energy, remainder and commit of a step are evaluated at two displacements. Each is solved once. All iterations of
/// a step begin at its start.
pub(in crate::fem) struct SolutionMemo<const N: usize, const B: usize>(Mutex<StoredStates<N, B>>);

impl<const N: usize, const B: usize> Default for SolutionMemo<N, B> {
    fn default() -> Self {
        let states = [None; STATE_COUNT];
        Self(Mutex::new(StoredStates { variables: Vec::new(), states, start: None }))
    }
}

/// A clone begins without states.
impl<const N: usize, const B: usize> Clone for SolutionMemo<N, B> {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl<const N: usize, const B: usize> fmt::Debug for SolutionMemo<N, B> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("SolutionMemo")
    }
}

impl<const N: usize, const B: usize> SolutionMemo<N, B> {
    /// The states at internal variables; none if the last ones belonged to others.
    pub(super) fn at(&self, variables: &[f64]) -> MutexGuard<'_, StoredStates<N, B>> {
        let mut stored = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if !have_same_bits(&stored.variables, variables) {
            stored.variables.clear();
            stored.variables.extend_from_slice(variables);
            stored.states = [None; STATE_COUNT];
            stored.start = None;
        }
        stored
    }
}

impl<const N: usize, const B: usize> StoredStates<N, B> {
    /// The state of a key; `None` unless it is one of the last.
    pub(super) fn find(&self, key: &SolutionKey<B>) -> Option<BasicState<N, B>> {
        let mut states = self.states.iter().flatten();
        states.find(|(state_key, _)| state_key == key).map(|(_, state)| *state)
    }

    /// Stores a state in place of the oldest.
    pub(super) fn store(&mut self, key: SolutionKey<B>, state: BasicState<N, B>) {
        self.states.rotate_right(1);
        self.states[0] = Some((key, state));
    }

    /// The linearisation about the start of the step, for a beam of this length.
    pub(super) fn start(&self, length: f64) -> Option<BeamLinearisation<N, B>> {
        self.start
            .filter(|(start_length, _)| *start_length == length)
            .map(|(_, start)| start)
    }

    /// Stores the linearisation about the start of the step.
    pub(super) fn set_start(&mut self, length: f64, start: Option<BeamLinearisation<N, B>>) {
        self.start = start.map(|start| (length, start));
    }
}

/// Whether two lists have the same bits, without a branch at each number.
fn have_same_bits(a: &[f64], b: &[f64]) -> bool {
    const NUMBERS_AT_ONCE: usize = 16;
    let pairs = a.chunks(NUMBERS_AT_ONCE).zip(b.chunks(NUMBERS_AT_ONCE));
    let difference = |a: &[f64], b: &[f64]| {
        a.iter().zip(b).fold(0, |bits, (x, y)| bits | (x.to_bits() ^ y.to_bits()))
    };
    a.len() == b.len() && pairs.into_iter().all(|(a, b)| difference(a, b) == 0)
}
