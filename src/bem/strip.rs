//! Strips of contact elements on the surface.

use std::ops::Range;

use crate::error::{Error, Result, finite, positive};
use crate::geometry::{ContactElement, check_count};
use crate::structure::{Structure, foundation_nodes};

/// Variation of element lengths along a strip.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum Grading {
    /// Equal lengths: cheapest history, first order.
    Uniform,
    /// x = −cos(πk/Q): short elements at the ends, where tractions are singular. Second order.
    #[default]
    Cosine,
}

words! { Grading, "grading", {
    Uniform = "uniform",
    Cosine = "cosine",
} }

/// A foundation strip: an interval of the surface cut into elements.
///
/// ```
/// use basemat::bem::Strip;
/// let strip = Strip::graded(-5.0..5.0, 10)?;
/// assert_eq!(strip.elements().len(), 10);
/// assert_eq!(strip.elements()[9].right, 5.0);
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
    /// Strip over `range` (m) of `count` elements.
    ///
    /// # Errors
    /// [`Error::Input`] for an empty or infinite range or no elements, [`Error::Memory`] for so many
    /// that the matrices between them would not fit.
    pub fn new(range: Range<f64>, count: usize, grading: Grading) -> Result<Self> {
        finite("left end of the strip", range.start)?;
        finite("right end of the strip", range.end)?;
        positive("length of the strip", range.end - range.start)?;
        if count == 0 {
            let (quantity, value) = ("number of contact elements", 0.0);
            return Err(Error::Input { quantity, value, needed: "1 or more" });
        }
        check_count(count)?;
        let middle = 0.5 * (range.start + range.end);
        let half = 0.5 * (range.end - range.start);
        let node = |k: usize| {
            let fraction = k as f64 / count as f64;
            // sin of the distance from the middle keeps both halves mirror images to rounding.
            let place = match grading {
                Grading::Uniform => 2.0 * fraction - 1.0,
                Grading::Cosine => (std::f64::consts::PI * (fraction - 0.5)).sin(),
            };
            match k {
                0 => range.start,
                k if k == count => range.end,
                _ => middle + half * place,
            }
        };
        Self::from_nodes((0..=count).map(node).collect())
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

    /// Strips of `count` elements under each foundation of `structure`, as wide as that is.
    ///
    /// ```
    /// use basemat::bem::{Grading, Strip};
    /// use basemat::structure::RigidBlock;
    /// let block = RigidBlock::new(6.0, 4.0, 2400.0)?;
    /// let strips = Strip::under(&block, 12, Grading::Cosine)?;
    /// let elements = strips[0].elements();
    /// assert_eq!((strips.len(), elements[0].left, elements[11].right), (1, -3.0, 3.0));
    /// assert!(elements[0].length() < 0.15 * elements[6].length());
    /// # Ok::<(), basemat::Error>(())
    /// ```
    ///
    /// # Errors
    /// As for [`Strip::new`]; [`Error::Size`] or [`Error::Index`] for a structure without foundations.
    pub fn under(structure: &dyn Structure, count: usize, grading: Grading) -> Result<Vec<Self>> {
        let nodes = structure.contact_nodes();
        let foundations = foundation_nodes(nodes.len(), &structure.foundation_ends())?;
        let strip =
            |own: Range<usize>| Self::new(nodes[own.start].x..nodes[own.end - 1].x, count, grading);
        foundations.into_iter().map(strip).collect()
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
        self.nodes.windows(2).map(|n| ContactElement { left: n[0], right: n[1] }).collect()
    }
}

/// One strip where several may be given.
impl AsRef<[Strip]> for Strip {
    fn as_ref(&self) -> &[Strip] {
        std::slice::from_ref(self)
    }
}
