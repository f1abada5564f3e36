//! States that follow one another.

use super::{Origin, State};
use std::ops::Range;

/// Checks that states belong to one simulation and that time increases.
#[derive(Debug, Clone)]
pub(crate) struct Sequence {
    origin: Origin,
    element_count: usize,
    probe_count: usize,
    /// Elements of each foundation.
    foundations: Vec<Range<usize>>,
    /// Time of the last state, s.
    end: f64,
}

impl Sequence {
    /// Sequence of states that begins with `state`.
    pub(crate) fn new(state: &State) -> Self {
        Self {
            origin: state.origin,
            element_count: state.contact.len(),
            probe_count: state.probes.len(),
            foundations: state
                .foundations
                .iter()
                .map(|foundation| foundation.elements.clone())
                .collect(),
            end: state.time,
        }
    }

    /// Sequence that accepts no state, for a run read from a file.
    #[cfg(feature = "serde")]
    pub(crate) fn closed() -> Self {
        Self::ended(f64::INFINITY)
    }

    /// Sequence that accepts no state; its last state was at `end`, s.
    #[cfg(feature = "serde")]
    pub(crate) fn ended(end: f64) -> Self {
        Self {
            origin: Origin::new(),
            element_count: 0,
            probe_count: 0,
            foundations: Vec::new(),
            end,
        }
    }

    /// Writes only the time of the last state.
    #[cfg(feature = "serde")]
    pub(crate) fn write_end<S: serde::Serializer>(
        &self,
        to: S,
    ) -> std::result::Result<S::Ok, S::Error> {
        to.serialize_f64(self.end)
    }

    /// Whether `state` belongs to the same simulation and is later than the last one.
    pub(crate) fn is_next(&self, state: &State) -> bool {
        // The caller may have changed the public fields of a state.
        state.origin.is_same(self.origin)
            && state.contact.len() == self.element_count
            && state.modes.len() == self.element_count
            && state.probes.len() == self.probe_count
            && state.foundations.iter().map(|foundation| &foundation.elements).eq(&self.foundations)
            && state.time > self.end
    }

    /// Adds `state` if it is the next one, and returns whether it is.
    pub(crate) fn accept(&mut self, state: &State) -> bool {
        let is_next = self.is_next(state);
        if is_next {
            self.end = state.time;
        }
        is_next
    }

    /// Time of the last state, s.
    pub(crate) fn end(&self) -> f64 {
        self.end
    }
}
