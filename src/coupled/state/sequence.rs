//! Sequence of states of one simulation.

use super::{SimulationId, State};
use std::ops::Range;

/// Checks that states belong to one simulation and that their times increase.
#[derive(Debug, Clone)]
pub(crate) struct StateSequence {
    simulation: SimulationId,
    element_count: usize,
    probe_count: usize,
    /// Elements of each foundation.
    foundation_elements: Vec<Range<usize>>,
    /// Time of the last state, s.
    last_time: f64,
}

impl StateSequence {
    /// Sequence of states that begins with `state`.
    pub(crate) fn new(state: &State) -> Self {
        Self {
            simulation: state.simulation,
            element_count: state.contact.len(),
            probe_count: state.probes.len(),
            foundation_elements: state
                .foundations
                .iter()
                .map(|foundation| foundation.elements.clone())
                .collect(),
            last_time: state.time,
        }
    }

    /// Sequence that accepts no state, for a run read from a file without the time of its last state.
    #[cfg(feature = "serde")]
    pub(crate) fn closed() -> Self {
        Self::closed_at(f64::INFINITY)
    }

    /// Sequence that accepts no further state; the last one was at `last_time`, s.
    #[cfg(feature = "serde")]
    pub(crate) fn closed_at(last_time: f64) -> Self {
        Self {
            simulation: SimulationId::new(),
            element_count: 0,
            probe_count: 0,
            foundation_elements: Vec::new(),
            last_time,
        }
    }

    /// Writes only the time of the last state.
    #[cfg(feature = "serde")]
    pub(crate) fn write_end<S: serde::Serializer>(
        &self,
        serializer: S,
    ) -> std::result::Result<S::Ok, S::Error> {
        serializer.serialize_f64(self.last_time)
    }

    /// Whether `state` belongs to the same simulation and is later than the last one.
    pub(crate) fn is_next(&self, state: &State) -> bool {
        // A user may have changed the public fields of a state.
        state.simulation == self.simulation
            && state.contact.len() == self.element_count
            && state.modes.len() == self.element_count
            && state.probes.len() == self.probe_count
            && state
                .foundations
                .iter()
                .map(|foundation| &foundation.elements)
                .eq(&self.foundation_elements)
            && state.time > self.last_time
    }

    /// Stores the time of `state` if it is the next one.
    ///
    /// Returns whether it is.
    pub(crate) fn accept(&mut self, state: &State) -> bool {
        let is_next = self.is_next(state);
        if is_next {
            self.last_time = state.time;
        }
        is_next
    }

    /// Time of the last state, s.
    pub(crate) fn last_time(&self) -> f64 {
        self.last_time
    }
}
