//! Snapshots of the base and of the structure at regular steps.

use std::collections::TryReserveError;

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
    /// Total velocities of the degrees of freedom, m/s and rad/s.
    pub velocity: &'a [f64],
    /// Mean displacement [horizontal, up] of the free field under the base, m.
    pub free_field: [f64; 2],
    /// In plan: mean displacement of the free field along y, m; zero in the plane.
    pub free_field_across: f64,
}

/// Frames of the base, one after the other in each list.
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub(super) struct ContactFrames {
    /// Number of steps from frame to frame.
    pub(super) every: usize,
    times: Vec<f64>,
    states: Vec<ContactState>,
    modes: Vec<Mode>,
}

impl ContactFrames {
    pub(super) fn new(every: usize) -> Self {
        Self { every, ..Self::default() }
    }

    /// Appends a frame.
    pub(super) fn store(&mut self, state: &State) {
        self.times.push(state.time);
        self.states.extend_from_slice(&state.contact);
        self.modes.extend_from_slice(&state.modes);
    }

    /// Reserves memory for `frames` more frames of `count` elements each.
    pub(super) fn reserve(&mut self, frames: usize, count: usize) -> Result<(), TryReserveError> {
        reserve(&mut self.times, frames)?;
        reserve(&mut self.states, frames.saturating_mul(count))?;
        reserve(&mut self.modes, frames.saturating_mul(count))
    }

    /// Bytes of a frame of `count` elements.
    pub(super) fn frame_bytes(count: usize) -> usize {
        size_of::<f64>() + count * (size_of::<ContactState>() + size_of::<Mode>())
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

/// Frames of the structure, one after the other in each list.
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub(super) struct MotionFrames {
    /// Number of steps from frame to frame.
    pub(super) every: usize,
    /// Static displacement of the degrees of freedom; empty after reading a file without it.
    #[cfg_attr(feature = "serde", serde(default))]
    pub(super) static_displacement: Vec<f64>,
    times: Vec<f64>,
    displacement: Vec<f64>,
    velocity: Vec<f64>,
    free_field: Vec<[f64; 2]>,
    /// Mean displacement of the free field along y, m, one for each frame; empty after reading a file without it.
    #[cfg_attr(feature = "serde", serde(default))]
    free_field_across: Vec<f64>,
}

impl MotionFrames {
    pub(super) fn new(every: usize, static_displacement: &[f64]) -> Self {
        let static_displacement = static_displacement.to_vec();
        Self { every, static_displacement, ..Self::default() }
    }

    /// Appends a frame.
    pub(super) fn store(&mut self, state: &State) {
        self.times.push(state.time);
        self.displacement.extend_from_slice(state.displacement());
        self.velocity.extend_from_slice(state.velocity());
        self.free_field.push(state.free_field);
        self.free_field_across.push(state.free_field_across);
    }

    /// Reserves memory for `frames` more frames of `count` degrees of freedom each.
    pub(super) fn reserve(&mut self, frames: usize, count: usize) -> Result<(), TryReserveError> {
        reserve(&mut self.times, frames)?;
        reserve(&mut self.displacement, frames.saturating_mul(count))?;
        reserve(&mut self.velocity, frames.saturating_mul(count))?;
        reserve(&mut self.free_field, frames)?;
        reserve(&mut self.free_field_across, frames)
    }

    /// Bytes of a frame of `count` degrees of freedom.
    pub(super) fn frame_bytes(count: usize) -> usize {
        (4 + 2 * count) * size_of::<f64>()
    }

    /// Whether these are frames of `count` degrees of freedom each.
    #[cfg(feature = "serde")]
    pub(super) fn is_whole(&self, count: usize) -> bool {
        let needed = self.times.len().checked_mul(count);
        self.every > 0
            && self.free_field.len() == self.times.len()
            && [0, self.times.len()].contains(&self.free_field_across.len())
            && [0, count].contains(&self.static_displacement.len())
            && [self.displacement.len(), self.velocity.len()].map(Some) == [needed; 2]
    }

    /// Frames of `count` degrees of freedom each.
    pub(super) fn frames(&self, count: usize) -> impl ExactSizeIterator<Item = MotionFrame<'_>> {
        self.times.iter().enumerate().map(move |(k, &time)| {
            let range = k * count..(k + 1) * count;
            let displacement = &self.displacement[range.clone()];
            let velocity = &self.velocity[range];
            let free_field = self.free_field[k];
            // Files of earlier versions have none.
            let free_field_across = self.free_field_across.get(k).copied().unwrap_or(0.0);
            MotionFrame { time, displacement, velocity, free_field, free_field_across }
        })
    }

    pub(super) fn bytes(&self) -> usize {
        let numbers = [&self.static_displacement, &self.displacement, &self.velocity].map(Vec::len);
        8 * (4 * self.times.len() + numbers.iter().sum::<usize>())
    }
}

/// Reserves memory for `more` entries.
///
/// The list doubles, so that it is seldom moved, or grows by an eighth if twice as much does not fit. If that fails too,
/// enough memory is left to report the error.
pub(super) fn reserve<T>(list: &mut Vec<T>, more: usize) -> Result<(), TryReserveError> {
    list.try_reserve(more).or_else(|_| list.try_reserve_exact(more.max(list.len() / 8)))
}
