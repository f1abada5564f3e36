//! Foundations that extend beyond the ground's elements.

use super::PlacedBase;
use crate::geometry::{axis_name, enclosing_interval, span};

/// Fraction of a foundation's length that may extend beyond the elements.
///
/// Its effect on the response is small.
const MAX_UNCOVERED_FRACTION: f64 = 0.1;

impl PlacedBase {
    /// Lengths by which foundations extend too far beyond the ground's elements.
    ///
    /// An entry is the foundation's number, in plan the axis, and the overhang, m. An overhang is too long if it exceeds
    /// the longest side of the elements along the axis, or a tenth of the foundation.
    pub(crate) fn long_overhangs(&self) -> Vec<(usize, Option<char>, f64)> {
        let mut overhangs = Vec::new();
        for (foundation, (nodes, elements)) in self.foundations().enumerate() {
            for axis in self.layout().axes() {
                let ends =
                    self.elements[elements.clone()].iter().map(|element| element.ends()[axis]);
                let sides = ends.clone().map(|[low, high]| high - low);
                let longest_side = sides.fold(0.0, |longest: f64, side| side.max(longest));
                let edges = enclosing_interval(ends);
                let node_ends = span(nodes.iter().map(|node| node.place()[axis]));
                let limit =
                    longest_side.min(MAX_UNCOVERED_FRACTION * (node_ends[1] - node_ends[0]));
                let overhang = (edges[0] - node_ends[0]).max(node_ends[1] - edges[1]);
                if overhang > limit {
                    let axis_letter = axis_name(self.elements.is_plan(), axis);
                    overhangs.push((foundation, axis_letter, overhang));
                }
            }
        }
        overhangs
    }
}
