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
    /// Equal lengths: fastest history, convergence of first order.
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
            // The sine of the distance from the middle keeps both halves mirror images to rounding.
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
            let first = nodes[0].x;
            let last = nodes[nodes.len() - 1].x;
            check_left_to_right(first, last)?;
            let element_count = if count == 0 { 0 } else { count.max(BaseNode::segments(nodes)) };
            strips.push(Self::new(first..last, element_count, grading)?);
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

/// Lets a single strip be passed where several are accepted.
impl AsRef<[Strip]> for Strip {
    fn as_ref(&self) -> &[Strip] {
        std::slice::from_ref(self)
    }
}

// Geometry of a pair of elements: the length of overlap at every offset, and its integral over the offsets that a wave
// of a certain speed passes during a step.

/// Overlap lengths w(x) of a receiver and a source shifted by x, folded to x ≥ 0.
///
/// Both foldings are linear between `nodes`.
#[derive(Debug, Clone)]
pub(crate) struct Overlap {
    /// Offsets, ascending, m.
    pub(crate) nodes: Vec<f64>,
    /// w(x) + w(−x) at the nodes, m.
    pub(crate) even: Vec<f64>,
    /// w(x) − w(−x) at the nodes, m.
    pub(crate) odd: Vec<f64>,
    /// Length of the receiver, m.
    pub(crate) length: f64,
    /// Whether the odd folding is not zero everywhere.
    pub(crate) one_sided: bool,
}

/// Returns the element if its ends are finite and the left end comes first.
fn checked(element: ContactElement) -> Result<ContactElement> {
    finite("left end of an element", element.left())?;
    finite("right end of an element", element.right())?;
    positive("length of an element", element.length())?;
    Ok(element)
}

impl Overlap {
    pub(crate) fn new(receiver: ContactElement, source: ContactElement) -> Result<Self> {
        let p = checked(receiver)?;
        let q = checked(source)?;
        let first = p.left() - q.right();
        let last = p.right() - q.left();
        let left_offset = p.left() - q.left();
        let right_offset = p.right() - q.right();
        let max_overlap = p.length().min(q.length());
        let largest_coordinate = [p.left(), p.right(), q.left(), q.right()]
            .iter()
            .fold(0.0_f64, |m, v| m.max(v.abs()));
        let rounding = 8.0 * f64::EPSILON * largest_coordinate;
        let mut nodes = vec![first.abs(), left_offset.abs(), right_offset.abs(), last.abs()];
        if first < rounding && last > -rounding {
            nodes.push(0.0);
        }
        nodes.sort_by(f64::total_cmp);
        // Nodes that differ only by rounding of the coordinates are one node.
        nodes.dedup_by(|next, previous| *next - *previous <= rounding);
        let overlap_length = |x: f64| (x - first).min(last - x).min(max_overlap).max(0.0);
        let mut even = Vec::with_capacity(nodes.len());
        let mut odd = Vec::with_capacity(nodes.len());
        for &x in &nodes {
            even.push(overlap_length(x) + overlap_length(-x));
            odd.push(overlap_length(x) - overlap_length(-x));
        }
        let one_sided = odd.iter().any(|w: &f64| w.abs() > rounding);
        Ok(Self { nodes, even, odd, length: p.length(), one_sided })
    }

    /// Largest offset, m.
    pub(crate) fn farthest(&self) -> f64 {
        self.nodes.last().copied().unwrap_or(0.0)
    }

    /// Smallest offset, m.
    pub(crate) fn nearest(&self) -> f64 {
        self.nodes.first().copied().unwrap_or(0.0)
    }

    /// Segment between nodes that contains the offset `x`.
    fn segment(&self, x: f64) -> SegmentOfOffset {
        if x < self.nearest() {
            return SegmentOfOffset::BeforeFirst;
        }
        match (1..self.nodes.len()).find(|&i| x < self.nodes[i]) {
            Some(end_node) => SegmentOfOffset::Inside(end_node - 1),
            None => SegmentOfOffset::BeyondLast,
        }
    }

