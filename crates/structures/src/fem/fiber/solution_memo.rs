//! Last states of a beam by forces, for further evaluations at the same deformations.

use std::fmt;
use std::sync::{Mutex, PoisonError};

use super::basic_state::BasicState;

/// Number of states: at mid-step and at the end of a step.
const STATE_COUNT: usize = 2;

/// What a state of a beam by forces depends on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SolutionKey<const B: usize> {
    /// Number of the committed deformations so far, by [`next_history`].
    pub(super) history: f64,
    /// Length, m.
    pub(super) length: f64,
    /// Basic deformations.
    pub(super) v: [f64; B],
}

/// A state with its key.
type KeyedState<const N: usize, const B: usize> = (SolutionKey<B>, BasicState<N, B>);

/// Last states that a beam by forces has solved for.
///
/// Force, energy, remainder and commit of a step are evaluated at two displacements. Each is solved once.
#[derive(Default)]
pub(in crate::fem) struct SolutionMemo<const N: usize, const B: usize>(
    Mutex<[Option<KeyedState<N, B>>; STATE_COUNT]>,
);

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
    /// The state of a key; `None` unless it is one of the last.
    pub(super) fn find(&self, key: &SolutionKey<B>) -> Option<BasicState<N, B>> {
        let states = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let mut states = states.iter().flatten();
        states.find(|(state_key, _)| state_key == key).map(|(_, state)| *state)
    }

    /// Stores a state in place of the oldest.
    pub(super) fn store(&self, key: SolutionKey<B>, state: BasicState<N, B>) {
        let mut states = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        states.rotate_right(1);
        states[0] = Some((key, state));
    }
}

/// Number of a sequence of committed deformations, from that of the sequence before the last.
///
/// Equal sequences have equal numbers, on which all internal variables depend. Different ones have different numbers, but for
/// one of 2⁵³ pairs.
pub(super) fn next_history<const B: usize>(history: f64, v: &[f64; B]) -> f64 {
    let mut bits = history.to_bits();
    for value in v {
        bits = mixed(bits ^ value.to_bits());
    }
    // An integer that a number of 53 bits represents exactly.
    (bits >> 11) as f64
}

/// Finaliser of SplitMix64 (Steele, Lea and Flood 2014): each bit depends on all.
fn mixed(bits: u64) -> u64 {
    let bits = bits.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}
