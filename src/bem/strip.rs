//! Strips of contact elements on the surface, and their overlap.

use std::ops::Range;

use crate::error::{Error, Result, at_least, finite, positive, require};
use crate::fundamental::branch::KernelWeight;
use crate::geometry::{COMPONENTS_IN_PLANE, ContactElement, check_count};
use crate::structure::{Base, BaseNode, Structure, check_left_to_right, check_line};

/// Variation of element lengths along a strip.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum Grading {
    /// Equal lengths, which lead to the fastest history. Convergence of first order.
    Uniform,
    /// x = −cos(πk/Q): short elements at the ends, where tractions are singular. Convergence of second order.
    #[default]
    Cosine,
}

words! { pub(crate) Grading, "grading", {
    Uniform = "uniform",
    Cosine = "cosine",
} }

/// A foundation strip: an interval of the surface divided into elements.
///
/// ```
/// use basemat::bem::Strip;
/// let strip = Strip::graded(-5.0..5.0, 10)?;
/// assert_eq!(strip.elements().len(), 10);
/// assert_eq!(strip.elements()[9].right(), 5.0);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "StripForm"))]
pub struct Strip {
    nodes: Vec<f64>,
}

validated! {
    Strip as StripForm { nodes: Vec<f64> }
    => Strip::from_nodes(nodes)
}

impl Strip {
    /// Strip over `range` (m) divided into `count` elements.
    ///
    /// # Errors
    /// [`Error::Input`] for an empty or infinite range or no elements, [`Error::Memory`] for more elements than their
    /// matrices allow.
    pub fn new(range: Range<f64>, count: usize, grading: Grading) -> Result<Self> {
        finite("left end of the strip", range.start)?;
        finite("right end of the strip", range.end)?;
        positive("length of the strip", range.end - range.start)?;
        require("number of contact elements", count as f64, count > 0, "1 or more")?;
        check_count(count, COMPONENTS_IN_PLANE)?;
        let middle = 0.5 * (range.start + range.end);
        let half_length = 0.5 * (range.end - range.start);
        let mut nodes = vec![range.start];
        for k in 1..count {
            let fraction = k as f64 / count as f64;
            // With the sine of the angle from the middle, both halves are mirror images up to rounding.
            let relative_position = match grading {
                Grading::Uniform => 2.0 * fraction - 1.0,
                Grading::Cosine => (std::f64::consts::PI * (fraction - 0.5)).sin(),
            };
            nodes.push(middle + half_length * relative_position);
        }
        nodes.push(range.end);
        Self::from_nodes(nodes)
    }

    /// Strip of `count` elements over `range` (m), graded towards its ends ([`Grading::Cosine`]).
    ///
    /// # Errors
    /// As for [`Strip::new`].
    pub fn graded(range: Range<f64>, count: usize) -> Result<Self> {
        Self::new(range, count, Grading::Cosine)
    }

    /// Strip of `count` equal elements over `range` (m).
    ///
    /// # Errors
    /// As for [`Strip::new`].
    pub fn uniform(range: Range<f64>, count: usize) -> Result<Self> {
        Self::new(range, count, Grading::Uniform)
    }

    /// Strips of `count` elements under each foundation of `structure`, as wide as the foundation.
    ///
    /// Under a flexible base a strip has at least one element for each segment, because nodes
    /// between elements are supported by the structure alone.
    ///
    /// ```
    /// use basemat::bem::{Grading, Strip};
    /// use basemat::structure::RigidBlock;
    /// let block = RigidBlock::new(6.0, 4.0, 2400.0)?;
    /// let strips = Strip::under(&block, 12, Grading::Cosine)?;
    /// let elements = strips[0].elements();
    /// assert_eq!((strips.len(), elements[0].left(), elements[11].right()), (1, -3.0, 3.0));
    /// assert!(elements[0].length() < 0.15 * elements[6].length());
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// As for [`Strip::new`]; [`Error::Size`] for a structure without foundations or a foundation of fewer than two
    /// nodes, [`Error::Scene`] for a structure in plan.
    pub fn under(structure: &dyn Structure, count: usize, grading: Grading) -> Result<Vec<Self>> {
        let Base::Lines(lines) = structure.base() else {
            let needed =
                "must have a base of lines in the plane for strips: its base has faces, in plan";
            return Err(Error::Scene { quantity: "structure", needed });
        };
        at_least("list of foundations", lines.len(), 1)?;
        let mut strips = Vec::with_capacity(lines.len());
        for nodes in &lines {
            check_line(nodes)?;
            let left_end = nodes[0].x;
            let right_end = nodes[nodes.len() - 1].x;
            check_left_to_right(left_end, right_end)?;
            let element_count =
                if count == 0 { 0 } else { count.max(BaseNode::segment_count(nodes)) };
            strips.push(Self::new(left_end..right_end, element_count, grading)?);
        }
        Ok(strips)
    }

