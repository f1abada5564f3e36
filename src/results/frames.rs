//! Snapshots of the base, of joints and of the structure at regular steps.

use std::collections::TryReserveError;
use std::ops::Range;

use crate::coupled::State;
use crate::interface::{ContactState, Mode};

/// The base, or a joint, at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ContactFrame<'a> {
    /// Time, s.
    pub time: f64,
    /// Gap, slip and total tractions of each element.
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

/// Frames of the base and its joints, one after the other in each list.
///
/// A frame has the elements of the base, then those of the joints.
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
        for joint in &state.joints {
            self.states.extend_from_slice(&joint.contact);
            self.modes.extend_from_slice(&joint.modes);
        }
    }

    /// Reserves memory for `frame_count` more frames of `element_count` elements each.
    pub(super) fn reserve(
        &mut self,
        frame_count: usize,
        element_count: usize,
    ) -> Result<(), TryReserveError> {
        reserve(&mut self.times, frame_count)?;
        reserve(&mut self.states, frame_count.saturating_mul(element_count))?;
        reserve(&mut self.modes, frame_count.saturating_mul(element_count))
    }

    /// Bytes of a frame of `element_count` elements.
    pub(super) fn frame_bytes(element_count: usize) -> usize {
        size_of::<f64>() + element_count * (size_of::<ContactState>() + size_of::<Mode>())
    }

    /// Whether the lists have a number for each of `element_count` elements in each frame.
    #[cfg(feature = "serde")]
    pub(super) fn is_whole(&self, element_count: usize) -> bool {
        let needed_length = self.times.len().checked_mul(element_count);
        self.every > 0 && [self.states.len(), self.modes.len()].map(Some) == [needed_length; 2]
    }

    /// Some elements of each frame, out of `element_count`.
    pub(super) fn frames(
        &self,
        elements: Range<usize>,
        element_count: usize,
    ) -> impl ExactSizeIterator<Item = ContactFrame<'_>> {
        self.times.iter().enumerate().map(move |(k, &time)| {
            let frame_start = k * element_count;
            let range = frame_start + elements.start..frame_start + elements.end;
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

    /// Reserves memory for `frame_count` more frames of `dof_count` degrees of freedom each.
    pub(super) fn reserve(
        &mut self,
        frame_count: usize,
        dof_count: usize,
    ) -> Result<(), TryReserveError> {
        reserve(&mut self.times, frame_count)?;
        reserve(&mut self.displacement, frame_count.saturating_mul(dof_count))?;
        reserve(&mut self.velocity, frame_count.saturating_mul(dof_count))?;
        reserve(&mut self.free_field, frame_count)?;
        reserve(&mut self.free_field_across, frame_count)
    }

    /// Bytes of a frame of `dof_count` degrees of freedom.
    pub(super) fn frame_bytes(dof_count: usize) -> usize {
        // Time and three components of the free field; displacements and velocities.
        (4 + 2 * dof_count) * size_of::<f64>()
    }

    /// Whether the lists have a number for each of `dof_count` degrees of freedom in each frame.
    #[cfg(feature = "serde")]
    pub(super) fn is_whole(&self, dof_count: usize) -> bool {
        let needed_length = self.times.len().checked_mul(dof_count);
        self.every > 0
            && self.free_field.len() == self.times.len()
            && [0, self.times.len()].contains(&self.free_field_across.len())
            && [0, dof_count].contains(&self.static_displacement.len())
            && [self.displacement.len(), self.velocity.len()].map(Some) == [needed_length; 2]
    }

    /// Frames of `dof_count` degrees of freedom each.
    pub(super) fn frames(
        &self,
        dof_count: usize,
    ) -> impl ExactSizeIterator<Item = MotionFrame<'_>> {
        self.times.iter().enumerate().map(move |(k, &time)| {
            let range = k * dof_count..(k + 1) * dof_count;
            let displacement = &self.displacement[range.clone()];
            let velocity = &self.velocity[range];
            let free_field = self.free_field[k];
            // Files of earlier versions have no motion along y.
            let free_field_across = self.free_field_across.get(k).copied().unwrap_or(0.0);
            MotionFrame { time, displacement, velocity, free_field, free_field_across }
        })
    }

    pub(super) fn bytes(&self) -> usize {
        let lengths = [&self.static_displacement, &self.displacement, &self.velocity].map(Vec::len);
        // Each frame has its time and three components of the free field.
        size_of::<f64>() * (4 * self.times.len() + lengths.iter().sum::<usize>())
    }
}

/// Reserves memory for `additional` entries.
///
/// The list doubles, so that it is seldom moved. It grows by an eighth if twice as much does not fit. If that fails too,
/// enough memory remains to report the error.
pub(super) fn reserve<T>(values: &mut Vec<T>, additional: usize) -> Result<(), TryReserveError> {
    values
        .try_reserve(additional)
        .or_else(|_| values.try_reserve_exact(additional.max(values.len() / 8)))
}
