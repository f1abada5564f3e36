//! Lines of a mesh of soil around a foundation: short elements at the ends of the foundation, where stresses are singular.

/// Length of the element at an end of the foundation, over its half width and the inverse square of the number of elements.
const END_ELEMENT_FACTOR: f64 = 1.8;
/// Longest element, over the mean length of those under the foundation.
///
/// The error in the stiffness of the foundation depends on the elements at its ends, not on those between them.
const LONGEST_ELEMENT_RATIO: f64 = 1.5;
/// Ratio of the lengths of neighbouring elements beside and below the foundation.
const GROWTH_RATIO: f64 = 2.5;
/// Number of halvings that find a ratio of lengths to rounding.
const HALVING_COUNT: usize = 60;

/// Division of the surface under a foundation, and of the soil beside and below it.
#[derive(Debug, Clone, Copy)]
pub(super) struct BoxLines {
    /// Half the width of the foundation, m.
    pub(super) half_width: f64,
    /// Number of elements under the foundation, even.
    pub(super) element_count: usize,
}

impl BoxLines {
    /// Length of the element at an end of the foundation, m.
    fn end_element(&self) -> f64 {
        let ratio = END_ELEMENT_FACTOR / (self.element_count as f64).powi(2);
        self.half_width * ratio.min(2.0 / self.element_count as f64)
    }

    /// Length of the longest element, m.
    fn longest_element(&self) -> f64 {
        LONGEST_ELEMENT_RATIO * 2.0 * self.half_width / self.element_count as f64
    }

    /// Distances of the lines of half of the foundation from its end, m; the last one is the middle.
    fn foundation_distances(&self) -> Vec<f64> {
        let count = self.element_count / 2;
        let first = self.end_element();
        let lengths = |ratio: f64| -> Vec<f64> {
            let length = |k| (first * ratio.powf(k as f64)).min(self.longest_element());
            (0..count).map(length).collect()
        };
        // The lengths grow by a ratio with which they add up to the half width; their sum ascends with it.
        let mut bounds = [1.0, self.half_width / first];
        for _ in 0..HALVING_COUNT {
            let middle = 0.5 * (bounds[0] + bounds[1]);
            let is_above = lengths(middle).iter().sum::<f64>() > self.half_width;
            bounds[usize::from(is_above)] = middle;
        }
        scaled_ends(&lengths(bounds[0]), self.half_width)
    }

    /// Vertical lines of a box between x = −`box_half_width` and `box_half_width`, m.
    pub(super) fn x_lines(&self, box_half_width: f64) -> Vec<f64> {
        let side = self.distances(&[box_half_width - self.half_width]);
        let mut lines: Vec<f64> = side.iter().rev().map(|end| self.half_width + end).collect();
        // The last line meets the wall of the trench to the last bit.
        lines[0] = box_half_width;
        lines.push(self.half_width);
        let under = self.foundation_distances();
        lines.extend(under[..under.len() - 1].iter().map(|end| self.half_width - end));
        let mirrored: Vec<f64> = lines.iter().rev().copied().collect();
        let mut whole: Vec<f64> = lines.iter().map(|x| -x).collect();
        whole.push(0.0);
        whole.extend(mirrored);
        whole
    }

    /// Distances from the foundation of lines in parts that end at `part_ends`, ascending, m.
    ///
    /// The elements grow with the distance; each part ends at a line.
    pub(super) fn distances(&self, part_ends: &[f64]) -> Vec<f64> {
        let mut distances = Vec::new();
        let mut length = self.end_element();
        let mut start = 0.0;
        for &end in part_ends {
            let mut lengths = Vec::new();
            let mut sum = 0.0;
            // An element that would be shorter than half its length joins its neighbour.
            while lengths.is_empty() || end - start - sum > 0.5 * length {
                lengths.push(length);
                sum += length;
                length = (GROWTH_RATIO * length).min(self.longest_element());
            }
            let part = scaled_ends(&lengths, end - start);
            distances.extend(part[..part.len() - 1].iter().map(|distance| start + distance));
            distances.push(end);
            start = end;
        }
        distances
    }

    /// Largest number of lines in parts of this total length, m.
    pub(super) fn line_bound(&self, length: f64, part_count: usize) -> f64 {
        let growing_count = (self.longest_element() / self.end_element()).log(GROWTH_RATIO) + 2.0;
        length / self.longest_element() + growing_count + part_count as f64
    }
}

/// Ends of elements with these relative lengths, which fill `length`, m.
fn scaled_ends(relative_lengths: &[f64], length: f64) -> Vec<f64> {
    let total: f64 = relative_lengths.iter().sum();
    let mut sum = 0.0;
    let mut ends = Vec::with_capacity(relative_lengths.len());
    for relative_length in relative_lengths {
        sum += relative_length;
        ends.push(sum / total * length);
    }
    ends
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_symmetric_and_meet_both_ends() {
        for element_count in [2, 4, 6, 12] {
            let lines = BoxLines { half_width: 3.0, element_count }.x_lines(7.0);
            assert!(lines.windows(2).all(|pair| pair[0] < pair[1]), "{lines:?}");
            assert!([-7.0, -3.0, 0.0, 3.0, 7.0].iter().all(|x| lines.contains(x)), "{lines:?}");
            assert!(lines.iter().zip(lines.iter().rev()).all(|(left, right)| *left == -right));
            let under = lines.iter().filter(|x| x.abs() < 3.0).count();
            assert_eq!(under, element_count - 1);
        }
    }

    #[test]
    fn lengths_grow_from_the_ends_of_the_foundation() {
        let lines = BoxLines { half_width: 3.0, element_count: 6 };
        let end_element = 1.8 * 3.0 / 36.0;
        let under = lines.foundation_distances();
        let expected_ends = [end_element, 1.5, 3.0];
        for (end, expected) in under.iter().zip(expected_ends) {
            assert!((end - expected).abs() < 1e-12, "{under:?}");
        }
        // Three elements that grow by 2.5, and one of the largest length, 1.5 m, stretched to 3 m.
        let below = lines.distances(&[3.0]);
        assert_eq!(below.len(), 4);
        let sum = end_element * (1.0 + 2.5 + 6.25) + 1.5;
        assert!((below[0] - end_element * 3.0 / sum).abs() < 1e-12, "{below:?}");
        // A boundary between layers is a line; a thin layer is one element.
        let layered = lines.distances(&[1.0, 1.05, 6.0]);
        assert!(layered.contains(&1.0) && layered.contains(&1.05), "{layered:?}");
        assert!(layered.windows(2).all(|pair| pair[0] < pair[1]), "{layered:?}");
        assert!(layered.len() as f64 <= lines.line_bound(6.0, 3));
    }
}
