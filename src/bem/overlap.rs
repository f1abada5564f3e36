//! Geometry of a pair of elements: the length of overlap at every offset, and its integrals over
//! the offsets that a wave of given slowness covers during a step.

use crate::error::{Error, Result, finite};
use crate::fundamental::branch::Weight;
use crate::geometry::ContactElement;

/// Overlap lengths w(x) of a receiver element and a source element shifted by x, folded to x ≥ 0.
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

/// An element with finite ends, the left one first.
fn checked(element: ContactElement) -> Result<ContactElement> {
    finite("left end of an element", element.left)?;
    finite("right end of an element", element.right)?;
    let length = element.length();
    if length.is_finite() && length > 0.0 {
        Ok(element)
    } else {
        Err(Error::Input {
            quantity: "length of an element",
            value: length,
            needed: "finite and above zero",
        })
    }
}

impl Overlap {
    pub(crate) fn new(receiver: ContactElement, source: ContactElement) -> Result<Self> {
        let (p, q) = (checked(receiver)?, checked(source)?);
        let (first, last) = (p.left - q.right, p.right - q.left);
        let (one, two) = (p.left - q.left, p.right - q.right);
        let plateau = p.length().min(q.length());
        let width = |x: f64| (x - first).min(last - x).min(plateau).max(0.0);
        let scale = [p.left, p.right, q.left, q.right].iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let close = 8.0 * f64::EPSILON * scale;
        let mut nodes = vec![first.abs(), one.abs(), two.abs(), last.abs()];
        if first < close && last > -close {
            nodes.push(0.0);
        }
        nodes.sort_by(f64::total_cmp);
        // Nodes that differ by rounding of the coordinates are one node.
        nodes.dedup_by(|next, kept| *next - *kept <= close);
        let fold = |sign: f64| nodes.iter().map(|&x| width(x) + sign * width(-x)).collect();
        let (even, odd): (Vec<f64>, Vec<f64>) = (fold(1.0), fold(-1.0));
        let one_sided = odd.iter().any(|w| w.abs() > close);
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

    /// Segment that holds `x`: `Ok` its number, or an error telling whether x lies beyond the end.
    fn segment(&self, x: f64) -> std::result::Result<usize, bool> {
        if x < self.nearest() {
            return Err(false);
        }
        (1..self.nodes.len()).find(|&i| x < self.nodes[i]).map(|i| i - 1).ok_or(true)
    }

    /// The polynomial A(u) on the piece that holds `middle`, for the even or the odd folding.
    pub(crate) fn covered(&self, step: [f64; 2], span: f64, middle: f64, odd: bool) -> Covered {
        let w = if odd { &self.odd } else { &self.even };
        let x = &self.nodes;
        let slope = |i: usize| (w[i + 1] - w[i]) / (x[i + 1] - x[i]);
        let mut covered = Covered {
            same: false,
            span,
            begin: step[0],
            end: step[1],
            base: 0.0,
            low: [0.0; 3],
            high: [0.0; 3],
        };
        let (low, high) = (self.segment(step[0] * middle), self.segment(step[1] * middle));
        if let (Ok(i), Ok(j)) = (low, high)
            && i == j
        {
            // From the end where w is smaller, so that w keeps its relative precision there.
            let k = if w[i].abs() <= w[i + 1].abs() { i } else { i + 1 };
            covered.same = true;
            covered.low = [x[k], w[k], slope(i)];
            return covered;
        }
        let mut from = 0;
        match low {
            Ok(i) => {
                from = i + 1;
                covered.low = [x[from], w[from], slope(i)];
            }
            Err(false) => {}
            Err(true) => return covered,
        }
        let to = match high {
            Ok(j) => {
                covered.high = [x[j], w[j], slope(j)];
                j
            }
            Err(true) => x.len() - 1,
            Err(false) => return covered,
        };
        for i in from..to {
            covered.base += 0.5 * (x[i + 1] - x[i]) * (w[i] + w[i + 1]);
        }
        covered
    }
}

/// A(u) = ∫ w(x) dx over u·t₀ < x < u·t₁ as a polynomial in u, valid while both limits stay in
/// their segments of w.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Covered {
    /// Both limits lie in the same segment.
    same: bool,
    span: f64,
    begin: f64,
    end: f64,
    base: f64,
    /// Node, width there and slope: of the segment that both limits share, or of the lower limit.
    low: [f64; 3],
    /// The same of the upper limit.
    high: [f64; 3],
}

impl Weight for Covered {
    /// A(u), m².
    fn at(&self, u: f64) -> f64 {
        if self.same {
            return u * self.over(u);
        }
        let below = self.low[0] - self.begin * u;
        let above = self.end * u - self.high[0];
        self.base
            + below * (self.low[1] - 0.5 * self.low[2] * below)
            + above * (self.high[1] + 0.5 * self.high[2] * above)
    }

    /// A(u)/u, m².
    fn over(&self, u: f64) -> f64 {
        if self.same {
            let middle = 0.5 * (self.begin + self.end);
            self.span * (self.low[1] + self.low[2] * (middle * u - self.low[0]))
        } else {
            self.at(u) / u
        }
    }

    fn vanishes(&self) -> bool {
        self.same
    }
}