    /// Strip whose elements lie between neighbouring `nodes` (m).
    ///
    /// # Errors
    /// [`Error::Input`] unless the nodes are finite and increase; [`Error::Size`] for fewer than 2.
    pub fn from_nodes(nodes: Vec<f64>) -> Result<Self> {
        if nodes.len() < 2 {
            return Err(Error::Size {
                quantity: "list of strip nodes",
                found: nodes.len(),
                needed: 2,
            });
        }
        for pair in nodes.windows(2) {
            finite("strip node", pair[0])?;
            finite("strip node", pair[1])?;
            positive("length of a contact element", pair[1] - pair[0])?;
        }
        Ok(Self { nodes })
    }

    /// The element ends, from left to right, m.
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// The elements, from left to right.
    pub fn elements(&self) -> Vec<ContactElement> {
        self.nodes.windows(2).map(|ends| ContactElement::new(ends[0], ends[1])).collect()
    }
}

/// A single strip is accepted where several strips are.
impl AsRef<[Strip]> for Strip {
    fn as_ref(&self) -> &[Strip] {
        std::slice::from_ref(self)
    }
}

/// Relative rounding error of an offset, a sum of up to four element ends: eight units in the last place.
const OFFSET_ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Overlap lengths w(x) of a receiver and a source shifted by x, folded to x ≥ 0.
///
/// The even and the odd overlap are linear between `nodes`.
#[derive(Debug, Clone)]
pub(crate) struct Overlap {
    /// Offsets, ascending, m.
    pub(crate) nodes: Vec<f64>,
    /// Even overlap w(x) + w(−x) at the nodes, m.
    pub(crate) even_overlaps: Vec<f64>,
    /// Odd overlap w(x) − w(−x) at the nodes, m.
    pub(crate) odd_overlaps: Vec<f64>,
    /// Length of the receiver, m.
    pub(crate) receiver_length: f64,
    /// Whether the odd overlap is not zero everywhere.
    pub(crate) is_one_sided: bool,
}

/// Error for an element whose ends are not finite or not in order.
fn check_ends(element: ContactElement) -> Result<()> {
    finite("left end of an element", element.left())?;
    finite("right end of an element", element.right())?;
    positive("length of an element", element.length())?;
    Ok(())
}

impl Overlap {
    /// Overlap of two elements; an error if the ends of one are not finite or not in order.
    pub(crate) fn new(receiver: ContactElement, source: ContactElement) -> Result<Self> {
        check_ends(receiver)?;
        check_ends(source)?;
        let min_offset = receiver.left() - source.right();
        let max_offset = receiver.right() - source.left();
        let left_offset = receiver.left() - source.left();
        let right_offset = receiver.right() - source.right();
        let max_overlap = receiver.length().min(source.length());
        let largest_coordinate = [receiver.left(), receiver.right(), source.left(), source.right()]
            .iter()
            .fold(0.0_f64, |largest, coordinate| largest.max(coordinate.abs()));
        let rounding_length = OFFSET_ROUNDING * largest_coordinate;
        let mut nodes =
            vec![min_offset.abs(), left_offset.abs(), right_offset.abs(), max_offset.abs()];
        if min_offset < rounding_length && max_offset > -rounding_length {
            nodes.push(0.0);
        }
        nodes.sort_by(f64::total_cmp);
        // Nodes that differ only by rounding of the coordinates are one node.
        nodes.dedup_by(|next, previous| *next - *previous <= rounding_length);
        let overlap_length =
            |x: f64| (x - min_offset).min(max_offset - x).min(max_overlap).max(0.0);
        let mut even_overlaps = Vec::with_capacity(nodes.len());
        let mut odd_overlaps = Vec::with_capacity(nodes.len());
        for &x in &nodes {
            even_overlaps.push(overlap_length(x) + overlap_length(-x));
            odd_overlaps.push(overlap_length(x) - overlap_length(-x));
        }
        let is_one_sided = odd_overlaps.iter().any(|w: &f64| w.abs() > rounding_length);
        let receiver_length = receiver.length();
        Ok(Self { nodes, even_overlaps, odd_overlaps, receiver_length, is_one_sided })
    }

    /// Largest offset, m.
    pub(crate) fn max_offset(&self) -> f64 {
        self.nodes.last().copied().unwrap_or(0.0)
    }

    /// Smallest offset, m.
    pub(crate) fn min_offset(&self) -> f64 {
        self.nodes.first().copied().unwrap_or(0.0)
    }

    /// Segment between nodes that contains the offset `x`.
    fn segment(&self, x: f64) -> SegmentOfOffset {
        if x < self.min_offset() {
            return SegmentOfOffset::BeforeFirst;
        }
        match (1..self.nodes.len()).find(|&i| x < self.nodes[i]) {
            Some(end_node) => SegmentOfOffset::Inside(end_node - 1),
            None => SegmentOfOffset::BeyondLast,
        }
    }