    /// The polynomial A(u) on the piece that contains the speed `middle`.
    ///
    /// `step`: t₀ and t₁; `duration`: t₁ − t₀, rounded once; `odd`: of the odd folding instead of the even one.
    pub(crate) fn passed_overlap(
        &self,
        step: [f64; 2],
        duration: f64,
        middle: f64,
        odd: bool,
    ) -> PassedOverlap {
        let w = if odd { &self.odd } else { &self.even };
        let x = &self.nodes;
        let slope = |i: usize| (w[i + 1] - w[i]) / (x[i + 1] - x[i]);
        let mut passed = PassedOverlap {
            same_segment: false,
            duration,
            start: step[0],
            end: step[1],
            whole_segments: 0.0,
            low: [0.0; 3],
            high: [0.0; 3],
        };
        let low = self.segment(step[0] * middle);
        let high = self.segment(step[1] * middle);
        if let (SegmentOfOffset::Inside(i), SegmentOfOffset::Inside(j)) = (low, high)
            && i == j
        {
            // Measured from the end where w is smaller, so that w keeps its relative precision there.
            let k = if w[i].abs() <= w[i + 1].abs() { i } else { i + 1 };
            passed.same_segment = true;
            passed.low = [x[k], w[k], slope(i)];
            return passed;
        }
        let first_node = match low {
            SegmentOfOffset::Inside(i) => {
                passed.low = [x[i + 1], w[i + 1], slope(i)];
                i + 1
            }
            SegmentOfOffset::BeforeFirst => 0,
            SegmentOfOffset::BeyondLast => return passed,
        };
        let last_node = match high {
            SegmentOfOffset::Inside(j) => {
                passed.high = [x[j], w[j], slope(j)];
                j
            }
            SegmentOfOffset::BeyondLast => x.len() - 1,
            SegmentOfOffset::BeforeFirst => return passed,
        };
        for i in first_node..last_node {
            passed.whole_segments += 0.5 * (x[i + 1] - x[i]) * (w[i] + w[i + 1]);
        }
        passed
    }
}

/// Place of an offset among the segments between the nodes of an [`Overlap`].
#[derive(Debug, Clone, Copy)]
enum SegmentOfOffset {
    BeforeFirst,
    /// Number of the segment.
    Inside(usize),
    BeyondLast,
}

/// Overlap that a wave of speed u passes during a step, a polynomial in u.
///
/// A(u) = ∫ w(x) dx over u·t₀ < x < u·t₁, valid while both limits stay in their segments of w.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PassedOverlap {
    /// Whether both limits lie in the same segment.
    same_segment: bool,
    /// t₁ − t₀.
    duration: f64,
    /// t₀.
    start: f64,
    /// t₁.
    end: f64,
    /// Integral over the segments that lie between the limits as a whole.
    whole_segments: f64,
    /// Node, width there and slope, of the segment that both limits share or of the lower limit's segment.
    low: [f64; 3],
    /// Node, width there and slope, of the upper limit's segment.
    high: [f64; 3],
}

impl KernelWeight for PassedOverlap {
    /// A(u), m².
    fn value(&self, u: f64) -> f64 {
        if self.same_segment {
            return u * self.value_over_speed(u);
        }
        let below = self.low[0] - self.start * u;
        let above = self.end * u - self.high[0];
        self.whole_segments
            + below * (self.low[1] - 0.5 * self.low[2] * below)
            + above * (self.high[1] + 0.5 * self.high[2] * above)
    }

    /// A(u)/u, m².
    fn value_over_speed(&self, u: f64) -> f64 {
        if self.same_segment {
            let middle = 0.5 * (self.start + self.end);
            self.duration * (self.low[1] + self.low[2] * (middle * u - self.low[0]))
        } else {
            self.value(u) / u
        }
    }

    fn vanishes_at_zero(&self) -> bool {
        self.same_segment
    }
}
