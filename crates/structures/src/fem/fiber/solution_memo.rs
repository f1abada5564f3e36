//! Last states of a beam by forces, for further evaluations at the same deformations.

use std::fmt;
use std::sync::{Mutex, PoisonError};

use super::basic_state::BasicState;

/// Number of states: at mid-step and at the end of a step.
const STATE_COUNT: usize = 2;

/// Length (m) and basic deformations of a state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SolutionKey<const B: usize> {
    pub(super) length: f64,
    pub(super) v: [f64; B],
}

/// States at the same internal variables.
struct StoredStates<const N: usize, const B: usize> {
    /// Internal variables of the beam to which the states belong.
    variables: Vec<f64>,
    states: [Option<(SolutionKey<B>, BasicState<N, B>)>; STATE_COUNT],
}

/// Last states that a beam by forces has solved for.
///
/// Force, energy, remainder and commit of a step are evaluated at two displacements. Each is solved once.
pub(in crate::fem) struct SolutionMemo<const N: usize, const B: usize>(Mutex<StoredStates<N, B>>);

impl<const N: usize, const B: usize> Default for SolutionMemo<N, B> {
    fn default() -> Self {
        Self(Mutex::new(StoredStates { variables: Vec::new(), states: [None; STATE_COUNT] }))
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
    /// The state of a key at internal variables; `None` unless it is one of the last.
    pub(super) fn find(&self, key: &SolutionKey<B>, variables: &[f64]) -> Option<BasicState<N, B>> {
        let stored = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if stored.variables != variables {
            return None;
        }
        let mut states = stored.states.iter().flatten();
        states.find(|(state_key, _)| state_key == key).map(|(_, state)| *state)
    }

    /// Stores a state in place of the oldest, and of all at other internal variables.
    pub(super) fn store(&self, key: SolutionKey<B>, variables: &[f64], state: BasicState<N, B>) {
        let stored = &mut *self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if stored.variables != variables {
            stored.variables.clear();
            stored.variables.extend_from_slice(variables);
            stored.states = [None; STATE_COUNT];
        }
        stored.states.rotate_right(1);
        stored.states[0] = Some((key, state));
    }
}