    /// The polynomial A(u) of a step from t₀ to t₁ on the interval of u that contains `speed`.
    ///
    /// `step_ends`: t₀ and t₁ (m); `travel_per_step`: t₁ − t₀ (m), with the rounding error of one operation only; `is_odd`:
    /// odd instead of even overlap.
    pub(crate) fn passed_overlap(
        &self,
        step_ends: [f64; 2],
        travel_per_step: f64,
        speed: f64,
        is_odd: bool,
    ) -> PassedOverlap {
        let w = if is_odd { &self.odd_overlaps } else { &self.even_overlaps };
        let x = &self.nodes;
        let slope = |i: usize| (w[i + 1] - w[i]) / (x[i + 1] - x[i]);
        let line_through =
            |node: usize, i: usize| LinearOverlap { x: x[node], w: w[node], slope: slope(i) };
        let mut passed_overlap = PassedOverlap {
            has_one_segment: false,
            travel_per_step,
            start: step_ends[0],
            end: step_ends[1],
            whole_segments: 0.0,
            lower_line: LinearOverlap::default(),
            upper_line: LinearOverlap::default(),
        };
        let lower_segment = self.segment(step_ends[0] * speed);
        let upper_segment = self.segment(step_ends[1] * speed);
        if let (SegmentOfOffset::Inside(i), SegmentOfOffset::Inside(j)) =
            (lower_segment, upper_segment)
            && i == j
        {
            // The line starts at the end with the smaller w, so that w keeps its relative precision there.
            let node = if w[i].abs() <= w[i + 1].abs() { i } else { i + 1 };
            passed_overlap.has_one_segment = true;
            passed_overlap.lower_line = line_through(node, i);
            return passed_overlap;
        }
        let first_node = match lower_segment {
            SegmentOfOffset::Inside(i) => {
                passed_overlap.lower_line = line_through(i + 1, i);
                i + 1
            }
            SegmentOfOffset::BeforeFirst => 0,
            SegmentOfOffset::BeyondLast => return passed_overlap,
        };
        let last_node = match upper_segment {
            SegmentOfOffset::Inside(j) => {
                passed_overlap.upper_line = line_through(j, j);
                j
            }
            SegmentOfOffset::BeyondLast => x.len() - 1,
            SegmentOfOffset::BeforeFirst => return passed_overlap,
        };
        for i in first_node..last_node {
            passed_overlap.whole_segments += 0.5 * (x[i + 1] - x[i]) * (w[i] + w[i + 1]);
        }
        passed_overlap
    }
}

/// Position of an offset relative to the segments between the nodes of an [`Overlap`].
#[derive(Debug, Clone, Copy)]
enum SegmentOfOffset {
    BeforeFirst,
    /// Index of the segment.
    Inside(usize),
    BeyondLast,
}

/// Linear overlap w on one segment: a point on the line, and the slope.
#[derive(Debug, Clone, Copy, Default)]
struct LinearOverlap {
    /// Offset of the point, m.
    x: f64,
    /// Overlap at the point, m.
    w: f64,
    /// Derivative of the overlap with respect to the offset.
    slope: f64,
}

/// Overlap that a wave of speed u passes during a step, a polynomial in u.
///
/// A(u) = ∫ w(x) dx over u·t₀ < x < u·t₁, valid for the u at which both limits lie in the same segments of w.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PassedOverlap {
    /// Whether both limits lie in the same segment.
    has_one_segment: bool,
    /// Difference t₁ − t₀, m.
    travel_per_step: f64,
    /// Start t₀ of the step, m.
    start: f64,
    /// End t₁ of the step, m.
    end: f64,
    /// Integral over the whole segments between the limits, m².
    whole_segments: f64,
    /// Line on the lower limit's segment, or on the segment of both limits.
    lower_line: LinearOverlap,
    /// Line on the upper limit's segment.
    upper_line: LinearOverlap,
}

impl KernelWeight for PassedOverlap {
    /// The passed overlap A(u), m².
    fn value(&self, u: f64) -> f64 {
        if self.has_one_segment {
            return u * self.value_over_speed(u);
        }
        let lower_length = self.lower_line.x - self.start * u;
        let upper_length = self.end * u - self.upper_line.x;
        self.whole_segments
            + lower_length * (self.lower_line.w - 0.5 * self.lower_line.slope * lower_length)
            + upper_length * (self.upper_line.w + 0.5 * self.upper_line.slope * upper_length)
    }

    /// The ratio A(u)/u, m².
    fn value_over_speed(&self, u: f64) -> f64 {
        if self.has_one_segment {
            let middle = 0.5 * (self.start + self.end);
            let LinearOverlap { x, w, slope } = self.lower_line;
            self.travel_per_step * (w + slope * (middle * u - x))
        } else {
            self.value(u) / u
        }
    }

    fn vanishes_at_zero(&self) -> bool {
        self.has_one_segment
    }
}
