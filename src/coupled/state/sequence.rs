//! States that follow one another.

use super::{Origin, State};
use std::ops::Range;

/// Checks that states belong to one simulation and that time increases.
#[derive(Debug, Clone)]
pub(crate) struct Sequence {
    origin: Origin,
    elements: usize,
    probes: usize,
    foundations: Vec<Range<usize>>,
    end: f64,
}

impl Sequence {
    /// Sequence of states that begins with `state`.
    pub(crate) fn new(state: &State) -> Self {
        Self {
            origin: state.origin,
            elements: state.contact.len(),
            probes: state.probes.len(),
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
        let elements = 0;
        let probes = 0;
        let foundations = Vec::new();
        Self { origin: Origin::new(), elements, probes, foundations, end }
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
        // The fields of a state are public and may have been changed.
        state.origin.is(self.origin)
            && state.contact.len() == self.elements
            && state.modes.len() == self.elements
            && state.probes.len() == self.probes
            && state.foundations.iter().map(|foundation| &foundation.elements).eq(&self.foundations)
            && state.time > self.end
    }

    /// Whether `state` is the next one; if so, stores its time as the last.
    pub(crate) fn takes(&mut self, state: &State) -> bool {
        let takes = self.is_next(state);
        if takes {
            self.end = state.time;
        }
        takes
    }

    /// Time of the last state, s.
    pub(crate) fn end(&self) -> f64 {
        self.end
    }
}
