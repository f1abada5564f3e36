//! Snapshots of the base and of the structure, every so many steps.

use crate::coupled::State;
use crate::interface::{ContactState, Mode};

/// The base at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ContactFrame<'a> {
    /// Time, s.
    pub time: f64,
    /// Opening and total traction of each element.
    pub states: &'a [ContactState],
    /// Mode of each element.
    pub modes: &'a [Mode],
}

/// The structure at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct MotionFrame<'a> {
    /// Time, s.
    pub time: f64,
    /// Degrees of freedom as changes against the static state, relative to the free field's translation, m
    /// and rad.
    pub displacement: &'a [f64],
    /// Their total rates.
    pub velocity: &'a [f64],
    /// Mean displacement [horizontal, up] of the free field under the base, m.
    pub free_field: [f64; 2],
}

/// Frames of the base, end to end.
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub(super) struct ContactFrames {
    pub(super) every: usize,
    times: Vec<f64>,
    states: Vec<ContactState>,
    modes: Vec<Mode>,
}

impl ContactFrames {
    pub(super) fn new(every: usize) -> Self {
        Self { every, ..Self::default() }
    }

    pub(super) fn keep(&mut self, state: &State) {
        self.times.push(state.time);
        self.states.extend_from_slice(&state.contact);
        self.modes.extend_from_slice(&state.modes);
    }

    /// For so many more steps of `count` elements each.
    pub(super) fn reserve(&mut self, steps: usize, count: usize) {
        let frames = steps / self.every + 1;
        self.times.reserve(frames);
        let _ = self.states.try_reserve(frames.saturating_mul(count));
        let _ = self.modes.try_reserve(frames.saturating_mul(count));
    }

    /// Whether these are frames of `count` elements each.
    #[cfg(feature = "serde")]
    pub(super) fn is_whole(&self, count: usize) -> bool {
        let needed = self.times.len().checked_mul(count);
        self.every > 0 && [self.states.len(), self.modes.len()].map(Some) == [needed; 2]
    }

    /// Frames of `count` elements each.
    pub(super) fn frames(&self, count: usize) -> impl ExactSizeIterator<Item = ContactFrame<'_>> {
        self.times.iter().enumerate().map(move |(k, &time)| {
            let range = k * count..(k + 1) * count;
            ContactFrame { time, states: &self.states[range.clone()], modes: &self.modes[range] }
        })
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.times[..]) + size_of_val(&self.states[..]) + size_of_val(&self.modes[..])
    }
}

/// Frames of the structure, end to end.
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub(super) struct MotionFrames {
    pub(super) every: usize,
    times: Vec<f64>,
    displacement: Vec<f64>,
    velocity: Vec<f64>,
    free_field: Vec<[f64; 2]>,
}

impl MotionFrames {
    pub(super) fn new(every: usize) -> Self {
        Self { every, ..Self::default() }
    }

    pub(super) fn keep(&mut self, state: &State) {
        self.times.push(state.time);
        self.displacement.extend_from_slice(state.displacement());
        self.velocity.extend_from_slice(state.velocity());
        self.free_field.push(state.free_field);
    }

    /// For so many more steps of `count` degrees of freedom each.
    pub(super) fn reserve(&mut self, steps: usize, count: usize) {
        let frames = steps / self.every + 1;
        self.times.reserve(frames);
        // What does not fit now may never be needed.
        let _ = self.displacement.try_reserve(frames.saturating_mul(count));
        let _ = self.velocity.try_reserve(frames.saturating_mul(count));
        self.free_field.reserve(frames);
    }

    /// Whether these are frames of `count` degrees of freedom each.
    #[cfg(feature = "serde")]
    pub(super) fn is_whole(&self, count: usize) -> bool {
        let needed = self.times.len().checked_mul(count);
        self.every > 0
            && self.free_field.len() == self.times.len()
            && [self.displacement.len(), self.velocity.len()].map(Some) == [needed; 2]
    }

    /// Frames of `count` degrees of freedom each.
    pub(super) fn frames(&self, count: usize) -> impl ExactSizeIterator<Item = MotionFrame<'_>> {
        self.times.iter().enumerate().map(move |(k, &time)| {
            let range = k * count..(k + 1) * count;
            let displacement = &self.displacement[range.clone()];
            let (velocity, free_field) = (&self.velocity[range], self.free_field[k]);
            MotionFrame { time, displacement, velocity, free_field }
        })
    }

    pub(super) fn bytes(&self) -> usize {
        8 * (3 * self.times.len() + self.displacement.len() + self.velocity.len())
    }
}
