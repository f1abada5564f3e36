//! Straight boundary elements.

use crate::error::{Error, MemoryError, Result, finite, memory, positive, require};

/// A straight boundary element.
///
/// The soil is on the right-hand side when moving from `from` to `to`, seen with x to the right and z
/// **down** (on a flat surface: from left to right).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// First end, (x, z), m.
    pub from: [f64; 2],
    /// Second end, (x, z), m.
    pub to: [f64; 2],
}

impl Segment {
    /// Length, m.
    pub fn length(&self) -> f64 {
        (self.to[0] - self.from[0]).hypot(self.to[1] - self.from[1])
    }

    /// Midpoint (x, z), m: the collocation point of the boundary equation.
    pub fn center(&self) -> [f64; 2] {
        [0.5 * (self.from[0] + self.to[0]), 0.5 * (self.from[1] + self.to[1])]
    }

    /// Unit vector (x, z) along the element.
    pub fn direction(&self) -> [f64; 2] {
        let length = self.length();
        [(self.to[0] - self.from[0]) / length, (self.to[1] - self.from[1]) / length]
    }

    /// Unit normal (x, z) pointing out of the soil: (0, −1) on a flat surface.
    pub fn normal(&self) -> [f64; 2] {
        let direction = self.direction();
        [direction[1], -direction[0]]
    }

    /// Distance (m) of a point (x, z) from the element.
    fn distance(&self, point: [f64; 2]) -> f64 {
        let d = self.direction();
        let n = self.normal();
        let y = self.center();
        let offset = [point[0] - y[0], point[1] - y[1]];
        let overhang = (offset[0] * d[0] + offset[1] * d[1]).abs() - 0.5 * self.length();
        overhang.max(0.0).hypot(offset[0] * n[0] + offset[1] * n[1])
    }
}

/// Memory for each pair of elements, bytes: eight dense operators of 2 × 2 numbers.
const BYTES_PER_PAIR: f64 = 256.0;

/// Error if the operators between `segment_count` elements exceed the memory limit.
pub(super) fn check_segment_count(segment_count: usize) -> std::result::Result<(), MemoryError> {
    let count = segment_count as f64;
    memory::check("boundary elements", count, BYTES_PER_PAIR * count * count)
}

/// Smallest distance from a midpoint of another element, relative to the shorter length.
const MIN_DISTANCE_RATIO: f64 = 1e-6;

/// Error unless there are elements, all have length, and none passes through the midpoint of another.
pub(super) fn check_segments(segments: &[Segment]) -> Result<()> {
    if segments.is_empty() {
        return Err(Error::Size { quantity: "list of boundary elements", found: 0, needed: 1 });
    }
    check_segment_count(segments.len())?;
    for segment in segments {
        for coordinate in segment.from.into_iter().chain(segment.to) {
            finite("end of a boundary element", coordinate)?;
        }
        positive("length of a boundary element", segment.length())?;
    }
    for (q, source) in segments.iter().enumerate() {
        for (p, receiver) in segments.iter().enumerate() {
            let distance = source.distance(receiver.center());
            let min_distance = MIN_DISTANCE_RATIO * source.length().min(receiver.length());
            let quantity = "distance of a boundary element from the midpoint of another";
            let is_separate = p == q || distance >= min_distance;
            require(quantity, distance, is_separate, "at least 1e-6 of the shorter")?;
        }
    }
    Ok(())
}
